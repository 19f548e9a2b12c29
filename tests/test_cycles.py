"""Cycles are found as they are, whatever the noise, the drift, the sample rate or the unit."""

from __future__ import annotations

import numpy as np
import pytest

import stiction as st
from stiction.analysis.record import record_of


def test_every_cycle_of_the_paper_is_the_same(paper_run: st.Trajectory) -> None:
    cycles = st.find_cycles(record_of(paper_run))
    assert cycles.sizes["cycle"] == 3
    # reference: rtol = 1e-10, samples at 100 kHz; README and shared notes have the same digits
    assert cycles["peak"].values == pytest.approx(np.full(3, 1.9925951), rel=1e-4)
    assert cycles["trough"].values == pytest.approx(np.full(3, 1.1685930), rel=1e-4)
    assert cycles["period"].values == pytest.approx(np.full(3, 0.9150646), rel=1e-4)
