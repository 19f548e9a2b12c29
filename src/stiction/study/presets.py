"""Studies to run by name: ``stiction sweep --preset yaw-angle``.

All start from the system of Fig. 3 of Nakano & Popov (2020), see
`stiction.presets.nakano_popov_2020`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi

import numpy as np

from stiction.arrays import Floats
from stiction.errors import DescriptionError, echo
from stiction.presets import nakano_popov_2020
from stiction.storage.kinds import use_of_name
from stiction.study.plan.axes import Axis, Grid, Values
from stiction.study.plan.study import Study
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.text.validation import unknown_name
from stiction.theory import natural_frequency

TRAVEL = 4.0  # least travel of the drive, in slip lengths: load-up, then some cycles
PERIODS = 40.0  # least duration, in slow periods, in which motion grows or dies out
MEASURES = ("regime", "mean_force", "peak_force", "amplitude")


def yaw_angle() -> Study:
    """Return the plane phi x V: misalignment stabilises up to a drive velocity that depends on it.

    phi is the yaw angle of Kado, Tadokoro & Nakano, cited as [22] and [23] by Nakano & Popov.
    """
    slider, V = nakano_popov_2020(), np.geomspace(1e-4, 1e-1, 31)
    return study(
        slider,
        {
            "phi": Grid("0.25 deg", "15 deg", 60),
            "drive.velocity": Grid("0.1 mm/s", "100 mm/s", len(V), "log"),
            "run.duration": Values(durations(slider, V), "drive.velocity"),
        },
    )


def anisotropy() -> Study:
    """Return k_y x phi with k_x = 1 kN/m: springs from isotropic to rigid along y."""
    slider = nakano_popov_2020()
    return study(
        slider,
        {
            "k_y": Grid("1 kN/m", "10 MN/m", 33, "log"),
            "phi": Grid("0.5 deg", "20 deg", 40),
            "run.duration": Values(durations(slider, np.full(33, 1e-3)), "k_y"),
        },
    )


def damping_diagram() -> Study:
    """Return A x theta, the plane of Fig. 5, in which theta finally falls to phi.

    A depends on both V and phi, which therefore vary together along one dimension.
    """
    slider = nakano_popov_2020()
    A, phi = (each.ravel() for each in np.meshgrid(np.geomspace(1, 1e4, 25), PHI))
    V = slider.F_0 / (2.0 * A * np.sin(np.radians(phi)) * np.sqrt(slider.mass * slider.k_x))
    return study(
        slider,
        {
            "phi": Values([f"{each!r} deg" for each in phi.tolist()], "sample"),
            "drive.velocity": Values(V, "sample"),
            "run.duration": Values(durations(slider, V), "sample"),
        },
    )


PHI = np.geomspace(0.5, 45.0, 25)  # deg
PRESETS: dict[str, Callable[[], Study]] = {
    "yaw-angle": yaw_angle,
    "anisotropy": anisotropy,
    "damping-diagram": damping_diagram,
}


def preset(name: str) -> Study:
    """Return a study by its name.

    Raises
    ------
    DescriptionError
        If there is no study of this name.
    """
    if name not in PRESETS:
        use = use_of_name(name)  # of a single system
        message = f"{echo(name)}: {use}" if use else unknown_name("preset", name, PRESETS)
        raise DescriptionError.of("preset", message)
    return PRESETS[name]()


def study(slider: Slider, axes: dict[str, Axis]) -> Study:
    """Return a study with the measures of the maps; an axis sets the durations."""
    base = Description(slider, Initial(), Settings(duration="5 s"))
    return Study(base=base, axes=axes)


def durations(slider: Slider, V: Floats) -> Floats:
    """Return, for each drive velocity (m/s), a duration (s) that shows the motion."""
    slow = 2.0 * pi / natural_frequency(slider.k_x, slider.mass)
    return TRAVEL * slider.F_0 / slider.k_x / V + PERIODS * slow


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
