"""The loop in steps against what the processor can do: operations, their longest chain, time.

Every number of a run in plain Python notes how many operations made it, and when it could be ready
if each operation began as soon as its operands are: the longest chain of dependent ones. Branches
cost nothing there, as if all were predicted. The processor's times of each operation are measured.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from math import exp, sqrt
from time import perf_counter
from typing import Any

from rich.progress import Progress

from benchmarks.section import Cell, Section, Table
from stiction.solver.compilation.part import ARITHMETIC, njit

RTOLS = (1e-3, 1e-6, 1e-9)
DURATION = 0.03  # s, of Fig. 3 in plain Python: some 30 cycles
CHAIN, ROUNDS, SIDE_BY_SIDE = 2_000_000, 5, 8
KINDS = ("* +", "+", "*", "/", "sqrt", "exp")
TRACE = """
import json, math, sys
NS = json.loads(sys.argv[1])
COUNTS = dict.fromkeys([*NS, "compared"], 0)

class Traced(float):
    def __new__(cls, value, at=0.0, began=None):
        made = float.__new__(cls, value)
        made.at, made.began = at, began  # when a product's factors were there
        return made

def ready(kind, value, *operands):
    began = max(getattr(each, "at", 0.0) for each in operands)
    COUNTS[kind] += 1
    return Traced(value, began + NS[kind], began if kind == "*" else None)

def add(value, a, b):  # to a product: one operation, which begins when all three are there
    for one, other in ((a, b), (b, a)):
        if getattr(one, "began", None) is not None:
            COUNTS["*"] -= 1
            COUNTS["* +"] += 1
            began, one.began = max(one.began, getattr(other, "at", 0.0)), None
            return Traced(value, began + NS["* +"])
    return ready("+", value, a, b)

def operator(name, plain):
    def work(a, b):
        if not isinstance(b, (int, float)):
            return NotImplemented
        value = plain(a, b)
        if "add" in name or "sub" in name:
            return add(value, a, b)
        divides = "div" in name and isinstance(a if "rt" in name else b, Traced)
        return ready("/" if divides else "*", value, a, b)  # by a constant, it is a product
    return work

def function(kind, plain):
    return lambda x: ready(kind, plain(x), x) if isinstance(x, Traced) else plain(x)

for name in ("add", "sub", "mul", "truediv"):
    for each in (f"__{name}__", f"__r{name}__"):
        setattr(Traced, each, operator(each, getattr(float, each)))
Traced.__neg__ = lambda x: Traced(float.__neg__(x), x.at)
Traced.__abs__ = lambda x: Traced(float.__abs__(x), x.at)
for name in ("__lt__", "__le__", "__gt__", "__ge__"):
    def compare(a, b, plain=getattr(float, name)):
        COUNTS["compared"] += 1
        return plain(a, b)
    setattr(Traced, name, compare)
math.sqrt, math.exp = function("sqrt", math.sqrt), function("exp", math.exp)

import stiction as st
from stiction.solver.exact.method import Exact
from stiction.solver.state import Motion, State

begin, advance, ends = Exact.begin, Exact.advance, []

def begin_traced(self, description):
    state = begin(self, description)
    return State(Motion(*map(Traced, state.motion)), state.memory, state.counts)

def advance_traced(self, *arguments):
    code, state = advance(self, *arguments)
    ends.append(state)
    return code, state

Exact.begin, Exact.advance = begin_traced, advance_traced
st.simulate(st.presets.nakano_popov_2020(), float(sys.argv[2]), sample_rate=0,
            rtol=float(sys.argv[3]), multiscale=False)
steps, last = ends[-1].counts.steps, ends[-1].motion
print(json.dumps({"counts": {kind: n / steps for kind, n in COUNTS.items()},
                  "chain": max(getattr(each, "at", 0.0) for each in last) / steps}))
