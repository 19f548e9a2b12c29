"""A rig: its description, in which some values are uncertain."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from math import nan, radians
from pathlib import Path
from typing import Any, NamedTuple, Self

from pydantic_core import PydanticCustomError

from stiction.drive.recorded.reading import locator, with_rows
from stiction.errors import DescriptionError, Fault, StictionError, echo
from stiction.friction import law_table, read_law
from stiction.friction.user.loading import finder_for_descriptions, is_own
from stiction.inference.priors import Normal, Prior, Uniform, middle, prior_table, read_prior
from stiction.inference.simulated.restriction import is_allowed_somewhere
from stiction.names import picture
from stiction.system.parameter import change_parameter, change_parameters, quantity, unit
from stiction.system.slider import OPTIONAL_TABLES, SLIDER_TABLES, Slider, slider_of
from stiction.system.writing import parameter_table, slider_tables
from stiction.text.paths import canonical, slug, with_changes
from stiction.text.sections import Section, as_html
from stiction.text.toml import folder_of, gather, read_slider, toml_text
from stiction.text.units import NORMAL, QUANTITY, UNIFORM, Kind, split_uncertain

NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(.*?)\s*")
LARGEST_ANGLE = radians(89.9)  # at 90 deg the drive pulls across
UNCERTAIN = '{"phi": "2 +- 1 deg"}'
UNDRAWN = 7.1  # standard deviations from the mean: beyond, nothing is drawn (`priors.EDGE`)


class _Parts(NamedTuple):
    slider: Slider
    priors: dict[str, Prior]


class Rig(_Parts):
    """A rig: a slider, and the priors of its uncertain values.

    Parameters
    ----------
    slider : Slider
        Every uncertain value that is stated in text is put in the middle of its prior.
    priors : dict
        By the path of each uncertain parameter, what a description would state:
        ``"2 +- 1 deg"``, or a table of ``value`` and ``uncertainty``, or of ``low`` and ``high``.

    Raises
    ------
    DescriptionError
        With every fault of what is stated.

    Examples
    --------
    >>> import stiction as st
    >>> rig = st.Rig(st.presets.nakano_popov_2020(), {"phi": "1 +- 0.5 deg"})
    >>> rig.to_toml().splitlines()[4]
    'phi = { value = "1 deg", uncertainty = "0.5 deg" }'
    """

    __slots__ = ()

    def __new__(cls, slider: Slider, priors: Mapping[str, Any] | None = None) -> Self:
        """Read a slider and priors from text or tables."""
        if not isinstance(priors, Mapping | None):
            raise DescriptionError.of("priors", f"{echo(priors)} is not a dict; write {UNCERTAIN}")
        given = {canonical(path): its for path, its in (priors or {}).items()}
        if all(isinstance(its, Prior) for its in given.values()):
            return super().__new__(cls, slider_of(slider), given)
        tables = {path: spread(its) or its for path, its in given.items()}
        return super().__new__(cls, *with_priors(slider_of(slider), tables))

    def __repr__(self) -> str:
        """Return the call that makes an equal rig, with its priors as a description states them."""
        stated = in_the_middle(self.slider, self.priors) == self.slider
        return f"st.Rig({self.slider!r}, {self._prior_tables() if stated else self.priors!r})"

    @classmethod
    def from_toml(
        cls, path: str | Path, changes: Mapping[str, Any] | None = None, *, trust: bool = False
    ) -> Rig:
        """Read the rig that a description states, uncertain values included.

        Parameters
        ----------
        path, changes, trust
            As of `stiction.Slider.from_toml`.

        Raises
        ------
        DescriptionError
            With every fault.

        Examples
        --------
        >>> from math import degrees
        >>> import stiction as st
        >>> text = st.presets.nakano_popov_2020().to_toml().replace('"1 deg"', '"1 +- 0.5 deg"')
        >>> degrees(Rig.from_toml(text).priors["phi"].mean)
        1.0
        """
        folder = folder_of(path)
        read, strange = read_slider(path, changes)
        raw, lost = with_rows(read, locator(folder, trust))
        stated: dict[str, Any] = {}
        certain = {
            name: dict(without_spread(table, (name,), stated))
            if isinstance(table, Mapping)
            else table
            for name, table in raw.items()
        }
        find = finder_for_descriptions(folder, trust)
        own, wrong = is_own(certain.get("friction")), prior_faults(stated)
        try:
            slider = Slider.from_parts(
                gather(
                    certain,
                    {**SLIDER_TABLES, "friction": partial(read_law, find=find)},
                    absent=OPTIONAL_TABLES,
                    last=("friction",) if own else (),
                    known=[*strange, *lost, *(wrong if own else ())],
                )
            )
        except DescriptionError as error:
            others = [fault for fault in error.faults if fault not in wrong]
            raise DescriptionError(with_prior_faults(others, wrong, stated)) from None
        return cls(*with_priors(slider, stated))

    def _repr_html_(self) -> str:
        table = as_html([Section("Rig", [], parameter_table(self._tables()))])
        return table + picture("plot_slider", self.slider)

    def to_toml(self) -> str:
        """Return the description as TOML with units, with the priors of uncertain values.

        Examples
        --------
        >>> import stiction as st
        >>> text = st.presets.nakano_popov_2020().to_toml().replace('"1 deg"', '"1 +- 0.5 deg"')
        >>> Rig.from_toml(text).to_toml().splitlines()[4]
        'phi = { value = "1 deg", uncertainty = "0.5 deg" }'
        """
        return toml_text(self._tables())

    def _tables(self) -> dict[str, Any]:
        """Return the tables of the description."""
        tables, _ = with_changes(slider_tables(self.slider), self._prior_tables())
        return tables

    def _prior_tables(self) -> dict[str, dict[str, Any]]:
        """Return the table that states each prior."""
        return {
            path: prior_table(prior, unit(self.slider, path)) for path, prior in self.priors.items()
        }


def with_priors(slider: Slider, stated: Mapping[str, Any]) -> tuple[Slider, dict[str, Prior]]:
    """Return a slider at the medians of its uncertain values, and all priors.

    A value that is given as a `Prior` leaves the slider as it is.
    """
    priors = read_priors(partial(unit, slider), stated)
    told = [name for name, its in stated.items() if not isinstance(its, Prior)]
    slider = in_the_middle(slider, {name: priors[name] for name in told})
    priors = within_ranges(slider, priors)
    return in_the_middle(slider, {name: priors[name] for name in told}), priors


def rig_of(source: Any, changes: Mapping[str, Any] | None = None, trust: bool = False) -> Rig:
    """Return a rig: the given one, that of a file or text, or a slider without priors.

    `changes` and `trust` are those of `Rig.from_toml`, of a file or text.

    Raises
    ------
    DescriptionError
        If `source` is none of these.
    """
    if isinstance(source, Rig):
        return source
    if isinstance(source, str | Path):
        return Rig.from_toml(source, changes, trust=trust)
    return Rig(slider_of(source), {})


def is_rig(source: Any) -> bool:
    """Return whether the argument is a rig, a slider, a description or its path, not a record."""
    if isinstance(source, str | Path):
        return Path(source).suffix.lower() == ".toml"
    return isinstance(source, Rig) or (
        isinstance(getattr(source, "slider", source), Slider)
        and (
            not hasattr(source, "samples")  # a run is a record
        )
    )


def refuse_swapped(rig: Any, records: Any, remedy: str) -> None:
    """Refuse a rig in the place of records, or records in that of a rig.

    Raises
    ------
    DescriptionError
        With the order of both, the `remedy`.
    """
    many = not isinstance(rig, str | Rig) and isinstance(rig, Sequence) and not is_rig(rig)
    measured = hasattr(rig, "force") or hasattr(rig, "samples")  # a record or a run
    if is_rig(records) or many or measured:
        raise DescriptionError.of("", remedy)


def load_of_records(rig: Rig) -> float:
    """Return the normal load (N) of a rig's records; NaN if it is uncertain or varies.

    >>> import stiction as st
    >>> text = st.presets.nakano_popov_2020().to_toml()
    >>> load_of_records(Rig.from_toml(text))
    10.0
    """
    certain = "normal_load" not in rig.priors and rig.slider.load is None
    return rig.slider.normal_load if certain else nan


def stored_text(rig: Rig) -> str:
    """Return a description as TOML for a results file, with the text of a user's law.

    `Rig.from_toml` reads it: it runs that text only with `trust`.
    """
    tables, law = rig._tables(), law_table(rig.slider.law)
    text = {key: law[key] for key in law.keys() & {"source", "reads"}}
    return toml_text({**tables, "friction": {**tables["friction"], **text}})


def stated_names(source: Any, changes: Mapping[str, Any] | None = None) -> list[str]:
    """Return the paths of a description's uncertain values, even if it has faults.

    None are known where no description is given, or where it cannot be read.
    """
    if not isinstance(source, str | Path):
        return []
    stated: dict[str, Any] = {}
    with suppress(StictionError):
        raw, _ = read_slider(source, changes)
        for name, table in raw.items():
            if isinstance(table, Mapping):
                dict(without_spread(table, (name,), stated))
    return [*stated]


def without_spread(
    table: Mapping[str, Any], keys: tuple[str, ...], stated: dict[str, Any]
) -> Iterator[tuple[str, Any]]:
    """Yield a table's items with a plain value for each uncertain one, moved to `stated`."""
    for key, value in table.items():
        yield key, _certain(value, (*keys, key), stated)


