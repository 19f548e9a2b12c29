"""``python -m benchmarks.explore.rotation``: whether the friction force turns, by the force across.

Random rigs whose friction weakens, evolves (rate and state), yields before it slips (LuGre) or has
a peak at rest are recorded with a force across: with noise, a zero that is stated or not, drift,
steps. Each conclusion is held against the noise-free path, and each number against its error.
Exit status 1 if a conclusion is wrong, or less than 90 % of a number's intervals hold it.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter, defaultdict

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.explore.misalignment import COVERED
from benchmarks.explore.rotation.judgement import Judged, look

SURE = 2.0  # standard errors


def main() -> int:
    """Look at as many rigs as are asked for; return 1 if a bound is broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.rotation")
    parser.add_argument("--rigs", type=int, default=100, help="of which something is said")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    seen, number = list[Judged](), 0
    while len(seen) < options.rigs:
        one = look(np.random.default_rng([options.seed, number]))
        number += 1
        if one is not None:
            seen.append(one)
    return report(Console(), seen)


def report(console: Console, seen: list[Judged]) -> int:
    """Say what was seen; return 1 if a bound is broken."""
    conclusions = Table("true", "told", "rigs", "wrong")
    for (true, told), count in sorted(Counter((each.true, each.told) for each in seen).items()):
        wrong = sum(not each.right for each in seen if (each.true, each.told) == (true, told))
        conclusions.add_row(true, told, f"{count}", f"{wrong}")
    console.print(conclusions)
    by_name = defaultdict[str, list[float]](list)
    for each in seen:
        for name, error in each.errors.items():
            by_name[name].append(error)
    numbers, least = Table("number", "told", "within 2 errors", "worst"), 1.0
    for name, errors in by_name.items():
        held = float(np.mean(np.array(errors) <= SURE))
        least = min(least, held)
        numbers.add_row(name, f"{len(errors)}", f"{held:.0%}", f"{max(errors):.1f}")
    console.print(numbers)
    return int(least < COVERED or not all(each.right for each in seen))


if __name__ == "__main__":
    sys.exit(main())
