"""The transverse oscillation in the stick phase, followed through its cycles."""

from __future__ import annotations

from math import pi
from typing import Any, TypeGuard

import numpy as np

from stiction import theory
from stiction.analysis.measured_line import STEPS
from stiction.analysis.motion.rest import sticks_until, stuck_until
from stiction.analysis.signals.ridge import follow_ridge
from stiction.analysis.signals.spectrum import even_rate, rate_spectrogram
from stiction.arrays import TINY, Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity.wording import advice, in_words
from stiction.trajectory import Trajectory

Rows = dict[str, tuple[Any, str, str]]  # name: values, unit, long name

WIDTH = 50.0  # transverse periods in a window
LOWEST = 0.15  # of omega_y: the frequency falls no lower before it dies away
HIGHEST = 1.2
SELDOM = 0.05  # of the time: a line that is seen no longer may be chance
SILENT = 1e-3  # of V sin(phi): smaller swings may be noise of the solver


def transverse_oscillation(run: Trajectory) -> xr.Dataset:
    """Follow the transverse oscillation of a run through time.

    Its frequency starts at omega_y and falls towards slip as sin(theta), with
    cos(theta) = k_x u_x/F_0: see `stiction.theory.oscillation_frequency`, which is ``expected``.
    As in Eq. (9), the velocity v_y reaches V sin(phi), where the mass sticks. The amplitude
    v_y/omega therefore is V sin(phi)/omega_y, the paper's bound, only at first, and grows as the
    frequency falls.

    Parameters
    ----------
    run : Trajectory
        Misaligned, and sampled several times each transverse period.

    Returns
    -------
    Dataset
        Over ``time`` (s), the middle of windows of 50 transverse periods, which overlap:
        ``frequency`` (Hz; NaN where no line stands out, or its velocity is below a thousandth of
        the bound), ``prominence`` as in `stiction.analysis.follow_ridge`, ``expected`` (Hz);
        ``velocity`` (m/s), half the range of v_y, and ``amplitude`` (m), velocity over angular
        frequency; ``velocity_bound`` V sin(phi) and ``amplitude_bound`` V sin(phi)/omega_y;
        ``share_stuck``, of time, and ``sticks_per_second`` (1/s): both are zero where the
        oscillation rings down freely.

    Raises
    ------
    ResultError
        If the run is too short or too coarsely sampled for it, or nothing moves along y.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "1 s", sample_rate="10 kHz")
    >>> round(float(st.analysis.transverse_oscillation(run)["frequency"][0]), -1)
    1000.0
    """
    natural = run.slider.natural_frequency_y
    width = WIDTH / natural
    if not run.samples["v_y"].any():
        raise ResultError("nothing moves across the drive: there is no misalignment")
    found = follow_ridge(oscillation_spectrogram(run), LOWEST * natural, HIGHEST * natural)
    middle = found["time"].values
    velocity, bound, expected = _in_windows(run, middle, width)
    found["frequency"] = found["frequency"].where(found["amplitude"] > SILENT * bound)
    edges = np.stack([middle - 0.5 * width, middle + 0.5 * width])
    stuck = np.diff(stuck_until(edges, run.stick_intervals), axis=0)[0] / width
    rows = {
        "expected": (expected / (2.0 * pi), "Hz", "frequency along the friction force"),
        "velocity": (velocity, "m/s", "half the range of v_y"),
        "velocity_bound": (bound, "m/s", "V sin(phi)"),
        "amplitude": (velocity / (2.0 * pi * found["frequency"].values), "m", "amplitude of u_y"),
        "amplitude_bound": (bound / (2.0 * pi * natural), "m", "V sin(phi)/omega_y"),
        "share_stuck": (stuck, "1", "share of time stuck"),
        "sticks_per_second": (
            np.diff(sticks_until(edges, run.stick_intervals), axis=0)[0] / width,
            "1/s",
            "stick intervals per second",
        ),
    }
    return (
        found.drop_vars("amplitude")
        .assign(_label("time", rows))
        .assign_attrs(natural_frequency=natural, width=width)
    )


def oscillation_spectrogram(run: Trajectory) -> xr.DataArray:
    """Return the spectrogram of v_y (m/s), see `transverse_oscillation`."""
    natural = run.slider.natural_frequency_y
    width = WIDTH / natural
    span, rate = float(np.ptp(run.samples["time"])), even_rate(run)
    if rate < 2.0 * HIGHEST * natural or span < width:
        raise ResultError(
            f"the transverse oscillation is at {in_words(natural, 'Hz')}; sample the run at "
            f"{advice(5.0 * natural, 'Hz')} or more, and for at least {advice(width, 's')}; it "
            f"is sampled at {in_words(rate, 'Hz')} for {in_words(span, 's')}"
        )
    return rate_spectrogram(run, "y", width=width, steps=STEPS)