def _certain(value: Any, keys: tuple[str, ...], stated: dict[str, Any]) -> Any:
    """Return a value without uncertainty; do the same inside tables and lists of tables."""
    parsed = spread(value)
    if parsed is not None:
        stated[canonical(".".join(keys))] = parsed
        return parsed["value"] if "value" in parsed else between(parsed)
    if isinstance(value, Mapping):
        return dict(without_spread(value, keys, stated))
    if isinstance(value, list):
        return [
            _certain(each, (*keys, element_key(each, number)), stated)
            if isinstance(each, Mapping)
            else each
            for number, each in enumerate(value, 1)
        ]
    return value


def between(table: Mapping[str, Any]) -> Any:
    """Return the middle of a uniform prior's ends; `low` if their units differ.

    >>> between({"low": 0.2, "high": 0.5}), between({"low": "1 deg", "high": "3 deg"})
    (0.35, '2.0 deg')
    >>> between({"low": "1 um", "high": "3 mm"})
    '1 um'
    """
    parts = [NUMBER.fullmatch(str(table[end])) for end in ("low", "high")]
    if not all(parts):
        return table["low"]
    (low, unit), (high, other) = (part.groups() for part in parts if part)
    if unit != other:
        return table["low"]
    value = 0.5 * (float(low) + float(high))
    return f"{value!r}{unit}" if unit else value


