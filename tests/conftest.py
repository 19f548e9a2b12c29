"""Runs that many tests use, computed once."""

import fcntl
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.uncertain import SIMULATIONS, TEXT, record_of

import stiction as st
from stiction.inference.mechanism.comparison import SHARE
from stiction.solver.compilation import machine_code

os.environ["DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT"] = "30m"  # not 30 s: the machine may be busy


@pytest.fixture(autouse=True)
def close_figures() -> Iterator[None]:
    """Close what a test has drawn: matplotlib warns of the 21st open figure, whoever made it."""
    yield
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
    for kept in full.glob("stiction.solver.exact.loop.steps-*"):
        shutil.copy(kept, place)
    return tmp_path / "cache"


@pytest.fixture(scope="session")
def rig() -> st.Rig:
    """A rig of which some things are uncertain."""
    return st.Rig.from_toml(TEXT)


@pytest.fixture(scope="session")
def record_file(rig: st.Rig, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A record of that rig, misaligned by 2.5 deg: ms and mN."""
    path = tmp_path_factory.mktemp("record") / "data.csv"
    record = record_of(rig.slider.replace(phi="2.5 deg"), 7, channels=("force",))
    rows = zip(1e3 * record.time, 1e3 * record.force, strict=True)
    path.write_text("t,F\n" + "".join(f"{t:.1f},{f:.3f}\n" for t, f in rows))
    return path


@pytest.fixture(scope="session")
def record(record_file: Path) -> st.Record:
    said = {"drive_velocity": "0.5 mm/s", "normal_load": "4 N"}
    return st.read_record(record_file, time="t=ms", force="F=mN", **said)


@pytest.fixture(scope="session")
def libraries(record: st.Record, rig: st.Rig, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulations for audits of that record; one worker makes them, and the others wait for it."""
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "libraries"
    folder.mkdir(exist_ok=True)
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        st.fit(record, rig, simulations=SIMULATIONS, library=folder)
        st.mechanism(record, rig, simulations=SIMULATIONS // SHARE, library=folder)
    return folder
