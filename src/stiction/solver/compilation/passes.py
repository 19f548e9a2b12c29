"""numba's inference and lowering of a part, which look for an operator of numbers once.

numba asks some forty templates, of arrays, dates and sets, before it knows that the sum of two
floats is a float, and asks them anew for each sum, twice.
"""

from __future__ import annotations

import operator
from typing import Any, ClassVar

from numba.core import compiler_machinery, lowering, typed_passes, types

from stiction.solver.compilation.library import PartLibrary

Lower: Any = lowering.Lower
NativeLowering: Any = typed_passes.NativeLowering
TypeInference: Any = typed_passes.NopythonTypeInference
register_pass: Any = compiler_machinery.register_pass

NUMBERS = (types.Number, types.Boolean)
OPERATORS = frozenset(getattr(operator, name) for name in operator.__all__) | {abs, bool, max, min}
POWERS = {operator.pow, operator.ipow}  # numba has code of their own for constant exponents


class Remembering:
    """A typing context that types an operator of the same numbers once."""

    def __init__(self, context: Any, known: dict[Any, Any]) -> None:
        """Store numba's context, and what is known so far."""
        self._context, self._known = context, known

    def __getattr__(self, name: str) -> Any:
        """Return what numba's context has under this name."""
        return getattr(self._context, name)

    def resolve_function_type(self, function: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        if not _of_numbers(function, args, kws):
            return self._context.resolve_function_type(function, args, kws)
        key = (function, args)
        if key not in self._known:
            self._known[key] = self._context.resolve_function_type(function, args, kws)
        return self._known[key]


def _of_numbers(function: Any, args: Any, kws: Any) -> bool:
    """Return whether a call is that of an operator with numbers."""
    return (
        not kws
        and isinstance(function, types.Function)
        and function.typing_key in OPERATORS
        and all(isinstance(each, NUMBERS) for each in args)
    )


@register_pass(mutates_CFG=True, analysis_only=False)
class PartInference(TypeInference):  # type: ignore[misc]
    """Infer types, with a memory for operators."""

    _name = "part_type_inference"
    _known: ClassVar[dict[Any, Any]] = {}

    def run_pass(self, state: Any) -> bool:
        """Infer the types."""
        context = state.typingctx
        state.typingctx = Remembering(context, self._known)
        try:
            return bool(super().run_pass(state))
        finally:
            state.typingctx = context


class PartLower(Lower):  # type: ignore[misc]
    """numba's lowering, which looks for operators of numbers once."""

    _called: ClassVar[dict[Any, Any]] = {}

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """Lower an operator; that of two numbers as its types were inferred."""
        signature = self.fndesc.calltypes[expr]
        if op in POWERS or not all(isinstance(each, NUMBERS) for each in signature.args):
            return super().lower_binop(resty, expr, op)
        context, builder = self.context, self.builder
        values = [
            context.cast(builder, self.loadvar(each.name), self.typeof(each.name), kind)
            for each, kind in zip((expr.lhs, expr.rhs), signature.args, strict=True)
        ]
        function = context.typing_context.resolve_value_type(op)
        key = (op, signature.args)
        if key not in self._called:
            self._called[key] = function.get_call_type(context.typing_context, signature.args, {})
        found = context.get_function(function, self._called[key])(builder, values)
        return context.cast(builder, found, signature.return_type, resty)


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(NativeLowering):  # type: ignore[misc]
    """Lower a part into a library of its own kind, and enter it among what can be called."""

    _name = "part_lowering"

    @property
    def lowering_class(self) -> Any:
        """Return what lowers a part."""
        return PartLower

    def run_pass(self, state: Any) -> bool:
        """Lower."""
        context = state.targetctx
        state.library = PartLibrary(context.codegen(), state.func_id.func_qualname)
        super().run_pass(state)
        key = object()  # by which calls find the part: numba takes the function for Python callers
        context.insert_user_function(key, state["cr"].fndesc, [state.library])
        state["cr"] = state["cr"]._replace(cfunc=key)
        return True
