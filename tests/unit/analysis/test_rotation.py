"""Whether the friction force turns or grows, of paths whose truth is known."""

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import pytest
from tests.rigs import SOFT_TESTER

import stiction as st
from stiction.analysis.parts import rotation
from stiction.analysis.report import _agreeing
from stiction.analysis.rotation.findings import BOTH, GROWING, TURNING, UNDETERMINED, rotation_of
from stiction.analysis.rotation.plane import with_both_forces
from stiction.arrays import xr
from stiction.errors import ResultError

F_0, LOADINGS, EACH = 2.0, 6, 300
RISE = F_0 * np.linspace(0.5, 0.999, EACH)  # of the force along
TURN = np.sqrt(F_0**2 - RISE**2)
PARTLY = np.minimum(TURN, 0.9 + 0.05 * RISE)  # the mass rests at first


def cycles_of(peak=RISE[-1], low=RISE[0]):
    starts = np.arange(LOADINGS, dtype=float)
    columns = {"start": starts, "peak_time": starts + 1.0, "peak": np.full(LOADINGS, peak)}
    columns["start_force"] = np.full(LOADINGS, low)
    return xr.Dataset({name: ("cycle", values) for name, values in columns.items()})


def record_of(across, noise, seed, zero=0.0, known=None, along=RISE):
    """Return loadings one after the other, with noise; `known` is the error of the zero.

    The zero may be that of each sample.
    """
    normal = np.random.default_rng(seed).standard_normal((2, LOADINGS * EACH))
    along, across = (np.tile(each, LOADINGS) for each in (along, across))
    return st.Record(
        time=np.concatenate([i + np.linspace(0.0, 0.999, EACH) for i in range(LOADINGS)]),
        force=along + noise * normal[0],
        force_across=across + zero + noise * normal[1],
        sensors=known and {"force_across": st.Sensor(zero_uncertainty=known)},
    )


@pytest.mark.parametrize("known", [None, 0.02])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_an_arc_is_a_force_that_turns_about_its_zero(side, known):
    zero = 0.0 if known else 3.0
    found = rotation_of(record_of(side * TURN, 2e-3, 1, zero, known), cycles_of())
    assert (found.kind, found.loadings, found.stated) == (TURNING, LOADINGS, bool(known))
    assert abs(found.F_0 - F_0) < 2.0 * found.F_0_error < 0.1
    assert abs(found.change) < 2.0 * found.change_error < 0.1
    assert abs(found.zero - zero) < 2.0 * found.zero_error
    truth = rotation_of(record_of(TURN, 0.0, 1, 0.0, 1e-9), cycles_of())
    assert (np.abs(found.angle - truth.angle) < 2.0 * found.angle_error).all()


