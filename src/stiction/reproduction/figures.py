"""The paper's figures of the apparatus and its model, of a run, and of the damping diagram."""

from __future__ import annotations

from math import degrees, pi, radians, sin

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction import theory
from stiction.analysis.creep.first_slip import first_slip_time
from stiction.analysis.signals.spectrum import rate_spectrogram
from stiction.plotting.analysis.oscillation import draw_spectrogram, mark_frequency
from stiction.plotting.apparatus.pin_on_plate import draw_apparatus, draw_side_view
from stiction.plotting.apparatus.schematic import draw_schematic
from stiction.plotting.apparatus.vectors import draw_velocity_triangle
from stiction.plotting.page.canvas import fix_ticks
from stiction.plotting.page.style import (
    BLUE,
    COLUMN,
    GREEN,
    PAGE,
    RED,
    lay_out,
    new_figure,
    panel_letter,
    style,
)
from stiction.plotting.run import time_series
from stiction.plotting.run.lines import draw_line
from stiction.plotting.run.time_series import draw_rate
from stiction.plotting.stability.damping import (
    CLEAR,
    draw_damping_map,
    draw_force_path,
    name_crossing,
    place_clear,
)
from stiction.system.slider import Slider
from stiction.text.quantity.prefix import metric_prefix
from stiction.trajectory import Trajectory

# places of a word, shares of width and height, the best first
ACROSS = sorted(np.linspace(0.18, 0.84, 34), key=lambda x: abs(x - 0.45))
WORD = (0.12, 0.05)  # half of a word
HIGH, LOW = (0.92, 0.86, 0.8, 0.72, 0.64), (0.15, 0.1, 0.2, 0.28)


def schematic(slider: Slider) -> Figure:
    """Draw Figs. 1 and 2 of Nakano & Popov, for any slider.

    Parameters
    ----------
    slider : Slider
        The system; its misalignment is to scale where it is large enough to be seen.

    Returns
    -------
    Figure
        As wide as a page.
    """
    with style():
        fig = new_figure(PAGE, 4.1)
        axes = fig.subplot_mosaic(
            [["apparatus", "top"], ["side", "triangle"]],
            width_ratios=[1.0, 1.2],
            height_ratios=[1.9, 1.0],
        )
        draw_apparatus(axes["apparatus"], slider)
        draw_side_view(axes["side"], slider)
        draw_schematic(axes["top"], slider)
        draw_velocity_triangle(axes["triangle"], slider)
        for name, title in (
            ("apparatus", "Apparatus (Fig. 1)"),
            ("side", "(a) Side view (Fig. 2)"),
            ("top", "(b) Top view"),
            ("triangle", "(c) Velocities and angles"),
        ):
            axes[name].set_title(title)
    return fig


def figure3(run: Trajectory) -> Figure:
    """Draw Fig. 3 of Nakano & Popov: forces, friction vector and position over time.

    (a) Spring force along x, (b) along y, (c) magnitude of the friction force, (d) its angle
    to the drive, (e) position, with the creep before the first slip magnified.

    Parameters
    ----------
    run : Trajectory
        The paper's runs 5 s; any other will do.

    Returns
    -------
    Figure
        As wide as a column.
    """
    with style():
        fig = new_figure(COLUMN, 5.6)
        axes = fix_ticks(list(fig.subplots(5, 1, sharex=True, height_ratios=[1, 1, 1, 1, 1.5])))
        time_series.draw_spring_force(axes[0], run, "x")
        time_series.draw_spring_force(axes[1], run, "y")
        time_series.draw_friction(axes[2], run)
        time_series.draw_direction(axes[3], run)
        time_series.draw_position(axes[4], run)
        for ax, letter in zip(axes, "abcde", strict=True):
            ax.margins(y=0.12)
            panel_letter(ax, letter)
        magnify_creep(axes[4], run)
        axes[-1].set_xlabel("time $t$ (s)")
        fig.align_ylabels(axes)
    return fig


def magnify_creep(ax: Axes, run: Trajectory) -> Axes:
    """Draw, in an inset, how X (um) creeps before the first slip."""
    time, X = run.samples["time"], run.samples["X"]
    end = first_slip_time(run)
    stick = time <= time[0] + 0.98 * (end - time[0])
    inset = ax.inset_axes((0.16, 0.48, 0.36, 0.44))
    factor, prefix = metric_prefix(X[stick])
    draw_line(inset, time[stick], X[stick] * factor, BLUE)
    inset.set_ylabel(f"$X$ ({prefix}m)", fontsize=7, labelpad=1)
    inset.set_xlabel("$t$ (s)", fontsize=7, labelpad=1)
    inset.margins(y=0.08)
    ax.annotate(
        "",
        (0.16 * end, 0.0),
        (0.30, 0.28),
        textcoords="axes fraction",
        arrowprops={"arrowstyle": "->", "linewidth": 0.6},
    )
    return inset


