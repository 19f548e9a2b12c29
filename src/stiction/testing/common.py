"""Checks of any law: pickling, descriptions and a simulation; with shared helpers."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Iterable, Iterator, Sequence
from math import isfinite, nan
from typing import Any

from stiction import presets
from stiction.errors import StictionError
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider

SPEEDS: tuple[float, ...] = (0.0, *(10.0 ** (i / 4) for i in range(-36, 5)))
LIBRARY_ROUNDING = 1e-12  # exp and pow of two libraries agree to some units of the last digit


def first(found: Iterable[str]) -> Iterator[str]:
    """Yield the first fault, and how many more there are of its kind."""
    every = list(found)
    more = f" (and {len(every) - 1} more like it)" if len(every) > 1 else ""
    yield from (f"{each}{more}" for each in every[:1])


def attempt(function: Callable[..., Any], *arguments: Any) -> tuple[float, str]:
    """Return a function's value and no fault, or NaN and its error."""
    try:
        return float(function(*arguments)), ""
    except Exception as error:  # whatever a user's law raises
        return nan, f"raises {error_line(error)}; it must return a number here"


def fault_of(value: float, fault: str) -> str:
    """Return the fault of a value: its error, or that it is not finite."""
    if fault or isfinite(value):
        return fault
    return f"is {value}; it must be finite: look for a division by zero or an overflow"


def error_line(error: Exception) -> str:
    """Return an error in one line."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return f"{type(error).__name__}: {lines[0]}" if lines else type(error).__name__


def run_compiled(
    law: Any, function: Callable[..., Any], inputs: Iterable[Sequence[Any]]
) -> tuple[list[Any], list[str]]:
    """Return the compiled results of a function of a law, or none and why it does not compile."""
    import numba

    from stiction.solver.compilation import refusal

    fast = numba.njit(error_model="numpy")(lambda law, *given: function(law, *given))
    prepared = getattr(law, "prepare", lambda: law)()
    try:
        return [fast(prepared, *each) for each in inputs], []
    except Exception:
        return [], [why for why in refusal.reasons(law) if why.startswith(function.__name__)]


def check_storage(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that a law pickles, copies, compares and hashes."""
    ways: dict[str, Callable[[], Any]] = {
        "pickling it": lambda: pickle.loads(pickle.dumps(law)),
        "copying it": lambda: copy.deepcopy(law),
        "making it from its fields": lambda: type(law)(*law),
    }
    for way, again in ways.items():
        try:
            if not bool(again() == law) or hash(again()) != hash(law):
                yield f"{way} gives another law; let it be a NamedTuple of numbers"
        except Exception as error:
            yield (
                f"{way} fails, {error_line(error)}; let it be a NamedTuple of numbers, defined at "
                "the top level of a file"
            )


def check_description(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that a law survives a description in JSON."""
    try:
        before = Description(_preset(law), Initial(), Settings(duration=1.0))
        after = Description.from_json(before.to_json())
    except (StictionError, TypeError, ValueError) as error:
        yield f"cannot be written to JSON and read back, {error_line(error)}"
        return
    if after != before or type(after.slider.law) is not type(law):
        yield f"read back from JSON it is {after.slider.law!r}, not {law!r}; use floats only"


def check_simulation(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that the paper's system runs for 20 ms: first stick, release, stick-slip."""
    from stiction.simulation import simulate

    try:
        run = simulate(_preset(law), duration=0.02, sample_rate=0)
    except Exception as error:
        yield f"the paper's system cannot be simulated with it, {error_line(error)}"
        return
    if not run.status.ok:
        yield f"the paper's system ended early at {float(run.final.time):g} s: {run.status.value}"


def _preset(law: Any) -> Slider:
    return presets.nakano_popov_2020().replace(friction=law)


COMMON = {"kept": check_storage, "described": check_description, "simulated": check_simulation}
