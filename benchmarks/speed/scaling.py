"""Scaling: time, steps and memory over the length of a run, and the cost of generality."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from operator import itemgetter
from time import perf_counter
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from rich.progress import Progress

import stiction as st
from benchmarks.section import Cell, Section, Table
from benchmarks.speed import generality, memory
from stiction import theory
from stiction.plotting.page.style import BLUE, GREEN, PAGE, new_figure, panel_letter, style
from stiction.trajectory import Statistics

ROUNDS = 3  # the fastest counts
DURATION = 5.0  # s
TRAVEL = 5e-3  # m: where V changes, each run pulls as far as the paper's
HEADINGS = (
    "what changes",
    "value",
    "time (ms)",
    "transverse cycles",
    "steps/cycle",
    "Newton iterations/step",
    "rejected (%)",
    "ns/step",
)
NOTES = (
    "All beside the paper's case over 5 s at the default tolerance. A step is an accepted one, with"
    " its share of those rejected, of landings and of sticks; the fixed cost of a call is taken off"
    " before dividing by the steps. A transverse cycle is 2 pi/omega_y, whether or not the mass"
    " oscillates.",
    "V: each run pulls 5 mm, so that a slow one is a long one.",
    "Memory: growth of the peak resident set in a fresh process that has simulated before.",
    *generality.NOTES,
)


class Setting(NamedTuple):
    """A run: the slider, how long (s), how exact."""

    slider: st.Slider
    duration: float = DURATION
    rtol: float = 1e-6


class Sweep(NamedTuple):
    """A parameter, its axis label, the values it takes, and the run it makes of each."""

    name: str
    label: str
    values: Sequence[float]
    setting: Callable[[float], Setting]


class Point(NamedTuple):
    """What a run took: its fastest time (s), how often it would swing across, its statistics."""

    time: float
    cycles: float
    statistics: Statistics
    per_step: float


PAPER = st.presets.nakano_popov_2020()
SWEEPS = (
    Sweep(
        "duration (s)",
        "duration (s)",
        (1.0, 3.0, 10.0, 30.0, 100.0),
        lambda t: Setting(PAPER, duration=t),
    ),
    Sweep(
        "k_y/k_x",
        "$k_y/k_x$",
        (1e2, 1e3, 1e4, 1e5, 1e6),
        lambda ratio: Setting(PAPER.replace(k_y=ratio * PAPER.k_x)),
    ),
    Sweep(
        "phi (deg)",
        r"$\phi$ (deg)",
        (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0),
        lambda phi: Setting(PAPER.replace(phi=f"{phi} deg")),
    ),
    Sweep(
        "V (m/s)",
        "$V$ (m/s)",
        (1e-5, 1e-4, 1e-3, 1e-2, 1e-1),
        lambda V: Setting(PAPER.replace(drive=st.ConstantVelocity(V)), duration=TRAVEL / V),
    ),
    Sweep(
        "rtol",
        "rtol",
        (1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12),
        lambda rtol: Setting(PAPER, rtol=rtol),
    ),
)


def run(progress: Progress, quick: bool) -> Section:
    """Return how time, steps and memory grow, and what laws, protocols and samples cost."""
    st.simulate(PAPER, 1e-3, sample_rate=0)
    fixed = min(_time(Setting(PAPER, duration=1e-6))[0] for _ in range(20))
    sweeps = [sweep._replace(values=sweep.values[:3]) for sweep in SWEEPS] if quick else SWEEPS
    task = progress.add_task("scaling", total=sum(len(sweep.values) for sweep in sweeps))
    points = []
    for sweep in sweeps:
        found = []
        for value in sweep.values:
            found.append(_point(sweep.setting(value), fixed))
            progress.advance(task)
        points.append(found)
    rows: list[tuple[Cell, ...]] = [
        (sweep.name, f"{value:g}", *_cells(point))
        for sweep, found in zip(sweeps, points, strict=True)
        for value, point in zip(sweep.values, found, strict=True)
    ]
    cost = ("fixed cost of a call", "", 1e3 * fixed, *("",) * 5)
    return Section(
        "Scaling",
        (
            Table("Time and steps", HEADINGS, [*rows, cost]),
            memory.table(progress, quick),
            *generality.tables(progress, quick),
        ),
        NOTES,
        {"scaling": _figure(sweeps, points)},
    )


def _time(setting: Setting) -> tuple[float, st.Trajectory]:
    slider, duration, rtol = setting
    begin = perf_counter()
    found = st.simulate(slider, duration, sample_rate=0, rtol=rtol)
    return perf_counter() - begin, found


def _point(setting: Setting, fixed: float) -> Point:
    time, found = min((_time(setting) for _ in range(ROUNDS)), key=itemgetter(0))
    s = setting.slider
    cycles = setting.duration * float(theory.natural_frequency(s.k_y, s.mass)) / (2 * pi)
    per_step = (time - fixed) / found.statistics.steps
    return Point(time, cycles, found.statistics, per_step)


def _cells(point: Point) -> tuple[float, ...]:
    took = point.statistics
    return (
        1e3 * point.time,
        round(point.cycles, 1),
        took.steps / point.cycles,
        took.iterations / took.steps,
        100.0 * took.rejected / (took.steps + took.rejected),
        1e9 * point.per_step,
    )


def _figure(sweeps: Sequence[Sweep], points: Sequence[Sequence[Point]]) -> Figure:
    """Draw time, and steps and nanoseconds, over each parameter."""
    rows = (
        ("time (ms)", BLUE, "o", lambda point: 1e3 * point.time),
        ("steps in a\ntransverse cycle", GREEN, "s", lambda p: p.statistics.steps / p.cycles),
        ("ns a step", "black", "^", lambda point: 1e9 * point.per_step),
    )
    with style():
        fig = new_figure(PAGE, 4.0)
        axes = fig.subplots(3, len(sweeps), sharex="col", sharey="row")
        for column, sweep, found in zip(axes.T, sweeps, points, strict=True):
            for ax, (_, colour, marker, height) in zip(column, rows, strict=True):
                ax.loglog(sweep.values, [height(p) for p in found], "-", color=colour)
                ax.loglog(sweep.values, [height(p) for p in found], marker, color=colour, ms=3)
            column[-1].set_xlabel(sweep.label)
            column[-1].margins(x=0.12)
        for row, (name, *_), letter in zip(axes, rows, "abc", strict=True):
            row[0].set_ylabel(name)
            panel_letter(row[0], letter)
        axes[-1][0].set_ylim(bottom=10.0 ** np.floor(np.log10(axes[-1][0].get_ylim()[0])))
        fig.align_ylabels(axes[:, 0])
    return fig
