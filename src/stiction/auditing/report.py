"""The audit of an apparatus: prediction, simulation and advice."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.record import Record
from stiction.arguments import end_reading, read_together
from stiction.arrays import same_fields
from stiction.auditing import chain
from stiction.auditing.advice import LEVERS, Remedy, advise
from stiction.auditing.oscillation import TransverseSwings, oscillation_of
from stiction.auditing.pairs import Pair, advise_pairs
from stiction.auditing.prediction import Prediction, predict
from stiction.auditing.simulated_test import (
    LEAST_WORK,
    MOST_WORK,
    OSCILLATES,
    SHARE,
    SLIDES,
    SimulatedTest,
    coarse_rate,
    from_sliding,
    simulate_test,
)
from stiction.auditing.words.chain import chain_sections
from stiction.auditing.words.changes import changes
from stiction.auditing.words.data import data
from stiction.auditing.words.load_cell import TITLE as LOAD_CELL
from stiction.auditing.words.load_cell import load_cell
from stiction.auditing.words.numbers import numbers, violated_assumptions
from stiction.auditing.words.stick import stick
from stiction.auditing.words.transverse import transverse
from stiction.auditing.words.verdict import AS_DESCRIBED, VERDICT, verdict
from stiction.friction import has_state
from stiction.inference.rig import Rig, load_of_records, refuse_swapped, rig_of
from stiction.inference.simulated import SIMULATIONS
from stiction.linear_stability import Critical, Linearisation, critical, steady_sliding
from stiction.linear_stability.axis import steadily_driven
from stiction.names import old_attributes, warn_renamed
from stiction.progress.audience import with_progress
from stiction.progress.report import Progress, part, silent
from stiction.system.description import Description
from stiction.system.slider import Slider
from stiction.text.sections import Report, Section

if TYPE_CHECKING:  # a fit takes 0.3 s to import
    from stiction.auditing.measured import RecordComparison
    from stiction.auditing.tolerance import Budget
    from stiction.inference.priors import Prior

# parts of the work: two tests, springs replaced, the advices, and pairs of them
PARTS_OF_WORK = 4 + len(LEVERS)
FITTING = 0.8  # of the time of an audit with a measured record
MORE = 12  # such parts of a tolerance budget


@dataclass(frozen=True, eq=False, repr=False)
class Audit(Report):
    """The audit of an apparatus before its friction tests are trusted.

    Parameters
    ----------
    slider : Slider
        The apparatus.
    prediction : Prediction
        The theoretical prediction from the description alone.
    sliding : Linearisation
        Steady sliding and its modes.
    misalignment : Critical
        Misalignments at which steady sliding changes between unstable and stable.
    observation : SimulatedTest
        The simulated test, from rest.
    sliding_on : SimulatedTest
        The simulated test, from steady sliding with a small disturbance.
    advices : tuple of Remedy
        Changes that would make it slide steadily, each tried from rest; empty if it does.
    chain : Chain or None
        The springs in series, and each replaced; None for a single spring.
    budget : Budget or None
        The tolerance budget; None where no parameter is uncertain.
    measured : RecordComparison or None
        A measured record beside simulations of the apparatus; None where none was given.
    priors : mapping
        Of the uncertain parameters, which `slider` has in their middle.
    pairs : tuple of Pair
        Changes of two parameters, where no misalignment alone makes it slide steadily.
    aligned : SimulatedTest or None
        The simulated test, from rest, without misalignment; only where friction has an internal
        state, which creeps by itself.

    Examples
    --------
    >>> import stiction as st
    >>> found = st.audit(st.presets.nakano_popov_2020())
    >>> found.ok, len(found.advices)
    (True, 4)
    """

    slider: Slider
    prediction: Prediction
    sliding: Linearisation
    misalignment: Critical
    observation: SimulatedTest
    sliding_on: SimulatedTest
    advices: tuple[Remedy, ...]
    chain: chain.Chain | None = None
    budget: Budget | None = None
    measured: RecordComparison | None = None
    priors: Mapping[str, Prior] = field(default_factory=dict)
    pairs: tuple[Pair, ...] = ()
    aligned: SimulatedTest | None = None

    def __eq__(self, other: object) -> bool:
        """Compare predictions and simulations; NaN equals NaN."""
        return same_fields(self, other)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        both = ", bistable" if self.bistable else ""
        return f"<Audit: {self.observation.motion}{both}; steady sliding is {self.sliding.verdict}>"

    @property
    def bistable(self) -> bool:
        """Whether the mass oscillates from rest, but continues to slide once it slides."""
        rest, sliding = self.observation.comes_to, self.sliding_on.comes_to
        return rest == OSCILLATES and sliding == SLIDES and self.sliding.stable

    @cached_property
    def oscillation(self) -> TransverseSwings:
        """The transverse oscillation of the test from rest, simulated again with fine samples."""
        return oscillation_of(self.observation)

    @property
    def remedies(self) -> list[Remedy | Pair]:
        """All changes of one and of two parameters, working ones first, the mildest first.

        A milder change has a smaller factor, see `stiction.auditing.advice.change_factor`.
        """
        every: list[Remedy | Pair] = [*self.advices, *self.pairs]
        return sorted(every, key=lambda each: (not each.works, each.factor))

    @property
    def ok(self) -> bool:
        """Whether every simulation reached its end."""
        tried = (each.tried for each in self.remedies if each.tried)
        replaced = self.chain.replacements if self.chain else ()
        stiffer = (each.tried for each in replaced if each.tried)
        runs = [self.observation, self.sliding_on, *tried, *stiffer]
        return all(each.run.status.ok for each in runs)

    def to_toml(self) -> str:
        """Return the description of the apparatus, with its uncertain values."""
        return Rig(self.slider, dict(self.priors)).to_toml()

    @np.errstate(under="ignore")  # as by public functions: its words analyse parts of runs
    def tables(self) -> list[Section]:
        """Return the report as sections of sentences and tables."""
        parts = [*_of_record(self.measured), *sections(self), *chain_sections(self)]
        if self.budget:
            from stiction.auditing.tolerance import section

            parts.append(section(self.budget))
        return parts

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers with their units, as ``stiction audit --json`` writes them."""
        return data(self)

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw the simulated test as a load cell records it; see `stiction.plotting`."""
        from stiction.plotting.analysis.cycles import plot_motion

        seen = self.observation
        return plot_motion(seen.record, seen.cycles, seen.motion, axes)

    def write_html(self, path: str | Path, name: str = "apparatus") -> Path:
        """Write the report as a self-contained page with figures; return the path.

        Raises
        ------
        ResultError
            If the file cannot be written.
        """
        from stiction.auditing.page import write

        return write(self, path, name)


@read_together
@with_progress("auditing")
def audit(
    slider: Slider | Description | Rig | str | Path,
    record: Record | str | Path | None = None,
    *,
    simulations: int = SIMULATIONS,
    library: str | Path | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Audit:
    """Audit an apparatus: will it measure friction, or itself?

    Parameters
    ----------
    slider : Slider, Description, Rig, str or Path
        The apparatus, or the file of its description, with a steady drive and load. The initial
        state and settings of a description are ignored. Where a parameter is uncertain, as in
        ``phi = "2 +- 1 deg"``, the audit ends with a tolerance budget.
    record : Record, str or Path, optional
        A measured record of the apparatus, whose description states what is uncertain: the audit
        begins with what it says, by a fit (`stiction.fit`) and simulations with its parameters.
    simulations, library, seed
        As of `stiction.fit`.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Audit
        Theoretical prediction, simulated test and advice; with ``tables()``, ``plot()`` and
        ``write_html(path)``.

    Raises
    ------
    DescriptionError
        If drive or load is not steady.
    StictionError
        If friction reaches no steady sliding.

    Examples
    --------
    >>> import stiction as st
    >>> st.audit(st.presets.nakano_popov_2020().replace(phi="9.5 deg"))
    <Audit: settling; steady sliding is stable>
    """
    if callable(record):  # the second argument of 0.4.0
        warn_renamed("st.audit(slider, progress)", "st.audit(slider, progress=progress)")
        record, progress = None, record
    refuse_swapped(slider, record, "the rig comes first: st.audit(rig, record=record)")
    rig = rig_of(slider)
    inform = progress or silent
    before = FITTING if record is not None else 0.0
    measured = None
    if record is not None:
        from stiction.auditing.measured import explain_record
        from stiction.inference.observation import record_from

        seen = record_from(record, load_of_records(rig))
        end_reading()
        measured = explain_record(
            seen, rig, simulations=simulations, library=library, seed=seed,
            progress=lambda fraction: inform(before * fraction),
        )  # fmt: skip
    end_reading()
    return _examine(rig, measured, lambda fraction: inform(before + (1.0 - before) * fraction))


def _examine(rig: Rig, measured: RecordComparison | None, progress: Progress) -> Audit:
    """Return the audit of a rig, given the comparison with its record."""
    system = steadily_driven(rig.slider)
    report = partial(part, progress, count=PARTS_OF_WORK + (MORE if rig.priors else 0))
    sliding, prediction = steady_sliding(system), predict(system)
    growth = sliding.growth_rate
    rate = max(prediction.sample_rate, coarse_rate(prediction))
    observation = simulate_test(system, prediction, growth, sample_rate=rate, progress=report(0))
    sliding_on = from_sliding(sliding, prediction, report(1))
    work = MOST_WORK - observation.work - sliding_on.work
    aligned = None
    if has_state(system.law) and system.misalignment != 0.0:
        straight = system.replace(phi=f"{system.turn!r} rad")
        at_zero, its = predict(straight), steady_sliding(straight).growth_rate
        most = max(min(work // 2, int(SHARE * MOST_WORK)), LEAST_WORK)
        aligned = simulate_test(straight, at_zero, its, sample_rate=rate, most_steps=most)
        work -= aligned.work
    springs = None
    if system.springs:
        springs = chain.examine(system, work // 2, report(2))
        work -= sum(each.tried.work for each in springs.replacements if each.tried)
    advices: tuple[Remedy, ...] = ()
    pairs: tuple[Pair, ...] = ()
    misalignment = critical(system, "phi")
    if not sliding.stable or observation.comes_to != SLIDES:
        known = None if sliding.stable else misalignment
        advices = tuple(advise(system, known, work, report(3, of=len(LEVERS))))
        work -= sum(each.work for each in advices)
        if not any(each.works for each in advices if each.path == "phi"):
            pairs = tuple(advise_pairs(system, work, report(3 + len(LEVERS))))
    tolerance = None
    if rig.priors:
        from stiction.auditing.tolerance import budget

        tolerance = budget(rig, report(PARTS_OF_WORK, of=MORE))
    progress(1.0)
    both = observation, sliding_on
    return Audit(
        system, prediction, sliding, misalignment, *both, advices, springs, tolerance, measured,
        rig.priors, pairs, aligned,
    )  # fmt: skip


def sections(found: Audit) -> list[Section]:
    """Return the sections of the report on the apparatus itself."""
    return [
        Section(VERDICT if found.measured is None else AS_DESCRIBED, verdict(found)),
        Section("Predicted and simulated", violated_assumptions(found), numbers(found)),
        Section("Is it stick?", stick(found)),
        Section(LOAD_CELL, load_cell(found)),
        Section("Transverse oscillation", *transverse(found)),
        Section("What to change", *changes(found)),
    ]


def _of_record(measured: RecordComparison | None) -> list[Section]:
    """Return the sections on a measured record; none without one."""
    if measured is None:
        return []
    from stiction.auditing.measured import sections as sections_of

    return sections_of(measured)


FORMER = {"Audit": "stiction.auditing.Audit", "examine": "stiction.audit"}
old_attributes(audit, FORMER)
