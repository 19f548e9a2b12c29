"""Load dependence: friction over normal load in a load ramp with levels."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan

import numpy as np

from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.protocols.friction_test import (
    ConstantStretch,
    FrictionTest,
    alike,
    of_record,
    of_run,
    without_harmonics,
)
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import statistics
from stiction.analysis.signals.straight_line import line_of_few
from stiction.arrays import Floats, ShortRepr
from stiction.drive import ConstantVelocity, LoadProgram, load_stretches
from stiction.errors import ResultError
from stiction.text.lists import say_left_out
from stiction.text.quantity.wording import in_words, with_error
from stiction.text.sections import Section, SectionReport, Table
from stiction.trajectory import Trajectory


@dataclass(frozen=True, repr=False)
class LoadDependence(SectionReport, ShortRepr):
    """Friction at each level of the normal load, and the line through it.

    Attributes
    ----------
    load, force : ndarray
        (n,), level of the load, N, and mean force along the load cell in its last fifth, N.
    coefficient, error : float
        Slope of the line, and its standard error by scatter and by the errors of forces; NaN with
        fewer than three levels.
    adhesion, adhesion_error : float
        Force at zero load, N, and its standard error: of Amontons' law it is zero.
    left_out : tuple of str
        Which levels are left out, and why, in sentences.
    """

    _figure = "plot_load_dependence"

    load: Floats
    force: Floats
    coefficient: float
    error: float
    adhesion: float
    left_out: tuple[str, ...] = ()
    adhesion_error: float = nan

    @property
    def section(self) -> Section:
        """The line in words, and the levels as a table."""
        said = (
            f"Friction rises by {with_error(self.coefficient, self.error, '')} of the load, from "
            f"{with_error(self.adhesion, self.adhesion_error, 'N')} at zero load."
        )
        rows = [
            (in_words(W, "N"), in_words(F, "N"), f"{F / W:.4f}")
            for W, F in zip(self.load, self.force, strict=True)
        ]
        return Section(
            "Load dependence", [said, *self.left_out], Table(("load", "friction", "ratio"), rows)
        )


def load_dependence(
    source: Trajectory | Record, program: LoadProgram | None = None
) -> LoadDependence:
    """Return friction over normal load in a test that holds several levels of the load.

    Under Amontons' law, F = mu W, the line has the slope mu and passes through zero; adhesion
    raises it.

    Only levels in whose last fifth the mass slides, and the force has settled, count: a spring that
    is still loaded shows less than friction. All are of one speed of the drive.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load at t = 0.
    program : LoadProgram, optional
        The program of a record, see `st.protocols.load_ramp`; that of a run is known.

    Raises
    ------
    ResultError
        If fewer than two levels are held while the mass slides.

    Examples
    --------
    >>> import stiction as st
    >>> load = st.protocols.load_ramp(["20 N", "30 N"], ramp="2 s", hold="5 s")
    >>> slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2), load=load)
    >>> found = st.analysis.load_dependence(st.simulate(slider, sample_rate="100 Hz"))
    >>> round(found.coefficient, 4)
    0.2
    """
    test = _test(source, program)
    held = [each for each in test.stretches if test.is_sampled(each)]
    faults = [(each, _fault(test, each)) for each in held]
    good = [each for each, why in faults if not why]
    left_out = say_left_out((in_words(each.load, "N"), why) for each, why in faults if why)
    other = [each for each in good if not alike(abs(each.velocity), abs(good[0].velocity))]
    if other:
        left_out += say_left_out(
            (in_words(each.load, "N"), "The drive has another speed") for each in other
        )
        good = [each for each in good if each not in other]
    rows = [(each.load, *_friction(test, each)) for each in good]
    if all(alike(each.load, good[0].load) for each in good):
        few = "fewer than two levels of the load are held while the mass slides"
        raise ResultError(" ".join([f"{few}; see st.protocols.load_ramp, with hold.", *left_out]))
    loads, forces, errors = np.array(rows).T
    found = line_of_few(loads, forces, errors)
    return LoadDependence(
        loads, forces, found.slope, found.slope_error, found.offset, left_out, found.offset_error
    )


def _friction(test: FrictionTest, level: ConstantStretch) -> tuple[float, float]:
    """Return mean friction in the end of a level, N, and its standard error."""
    mean, error, _ = statistics(test.force[test.late(level)])
    return abs(mean), error


def _test(source: Trajectory | Record, program: LoadProgram | None) -> FrictionTest:
    """Return the test with all stretches in which the load is held."""
    if isinstance(source, Trajectory):
        return of_run(source, without_harmonics(source.slider.motion))
    source = as_record(source)
    if source.normal_load is None:
        raise ResultError("the load is unknown; give the record its normal_load")
    # a drive whose speed is unknown is quicker than any loading that is seen
    drive = ConstantVelocity._make((source.drive_velocity or inf,))
    return of_record(source, drive, load_stretches(source.normal_load, program))


def _fault(test: FrictionTest, level: ConstantStretch) -> str:
    """Return why the force at a level is not friction; empty if it is."""
    if not level.velocity:
        return "The drive rests"
    if not test.slides(level):
        return "The mass does not slide, or not yet"
    if not test.has_settled(level):
        return "The force has not settled"
    return ""
