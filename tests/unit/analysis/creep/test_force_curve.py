"""The misalignment from a measured force alone: right where it is given, or not given."""

from math import cos, degrees, radians

import numpy as np
import pytest

import stiction as st

RATE = 2e3
PAPER = st.presets.nakano_popov_2020()


def measure(
    phi: float, noise: float = 0.0, stiffness: float = 1.0, across: float = 1e4
) -> st.Record:
    """Return what a load cell sees of the paper's rig at phi (deg), its stiffness misstated.

    The spring across is stiffer by a factor.
    """
    slider = PAPER.replace(phi=f"{phi} deg", k_y=across * PAPER.k_x)
    run = st.simulate(slider, 6.0, sample_rate=RATE)
    force = run.data["spring_x"].values
    hiss = noise * np.random.default_rng(3).standard_normal(len(force))
    return st.Record(
        time=run.data["time"].values,
        force=force + hiss,
        stiffness=stiffness * slider.k_x,
        drive_velocity=1e-3 * cos(slider.phi),
    )


@pytest.mark.parametrize(
    ("phi", "noise", "stiffness"),
    [(1.0, 0.0, 1.0), (1.0, 1e-4, 0.98), (2.0, 1e-3, 1.0), (2.0, 1e-3, 1.02), (4.0, 4e-3, 0.99)],
)
def test_a_force_alone_implies_the_misalignment(phi: float, noise: float, stiffness: float) -> None:
    found = st.analysis.misalignment_from_force(measure(phi, noise, stiffness))
    low, high = found.interval
    assert low < radians(phi) < high
    assert found.phi_error < 0.3 * found.phi
    assert found.stiffness == pytest.approx(PAPER.k_x, rel=0.02)


def test_a_stated_stiffness_across_is_used() -> None:
    """Its order of magnitude was assumed, whatever the record stated."""
    record = measure(1.0, across=1e3)
    stated = record.model_copy(update={"stiffness_across": 1e3 * PAPER.k_x})
    assumed, known = (st.analysis.misalignment_from_force(each) for each in (record, stated))
    assert known.interval[0] < radians(1.0) < known.interval[1]
    assert known.phi_error < 0.8 * assumed.phi_error
    assert "k_x/k_y" in str(st.analyse(record))
    assert "By Eq. (7), with both springs, it implies" in str(st.analyse(stated))


def test_what_noise_hides_is_not_determined() -> None:
    with pytest.raises(st.ResultError, match="not determined: the bend of the rises"):
        st.analysis.misalignment_from_force(measure(0.2, 0.03))


def test_steps_of_an_eighth_of_the_drop_hide_it() -> None:
    record = measure(1.0)
    step = 0.1  # N, of a drop of 0.8 N
    cycles = st.analysis.find_cycles(record)
    coarse = record.model_copy(update={"force": step * np.round(record.force / step)})
    with pytest.raises(st.ResultError, match="not determined"):
        st.analysis.misalignment_from_force(coarse, cycles)


def test_a_stiffness_that_cannot_be_is_named() -> None:
    with pytest.raises(st.ResultError, match=r"0.9\d* times stiffness times drive velocity"):
        st.analysis.misalignment_from_force(measure(1.0, 1e-4, 1.1))


def test_an_analysis_takes_it_from_the_force() -> None:
    found = st.analyse(measure(1.0))
    assert degrees(found.misalignment.phi) == pytest.approx(1.0, abs=0.25)
    late = found.creep.isel(bin=slice(1, 10))
    assert (late["velocity"].values > 0.0).all()


def test_an_even_sawtooth_has_no_bend() -> None:
    time = np.arange(0.0, 20.0, 1e-3)
    record = st.Record(time=time, force=1.0 + 0.4 * (time % 2.0), stiffness=0.4, drive_velocity=1.0)
    found = st.analyse(record)
    assert found.misalignment is None
    assert "not determined" in found.missing["misalignment"]


def test_a_rate_that_an_angle_refuses_is_not_said_to_contradict_what_is_stated() -> None:
    """Ten lines apart, one report asked to measure again what it did not contradict."""
    record = measure(1.0)
    assert record.stiffness is not None
    stated = record.model_copy(update={"stiffness": record.stiffness / 1.09})
    said = str(st.analyse(stated))
    assert (
        "times stiffness times drive velocity as stated, and an angle needs that to within" in said
    )
    assert "The record contradicts" not in said


def softening(share: float, begin: float, number: int) -> st.Record:
    """Return the record of a mass that rests between slips, behind a spring that softens.

    Its stiffness falls by a share up to the peak, and is stated as it is at a smaller force.
    """
    random = np.random.default_rng(number)
    k, top, V = 2e4, 12.0, 1e-3
    a = k**2 * (1.0 - (1.0 - share) ** 2) / (4.0 * top)  # F = k u - a u²
    force = begin * top + (1.0 - begin) * top * np.linspace(0.0, 1.0, 4000)
    elongation = (k - np.sqrt(k**2 - 4.0 * a * force)) / (2.0 * a)
    lasts = (elongation[-1] - elongation[0]) / V
    time = np.arange(0.0, 40.0 * lasts, lasts / 500)
    reached = elongation[0] + V * (time % lasts)
    seen = k * reached - a * reached**2 + 0.05 * random.normal(size=len(time))
    stated = np.sqrt(k**2 - 4.0 * a * random.uniform(0.6, 1.0) * begin * top)
    return st.Record(time=time, force=seen, stiffness=stated, drive_velocity=V)


@pytest.mark.parametrize("number", range(5))
def test_a_spring_that_softens_is_no_misalignment(number: int) -> None:
    """A leaf spring, without any creep, gave 14 ± 3 deg; and so did 35 of 80 of these."""
    random, reasons = np.random.default_rng([41, number]), []
    for at in range(8):
        record = softening(random.uniform(0.2, 0.6), random.uniform(0.3, 0.6), 8 * number + at)
        with pytest.raises(st.ResultError, match="not determined") as refused:
            st.analysis.misalignment_from_force(record)
        reasons.append(str(refused.value))
    assert any("a spring whose stiffness falls by" in reason for reason in reasons)