"""
HEADINGS = (
    "rtol",
    *(f"{kind} a step" for kind in KINDS),
    "compared",
    "operations one by one (ns)",
    "side by side (ns)",
    "longest chain (ns)",
    "measured (ns a step)",
)
NOTES = (
    "Fig. 3 in steps. One by one: each operation waits for the one before it. Side by side: "
    "operations as fast as the processor begins them, if none waited; scalar ones, since the "
    "steps of one run follow each other. An addition to a product is one, a division by a "
    "constant a multiplication. What the compiler finds twice it computes once, which is not seen. "
    "Longest chain: no run can be faster than that.",
)


def run(progress: Progress, quick: bool) -> Section:
    """Return operations a step, bounds of its time, and its time."""
    rtols = RTOLS[:2] if quick else RTOLS
    task = progress.add_task("roofline", total=len(rtols) + 1)
    waits, begins = times_of_operations()
    progress.advance(task)
    rows: list[tuple[Cell, ...]] = []
    for rtol in rtols:
        found = trace(waits, rtol)
        counts = found["counts"]
        bounds = (sum(counts[kind] * times[kind] for kind in KINDS) for times in (waits, begins))
        each = (round(counts[kind], 1) for kind in (*KINDS, "compared"))
        rows.append((rtol, *each, *bounds, found["chain"], time_of_step(rtol)))
        progress.advance(task)
    operations = [(kind, waits[kind], begins[kind]) for kind in KINDS]
    headings = ("operation", "until the next can use it (ns)", "until the next can begin (ns)")
    return Section(
        "Roofline",
        (Table("A step", HEADINGS, rows), Table("This processor", headings, operations)),
        NOTES,
    )


def trace(waits: dict[str, float], rtol: float) -> dict[str, dict[str, float]]:
    """Return operations a step, and their longest chain (ns a step)."""
    command = [sys.executable, "-c", TRACE, json.dumps(waits), str(DURATION), str(rtol)]
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=plain)
    found: dict[str, dict[str, float]] = json.loads(done.stdout.splitlines()[-1])
    return found


def time_of_step(rtol: float) -> float:
    """Return the time of a step, ns."""
    import stiction as st

    slider, best = st.presets.nakano_popov_2020(), float("inf")
    for _ in range(ROUNDS):
        start = perf_counter()
        run = st.simulate(slider, 2.0, sample_rate=0, rtol=rtol, multiscale=False)
        best = min(best, (perf_counter() - start) / run.statistics.steps)
    return 1e9 * best


def times_of_operations() -> tuple[dict[str, float], dict[str, float]]:
    """Return the times (ns) until an operation's result can be used, and until another begins."""
    chains = {
        "* +": lambda x: x * 0.999999 + 1e-3,
        "+": lambda x: x + 1e-3,
        "*": lambda x: x * 0.999999,
        "/": lambda x: 1.000001 / x,
        "sqrt": lambda x: sqrt(x),
        "exp": lambda x: exp(-x),
    }
    waits, begins = {}, {}
    for kind, operation in chains.items():
        one, many = chain_of(njit(operation, inline="always", **ARITHMETIC))
        waits[kind], begins[kind] = fastest(one), fastest(many) / SIDE_BY_SIDE
    return waits, begins


def chain_of(operation: Any) -> tuple[Any, Any]:
    """Return loops of one chain of an operation, and of several side by side."""

    @njit(**ARITHMETIC)
    def one(n: int, x: float) -> float:
        for _ in range(n):
            x = operation(x)
        return x

    @njit(**ARITHMETIC)
    def many(n: int, x: float) -> float:
        a, b, c, d, e, f, g, h = x, x + 0.1, x + 0.2, x + 0.3, x + 0.4, x + 0.5, x + 0.6, x + 0.7
        for _ in range(n):
            a, b, c, d = operation(a), operation(b), operation(c), operation(d)
            e, f, g, h = operation(e), operation(f), operation(g), operation(h)
        return a + b + c + d + e + f + g + h

    return one, many


def fastest(loop: Any) -> float:
    """Return the shortest time of a turn of a loop, ns."""
    loop(1, 0.7)
    best = float("inf")
    for _ in range(ROUNDS):
        start = perf_counter()
        loop(CHAIN, 0.7)
        best = min(best, perf_counter() - start)
    return 1e9 * best / CHAIN
