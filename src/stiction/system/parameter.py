"""One parameter of a slider, or of a whole description, by its path: read it or change it.

A path is a field of `Slider` (``phi``, ``c_x``), or of its drive, load or friction law
(``drive.velocity``, ``load.program.1.to``, ``friction.mu_inf``); in a description also of the
initial state or the settings (``initial.u_x``, ``run.rtol``). Commas join several that share one
value: ``"k_x, k_y"`` for a spring that is equally stiff in all directions. Elements of a list count
from 1, and springs in series are known by their names too: ``springs.load-cell.k_x``. ``V`` is
short for ``drive.velocity``, ``W`` for ``normal_load``, ``m`` for ``mass``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar, cast, get_args

from stiction.drive.pieces import LEVELS
from stiction.drive.program import DriveProgram, refuse_idle_base
from stiction.errors import DescriptionError, Fault, Faults, echo
from stiction.friction import LAWS, Anisotropic
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import FROM_SPRINGS, Slider
from stiction.text.paths import canonical, keys_of
from stiction.text.units import Quantity, hints_of, unit_of
from stiction.text.validation import fields_to_read, make, unknown_name

Owner = TypeVar("Owner", Slider, Description)
KINDS = {"slider": Slider, "drive": DriveProgram, "initial": Initial, "run": Settings}
LEVEL_UNITS = {"drive": "m/s", "load": "N"}  # of pieces, whose quantity depends on their program


def units(owner: Slider | Description) -> dict[str, str]:
    """Return the path and SI unit ('' for none) of every parameter that is one number.

    For an anisotropic law, the parameters of its inner law are included.
    """
    return dict(_numbers(owner, ()))


def unit(owner: Slider | Description, path: str) -> str:
    """Return the SI unit of a parameter, '' for a number without one.

    Raises
    ------
    DescriptionError
        If there is no such parameter, or joined ones differ in their unit.
    """
    found: dict[str, str] = {}
    faults: list[Fault] = []
    for name in names(path):
        try:
            found[name] = _unit(owner, name)
        except DescriptionError as error:
            faults += error.faults
    if faults:
        raise DescriptionError(faults)
    if len(set(found.values())) > 1:
        listed = ", ".join(f"{name} ({its or 'a number'})" for name, its in found.items())
        raise DescriptionError.of(path, f"cannot share one value: {listed}; name one of them")
    return next(iter(found.values()))


def stated_unit(tables: Mapping[str, Any], name: str) -> str | None:
    """Return the SI unit of a quantity by the kind of its table, which need not be valid.

    None where that does not tell, as of a part of a program, or of a plain number.

    >>> stated_unit({"friction": {"law": "stribeck"}}, "friction.v_s"), stated_unit({}, "V")
    ('m/s', 'm/s')
    """
    try:
        title, *keys = keys_of(tables, name)
    except KeyError:
        return None
    law = tables.get("friction")
    kinds = {**KINDS, "friction": LAWS.get(str(law.get("law")) if isinstance(law, Mapping) else "")}
    kind = kinds.get(title)
    return None if kind is None or len(keys) != 1 else _unit_in(hints_of(kind).get(keys[0])) or None


def read(owner: Slider | Description, path: str) -> float:
    """Return the value of a parameter, in SI.

    Raises
    ------
    DescriptionError
        If there is no such parameter, it has no value, or joined ones differ in value.

    Examples
    --------
    >>> import stiction as st
    >>> read(st.presets.nakano_popov_2020(), "friction.v_f")
    0.01
    """
    unit(owner, path)
    values = {name: _value(owner, name) for name in names(path)}
    if len(set(values.values())) > 1:
        listed = ", ".join(f"{name} is {value:g}" for name, value in values.items())
        raise DescriptionError.of(path, f"has no one value: {listed}; set both first")
    return next(iter(values.values()))


def change_parameter(owner: Owner, path: str, value: Quantity) -> Owner:
    """Return a slider or description with another value of a parameter.

    Parameters
    ----------
    owner : Slider or Description
        The system.
    path : str
        The parameter.
    value : float or str
        In SI, or with its unit; an angle needs its unit.

    Raises
    ------
    DescriptionError
        If there is no such parameter, or the value is invalid.

    Examples
    --------
    >>> import stiction as st
    >>> change_parameter(st.presets.nakano_popov_2020(), "drive.velocity", "2 mm/s").drive.velocity
    0.002
    """
    unit(owner, path)
    return change_parameters(owner, {path: value})


def change_parameters(owner: Owner, changes: Mapping[str, Quantity]) -> Owner:
    """Return a slider or description with several parameters changed, validated together.

    Raises
    ------
    DescriptionError
        With every parameter that cannot have its value.
    """
    tree: dict[str, Any] = {}
    for path, value in changes.items():
        for name in names(path):
            *rooms, field = _keys(owner, name)
            branch = tree
            for room in rooms:
                branch = branch.setdefault(room, {})
            branch[field] = value
    drive = (owner.slider if isinstance(owner, Description) else owner).drive
    refuse_idle_base(drive, (name for path in changes for name in names(path)))
    if not isinstance(owner, Description):
        return cast(Owner, _remake_at("", owner, tree))
    faults, parts = Faults(), {}
    for room, new in tree.items():
        with faults.of_part():
            parts[room] = _remake_at("" if room == "slider" else room, getattr(owner, room), new)
    faults.refuse()
    return owner._replace(**parts)


def change_unchecked(slider: Slider, path: str, value: float) -> Slider:
    """Return the slider with a parameter at `value` (SI), without a check, for inner loops.

    The path must exist, and the value lie between two that `change_parameter` accepts.
    """
    for name in names(path):
        slider = _place(slider, _keys(slider, name), value)
    return slider


def names(path: str) -> list[str]:
    """Return the paths joined in one; short names such as ``V`` are resolved."""
    return [canonical(name) for name in path.split(",")]


def _keys(owner: Slider | Description, name: str) -> list[str]:
    """Return the fields that lead to a parameter."""
    keys = name.split(".")
    springs = (owner if isinstance(owner, Slider) else owner.slider).springs
    if (
        keys[0] == "springs"
        and len(keys) > 1
        and keys[1].isdigit()
        and 0 < int(keys[1]) <= len(springs)
    ):
        keys[1] = springs[int(keys[1]) - 1].slug
    return keys if isinstance(owner, Slider) or keys[0] in ("initial", "run") else ["slider", *keys]


def quantity(slider: Slider, path: str, value: float) -> float | str:
    """Return the value of a parameter in SI as a slider reads it: an angle with its unit."""
    return f"{value!r} rad" if unit(slider, path) == "rad" else value


def _unit(owner: Slider | Description, name: str) -> str:
    *rooms, field = _keys(owner, name)
    part: Any = owner
    for room in rooms:
        part = _member(owner, part, room, name)
    value = _member(owner, part, field, name)
    its = _unit_of(part, rooms, field)
    if not _is_number(value) and (value is not None or not its):
        raise DescriptionError.of(name, f"is not one number, it is {echo(value)}")
    return its


def _unit_of(part: Any, rooms: list[str], field: str) -> str:
    its = _unit_in(hints_of(type(_holder(part, field))).get(field))
    room = next((each for each in rooms if each in LEVEL_UNITS), "")
    return its or (LEVEL_UNITS.get(room, "") if field in LEVELS else "")


def _unit_in(hint: Any) -> str:
    return next((u for each in (hint, *get_args(hint)) if (u := unit_of(each))), "")


def _member(owner: Slider | Description, part: Any, key: str, name: str) -> Any:
    """Return a member of a part by its key; a list's elements count from 1."""
    if isinstance(part, Slider) and part.springs and key in FROM_SPRINGS:
        own = ", ".join(f"springs.{each.slug}.{key}" for each in part.springs)
        message = f"follows from springs in series; change one of them: {own}"
        raise DescriptionError.of(name, message)
    if key not in _fields(part):
        raise DescriptionError.of(name, unknown_name("parameter", name, units(owner)))
    return _part(part, key)


