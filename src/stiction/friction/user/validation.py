"""Checks that a user's class is a friction law, with messages if it is not."""

from __future__ import annotations

import inspect
from math import isfinite
from types import ModuleType
from typing import Any

from stiction.errors import DescriptionError, Fault, echo, one_line
from stiction.friction.law import has_state
from stiction.friction.user.bounded import endless
from stiction.friction.user.source import member
from stiction.text.validation import unknown_name

SET_VALUED = ("coefficient", "slope")
WITH_STATE = ("states", "coefficient", "settled", "force", "change")
WRITE = (
    "write class {name}(NamedTuple) with its parameters as fields and the methods "
    "coefficient(law, v) and slope(law, v); for a law with internal state: states(), "
    "coefficient(law, v), settled(law, speed), force and change(law, slip, load, state)"
)
ENDING = "bound each loop: for _ in range(50)"
RESERVED = {"law", "source"}  # keys of [friction] that are not parameters
PROBED = (0.0, 1e-3)  # m/s


def fault(message: str, key: str = "law") -> DescriptionError:
    """Return the error for a fault in the table [friction]."""
    return DescriptionError([Fault(f"friction.{key}", message)])


def law_in(module: ModuleType, kind: str, name: str) -> type[Any]:
    """Return the law `kind` of a module; `name` is the user's name for it."""
    found = member(module, kind)
    if found is None:
        classes = [n for n, value in vars(module).items() if _is_its_own(value, module)]
        raise fault(f"{echo(name)}: {unknown_name('class', kind, classes or ['none'])}")
    law = is_law(found, name)
    for field in sorted(RESERVED.intersection(law._fields)):
        raise fault(
            f"{echo(name)} has a parameter {echo(field)}, which is a reserved key; rename it"
        )
    return law


def is_law(found: Any, name: str) -> type[Any]:
    """Return a class, if it is a friction law; `name` is the user's name for it."""
    write = WRITE.format(name=name.rpartition(":")[2].rpartition(".")[2])
    if not (inspect.isclass(found) and issubclass(found, tuple) and hasattr(found, "_fields")):
        raise fault(f"{echo(name)} is not a NamedTuple; {write}")
    wanted = WITH_STATE if hasattr(found, "states") else SET_VALUED
    lacking = [method for method in wanted if not callable(getattr(found, method, None))]
    if lacking:
        raise fault(f"{echo(name)} is not a friction law, it lacks {', '.join(lacking)}; {write}")
    law: type[Any] = found
    return law


def try_law(law: Any, name: str) -> Any:
    """Return the law, if its methods return numbers at a few speeds."""
    if said := endless(law):
        raise fault(f"{echo(name)}: {said}; {ENDING}")
    probes = [("coefficient", v) for v in PROBED] + [("slope", v) for v in PROBED]
    for method, v in [("coefficient", PROBED[1])] if has_state(law) else probes:
        try:
            value = float(getattr(law, method)(v))
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # whatever the user's law raises
            what = (
                f"{method}(law, {v:g}) of {echo(name)} raises {one_line(error)}; correct it there"
            )
            raise fault(what) from None
        if not isfinite(value):
            raise fault(f"{method}(law, {v:g}) of {echo(name)} is {echo(value)}; it must be finite")
    return law


def _is_its_own(value: Any, module: ModuleType) -> bool:
    return inspect.isclass(value) and value.__module__ == module.__name__
