"""A regular wave under cycles is named, and what only wanders is none."""

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.wave import regular_wave

WAVES = inside(16, (-0.8, 1.0), (4.5, 12.0), (4.0, 20.0), (0.0, 0.15))


@pytest.mark.parametrize(("decade", "turns", "each", "irregular"), WAVES)
def test_a_wave_under_stick_slip_is_named_with_its_height_and_period(
    decade, turns, each, irregular
):
    """Of a sixth of the drop to ten times that."""
    height, count = 10**decade, int(turns * each)
    random = np.random.default_rng(1)
    rises = 1.0 + min(irregular, 0.5 * height) * random.standard_normal(count)
    corners = np.concatenate([[0.0], np.cumsum(np.stack([rises, np.full(count, 0.05)], 1))])
    force = np.append(np.stack([np.zeros(count), rises], axis=1), 0.0)
    time = np.arange(0.0, corners[-1], 0.01)
    wave = 0.5 * height * np.sin(2.0 * np.pi * turns * time / time[-1] + 1.0)
    noise = 0.003 * random.standard_normal(len(time))
    found = st.analyse(
        st.Record(time=time, force=10.0 + np.interp(time, corners, force) + wave + noise)
    )
    assert found.regime.kind == "stick-slip"
    assert found.regime.evidence["wave"] == pytest.approx(height, rel=0.2)
    assert "from crest to trough" in str(found)
    if "wave_period" in found.regime.evidence:
        period = time[-1] / turns
        assert found.regime.evidence["wave_period"] == pytest.approx(period, rel=0.04)


@pytest.mark.parametrize("remembers", [0.0, 0.6, 0.9, 0.97, 1.0])
def test_friction_that_wanders_is_no_wave(remembers):
    """In 40 records each, of 18 to 300 cycles, whose middles remember the ones before."""
    for number in range(40):
        random = np.random.default_rng([7, number])
        count = int(random.integers(18, 300))
        middle = np.zeros(count)
        for k, step in enumerate(random.standard_normal(count)):
            middle[k] = remembers * middle[k - 1] + step
        time = np.cumsum(1.0 + 0.1 * random.random(count))
        drop = np.ones(count)
        columns = {"peak_time": time, "trough_time": time + 0.1, "drop": drop, "start": time}
        columns |= {"peak": middle + 0.5, "trough": middle - 0.5}
        assert regular_wave(CycleTable(columns, 0.0)) is None
