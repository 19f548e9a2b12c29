"""The spectrogram of a run for its view: right for a run of any length.

A long run is not sampled throughout, but in each window by itself: the rate of the samples follows
from the frequencies of the system alone.
"""

from __future__ import annotations

import numpy as np

from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.explorer.motion import Check, Reply, simulate, span
from stiction.system.description import Description
from stiction.text.quantity.wording import in_words

# Of the highest frequency: what is shown, and the rate of samples
SHOWN_BAND, SAMPLED_RATE = 2.0, 8.0
FEWEST_SAMPLES, MOST_SAMPLES = 2_000, 150_000  # samples of a run that is sampled throughout
WIDTHS, STEPS, SHORTEST = 50, 6, 64  # windows beside each other, steps of one, samples of one
STEP_ROUNDING = 8.0 * np.finfo(np.float64).eps  # of an elongation: smaller steps are none
APART, LENGTH = 300, 1_024  # windows of a longer run, samples of one


def spectrogram(description: Description, check: Check) -> Reply:
    """Return the spectrogram of the transverse rate: amplitudes (m/s), frequency by time.

    Transformed are mean rates from sample to sample, differences of the elongation. They hold less
    of what oscillates faster than samples can show, and would be folded into the view, than samples
    of the rate: at a multiple of the sample rate, nothing.

    Raises
    ------
    ResultError
        If the run ended within the first window.
    """
    from stiction.analysis.signals.spectrum import spectrogram as transform

    low, high = span(description)
    slider = description.slider
    highest = max(*slider.natural_frequencies, *slider.modulation_frequencies)
    count = max(int(SAMPLED_RATE * highest * (high - low)), FEWEST_SAMPLES)
    if count <= MOST_SAMPLES:
        rate, windows = count / (high - low), 1
        length = max(count // WIDTHS, SHORTEST)
        times, hop = np.linspace(low, high, count + 1), length // STEPS
    else:
        rate, length, hop = SAMPLED_RATE * highest, LENGTH, LENGTH
        windows = min(APART, int((high - low) * rate) // (length + 1))  # beside each other
        starts = np.linspace(low, high - length / rate, windows)
        times = (starts[:, np.newaxis] + np.arange(length + 1) / rate).ravel()
    elongation = sample(description, times, check)
    rates = mean_rates(elongation, rate, len(times) // windows)
    if len(rates) < length:
        lasts = in_words(length / rate, "s")
        raise ResultError(f"the run ended before a spectrum could be taken, which lasts {lasts}")
    found = transform(rates, rate, width=length / rate, step=hop / rate, start=low)
    frequency = found["frequency"].values
    top = max(int(np.searchsorted(frequency, SHOWN_BAND * highest)), SHORTEST // 8)
    loss = np.sinc(frequency[:top] / rate)  # of a mean over a step
    amplitude = found.values[:top] / loss[:, np.newaxis]
    amplitude[amplitude < STEP_ROUNDING * np.max(abs(elongation)) * rate] = 0.0
    middles = found["time"].values
    if windows > 1:
        middles = starts[: amplitude.shape[1]] + 0.5 * length / rate
    head = {
        "frequency": (0.0, float(frequency[top - 1])),
        "times": (float(middles[0]), float(middles[-1])),
    }
    return head, {"amplitude": amplitude.astype(np.float32)}


def sample(description: Description, times: Floats, check: Check) -> Floats:
    """Return the transverse elongation (m) at `times` (s), as far as the run came."""
    _, table = simulate(description, times, check)
    reached = table["time"]
    count = len(reached) - int(reached[-1] != times[len(reached) - 1])  # its end is none of them
    found: Floats = table["u_y"][:count]
    return found[np.isfinite(found)]


def mean_rates(elongation: Floats, rate: float, length: int) -> Floats:
    """Return the mean rates (m/s) from each sample to the next in parts of `length` samples.

    Of the last part, what there is, if it is the only one.
    """
    if len(elongation) < 2 * length:
        return np.diff(elongation[:length]) * rate
    whole = elongation[: len(elongation) // length * length]
    found: Floats = (np.diff(whole.reshape(-1, length), axis=1) * rate).ravel()
    return found
