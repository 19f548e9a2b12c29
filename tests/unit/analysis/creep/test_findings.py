"""The limits beyond which creep determines no angle and no exponent."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction.analysis.creep import findings
from stiction.analysis.creep.divergence import Divergence
from stiction.analysis.creep.misalignment import Misalignment

V = 1e-3
CURVE = xr.Dataset({"velocity": ("bin", np.full(9, 0.1 * V)), "force": ("bin", np.ones(9))})
SURE = Misalignment(0.02, 1e-3, 2.0, 0.1, misfit=0.0, scatter=1.0, worse=100.0, contact=9.0)
DIVERGES = Divergence(*np.zeros(len(Divergence._fields)))._replace(
    exponent=0.5, exponent_error=0.1, amplitude=1.0, amplitude_error=0.1
)


@pytest.mark.parametrize(
    ("seen", "why"),
    [
        ({"misfit": 0.09}, ""),
        ({"misfit": 0.11}, "misses this creep by 11 %"),
        ({"scatter": 1.9}, ""),
        ({"scatter": 2.1}, "misses this creep by more than its uncertainty"),
        ({"worse": -3.9}, ""),
        ({"worse": -4.1}, "presliding"),
        ({"phi": -0.02, "phi_error": 0.0048}, ""),
        ({"phi": -0.02, "phi_error": 0.0052}, "does not stand out of its uncertainty; it is below"),
        ({"phi": 0.7, "phi_error": 0.2}, r"does not stand out of its uncertainty$"),
    ],
)
def test_an_angle_is_that_of_creep_that_eq_7_describes(monkeypatch, seen, why):
    monkeypatch.setattr(findings, "fit_misalignment", lambda *_, **__: SURE._replace(**seen))
    curve = CURVE.assign(begin=("bin", np.ones(9)))
    if not why:
        assert findings._misalignment(curve, V, 1e3, 1e7, None, True) == SURE._replace(**seen)
        return
    with pytest.raises(st.ResultError, match=why):
        findings._misalignment(curve, V, 1e3, 1e7, None, True)


@pytest.mark.parametrize(("speed", "rests"), [(0.5e-6, True), (2e-6, False)])
def test_an_angle_is_not_that_of_a_mass_that_rests(speed, rests):
    curve = CURVE.assign(velocity=-speed * V + 0.0 * CURVE["velocity"])
    if not rests:
        findings._refuse_rest(curve, V)
        return
    with pytest.raises(st.ResultError, match="mostly rests"):
        findings._refuse_rest(curve, V)


@pytest.mark.parametrize(
    ("seen", "known"),
    [
        ({"exponent_error": 0.24}, True),
        ({"exponent_error": 0.26}, False),
        ({"exponent_error": np.nan}, False),
        ({"amplitude_error": 0.49}, True),
        ({"amplitude_error": 0.52}, False),
        ({"exponent": 0.01}, True),
        ({"exponent": 0.0}, False),
    ],
)
def test_a_divergence_exceeds_its_uncertainty(monkeypatch, seen, known):
    monkeypatch.setattr(findings, "fit_divergence", lambda *_: DIVERGES._replace(**seen))
    if known:
        assert findings._divergence(CURVE, 2.0) == DIVERGES._replace(**seen)
        return
    with pytest.raises(st.ResultError, match="no divergence exceeds its uncertainty"):
        findings._divergence(CURVE, 2.0)


@pytest.mark.parametrize(
    ("rest", "each", "lost", "refused"),
    [
        (0.25, 0.05, 0.025, True),
        (0.18, 0.06, 0.025, False),  # it rests for less than a fifth
        (0.25, 0.05, 0.018, False),  # friction is less by less than 2 %
        (0.24, 0.08, 0.025, True),
        (0.24, 0.12, 0.025, False),  # these are no rests between jerks
    ],
)
@pytest.mark.parametrize("before", [0.0, 3.0])
def test_jerks_with_less_friction_and_long_rests_are_not_creep(rest, each, lost, refused, before):
    """In a stick phase of 1 s, of which nothing `before` (s) counts, nor after it."""
    starts = before + 0.3 + np.arange(round(rest / each)) * 2.0 * each
    time = np.linspace(0.0, before + 2.0, 4001)
    inside = (time >= before) & (time <= before + 1.0)
    samples = {
        "time": time,
        "slip_speed": np.where(np.abs(time - before - 0.2) < 0.15, V, 0.0) + V * ~inside,
        "friction": np.where(inside, 2.0 * (1.0 - lost), 2.0),
    }
    others = np.append(np.arange(0.0, before, 0.1), np.arange(before + 1.2, before + 2.0, 0.1))
    run = SimpleNamespace(
        stick_intervals=np.concatenate(
            [np.stack([s, s + d], axis=1) for s, d in ((others, 0.05), (starts, each))]
        ),
        samples=samples,
        slider=SimpleNamespace(F_0=2.0),
    )
    curves = xr.Dataset(
        {"begin": (("phase", "bin"), [[0.5, 1.0]])}, {"slip_time": ("phase", [before + 1.0])}
    )
    if not refused:
        findings._refuse_jerks(run, curves)
        return
    with pytest.raises(st.ResultError, match="creeps by jerks"):
        findings._refuse_jerks(run, curves)
    samples["slip_speed"] = 0.0 * time
    findings._refuse_jerks(run, curves)


@pytest.mark.parametrize(
    ("change", "k_y", "refused"),
    [
        (0.24, 1e9, {}),
        (0.26, 1e9, {"divergence": "Eq. (8) supposes"}),
        (0.39, 1e9, {"divergence": "Eq. (8) supposes"}),
        (0.41, 1e9, {"divergence": "Eq. (8) supposes", "misalignment": "Eq. (7) supposes"}),
        (0.41, None, {"divergence": "Eq. (8) supposes", "misalignment": "Eq. (7) supposes"}),
        (0.19, 1e3 / np.tan(0.02) ** 2, {}),
        (0.21, 1e3 / np.tan(0.02) ** 2, {"misalignment": "spring across turns the slip"}),
    ],
)
def test_a_load_may_change_by_so_much(monkeypatch, change, k_y, refused):
    monkeypatch.setattr(findings, "load_change", lambda *_: change)
    monkeypatch.setattr(findings, "fit_misalignment", lambda *_, **__: SURE)
    monkeypatch.setattr(findings, "fit_divergence", lambda *_: DIVERGES)
    record = st.Record(time=np.arange(3.0), force=np.ones(3), stiffness_across=k_y)
    curves = xr.Dataset({"begin": (("phase", "bin"), [[1.0]])}, {"slip_time": ("phase", [1.0])})
    mean = CURVE.assign(begin=("bin", np.ones(9)))
    found = findings._with_fits(
        findings.CreepFound(curves, mean, None, None, {}), None, record, 1e3, V
    )
    assert found.missing.keys() == refused.keys()
    assert all(why in found.missing[name] for name, why in refused.items())


def test_by_the_force_alone_creep_diverges_in_the_time_in_which_friction_is_loaded(monkeypatch):
    seen = findings.CreepFound(None, CURVE, None, SURE, {})
    monkeypatch.setattr(
        findings, "fit_divergence", lambda _, loading: DIVERGES._replace(loading_time=loading)
    )
    assert findings._with_divergence(seen, 0.5).divergence.loading_time == SURE.F_0 / 0.5
    unknown = findings._with_divergence(seen._replace(misalignment=None), 0.5)
    assert "follows from the misalignment" in unknown.missing["divergence"]


def test_without_misalignment_none_is_missed():
    slider = st.presets.nakano_popov_2020().replace(phi="0 deg")
    found = st.analyse(st.simulate(slider, "5 s", sample_rate="1 kHz"))
    assert found.misalignment is None
    assert found.missing.keys().isdisjoint({"misalignment", "divergence"})
