"""``python -m benchmarks.explore.rigs``: random planar rigs against the readable reference.

Masses, dampers and springs in series with axes of their own, on isotropic surfaces and on a grain.
The reference solves the equations as they are, in the axes x and y; the solver does in axes
weighted by mass. What is held against the bound is the difference over the response, as in
`benchmarks.explore`. Deterministic in its seed; exit status 1 if a bound is broken.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
from rich.console import Console

import stiction as st
from benchmarks.explore.accuracy import BOUNDS, SHARES
from benchmarks.explore.rigs.comparison import Seen, look
from benchmarks.explore.rigs.drawing import rig
from benchmarks.report import show
from benchmarks.section import Section, Table

WORST = 5


def main() -> int:
    """Look at the rigs asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.rigs", description=__doc__)
    parser.add_argument("--systems", type=int, default=100, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", type=int, metavar="NUMBER", help="one rig, and what it is")
    options = parser.parse_args()
    if options.only is not None:
        slider, duration, rtol = rig(options.seed, options.only)[:3]
        settings = st.Settings(duration=duration, rtol=rtol)
        print(st.Description(slider, st.Initial(), settings).to_json())
        print(look(options.seed, options.only))
        return 0
    with ProcessPoolExecutor(options.processes) as pool:
        seen = list(pool.map(partial(look, options.seed), range(options.systems)))
    found, keeps = section(seen)
    show(Console(), found)
    return 0 if keeps else 1


def section(seen: list[Seen]) -> tuple[Section, bool]:
    """Return what was seen of all rigs, and whether the bound is kept."""
    counted = [each for each in seen if not each.left_out]
    ratios, bound = np.array([each.off for each in counted]), BOUNDS["in steps"]
    broken = int((ratios > bound).sum())
    reasons = sorted({each.left_out for each in seen})
    count = [(why or "counted", sum(each.left_out == why for each in seen)) for why in reasons]
    rows = [(f"{share:.1%} below", float(np.quantile(ratios, share))) for share in SHARES]
    rows += [("bound", bound), ("rigs", len(counted)), ("above the bound", broken)]
    worst = sorted(counted, key=lambda each: -each.off)[:WORST]
    headings = ("number", "ratio", "law", "rtol", "response", "sticks")
    lines = [(str(a.number), a.off, a.law, a.rtol, a.response, str(a.sticks)) for a in worst]
    tables = [
        Table("Rigs", ("", "number"), count),
        Table("Difference from the reference over response", ("share of rigs", "ratio"), rows),
        Table("Worst rigs", headings, lines),
    ]
    note = "one rig again, with its description: --only NUMBER"
    return Section("Random planar rigs", tables, [note]), not broken and bool(counted)


if __name__ == "__main__":
    sys.exit(main())
