"""The workloads that are timed in both trees, and the process that times them.

Run as a script with the tree to time on PYTHONPATH: for each line with a case's name that it reads,
it runs that case once and answers with the seconds it took. A case that this tree does not know is
answered with ``absent`` and the reason. Only what is public is used, so that old revisions run too.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable

import stiction as st


def paper(rtol: float) -> Callable[[], object]:
    """Fig. 3 over 5 s: sticks, slips and landings, nothing else."""
    slider = st.presets.nakano_popov_2020()
    return lambda: st.simulate(slider, 5.0, sample_rate=0.2, rtol=rtol, multiscale=False)


def sample_paper() -> Callable[[], object]:
    """The same, sampled at 10 kHz: dense output, and the labelled arrays."""
    slider = st.presets.nakano_popov_2020()
    return lambda: st.simulate(slider, 5.0, sample_rate=10e3, multiscale=False)


def law_with_state() -> Callable[[], object]:
    """Rate and state friction on the same apparatus."""
    law = st.laws.RateStateAgeing(a=0.01, b=0.015, D_c=1e-5, mu_star=0.2, V_star=1e-3)
    slider = st.presets.nakano_popov_2020().replace(friction=law)
    return lambda: st.simulate(slider, 5.0, sample_rate=0.2)


def program() -> Callable[[], object]:
    """A drive in pieces, shaken across: segments, and what is not constant in time."""
    pieces = [st.protocols.Constant(duration="0.2 s"), st.protocols.Reversal("0.2 s")]
    drive = st.protocols.DriveProgram(
        velocity="1 mm/s",
        program=pieces,
        repeat=5,
        across=st.protocols.Modulation("0.1 mm/s", "50 Hz"),
    )
    slider = st.presets.nakano_popov_2020().replace(drive=drive)
    return lambda: st.simulate(slider, 2.0, sample_rate=0.5)


def many() -> Callable[[], object]:
    """64 short runs, phi from 0.5 to 10 deg: what a call costs by itself."""
    base = st.presets.nakano_popov_2020()
    sliders = [base.replace(phi=f"{0.5 + 9.5 * i / 63} deg") for i in range(64)]
    return lambda: [st.simulate(slider, 0.02, sample_rate=50.0) for slider in sliders]


def start() -> Callable[[], object]:
    """A fresh process that is ready to simulate."""
    command = [sys.executable, "-c", "from stiction import Slider, simulate"]
    return lambda: subprocess.run(command, check=True, stdin=subprocess.DEVNULL)


CASES: dict[str, Callable[[], Callable[[], object]]] = {
    "Fig. 3, rtol=1e-6": lambda: paper(1e-6),
    "Fig. 3, rtol=1e-9": lambda: paper(1e-9),
    "Fig. 3, sampled at 10 kHz": sample_paper,
    "rate and state": law_with_state,
    "program of the drive": program,
    "64 short runs": many,
    "start of a process": start,
}


def main() -> None:
    """Time the cases named on standard input, line by line."""
    prepared: dict[str, Callable[[], object]] = {}
    for line in sys.stdin:
        name = line.rstrip("\n")
        try:
            if name not in prepared:
                prepared[name] = CASES[name]()
                prepared[name]()  # compiled, and warm
            begin = time.perf_counter()
            prepared[name]()
            answer = repr(time.perf_counter() - begin)
        except (AttributeError, ImportError, TypeError) as error:
            answer = f"absent {error}"
        print(answer, flush=True)


if __name__ == "__main__":
    main()
