"""Checks that a user's class is a friction law, with messages if it is not.

Its methods run in plain Python for a limited number of lines, so that an endless loop is found
before it is compiled. Lines are counted, not seconds: the verdict is the same on every machine.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache, partial, update_wrapper
from inspect import isfunction
from itertools import pairwise
from math import inf, isfinite, nan
from types import FrameType, ModuleType
from typing import Any, TypeVar

from stiction.errors import DescriptionError, echo, one_line
from stiction.friction.law import has_state
from stiction.friction.user.derivative import derivative, is_steep_at_rest, jump
from stiction.own_code.frozen import renew
from stiction.own_code.identity import refuse_unknown, state_of
from stiction.own_code.source import member
from stiction.text.validation import unknown_name

LINES = 100_000  # a method has about ten
SPEEDS = (0.0, 1e-9, 1e-6, 1e-3, 1.0, inf, nan)  # m/s; the last two may occur in failed steps
LOAD = 1.0  # N
SET_VALUED = ("coefficient", "slope")
WITH_STATE = ("states", "coefficient", "settled", "force", "change")
WRITE = (
    "write class {name}(NamedTuple) with its parameters as fields and the methods "
    "coefficient(law, v) and slope(law, v); for a law with internal state: states(), "
    "coefficient(law, v), settled(law, speed), force and change(law, slip, load, state)"
)
ENDING = "bound each loop: for _ in range(50)"
FIELD = "a field of the class"
RESERVED = {"law", "source", "reads"}  # keys of [friction] that are not parameters
PROBED = (0.0, 1e-3)  # m/s
DENSE = tuple(10.0 ** (i / 8) for i in range(-72, 9))  # m/s: friction is not negative, nor jumps
JUMP = 1e-3  # of the largest coefficient so far: less is rounding in the pieces of a law
SLOPES = (1.3e-6, 1.7e-4, 1.1e-2, 0.23)  # m/s: at such numbers no law has a kink
WRONG = 0.01  # of two slopes: by so much they may differ beside the difference's error


class NoEnd(BaseException):
    """Too many lines were run; a law's `except Exception` does not catch it."""


def endless(law: Any) -> str:
    """Return which method of a law does not end, and at which slip speed; '' for none."""
    for v in SPEEDS:
        for name, call in _calls(law, v).items():
            try:
                with limit_lines(type(law)):
                    call()
            except NoEnd:
                return f"{name} at {v:g} m/s ran {LINES:,} lines and did not end"
            except KeyboardInterrupt:
                raise
            except BaseException:  # other checks report other faults
                continue
    return ""


T = TypeVar("T")


def once_for_each_law(function: Callable[..., T]) -> Callable[..., T]:
    """Let a function of a law, and of numbers, remember its last values.

    Laws of different classes are equal as tuples, and one law differs with the variables that it
    reads.
    """

    @lru_cache(maxsize=256, typed=True)
    def remember(_: object, *arguments: Any) -> T:
        return function(*arguments)

    def look_up(law: Any, *others: Any) -> T:
        return remember(state_of(type(law)), law, *others)

    return update_wrapper(look_up, function)


_endless = once_for_each_law(endless)


def _calls(law: Any, v: float) -> dict[str, Callable[[], object]]:
    calls: dict[str, Callable[[], object]] = {"coefficient": lambda: law.coefficient(v)}
    if not hasattr(law, "states"):
        return calls | {"slope": lambda: law.slope(v)}
    return calls | {
        "settled": lambda: law.settled(v),
        "force": lambda: law.force((v, 0.0), LOAD, law.settled(v)),
        "change": lambda: law.change((v, 0.0), LOAD, law.settled(v)),
    }


