"""From rtol to the local tolerance: the factor of (M39), measured on systems of every kind.

The error of a run is told as the change of the apparatus that would cause it: the largest
difference of the forces, over what they change by if mass or load is greater by a share, over that
share. It is in proportion to the local tolerance to the power 5/4, in theory; so the factor with
which it would equal rtol follows from each run.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from rich.progress import Progress

import stiction as st
from benchmarks.accuracy.convergence import order
from benchmarks.explore.deviation import deviation, forces, response
from benchmarks.explore.systems.set_valued import System
from benchmarks.section import Section, Table
from stiction.friction import has_state
from stiction.plotting.page.style import BLUE, PAGE, RED, new_figure, panel_letter, style
from stiction.solver.accuracy import FACTOR

TOLERANCES = tuple(10.0**-n for n in range(3, 10))
LASTS = 3.0  # s
REFERENCE = 1e-12
SHARE = 1e-7  # by which the apparatus is changed: the response is linear, and above rounding
POWER = 4.0 / 5.0
NOTES = (
    "Error: the relative change of mass or load that would move the forces as far, over rtol.",
    "Factor: what 0.8 would have to be for that error to equal rtol, (M39); above 0.8, the run is"
    " more accurate than asked. The middle, and the range, over the tolerances; of all, over the"
    " systems.",
)


class Measured(NamedTuple):
    """The errors of one system, as changes of the apparatus, at each tolerance."""

    name: str
    smooth: bool
    errors: tuple[float, ...]

    @property
    def factors(self) -> list[float]:
        """The factor of (M39) with which each error would equal its tolerance."""
        pairs = zip(TOLERANCES, self.errors, strict=False)
        return [FACTOR * (rtol / error) ** POWER for rtol, error in pairs]


def systems() -> dict[str, System]:
    """Return systems of every kind."""
    p, paper = st.protocols, st.presets.nakano_popov_2020()
    shaken = p.DriveProgram(velocity="1 mm/s", across=p.Modulation("0.2 mm/s", "50 Hz"))
    stopped = [p.Constant(duration="2.2 s"), p.Ramp("3 mm/s", "0.2 s"), p.Hold("0.3 s")]
    loaded = p.LoadProgram(modulation=p.Modulation("2 N", "5 Hz"))
    steps = p.DriveProgram(velocity="1 mm/s", program=[*stopped, p.Constant()])
    peak = st.ExponentialWeakening(0.2, 0.15, "10 mm/s", mu_static=0.22)
    ageing = st.laws.RateStateAgeing(a=0.01, b=0.015, D_c="1 um", mu_star=0.2, V_star="1 mm/s")
    slip = st.laws.RateStateSlip(a=0.01, b=0.015, D_c="1 um", mu_star=0.2, V_star="1 mm/s")
    bristles = st.laws.LuGre(0.15, 0.2, "10 mm/s", "1e5 N/m", "30 N*s/m")
    grain = st.laws.Anisotropic(paper.law, 0.8, "20 deg")
    rigs = {
        "Fig. 3": {},
        "phi = 5 deg": {"phi": "5 deg"},
        "phi = 30 deg": {"phi": "30 deg"},
        "k_y = 10 k_x": {"k_y": "10 kN/m"},
        "mass of 10 kg": {"mass": "10 kg"},
        "damped": {"c_x": "5 N*s/m", "c_y": "50 N*s/m"},
        "Coulomb": {"friction": st.Coulomb(0.2)},
        "Coulomb, static peak": {"friction": peak},
        "Stribeck": {"friction": st.laws.Stribeck(0.2, 0.15, "10 mm/s")},
        "hyperbolic": {"friction": st.laws.HyperbolicWeakening(0.2, "50 mm/s")},
        "a grain": {"friction": grain},
        "drive with stops": {"drive": steps},
        "drive shaken across": {"drive": shaken},
        "load modulated": {"load": loaded},
        "spring driven, shaken": {"drive": shaken, "driven": "spring"},
        "ageing": {"friction": ageing, "k_y": "1 MN/m"},
        "slip law": {"friction": slip, "k_y": "1 MN/m"},
        "LuGre": {"friction": bristles, "k_y": "1 MN/m"},
    }
    return {name: System(paper.replace(**each), LASTS, REFERENCE) for name, each in rigs.items()}


def measure(name: str, system: System, tolerances: Sequence[float]) -> Measured:
    """Run a system at each tolerance, beside the tightest one and a changed apparatus."""
    sharp, _ = forces(system, REFERENCE)
    per_share = response(system, SHARE, REFERENCE, sharp) / SHARE
    off = (deviation(forces(system, rtol)[0], sharp) for rtol in tolerances)
    errors = tuple(each / per_share for each in off)
    return Measured(name, has_state(system.slider.law), errors)


def run(progress: Progress, quick: bool) -> Section:
    """Return the errors of all systems at all tolerances, and the factor that each asks for."""
    chosen = systems()
    task = progress.add_task("calibration", total=len(chosen))
    found = []
    for name, system in chosen.items():
        found.append(measure(name, system, TOLERANCES[: 4 if quick else None]))
        progress.advance(task)
    return Section("Calibration", [table(found)], NOTES, {"calibration": figure(found)})


def table(found: Sequence[Measured]) -> Table:
    """Return a row a system: errors over rtol, order, and factor; then all together."""
    count = len(found[0].errors)
    rows = []
    for each in found:
        ratios = [error / rtol for error, rtol in zip(each.errors, TOLERANCES, strict=False)]
        p, spread = order(TOLERANCES[:count], each.errors)
        rows.append((each.name, *ratios, f"{p:.2f} ± {spread:.2f}", *_range(each.factors)))
    middles = [float(np.median(each.factors)) for each in found]
    errors = np.array([each.errors for each in found])
    middle = [float(x) for x in np.median(errors / np.array(TOLERANCES[:count]), axis=0)]
    p, spread = order(TOLERANCES[:count], [float(x) for x in np.median(errors, axis=0)])
    rows.append(("middle of all", *middle, f"{p:.2f} ± {spread:.2f}", *_range(middles)))
    ratios = (f"error/rtol, rtol={rtol:.0e}" for rtol in TOLERANCES[:count])
    headings = ("system", *ratios, "order in rtol", "factor", "least", "largest")
    return Table("From rtol to the local tolerance", headings, rows)


def _range(factors: Sequence[float]) -> tuple[float, float, float]:
    return float(np.median(factors)), min(factors), max(factors)


def figure(found: Sequence[Measured]) -> Figure:
    """Draw each system's error over rtol, and the factors that they ask for."""
    with style():
        fig = new_figure(PAGE, 2.9)
        left, right = fig.subplots(1, 2)
        for each in found:
            colour = RED if each.smooth else BLUE
            x = TOLERANCES[: len(each.errors)]
            left.loglog(x, each.errors, "o-", color=colour, linewidth=0.5, markersize=2)
        for colour, name in ((BLUE, "set-valued friction"), (RED, "laws with state")):
            left.plot([], [], "o-", color=colour, linewidth=0.5, markersize=2, label=name)
        left.loglog(x, x, "k--", linewidth=0.8, label="error = rtol")
        left.invert_xaxis()
        left.set_xlabel("relative tolerance, rtol")
        left.set_ylabel("error, as a change of mass or load")
        left.legend(loc="lower left")
        factors = np.sort([float(np.median(each.factors)) for each in found])
        right.semilogx(factors, np.arange(1, len(factors) + 1), "o", color=BLUE, markersize=3)
        right.axvline(FACTOR, color="black", linestyle="--", linewidth=0.8)
        right.set_xlabel("factor that makes error = rtol")
        right.set_ylabel("systems with at most that")
        right.yaxis.get_major_locator().set_params(integer=True)
        for ax, letter in zip((left, right), "ab", strict=True):
            panel_letter(ax, letter)
    return fig