@pytest.mark.parametrize("angle", [25.0, 40.0, 60.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_force_that_grows_and_then_turns_does_both(side, angle):
    """By its ends alone that of a soft rig, which turns by 40 deg after it has grown, only grew."""
    half = EACH // 2
    size = F_0 * np.append(np.linspace(0.3, 1.0, half), np.ones(EACH - half))
    turn = np.radians(np.append(np.full(half, angle), np.linspace(angle, 2.0, EACH - half)))
    along, across = size * np.cos(turn), side * size * np.sin(turn)
    found = rotation_of(record_of(across, 2e-3, 1, 0.0, 0.005, along), cycles_of(along[-1], 0.0))
    assert found.kind == BOTH
    assert found.change > 0.8  # the first tenth of a loading is left out
    slow = SOFT_TESTER.loading_time
    run = st.simulate(SOFT_TESTER, 6.0 * slow, sample_rate=500.0 / slow)
    assert st.analyse(run).parts["rotation"].kind == BOTH


@pytest.mark.parametrize(("slope", "known"), [*product([0.0, 0.05, -0.05], [None, 0.02])])
def test_a_straight_path_is_a_force_that_grows(slope, known):
    zero = 0.0 if known else 3.0
    found = rotation_of(record_of(slope * RISE, 2e-3, 2, zero, known), cycles_of())
    assert found.kind == GROWING
    assert np.isnan(found.F_0)
    if known:
        truth = rotation_of(record_of(slope * RISE, 0.0, 2, 0.0, 1e-9), cycles_of())
        assert abs(found.change - truth.change) < 2.0 * found.change_error < 0.01


def test_a_force_that_first_grows_then_turns_does_both():
    across = PARTLY
    assert rotation_of(record_of(across, 1e-3, 3, 0.0, 0.01), cycles_of()).kind == BOTH
    # Without a zero its path is neither of both
    assert rotation_of(record_of(across, 1e-3, 3, 3.0), cycles_of()).kind == UNDETERMINED


def test_a_loading_counts_from_where_the_force_pulls_forward():
    along = F_0 * np.linspace(-0.9, 0.999, EACH)
    found = rotation_of(record_of(0.0 * along, 1e-3, 7, 0.0, 0.02, along), cycles_of(low=along[0]))
    assert found.kind == GROWING
    assert found.along[0] > 0.1 * F_0


def test_noise_that_hides_the_arc_leaves_it_undetermined():
    assert rotation_of(record_of(0.1 * TURN, 2.0, 4), cycles_of()).kind == UNDETERMINED


def test_errors_cover_zero_magnitude_and_its_change_where_friction_weakens():
    """In at least 93 % of cases, with weakening of 0 to 6 % as 1/sin of the angle."""
    covers = []
    for seed in range(30):
        weak = 0.002 * (seed % 4)
        r = F_0 * (1.0 - weak / np.sqrt(1.0 - (RISE / F_0) ** 2).clip(0.1))
        along, across = r * RISE / F_0, r * TURN / F_0
        known = 0.01 if seed % 2 else None
        zero = 0.01 * np.random.default_rng(seed).standard_normal() if known else 1.0
        record = record_of(across, 10.0 ** (-4 + seed / 15), seed, zero, known, along)
        found = rotation_of(record, cycles_of(along.max()))
        truth = rotation_of(record_of(across, 0.0, 0, 0.0, 1e-9, along), cycles_of(along.max()))
        if found.kind == TURNING:
            covers.append(abs(found.F_0 - F_0) <= 2.0 * found.F_0_error)
            covers.append(abs(found.change - truth.change) <= 2.0 * found.change_error)
    assert len(covers) > 40
    assert np.mean(covers) >= 0.93


@pytest.mark.parametrize("stated", [0.0, 0.02])
def test_a_drift_of_the_zero_is_in_the_errors_whether_it_is_seen_or_stated(stated):
    """Over one loading it isn't seen."""
    rate = 0.02
    drifting = record_of(TURN, 1e-4, 8, rate * np.linspace(0.0, LOADINGS, LOADINGS * EACH), 1e-3)
    sensor = st.Sensor(zero_uncertainty=1e-3, zero_drift_uncertainty=stated)
    record = drifting.model_copy(update={"sensors": {"force_across": sensor}})
    cycles = cycles_of().isel(cycle=[-1]) if stated else cycles_of()
    found = rotation_of(record, cycles)
    truth = rotation_of(record_of(TURN, 0.0, 1, 0.0, 1e-9), cycles_of())
    assert (np.abs(found.angle - truth.angle) < 2.0 * found.angle_error).all()
    assert (found.angle_error < np.radians(4.0)).all()
    assert abs(found.change - truth.change) < 2.0 * found.change_error


def test_rounding_that_all_loadings_share_is_in_the_errors():
    """Across all of them the force is one code, off by up to half a step."""
    step = 0.1
    along, across = (step * np.round(each / step) for each in (RISE, 0.44 * step + 0.1 * RISE))
    found = rotation_of(record_of(across, 0.0, 1, 0.0, 1e-3, along), cycles_of())
    truth = rotation_of(record_of(0.44 * step + 0.1 * RISE, 0.0, 1, 0.0, 1e-9), cycles_of())
    assert (np.abs(found.angle - truth.angle) < 2.0 * found.angle_error).all()
    assert abs(found.change - truth.change) < 2.0 * found.change_error


def test_a_force_across_that_passes_through_zero_has_angles_on_both_sides():
    across = np.linspace(1.0, -0.5, EACH)
    first, last = rotation_of(record_of(-across, 1e-4, 9, 0.0, 1e-3), cycles_of()).angle
    assert first > 0.0 > last


def test_a_magnitude_that_falls_with_the_logarithm_as_in_rate_and_state_is_in_the_errors():
    r = F_0 * (1.0 + 0.04 * np.log(TURN.clip(0.1) / F_0))
    along, across = r * RISE / F_0, r * TURN / F_0
    found = rotation_of(record_of(across, 1e-3, 10, 1.0, None, along), cycles_of(along.max()))
    assert found.kind == TURNING
    assert abs(found.zero - 1.0) < 2.0 * found.zero_error
    assert found.zero_error < 0.1 * F_0


def test_what_does_not_rise_or_is_too_short_is_refused():
    with pytest.raises(ResultError, match="rises by less than 10 %"):
        rotation_of(record_of(TURN, 1e-3, 5, along=np.full(EACH, F_0)), cycles_of(F_0))
    record = record_of(TURN, 1e-3, 5)
    short = st.Record(
        time=record.time[::10], force=record.force[::10], force_across=record.force_across[::10]
    )
    with pytest.raises(ResultError, match="5 samples in each of 10 parts"):
        rotation_of(short, cycles_of())


@pytest.mark.parametrize(
    ("across", "known", "said"),
    [
        (TURN, None, "falls from 1.6"),
        (TURN, 0.02, "It turns at nearly constant magnitude"),
        (TURN, None, "The zero of the force across, 3.00"),
        (0.0 * RISE, None, "Its path is straight"),
        (0.0 * RISE, 0.02, "It grows rather than turns"),
        (PARTLY, 0.01, "It grows and turns"),
        (PARTLY, None, "state the zero of the force across"),
    ],
)
def test_the_report_says_so(across, known, said):
    its = rotation_of(record_of(across, 1e-3, 6, 0.0 if known else 3.0, known), cycles_of())
    analysis = type("Found", (), {"parts": {"rotation": its}, "missing": {}, "source": None})
    assert said in " ".join(rotation.section(analysis).sentences)
    assert f"means over {LOADINGS} loadings" in " ".join(rotation.section(analysis).sentences)
    numbers = rotation.numbers(analysis)["rotation"]
    assert numbers["kind"] == its.kind
    assert numbers["change"] is None or abs(numbers["change"]) < 1.0


def test_the_brief_says_that_a_turn_is_not_determined_and_what_to_state():
    """It was silent, as where no force across is measured."""
    its = rotation_of(record_of(PARTLY, 1e-3, 6, 3.0, None), cycles_of())
    analysis = type("Found", (), {"parts": {"rotation": its}, "missing": {}, "source": None})
    (said,) = rotation.in_short(analysis)
    assert said.startswith("Whether the force turns or grows is not determined; state the zero of")
    assert 'zero = "0 +- 5 mN" under [sensors.force_across]' in said
    analysis = type("Found", (), {"parts": {"rotation": None}, "missing": {}, "source": None})
    assert rotation.in_short(analysis) == []


def test_the_report_of_one_loading_leaves_out_a_drift_that_it_cannot_show():
    its = rotation_of(record_of(TURN, 1e-3, 6, 0.0, 0.02), cycles_of().isel(cycle=[0]))
    analysis = type("Found", (), {"parts": {"rotation": its}, "missing": {}, "source": None})
    said = " ".join(rotation.section(analysis).sentences)
    assert "This is of one loading" in said
    assert "a drift of the zero beyond a stated one" in said


@dataclass(frozen=True)
class FoundAngle:
    """What is known of an angle beside a rotation."""

    parts: dict[str, Any]
    missing: dict[str, str]
    misalignment: Any = None


@pytest.mark.parametrize("angle", [None, 0.02])
def test_a_force_that_grows_implies_no_angle_nor_a_bound_of_it(angle):
    """Beside "It grows" stood "it is below 0.41 deg", of a rock at 1 deg."""
    bound = {"misalignment": "it is below 0.41 deg"} if angle is None else {}
    for across, known in ((0.0 * RISE, True), (TURN, False)):
        its = rotation_of(record_of(across, 1e-3, 6, 0.0, 0.02), cycles_of())
        found = _agreeing(FoundAngle({"rotation": its}, bound, angle))
        assert (found.misalignment, found.missing != bound) == (None if known else angle, known)
        assert ("shows that it grows" in found.missing.get("misalignment", "")) is known


@pytest.mark.parametrize(
    ("across", "known", "said"),
    [
        (TURN, None, "turns at nearly constant magnitude: this apparent stick is slow creep."),
        (0.05 * RISE, 0.02, "grows rather than turns at one magnitude: the mass rests, or its"),
        (PARTLY, 0.01, "grows and turns: the mass rests for a part of the loading"),
        (PARTLY, None, ""),
    ],
)
def test_the_brief_says_it_directly_after_the_kind_of_motion(across, known, said):
    found = st.analyse(record_of(across, 1e-3, 6, 0.0 if known else 3.0, known))
    brief = found.tables()[0]
    kind, motion, third = brief.sentences[:3]
    assert (brief.title, kind[:10], motion[:8]) == ("In short", "Stick-slip", "The mass")
    assert third.startswith(f"By the force across, the friction force {said}") is bool(said)
    assert "By the force across" not in " ".join(brief.sentences[3 if said else 2 :])


@pytest.mark.parametrize(
    ("angle", "kind", "said"),
    [("1 deg", TURNING, "this apparent stick is slow creep"), ("0 deg", GROWING, "the mass rests")],
)
def test_a_run_knows_both_forces(angle, kind, said):
    slider = st.presets.nakano_popov_2020().replace(phi=angle)
    found = st.analyse(st.simulate(slider, duration=5.0, sample_rate=2e3))
    its = found.parts["rotation"]
    assert (its.kind, its.stated, found.record.force_across) == (kind, True, None)
    third = found.tables()[0].sentences[2]
    assert third.startswith("While the spring is loaded, the friction force")
    assert said in third
    section = next(each for each in found.tables() if each.title == rotation.TITLE)
    assert not {"stated", "crosstalk", "zero"} & set(" ".join(section.sentences).split())


def test_the_forces_of_a_run_stand_along_its_load_cell_and_across_it():
    slider = st.presets.nakano_popov_2020()
    turned = slider.replace(cell_angle="30 deg")
    first, second = (
        with_both_forces(run, st.analysis.record_of(run))
        for run in (st.simulate(each, duration=2.0, sample_rate=1e3) for each in (slider, turned))
    )
    magnitude = [np.hypot(each.force, each.force_across) for each in (first, second)]
    assert np.allclose(*magnitude, rtol=1e-12, atol=0.0)
    angle = np.arctan2(second.force_across, second.force) - np.arctan2(
        first.force_across, first.force
    )
    assert np.allclose(np.abs(angle[5:]), np.pi / 6.0 + slider.phi, atol=1e-9)
