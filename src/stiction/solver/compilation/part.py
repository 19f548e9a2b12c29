"""Compilation of a part of the loop, as far as its callers need it.

numba makes machine code of each function by itself, all that it calls included, and does so again
for whatever calls it. A part is called by compiled code only: it is typed and lowered once, and
optimised once, where all parts are merged. Two copies of it cannot differ by how their sums are
rounded. numba's own passes do the work; those are left out that find nothing in a part, and the
clean-up and the timers that numba adds around each.
"""

from __future__ import annotations

from functools import cache, partial
from typing import Any

from numba.core import (
    compiler,
    compiler_machinery,
    decorators,
    sigutils,
    typed_passes,
    untyped_passes,
)

from stiction.solver.compilation.library import EntryLibrary
from stiction.solver.compilation.passes import (
    KNOWN,
    Current,
    EntryLowering,
    PartLowering,
    Remembering,
)

njit: Any = decorators.njit
Compiler: Any = compiler.Compiler
CompilerBase: Any = compiler.CompilerBase
PassManager: Any = compiler_machinery.PassManager
normalize_signature: Any = sigutils.normalize_signature

# the compiler may fuse multiply-adds and share divisions by a common divisor; it reorders nothing,
# and infinities and NaN keep their meaning
ARITHMETIC = {"error_model": "numpy", "fastmath": {"contract", "arcp", "nsz"}}

# only compiled code calls a part, and most parts allocate nothing: without wrappers for Python
# callers, and without reference counts, they compile in half the time
PART = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


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
        typed_passes.NopythonTypeInference,
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

    def __init__(self, typing: Any, target: Any, *others: Any) -> None:
        """Take the contexts as they are."""
        super().__init__(Remembering(typing, KNOWN), Current(target), *others)

    def define_pipelines(self) -> list[Any]:
        """Return the passes."""
        self.state.flags.no_compile = True
        return [passes()]


def compile_part(part: Any, signature: Any) -> Any:
    """Compile a part for these types, unless it is compiled, and return its key for calls.

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


class EntryCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, for functions that call parts."""

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes, with the lowering of parts."""
        made = super().define_pipelines()
        for each in made:
            each.passes = [
                (EntryLowering if one is typed_passes.NativeLowering else one, said)
                for one, said in each.passes
            ]
            each.finalize()
        return list(made)

    def compile_extra(self, function: Any) -> Any:
        """Compile a Python function."""
        library = EntryLibrary(self.state.targetctx.codegen(), function.__qualname__)
        library.enable_object_caching()
        self.state.library = library
        return super().compile_extra(function)


def make_entry(function: Any, **options: Any) -> Any:
    """Return a function as one that Python calls, not yet compiled."""
    return njit(nogil=True, pipeline_class=EntryCompiler, **options, **ARITHMETIC)(function)


def make_part(function: Any, **options: Any) -> Any:
    """Return a function as a part, not yet compiled."""
    made = njit(nogil=True, pipeline_class=PartCompiler, **options, **ARITHMETIC, **PART)(function)

    def refuse(*_: Any, **__: Any) -> Any:
        raise TypeError(f"{function.__name__} is called by compiled code only")

    # numba would call missing code, and crash Python
    made._insert, made._compile_for_args = _nowhere, refuse
    made.compile = partial(compile_part, made)
    return made


def _nowhere(*_: Any, **__: Any) -> None:
    """Do not register a compiled part for Python callers."""
