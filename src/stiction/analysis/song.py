"""The song: the high-frequency oscillation in the stick phase, followed through its cycles."""

from __future__ import annotations

from math import pi, sin
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stiction import theory
from stiction.analysis.ridge import follow_ridge
from stiction.analysis.spectrum import spectrogram
from stiction.analysis.stuck import sticks_until, stuck_until
from stiction.errors import ResultError
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

WIDTH = 50.0  # transverse periods in a window
STEPS = 5  # windows that overlap at any time
LOWEST = 0.15  # of omega_y: the song falls no lower before it dies away
HIGHEST = 1.2


def hear_song(run: Trajectory) -> xr.Dataset:
    """Follow the transverse oscillation of a run through time.

    While the friction force is turned by theta, slip has its direction, across which the mass is
    held as if by a strong damper, F/(m |s|) per second. So it swings along the force, against the
    stiffness k_x cos^2(theta) + k_y sin^2(theta): the song begins at omega_y and falls as
    sin(theta), with cos(theta) = k_x u_x/F_0, towards slip. (Beyond the paper, which reports the
    fall, Fig. 4; this is ``expected``.)

    As in the paper, Eq. (9), its velocity v_y reaches V sin(phi) where the mass sticks. The
    amplitude v_y/omega is thus V sin(phi)/omega_y, the bound, only at first, and
    grows as the frequency falls.

    Parameters
    ----------
    run : Trajectory
        Misaligned, and sampled several times each transverse period.

    Returns
    -------
    Dataset
        Over ``time`` (s), the middle of windows of 50 transverse periods: ``frequency`` (Hz; not
        a number where no line stands out), ``expected`` (Hz), ``prominence`` as in
        `stiction.follow_ridge`; ``velocity`` (m/s), half the range of v_y, and ``amplitude`` (m),
        it over the frequency; ``velocity_bound`` V sin(phi) and ``amplitude_bound``
        V sin(phi)/omega_y; ``share_stuck``, of time, and ``sticks_per_second`` (1/s): both are
        zero where the oscillation rings down freely.

    Raises
    ------
    ResultError
        If the run is too short or too coarsely sampled for it.
    """

    slider, data = run.slider, run.data
    times, v_y = data["time"].values, data["v_y"].values
    natural, width = _scales(run)
    lines = song_spectrogram(run)
    found = follow_ridge(lines, LOWEST * natural, HIGHEST * natural)
    middle = found["time"].values
    velocity, force = _in_windows(times, v_y, data["spring_x"].values, middle, width)
    edges = np.stack([middle - 0.5 * width, middle + 0.5 * width])
    across = abs(slider.motion.rate(times[0])[0] * sin(slider.phi))
    cosine = np.clip(np.abs(force) / slider.F_0, 0.0, 1.0)
    stiffness = (slider.k_x * cosine**2 + slider.k_y * (1.0 - cosine**2)) / slider.k_y
    rows = {
        "expected": (natural * np.sqrt(stiffness), "Hz", "omega_y sin(theta)/2 pi"),
        "velocity": (velocity, "m/s", "half the range of v_y"),
        "velocity_bound": (np.full(len(middle), across), "m/s", "V sin(phi)"),
        "amplitude": (velocity / (2.0 * pi * found["frequency"].values), "m", "amplitude of u_y"),
        "amplitude_bound": (
            np.full(len(middle), across / (2.0 * pi * natural)),
            "m",
            "V sin(phi)/omega_y",
        ),
        "share_stuck": (np.diff(stuck_until(edges, run.sticks), axis=0)[0] / width, "1", "stuck"),
        "sticks_per_second": (
            np.diff(sticks_until(edges, run.sticks), axis=0)[0] / width,
            "1/s",
            "sticks per second",
        ),
    }
    return (
        found.drop_vars("amplitude")
        .assign(
            {
                name: ("time", values, {"units": unit, "long_name": meaning})
                for name, (values, unit, meaning) in rows.items()
            }
        )
        .assign_attrs(natural_frequency=natural, width=width)
    )


