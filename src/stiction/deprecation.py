"""Old public names go on working for one version, with a warning that names the new one."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from typing import Any


def warn_renamed(old: str, new: str, *, stacklevel: int = 3) -> None:
    """Warn the caller's caller that `old` is called `new` now."""
    message = f"{old} is now called {new}; the old name goes with the next version"
    warnings.warn(message, DeprecationWarning, stacklevel=stacklevel)


def by_new_names(names: Iterable[str], formerly: Mapping[str, str], what: str) -> list[str]:
    """Return names of data, old ones replaced; warn who called the public function of each.

    Parameters
    ----------
    names : iterable of str
        As they were given.
    formerly : mapping
        From each old name to the new one.
    what : str
        What they name, for example "measure".
    """
    given = list(names)
    for name in dict.fromkeys(given):
        if name in formerly:
            warn_renamed(f"the {what} {name!r}", repr(formerly[name]), stacklevel=5)
    return [formerly.get(name, name) for name in given]


def old_names(
    module: str, renamed: Mapping[str, str], otherwise: Callable[[str], Any] | None = None
) -> Callable[[str], Any]:
    """Return a module's ``__getattr__`` that knows old names.

    Parameters
    ----------
    module : str
        The module's ``__name__``.
    renamed : mapping
        From each old name to the new one, an attribute of the same module, or written with dots
        from the package on (``"stiction.plotting.run"``).
    otherwise : callable, optional
        Asked for any other name; an `AttributeError` when left out.

    Examples
    --------
    In ``stiction/analysis/oscillation.py``::

        __getattr__ = old_names(__name__, {"hear_song": "transverse_oscillation"})
    """

    def find(name: str) -> Any:
        if name in renamed:
            home, _, new = renamed[name].rpartition(".")
            warn_renamed(f"{module}.{name}", f"{home or module}.{new}")
            return getattr(import_module(home or module), new)
        if otherwise is not None:
            return otherwise(name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return find


class _Moved:
    """Stands where a function or class was: called, asked for or tested against, it warns."""

    def __init__(self, old: str, new: str) -> None:
        self._old, self._new = old, new

    def _found(self) -> Any:
        warn_renamed(self._old, self._new, stacklevel=4)
        home, _, name = self._new.rpartition(".")
        return getattr(import_module(home), name)

    def __call__(self, *args: Any, **values: Any) -> Any:
        return self._found()(*args, **values)

    def __instancecheck__(self, value: Any) -> bool:
        return isinstance(value, self._found())

    def __subclasscheck__(self, kind: type) -> bool:
        return issubclass(kind, self._found())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # pytest, doctest and the like ask functions for these
            raise AttributeError(name)
        return getattr(self._found(), name)


def old_attributes(function: Callable[..., Any], renamed: Mapping[str, str]) -> None:
    """Let a function that took the place of a module answer to what the module held.

    Parameters
    ----------
    function : callable
        For example `stiction.audit`.
    renamed : mapping
        From each old name in the module to the new one, written from the package on.
    """
    for old, new in renamed.items():
        setattr(function, old, _Moved(f"stiction.{function.__name__}.{old}", new))


def old_method(old: str, new: str) -> Callable[..., Any]:
    """Return a method in whose place there is a function of the package now, which it warns of.

    Parameters
    ----------
    old : str
        The call as it was, for example ``"Study.run(store)"``.
    new : str
        The same call of a public function, ``"sweep(study, store)"``; it is given the instance
        first.
    """

    def method(self: Any, *args: Any, **values: Any) -> Any:
        warn_renamed(old, f"stiction.{new}")
        function = getattr(import_module("stiction"), new.partition("(")[0])
        return function(self, *args, **values)

    method.__doc__ = f"Deprecated: `stiction.{new}`."
    return method
