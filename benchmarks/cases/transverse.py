"""Active control of friction: a rigid slider shaken across its way, at other speeds."""

from __future__ import annotations

from functools import partial
from math import pi

from scipy.special import ellipk

import stiction as st
from benchmarks.cases.case import Case
from stiction.presets import Number
from stiction.presets.vibration import mean_friction, shaken_slider


def mean(r: float, wanted: float, rtol: float) -> list[Number]:
    """Mean friction along X over mu_0 W is (2/pi) K(-r^2), for a slider that follows the drive."""
    description = shaken_slider(r)
    settings = description.run.model_dump(exclude_none=True) | {"rtol": rtol}
    found = mean_friction(st.run(description._replace(run=st.Settings(**settings))))
    return [
        Number("elliptic integral", "mean friction/mu_0 W, as printed", wanted, found, 5e-6),
        Number("elliptic integral", "  rigid limit", 2 / pi * float(ellipk(-r * r)), found, 5e-6),
    ]


CASES = tuple(
    Case(f"transverse oscillation, r = {r:g}", partial(mean, r, wanted), 1e-8)
    for r, wanted in ((1.0, 0.83463), (10.0, 0.23442))
)
