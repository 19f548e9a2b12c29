"""Load dependence: friction over normal load in a load ramp with levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stiction.analysis.protocols.friction_test import SETTLED
from stiction.analysis.protocols.healing import line
from stiction.analysis.record import Record, as_record
from stiction.arrays import Floats
from stiction.drive import ConstantLoad, LoadProgram, load_stretches
from stiction.errors import ResultError
from stiction.text.sections import Section, Table
from stiction.text.units import in_words
from stiction.trajectory import Trajectory


@dataclass(frozen=True)
class LoadDependence:
    """Friction at each level of the normal load, and the line through it.

    Attributes
    ----------
    load, force : ndarray
        (n,), level of the load, N, and mean force along the drive in its last fifth, N.
    coefficient, error : float
        Slope of the line, and its standard error; NaN where it is unknown.
    adhesion : float
        Force at zero load, N: of Amontons' law it is zero.
    """

    load: Floats
    force: Floats
    coefficient: float
    error: float
    adhesion: float

    @property
    def section(self) -> Section:
        """The line in words, and the levels as a table."""
        error = f" +- {self.error:.1g}" if self.error > 0.0 else ""
        said = (
            f"Friction rises by {self.coefficient:.4g}{error} of the load, from "
            f"{in_words(self.adhesion, 'N')} at zero load."
        )
        rows = [
            (in_words(W, "N"), in_words(F, "N"), f"{F / W:.4f}")
            for W, F in zip(self.load, self.force, strict=True)
        ]
        return Section("Load dependence", [said], Table(("load", "friction", "ratio"), rows))

    def __str__(self) -> str:
        """Return the section as text."""
        return str(self.section)


def load_dependence(
    source: Trajectory | Record, program: LoadProgram | None = None
) -> LoadDependence:
    """Return friction over normal load in a test that holds several levels of the load.

    Under Amontons' law, F = mu W, the line has the slope mu and passes through zero; adhesion
    raises it.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load at t = 0.
    program : LoadProgram, optional
        The program of a record, see `st.protocols.load_ramp`; that of a run is known.

    Raises
    ------
    ResultError
        If fewer than two levels are held.

    Examples
    --------
    >>> import stiction as st
    >>> load = st.protocols.load_ramp(["20 N", "30 N"], ramp="2 s", hold="5 s")
    >>> slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2), load=load)
    >>> found = st.analysis.load_dependence(st.simulate(slider, sample_rate="100 Hz"))
    >>> round(found.coefficient, 4)
    0.2
    """
    if isinstance(source, Trajectory):
        d, slider = source.samples, source.slider
        time, force = d["time"], slider.along_drive(d["spring_x"], d["spring_y"])
        base, program = slider.normal_load, slider.load
    elif as_record(source).normal_load is None:
        raise ResultError("the load is unknown; give the record its normal_load")
    else:
        time, force, base = source.time, source.force, source.normal_load
    rows, start = [], 0.0
    for end, load in load_stretches(base, program):
        until = min(end, float(time[-1]))
        if isinstance(load, ConstantLoad) and until > start:
            near = (time >= until - SETTLED * (until - start) - 1e-9) & (time <= until + 1e-9)
            if near.any():
                rows.append((load.force, float(np.abs(force[near].mean()))))
        start = end
    levels = {level for level, _ in rows}
    if len(levels) < 2:
        raise ResultError(
            "fewer than two levels of the load are held; see st.protocols.load_ramp, with hold"
        )
    loads, forces = np.array(rows).T
    return LoadDependence(loads, forces, *line(loads, forces))
