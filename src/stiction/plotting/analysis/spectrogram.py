"""Spectrograms."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.lines import Line2D

from stiction.arrays import xr
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import style


def plot_spectrogram(
    amplitude: xr.DataArray, highest: float | None = None, ax: Axes | None = None
) -> Axes:
    """Draw amplitudes over time and frequency, in decibels below the largest.

    Parameters
    ----------
    amplitude : DataArray
        Over ``frequency`` (Hz) and ``time`` (s), from `stiction.analysis.spectrogram`.
    highest : float, optional
        Upper end of the frequency axis, Hz; all when left out.
    ax : Axes, optional
        Drawn on; a new figure as wide as a column when left out.
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

    Parameters
    ----------
    ax : Axes
        Drawn on.
    amplitude : DataArray
        Over ``frequency`` (Hz) and ``time`` (s), from `stiction.analysis.signals.spectrum`.
    reference : float
        The amplitude of 0 dB, in the unit of `amplitude`.
    decibels : tuple of float
        Ends of the colour scale, dB.
    highest : float
        Upper end of the frequency axis, Hz.

    Returns
    -------
    QuadMesh
        For the colour bar.
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
