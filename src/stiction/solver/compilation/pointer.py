"""Code and data behind pointers, so that one compiled solver serves all laws.

A law is two addresses: that of a function's machine code, and that of the law's fields. Compiled
code calls the one with the other, in some 2 ns, and is the same for all laws; if laws were inlined,
each would need its own compilation. Without compilation (see `jit`) the function and the law
themselves take the place of the addresses.
"""

from __future__ import annotations

import ctypes
import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from typing import Any, cast

import numba
import numba.core.cgutils
import numba.core.types
import numba.extending
import numpy as np
from numba.core.registry import cpu_target

from stiction.friction.user.validation import fault
from stiction.own_code.frozen import MODULE, class_to_compile, unstored
from stiction.own_code.source import text_of
from stiction.solver.compilation.interrupt import compiling
from stiction.solver.compilation.jit import INTERPRETED, compiled, compiled_for

context: Any = cpu_target.target_context
cgutils: Any = numba.core.cgutils
types: Any = numba.core.types
intrinsic: Any = numba.extending.intrinsic
typeof: Any = numba.typeof


def code_and_fields(law: Any, *entries: Any) -> tuple[Any, ...]:
    """Return the addresses of functions for a law, and the law's fields in memory.

    The functions are made by `entry_by_address`; their first argument is a pointer to the fields
    (see `pointee`). They are compiled for the first law of each type.
    """
    if INTERPRETED:
        return *entries, law
    law = _with_values_of_now(law)
    kind = type_of(law)
    known = _prepared.get((kind, entries))
    if known is None:
        with compiling():
            known = _prepared[kind, entries] = prepare(kind, entries, law)
    codes, size, write_own = known
    room: Any = (ctypes.c_char * size)()
    room.law = law  # keeps its arrays alive
    write_own(law, ctypes.addressof(room))
    return *codes, np.frombuffer(room, dtype=np.uint8)


def _with_values_of_now(law: Any) -> Any:
    """Return a user's law as one of the class to compile; others as they are."""
    kind = type(law)
    if kind.__module__.startswith("stiction."):
        return law
    try:
        return tuple.__new__(class_to_compile(kind), law)
    except ValueError as error:
        raise fault(str(error)) from None


Prepared = tuple[list[int], int, Any]
_prepared: dict[tuple[Any, ...], Prepared] = {}
_of_floats: dict[type, Any] = {}


def type_of(law: Any) -> Any:
    """Return numba's type of a law; of one that has floats only it is known by the class."""
    if not all(type(value) is float for value in law):
        return typeof(law)
    own = type(law)
    if own not in _of_floats:
        _of_floats[own] = typeof(law)
    return _of_floats[own]


def prepare(kind: Any, entries: tuple[Any, ...], law: Any) -> Prepared:
    """Return the addresses, the size of fields and their writing function for laws of a type."""
    codes = [
        int(address_of(_for_own(entry, kind), types.CPointer(kind), *entry.kinds))
        for entry in entries
    ]
    size, write_own = _size(kind), _for_own(write, kind)
    room: Any = (ctypes.c_char * size)()
    write_own(law, ctypes.addressof(room))  # which compiles it
    return codes, size, write_own


@cache
def address_of(function: Any, *kinds: Any) -> Any:
    """Return the address of the machine code of a compiled function for arguments of some types."""
    if INTERPRETED:
        return function
    function.compile(kinds)
    result = function.overloads[kinds]
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))


def _size(kind: Any) -> int:
    """Return the size of a value in bytes, at least one."""
    return max(1, int(context.get_abi_sizeof(context.get_data_type(kind))))


@compiled
def write(law: Any, to: int) -> None:
    """Write the fields of a law to an address."""
    write_value(law, to)


def _write_value(_: Any, value: Any, to: Any) -> Any:
    """Write a value to an address."""

    def generate(context: Any, builder: Any, _: Any, arguments: Any) -> Any:
        kind = context.get_data_type(value).as_pointer()
        lent = _borrow(context, builder, value, arguments[0])
        context.pack_value(builder, value, lent, builder.inttoptr(arguments[1], kind))
        return context.get_dummy_value()

    return types.void(value, types.intp), generate


write_value: Any = intrinsic(_write_value)