def figure4(run: Trajectory) -> Figure:
    """Draw Fig. 4 of Nakano & Popov: the elongation rates and their spectrograms.

    (a) v_x, (b) its spectrogram, (c) v_y, (d) its spectrogram; Hamming window of 0.1 s. The
    transverse natural frequency omega_y/2 pi is marked: the oscillation starts there and
    falls towards each slip.

    Sampling folds what lies above half the sample rate back into view. At 10 kHz the folded
    harmonics are below the colour scale; at much lower rates they are not.

    Parameters
    ----------
    run : Trajectory
        Sampled at more than twice the frequencies to be seen; 10 kHz for the paper's.

    Returns
    -------
    Figure
        As wide as a column.
    """
    slider = run.slider
    natural = float(theory.natural_frequency(slider.k_y, slider.mass)) / (2 * pi)
    with style():
        fig = new_figure(COLUMN, 5.4)
        axes = fix_ticks(list(fig.subplots(4, 1, sharex=True, height_ratios=[1, 1.5, 1, 1.5])))
        for (rate, spectrum), axis in zip((axes[:2], axes[2:]), "xy", strict=True):
            draw_rate(rate, run, axis)
            rate.margins(y=0.12)
            mesh = draw_spectrogram(spectrum, rate_spectrogram(run, axis), highest=2 * natural)
            mark_frequency(spectrum, natural, r"$\omega_y/2\pi$")
        for ax, letter in zip(axes, "abcd", strict=True):
            panel_letter(ax, letter)
            ax.locator_params(axis="y", nbins=3)
        _magnify_stick(axes[0], run)
        axes[-1].set_xlabel("time $t$ (s)")
        bar = fig.colorbar(mesh, ax=axes, location="bottom", extend="both", aspect=35, pad=0.01)
        bar.set_label("amplitude (dB re 1 µm/s)")
        fig.align_ylabels(axes)
    return fig


def _magnify_stick(ax: Axes, run: Trajectory) -> Axes:
    """Draw, in an inset, v_x before the first slip, where its oscillation is small."""
    start, end = float(run.samples["time"][0]), first_slip_time(run)
    stick = run.data["v_x"].sel(time=slice(start, start + 0.98 * (end - start)))
    factor, prefix = metric_prefix(stick.values)
    inset = ax.inset_axes((0.14, 0.2, 0.25, 0.52))
    draw_line(inset, stick["time"].values, stick.values * factor, RED)
    inset.set_ylabel(f"{prefix}m/s", fontsize=7, labelpad=1)
    inset.margins(y=0.15)
    return inset


def figure5(slider: Slider, other_phi: float | None = radians(10)) -> Figure:
    """Draw Fig. 5 of Nakano & Popov: the damping ratio along the path of the friction force.

    Parameters
    ----------
    slider : Slider
        The system, misaligned and driven; its path is red.
    other_phi : float or None
        Misalignment of a second path, in blue, rad; everything else is the slider's.

    Returns
    -------
    Figure
        As wide as a column.

    Raises
    ------
    ValueError
        Without misalignment or drive, because the damping number A is undefined.
    """
    with style():
        fig = new_figure(COLUMN, 2.9)
        ax = fig.subplots()
        angles = [slider.misalignment] if other_phi is None else [slider.misalignment, other_phi]
        paths = [(damping_number(slider, phi), phi) for phi in angles]
        low = min(1e-1, *(A / 10 for A, _ in paths))
        high = max(1e5, *(A * 10 for A, _ in paths))
        lowest = min(0.5, degrees(abs(slider.misalignment)) / 2)
        draw_damping_map(ax, (low, high), (lowest, 90.0))
        for (A, phi), color in zip(paths, (RED, BLUE), strict=False):
            draw_force_path(ax, A, phi, color, _label(A, phi))
        fig.legend(loc="outside upper center", ncols=2)
        lay_out(fig)  # words are placed in axes of their final size
        for A, phi in paths:
            name_crossing(ax, A, phi)
        at = np.geomspace(low, high, 40)[2:-2]
        edge = np.degrees(theory.critical_angle(np.maximum(at, 1.0)))
        name = ax.text(0.0, 0.0, r"$\zeta$ = 1", color=GREEN, ha="right", va="top", bbox=CLEAR)
        place_clear(
            name, [{"position": each} for each in zip(at[::-1], 0.88 * edge[::-1], strict=True)]
        )
        for text, heights, inner in (
            ("overdamped:\nslow creep", HIGH, -1.0),
            ("underdamped:\nrapid slip", LOW, 1.0),
        ):
            word = ax.text(0.0, 0.0, text, transform=ax.transAxes, ha="center", bbox=CLEAR)
            word.set(verticalalignment="center", fontsize=7)
            # the corner nearest to the boundary is on the word's own side of it
            own = [
                {"position": (x, y)}
                for y in heights
                for x in ACROSS
                if inner
                * np.log(
                    theory.damping_ratio(
                        low * (high / low) ** (x + inner * WORD[0]),
                        np.radians(lowest * (90.0 / lowest) ** (y + inner * WORD[1])),
                    )
                )
                < 0.0
            ]
            place_clear(word, own)
    return fig


def damping_number(slider: Slider, phi: float) -> float:
    """Return A of Eq. (10) for the slider at a misalignment `phi` (rad), dimensionless."""
    V = slider.drive_speed
    if V == 0 or sin(phi) == 0:
        raise ValueError(f"A needs a drive and a misalignment; V is {V:g} m/s, phi {phi:g} rad")
    return theory.damping_number_of(slider, V, phi)


def _label(A: float, phi: float) -> str:
    digits, power = f"{A:.1e}".split("e")
    misalignment = f"{degrees(phi):.4g}".replace("-", "−")
    number = rf"{digits}$\times$10$^{{{int(power)}}}$" if abs(int(power)) > 1 else f"{A:.2g}"
    return rf"$\varphi$ = {misalignment}°, $A$ = {number}"
