"""The analyses of several records side by side: a row each."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from math import isfinite, nan

import numpy as np

from stiction.analysis.motion.cycle_columns import mean_in_words, with_spread
from stiction.analysis.motion.friction import Measured
from stiction.analysis.parts.brief import warnings_in_short
from stiction.analysis.parts.friction import coefficient_in_words, force_in_words
from stiction.analysis.report import Analysis
from stiction.analysis.signals.correlated_noise import (
    correlation_time,
    error_of_few,
    statistics,
)
from stiction.arrays import Floats, xr
from stiction.formats.table import number_of
from stiction.recording.origin import OriginOfStroke
from stiction.text.quantity.wording import in_words, with_error
from stiction.text.sections import Section, Table

FRICTIONS = ("static", "kinetic")
MEANS = {"drop": "N", "period": "s"}  # over the cycles
COLUMNS = (
    *("record", "motion", "cycles", "static friction", "kinetic friction", "force drop"),
    *("period", "misalignment φ", "warnings"),
)
NUMBER = re.compile(r"[-+]?\d[\d.]*")
UNKNOWN = Measured(nan, nan, nan, nan, nan, nan)


def side_by_side(found: Mapping[str, Analysis]) -> xr.Dataset:
    """Return a row for each analysis: motion, friction, means over cycles, misalignment, warnings.

    Parameters
    ----------
    found : mapping of str to Analysis
        From `stiction.analyse`, by the names of the records.

    Returns
    -------
    Dataset
        Over ``record``; NaN where a quantity is not determined.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 10.0, 1e-3)
    >>> records = {"slow": 0.1 * (time % 2.0), "fast": 0.1 * (time % 0.5)}
    >>> found = {
    ...     name: st.analyse(st.Record(time=time, force=force)) for name, force in records.items()
    ... }
    >>> st.analysis.side_by_side(found)["period"].values.round(6).tolist()
    [2.0, 0.5]
    """
    each = list(found.values())
    columns = {
        "motion": ([x.regime.kind for x in each], ""),
        "confidence": ([x.regime.confidence for x in each], "1"),
        "cycles": ([x.cycles.sizes["cycle"] for x in each], "1"),
    }
    for name in FRICTIONS:
        its = [getattr(x.friction, name) or UNKNOWN for x in each]
        columns |= {
            f"mu_{name}": ([x.coefficient for x in its], "1"),
            f"mu_{name}_error": ([x.coefficient_error for x in its], "1"),
            f"{name}_force": ([x.force for x in its], "N"),
            f"{name}_force_error": ([x.error for x in its], "N"),
        }
    for name, unit in MEANS.items():
        rows = [x.summary.sel(quantity=name) for x in each]
        for key in ("mean", "standard_deviation"):
            column = name if key == "mean" else f"{name}_{key}"
            columns[column] = ([float(row[key]) for row in rows], unit)
    angles = [x.misalignment for x in each]
    columns |= {
        "misalignment": ([x.phi if x else nan for x in angles], "rad"),
        "misalignment_error": ([x.phi_error if x else nan for x in angles], "rad"),
        "warnings": (["; ".join(x.warnings) for x in each], ""),
    }
    return xr.Dataset(
        {
            name: ("record", values, {"units": unit} if unit else {})
            for name, (values, unit) in columns.items()
        },
        {"record": list(found)},
    )


def section(found: Mapping[str, Analysis]) -> Section:
    """Return the same in words: a table without empty columns, and the warnings."""
    rows = [_row(name, each) for name, each in found.items()]
    kept = [at for at in range(len(COLUMNS)) if any(row[at] for row in rows)]
    kinds = Counter(each.regime.kind for each in found.values())
    lines = [f"{len(found)} records: {', '.join(f'{k} ({n})' for k, n in kinds.most_common())}."]
    lines += _warnings(found)
    table = Table(
        tuple(COLUMNS[at] for at in kept), [tuple(row[at] or "none" for at in kept) for row in rows]
    )
    return Section("Side by side", lines, table)


def mean_over(found: Mapping[str, Analysis]) -> Section:
    """Return the mean friction of the strokes of one test, with its error.

    The ways forth and back weigh equally, so that a zero that is off cancels: it shifts them apart.
    The error is that by the scatter of the strokes of each way; of records that are not known to be
    such strokes, by the scatter of all.

    Parameters
    ----------
    found : mapping of str to Analysis
        From `stiction.analyse`, by the names of the strokes.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 10.0, 1e-3)
    >>> found = {
    ...     name: st.analyse(st.Record(time=time, force=1.0 + height * (time % 2.0)))
    ...     for name, height in {"forth": 0.1, "back": 0.1004}.items()
    ... }
    >>> print(st.analysis.mean_over(found).table.rows[0][:2])
    ('static', '2')
    """
    origins = [x.record.origin for x in found.values()]
    strokes = [None if origin is None else origin.stroke for origin in origins]
    ways = np.array([0.0 if stroke is None else stroke.way for stroke in strokes])
    rows = []
    for name in FRICTIONS:
        its = [getattr(x.friction, name) for x in found.values()]
        known = np.array([each is not None for each in its])
        if np.count_nonzero(known) < 2:
            continue
        measured = [each for each in its if each is not None]
        of_load = all(isfinite(each.coefficient) for each in measured)
        values = np.array([each.coefficient if of_load else each.force for each in measured])
        mean, error, spread = _mean_of_ways(values, ways[known])
        unit = "1" if of_load else "N"
        shown = with_error(mean, error, unit) if isfinite(error) else in_words(mean, unit)
        rows.append((name, f"{len(values)}", shown, with_spread(spread, mean, unit)))
    if not rows:
        return Section("Mean of the strokes", ["Fewer than two of them have a friction."])
    headings = ("friction", "strokes", "mean", "standard deviation")
    return Section("Mean of the strokes", _on_error(ways, strokes), Table(headings, rows))


def _mean_of_ways(values: Floats, ways: Floats) -> tuple[float, float, float]:
    """Return mean, standard error and spread of strokes; the ways forth and back weigh equally.

    Error and spread are those of the strokes about the mean of their way; NaN with one each way.
    Where a way is not known (0), all count alike.
    """
    forth = ways > 0.0
    if not (forth.any() and (ways < 0.0).any() and ways.all()):
        return statistics(values)
    means = np.where(forth, values[forth].mean(), values[~forth].mean())
    mean, left = 0.5 * (values[forth].mean() + values[~forth].mean()), values - means
    freedom = len(values) - 2
    if not freedom:
        return float(mean), nan, nan
    alike, spread = correlation_time(left), float(np.sqrt(left @ left / freedom))
    shares = 1.0 / np.count_nonzero(forth) + 1.0 / np.count_nonzero(~forth)
    error = float(0.5 * spread * np.sqrt(alike * shares))
    return float(mean), error_of_few(error, len(values) / alike - 2.0), spread


def _on_error(ways: Floats, strokes: list[OriginOfStroke | None]) -> list[str]:
    """Return the meaning of the error of a mean, and the zero that cancels in it."""
    if not (ways.all() and np.ptp(ways)):
        return ["The error of the mean is that by the scatter of the strokes, each as telling."]
    zero = next((each.middle for each in strokes if each and each.middle is not None), None)
    its = "" if zero is None else f", here {in_words(zero, 'N')},"
    lines = [f"The ways forth and back weigh equally, so that the zero of the force{its} cancels."]
    if len(ways) == 2:
        return [*lines, "The error is not determined: one stroke each way shows no scatter."]
    return [*lines, "The error is that by the scatter of the strokes of each way."]


def _warnings(found: Mapping[str, Analysis]) -> list[str]:
    """Return the warnings in short, those that differ in their numbers alone said once."""
    alike: dict[str, list[tuple[str, str]]] = {}
    for name, each in found.items():
        for warning in warnings_in_short(each.warnings):
            alike.setdefault(NUMBER.sub("", warning), []).append((name, warning))
    lines = []
    for (name, warning), *others in alike.values():
        too = f" ({number_of(len(others), 'other')} alike)" if others else ""
        lines.append(f"{name}{too}: {warning}")
    return lines


def _row(name: str, found: Analysis) -> tuple[str, ...]:
    angle, count = found.misalignment, len(found.warnings)
    return (
        name,
        found.regime.kind,
        str(found.cycles.sizes["cycle"]),
        *(_friction(getattr(found.friction, each)) for each in FRICTIONS),
        *(_mean(found.summary, each) for each in MEANS),
        with_error(angle.phi, angle.phi_error, "rad") if angle else "",
        str(count) if count else "",
    )


def _friction(its: Measured | None) -> str:
    """Return a coefficient, the force where the load is unknown, or nothing."""
    return (coefficient_in_words(its) or force_in_words(its)) if its else ""


def _mean(summary: xr.Dataset, quantity: str) -> str:
    known = isfinite(float(summary["mean"].sel(quantity=quantity)))
    return mean_in_words(summary, quantity) if known else ""
