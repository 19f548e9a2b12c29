"""Accuracy: every case with a known solution, and its error over the tolerance."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context

from rich.progress import Progress

from benchmarks.accuracy import convergence
from benchmarks.cases import GROUPS
from benchmarks.cases.closed_forms import closed_forms
from benchmarks.section import Cell, Section, Table
from stiction.presets import Number

TOLERANCES = (1e-4, 1e-6, 1e-8)
NOTES = (
    "Errors are computed less known. A value as printed is known to half a unit of its last digit,"
    " which is then the last column; elsewhere that is what the test suite asks for, at the"
    " tolerance at which the case is tested.",
    "Critical stiffness and misalignment: where the growth rate of a small oscillation changes its"
    " sign; NaN where a run at that tolerance damps it by more than is looked at.",
    "Transverse oscillation: the springs are stiff, not rigid, which shows below 1e-8.",
    "Convergence: largest error on a 1 ms grid, beside the run at"
    f" rtol={convergence.REFERENCE:g}. The method is of order 5 (Radau IIA); steps in stick and"
    " landing are in closed form and count for nothing.",
)


def run(progress: Progress, quick: bool) -> Section:
    """Return the errors of every case at several tolerances, and the orders measured."""
    rows = _all_cases(progress)
    found = convergence.points(progress, convergence.TOLERANCES[: 5 if quick else None])
    errors = tuple(f"error, rtol={rtol:.0e}" for rtol in TOLERANCES)
    headings = ("case", "quantity", "known from", "unit", "known", *errors, "known or tested to")
    return Section(
        "Accuracy",
        (Table("Cases with a known solution", headings, rows), _theory(), convergence.table(found)),
        NOTES,
        {"convergence": convergence.figure(found)},
    )


def _all_cases(progress: Progress) -> list[tuple[Cell, ...]]:
    """Return the rows of all cases; nothing is timed, so they run side by side."""
    task = progress.add_task("verification", total=len(GROUPS))
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        running = [pool.submit(_rows, number) for number in range(len(GROUPS))]
        for each in as_completed(running):
            each.result()
            progress.advance(task)
    return [row for each in running for row in each.result()]


def _rows(number: int) -> list[tuple[Cell, ...]]:
    """Return the rows of a group of cases, which another process finds by its number."""
    rows: list[tuple[Cell, ...]] = []
    for case in GROUPS[number]:
        for numbers in zip(*(case.numbers(rtol) for rtol in TOLERANCES), strict=True):
            n = numbers[0]
            errors = [number.deviation for number in numbers]
            known = f"{n.stated:.11g}"
            rows.append((case.name, n.what, n.where, n.unit, known, *errors, n.tolerance))
    return rows


def _theory() -> Table:
    def row(n: Number) -> tuple[Cell, ...]:
        return n.what, n.where, n.unit, f"{n.stated:.11g}", n.computed, n.deviation, n.tolerance

    headings = ("quantity", "equation", "unit", "known", "computed", "error", "known to")
    return Table("The theory's closed forms, Fig. 3", headings, [row(n) for n in closed_forms()])
