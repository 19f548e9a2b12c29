"""The friction test that the drive or load of a run or record makes, and its results."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stiction.analysis.motion.doubts.unsteady import say_unsteady, variations
from stiction.analysis.motion.regime.kinds import STICK_SLIP
from stiction.analysis.record import Record
from stiction.arrays import xr
from stiction.errors import ResultError
from stiction.storage.table_files import number
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis
    from stiction.text.sections import SectionReport


class ColumnsOfTest(NamedTuple):
    """Units of the numbers of a test by name: attributes of its analysis, or of each part of it."""

    row: str  # what a row of its table is
    # columns of the table, and what follows from all rows
    rows: dict[str, str]
    results: dict[str, str]
    # which attribute holds the rows, an object each; '' where each column is an attribute
    parts: str = ""


TESTS = {  # the first that suits a run is its test
    "velocity-steps": ColumnsOfTest("step", {
        "time": "s", "before": "m/s", "after": "m/s", "steady_before": "1", "steady_after": "1",
        "peak": "1", "a_minus_b": "1", "a_minus_b_error": "1", "a": "1", "a_error": "1",
        "b": "1", "b_error": "1", "D_c": "m", "D_c_error": "m", "law": "",
    }, {"stiffness": "1", "trend": "1/m", "trend_error": "1/m"}, "steps"),
    "healing": ColumnsOfTest("number", {  # a hold has its duration in a column of that name
        "hold": "s", "steady": "1", "relaxed": "1", "peak": "1", "gain": "1", "peak_error": "1",
    }, {
        "per_decade": "1", "per_decade_error": "1",
        "at_one_second": "1", "at_one_second_error": "1",
    }),
    "hysteresis": ColumnsOfTest("loop", {"area": "J", "width": "m", "friction": "1"}, {}, "loops"),
    "load-dependence": ColumnsOfTest("level", {"load": "N", "force": "N"}, {
        "coefficient": "1", "error": "1", "adhesion": "N", "adhesion_error": "N",
    }),
}  # fmt: skip
OF_SPEED = ("velocity-steps", "healing")  # tests of steady friction at several speeds


def find(found: Analysis) -> Any:
    """Return the first analysis of a test that suits a run, or a record of the drive as well.

    None where nothing varies. Under stick-slip no change of the drive's speed shows steady
    friction; and in a record the strokes of a drive that goes back and forth are analysed one by
    one.
    """
    source, sticks = found.source, found.regime.kind == STICK_SLIP
    if isinstance(source, Trajectory):
        its = [name for name in TESTS if not (sticks and name in OF_SPEED)]
        return _first(source, its) if variations(source) else None
    if sticks or source.drive_position is None or source.normal_load is None:
        return None
    from stiction.analysis.protocols.friction_test import friction_test

    with suppress(ResultError):
        if len(friction_test(source).stretches) > 1:
            return _first(source, OF_SPEED)
    return None


def with_test(found: Analysis, test: Any) -> Analysis:
    """Return an analysis without warnings and friction that its test replaces.

    A warning names the analysis that suits a test; and a mean over velocities, each with its own
    friction, is none of them.
    """
    if test is None:
        return found
    if isinstance(found.source, Trajectory):
        needless = say_unsteady(found.source, found.regime.kind)
        found = replace(found, warnings=tuple(x for x in found.warnings if x not in needless))
    if name_of(test) not in OF_SPEED:
        return found
    why = f"the drive has several velocities, each with its own: see {test.section.title}"
    return replace(found, friction=found.friction.without_kinetic(why))


def _first(source: Trajectory | Record, names: Iterable[str]) -> Any:
    """Return the first of some analyses that finds its test; None if there is none of them."""
    import stiction.analysis as of

    for name in names:
        with suppress(ResultError):
            return getattr(of, name.replace("-", "_"))(source)
    return None


def section(found: Analysis) -> Section | None:
    """Return its section."""
    its: SectionReport | None = found.parts["procedure"]
    return None if its is None else its.section


def name_of(its: SectionReport) -> str:
    """Return the name of the friction test in an analysis, which its files have, too."""
    return its.figure.removeprefix("plot_").replace("_", "-")


def tables(found: Analysis) -> dict[str, xr.Dataset]:
    """Return the test's steps, holds, loops or levels, a row each."""
    its = found.parts["procedure"]
    if its is None:
        return {}
    name = name_of(its)
    row = TESTS[name].row
    table = {
        key: (row, values, {"units": unit} if unit else {}) for key, values, unit in _columns(its)
    }
    count = len(next(iter(table.values()))[1])
    return {name: xr.Dataset(table, {row: np.arange(1, count + 1)})}


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the same for JSON, with the results from all rows."""
    its = found.parts["procedure"]
    if its is None:
        return {"procedure": None}
    name = name_of(its)
    results = {
        key: {"value": number(getattr(its, key)), "unit": unit}
        for key, unit in TESTS[name].results.items()
    }
    rows = {
        key: {"values": [_for_json(each) for each in values], "unit": unit}
        for key, values, unit in _columns(its)
    }
    return {"procedure": {"test": name, **results, "rows": rows}}


def _columns(its: SectionReport) -> Iterator[tuple[str, list[Any], str]]:
    """Yield the columns of a test's table: name, values, and unit; '' where it has none."""
    test = TESTS[name_of(its)]
    parts = getattr(its, test.parts) if test.parts else None
    for key, unit in test.rows.items():
        values = getattr(its, key) if parts is None else [getattr(each, key) for each in parts]
        if values is not None:
            yield key, list(values), unit


def _for_json(value: Any) -> Any:
    return value if isinstance(value, str) else number(value)
