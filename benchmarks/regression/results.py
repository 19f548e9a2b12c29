"""The runs that are compared bit by bit, and the process that makes them in one tree.

Run as a script with the tree on PYTHONPATH: it prints a line for each run, its name and a digest of
all that it found. Only what is public is used, so that old revisions run too.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).parent.parent.parent))

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import system

SEED = 5
MOST = 50_000  # steps of a run
STATES = (
    st.laws.LuGre,
    st.laws.RateStateAgeing,
    st.laws.RateStateSlip,
    st.laws.RateStateAgeing2,
    st.laws.RateStateSlip2,
)


def runs() -> Iterator[tuple[str, dict[str, object]]]:
    """Yield 210 runs: a name, and the arguments of `simulate`."""
    for number in range(100):  # all laws without states
        drawn = system(SEED, number)
        common = {"slider": drawn.slider, "duration": drawn.duration, "rtol": drawn.rtol}
        common["multiscale"] = False
        rate = 500.0 / drawn.duration
        yield f"system {number}", common | {"sample_rate": rate}
        if number < 40:
            yield f"system {number}, multiscale", common | {"multiscale": True}
    for number in range(60):
        draw = Draw(SEED, 1000 + number)
        phi = f"{draw.between(0.5, 8.0)!r} deg"
        slider = st.presets.nakano_popov_2020().replace(phi=phi)
        common = {"duration": 0.4, "sample_rate": 2000.0, "multiscale": False}
        if number < 25:
            law = STATES[number % 5].like(0.5, draw.between(0.2, 0.4), draw.decades(1e-3, 1e-2))
            yield f"states {number}", common | {"slider": slider.replace(friction=law)}
        elif number < 50:
            yield f"program {number}", common | {"slider": add_program(draw, slider)}
        else:
            delta = draw.decades(1e-7, 1e-5)
            yield f"smoothed {number}", common | {"slider": slider, "regularisation": delta}
    for number in range(10):
        draw = Draw(SEED, 2000 + number)
        slider = add_tables(draw, st.presets.nakano_popov_2020())
        yield f"recorded {number}", {"slider": slider, "duration": 0.4, "sample_rate": 2000.0}


def add_program(draw: Draw, slider: st.Slider) -> st.Slider:
    """Return the slider with a program of the drive, of the load, or of both."""
    which, hertz = draw.between(0.0, 3.0), f"{draw.between(10.0, 80.0)!r} Hz"
    changes: dict[str, object] = {}
    if which < 2.0:
        pieces = [
            st.protocols.Constant(duration="50 ms"),
            st.protocols.Hold("20 ms"),
            st.protocols.Reversal("50 ms"),
        ]
        across = st.protocols.Modulation(f"{draw.between(0.01, 0.2)!r} mm/s", hertz)
        changes["drive"] = st.protocols.DriveProgram(
            velocity="1 mm/s", program=pieces, repeat=5, across=across
        )
        changes["driven"] = "plate" if draw.chance(0.5) else "spring"
    if which > 1.0:
        amplitude = f"{draw.between(0.1, 2.0)!r} N"
        changes["load"] = st.protocols.LoadProgram(
            modulation=st.protocols.Modulation(amplitude, hertz)
        )
    return slider.replace(**changes)


def add_tables(draw: Draw, slider: st.Slider) -> st.Slider:
    """Return the slider with a recorded drive, a recorded load, or both."""
    which, time = draw.between(0.0, 3.0), np.linspace(0.0, 0.3, 151)
    wave = 2.0 * np.pi * draw.between(5.0, 40.0) * time
    changes: dict[str, object] = {}
    if which < 2.0:
        x = 1e-3 * time + draw.decades(1e-7, 1e-5) * np.sin(wave)
        pieces = [st.protocols.Recorded(time, position=x), st.protocols.Hold()]
        changes["drive"] = st.protocols.DriveProgram(velocity="1 mm/s", program=pieces)
    if which > 1.0:
        load = st.protocols.RecordedLoad(time, 10.0 + draw.between(0.1, 2.0) * np.sin(wave))
        changes["load"] = st.protocols.LoadProgram(program=[load])
    return slider.replace(**changes)


def digest(arguments: dict[str, Any]) -> str:
    """Return what tells two runs apart that differ by a bit."""
    run = st.simulate(**arguments, max_steps=MOST)
    found = hashlib.sha256(repr((run.status, run.data.attrs.get("steps"))).encode())
    for name in sorted(map(str, run.data.data_vars)):
        found.update(name.encode() + run.data[name].values.tobytes())
    found.update(run.stick_intervals.tobytes())
    return found.hexdigest()[:16]


def main() -> None:
    """Print a line for each run."""
    for name, arguments in runs():
        print(f"{name}\t{digest(arguments)}", flush=True)


if __name__ == "__main__":
    main()
