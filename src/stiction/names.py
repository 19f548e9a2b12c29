"""Public names: a room lists them once, in its stub, and imports each at first use.

The stub (``__init__.pyi``, a line ``from HOME import NAME as NAME`` each) is what type checkers
read, so that they and a session see the same names, and `import stiction` is fast. Old names work
for one more version, with a warning that names the new one.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from functools import cache, wraps
from importlib import import_module
from inspect import currentframe
from os import sep
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar, cast

from stiction.arguments import doorway
from stiction.errors import StictionError

F = TypeVar("F", bound=Callable[..., Any])


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
        From each old name to the new one, as `old_names` takes it.
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


def refuse_second(what: str, name: str, earlier: Any, later: Any) -> None:
    """Refuse another class or function under a name: who uses the name would get the wrong one.

    The same one again is not another, as where its module is loaded anew.

    Raises
    ------
    StictionError
        With the places of both.
    """
    first, second = (f"{each.__module__}.{each.__qualname__}" for each in (earlier, later))
    if first != second:
        raise StictionError(f"the {what} {name!r} is {first}; give {second} another name")


def entry(room: str, name: str, attribute: str | None, registry: str) -> Any:
    """Return the file of a room that a line of a registry names, or an attribute of it.

    Raises
    ------
    StictionError
        If there is none.
    """
    path = f"{room}.{name}"
    try:
        module = import_module(path)
        return module if attribute is None else getattr(module, attribute)
    except ModuleNotFoundError as error:
        if error.name is None or not path.startswith(error.name):
            raise  # what the file imports is missing
        lacks = "there is no such file"
    except AttributeError:
        lacks = f"it has no function {attribute}"
    file = f"{path.replace('.', '/')}.py"
    raise StictionError(f"{registry} names {name!r}, {file}: {lacks}; correct the line, or add it")


def draw(figure: str, *what: Any, **options: Any) -> Any:
    """Draw a public figure: a result calls for its own by name, see `plotting`."""
    return getattr(import_module("stiction.plotting"), figure)(*what, **options)


def picture(figure: str, *what: Any) -> str:
    """Return a public figure as an image in HTML, for a notebook."""
    shown = import_module("stiction.plotting.page.save")
    return str(shown.picture(getattr(import_module("stiction.plotting"), figure), *what))


def own_picture(what: Any) -> str:
    """Return the figure of an object's ``plot`` as an image in HTML, for a notebook."""
    shown, door = (import_module(f"stiction.plotting.{name}") for name in ("page.save", "door"))
    return str(shown.picture(door.plot, what))


def page_of(what: Any, path: str | Path, name: str) -> Path:
    """Write an analysis as a page in HTML; return its path."""
    written: Path = import_module("stiction.plotting.analysis.page").write(what, path, name)
    return written


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


def warn_renamed(old: str, new: str) -> None:
    """Warn that `old` is called `new` now, at the line of the user that holds the old name.

    Python shows such a warning only for a line of a script or a session.
    """
    message = f"{old} is now called {new}; the old name goes with the next version"
    own = f"{Path(__file__).parent}{sep}", f"{sep}pydantic{sep}"  # which checks arguments for us
    frame, level = currentframe(), 1
    while frame is not None and any(part in frame.f_code.co_filename for part in own):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, DeprecationWarning, stacklevel=level)


def by_new_names(names: Iterable[str], formerly: Mapping[str, str], what: str) -> list[str]:
    """Replace old names of data by new ones; warn the caller of the public function.

    Parameters
    ----------
    names : iterable of str
        The given names.
    formerly : mapping
        From each old name to the new one.
    what : str
        The kind of name, for example "measure".
    """
    given = list(names)
    for name in dict.fromkeys(given):
        if name in formerly:
            warn_renamed(f"the {what} {name!r}", repr(formerly[name]))
    return [formerly.get(name, name) for name in given]


def old_names(
    module: str, renamed: Mapping[str, str], otherwise: Callable[[str], Any] | None = None
) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for a module that resolves its old names.

    Parameters
    ----------
    module : str
        The module's ``__name__``.
    renamed : mapping
        From each old name to the new one: an attribute of the same module, or a full dotted
        path (``"stiction.plotting.run"``).
    otherwise : callable, optional
        Resolves all other names; by default they raise `AttributeError`.

    Examples
    --------
    In ``stiction/analysis/oscillation.py``::

        __getattr__ = old_names(__name__, {"hear_song": "transverse_oscillation"})
    """

    def find(name: str) -> Any:
        if name in renamed:
            new = renamed[name] if "." in renamed[name] else f"{module}.{renamed[name]}"
            warn_renamed(f"{module}.{name}", new)
            return _resolve(new)
        if otherwise is not None:
            return otherwise(name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return find


def _resolve(path: str) -> Any:
    from pkgutil import resolve_name  # here, so that `import stiction` is fast

    return resolve_name(path)


class _Moved:
    """Placeholder for a moved function or class, which warns at each use."""

    def __init__(self, old: str, new: str) -> None:
        self._old, self._new = old, new

    def _resolve(self) -> Any:
        warn_renamed(self._old, self._new)
        return _resolve(self._new)

    def __call__(self, *args: Any, **values: Any) -> Any:
        return self._resolve()(*args, **values)

    def __instancecheck__(self, value: Any) -> bool:
        return isinstance(value, self._resolve())

    def __subclasscheck__(self, kind: type) -> bool:
        return issubclass(kind, self._resolve())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # pytest, doctest and others look these up on functions
            raise AttributeError(name)
        return getattr(self._resolve(), name)


def old_attributes(function: Callable[..., Any], renamed: Mapping[str, str]) -> None:
    """Give a function that replaced a module the attributes of that module.

    Parameters
    ----------
    function : callable
        For example `stiction.audit`.
    renamed : mapping
        From each old name in the module to the full path of the new one.
    """
    for old, new in renamed.items():
        setattr(function, old, _Moved(f"stiction.{function.__name__}.{old}", new))


def old_keywords(**renamed: str) -> Callable[[F], F]:
    """Return a decorator for a function that takes old names of its arguments, with a warning.

    Parameters
    ----------
    renamed : str
        The new name of each argument, by its old one.

    Examples
    --------
    >>> area = old_keywords(width="a")(lambda a, b: a * b)
    >>> area(2, b=3)
    6
    """

    def decorate(function: F) -> F:
        @wraps(function)
        def call(*args: Any, **values: Any) -> Any:
            for old, new in renamed.items():
                if old in values and new not in values:
                    warn_renamed(f"the argument {old} of {function.__name__}", new)
                    values[new] = values.pop(old)
            return function(*args, **values)

        return cast(F, call)

    return decorate


def old_method(old: str, new: str) -> Callable[..., Any]:
    """Return a deprecated method that warns and calls the function that replaced it.

    Parameters
    ----------
    old : str
        The old call, for example ``"Study.run(store)"``.
    new : str
        The same call of a public function, ``"sweep(study, store)"``; the instance is its first
        argument.
    """

    def method(self: Any, *args: Any, **values: Any) -> Any:
        warn_renamed(old, f"stiction.{new}")
        function = getattr(import_module("stiction"), new.partition("(")[0])
        return function(self, *args, **values)

    method.__doc__ = f"Deprecated: ``stiction.{new}``."
    return method
