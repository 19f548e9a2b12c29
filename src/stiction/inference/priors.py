"""Priors: what the description of a rig says is uncertain, and by how much.

A value of a description may be uncertain in three ways:

    phi = "2 +- 1 deg"                                  # also "2 ± 1 deg"
    phi = {value = "2 deg", uncertainty = "1 deg"}      # a normal distribution; also "5 %"
    phi = {low = "0.5 deg", high = "5 deg"}             # uniform; scale = "log": of its logarithm

A normal distribution ends where a value would be impossible, such as a stiffness at zero.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from math import inf, log
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pydantic_core import PydanticCustomError

from stiction.arrays import Floats
from stiction.drive.recorded.reading import locator, with_rows
from stiction.errors import DescriptionError, Fault, echo
from stiction.friction import read_law
from stiction.friction.user.loading import finder_for_descriptions, is_own
from stiction.system.parameter import change_parameter, change_parameters, quantity, unit
from stiction.system.slider import OPTIONAL_TABLES, SLIDER_TABLES, Slider, slider_of
from stiction.text.paths import canonical
from stiction.text.toml import folder_of, gather, read_toml
from stiction.text.units import Kind, split_uncertain, to_si

NORMAL = {"value", "uncertainty"}
UNIFORM = {"low", "high"}
SCALES = ("linear", "log")
EDGE = 1e-12  # shares beyond which a quantile would be infinite


@dataclass(frozen=True)
class Normal:
    """A normal distribution between two bounds.

    >>> Normal(2.0, 1.0, low=0.0).quantile(np.array([0.0, 0.5]))
    array([0.        , 2.028...])
    """

    mean: float
    deviation: float
    low: float = -inf
    high: float = inf

    def quantile(self, share: Floats) -> Floats:
        """Return the values below which these shares of the distribution lie."""
        from scipy.special import ndtr, ndtri

        below, until = (ndtr((x - self.mean) / self.deviation) for x in (self.low, self.high))
        inner = np.clip(below + share * (until - below), EDGE, 1.0 - EDGE)
        return np.asarray(np.clip(self.mean + self.deviation * ndtri(inner), self.low, self.high))

    def share(self, value: Floats) -> Floats:
        """Return the shares of the distribution below these values."""
        from scipy.special import ndtr

        below, until = (ndtr((x - self.mean) / self.deviation) for x in (self.low, self.high))
        inside = ndtr((np.asarray(value) - self.mean) / self.deviation)
        return np.asarray(np.clip((inside - below) / (until - below), 0.0, 1.0))


@dataclass(frozen=True)
class Uniform:
    """A uniform distribution of a value, or of its logarithm.

    >>> Uniform(1.0, 100.0, "log").quantile(np.array([0.5])).round(9)
    array([10.])
    """

    low: float
    high: float
    scale: str = "linear"

    def quantile(self, share: Floats) -> Floats:
        """Return the values below which these shares of the distribution lie."""
        if self.scale == "log":
            return np.asarray(self.low * (self.high / self.low) ** np.asarray(share))
        return np.asarray(self.low + (self.high - self.low) * np.asarray(share))

    def share(self, value: Floats) -> Floats:
        """Return the shares of the distribution below these values."""
        at = np.clip(value, self.low, self.high)
        if self.scale == "log":
            return np.asarray(np.log(at / self.low) / log(self.high / self.low))
        return np.asarray((at - self.low) / (self.high - self.low))


Prior = Normal | Uniform


class Rig(NamedTuple):
    """A rig as its description states it.

    Parameters
    ----------
    slider : Slider
        With every uncertain value in the middle of its prior.
    priors : dict of str to Normal or Uniform
        By the path of each uncertain parameter.

    Examples
    --------
    >>> import stiction as st
    >>> text = st.presets.nakano_popov_2020().to_toml().replace('"1 deg"', '"1 +- 0.5 deg"')
    >>> list(st.Rig.from_toml(text).priors)
    ['phi']
    """

    slider: Slider
    priors: dict[str, Prior]

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
        >>> import stiction as st
        >>> text = st.presets.nakano_popov_2020().to_toml().replace('"1 deg"', '"1 +- 0.5 deg"')
        >>> Rig.from_toml(text).priors["phi"].mean * 180.0 / np.pi
        1.0
        """
        folder = folder_of(path)
        raw, lost = with_rows(read_toml(path, changes), locator(folder, trust))
        wanted = {name: raw[name] for name in raw if name in SLIDER_TABLES}
        stated: dict[str, Any] = {}
        certain = {
            name: dict(without_spread(table, (name,), stated))
            if isinstance(table, Mapping)
            else table
            for name, table in wanted.items()
        }
        find = finder_for_descriptions(folder, trust)
        slider = Slider.from_parts(
            gather(
                certain,
                {**SLIDER_TABLES, "friction": partial(read_law, find=find)},
                absent=OPTIONAL_TABLES,
                last=("friction",) if is_own(certain.get("friction")) else (),
                known=lost,
            )
        )
        priors = read_priors(slider, stated)
        middles = {name: middle(prior) for name, prior in priors.items()}
        given = {name: quantity(slider, name, value) for name, value in middles.items()}
        slider = change_parameters(slider, given) if given else slider
        return cls(slider, priors)


