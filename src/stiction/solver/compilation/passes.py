"""numba's typing and lowering of a part, which look for an operator of numbers once.

numba asks some forty templates, of arrays, dates and sets, before it knows that the sum of two
floats is a float, and asks them anew for each sum, twice.
"""

from __future__ import annotations

import operator
from typing import Any, cast

from numba.core import compiler_machinery, lowering, typed_passes, types

from stiction.solver.compilation.library import PartLibrary

Lower: Any = lowering.Lower
NativeLowering: Any = typed_passes.NativeLowering
register_pass: Any = compiler_machinery.register_pass

NUMBERS = (types.Number, types.Boolean)
OPERATORS = frozenset(getattr(operator, name) for name in operator.__all__) | {abs, bool, max, min}
ORDERS = {min: operator.lt, max: operator.gt}
POWERS = {operator.pow, operator.ipow}  # numba has code of their own for constant exponents


class Current:
    """A context of numba's that is up to date, since a caller of the part is being compiled."""

    def __init__(self, context: Any) -> None:
        """Store numba's context."""
        self._context = context

    def __getattr__(self, name: str) -> Any:
        """Return the attribute of numba's context with this name."""
        return getattr(self._context, name)

    def refresh(self) -> None:
        """Look for no news."""


class Remembering(Current):
    """A typing context that types an operator of the same numbers once."""

    def __init__(self, context: Any, known: dict[Any, Any]) -> None:
        """Store numba's context, and the known signatures."""
        super().__init__(context)
        self._known = known

    def resolve_function_type(self, function: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        if kws or not is_of_numbers(function, args):
            return self._context.resolve_function_type(function, args, kws)
        key = (function, args)
        if key not in self._known:
            self._known[key] = self._context.resolve_function_type(function, args, kws)
        return self._known[key]


KNOWN: dict[Any, Any] = {}  # signatures of operators


def is_of_numbers(function: Any, args: Any) -> bool:
    """Return whether a call applies an operator to numbers."""
    return (
        isinstance(function, types.Function)
        and function.typing_key in OPERATORS
        and all(isinstance(each, NUMBERS) for each in args)
    )


class PartLower(Lower):  # type: ignore[misc]
    """numba's lowering, which looks for operators of numbers once."""

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """Lower an operator; for two numbers, as its types were inferred."""
        context, builder, signature = self.context, self.builder, self.fndesc.calltypes[expr]
        function = context.typing_context.resolve_value_type(op)
        if op in POWERS or not is_of_numbers(function, signature.args):
            return super().lower_binop(resty, expr, op)
        values = [
            context.cast(builder, self.loadvar(each.name), self.typeof(each.name), kind)
            for each, kind in zip((expr.lhs, expr.rhs), signature.args, strict=True)
        ]
        typing = Remembering(context.typing_context, KNOWN)
        known = typing.resolve_function_type(function, signature.args, {})
        found = context.get_function(function, known)(builder, values)
        return context.cast(builder, found, signature.return_type, resty)

    def lower_call(self, resty: Any, expr: Any) -> Any:
        """Lower a call; the smallest or largest of some numbers as numba's own code does.

        That is a function, compiled with the options of what calls it first: machine code would
        depend on what was compiled before it in the process.
        """
        context, builder = self.context, self.builder
        function, names = self.typeof(expr.func.name), [each.name for each in expr.args]
        kinds, kind = [*map(self.typeof, names)], self.fndesc.calltypes[expr].return_type
        order = ORDERS.get(cast(Any, getattr(function, "typing_key", None)))
        numbers = not expr.vararg and all(isinstance(each, types.Number) for each in kinds)
        if order is None or not numbers:
            return super().lower_call(resty, expr)
        compared = context.typing_context.resolve_value_type(order)
        known = compared.get_call_type(context.typing_context, (kind, kind), {})
        is_before = context.get_function(compared, known)
        found, *others = (
            context.cast(builder, self.loadvar(name), each, kind)
            for name, each in zip(names, kinds, strict=True)
        )
        for value in others:
            found = builder.select(is_before(builder, (value, found)), value, found)
        return context.cast(builder, found, kind, resty)


@register_pass(mutates_CFG=True, analysis_only=False)
class EntryLowering(NativeLowering):  # type: ignore[misc]
    """Lower functions that call parts, as parts are lowered."""

    _name = "entry_lowering"

    @property
    def lowering_class(self) -> Any:
        """Return the class that lowers parts and their callers."""
        return PartLower


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(EntryLowering):
    """Lower a part into a library of its own kind, and register it for calls."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower."""
        context = state.targetctx
        state.library = PartLibrary(context.codegen(), state.func_id.func_qualname)
        super().run_pass(state)
        key = object()  # by which calls find the part: numba takes the function for Python callers
        context.insert_user_function(key, state["cr"].fndesc, [state.library])
        state["cr"] = state["cr"]._replace(cfunc=key)
        return True
