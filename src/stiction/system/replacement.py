"""Parameters that `Slider.replace` does not take: where they are, and the call for each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from stiction.errors import Fault, echo
from stiction.friction import Anisotropic, parameters
from stiction.text.paths import SETTINGS, canonical
from stiction.text.validation import unknown_name

LONGEST = 300  # characters of a call that is written out in a message


def refusals(slider: Any, changes: Mapping[str, Any], known: Iterable[str]) -> list[Fault]:
    """Return a fault for each change of no field of a slider, with the right call if there is one.

    Parameters
    ----------
    slider : Slider
        The slider.
    changes : mapping
        New values by name.
    known : iterable of str
        Its fields.
    """
    fields, kind = [*known], type(slider).__name__
    found = []
    for name, value in changes.items():
        if name not in fields:
            said = right_call(slider, name, value, fields) or unknown_name("key", name, fields)
            found.append(Fault(f"{kind}.{name}", said))
    return found


def right_call(slider: Any, name: str, value: Any, fields: list[str]) -> str:
    """Return where a parameter is, and the call that changes it; '' if there is no such one."""
    path = canonical(name)
    key = path.removeprefix("friction.")
    if path in fields:
        return f"is {path}; write slider.replace({path}={echo(value)})"
    if path == "drive.velocity":
        return _call_with("drive", slider.drive, path, {"velocity": value})
    if hasattr(slider.law, "_asdict") and key in parameters(slider.law):
        return _call_with("friction", slider.law, f"friction.{key}", {key: value})
    if path in SETTINGS:
        return f"is a setting of a run; write st.simulate(slider, ..., {path}={echo(value)})"
    return ""


def _call_with(field: str, part: Any, path: str, values: Mapping[str, Any]) -> str:
    """Return the call that replaces a part of a slider by one with another value."""
    call = f"slider.replace({field}={_with_value(part, values)!r})"
    if len(call) > LONGEST:
        (name, value), *_ = values.items()
        call = f"slider.replace({field}=...) with {name}={echo(value)}"
    return f"is {path}; write {call}"


def _with_value(part: Any, values: Mapping[str, Any]) -> Any:
    """Return a law or a drive with another value, unread: as a call has it."""
    if isinstance(part, Anisotropic) and not values.keys() <= {*part._fields}:
        return part._replace(law=_with_value(part.law, values))
    return part._replace(**values) if hasattr(part, "_replace") else part.model_copy(update=values)