def oscillation_by_phase(oscillation: xr.Dataset, run: Trajectory, phases: Floats) -> xr.Dataset:
    """Return the shares of ring-down and micro stick-slip in each stick phase.

    Parameters
    ----------
    oscillation : Dataset
        From `transverse_oscillation`.
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
        slip; ``first_frequency`` and ``last_frequency`` (Hz) that are seen in it.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "3 s", sample_rate="10 kHz")
    >>> swings = st.analysis.transverse_oscillation(run)
    >>> found = st.analysis.oscillation_by_phase(swings, run, np.array([[0.1, 1.9]]))
    >>> bool(found["share_stuck"][0] > 0.05)
    True
    """
    phases = np.asarray(phases, dtype=np.float64).reshape(-1, 2)
    length = phases[:, 1] - phases[:, 0]
    begun = sticks_until(phases, run.stick_intervals)
    count = begun[:, 1] - begun[:, 0]
    ends = np.append(-np.inf, run.stick_intervals[:, 1])[begun[:, 1]]
    last = np.clip(ends, phases[:, 0], phases[:, 1])
    stuck = np.diff(stuck_until(phases, run.stick_intervals), axis=1)[:, 0]
    length = np.where(length > 0.0, length, np.nan)  # a share of nothing is none
    seen = [_frequencies(oscillation, *phase) for phase in phases]
    rows = {
        "share_stuck": (stuck / length, "1", "share of time stuck"),
        "sticks": (count, "1", "stick intervals"),
        "sticks_per_second": (count / length, "1/s", "stick intervals per second"),
        "rings_from": (last, "s", "end of the last stick"),
        "ring_down": ((phases[:, 1] - last) / length, "1", "share of time without sticks, to slip"),
        "first_frequency": (np.array([f[0] for f in seen]), "Hz", "first frequency seen"),
        "last_frequency": (np.array([f[1] for f in seen]), "Hz", "last frequency seen"),
    }
    seconds = {"units": "s"}
    return xr.Dataset(
        _label("phase", rows),
        {"start": ("phase", phases[:, 0], seconds), "end": ("phase", phases[:, 1], seconds)},
    )


def stands_out(oscillation: xr.Dataset | None) -> TypeGuard[xr.Dataset]:
    """Return whether there is a line, and it is seen for longer than by chance."""
    if oscillation is None:
        return False
    seen = np.isfinite(oscillation["frequency"].values)
    return bool(seen.any() and seen.mean() >= SELDOM)


def hides(oscillation: xr.Dataset, cycles: xr.Dataset) -> bool:
    """Return whether windows are longer than half a cycle."""
    if not cycles.sizes["cycle"]:
        return False
    return bool(oscillation.attrs["width"] > 0.5 * float(np.median(cycles["period"].values)))


def apart(oscillation: xr.Dataset, cycles: xr.Dataset) -> xr.Dataset:
    """Return an oscillation without lines that may be harmonics of the cycles.

    If windows are longer than half a cycle, only lines before the first cycle remain.
    """
    if not hides(oscillation, cycles):
        return oscillation
    before = oscillation["time"] + 0.5 * oscillation.attrs["width"] < float(cycles["start"][0])
    cleared = {name: oscillation[name].where(before) for name in ("frequency", "amplitude")}
    return oscillation.assign(cleared)


def _label(dimension: str, rows: Rows) -> dict[str, tuple[str, Any, dict[str, str]]]:
    """Return variables over a dimension from values, unit and long name of each."""
    return {
        name: (dimension, values, {"units": unit, "long_name": meaning})
        for name, (values, unit, meaning) in rows.items()
    }


def _frequencies(oscillation: xr.Dataset, start: float, end: float) -> tuple[float, float]:
    half = 0.5 * oscillation.attrs["width"]
    inside = (oscillation["time"].values >= start + half) & (
        oscillation["time"].values <= end - half
    )
    seen = oscillation["frequency"].values[inside]
    seen = seen[np.isfinite(seen)]
    return (float(seen[0]), float(seen[-1])) if len(seen) else (np.nan, np.nan)


def _in_windows(run: Trajectory, middle: Floats, width: float) -> tuple[Floats, Floats, Floats]:
    """Return half the range of v_y (m/s), its bound, and the expected frequency (rad/s).

    Each in the middle fifth of a window, where those of its neighbours begin and end.
    """
    slider, data = run.slider, run.data
    times, half = data["time"].values, 0.5 * width / STEPS
    begin, end = (np.searchsorted(times, middle + side) for side in (-half, half))
    pairs = np.stack([begin, np.maximum(end, begin + 1)], axis=1).ravel()
    pairs = np.minimum(pairs, len(times) - 1)
    counts = np.diff(pairs)[::2]

    def mean(name: str) -> Floats:
        return np.asarray(np.add.reduceat(data[name].values, pairs)[::2] / counts)

    v_y = data["v_y"].values
    range_y = np.maximum.reduceat(v_y, pairs)[::2] - np.minimum.reduceat(v_y, pairs)[::2]
    across = np.abs(slider.along_axes(mean("drive_X"), mean("drive_Y"))[1])
    holds = slider.F_0 * mean("normal_load") / slider.normal_load
    cosine = np.clip(np.abs(mean("spring_x")) / np.maximum(holds, TINY), 0.0, 1.0)
    m = slider.masses[1]  # the oscillation is across, on the stiff spring
    expected = theory.oscillation_frequency(np.arccos(cosine), slider.k_x, slider.k_y, m)
    return 0.5 * range_y, across, expected