def _borrow(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """Return a value whose arrays have no reference counts here: Python owns them."""
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        for owner in ("meminfo", "parent"):
            setattr(array, owner, cgutils.get_null_value(getattr(array, owner).type))
        return array._getvalue()
    if isinstance(kind, types.BaseTuple):
        parts = zip(cast(Iterable[Any], kind), cgutils.unpack_tuple(builder, value), strict=True)
        return context.make_tuple(
            builder, kind, [_borrow(context, builder, *part) for part in parts]
        )
    if context.enable_nrt:  # a user's law may have other counted objects: they are never freed
        context.nrt.incref(builder, kind, value)
    return value


def _pointee(_: Any, pointer: Any) -> Any:
    """Return the value at a pointer."""

    def generate(context: Any, builder: Any, _: Any, arguments: Any) -> Any:
        return context.unpack_value(builder, pointer.dtype, arguments[0])

    return pointer.dtype(pointer), generate


pointee: Any = (lambda law: law) if INTERPRETED else intrinsic(_pointee)


def caller(result: Any, *kinds: Any) -> Any:
    """Return a function (code, memory, arguments) for compiled code, which calls an address.

    `result` and `kinds` are the types of the result and of the arguments. Errors propagate.
    """

    def call(_: Any, code: Any, memory: Any, arguments: Any) -> Any:
        def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
            data = context.make_array(memory)(context, builder, values[1]).data
            given = zip(
                cgutils.unpack_tuple(builder, values[2]), arguments.types, kinds, strict=True
            )
            passed = [data, *(context.cast(builder, *each) for each in given)]
            return _call_address(
                context, builder, values[0], result, (types.voidptr, *kinds), passed
            )

        return result(types.intp, memory, arguments), generate

    if INTERPRETED:
        return lambda code, memory, arguments: code(memory, *arguments)
    return intrinsic(call)


def caller_of(result: Any, *kinds: Any) -> Any:
    """Return a function (code, first, others) for compiled code, which calls an address.

    It is that of a compiled function (see `address_of`) for a first argument of the given type, and
    for others of the types `kinds`. Errors propagate.
    """

    def call(_: Any, code: Any, first: Any, others: Any) -> Any:
        def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
            given = zip(cgutils.unpack_tuple(builder, values[2]), others.types, kinds, strict=True)
            passed = [values[1], *(context.cast(builder, *each) for each in given)]
            return _call_address(context, builder, values[0], result, (first, *kinds), passed)

        return result(types.intp, first, others), generate

    if INTERPRETED:
        return lambda code, first, others: code(first, *others)
    return intrinsic(call)


def _call_address(
    context: Any, builder: Any, code: Any, result: Any, kinds: Any, passed: Any
) -> Any:
    """Generate the call of an address, and return its result."""
    convention = context.call_conv
    shape = convention.get_function_type(result, kinds).as_pointer()
    function = builder.inttoptr(code, shape)
    status, value = convention.call_function(builder, function, result, kinds, passed)
    with cgutils.if_unlikely(builder, status.is_error):
        convention.return_status_propagate(builder, status)
    return value


@cache
def _for_own(function: Any, kind: Any) -> Any:
    """Return the compiled `function` to use with values of this type.

    Code for a user's law is cached under its identity, so that edits are noticed, and a process
    without the law never loads it.
    """
    own = [each for each in _classes(kind) if not each.__module__.startswith("stiction.")]
    if not own:
        return function
    try:
        digest = hashlib.sha256("".join(sorted(map(_source, own))).encode()).hexdigest()
    except OSError:
        return compiled_for(function, None)
    return compiled_for(function, digest)


def _classes(kind: Any) -> Iterator[type]:
    """Yield the classes of named tuples in a type, its own first."""
    if isinstance(kind, types.BaseTuple):
        if hasattr(kind, "instance_class"):
            yield kind.instance_class
        for part in cast(Iterable[Any], kind):
            yield from _classes(part)


def _source(kind: type) -> str:
    """Return the origin of a type, after which its code is named."""
    if kind.__module__ in unstored:
        raise OSError(f"{kind.__module__} has helpers that another process cannot link")
    if kind.__module__.startswith(MODULE):
        return kind.__module__
    text = None if kind.__module__ == "__main__" else text_of(kind)  # the type of a field
    if text is None:  # in a script, each process has new types
        raise OSError(f"{kind.__module__} has no file, as it was run, to name them by")
    return f"{kind.__module__}\n{text.text}"