def _numbers(part: Any, keys: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield path and unit of each parameter below some keys that is one number, not a count."""
    for key in _fields(part):
        value = _part(part, key)
        if isinstance(value, float):
            yield canonical(".".join([*keys, key])), _unit_of(part, list(keys), key)
        else:
            yield from _numbers(value, (*keys, key))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _value(owner: Slider | Description, name: str) -> float:
    part: Any = owner
    for key in _keys(owner, name):
        part = _part(part, key)
    if part is None:
        raise DescriptionError.of(name, "is not given")
    return float(part)


def _fields(part: Any) -> tuple[str, ...]:
    """Return the keys of a part of a description; none if it has no parts."""
    if isinstance(part, Anisotropic):
        return (*part.law._fields, "ratio", "angle")
    if hasattr(part, "_fields"):
        return tuple(part._fields)
    if isinstance(part, tuple):
        return tuple(getattr(each, "slug", str(count)) for count, each in enumerate(part, 1))
    return part.own_fields() if hasattr(part, "own_fields") else ()


def _part(part: Any, key: str) -> Any:
    if isinstance(part, tuple) and key in (keys := _fields(part)) and not hasattr(part, "_fields"):
        return part[keys.index(key)]
    return getattr(_holder(part, key), key)


def _holder(part: Any, key: str) -> Any:
    """Return the owner of a field: for an anisotropic law, perhaps its inner law."""
    return part.law if isinstance(part, Anisotropic) and key not in part._fields else part


def _remake_at(path: str, part: Any, changes: Mapping[str, Any]) -> Any:
    """Do as `_remake`, with faults below a path."""
    try:
        return _remake(part, changes)
    except DescriptionError as error:
        raise error.at(path) from None


def _remake(part: Any, changes: Mapping[str, Any]) -> Any:
    """Return a part of a description with some fields changed, and validated."""
    if isinstance(part, Anisotropic):
        inner = {key: value for key, value in changes.items() if key not in part._fields}
        own = {key: value for key, value in changes.items() if key in part._fields}
        law = _remake(part.law, inner) if inner else part.law
        return Anisotropic(**{**_field_values(part), **own, "law": law})
    faults, new, made = Faults(), {**changes}, part
    for key, value in changes.items():
        if isinstance(value, Mapping):
            new[key] = _part(part, key)
            with faults.of_part():
                new[key] = _remake_at(f"{type(part).__name__}.{key}", new[key], value)
    with faults.of_part():
        made = _with_fields(part, new)
    faults.refuse()
    return made


def _with_fields(part: Any, new: Mapping[str, Any]) -> Any:
    """Return a part of a description with other values of some fields."""
    if hasattr(part, "replace"):
        return part.replace(**new)
    if isinstance(part, tuple) and not hasattr(part, "_fields"):
        return [new.get(key, each) for key, each in zip(_fields(part), part, strict=True)]
    if isinstance(part, tuple):
        return make(type(part), {**_field_values(part), **new})
    return type(part)(**{**_field_values(part), **new})


def _place(part: Any, keys: list[str], value: float) -> Any:
    key, *rest = keys
    if isinstance(part, tuple) and not hasattr(part, "_fields"):
        new: Any = {key: _place(_part(part, key), rest, value) if rest else value}
        return tuple(new.get(its, each) for its, each in zip(_fields(part), part, strict=True))
    if _holder(part, key) is not part:
        return part._replace(law=_place(part.law, keys, value))
    new = _place(_part(part, key), rest, value) if rest else value
    if key == "springs":  # the stiffnesses follow
        return part.replace(springs=new)
    replace = getattr(part, "_replace", None)
    return part.model_copy(update={key: new}) if replace is None else replace(**{key: new})


def _field_values(part: Any) -> dict[str, Any]:
    """Return the fields of a part, ready to be read: angles with their unit."""
    return fields_to_read(part, getattr(part, "_fields", None) or part.model_fields_set)
