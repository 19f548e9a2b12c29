"""The loop in steps as the map calls it: at the address of its machine code.

So it is compiled once, for runs in steps and for the map; and both are the same to the last bit.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.interrupt import compiling
from stiction.solver.compilation.jit import INTERPRETED, inlined
from stiction.solver.compilation.pointer import address_of, caller_of, typeof, types
from stiction.solver.exact.loop import advance
from stiction.solver.exact.record import record_of
from stiction.solver.multiscale.return_map import Returns
from stiction.solver.problem import Problem, System, kinds_of
from stiction.solver.state import State, start, state_from_plain

_state = start(System(*[1.0] * len(System._fields)), 0.0, (0.0, 0.0), (0.0, 0.0))
_row, _table = np.empty(0), np.empty((0, 0))
KINDS = tuple(  # types of the arguments of `exact.loop.advance`, but for the problem's
    typeof(each)
    for each in (
        _state,
        0.0,
        Accuracy(*[0.0] * len(Accuracy._fields)),
        0,
        _row,
        _table,
        0,
        _table,
        record_of(0),
    )
)
PLAIN = typeof(tuple(map(tuple, _state)))
call: Any = caller_of(types.Tuple((types.int64, PLAIN, types.int64, types.int64)), *KINDS)


_addresses: dict[tuple[Any, ...], Any] = {}


def kinds_of_steps(problem: Problem) -> tuple[Any, ...]:
    """Return the types of the arguments of `exact.loop.advance`."""
    return typeof(problem), *KINDS


def address_of_steps(problem: Problem) -> Any:
    """Return the address of the loop in steps, compiled for a problem of this type."""
    if INTERPRETED:
        return advance
    kinds = kinds_of(problem)
    if kinds not in _addresses:
        with compiling():
            _addresses[kinds] = address_of(advance, *kinds_of_steps(problem))
    return _addresses[kinds]


@inlined
def take_steps(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
    known: Returns,
) -> tuple[int, State, int, int]:
    """Do the work of `exact.loop.take_steps`; the map's record stores the steps."""
    others = state, t_end, accuracy, budget, times, samples, k, sticks, known.record
    code, now, k, turns = call(known.steps, problem, others)
    return code, state_from_plain(now), k, turns
