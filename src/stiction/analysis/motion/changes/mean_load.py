"""The force of a record under the mean of its normal load, where the force follows the load."""

from __future__ import annotations

from typing import NamedTuple

from stiction.analysis.motion.changes.sliding import sliding
from stiction.analysis.record import Record
from stiction.analysis.signals.robust import inner_product, uniform_mean
from stiction.arrays import Floats
from stiction.recording.noise import ORDER, white_noise

LEFT = 0.25  # of the standard deviation of a force: a load that the force follows leaves less
# Slope of the force over the load, over the ratio of their means: 1 by Amontons' law. A zero or
# adhesion changes it; a load cell that friction tilts has a slope of several times as much.
SLOPES = (0.5, 2.0)


class FollowedLoad(NamedTuple):
    """A load that the force follows."""

    slope: float  # of the force over the load
    share: Floats  # (n,), N: the part of the force that makes it differ from that under the mean

    def taken_from(self, record: Record) -> Record:
        """Return the record as under the mean of its load."""
        steady = record.with_force(record.force - self.share)
        return steady.model_copy(update={"load": None})


def followed_load(record: Record) -> FollowedLoad | None:
    """Return the load that the force follows while the mass slides, if it does.

    The slope is that of least squares, of means as long as the noise of the load requires. Where it
    explains all but a sixteenth of the force's variance, the load makes the swings of the force.
    """
    if record.load is None or record.slip_speed is not None or not record.load_variation() > 0.0:
        return None
    slides = sliding(record)
    part = slice(slides.first, slides.last)
    width = record.averaged_over
    force, load = (uniform_mean(each, width)[part] for each in (record.force, record.load))
    if len(force) <= ORDER or not load.min() > 0.0:
        return None
    by_load, by_all = load - load.mean(), force - force.mean()
    slope = inner_product(by_load, by_all) / inner_product(by_load, by_load)
    left = by_all - slope * by_load
    noise = white_noise(force) ** 2
    explains = left.var() - noise < LEFT**2 * (by_all.var() - noise)
    least, largest = SLOPES
    if not explains or not least < slope * load.mean() / force.mean() < largest:
        return None
    share = slope * (record.load - record.load.mean())
    # a spring that is loaded or unloaded does not feel the load: it keeps its straight line there
    for outside, at in ((slice(slides.first), 0), (slice(slides.last, None), -1)):
        share[outside] = record.force[outside] * share[part][at] / force[at]
    return FollowedLoad(slope, share)


def under_mean_load(record: Record) -> Record:
    """Return a record as under the mean of its load, where the force follows the load.

    Swings of the load make none of the force then. Any other record is returned as it is.
    """
    load = followed_load(record)
    return record if load is None else load.taken_from(record)