@contextmanager
def limit_lines(kind: type) -> Iterator[None]:
    """Limit the lines that the methods of a class, and their callees, may run.

    Raises
    ------
    NoEnd
        If they have run `LINES` lines.
    """
    left = LINES

    def count(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal left
        if frame.f_code.co_filename not in files:
            return None
        left -= 1
        if left < 0:
            raise NoEnd
        return count

    with _in_python(kind) as files:
        before = sys.gettrace()
        sys.settrace(count)
        try:
            yield
        finally:
            sys.settrace(before)


@contextmanager
def _in_python(kind: type) -> Iterator[set[str]]:
    """Run a class's functions as plain Python, not compiled; yield the files they are in."""
    methods, files = _methods(kind), set[str]()
    rooms = {id(each.__globals__): each.__globals__ for each in methods}.values()
    compiled = [(names, _compiled_in(names)) for names in rooms]
    for names, found in compiled:
        plain = {name: value.py_func for name, value in found.items()}
        files.update(each.__code__.co_filename for each in plain.values())
        names.update(plain)
    try:
        yield files.union(each.__code__.co_filename for each in methods)
    finally:
        for names, found in compiled:
            names.update(found)


def _methods(kind: type) -> list[Any]:
    """Return the methods of a class, also inherited ones, except tuple's own."""
    found = {
        name: each
        for base in reversed(kind.__mro__)
        for name, each in vars(base).items()
        if isfunction(each) and each.__module__ == base.__module__
    }
    return [*found.values()]


def _compiled_in(names: dict[str, Any]) -> dict[str, Any]:
    """Return the functions of a file that a user has compiled."""
    return {name: value for name, value in names.items() if hasattr(value, "py_func")}


@lru_cache(maxsize=256)
def printing(kind: type) -> str:
    """Return the method of a law, or the function that one calls, that prints; '' for none."""
    found = _methods(kind)
    for each in found:  # and each that it calls
        if "print" in each.__code__.co_names:
            return str(each.__name__)
        compiled = _compiled_in(each.__globals__)
        called = (compiled[name].py_func for name in each.__code__.co_names if name in compiled)
        found += [function for function in called if function not in found]
    return ""


def fault(message: str, key: str = "law") -> DescriptionError:
    """Return the error for a fault in the table [friction]."""
    return DescriptionError.of(f"friction.{key}", message)


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
    if hasattr(found, "states") and not _is_free(found.states):
        raise fault(f"{echo(name)}.states() takes no argument; write @staticmethod above it")
    if printer := printing(found):  # compiled, it would not end
        raise fault(
            f"{echo(name)}: {printer} prints, and a run calls it many thousands of times; take "
            "print out, and call the method in Python to see what it returns"
        )
    law: type[Any] = found
    return law


def _is_free(method: Callable[..., object]) -> bool:
    """Return whether a method can be called on its class, without an argument."""
    try:
        inspect.signature(method).bind()
    except TypeError:
        return False
    except ValueError:  # unknown: not of Python
        return True
    return True


def try_law(law: Any, name: str) -> Any:
    """Return the law, if its methods return finite values at a few speeds, and it is `sound`."""
    check_end(law, name)
    for method, v in _probes(law):
        try:
            value = getattr(law, method)(v)
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # whatever the user's law raises
            what = (
                f"{method}(law, {v:g}) of {echo(name)} raises {one_line(error)}; correct it there"
            )
            raise fault(what) from None
        if _is_number(value) and not isfinite(float(value)):
            raise fault(f"{method}(law, {v:g}) of {echo(name)} is {echo(value)}; it must be finite")
    return sound(law, name)


def _probes(law: Any) -> list[tuple[str, float]]:
    """Return methods of a law and the slip speeds at which they are tried."""
    if has_state(law):
        return [("coefficient", PROBED[1])]
    return [(method, v) for method in SET_VALUED for v in PROBED]


def no_number(law: Any) -> tuple[str, str] | None:
    """Return the method of a law that returns something else than a number, and the fault."""
    for method, v in _probes(law):
        try:
            value = getattr(law, method)(v)
        except KeyboardInterrupt:
            raise
        except BaseException:  # other checks report it
            continue
        if not _is_number(value):
            return f"{method}(law, {v:g})", f"is {echo(value)}; it must be one number"
    return None


_no_number = once_for_each_law(no_number)


def check_end(law: Any, name: str) -> None:
    """Raise an error if a law cannot be distinguished from others, or a method does not end."""
    for key, value in law._asdict().items():
        try:
            hash(value)
        except TypeError:
            raise fault(
                f"{key} of {echo(name)} is a {type(value).__name__}, which may change; let each "
                "parameter be a number, or a tuple of numbers"
            ) from None
    try:
        refuse_unknown(type(law), FIELD)
        renew(type(law))
    except ValueError as error:
        raise fault(str(error)) from None
    if said := _endless(law):
        raise fault(f"{echo(name)}: {said}; {ENDING}")


def sound(law: Any, name: str) -> Any:
    """Return the law, if its methods end, and friction and slope can be right."""
    check_end(law, name)
    if said := _no_number(law) or (None if has_state(law) else _wrong(law)):
        method, rest = said
        raise fault(f"{method} of {echo(name)} {rest}")
    return law


@once_for_each_law
def _wrong(law: Any) -> tuple[str, str] | None:
    """Return a fault of a set-valued law at a few speeds: the method, and the reason.

    Where Python cannot tell a value, compiled code may: then nothing is known to be wrong.
    """
    for v in (0.0, *DENSE):
        if (mu := _value(law.coefficient, v)) < 0.0:
            what = f"is {mu:g}; it must not be negative: friction would push the mass on"
            return f"coefficient(law, {v:g})", what
    for v in SLOPES:
        given = _value(law.slope, v)
        wanted, error = derivative(partial(_value, law.coefficient), v)
        if abs(given - wanted) > error + WRONG * (abs(given) + abs(wanted)):
            what = (
                f"is {given:.4g} s/m, but there its coefficient changes by {wanted:.4g} s/m; let "
                "it return d(coefficient)/dv"
            )
            return f"slope(law, {v:g})", what
    coefficient, slope = partial(_value, law.coefficient), partial(_value, law.slope)
    if is_steep_at_rest(coefficient):
        what = (
            "falls infinitely fast from rest, as 1 - sqrt(v) does: runs at a slow drive would not "
            "end; let it be a straight line below a slow speed, such as 1 um/s"
        )
        return "coefficient(law, 0)", what
    largest = coefficient(0.0)
    for low, high in pairwise(DENSE):
        largest = max(coefficient(high), largest)
        found = jump(coefficient, slope, low, high, JUMP * largest)
        if found is not None:
            what = (
                f"jumps there from {found.before:.4g} to {found.after:.4g}; smooth the jump over a "
                "range of speeds, or give friction at rest as a field mu_static"
            )
            return f"coefficient(law, {found.at:g})", what
    return None


def _value(method: Callable[[float], Any], v: float) -> float:
    """Return a method's value at a slip speed (m/s); NaN if it raises an error."""
    try:
        return float(method(v))
    except KeyboardInterrupt:
        raise
    except BaseException:  # the run says what a law raises
        return nan


def _is_number(value: Any) -> bool:
    """Return whether compiled code may take a value as a number; a text in digits is none."""
    try:
        float(value)
    except (TypeError, ValueError, OverflowError):  # the last: an integer beyond floats
        return False
    return not isinstance(value, str | bytes)


def _is_its_own(value: Any, module: ModuleType) -> bool:
    return inspect.isclass(value) and value.__module__ == module.__name__
