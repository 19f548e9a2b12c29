"""Runs that many tests look at, computed once."""

import os

import pytest
from hypothesis import HealthCheck, settings

import stiction as st

# the same examples each time, whatever was found before and however slow the machine is; random
# exploration has commands of its own, in benchmarks.explore
settings.register_profile(
    "fixed",
    derandomize=True,
    database=None,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("fixed")
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
