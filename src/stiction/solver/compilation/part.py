"""How a part of the loop is compiled: as far as what calls it needs.

numba makes machine code of each function by itself, all that it calls included, and does so again
for whatever calls it. A part is called by compiled code only: no machine code is made of it, and
two copies of it, in a function and by itself, cannot differ by how their sums are rounded.
"""

from __future__ import annotations

from typing import Any

from numba.core import codegen, compiler, compiler_machinery, typed_passes

JITCodeLibrary: Any = codegen.JITCodeLibrary
CompilerBase: Any = compiler.CompilerBase
NativeLowering: Any = typed_passes.NativeLowering
register_pass: Any = compiler_machinery.register_pass
builder: Any = compiler.DefaultPassBuilder


class PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of a part, to be merged into that of what calls it."""

    def _finalize_final_module(self) -> None:
        """End as any library, but for machine code."""
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


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


class PartCompiler(CompilerBase):  # type: ignore[misc]
    """numba's compiler, with that pass."""

    def define_pipelines(self) -> list[Any]:
        """Return numba's own passes, but for the lowering."""
        self.state.flags.no_compile = True
        made = builder.define_nopython_pipeline(self.state)
        made.passes = [
            (PartLowering if each is NativeLowering else each, text) for each, text in made.passes
        ]
        made._finalized = False
        made.finalize()
        return [made]
