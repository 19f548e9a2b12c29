"""Runs that many tests use, computed once."""

import os
import shutil
import sys
from functools import cache
from pathlib import Path
from threading import TIMEOUT_MAX

import pytest
from tests.uncertain import designed as designed
from tests.uncertain import libraries as libraries
from tests.uncertain import record as record
from tests.uncertain import record_file as record_file
from tests.uncertain import rig as rig

import stiction as st
from stiction.machine import CORES
from stiction.solver.compilation import ahead, machine_code
from stiction.study.execution import cores

if int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")) >= CORES:
    ahead.CORES = 1  # that of this worker: a second process would take that of another
    cores.LONG = TIMEOUT_MAX  # nor does long work start one

os.environ["DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT"] = "30m"  # not 30 s: the machine may be busy


def pytest_collection_finish() -> None:
    """Let all figures share the formulas that matplotlib has parsed: each would parse its own."""
    if mathtext := sys.modules.get("matplotlib.mathtext"):
        from matplotlib import textpath
        from matplotlib.backends import backend_agg

        parser = mathtext.MathTextParser
        parser._parse_cached = cache(parser._parse_cached.__wrapped__)
        textpath.MathTextParser = backend_agg.MathTextParser = cache(parser)


def pytest_runtest_teardown() -> None:
    """Close what a test has drawn: matplotlib warns of the 21st open figure, whoever made it."""
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")


@pytest.fixture(scope="session")
def slider() -> st.Slider:
    return st.presets.nakano_popov_2020()


@pytest.fixture(scope="session")
def paper_run(slider: st.Slider) -> st.Trajectory:
    """Fig. 3 at the default tolerance, with ten samples in each period of the fast oscillation."""
    return st.simulate(slider, 5.0, sample_rate=10e3)


@pytest.fixture(scope="session")
def sharp_run(slider: st.Slider) -> st.Trajectory:
    """Fig. 3 at a tolerance 1e6 times tighter, on the same samples."""
    return st.simulate(slider, 5.0, sample_rate=10e3, rtol=1e-12)


@pytest.fixture
def code_cache(slider: st.Slider, tmp_path: Path) -> Path:
    """A folder for machine code in which the solver is compiled, but no law."""
    st.simulate(slider, 1e-3)
    full = machine_code.folder()
    place = tmp_path / "cache" / full.name
    place.mkdir(parents=True, mode=0o700)
    for kept in full.glob("stiction.solver.exact.loop.advance-*"):
        shutil.copy(kept, place)
    return tmp_path / "cache"
