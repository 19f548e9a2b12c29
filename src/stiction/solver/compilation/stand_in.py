"""Stand-ins: functions that compiled code calls in the place of Python functions.

As `overload` and `register_jitable` of numba, but what is called is a part (see `part`); numba's
own would be given wrappers that nothing calls.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from numba.core import types
from numba.core.typing import templates

from stiction.solver.compilation.part import make_part

make_template: Any = templates.make_overload_template
infer: Any = templates.infer
infer_global: Any = templates.infer_global
F = TypeVar("F", bound=Callable[..., Any])


class PartTemplate:
    """A template by which numba compiles a stand-in as a part."""

    def _get_jit_decorator(self) -> Callable[..., Callable[[Any], Any]]:
        return lambda **options: lambda function: make_part(function, **options)


def stand_in(function: Any, **options: Any) -> Callable[[F], F]:
    """Decorate a function that chooses, by the types of arguments, the one to call instead."""

    def register(choose: F) -> F:
        found = make_template(function, choose, options, strict=False, inline="never")
        template = type(found.__name__, (PartTemplate, found), {})
        infer(template)
        infer_global(function, types.Function(template))
        return choose

    return register


def called_from_both(function: F, **options: Any) -> F:
    """Let compiled code call a function that Python calls as well."""
    stand_in(function, **options)(lambda *_: function)
    return function
