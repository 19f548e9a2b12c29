"""Loops of a record whose drive was measured: turns are those of the displacement, despite noise.

Where a mass without inertia slides at mu W on a spring of stiffness k, a loop over L has the area
2 mu W (L - d) and the width L - d, with d = 2 mu W/k.
"""

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from tests.drawn import SEED

import stiction as st

FRICTION, LENGTH, SAMPLES = 2.0, 1e-2, 400  # N, m, of each leg
AT = np.arange(SAMPLES) / SAMPLES
LEGS = {
    "triangle": [AT, 1.0 - AT],
    "sine": [0.5 - 0.5 * np.cos(np.pi * AT), 0.5 + 0.5 * np.cos(np.pi * AT)],
    "dwells": [AT, np.ones(SAMPLES // 4), 1.0 - AT, np.zeros(SAMPLES // 4)],
}


def force_of_sliding(X, k, friction):
    """Return the force of a spring whose mass slides where the force reaches its friction."""
    force, mass = [], 0.0
    for x in X:
        mass = min(max(mass, x - friction / k), x + friction / k)
        force.append(k * (x - mass))
    return np.array(force)


@pytest.mark.parametrize("kind", sorted(LEGS))
def test_loops_of_a_measured_drive(kind):
    """To the noise of two ends of a loop, and of the force by chance, at five sigma; to a sample.

    The level is that of the largest and the smallest of a thousand samples: of noise, some four
    sigma each, of which half is the error of the level, and less than that over k in the width.
    """
    for number in range(12):
        draw = Draw(SEED, number)
        noise, shakes = draw.decades(1e-6, 2e-3) * LENGTH, draw.decades(1e-4, 1e-2) * FRICTION
        d = draw.decades(1e-3, 0.5) * LENGTH
        X = LENGTH * np.concatenate(3 * LEGS[kind])
        k = 2.0 * FRICTION / d
        force = force_of_sliding(X, k, FRICTION)
        scatter = np.random.default_rng([SEED, number]).normal(size=(2, len(X)))
        record = st.Record(
            time=1e-2 * np.arange(len(X)), force=force + shakes * scatter[0], normal_load=10.0,
            drive_position=X + noise * scatter[1] + draw.between(-1.0, 1.0),
        )  # fmt: skip
        found = st.analysis.hysteresis(record)
        assert len(found.loops) == 2
        step = float(np.abs(np.diff(X)).max())
        for loop in found.loops:
            ends = 2.0**0.5 * 5.0 * noise + step
            by_chance = 5.0 * shakes * float(np.sqrt(np.sum(np.diff(loop.travel) ** 2)))
            area = 2.0 * FRICTION * (LENGTH - d)
            assert loop.area == pytest.approx(area, abs=FRICTION * ends + by_chance)
            assert loop.width == pytest.approx(LENGTH - d, abs=2.0 * (ends + 4.0 * shakes / k))
            assert loop.friction == pytest.approx(0.2, abs=5.0 * shakes / 10.0)
            assert loop.closed


def test_the_program_comes_before_the_measured_drive():
    time = np.arange(0.0, 20.0, 1e-2)
    program = st.protocols.reversal_loops("1 mm/s", "5 mm", loops=1)
    record = st.Record(
        time=time, force=np.ones(len(time)), normal_load=10.0, drive_position=np.sin(time)
    )
    assert len(st.analysis.hysteresis(record).loops) == 3
    with pytest.raises(st.ResultError, match="does not turn twice"):
        st.analysis.hysteresis(record.before(0.1), program)
    assert len(st.analysis.hysteresis(record, program).loops) == 1
