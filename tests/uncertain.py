"""A rig whose description states what is uncertain, and records and simulations of it, for fits."""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import numpy as np
import pytest

import stiction as st
from stiction.inference.mechanism.odds import SHARE
from stiction.inference.next_test import further
from stiction.inference.simulated.jitter import Jitter, move

TEXT = """
[slider]
mass = "80 g"
k_x = "2.3 +- 0.1 kN/m"
k_y = {value = "0.9 MN/m", uncertainty = "10 %"}
phi = {low = "0.5 deg", high = "5 deg", scale = "log"}
normal_load = "4 N"

[friction]
law = "exponential-weakening"
mu_0 = {low = 0.5, high = 0.75}
mu_inf = {low = 0.25, high = 0.5}
v_f = "10 mm/s"

[drive]
velocity = "0.5 mm/s"
"""

SIMULATIONS = 512  # whole blocks, enough for a fit, and a quarter of them for each mechanism
BOTH = ("force", "force_across")
CYCLES = 6  # of each record of a design: few, to see that it works
ASKED = {"angles": ["3 deg"], "velocities": ["1 m/s"], "loads": ["1 kN"], "simulations": 200}


def record_of(
    slider: st.Slider, seed: int, duration: float = 13.0, *, drift: float = 0.0, channels=BOTH
) -> st.Record:
    """Return a record of some jittered cycles, with noise of 0.2 % of the friction force."""
    random = np.random.default_rng(seed)
    times = np.arange(0.0, duration, 0.01)
    motion = move(slider, times, Jitter(0.005, 0.5, drift), random, cycle=1.4)
    noise = 0.004 * random.standard_normal((2, len(motion.time)))
    forces = np.array([slider.k_x, slider.k_y]) * motion.rows[:, :2] + noise.T
    measured = dict(zip(BOTH, forces.T, strict=True))
    return st.Record(
        time=motion.time, drive_velocity=0.5e-3, normal_load=4.0,
        **{name: measured[name] for name in channels},
    )  # fmt: skip


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


def wait_for(lock: IO[str]) -> None:
    """Wait until no other worker has it; on Windows, which lacks it, all make the same."""
    with contextlib.suppress(ImportError):
        from fcntl import LOCK_EX, flock

        flock(lock, LOCK_EX)


@contextlib.contextmanager
def shared_folder(name: str, factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Make a folder that one worker fills in the ``with`` block, and for which the others wait."""
    own = factory.getbasetemp()
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / name
    folder.mkdir(exist_ok=True)
    with folder.with_suffix(".lock").open("w") as lock:
        wait_for(lock)
        yield folder


@pytest.fixture(scope="session")
def libraries(record: st.Record, rig: st.Rig, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulations for audits of that record."""
    with shared_folder("libraries", tmp_path_factory) as folder:
        st.fit(record, rig, simulations=SIMULATIONS, library=folder)
        st.mechanism(record, rig, simulations=SIMULATIONS // SHARE, library=folder)
    return folder


@pytest.fixture(scope="session")
def designed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulations for designs of that rig, in records of `CYCLES`."""
    with (
        shared_folder("designs", tmp_path_factory) as folder,
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.setattr(further, "CYCLES", CYCLES)
        st.design(TEXT, library=folder, **ASKED)
    return folder


def copy_blocks(folder: Path, own: Path) -> None:
    """Copy simulations to a folder of its own, without what was found in them."""
    shutil.copytree(folder, own, ignore=shutil.ignore_patterns("tests-*"), dirs_exist_ok=True)
