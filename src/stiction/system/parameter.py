"""One parameter of a slider by its name: what it is, and the slider with another value of it.

A path is a field of `Slider` (``phi``, ``c_x``), or one of its drive's or of its friction law's
(``drive.velocity``, ``friction.mu_inf``); several that share one value are joined by commas, as
``"k_x, k_y"`` for a spring that is equally stiff in all directions. ``V`` is short for
``drive.velocity``, ``W`` for ``normal_load``, ``m`` for ``mass``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, get_type_hints

from stiction.errors import DescriptionError, Fault
from stiction.friction import Anisotropic
from stiction.system.slider import Apparatus, Slider
from stiction.text.paths import canonical
from stiction.text.units import unit_of
from stiction.text.validation import made, unknown


def units(slider: Slider) -> dict[str, str]:
    """Return the path of every parameter that is one number, and its SI unit ('' for none).

    Those of an anisotropic law are listed with those of the law that it holds.
    """
    law: Any = slider.law
    own = {f"friction.{name}": unit for name, unit in _units(law).items()}
    held = _units(law.law) if isinstance(law, Anisotropic) else {}
    return {
        **{name: unit for name, unit in _units(slider).items() if name in Apparatus.model_fields},
        "drive.velocity": "m/s",
        **{f"friction.{name}": unit for name, unit in held.items()},
        **own,
    }


def unit(slider: Slider, path: str) -> str:
    """Return the SI unit of a parameter, '' for a number without one.

    Raises
    ------
    DescriptionError
        If the slider has no such parameter, or those that are joined differ in their unit.
    """
    known = units(slider)
    joined = names(path)
    found = [Fault(name, unknown("parameter", name, known)) for name in joined if name not in known]
    if found:
        raise DescriptionError(found)
    if len({known[name] for name in joined}) > 1:
        listed = ", ".join(f"{name} ({known[name] or 'a number'})" for name in joined)
        raise DescriptionError([Fault(path, f"cannot share one value: {listed}; name one of them")])
    return known[joined[0]]


def read(slider: Slider, path: str) -> float:
    """Return the value of a parameter, in SI.

    Raises
    ------
    DescriptionError
        If the slider has no such parameter, or those that are joined differ in value.

    Examples
    --------
    >>> import stiction as st
    >>> read(st.presets.nakano_popov_2020(), "friction.v_f")
    0.01
    """
    unit(slider, path)
    values = {name: float(_value(slider, name)) for name in names(path)}
    if len(set(values.values())) > 1:
        listed = ", ".join(f"{name} is {value:g}" for name, value in values.items())
        raise DescriptionError([Fault(path, f"has no one value: {listed}; set both first")])
    return next(iter(values.values()))


def changed(slider: Slider, path: str, value: float | str) -> Slider:
    """Return the slider with another value of a parameter.

    Parameters
    ----------
    slider : Slider
        The system.
    path : str
        Which parameter.
    value : float or str
        In SI, or with its unit; an angle needs its unit.

    Raises
    ------
    DescriptionError
        If the slider has no such parameter, or it cannot have this value.

    Examples
    --------
    >>> import stiction as st
    >>> changed(st.presets.nakano_popov_2020(), "drive.velocity", "2 mm/s").drive.velocity
    0.002
    """
    unit(slider, path)
    for name in names(path):
        room, _, field = name.rpartition(".")
        part = {field: value}
        if room:
            part = {room: _remade(getattr(slider, room), field, value)}
        slider = slider.replace(**part)
    return slider


def placed(slider: Slider, path: str, value: float) -> Slider:
    """Return the slider with a parameter at `value` (SI), unchecked: `changed` for inner loops.

    The path must be known, and the value lie between two that `changed` takes.
    """
    for name in names(path):
        room, _, field = name.rpartition(".")
        new: Any = value
        if room:
            field, new = room, _replaced(getattr(slider, room), field, value)
        slider = slider.model_copy(update={field: new})
    return slider


def names(path: str) -> list[str]:
    """Return the paths that are joined in one, short names such as ``V`` resolved."""
    return [canonical(name) for name in path.split(",")]


def _units(owner: Any) -> dict[str, str]:
    """Return the fields of a description or of a law that are one number, with their units."""
    hints = get_type_hints(type(owner), include_extras=True)
    fields = owner._fields if hasattr(owner, "_fields") else type(owner).model_fields
    return {
        name: unit_of(hints.get(name))
        for name in fields
        if isinstance(getattr(owner, name), float | int)
    }


def _holder(part: Any, field: str) -> bool:
    """Return whether a parameter belongs to the law that an anisotropic one holds."""
    return isinstance(part, Anisotropic) and field not in part._fields


def _value(slider: Slider, name: str) -> Any:
    room, _, field = name.rpartition(".")
    part = getattr(slider, room) if room else slider
    return getattr(part.law if _holder(part, field) else part, field)


def _remade(part: Any, field: str, value: float | str) -> Any:
    """Return a drive or a law with another value of a field, read and checked anew."""
    if _holder(part, field):
        return _remade(part, "law", _remade(part.law, field, value))
    if not hasattr(part, "_asdict"):  # a drive's program
        return type(part)(**{**_given(part), field: value})
    return made(type(part), {**_written(part), field: value})


def _replaced(part: Any, field: str, value: float) -> Any:
    if _holder(part, field):
        return part._replace(law=part.law._replace(**{field: value}))
    replace = getattr(part, "_replace", None)
    return part.model_copy(update={field: value}) if replace is None else replace(**{field: value})


def _given(part: Any) -> Mapping[str, Any]:
    return {name: getattr(part, name) for name in part.model_fields_set}


def _written(part: Any) -> Mapping[str, Any]:
    """Return a law's or a drive's fields as they are read: angles with their unit."""
    angles = [name for name, its in _units(part).items() if its == "rad"]
    values: dict[str, Any] = part._asdict()
    return {**values, **{name: f"{values[name]!r} rad" for name in angles}}
