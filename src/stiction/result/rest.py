"""A run in which the mass never slips, and changes that would make it slip."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.text.quantity.wording import in_words

if TYPE_CHECKING:
    from stiction.result.table import ColumnTable
    from stiction.system.slider import Slider

REST = 1e-9  # of the drive velocity: slower slip counts as rest


def rest_in_words(slider: Slider, samples: ColumnTable, steps: int) -> str:
    """Return that a run never slipped, and the remedy; nothing where it slipped.

    A law with internal state does not allow true rest: there the samples tell, in which the first
    has the slip of the start. Between them, too, the mass must not have moved.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 ms")
    >>> rest_in_words(run.slider, run.samples, run.statistics.steps).split(";")[0]
    'it never slipped: friction held all the time'
    """
    time, X, slip = (samples[name][1:] for name in ("time", "X", "slip_speed"))
    V = slider.drive_speed
    if steps and not (len(time) and (slip < REST * V).all() and np.ptp(X) <= REST * V * time[-1]):
        return ""
    still = not any(samples[name].any() for name in ("drive_X", "drive_Y"))
    remedy = "the drive is at rest; give it a velocity" if still else longer(slider)
    return f"it never slipped: friction held all the time; {remedy}"


def longer(slider: Slider) -> str:
    """Return the remedy for a run that is too short for slip."""
    if not slider.drive_speed > 0.0:
        return "run it longer"
    most, load = in_words(slider.F_0, "N"), in_words(slider.loading_time, "s", 2)
    return (
        f"it takes about {load} to load a spring to the {most} that friction can hold; "
        "set a longer duration"
    )
