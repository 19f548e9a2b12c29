"""The code of a part of the loop, and of a function into which parts are merged.

numba merges what a function calls into it, and all that again into what calls the function. Here
each part is merged once, into the function that Python calls.
"""

from __future__ import annotations

from functools import cache, cached_property
from typing import Any

from llvmlite.binding import newpassmanagers
from numba.core import codegen

JITCodeLibrary: Any = codegen.JITCodeLibrary
create_passes: Any = newpassmanagers.create_new_function_pass_manager


class CallingLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of a function that calls parts."""

    def add_linking_library(self, library: Any) -> None:
        """Note a called library: a part, or a function of numba's own, which must be complete."""
        if isinstance(library, PartLibrary):
            self._linking_libraries.append(library)
        else:
            super().add_linking_library(library)

    @cached_property
    def called(self) -> dict[Any, None]:
        """Return all called libraries, and those that they call in turn, in a fixed order."""
        found: dict[Any, None] = {}
        for each in dict.fromkeys(self._linking_libraries):
            found |= {each: None} | (each.called if isinstance(each, PartLibrary) else {})
        return found

    def merge(self) -> None:
        """Merge all called libraries, each caller before the libraries that it calls.

        LLVM leaves out what nothing calls so far.
        """
        for each in sorted(self.called, key=_count_called, reverse=True):
            self._final_module.link_in(each._get_module_for_linking(), preserve=True)
        self._linking_libraries: list[Any] = []


def _count_called(library: Any) -> int:
    """Return the number of libraries that a part calls; 0 for numba's own functions."""
    return len(library.called) if isinstance(library, PartLibrary) else 0


class PartLibrary(CallingLibrary):
    """The code of a part."""

    def _optimize_functions(self, module: Any) -> None:
        """Tidy the part up, so that less is merged; all else is done then."""
        module.data_layout = self._codegen._data_layout
        builder = self._codegen._pass_builder()
        for function in module.functions:
            if not function.is_declaration:
                tidying().run(function, builder)

    def _get_module_for_linking(self) -> Any:
        """Return the part as code that may be there already: by itself, unless finalised."""
        for function in self._final_module.functions:
            if not function.is_declaration:
                function.linkage = "linkonce_odr"
        return self._final_module

    def finalize(self) -> None:
        """Merge all called libraries, for a caller that is compiled in numba's own way."""
        self.merge()
        self._finalized = True


class EntryLibrary(CallingLibrary):
    """The code of a function that Python calls."""

    def finalize(self) -> None:
        """Merge all called libraries, and finish as any library."""
        self.merge()
        super().finalize()


@cache
def tidying() -> Any:
    """Return the passes that turn memory into numbers, and fold them."""
    made = create_passes()
    made.add_sroa_pass()
    made.add_instruction_combine_pass()
    made.add_simplify_cfg_pass()
    return made
