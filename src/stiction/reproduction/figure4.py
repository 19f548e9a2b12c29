"""Fig. 4: the high-frequency oscillations in the stick phase."""

from __future__ import annotations

from math import pi

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction import theory
from stiction.analysis.creep.first_slip import first_slip_time
from stiction.analysis.signals.spectrum import rate_spectrogram
from stiction.plotting.analysis.spectrogram import draw_spectrogram, mark_frequency
from stiction.plotting.page.style import COLUMN, RED, new_figure, panel_letter, style
from stiction.plotting.run.time_series import draw_line, draw_rate
from stiction.text.quantity_text import metric_prefix
from stiction.trajectory import Trajectory


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
        axes = fig.subplots(4, 1, sharex=True, height_ratios=[1, 1.5, 1, 1.5])
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
