"""A record of a rig compared with simulations of the rig."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from stiction.analysis.record import Record
from stiction.errors import DescriptionError, ResultError
from stiction.inference.features import USED
from stiction.inference.fit import check, fit
from stiction.inference.library import SIMULATIONS
from stiction.inference.mechanism.comparison import SHARE, mechanism
from stiction.inference.mechanism.odds import Odds
from stiction.inference.observation import Observation, observe
from stiction.inference.posterior import RARE, Fit
from stiction.inference.predictive import Predictive, predict
from stiction.inference.priors import Rig


@dataclass(frozen=True)
class RecordComparison:
    """A record beside simulations of its rig.

    Parameters
    ----------
    record : Record
        As measured.
    seen : Observation or None
        What a fit takes from it; None where it cannot be fitted.
    fit : Fit or None
        Posterior beside prior.
    predictive : Predictive or None
        Simulations with parameters of the posterior; None if hardly any has cycles.
    reason : str
        Why there is no fit.
    odds : Odds or None
        Of mechanisms.
    incomparable : str
        Why there are no odds.
    """

    record: Record
    seen: Observation | None = None
    fit: Fit | None = None
    predictive: Predictive | None = None
    reason: str = ""
    odds: Odds | None = None
    incomparable: str = ""

    @property
    def like(self) -> bool:
        """Whether the record looks like the simulations by features, loading curve and priors."""
        if self.fit is None or self.predictive is None:
            return False
        usual = self.fit.farther >= RARE and self.predictive.larger >= RARE
        return usual and not self.fit.beyond

    @property
    def absent(self) -> list[str]:
        """The channels that a fit would use and the record does not have."""
        return [name for name in USED if getattr(self.record, name) is None]


def compare(
    record: Record,
    rig: Rig,
    *,
    simulations: int = SIMULATIONS,
    library: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
) -> RecordComparison:
    """Fit a rig to a record and simulate the record again with what was found.

    Raises
    ------
    DescriptionError
        If nothing of the rig is uncertain, or it is not of a kind that can be fitted.
    """
    check(rig)
    report = progress or (lambda fraction: None)
    try:
        seen = observe(record, rig.slider)
        found = fit(
            record, rig, simulations=simulations, library=library,
            progress=lambda fraction: report(0.5 * fraction),
        )  # fmt: skip
    except ResultError as error:
        return RecordComparison(record, reason=str(error))
    made = predict(found, seen, lambda fraction: report(0.5 + 0.05 * fraction))
    odds, why = None, ""
    try:
        odds = mechanism(
            record, rig, simulations=simulations // SHARE, library=library,
            progress=lambda fraction: report(0.55 + 0.45 * fraction),
        )  # fmt: skip
    except (ResultError, DescriptionError) as error:
        why = str(error)
    return RecordComparison(record, seen, found, made, odds=odds, incomparable=why)
