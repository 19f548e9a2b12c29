"""Parts of compiled code, to be called from a test."""

from dis import get_instructions
from functools import cache
from types import FunctionType

import numba
from numba.extending import _Intrinsic

from stiction.solver.compilation import pointer
from stiction.solver.exact.loop import advance
from stiction.solver.multiscale.return_map import empty_map


def entry(part):
    """Return what Python can call in place of `part`, which compiled code alone can call."""
    return numba.njit(lambda *arguments: part(*arguments))


@cache
def plain(part):
    """Return `part` as the Python that it is written in, with all parts that it calls.

    That costs no compiling. That compiled code does the same is held by whole runs. A pointer to a
    law is the law itself, and the address of a function is the plain function.
    """
    if isinstance(part, _Intrinsic):
        return itself if part is pointer.pointee else call
    function = getattr(part, "py_func", None)
    if function is None:  # nothing is compiled
        return part
    scope, code = dict(function.__globals__), function.__code__
    used = {each.argval for each in get_instructions(code) if each.opname == "LOAD_GLOBAL"}
    scope |= {name: plain(scope[name]) for name in used if is_compiled(scope.get(name))}
    return FunctionType(code, scope, code.co_name, function.__defaults__)


def is_compiled(value):
    """Return whether a value is a compiled function, or works on pointers in compiled code."""
    return hasattr(value, "py_func") or isinstance(value, _Intrinsic)


def itself(law):
    return law


def call(function, first, others):
    return function(first, *others)


def map_of(rtol, samples=False):
    """Return an empty map, of cycles in steps of plain Python."""
    return empty_map(rtol, plain(advance), samples)
