"""Parts: compiled as numba compiles any function, in less time, and the same wherever they are."""

import operator
import os
import re
import subprocess
import sys
from itertools import product
from math import hypot, nan
from pathlib import Path

import numba
import numpy as np
import pytest
from tests.entry import entry

from stiction.solver.compilation import jit
from stiction.solver.compilation.passes import Remembering

ROOT = Path(__file__).parents[4]
NUMBERS = [True, 2, 3.5, np.int64(-7), np.float64(0.3)]


def operations(a, b):
    """Return what each operator makes of two numbers."""
    return (
        a + b,
        a / b,
        a // b,
        a % b,
        a**b,
        a < b,
        a == b,
        max(a, b, 2.5),
        min(a, b),
        abs(a) + abs(b),
        bool(a) + (not b),
        a**2 - b**3,
        (int(a) << 2) + (int(b) >> 1) & 13 | 6 ^ int(a),
    )


def branches(a, b):
    """Return a value over branches, a loop, a tuple and a literal index."""
    pair = (a, b)
    total = 0.0
    for k in range(4):
        if k % 2:
            total += pair[0] * k
        elif k > 2:
            total -= pair[1]
        else:
            total = max(total, pair[1] ** 2)
    while total > 10.0:
        total *= 0.5
    return total, k


@pytest.mark.skipif(jit.INTERPRETED, reason="nothing is compiled")
def test_operators_keep_the_types_that_numba_gives_them():
    part, own = entry(jit.inlined(operations)), numba.njit(error_model="numpy")(operations)
    for a in NUMBERS:
        for b in NUMBERS:
            found, expected = part(a, b), own(a, b)
            assert [*map(type, found)] == [*map(type, expected)]
            np.testing.assert_equal(found, expected)  # NaN is NaN


def ends(a, b, c):
    """Return the smallest and the largest of some numbers."""
    return min(a, b, c), max(a, b, c), min(b, a), max(*(c, b))


@pytest.mark.skipif(jit.INTERPRETED, reason="nothing is compiled")
def test_the_smallest_and_the_largest_are_those_of_python():
    part = entry(jit.piece(ends))
    for numbers in product((-0.0, 0.0, 1.5, nan, -3, np.int64(2)), repeat=3):
        found, expected = part(*numbers), ends(*numbers)
        np.testing.assert_array_equal(np.array(found, float), np.array(expected, float))


@pytest.mark.skipif(jit.INTERPRETED, reason="nothing is compiled")
def test_machine_code_does_not_depend_on_what_was_compiled_before():
    """numba compiles the smallest of numbers with the options of what asks for it first.

    So the solver's code, and the last bits of its results, were others after another law's.
    """
    part = jit.piece(lambda a, b: min(a, b) + max(a, b, 1.0))
    assert entry(part)(0.5, 2.0) == 2.5
    (made,) = part.overloads.values()
    assert not re.findall(r"call[^@]*@[^(]*(?:ol_min|ol_max)", str(made.library._final_module))


@pytest.mark.parametrize(("a", "b"), [(1.5, 2.0), (-3.0, 0.1), (20.0, 1.0)])
def test_branches_loops_and_tuples(a, b):
    assert entry(jit.piece(branches))(a, b) == branches(a, b)


@pytest.mark.skipif(jit.INTERPRETED, reason="nothing is compiled")
def test_a_separate_part_stays_separate_where_it_is_called_by_an_inlined_one():
    """numba hands the demand to inline down to all that a function calls, unless they refuse it.

    Before they did, the multiscale loop held four copies of the solver: 42 s to compile for 13.
    """
    separate = jit.piece(lambda x: x * x + 1.0)
    merged = jit.inlined(lambda x: separate(x) - separate(2.0 * x))
    assert entry(merged)(3.0) == 10.0 - 37.0
    for part, inline in ((separate, False), (merged, True)):
        (made,) = part.overloads.values()
        assert made.fndesc.inline is inline


def size(x):
    """Return the magnitude of a number, by a function of numba's own."""
    return hypot(x, 0.0)


def called_for_nothing(x, part):
    """Call a part in a branch that folding removes."""
    return part(x) if x != x and x == x else x


@pytest.mark.skipif(jit.INTERPRETED, reason="nothing is compiled")
@pytest.mark.parametrize("make", [numba.njit, jit.make_entry], ids=["numba's own", "ours"])
def test_what_several_parts_call_is_there_once_and_for_all_of_them(make):
    """LLVM leaves out what nothing calls when it is merged, also if something calls it later."""
    part = jit.inlined(size)
    first = jit.inlined(lambda x: called(x, part))
    called = jit.inlined(called_for_nothing)
    second = jit.piece(lambda x: part(x) + part(x + 1.0))
    whole = make(lambda x: first(x) + second(x) + first(x - 1.0))
    assert whole(-3.0) == -3.0 + (3.0 + 2.0) - 4.0


def test_an_operator_is_typed_once():
    asked = []

    class Context:
        def resolve_function_type(self, function, args, kws):
            asked.append(args)
            return numba.core.typing.signature(args[0], *args)

    context = Remembering(Context(), {})
    add = numba.types.Function(
        type("Sum", (numba.core.typing.templates.AbstractTemplate,), {"key": operator.add})
    )
    number, array = numba.types.float64, numba.types.float64[:]
    for _ in range(3):
        context.resolve_function_type(add, (number, number), {})
        context.resolve_function_type(add, (array, number), {})
    assert asked.count((number, number)) == 1
    assert asked.count((array, number)) == 3


@pytest.mark.skipif(jit.INTERPRETED, reason="nothing is compiled")
def test_code_just_compiled_and_code_loaded_agree_to_the_last_bit(tmp_path):
    """Two processes, of which the first compiles what the second loads.

    With numba's own pipeline a part within another stands twice in the first process, by itself and
    in what calls it, with sums rounded in different ways; then the second process found others.
    """
    command = [sys.executable, "-m", "tests.unit.solver.compilation.fresh"]
    place = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    compiled, loaded = (
        subprocess.run(command, env=place, cwd=ROOT, capture_output=True, text=True, check=True)
        for _ in range(2)
    )
    hits, *numbers = compiled.stdout.split()
    again, *same = loaded.stdout.split()
    assert (hits, again) == ("0", "1")
    assert len(set(numbers)) > 500
    assert same == numbers
