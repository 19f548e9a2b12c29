"""Cycles of two sizes within a record, as under two loads; and ripple that is none of them."""

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.analysis.motion.changes import sizes
from stiction.analysis.motion.changes.cycles import FEW_CYCLES
from stiction.analysis.signals.turning_points import FEWEST_PER_CYCLE, turning_points

STIFFNESS, SPEED, RATE = 1e3, 1e-3, 250.0  # N/m, m/s, Hz


def stick_slip(loads, number, noise=0.0, seed=1):
    """Return times and the force of a mass under one load after the other.

    It sticks to 0.5 of the load, then slips to 0.3 of it; each load lasts for so many slips.
    """
    rate = STIFFNESS * SPEED
    times, forces = [0.0], [0.0]
    for load, slips in zip(loads, number, strict=True):
        for _ in range(slips):
            if forces[-1] < 0.5 * load:
                times.append(times[-1] + (0.5 * load - forces[-1]) / rate)
                forces.append(0.5 * load)
            times.append(times[-1] + 0.02)
            forces.append(0.3 * load)
    time = np.arange(0.0, times[-1] + 0.01, 1.0 / RATE)
    scatter = noise * np.random.default_rng(seed).standard_normal(len(time))
    return time, np.interp(time, times, forces) + scatter


@pytest.mark.parametrize(
    ("ratio", "few", "many", "noise"), inside(12, (2, 8), (8, 20), (20, 40), (0, 0.1))
)
@pytest.mark.parametrize("upwards", [True, False])
def test_a_second_load_hides_no_slips(ratio, few, many, noise, upwards):
    """The smaller ones were noise: 15 cycles of 50; the break-away was of the other load."""
    loads, number = [1.0, ratio], [round(many), round(few)]
    if not upwards:
        loads, number = loads[::-1], number[::-1]
    time, force = stick_slip(loads, number, noise=noise * 0.2)
    found = st.analyse(st.Record(time=time, force=force, stiffness=STIFFNESS, drive_velocity=SPEED))
    assert found.cycles.sizes["cycle"] == pytest.approx(sum(number) - 1, abs=3)
    drops = found.parts["changes"]["drop"].values
    assert drops == pytest.approx(0.2 * np.array(loads), rel=0.25)
    first = found.friction.break_away
    assert first.force == pytest.approx(0.5 * loads[0], abs=0.03 + 0.3 * noise)
    assert any("analyse the two parts by themselves" in each for each in found.warnings)


def test_three_loads_have_a_part_each():
    time, force = stick_slip([1.0, 3.0, 9.0], [30, 12, 8], noise=0.01)
    found = st.analyse(st.Record(time=time, force=force, stiffness=STIFFNESS, drive_velocity=SPEED))
    assert found.parts["changes"]["number"].values == pytest.approx([30, 12, 8], abs=2)
    assert found.friction.break_away.force == pytest.approx(0.5, abs=0.03)


@pytest.mark.parametrize("frequency", [7.0, 20.0, 50.0])
def test_a_ripple_over_all_of_a_record_is_no_cycle_where_the_mass_slides(frequency):
    time, force = stick_slip([5.0], [20], noise=0.01)
    slides = np.full(4000, force[-1])
    time = np.arange(len(force) + len(slides)) / RATE
    ripple = 0.05 * np.sin(2.0 * np.pi * frequency * time)
    record = st.Record(time=time, force=np.append(force, slides) + ripple)
    assert st.analysis.find_cycles(record)["drop"].min() > 0.9
    assert st.analysis.find_cycles(record).sizes["cycle"] in (18, 19, 20)


def test_a_load_under_which_the_mass_slides_has_its_own_break_away():
    """The break-away was that of the second load, 2.5 N."""
    time, force = stick_slip([5.0], [20], noise=0.01)
    early = np.arange(0.0, 4.0, 1.0 / RATE)
    slides = np.minimum(early, 0.5) + 0.005 * np.cos(300.0 * early)
    time = np.arange(len(early) + len(force)) / RATE
    found = st.analyse(st.Record(time=time, force=np.append(slides, np.maximum(force, 0.5))))
    assert found.friction.break_away is None
    assert "stays at a lower level" in found.friction.missing["break_away"]
    assert any(each.startswith("Before 6.5") for each in found.warnings)


def test_a_build_up_is_not_a_part():
    growth = np.minimum(np.exp(0.2 * (np.arange(40.0) - 15.0)), 1.0)
    corners = np.stack([-growth, growth], axis=1).ravel()
    time = np.arange(0.0, 20.0, 4e-3)
    force = 2.0 + np.interp(time, 0.25 * np.arange(len(corners)), corners)
    cycles = st.analysis.find_cycles(st.Record(time=time, force=force))
    assert cycles["drop"].min() > 0.5 * cycles["drop"].median()


def cycles_of(time, force):
    return sizes.find_corners(time, force, turning_points(force))


def test_the_nearest_periods_tell_a_ripple():
    """Far away, where the mass slides, there is one; next to the smaller slips there is none."""
    time, force = stick_slip([5.0, 0.5], [60, 40])
    smaller = cycles_of(time[time > 62.0], force[time > 62.0])
    period = np.median(smaller.period)
    count = int(3.0 * sizes.ENOUGH * period * RATE)
    quiet = np.full(count, 1.5)
    ripple = 1.5 + 0.5 * np.median(smaller.drop) * np.sin(2.0 * np.pi * np.arange(count) / 25.0)
    force = np.concatenate([force, quiet, ripple])
    time = np.arange(len(force)) / RATE
    its = sizes.Larger(time, force, cycles_of(*stick_slip([5.0], [60])), [])
    edges = time[-2 * count], time[-count], time[-1]
    parts = [edges[:2], edges[1:]]
    assert not sizes._is_ripple(smaller, its, parts)
    assert sizes._is_ripple(smaller, its, parts[::-1])


def test_the_nearest_parts_are_looked_at_first(monkeypatch):
    time, force = stick_slip([5.0, 0.5, 5.0], [30, 30, 30])
    begin, end = time[force > 2.3][[0, -1]]
    middle = 0.5 * (begin + end)
    larger = cycles_of(*stick_slip([5.0], [30]))
    parts = [(0.0, 5.0), (5.0, middle - 9.0), (middle + 9.0, end - 5.0), (end - 5.0, end)]
    asked = []

    def note(cycles, its, parts):
        asked.extend(parts)
        return True

    monkeypatch.setattr(sizes, "_is_ripple", note)
    its = sizes.Larger(time, force, larger, parts)
    small = time[(force < 0.4) & (time > 5.0) & (time < end)][[0, -1]]
    assert sizes._smaller_cycles(its, *small) is None
    away = [max(part[0] - small[1], small[0] - part[1]) for part in asked]
    assert len(away) == len(parts)
    assert away == sorted(away)


def test_a_stretch_too_short_for_a_few_cycles_is_not_searched(monkeypatch):
    """46 000 were, in a record of 4 million readings, by which nothing could be found."""
    time, force = stick_slip([5.0, 0.5, 5.0], [30, 30, 30])
    larger, asked = cycles_of(time, force), []
    monkeypatch.setattr(sizes, "turning_points", lambda part: asked.append(len(part)))
    monkeypatch.setattr(sizes, "find_corners", lambda *_: larger)
    its = sizes.Larger(time, force, larger, [])
    least = FEW_CYCLES * FEWEST_PER_CYCLE
    for length in (least - 1, least):
        sizes._smaller_cycles(its, time[100], time[100 + length])
    assert asked == [least]
