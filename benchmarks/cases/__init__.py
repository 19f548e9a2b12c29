"""Cases with a known solution: exact, or published, or agreed on by two methods.

They are written once: the benchmark lists their errors at several tolerances, and the test suite
asks that they agree to the digits given.
"""

from itertools import chain

from benchmarks.cases import belt, oscillator, paper, published, rate_and_state, steady, transverse
from benchmarks.cases.case import Case

# each with what it shares with nobody before it: run side by side, hardly anything compiles twice
GROUPS: tuple[tuple[Case, ...], ...] = (
    paper.CASES,
    published.CASES,
    rate_and_state.CASES,
    oscillator.CASES,
    belt.CASES,
    steady.CASES,
    transverse.CASES,
)
CASES: tuple[Case, ...] = tuple(chain.from_iterable(GROUPS))
