"""Runs that many tests look at, computed once."""

import os

import pytest

import stiction as st

os.environ["DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT"] = "30m"  # not 30 s: the machine may be busy


@pytest.fixture(scope="session")
def slider() -> st.Slider:
    return st.presets.nakano_popov_2020()


@pytest.fixture(scope="session")
def paper_run(slider: st.Slider) -> st.Trajectory:
    """Fig. 3 at the default tolerance, sampled as in the issue."""
    return st.simulate(slider, 5.0, sample_rate=10e3)


@pytest.fixture(scope="session")
def sharp_run(slider: st.Slider) -> st.Trajectory:
    """Fig. 3 at a tolerance 1e6 times tighter, on the same samples."""
    return st.simulate(slider, 5.0, sample_rate=10e3, rtol=1e-12)
