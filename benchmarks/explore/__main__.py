"""``python -m benchmarks.explore``: thousands of random systems against what `simulate` promises.

Deterministic in its seed. With ``--keep FILE`` what was seen is kept, one line of JSON a system,
and the same command goes on where it was stopped. Exit status 1 if a bound is broken.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from functools import partial
from pathlib import Path

from rich.console import Console

import stiction as st
from benchmarks.explore.accuracy import DRAWN, Seen, look, section
from benchmarks.report import show

EVERY = 500  # systems between two looks at how far it is
CHUNK = 10  # systems handed to a process at a time


def main() -> int:
    """Look at the systems asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore", description=__doc__)
    parser.add_argument("--systems", type=int, default=1000, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--kind", choices=DRAWN, default="set-valued", help="of system to draw")
    parser.add_argument("--longer", type=float, default=1.0, help="times as long runs")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--keep", type=Path, help="file to keep what was seen in, or to go on with")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="one system, and what it is")
    options = parser.parse_args()
    if options.only is not None:
        return one(options.seed, options.only, options.longer, options.kind)
    console, seen = Console(), read_kept(options.keep)
    wanted = sorted(set(range(options.systems)) - {each.number for each in seen})
    with options.keep.open("a") if options.keep else nullcontext() as file:
        drawn = options.seed, wanted, options.longer, options.kind
        for each in looked_at(*drawn, options.processes):
            seen.append(each)
            if file is not None:
                print(json.dumps(each), file=file, flush=True)
            if len(seen) % EVERY == 0 and len(seen) < options.systems:
                show(console, section(seen)[0])
    found, keeps = section(seen)
    show(console, found)
    return 0 if keeps else 1


def read_kept(path: Path | None) -> list[Seen]:
    """Return what was seen before."""
    if path is None or not path.exists():
        return []
    rows = map(json.loads, path.read_text().splitlines())
    return [Seen(*row)._replace(off=tuple(row[4]), mapped=tuple(row[5])) for row in rows]


def looked_at(
    seed: int, numbers: Iterable[int], longer: float, kind: str, processes: int
) -> Iterator[Seen]:
    """Yield what is seen of each system, in order."""
    with ProcessPoolExecutor(processes) as pool:
        yield from pool.map(partial(look, seed, longer=longer, kind=kind), numbers, chunksize=CHUNK)


def one(seed: int, number: int, longer: float, kind: str) -> int:
    """Print one system and what is seen of it."""
    drawn = DRAWN[kind](seed, number)
    settings = st.Settings(
        duration=longer * drawn.duration, rtol=drawn.rtol, regularisation=drawn.delta
    )
    print(st.Description(drawn.slider, drawn.start or st.Initial(), settings).to_json())
    print(look(seed, number, longer, kind))
    return 0


if __name__ == "__main__":
    sys.exit(main())