def song_spectrogram(run: Trajectory) -> xr.DataArray:
    """Return the spectrogram of v_y (m/s) in which the song is followed, see `hear_song`."""
    times = run.data["time"].values
    natural, width = _scales(run)
    span = float(times[-1] - times[0])
    rate = (len(times) - 1) / span if span > 0.0 else 0.0
    if rate < 2.0 * HIGHEST * natural or span < width:
        raise ResultError(
            f"the transverse oscillation has {natural:.4g} Hz: sample the run at "
            f"{5 * natural:.4g} Hz or more and for {width:.3g} s at least; it has "
            f"{rate:.4g} Hz and {span:.3g} s"
        )
    lines = spectrogram(
        run.data["v_y"].values, rate, width=width, step=width / STEPS, start=float(times[0])
    )
    return lines.assign_attrs(units="m/s", long_name="amplitude of v_y")


def song_by_phase(song: xr.Dataset, run: Trajectory, phases: Floats) -> xr.Dataset:
    """Return how ring-down and micro stick-slip share each stick phase.

    Parameters
    ----------
    song : Dataset
        From `hear_song`.
    run : Trajectory
        The same run.
    phases : array
        (n, 2), s: start and end of each, e.g. of cycles from trough to peak.

    Returns
    -------
    Dataset
        Over ``phase``: ``start``, ``end`` (s); ``share_stuck``, of its time; ``sticks`` and
        ``sticks_per_second``, on the average; ``rings_from`` (s), when its last stick ends and
        the oscillation begins to ring down; ``ring_down``, the share of its time from there to
        slip; ``first_frequency`` and ``last_frequency`` (Hz) that are heard in it.
    """
    import xarray as xr

    phases = np.asarray(phases, dtype=np.float64).reshape(-1, 2)
    length = phases[:, 1] - phases[:, 0]
    begun = sticks_until(phases, run.sticks)
    count = begun[:, 1] - begun[:, 0]
    ends = np.append(-np.inf, run.sticks[:, 1])[begun[:, 1]]
    last = np.clip(ends, phases[:, 0], phases[:, 1])
    stuck = np.diff(stuck_until(phases, run.sticks), axis=1)[:, 0]
    heard = [_heard(song, *phase) for phase in phases]
    rows = {
        "share_stuck": (stuck / length, "1", "share of time stuck"),
        "sticks": (count, "1", "stick intervals"),
        "sticks_per_second": (count / length, "1/s", "stick intervals per second"),
        "rings_from": (last, "s", "end of the last stick"),
        "ring_down": ((phases[:, 1] - last) / length, "1", "share of time without sticks, to slip"),
        "first_frequency": (np.array([f[0] for f in heard]), "Hz", "first frequency heard"),
        "last_frequency": (np.array([f[1] for f in heard]), "Hz", "last frequency heard"),
    }
    return xr.Dataset(
        {
            name: ("phase", values, {"units": unit, "long_name": meaning})
            for name, (values, unit, meaning) in rows.items()
        },
        {
            "start": ("phase", phases[:, 0], {"units": "s"}),
            "end": ("phase", phases[:, 1], {"units": "s"}),
        },
    )


def _scales(run: Trajectory) -> tuple[float, float]:
    """Return the transverse natural frequency (Hz), and how wide windows are (s)."""
    omega_y = float(theory.natural_frequency(run.slider.k_y, run.slider.mass))
    return omega_y / (2.0 * pi), WIDTH * 2.0 * pi / omega_y


def _heard(song: xr.Dataset, start: float, end: float) -> tuple[float, float]:
    half = 0.5 * song.attrs["width"]
    inside = (song["time"].values >= start + half) & (song["time"].values <= end - half)
    heard = song["frequency"].values[inside]
    heard = heard[np.isfinite(heard)]
    return (float(heard[0]), float(heard[-1])) if len(heard) else (np.nan, np.nan)


def _in_windows(
    times: Floats, v_y: Floats, force: Floats, middle: Floats, width: float
) -> tuple[Floats, Floats]:
    """Return half the range of v_y in the middle fifth of each window, and the mean force."""
    half = 0.5 * width / STEPS
    begin, end = (np.searchsorted(times, middle + side) for side in (-half, half))
    pairs = np.stack([begin, np.maximum(end, begin + 1)], axis=1).ravel()
    pairs = np.minimum(pairs, len(times) - 1)
    high, low = np.maximum.reduceat(v_y, pairs)[::2], np.minimum.reduceat(v_y, pairs)[::2]
    return 0.5 * (high - low), np.add.reduceat(force, pairs)[::2] / np.diff(pairs)[::2]
