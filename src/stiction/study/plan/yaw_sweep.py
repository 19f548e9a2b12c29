"""A yaw sweep: one friction test at many misalignments."""

from __future__ import annotations

from collections.abc import Sequence

from stiction.study.plan.axes import Values
from stiction.study.plan.study import Study
from stiction.system.description import Description

MEASURES = ("regime", "mean_force", "peak_force", "amplitude")


def yaw_sweep(base: Description, angles: Sequence[str]) -> Study:
    """Return the study of a test at several misalignments, for `st.analysis.apparent_friction`.

    Parameters
    ----------
    base : Description
        The test; long enough for the last quarter to be periodic or steady.
    angles : sequence of str
        Misalignments phi, with their unit.

    Examples
    --------
    >>> import stiction as st
    >>> base = st.presets.yaw_angle_brake()
    >>> study = st.protocols.yaw_sweep(base, [f"{phi} deg" for phi in range(0, 31, 5)])
    >>> study.layout.runs
    7
    """
    return Study(base=base, axes={"phi": Values(list(angles))}, measures=MEASURES)
