"""Conservation: the energy balance of a hundred stick-slip cycles, and their drift."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from rich.progress import Progress
from scipy.interpolate import CubicHermiteSpline

import stiction as st
from benchmarks.accuracy.energy import PANELS, Balance, Floats, balance
from benchmarks.section import Cell, Section, Table
from stiction.plotting.page.style import BLUE, GREEN, PAGE, RED, new_figure, panel_letter, style

TOLERANCES = (1e-4, 1e-6, 1e-8)
COLOURS = (RED, BLUE, GREEN)
DURATION = 95.0  # s; 100 cycles of 0.915 s, after one that starts from rest
SETTLED = 2.5  # s; the first cycle starts from rest
LEVEL = 1.58  # N, half way down: k_x u_x falls through it once a cycle, fast

ENERGY_HEADINGS = (
    "system",
    "rtol",
    "time (s)",
    "work of the drive (J)",
    "friction (J)",
    "damper (J)",
    "stored (J)",
    "residual (J)",
    "residual/work",
    "largest on the way/work",
    "of it quadrature/work",
)
CYCLE_HEADINGS = (
    "system",
    "rtol",
    "cycles",
    "mean period (s)",
    "its scatter (s)",
    "drift a cycle (s)",
    "mean peak of k_x u_x (N)",
    "its scatter (N)",
    "drift a cycle (N)",
)
NOTES = (
    "Work of the drive on spring and damper = dissipated by friction + by the damper + change of"
    " what is stored in springs and mass; each is integrated by itself, from the forces and"
    " velocities of the run, and nothing is adjusted.",
    f"The quadrature has {PANELS} panels of three Gauss points in a transverse period and breaks at"
    " each stick; its own share is the change of the residual on two thirds of the panels.",
    "Cycles are told apart by the fall of k_x u_x through"
    f" {LEVEL:g} N. Scatter: standard deviation; drift: slope of a straight line"
    " through all cycles, with its standard error. Where it is within two of them, there is none to"
    " be seen.",
)


class Cycles(NamedTuple):
    """When each cycle ends (s), and its largest k_x u_x (N)."""

    ends: Floats
    peaks: Floats


def run(progress: Progress, quick: bool) -> Section:
    """Return the balance of energy, and the drift of the cycle, at several tolerances."""
    slider = st.presets.nakano_popov_2020()
    duration = 0.1 * DURATION if quick else DURATION
    systems = {"Fig. 3": slider, "with dampers": slider.replace(c_x=1.0, c_y=20.0)}
    wanted = [(name, system, rtol) for name, system in systems.items() for rtol in TOLERANCES]
    task = progress.add_task("conservation", total=len(wanted))

    def kept(which: tuple[str, st.Slider, float]) -> tuple[Balance, float, Cycles]:
        _, system, rtol = which
        fine = balance(system, duration, rtol)
        found = cycles(system, fine)
        coarse = _coarse(system, duration, rtol)
        progress.advance(task)
        return fine._replace(nodes=()), coarse, found

    with ThreadPoolExecutor(os.cpu_count()) as threads:  # nothing is timed
        results = list(threads.map(kept, wanted))
    energies: list[tuple[Cell, ...]] = []
    periods: list[tuple[Cell, ...]] = []
    shown = []
    for (name, system, rtol), (fine, coarse, found) in zip(wanted, results, strict=True):
        energies.append((name, f"{rtol:.0e}", *_energies(fine, coarse)))
        periods.append((name, f"{rtol:.0e}", *_cycles(found)))
        if system is slider:
            shown.append((rtol, fine, found))
    return Section(
        "Conservation",
        (
            Table("Energy", ENERGY_HEADINGS, energies),
            Table("The stick-slip cycle", CYCLE_HEADINGS, periods),
        ),
        NOTES,
        {"conservation": _figure(shown)},
    )


def _coarse(slider: st.Slider, duration: float, rtol: float) -> float:
    return float(balance(slider, duration, rtol, 2 * PANELS // 3).residual[-1])


def _energies(found: Balance, coarse: float) -> tuple[Cell, ...]:
    work, residual = float(found.work[-1]), float(found.residual[-1])
    parts = (float(each[-1]) for each in (found.friction, found.damper, found.stored))
    largest = float(np.abs(found.residual).max())
    shares = residual / work, largest / work, abs(residual - coarse) / work
    return (float(found.t[-1]), work, *parts, residual, *shares)


def cycles(slider: st.Slider, found: Balance) -> Cycles:
    """Return the cycles of a run, from where it has settled."""
    t, u_x, v_x = found.nodes
    level = LEVEL / slider.k_x
    falls = np.flatnonzero((u_x[:-1] > level) & (u_x[1:] <= level) & (t[:-1] > SETTLED))
    ends = []
    for i in falls:  # time as a function of the elongation, which falls steadily there
        pair = [i + 1, i]
        ends.append(float(CubicHermiteSpline(u_x[pair], t[pair], 1.0 / v_x[pair])(level)))
    peaks = np.maximum.reduceat(u_x, falls[:-1]) * slider.k_x
    return Cycles(np.array(ends), peaks)


def _cycles(found: Cycles) -> tuple[Cell, ...]:
    periods = np.diff(found.ends)
    cells: list[Cell] = [len(periods)]
    for values in (periods, found.peaks):
        slope, error = drift(values)
        mean, scatter = f"{values.mean():.9f}", float(values.std(ddof=1))
        cells += [mean, scatter, f"{slope:.1e} ± {error:.0e}"]
    return tuple(cells)


def drift(values: Floats) -> tuple[float, float]:
    """Return the slope of a straight line through evenly spaced values, and its standard error."""
    n = np.arange(len(values))
    (slope, _), covariance = np.polyfit(n, values, 1, cov=True)
    return float(slope), float(np.sqrt(covariance[0, 0]))


def _figure(shown: list[tuple[float, Balance, Cycles]]) -> Figure:
    with style():
        fig = new_figure(PAGE, 2.6)
        left, right = fig.subplots(1, 2)
        settled = np.diff(shown[-1][2].ends).mean()  # of the tightest
        for (rtol, energy, found), colour in zip(shown, COLOURS, strict=True):
            share = np.abs(energy.residual[1:]) / energy.work[1:]
            name = f"$10^{{{round(np.log10(rtol))}}}$"
            left.semilogy(energy.t[1:], share, color=colour, linewidth=0.6, label=name)
            periods = np.diff(found.ends)
            away = np.abs(periods - settled) / settled
            right.semilogy(np.arange(1, len(periods) + 1), away, ".", color=colour, markersize=3)
        left.set_xlabel("time $t$ (s)")
        left.set_ylabel("|energy residual|/work of the drive")
        right.set_xlabel("stick-slip cycle")
        right.set_ylabel("|its period/settled period − 1|")
        for ax, letter in zip((left, right), "ab", strict=True):
            panel_letter(ax, letter)
        left.legend(title="rtol", ncols=3, loc="lower right")
    return fig
