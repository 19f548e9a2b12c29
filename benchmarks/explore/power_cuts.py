"""``python -m benchmarks.explore.power_cuts``: the power fails while a study is written.

A study runs on a file system of its own, ext4 in a file. 4 to 8 s after it began the file system is
shut down by the system call for that, without another byte going out: what it finds when it is
mounted again is what a machine finds that lost its power. The study must then go on, and come out
as the undisturbed one. It needs Linux, and the right to mount. Exit status 1 if anything was lost.
"""

from __future__ import annotations

import argparse
import fcntl
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random

import xarray as xr

import stiction as st
from stiction.study.execution.sweep import Tally

SHUTDOWN, WITHOUT_FLUSH = 0x8004587D, 2  # EXT4_IOC_SHUTDOWN, EXT4_GOING_FLAGS_NOLOGFLUSH
SIZE = 256 * 2**20  # bytes of the file system
SIDES = (46, 46)  # runs along phi and along V: some 8 s on two threads
CHILD = """
import sys
import stiction as st
from stiction.study.execution.engines import Threads
study = st.Study.from_json(sys.argv[1])
say = lambda tally: print(".", flush=True)
st.sweep(study, sys.argv[2], engine=Threads(2), progress=say)
"""


def study() -> st.Study:
    """Return a study that takes longer than the power lasts."""
    base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration=8.0))
    axes = {
        "phi": st.Grid("0.5 deg", "10 deg", SIDES[0]),
        "drive.velocity": st.Grid("0.1 mm/s", "10 mm/s", SIDES[1], "log"),
    }
    return st.Study(base=base, axes=axes)


@contextmanager
def mount(image: Path, at: Path) -> Iterator[Path]:
    """Mount a file system that is a file."""
    subprocess.run(["mount", "-o", "loop,commit=1", image, at], check=True)
    try:
        yield at
    finally:
        subprocess.run(["umount", at], check=True)


def cut_power(made: st.Study, folder: Path, after: float) -> int:
    """Do a study until the power fails; return how many blocks it said were done."""
    command = [sys.executable, "-c", CHILD, made.to_json(), folder / "a.zarr"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as child:
        assert child.stdout is not None
        first = child.stdout.read(1)  # the study has begun
        time.sleep(after)
        handle = os.open(folder, os.O_RDONLY)
        fcntl.ioctl(handle, SHUTDOWN, struct.pack("I", WITHOUT_FLUSH))
        os.close(handle)
        child.send_signal(signal.SIGKILL)
        return (first + child.stdout.read()).count(b".")


def gone_on(made: st.Study, path: Path, undisturbed: xr.Dataset, said: int) -> str:
    """Go on with a study; return what is wrong with what comes out, or ''."""
    tallies: list[Tally] = []
    try:
        st.sweep(made, path, progress=tallies.append)
        found = xr.open_zarr(path).load()
    except Exception as error:
        return f"{type(error).__name__}: {error}".splitlines()[0][:120]
    if not found.identical(undisturbed):
        names = [str(n) for n in found.variables if not found[n].identical(undisturbed[n])]
        return f"differs in {', '.join(names)}"
    blocks = made.layout.tasks - len(tallies)
    return "" if blocks >= said else f"{said} blocks were said to be done, {blocks} were left"


def main() -> int:
    """Cut the power as often as asked for; return the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.explore.power_cuts", description=__doc__
    )
    parser.add_argument("--cuts", type=int, default=20, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of when")
    options = parser.parse_args()
    made, chance, wrong = study(), Random(options.seed), 0
    with tempfile.TemporaryDirectory() as name:
        room, image, at = Path(name), Path(name) / "image", Path(name) / "mounted"
        at.mkdir()
        st.sweep(made, room / "undisturbed.zarr")
        undisturbed = xr.open_zarr(room / "undisturbed.zarr").load()
        for number in range(options.cuts):
            after = chance.uniform(4.0, 8.0)
            image.unlink(missing_ok=True)
            with image.open("wb") as file:
                file.truncate(SIZE)
            subprocess.run(["mkfs.ext4", "-q", image], check=True)
            with mount(image, at):
                said = cut_power(made, at, after)
            with mount(image, at):
                fault = gone_on(made, at / "a.zarr", undisturbed, said)
            wrong += bool(fault)
            print(
                f"{number + 1}: after {after:.1f} s, {said} blocks: {fault or 'same'}",
                flush=True,
            )
    print(f"{options.cuts - wrong} of {options.cuts} studies went on and came out the same")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
