"""Public names: a room lists them once, in its stub, and imports each at first use.

The stub (``__init__.pyi``, a line ``from HOME import NAME as NAME`` each) is what type checkers
read, so that they and a session see the same names, and `import stiction` is fast.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from types import FunctionType
from typing import Any

from stiction.arguments import doorway
from stiction.deprecation import old_names


@cache
def public_names(room: str) -> dict[str, str]:
    """Return the module of each public name of a room, from the lines of its stub.

    They are read and not run: to import everything takes much longer than to import one name.
    """
    import ast

    with open(f"{sys.modules[room].__file__}i", encoding="utf-8") as stub:
        lines = [each for each in ast.parse(stub.read()).body if isinstance(each, ast.ImportFrom)]
    return {each.name: str(line.module) for line in lines for each in line.names}


def public(
    room: str, formerly: Mapping[str, str] | None = None
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a room that has a stub.

    Parameters
    ----------
    room : str
        The module's ``__name__``.
    formerly : mapping, optional
        From each old name to the new one, as `stiction.deprecation.old_names` takes it.
    """

    def find(name: str) -> Any:
        if name == "__all__":
            return sorted(public_names(room))
        if name.startswith("__") or name not in public_names(room):
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        home = public_names(room)[name]
        found = None if home == room else getattr(import_module(home), name, None)
        if found is None:
            return import_module(f"{home}.{name}")  # a room
        return doorway(found, room, name) if isinstance(found, FunctionType) else found

    def names() -> list[str]:
        own = (name for name in vars(sys.modules[room]) if name.startswith("__"))
        return sorted([*public_names(room), *own])

    return old_names(room, formerly or {}, find), names


def draw(figure: str, *what: Any) -> Any:
    """Return what a public figure draws: a result asks for its own when called, see `plotting`."""
    return getattr(import_module("stiction.plotting"), figure)(*what)


def picture(figure: str, *what: Any) -> str:
    """Return what a public figure draws as an image in HTML, for a notebook."""
    shown = import_module("stiction.plotting.page.save")
    return str(shown.picture(getattr(import_module("stiction.plotting"), figure), *what))


def session_name(kind: type) -> str:
    """Return a class as one writes it in a session: ``st.laws.LuGre``; others by their name.

    >>> from stiction.friction.laws import LuGre
    >>> session_name(LuGre)
    'st.laws.LuGre'
    """
    name, home = kind.__name__, kind.__module__
    if home.startswith("stiction."):
        import stiction

        if home.startswith(public_names("stiction").get(name, "none")):
            return f"st.{name}"
        for room in ("laws", "protocols"):
            if getattr(getattr(stiction, room), name, None) is kind:
                return f"st.{room}.{name}"
    return name
