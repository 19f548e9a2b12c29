"""Priors: the uncertain values in a rig's description, and their distributions.

A value of a description may be uncertain in three ways:

    phi = "2 +- 1 deg"                                  # also "2 ± 1 deg"
    phi = {value = "2 deg", uncertainty = "1 deg"}      # a normal distribution; also "5 %"
    phi = {low = "0.5 deg", high = "5 deg"}             # uniform; scale = "log": of its logarithm

A normal distribution ends where a value would be impossible, such as a stiffness at zero. What is
impossible only together, such as mu_static below mu_0, is not drawn (`simulated.restriction`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from math import inf, log
from typing import Any

import numpy as np

from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats
from stiction.errors import echo
from stiction.text.quantity.exact import quantity_text
from stiction.text.units import NORMAL, QUANTITY, UNIFORM, Kind, to_si

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
        """Return the quantiles of the distribution at these shares."""
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
        """Return the quantiles of the distribution at these shares."""
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


# Priors of the jitter, the standard deviation of friction from cycle to cycle over its mean; the
# second for records whose peaks spread by more than a share of their mean. They overlap by about
# as much as the spread of six peaks differs from the jitter by chance.
JITTER, IRREGULAR = Uniform(1e-3, 0.05, "log"), Uniform(0.01, 0.3, "log")
SPREAD = 0.035


def jitter_of(peaks: Floats) -> Uniform:
    """Return the prior of the jitter for the peaks of a force (n,) without their trend.

    >>> jitter_of(np.r_[1.0:2.0:9j]) == JITTER, jitter_of(np.r_[0.9, 1.1, 0.9, 1.1]) == IRREGULAR
    (True, True)
    """
    number = np.arange(float(len(peaks)))
    spread = np.std(line(number, peaks).deviations(number, peaks)) / abs(np.mean(peaks))
    return IRREGULAR if spread > SPREAD else JITTER


def read_prior(table: Mapping[str, Any], kind: Kind) -> Prior:
    """Return the prior that a table states, in SI.

    >>> read_prior({"value": "2 N", "uncertainty": "5 %"}, Kind("a force", "N", "1 N"))
    Normal(mean=2.0, deviation=0.1, low=-inf, high=inf)
    """
    keys = set(table)
    if keys == NORMAL:
        mean, said = to_si(table["value"], kind), table["uncertainty"]
        share = re.fullmatch(r"\s*(.+?)\s*%\s*", said) if isinstance(said, str) else None
        width = to_si(share_of(table["value"], share[1]) if share else said, kind)
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


def share_of(value: Any, percent: str) -> str | float:
    """Return a percentage of the size of a quantity, in the quantity's unit.

    >>> share_of("30 mN", "10"), share_of(0.3, "7")
    ('3.0 mN', 0.021)
    """
    found = QUANTITY.fullmatch(str(value).replace("−", "-"))
    assert found is not None  # the value has been read
    size = float(abs(Decimal(found[1])) * Decimal(repr(to_si(percent, PLAIN))) / 100)
    unit = found[2].strip()
    return f"{size!r} {unit}" if unit else size


def prior_table(prior: Prior, unit: str) -> dict[str, Any]:
    """Return the table that states a prior, as `read_prior` reads it.

    >>> prior_table(Uniform(0.1, 0.4, "log"), ""), prior_table(Normal(2e3, 50.0), "N/m")
    ({'low': 0.1, 'high': 0.4, 'scale': 'log'}, {'value': '2 kN/m', 'uncertainty': '50 N/m'})
    """
    if isinstance(prior, Normal):
        its = {"value": prior.mean, "uncertainty": prior.deviation}
    else:
        its = {"low": prior.low, "high": prior.high}
    table: dict[str, Any] = {
        key: quantity_text(value, unit) if unit else value for key, value in its.items()
    }
    logarithmic = isinstance(prior, Uniform) and prior.scale == "log"
    return table | ({"scale": "log"} if logarithmic else {})


def middle(prior: Prior) -> float:
    """Return the median of a prior."""
    return float(prior.quantile(np.array(0.5)))
