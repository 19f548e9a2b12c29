"""How a part of the loop is compiled: as far as what calls it needs.

numba makes machine code of each function by itself, all that it calls included, and does so again
for whatever calls it. A part is called by compiled code only: it is typed and lowered once, and
optimised once, where all parts are merged. Two copies of it cannot differ by how their sums are
rounded. numba's own passes do the work; those are left out that find nothing in a part, and the
clean-up and the timers that numba adds around each.
"""

from __future__ import annotations

import operator
from functools import cache
from typing import Any, ClassVar

from numba.core import (
    codegen,
    compiler,
    compiler_machinery,
    sigutils,
    typed_passes,
    types,
    untyped_passes,
)

JITCodeLibrary: Any = codegen.JITCodeLibrary
CompilerBase: Any = compiler.CompilerBase
PassManager: Any = compiler_machinery.PassManager
NativeLowering: Any = typed_passes.NativeLowering
TypeInference: Any = typed_passes.NopythonTypeInference
register_pass: Any = compiler_machinery.register_pass
normalize_signature: Any = sigutils.normalize_signature

OPERATORS = frozenset(getattr(operator, name) for name in operator.__all__)


class PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of a part, to be merged into that of what calls it."""

    def _optimize_final_module(self) -> None:
        """Leave this to the function into which all parts are merged."""

    def _finalize_final_module(self) -> None:
        """End as any library, but for machine code."""
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


class Remembering:
    """A typing context that types an operator of the same numbers once.

    numba asks some forty templates, of arrays, dates and sets, before it knows that the sum of two
    floats is a float, and asks them anew for each sum.
    """

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
        and all(isinstance(each, types.Number | types.Boolean) for each in args)
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


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(NativeLowering):  # type: ignore[misc]
    """Lower a part into a library of its own kind, and enter it among what can be called."""

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


class Passes(PassManager):  # type: ignore[misc]
    """Passes, one after the other."""

    def _runPass(self, _: int, one: Any, state: Any) -> None:
        one.analysis = self._analysis
        one.run_initialization(state)
        one.run_pass(state)
        one.run_finalizer(state)


@cache
def passes() -> Any:
    """Return the passes of a part."""
    made = Passes("part")
    for one in (
        untyped_passes.TranslateByteCode,
        untyped_passes.FixupArgs,
        untyped_passes.IRProcessing,
        untyped_passes.RewriteSemanticConstants,
        untyped_passes.DeadBranchPrune,
        untyped_passes.GenericRewrites,
        untyped_passes.ReconstructSSA,
        PartInference,
        typed_passes.PreLowerStripPhis,
        typed_passes.IRLegalization,
        PartLowering,
        typed_passes.NoPythonBackend,
    ):
        made.add_pass(one)
    made.finalize()
    return made


class PartCompiler(CompilerBase):  # type: ignore[misc]
    """numba's compiler, with these passes."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes."""
        self.state.flags.no_compile = True
        return [passes()]


def compile_part(part: Any, signature: Any) -> Any:
    """Compile a part for these types, if it is not yet, and return the key by which it is called.

    numba's own `Dispatcher.compile`, which holds the compiler's lock already, without a cache and
    without timers, of which each would listen to all parts below.
    """
    arguments, returned = normalize_signature(signature)
    known = part.overloads.get(tuple(arguments))
    if known is not None:
        return known.entry_point
    made = part._compiler.compile(arguments, returned)
    part.add_overload(made)
    return made.entry_point