def element_key(element: Mapping[str, Any], number: int) -> str:
    """Return the key of a table in a list: its name, or its number.

    >>> element_key({"name": "Load cell"}, 1), element_key({}, 2)
    ('load-cell', '2')
    """
    return slug(element["name"]) if "name" in element else str(number)


def spread(value: Any) -> dict[str, Any] | None:
    """Return an uncertain value as a table; None for any other value.

    >>> spread("2 +- 1 deg")
    {'value': '2 deg', 'uncertainty': '1 deg'}
    """
    if isinstance(value, Mapping):
        keys = set(value)
        ours = keys >= NORMAL or keys >= UNIFORM
        return dict(value) if ours else None
    both = split_uncertain(value)
    return None if both is None else {"value": both[0], "uncertainty": both[1]}


def with_prior_faults(
    faults: Sequence[Fault], wrong: Sequence[Fault], stated: Mapping[str, Mapping[str, Any]]
) -> list[Fault]:
    """Return a description's faults, and the faults of uncertain values at other paths.

    A value that cannot be read stands for a prior: where it is the middle of one, that is said.
    """
    found, places = [], {canonical(fault.path) for fault in faults}
    for path, message in faults:
        table = stated.get(canonical(path), {})
        between = f"; it lies between low = {echo(table.get('low'))} and high" * ("low" in table)
        found.append(Fault(path, message + between))
    return found + [fault for fault in wrong if fault.path not in places]


