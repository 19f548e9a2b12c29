"""Spectrograms, and the transverse oscillation: frequency, amplitude, and the rests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from stiction.analysis.oscillation import oscillation_spectrogram
from stiction.arrays import xr
from stiction.plotting.page.canvas import panel, stack
from stiction.plotting.page.style import BLACK, BLUE, GREY, ORANGE, RED, panel_letter, style
from stiction.trajectory import Trajectory

HIGHEST = 1.5  # of omega_y, drawn


def plot_spectrogram(
    amplitude: xr.DataArray, highest: float | None = None, ax: Axes | None = None
) -> Axes:
    """Draw amplitudes over time and frequency, in decibels below the largest.

    Parameters
    ----------
    amplitude : DataArray
        Over ``frequency`` (Hz) and ``time`` (s), from `stiction.analysis.spectrogram`.
    highest : float, optional
        Upper end of the frequency axis, Hz; by default all.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.
    """
    with style():
        ax = panel(ax, 2.6)
        top = float(amplitude["frequency"].max()) if highest is None else highest
        mesh = draw_spectrogram(
            ax, amplitude, reference=float(amplitude.max()), decibels=(-70.0, 0.0), highest=top
        )
        ax.set_xlabel("time $t$ (s)")
        ax.figure.colorbar(mesh, ax=ax, label="amplitude (dB of the largest)", extend="min")
    return ax


def frequency_unit(highest: float) -> tuple[float, str]:
    """Return factor and unit in which frequencies up to `highest` (Hz) are drawn."""
    return (1e-3, "kHz") if highest >= 500.0 else (1.0, "Hz")


def draw_spectrogram(
    ax: Axes,
    amplitude: xr.DataArray,
    *,
    reference: float = 1e-6,
    decibels: tuple[float, float] = (-30.0, 40.0),
    highest: float = 2000.0,
) -> QuadMesh:
    """Draw amplitudes over time and frequency, in decibels.

    The `reference` is the amplitude of 0 dB, `decibels` are the ends of the colour scale, and
    `highest` is the upper end of the frequency axis, Hz.
    """
    shown = amplitude.sel(frequency=slice(0.0, highest))
    factor, unit = frequency_unit(highest)
    level = 20.0 * np.log10(np.fmax(shown.values / reference, 1e-30))
    mesh = ax.pcolormesh(
        shown["time"],
        shown["frequency"] * factor,
        level,
        shading="nearest",
        cmap="viridis",
        vmin=decibels[0],
        vmax=decibels[1],
        rasterized=True,
    )
    ax.set_ylim(0, min(highest, float(shown["frequency"].max())) * factor)
    ax.set_ylabel(f"frequency ({unit})")
    return mesh


def mark_frequency(ax: Axes, frequency: float, text: str) -> Line2D:
    """Mark a frequency (Hz) across a spectrogram and name it."""
    line = ax.axhline(frequency / 1e3, color="white", linewidth=0.8, dashes=(5, 3))
    ax.annotate(
        text,
        (1.0, frequency / 1e3),
        (-4, 2),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        color="white",
        fontsize=7,
        ha="right",
        va="bottom",
    )
    return line


def draw_ridge(ax: Axes, oscillation: xr.Dataset) -> None:
    """Draw the tracked frequency, and the theoretical omega_y sin(theta), over a spectrogram."""
    time = oscillation["time"].values
    factor, _ = frequency_unit(HIGHEST * oscillation.attrs["natural_frequency"])
    natural = oscillation.attrs["natural_frequency"] * factor
    ax.axhline(natural, color="white", linewidth=0.8, dashes=(5, 3), label=r"$\omega_y/2\pi$")
    expected = r"$\omega_y \sin\theta/2\pi$"
    ax.plot(
        time,
        oscillation["expected"].values * factor,
        color="white",
        lw=1.6,
        alpha=0.6,
        label=expected,
    )
    seen = oscillation["frequency"].values * factor
    if np.isfinite(seen).any():
        ax.plot(time, seen, color=RED, lw=0.9, label="seen")


def draw_amplitudes(ax: Axes, oscillation: xr.Dataset) -> None:
    """Draw velocity and displacement of the oscillation as shares of their bounds."""
    time = oscillation["time"].values
    share = (oscillation["amplitude"] / oscillation["amplitude_bound"]).values
    if np.isfinite(share).any():
        label = r"of $u_y$, over $V\sin\varphi/\omega_y$"
        ax.plot(time, share, color=BLUE, dashes=(4, 1.5), label=label)
    share = (oscillation["velocity"] / oscillation["velocity_bound"]).values
    ax.plot(time, share, color=BLACK, label=r"of $v_y$, over $V\sin\varphi$")
    ax.axhline(1.0, color=GREY, linewidth=0.6, zorder=1)
    ax.set_ylim(0.0, None)
    ax.set_ylabel("amplitude (1)")


def draw_share_stuck(ax: Axes, oscillation: xr.Dataset) -> None:
    """Draw the share of time stuck (%): where it is zero, the oscillation rings down freely."""
    share = 100.0 * oscillation["share_stuck"].values
    ax.fill_between(oscillation["time"].values, share, color=ORANGE, linewidth=0)
    ax.set_ylim(0.0, None)
    ax.set_ylabel("stuck (%)")


def plot_oscillation(
    run: Trajectory, oscillation: xr.Dataset, axes: Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw the transverse oscillation of a run over time.

    (a) Spectrogram of v_y with the frequency followed, omega_y, and omega_y sin(theta). (b) The
    amplitudes of v_y and u_y over their bounds. (c) The share of time stuck.

    Parameters
    ----------
    run : Trajectory
        As for `stiction.analysis.transverse_oscillation`.
    oscillation : Dataset
        What that returned.
    axes : sequence of Axes, optional
        Three, drawn on; by default a new figure as wide as a column.

    Returns
    -------
    ndarray of Axes
        The three.
    """
    natural = oscillation.attrs["natural_frequency"]
    with style():
        panels = stack(axes, 4.6, (2.0, 1.2, 1.0))
        amplitude = oscillation_spectrogram(run)
        top = max(40.0, 10.0 * np.ceil(2.0 * np.log10(float(amplitude.max()) / 1e-6)))
        mesh = draw_spectrogram(
            panels[0], amplitude, decibels=(top - 70.0, top), highest=HIGHEST * natural
        )
        draw_ridge(panels[0], oscillation)
        draw_amplitudes(panels[1], oscillation)
        draw_share_stuck(panels[2], oscillation)
        for ax, letter in zip(panels, "abc", strict=True):
            panel_letter(ax, letter)
        above: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "columnspacing": 1.0}
        dark: Any = {"facecolor": mesh.cmap(0.0), "frameon": True, "framealpha": 1.0}
        panels[0].legend(**above, **dark, ncols=3, labelcolor="white", handlelength=1.4)
        panels[1].legend(**above, ncols=2)
        begin, end = (float(oscillation["time"][at]) for at in (0, -1))
        if end > begin:
            panels[-1].set_xlim(begin, end)
        panels[-1].set_xlabel("time $t$ (s)")
        bar = panels[0].figure.colorbar(
            mesh, ax=panels, location="bottom", extend="both", aspect=35, pad=0.01
        )
        bar.set_label("amplitude of $v_y$ (dB re 1 µm/s)")
    return np.array(panels, dtype=object)
