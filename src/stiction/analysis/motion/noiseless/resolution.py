"""Whether the samples of a run are close enough to show its motion."""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from stiction.arrays import Floats
from stiction.system.slider import Slider
from stiction.system.tensors import stiffness_and_mass_along

if TYPE_CHECKING:  # else numba would be loaded for a measured record, too
    from stiction.analysis.motion.noiseless.features import Features

# The smallest reversal of the force that counts, as a share of its span in the last quarter of the
# time until the drive stops for good; afterwards friction holds the force. It is ten times the fast
# oscillation of the paper's system, and small enough to see swings die out. It is at least the
# solver's tolerance for the largest force.
REVERSAL = 1e-3

# With samples this dense, cubics find peaks to 4e-6 of the amplitude for a harmonic, and to 5e-7
# for the paper's system. The samples cost a fifth of the run's time.
PER_SLOW_PERIOD = 32
PER_COUPLED_PERIOD = 16  # of the mass moving only along the drive
# Of what varies drive or load: friction that turns with it has half its period
PER_IMPOSED_PERIOD = 2 * PER_SLOW_PERIOD
# Largest change of the force between two samples that their rates do not explain, as a share of the
# smallest drop. A harmonic of 10 samples a period has as much, and its peaks are 1e-3 off at most
UNEXPLAINED = 0.02
AT_ONCE = 8  # samples, in which a stiff system comes from its initial state into balance
# The same of samples that show cycles, though not how large they are to a per cent. A mass may slip
# between the last sample before and the first after: in so many intervals of each cycle, and in
# such a share of all. Between samples at random phases rates change their sign in every second
# interval, so that four of them seem to be a cycle: twice as many are one
FAR_OFF, AT_A_SLIP, FEW = 0.25, 2, 1 / 8
# A run sticks again and again if it does so by so many times in this part of it, its end; so many
# samples from stick to stick show the cycles, though their falls differ in size. So do fewer
# samples, if they show nearly each slip: if there are at most so many sticks for each cycle
FEWEST_STICKS, LATE, SHOWN_SAMPLES = 3, 0.25, 16.0
STICKS_SEEN = 1.25


def least_rate(slider: Slider) -> float:
    """Return the rate of even samples (1/s) that the known frequencies of a system need."""
    slow = slider.natural_frequencies[0]
    along = PER_COUPLED_PERIOD * coupled_frequency(slider)
    return max(PER_SLOW_PERIOD * slow, along, imposed_rate(slider))


def imposed_rate(slider: Slider) -> float:
    """Return the rate of even samples (1/s) that drive and load need."""
    return PER_IMPOSED_PERIOD * max(slider.modulation_frequencies, default=0.0)


def coupled_frequency(slider: Slider) -> float:
    """Return the frequency (Hz) of a mass that friction confines to the drive's direction."""
    stiffness, mass = stiffness_and_mass_along(slider, slider.direction)
    return sqrt(stiffness / mass) / (2.0 * pi)


def residual_changes(time: Floats, values: Floats, rates: Floats) -> Floats:
    """Return the changes between samples, (n - 1,), less the integrals of their rates."""
    return np.asarray(np.diff(values) - 0.5 * np.diff(time) * (rates[1:] + rates[:-1]))


def shows_motion(missed: Floats, drop: Floats, span: float, found: Features, rtol: float) -> bool:
    """Return whether each sample of a force follows from the one before.

    Samples farther apart than a period show a slower motion, which is not there; the force then
    changes by other amounts than its rates tell: `missed` (n - 1,) is by how much (N). The `drop`
    (N) is that of each cycle; without cycles the `span` of the force (N) counts.
    """
    late, least = missed[AT_ONCE:], least_drop(drop, span)
    if late.max(initial=0.0) > UNEXPLAINED * least:
        return False
    if len(drop):
        return True
    counts = max(REVERSAL * found.late_span, rtol * abs(least))
    return bool(late[3 * len(late) // 4 :].max(initial=0.0) <= counts)


def shows_cycles(time: Floats, missed: Floats, drop: Floats, span: float, sticks: Floats) -> bool:
    """Return whether samples show that there are cycles, though perhaps not how large they are.

    See `shows_motion`; the stick intervals are (k, 2), s.
    """
    if not len(drop):
        return False
    late, needed = missed[AT_ONCE:], rate_of_sticks(float(time[0]), float(time[-1]), sticks)
    at_once = int(np.count_nonzero(late > FAR_OFF * least_drop(drop, span)))
    if not at_once or not needed:
        most = min(AT_A_SLIP * (len(drop) + 1), FEW * len(late))
        return at_once <= most and len(drop) <= FEW * len(late)
    each = len(drop) <= len(sticks) + 1 and len(sticks) <= STICKS_SEEN * len(drop) + FEWEST_STICKS
    return each or needed * float(np.diff(time).max()) <= 1.0


def rate_of_sticks(begin: float, end: float, sticks: Floats) -> float:
    """Return the rate of samples (1/s) that many sticks, (k, 2), s, need at the end; else 0."""
    lasts = LATE * (end - begin)
    count = int(np.count_nonzero(sticks[:, 0] > end - lasts))
    return SHOWN_SAMPLES * count / lasts if count >= FEWEST_STICKS else 0.0


def least_drop(drop: Floats, span: float) -> float:
    """Return the smallest drop of a cycle, N; without cycles the span of the force."""
    return float(np.min(drop, initial=span))