def prior_faults(stated: Mapping[str, Mapping[str, Any]]) -> Sequence[Fault]:
    """Return the faults of uncertain values, checked without knowledge of their parameters."""
    try:
        read_priors(lambda path: own_unit(stated[path]), stated)
    except DescriptionError as error:
        return error.faults
    return ()


def own_unit(table: Mapping[str, Any]) -> str:
    """Return the first unit that a prior's table contains; '' for plain numbers.

    >>> own_unit({"low": 0, "high": "3 deg"}), own_unit({"value": 0.3, "uncertainty": "10 %"})
    ('deg', '')
    """
    found = [QUANTITY.fullmatch(str(value)) for value in table.values()]
    units = [each[2].strip() for each in found if each]
    return next((each for each in units if each not in ("", "%")), "")


def read_priors(unit_at: Callable[[str], str], stated: Mapping[str, Any]) -> dict[str, Prior]:
    """Return the prior of each uncertain parameter, in the unit by `unit_at`, or every fault."""
    priors, faults = dict[str, Prior](), list[Fault]()
    for path, table in stated.items():
        try:
            its = unit_at(path)
            if isinstance(table, Prior):
                priors[path] = table
                continue
            if not isinstance(table, Mapping):
                raise ValueError(f"{echo(table)} is not uncertain; write as in {UNCERTAIN}")
            example = "1 deg" if its == "rad" else f"1 {its}".rstrip()
            priors[path] = read_prior(table, Kind(path, its, example))
        except PydanticCustomError as error:
            faults.append(Fault(path, error.message()))
        except DescriptionError as error:
            faults += error.faults
        except ValueError as error:
            faults.append(Fault(path, str(error)))
    if faults:
        raise DescriptionError(faults)
    return priors


def in_the_middle(slider: Slider, priors: Mapping[str, Prior]) -> Slider:
    """Return the slider with every uncertain value at the median of its prior."""
    middles = {name: middle(prior) for name, prior in priors.items()}
    given = {name: quantity(slider, name, value) for name, value in middles.items()}
    return change_parameters(slider, given) if given else slider


def within_ranges(slider: Slider, priors: Mapping[str, Prior]) -> dict[str, Prior]:
    """Return the priors, restricted to possible values; or every fault.

    `slider` is in the middle of them.
    """
    found, faults = dict[str, Prior](), list[Fault]()
    for path, prior in priors.items():
        others = {name: its for name, its in priors.items() if name != path}
        try:
            found[path] = within_range(slider, path, prior, others)
        except DescriptionError as error:
            faults += error.faults
    if faults:
        raise DescriptionError(faults)
    return found


def within_range(slider: Slider, path: str, prior: Prior, others: Mapping[str, Prior]) -> Prior:
    """Return a prior restricted to possible values; refuse a uniform one with an impossible end."""
    if isinstance(prior, Uniform):
        for end in (prior.low, prior.high):
            try:
                change_parameter(slider, path, quantity(slider, path, end))
            except DescriptionError:
                if not is_allowed_somewhere(slider, {path: end}, others):
                    raise
        return prior
    if path == "phi" and abs(prior.mean) + UNDRAWN * prior.deviation > LARGEST_ANGLE:
        return Normal(prior.mean, prior.deviation, -LARGEST_ANGLE, LARGEST_ANGLE)
    try:
        change_parameter(slider, path, quantity(slider, path, -max(abs(prior.mean), 1e-30)))
    except DescriptionError:
        return Normal(prior.mean, prior.deviation, low=0.0)
    return prior
