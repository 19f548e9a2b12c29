"""``python -m benchmarks.harness.worker MODULE``: the process of one library.

It says which rows the module's ``contestants()`` are, then answers one request a line, in JSON:
solve a row for so many points in time over so many seconds, and say how long that took. Only NumPy
is needed beside the library itself.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
from math import inf
from time import perf_counter

import numpy as np

from benchmarks.harness.contestant import Contestant, Failed

MOMENT = 0.02  # s


def main() -> None:
    """Answer requests until there are no more."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what a library prints must not be taken for an answer

    def say(answer) -> None:
        print(json.dumps(answer), file=answers, flush=True)

    try:
        contestants = importlib.import_module(sys.argv[1]).contestants()
    except ImportError as problem:
        say({"missing": str(problem)})
        return
    except Exception as problem:  # say, no C compiler
        say({"failed": f"{type(problem).__name__}: {problem}"})
        return
    say({"rows": [[row.solver, row.settings] for row in contestants]})
    for line in sys.stdin:
        request = json.loads(line)
        try:
            times = np.linspace(0.0, request["duration"], request["points"])
            say({"seconds": time_contestant(contestants[request["row"]], times, request["into"])})
        except Failed as reason:
            say({"failed": str(reason)})
        except Exception as problem:  # of whatever kind: a library's, on its row
            say({"failed": f"{type(problem).__name__}: {problem}"})


def time_contestant(contestant: Contestant, times, into: str | None) -> float:
    """Return how long a contestant takes, s; its elongations go to a file if one is named.

    One that takes less than a moment goes on until that is over, and its shortest time counts: a
    first run finds the processor's caches full of what ran before.
    """
    shortest, until = inf, perf_counter() + MOMENT
    while perf_counter() < until:
        start = perf_counter()
        found = contestant.solve(times)
        shortest = min(shortest, perf_counter() - start)
    if into is not None:
        np.save(into, found)
    return shortest


if __name__ == "__main__":
    main()
