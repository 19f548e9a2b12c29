"""Figures of named friction tests, from the findings of `stiction.analysis`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, GREY, LINES, RED, style
from stiction.text.quantity.wording import in_words, with_error

if TYPE_CHECKING:
    from stiction.analysis.protocols.healing import Healing
    from stiction.analysis.protocols.hysteresis import Hysteresis
    from stiction.analysis.protocols.load_dependence import LoadDependence
    from stiction.analysis.protocols.step_findings import VelocitySteps
    from stiction.analysis.protocols.yaw import ApparentFriction

REACH = 8.0  # D_c of slip that are drawn
POINTS = 200  # of the data after a step: more would hide the line


def plot_velocity_steps(found: VelocitySteps, ax: Axes | None = None) -> Axes:
    """Draw friction over the slip since each jump of the velocity, and the fitted evolution.

    Parameters
    ----------
    found : VelocitySteps
        From `stiction.analysis.velocity_steps`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.
    """
    with style():
        ax = panel(ax, 2.8)
        far = max((REACH * each.D_c for each in found.steps if each.D_c > 0.0), default=None)
        for n, each in enumerate(found.steps):
            color, dashes = LINES[n % len(LINES)]
            label = f"{in_words(each.before, 'm/s', 3)} to {in_words(each.after, 'm/s', 3)}"
            some = slice(None, None, max(1, len(each.slip) // POINTS))
            ax.plot(1e6 * each.slip[some], each.mu[some], ".", color=color, ms=4.0, alpha=0.4)
            ax.plot(1e6 * each.slip, each.fit, color=color, linestyle=dashes, label=label, zorder=3)
            ax.axhline(each.steady_before, color=color, linestyle=dashes, linewidth=0.4)
        if far is not None:
            ax.set_xlim(0.0, 1e6 * far)
        ax.set_xlabel("slip since the step (µm)")
        ax.set_ylabel(r"friction $\mu$ (1)")
        fit = f"; lines: {found.steps[0].law} law" if far is not None else ""
        ax.legend(loc="best", title=f"points: data{fit}")
    return ax


def plot_healing(found: Healing, ax: Axes | None = None) -> Axes:
    """Draw peak less steady friction over the hold time, and the line through it.

    Parameters
    ----------
    found : Healing
        From `stiction.analysis.healing`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.
    """
    with style():
        ax = panel(ax, 2.4)
        sure = found.resolved
        ax.plot(
            found.hold[sure], found.gain[sure], "o",
            color=BLACK, markersize=3.0, label="each hold",
        )  # fmt: skip
        if found.peak_error is not None:
            reach = found.hold[sure], found.gain[sure], found.peak_error[sure]
            ax.errorbar(*reach, fmt="none", ecolor=BLACK, elinewidth=0.6)
        if not sure.all():
            ax.plot(found.hold[~sure], found.gain[~sure], "^", color=GREY, label="at least")
        if np.isfinite(found.per_decade):
            holds = np.array([found.hold.min(), found.hold.max()])
            line = found.at_one_second + found.per_decade * np.log10(holds)
            label = f"{with_error(found.per_decade, found.per_decade_error, '')} per decade"
            ax.plot(holds, line, color=BLUE, label=label)
        ax.set_xscale("log")
        ax.set_xlabel("hold time (s)")
        ax.set_ylabel(r"$\Delta\mu$: peak less steady (1)")
        ax.legend(loc="upper left")
    return ax


def plot_hysteresis(found: Hysteresis, ax: Axes | None = None) -> Axes:
    """Draw the loops of a reversal test, the last one shaded.

    Parameters
    ----------
    found : Hysteresis
        From `stiction.analysis.hysteresis`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.
    """
    with style():
        ax = panel(ax, 2.6)
        last = found.loops[-1]
        for each in found.loops[:-1]:
            ax.plot(1e3 * each.travel, each.force, color=GREY, linewidth=0.6)
        label = f"loop {len(found.loops)}: {in_words(last.area, 'J', 3)}"
        ax.fill(1e3 * last.travel, last.force, color=BLUE, alpha=0.12, linewidth=0)
        ax.plot(1e3 * last.travel, last.force, color=BLUE, label=label)
        middle = 0.5 * (float(np.max(last.force)) + float(np.min(last.force)))
        ax.axhline(middle, color=BLACK, linewidth=0.4)
        ax.set_xlabel("travel of the drive since its turn (mm)")
        ax.set_ylabel("force (N)")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return ax


def plot_load_dependence(found: LoadDependence, ax: Axes | None = None) -> Axes:
    """Draw friction over the normal load, and the line through it down to zero load.

    Parameters
    ----------
    found : LoadDependence
        From `stiction.analysis.load_dependence`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Examples
    --------
    >>> import stiction as st
    >>> load = st.protocols.load_ramp(["10 N", "20 N", "30 N"], ramp="2 s", hold="5 s")
    >>> slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2), load=load)
    >>> found = st.analysis.load_dependence(st.simulate(slider, sample_rate="100 Hz"))
    >>> ax = st.plotting.plot_load_dependence(found)
    """
    with style():
        ax = panel(ax, 2.4)
        ax.plot(found.load, found.force, "o", color=BLACK, markersize=3.0, label="each level")
        loads = np.array([0.0, found.load.max()])
        label = f"slope {with_error(found.coefficient, found.error, '')}"
        ax.plot(loads, found.adhesion + found.coefficient * loads, color=BLUE, label=label)
        ax.set_xlabel("normal load (N)")
        ax.set_ylabel("friction (N)")
        ax.legend(loc="upper left")
    return ax


def plot_apparent_friction(found: ApparentFriction, ax: Axes | None = None) -> Axes:
    """Draw a load cell's reading over the misalignment: its peak, its mean and its span.

    Parameters
    ----------
    found : ApparentFriction
        From `stiction.analysis.apparent_friction`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.
    """
    phi = np.degrees(found.phi)
    with style():
        ax = panel(ax, 2.6)
        low, high = found.mean - found.amplitude, found.mean + found.amplitude
        ax.fill_between(phi, low, high, color=BLUE, alpha=0.15, linewidth=0)
        ax.plot(phi, found.peak, "^", color=RED, markersize=3.0, label="peak: apparent static")
        label = "mean, and half span: apparent kinetic"
        ax.plot(phi, found.mean, "o-", color=BLUE, markersize=2.6, label=label)
        label = r"steady sliding: $\mu(V) \cos\varphi$"
        ax.plot(phi, found.steady, color=BLACK, linestyle=(0, (4, 1.5)), label=label)
        ax.set_xlabel(r"misalignment $\varphi$ (deg)")
        ax.set_ylabel("force on the soft spring over load (1)")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return ax