def rig_of(source: Any) -> Rig:
    """Return the rig that is given, that of a file or text, or a slider without priors.

    Raises
    ------
    DescriptionError
        If `source` is none of these.
    """
    if isinstance(source, Rig):
        return source
    return Rig.from_toml(source) if isinstance(source, str | Path) else Rig(slider_of(source), {})


def without_spread(
    table: Mapping[str, Any], keys: tuple[str, ...], stated: dict[str, Any]
) -> Iterator[tuple[str, Any]]:
    """Yield the items of a table, a plain value for each uncertain one; that is put in `stated`."""
    for key, value in table.items():
        parsed = spread(value)
        if parsed is not None:
            stated[canonical(".".join([*keys, key]))] = parsed
            yield key, parsed["value"] if "value" in parsed else parsed["low"]
        elif isinstance(value, Mapping):
            yield key, dict(without_spread(value, (*keys, key), stated))
        else:
            yield key, value


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


def read_priors(slider: Slider, stated: Mapping[str, Mapping[str, Any]]) -> dict[str, Prior]:
    """Return the prior of each uncertain parameter, or every fault."""
    priors, faults = {}, []
    for path, table in stated.items():
        try:
            its = unit(slider, path)
            example = "1 deg" if its == "rad" else f"1 {its}".rstrip()
            prior = read_prior(table, Kind(path, its, example))
            priors[path] = within_range(slider, path, prior)
        except PydanticCustomError as error:
            faults.append(Fault(path, error.message()))
        except ValueError as error:
            faults.append(Fault(path, str(error)))
        except DescriptionError as error:
            faults += error.faults
    if faults:
        raise DescriptionError(faults)
    return priors


def read_prior(table: Mapping[str, Any], kind: Kind) -> Prior:
    """Return the prior that a table states, in SI.

    >>> read_prior({"value": "2 N", "uncertainty": "5 %"}, Kind("a force", "N", "1 N"))
    Normal(mean=2.0, deviation=0.1, low=-inf, high=inf)
    """
    keys = set(table)
    if keys == NORMAL:
        mean, said = to_si(table["value"], kind), table["uncertainty"]
        share = re.fullmatch(r"\s*(.+?)\s*%\s*", said) if isinstance(said, str) else None
        width = abs(mean) * to_si(float(share[1]), PLAIN) / 100.0 if share else to_si(said, kind)
        if not width > 0.0:
            raise ValueError(f"uncertainty must be greater than 0, is {echo(said)}")
        return Normal(mean, width)
    if not UNIFORM <= keys <= UNIFORM | {"scale"}:
        listed = ", ".join(sorted(keys - NORMAL - UNIFORM)) or "both ways at once"
        raise ValueError(
            f"has {listed}; write {{value = ..., uncertainty = ...}} or {{low = ..., high = ...}}"
        )
    low, high = to_si(table["low"], kind), to_si(table["high"], kind)
    scale = table.get("scale", "linear")
    if scale not in SCALES:
        raise ValueError(f"scale is {echo(scale)}; write one of {', '.join(SCALES)}")
    if not low < high:
        raise ValueError(
            f"low must be below high, is {echo(table['low'])} and {echo(table['high'])}"
        )
    if scale == "log" and not low > 0.0:
        raise ValueError(f"low must be above 0 for scale = 'log', is {echo(table['low'])}")
    return Uniform(low, high, scale)


PLAIN = Kind("a number", "", "5")


def within_range(slider: Slider, path: str, prior: Prior) -> Prior:
    """Return a prior that ends where a value would be impossible.

    Raises
    ------
    DescriptionError
        If the value itself, or an end of a uniform prior, is impossible.
    """
    if isinstance(prior, Uniform):
        for end in (prior.low, prior.high):
            change_parameter(slider, path, quantity(slider, path, end))
        return prior
    change_parameter(slider, path, quantity(slider, path, prior.mean))
    try:
        change_parameter(slider, path, quantity(slider, path, -max(abs(prior.mean), 1e-30)))
    except DescriptionError:
        return Normal(prior.mean, prior.deviation, low=0.0)
    return prior


def middle(prior: Prior) -> float:
    """Return the median of a prior."""
    return float(prior.quantile(np.array(0.5)))
