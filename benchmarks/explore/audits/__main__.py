"""``python -m benchmarks.explore.audits``: contradictions within audits of random rigs.

Each rig is audited, its page written, and what words, numbers, advice and linear theory say is held
against each other. Deterministic in its seed; exit status 1 if a rule is broken.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from time import process_time
from typing import NamedTuple

import stiction as st
from benchmarks.explore.audits.drawing import rig
from benchmarks.explore.audits.rules import RULES
from stiction.auditing.page import page


class Seen(NamedTuple):
    """What came of one audit: in a line, its time on a core (s), and the rules that it breaks."""

    number: int
    what: str
    seconds: float
    broken: tuple[str, ...]


def look(seed: int, number: int) -> Seen:
    """Audit one rig, write its page, and hold it against the rules."""
    slider, begin = rig(seed, number), process_time()
    name = type(slider.law).__name__
    fractions: list[float] = []
    try:
        found = st.audit(slider, progress=fractions.append)
        page(found, f"rig {number}")
    except Exception as error:
        return Seen(number, name, process_time() - begin, (f"{type(error).__name__}: {error}",))
    broken = [rule.__name__ for rule in RULES if not rule(found)]
    if fractions != sorted(fractions) or fractions[-1:] != [1.0]:
        broken.append("progress ends elsewhere than at 1")
    return Seen(number, f"{name}: {found!r}", process_time() - begin, tuple(broken))


def main() -> int:
    """Look at the rigs asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.audits")
    parser.add_argument("--rigs", type=int, default=40, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", type=int, metavar="NUMBER", help="print the audit of one rig")
    options = parser.parse_args()
    if options.only is not None:
        slider = rig(options.seed, options.only)
        print(slider.to_toml())
        print(st.audit(slider))
        return 0
    broken = 0
    with ProcessPoolExecutor(options.processes) as pool:
        for each in pool.map(partial(look, options.seed), range(options.rigs)):
            broken += len(each.broken)
            rules = "; ".join(each.broken)
            print(f"{each.number:4d} {each.seconds:6.1f} s  {each.what}  {rules}", flush=True)
    print(f"{options.rigs} rigs, {broken} rules broken")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
