"""What a run shows of the friction test that its drive or its load makes."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.doubts.warnings import variations
from stiction.errors import ResultError
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis


def find(found: Analysis) -> Any:
    """Return the first analysis of a test that suits a run; None where nothing varies."""
    run = found.source
    if not isinstance(run, Trajectory) or not variations(run):
        return None
    from stiction.analysis.protocols.healing import healing
    from stiction.analysis.protocols.hysteresis import hysteresis
    from stiction.analysis.protocols.load_dependence import load_dependence
    from stiction.analysis.protocols.velocity_steps import velocity_steps

    for analysis in (velocity_steps, healing, hysteresis, load_dependence):
        with suppress(ResultError):
            return analysis(run)
    return None


def section(found: Analysis) -> Section | None:
    """Return its section."""
    its = found.parts["procedure"]
    return None if its is None else its.section
