"""Apparent friction over the yaw angle, as a load cell on the soft spring reads it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stiction.analysis.protocols.friction_test import constant_stretches
from stiction.arrays import Floats, ShortRepr, xr
from stiction.drive import drive_stretches, load_stretches
from stiction.errors import ResultError
from stiction.linear_stability import steady_sliding
from stiction.system.description import Description
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider, slider_of
from stiction.text.sections import Section, SectionReport, Table


@dataclass(frozen=True, repr=False)
class ApparentFriction(SectionReport, ShortRepr):
    """Forces of a yaw sweep over the normal load.

    Attributes
    ----------
    phi : ndarray
        (n,), misalignment, rad.
    mean, peak : ndarray
        (n,), mean in the last quarter and largest value of the force on the soft spring over the
        normal load.
    amplitude : ndarray
        (n,), half the span of that force in the last quarter, over the normal load.
    steady : ndarray
        (n,), what steady sliding gives: mu(V) cos(phi), without axes of the springs, or a grain.
    along : ndarray
        (n,), friction along the drive in steady sliding, over the normal load: mu(V).
    """

    _figure = "plot_apparent_friction"

    phi: Floats
    mean: Floats
    peak: Floats
    amplitude: Floats
    steady: Floats
    along: Floats

    @property
    def corrected(self) -> Floats:
        """Mean friction along the drive where sliding is steady, `mean` over cos(phi), (n,)."""
        return self.mean * self.along / self.steady

    @property
    def section(self) -> Section:
        """The sweep in words and as a table."""
        calm = np.flatnonzero(self.amplitude <= 1e-3 * self.mean)
        said = "It vibrates at every angle."
        if len(calm):
            said = f"Sliding is steady at {_degrees(self.phi[calm[0]])} first."
        rows = [
            (_degrees(phi), *(f"{value:.4f}" for value in values))
            for phi, *values in zip(
                self.phi, self.mean, self.peak, self.amplitude, self.steady, strict=True
            )
        ]
        headings = ("phi", "mean", "peak", "amplitude", "steady sliding")
        return Section("Apparent friction over the yaw angle", [said], Table(headings, rows))


def _degrees(phi: float) -> str:
    return f"{np.degrees(phi):.3g} deg"


def _load_and_speed(slider: Slider) -> tuple[float, float]:
    """Return normal load (N) and speed (m/s) of a test in which both are constant."""
    loads = load_stretches(slider.normal_load, slider.load)
    found = constant_stretches(drive_stretches(slider.motion), loads, np.array([0.0, np.inf]))
    if [each[:2] for each in found] != [(0.0, np.inf)]:
        raise ResultError(
            "the velocity of the drive, or the load, varies, and one force over one load is not "
            "friction then; give a constant velocity, and no load program"
        )
    return found[0].load, abs(found[0].velocity)


def steady_forces(slider: Slider, phi: float) -> tuple[float, float]:
    """Return the force on the soft spring in steady sliding, and friction along the drive, N."""
    turned = change_unchecked(slider, "phi", phi)
    x, y = np.array([turned.k_x, turned.k_y]) * steady_sliding(turned).state[:2]
    way = float(np.sign(turned.motion.rate(0.0)[0]))
    return way * float(x), way * float(turned.along_drive(x, y))


def apparent_friction(
    study: xr.Dataset, slider: Slider | Description | str | Path
) -> ApparentFriction:
    """Return the friction that a load cell on the soft spring reads, over the misalignment.

    In steady sliding friction mu(V) W acts along the drive, of which the soft spring carries
    cos(phi), or what axes of the springs' own, and a grain, make of it; stick-slip makes its mean
    lower.

    Parameters
    ----------
    study : Dataset
        Of `st.protocols.yaw_sweep`, from `st.open_study`.
    slider : Slider, Description, str or Path
        The apparatus that was swept, or the file of its description: it has the normal load, the
        law and the drive velocity.

    Raises
    ------
    ResultError
        If the study is not one over phi alone, or lacks a measure; if velocity or load vary.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "6 s")
    >>> done = st.sweep(st.protocols.yaw_sweep(base, ["1 deg", "12 deg"]), "angles.zarr")
    >>> found = st.analysis.apparent_friction(st.open_study("angles.zarr"), base.slider)
    >>> found.peak.round(3).tolist()
    [0.199, 0.191]
    """
    wanted = ("mean_force", "peak_force", "amplitude")
    if set(study.dims) != {"phi"} or not {*wanted} <= {str(name) for name in study.data_vars}:
        raise ResultError(
            "the data are not a study over phi alone with its forces; see st.protocols.yaw_sweep"
        )
    slider = slider_of(slider)
    W, _ = _load_and_speed(slider)
    phi = study["phi"].values * (np.pi / 180.0 if study["phi"].attrs["units"] == "deg" else 1.0)
    mean, peak, amplitude = (study[name].values.astype(np.float64) / W for name in wanted)
    steady, along = np.array([steady_forces(slider, float(each)) for each in phi]).T / W
    return ApparentFriction(phi, mean, peak, amplitude, steady, along)
