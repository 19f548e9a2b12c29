"""What a run, or a record, shows of the friction test that its drive or its load makes."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.doubts.warnings import variations
from stiction.analysis.motion.regime.kinds import STICK_SLIP
from stiction.analysis.record import Record
from stiction.errors import ResultError
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis
    from stiction.system.slider import Slider

TWO_AXES = (
    "Here coefficients are of the force along the drive, elsewhere in this report of k_x u_x. "
    "State cell_angle to have them along one axis."
)


def find(found: Analysis) -> Any:
    """Return the first analysis of a test that suits a run, or a record of the drive as well.

    None where nothing varies. In a record of stick-slip no change of the drive's speed shows steady
    friction; and the strokes of a drive that goes back and forth are analysed one by one.
    """
    source = found.source
    if isinstance(source, Trajectory):
        its = ("velocity_steps", "healing", "hysteresis", "load_dependence")
        return _first(source, its) if variations(source) else None
    measured = source.drive_position is not None and source.normal_load is not None
    if not measured or found.regime.kind == STICK_SLIP:
        return None
    from stiction.analysis.protocols.friction_test import friction_test

    with suppress(ResultError):
        if len(friction_test(source).stretches) > 1:
            return _first(source, ("velocity_steps", "healing"))
    return None


def _first(source: Trajectory | Record, names: tuple[str, ...]) -> Any:
    """Return the first of some analyses that finds its test; None if there is none of them."""
    import stiction.analysis as of

    for name in names:
        with suppress(ResultError):
            return getattr(of, name)(source)
    return None


def section(found: Analysis) -> Section | None:
    """Return its section."""
    its, source = found.parts["procedure"], found.source
    if its is None:
        return None
    shown: Section = its.section
    if isinstance(source, Trajectory) and _reads_along_two_axes(source.slider):
        shown = shown._replace(sentences=[*shown.sentences, TWO_AXES])
    return shown


def _reads_along_two_axes(slider: Slider) -> bool:
    return slider.cell_angle is None and slider.misalignment != 0.0
