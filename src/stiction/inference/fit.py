"""st.fit(records, rig): estimate the parameters of a rig from records."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from stiction.arguments import end_reading, read_together
from stiction.drive import ConstantVelocity
from stiction.drive.program import nominal_velocity
from stiction.errors import DescriptionError, Fault, Instruction
from stiction.friction import Anisotropic, has_state
from stiction.friction.registry import LAWS
from stiction.inference.learning.calibration import learn_or_read, learn_or_read_summary
from stiction.inference.learning.summary import FeatureSummary
from stiction.inference.measured.observed_rig import ObservedRig, observe_rig
from stiction.inference.observation import (
    VELOCITY,
    Conditions,
    Observation,
    Source,
    sign_seen,
)
from stiction.inference.posterior import Fit
from stiction.inference.priors import Prior, middle
from stiction.inference.rig import Rig, refuse_swapped, rig_of
from stiction.inference.simulated import SIMULATIONS
from stiction.inference.simulated.jitter import coefficients
from stiction.inference.simulated.library import (
    Ensemble,
    Library,
    library_folder,
    refuse_too_few,
    telling,
    will_be_too_few,
)
from stiction.inference.simulated.plan import Plan, plan
from stiction.inference.simulated.synthetic import LONGEST_CYCLE
from stiction.inference.suitability import ANALYSE
from stiction.progress.audience import with_progress
from stiction.progress.report import Progress, part, silent
from stiction.recording.part import begin_and_end
from stiction.system.slider import Slider

SMALLEST_ANGLE = 1e-9  # rad: a median of zero is off by rounding
VARIED = "mu_0, mu_s, ... to vary from cycle to cycle"
FEWEST_SIMULATIONS = 300  # simulations with cycles, below which nothing is learned
USABLE = 0.5  # of the simulations, at least, have cycles where more of them are simulated
MORE = 1.5  # times as many as lack on average


@read_together
@with_progress("simulating and learning")
def fit(
    records: Source | Sequence[Source],
    rig: Rig | str | Path,
    *,
    simulations: int = SIMULATIONS,
    library: str | Path | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Fit:
    """Estimate the parameters of a rig from one or several measured records.

    Each of many simulated records has parameters drawn from the rig's priors, friction that differs
    from cycle to cycle, and the record's own sampling and noise. Their features are compared with
    those of the measured ones (regression-adjusted approximate Bayesian computation).

    Experimental: nothing promises the coverage of the intervals on your rig. Each fit measures it
    on simulated records that it leaves out, and reports it: ``fit["phi"].coverage``.

    Parameters
    ----------
    records : Record, Trajectory, str, Path or sequence of Record, Trajectory, str or Path
        Records of one rig, or their files, at the same or at other velocities and loads, with at
        least six whole cycles of stick and slip each. A run is taken as if it was measured.
        ``drive_velocity`` and ``normal_load`` of a record replace those of the rig, ``turned``
        is added to its misalignment.
    rig : Rig, str or Path
        The description with its priors; see `stiction.inference.priors`.
    simulations : int, optional
        In the library, at least 300; more sharpen the posterior. Where fewer than 300 have
        cycles, and most do, further ones are simulated.
    library : str or Path, optional
        A folder in which libraries are kept: an interrupted fit continues, and a record under
        the same conditions needs no new simulation.
    seed : int, optional
        Of the simulations.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Fit
        Posterior and prior of each parameter.

    Raises
    ------
    ResultError
        If a record cannot be used, the priors lead to too few records with cycles, or nothing can
        be written to `library`.
    DescriptionError
        If nothing is uncertain, or the rig is not of a kind that can be fitted.
    """
    refuse_swapped(rig, records, "the rig comes second: st.fit(records, rig)")
    known = rig_of(rig)
    check(known, simulations)
    place = library_folder(library)
    its = observe_rig(records, known)
    end_reading()
    return fit_observed(its, simulations, place, seed, progress or silent)


def fit_observed(
    its: ObservedRig, simulations: int, place: Path | None, seed: int, progress: Progress
) -> Fit:
    """Do as `fit` for records that are observed, with libraries in the folder `place`."""
    simulating, learning = part(progress, 0, 10, of=7), part(progress, 7, 10, of=3)
    begun = Ensemble.within(place, plan_for(its.rig, its.conditions), seed)
    begun = refuse_early(begun, simulations, part(simulating, 0, 20))
    simulated = build_enough(begun, simulations, part(simulating, 1, 20, of=19))
    found = posterior_of(simulated, its.seen, begun.folder, learning)
    progress(1.0)
    return replace(found, drive=its.drive)


def refuse_early(begun: Ensemble, simulations: int, progress: Progress = silent) -> Ensemble:
    """Return the first simulations; refuse them if they show that too few will have cycles."""
    most = max(simulations, int(FEWEST_SIMULATIONS / USABLE))
    number = telling(most, FEWEST_SIMULATIONS)
    if simulations <= number:
        return begun
    begun = begun.simulate(number, progress)
    first = begun.library(number)
    if will_be_too_few(len(first.scores), number, most, FEWEST_SIMULATIONS):
        refuse_few_of(first)
    return begun


def build_enough(begun: Ensemble, simulations: int, progress: Progress) -> Library:
    """Simulate a library, and more than are asked for where a few are lacking with cycles.

    Where fewer than half of them have cycles, the priors are at fault: then it is left as it is.
    """
    wanted = simulations
    while True:
        begun = begun.simulate(wanted, progress)
        library = begun.library(wanted)
        usable = len(library.scores)
        if not USABLE * wanted <= usable < FEWEST_SIMULATIONS:
            return library
        wanted += ceil(MORE * (FEWEST_SIMULATIONS - usable) / (usable / wanted))


def refuse_few_of(library: Library) -> None:
    """Refuse a library of which too few simulations have cycles."""
    usable = len(library.scores)
    refuse_few_simulations("simulated records", usable, library.wanted, FEWEST_SIMULATIONS)


def refuse_few_simulations(
    what: str, usable: int, simulated: int, fewest: int, recorded: bool = True
) -> None:
    """Refuse simulations of which fewer have cycles, and name the priors that decide it.

    They are compared with those of a record, or else with that of the rig in the middle of its
    priors.
    """
    compared = "the record's" if recorded else "that in the middle of the priors"
    also = f", and whether the record is stick-slip at all: `{ANALYSE}` tells" if recorded else ""
    refuse_too_few(
        what, usable, simulated, fewest, f" no longer than {LONGEST_CYCLE:g} times {compared}",
        f"the priors, and stiffness and velocity, which decide how long a cycle lasts{also}",
    )  # fmt: skip


def check(rig: Rig, simulations: int = FEWEST_SIMULATIONS) -> None:
    """Refuse a rig without priors, a law or drive that cannot be fitted, and a small library.

    Fewer simulations than are needed with cycles would be too few if all of them had some.
    """
    faults = []
    if simulations < FEWEST_SIMULATIONS:
        message = f"must be at least {FEWEST_SIMULATIONS}, is {simulations}; more sharpen the fit"
        faults.append(Fault("simulations", message))
    if not rig.priors:
        message = "nothing is uncertain, and a fit estimates what is; write for example "
        message += 'phi = "2 +- 1 deg", in Python st.Rig(slider, {"phi": "2 +- 1 deg"})'
        faults.append(Fault("slider", message))
    faults += law_faults(rig.slider.law)
    faults += program_faults(rig.slider)
    if faults:
        raise DescriptionError(faults)


def program_faults(slider: Slider) -> Iterator[Fault]:
    """Yield a fault for a drive that stands still, and for a drive or load that varies."""
    part = f"and take the part of the record in which it is so ({begin_and_end()})"
    if not isinstance(slider.motion, ConstantVelocity):
        yield Fault(
            "drive", f'changes, and a fit takes a steady one: write velocity = "1 mm/s", {part}'
        )
    elif not nominal_velocity(slider.motion):
        yield Fault(VELOCITY, 'is 0, and a fit takes a drive that moves: write velocity = "1 mm/s"')
    if slider.load is not None:
        yield Fault("load", f"changes, and a fit takes a constant one: take out this table, {part}")


def law_faults(law: Any) -> Iterator[Fault]:
    """Yield a fault for a law that cannot be fitted; the message names those that can."""
    inner = law.law if isinstance(law, Anisotropic) else law
    if _is_fitted(inner):
        return
    known = ", ".join(name for name, kind in LAWS.items() if _is_fitted(kind))
    lack, why = f"it has no coefficient {VARIED}", ""
    if has_state(inner):
        lack = "it has internal states"
        odds = Instruction("stiction fit --mechanism", "st.mechanism")
        why = (
            f". With such a law the odds of mechanisms (`{odds}`) say "
            "whether the record is like rate and state or LuGre"
        )
    yield Fault(
        "friction.law",
        f"{type(inner).__name__} is not fitted, as {lack}; take one of {known}, or one of your own "
        f"with a coefficient {VARIED}, and without states{why}",
    )


def _is_fitted(law: Any) -> bool:
    """Return whether a law, or a kind of it, can be fitted: only its coefficients vary by cycle.

    It has no internal state, and a coefficient mu_... beside that of static friction.
    """
    return not has_state(law) and bool({*coefficients(law)} - {"mu_static"})


def plan_for(rig: Rig, conditions: Sequence[Conditions], signed: bool | None = None) -> Plan:
    """Return the plan of a library for records under these conditions.

    Where records show no sign of the misalignment, which `signed` tells if not the conditions, it
    has that of its prior's middle.
    """
    if signed is None:
        signed = sign_seen(conditions)
    priors = {**rig.priors}
    if not signed and "phi" in priors:
        priors["phi"] = one_sided(priors["phi"])
    if VELOCITY in priors:  # a drive that goes back makes no such record
        priors[VELOCITY] = one_sided(priors[VELOCITY], rounding=0.0)
    return plan(rig.slider, priors, conditions)


def one_sided(prior: Prior, rounding: float = SMALLEST_ANGLE) -> Prior:
    """Return the part of a prior on the side of its middle, as that of an angle without a sign.

    A middle of zero is off by `rounding`, and is on the positive side.
    """
    if middle(prior) < -rounding:
        return replace(prior, high=min(prior.high, 0.0))
    return replace(prior, low=max(prior.low, 0.0))


def posterior_of(
    library: Library,
    seen: Sequence[Observation],
    folder: Path | None = None,
    progress: Progress = silent,
) -> Fit:
    """Return the posterior by the features of records, by comparison with a library.

    What is learned from the library is kept in `folder`.

    Raises
    ------
    ResultError
        If too few of its simulations have cycles.
    """
    refuse_few_of(library)
    observed = np.concatenate([each.features for each in seen])
    count = 1 + len(seen)
    learned = learn_or_read(
        library.features, library.scores, _place(folder, library), part(progress, 0, count)
    )
    (sample,) = learned.posteriors(observed[None])
    return Fit.of(library, sample, seen, learned, [*_alone(library, seen, folder, progress)])


def _alone(
    library: Library, seen: Sequence[Observation], folder: Path | None, progress: Progress
) -> Iterator[FeatureSummary]:
    """Yield the estimates from the features of each of several records by itself."""
    if len(seen) < 2:
        return
    ends = np.cumsum([len(each.features) for each in seen])[:-1]
    for number, features in enumerate(np.split(library.features, ends, axis=1), 1):
        place = _place(folder, library, f"-record-{number}")
        own = np.ascontiguousarray(features)
        report = part(progress, number, 1 + len(seen))
        yield learn_or_read_summary(own, library.scores, place, report)


def _place(folder: Path | None, library: Library, of: str = "") -> Path | None:
    """Return the file of the results learned from a library."""
    return None if folder is None else folder / f"learned-{library.wanted}{of}.npz"
