"""The question of a design: a rig, a parameter of it, and tests; or every fault of them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

from stiction.analysis.record import Record
from stiction.arguments import is_list
from stiction.errors import DescriptionError, Fault, Faults
from stiction.inference.fit import check
from stiction.inference.next_test.further import Wanted
from stiction.inference.posterior import OWN_UNITS
from stiction.inference.rig import Rig, load_of_records, rig_of, stated_names
from stiction.inference.simulated.plan import Plan
from stiction.text.paths import canonical, last_part
from stiction.text.quantity.wording import in_words
from stiction.text.validation import read_arguments

ALWAYS = "jitter"  # of the parameters that no description has, the one that every fit estimates
SEVERAL = ("channels", "angles", "velocities", "loads")  # arguments that may be one value alone


class Question(NamedTuple):
    """The question of a design."""

    rig: Rig  # with its priors
    of: str  # the path of the parameter of interest
    wanted: Wanted  # the other arguments
    record: Record | None  # of the present test


def ask(
    rig: Rig | str | Path,
    read_record: Callable[[float | None], Record] | None,
    of: str,
    faults: Faults,
    *,
    changes: Mapping[str, Any] | None = None,
    trust: bool = False,
    **given: Any,
) -> Question:
    """Return the question, or every fault of rig, record and arguments, and earlier faults.

    `changes` and `trust` are for the file of a rig, as of `Rig.from_toml`.
    """
    known, seen = None, None
    with faults.of_part():
        known = rig_of(rig, changes, trust)
        check(known)
    if read_record is not None:
        with faults.of_part():
            seen = read_record(None if known is None else load_of_records(known))
        if several(given["channels"]) != ("force",):
            with faults.of_part():
                message = "are those of the record; leave them out, or the record"
                raise DescriptionError.of("channels", message)
    names = stated_names(rig, changes) if known is None else known.priors
    with faults.of_part():
        name, wanted = check_arguments(names, of, 0.0 if known is None else known.slider.phi, given)
    faults.refuse()
    assert known is not None
    return Question(known, name, wanted, seen)


def several(given: Any) -> tuple[Any, ...]:
    """Return values as a tuple; a single value becomes a tuple of one.

    >>> several("3 deg"), several(["1 deg", "3 deg"])
    (('3 deg',), ('1 deg', '3 deg'))
    """
    return tuple(given) if is_list(given) else (given,)


def check_arguments(
    names: Collection[str], of: str, phi: float, given: dict[str, Any]
) -> tuple[str, Wanted]:
    """Return the path of the parameter of interest and the other arguments, or every fault.

    Of a rig with a misalignment `phi`, whose uncertain parameters have these `names`; where it has
    none, which is a fault of the rig, any parameter will do.
    """
    name, faults = canonical(of), []
    name = next((path for path in names if name in (path, last_part(path))), name)
    if names and name not in (*names, *OWN_UNITS):
        known = ", ".join((*names, ALWAYS))
        faults.append(Fault(of, f"is not uncertain in this description; name one of {known}"))
    lists = {key: several(given[key]) for key in SEVERAL if given[key] is not None}
    try:
        wanted = read_arguments(Wanted, **{**given, **lists})
    except DescriptionError as error:
        raise DescriptionError([*faults, *error.faults]) from None
    for angle in wanted.angles:
        if abs(phi + angle) >= 0.5 * pi:
            message = f"{in_words(angle, 'rad')} turns the rig to 90 deg or more"
            faults.append(Fault("angles", f"{message}; write a smaller one"))
    if faults:
        raise DescriptionError(faults)
    return name, wanted


def refuse_certain(name: str, trial: Plan) -> None:
    """Refuse a parameter of the load cell whose uncertainty is not stated."""
    if name not in trial.priors:
        message = "is taken as certain; state its uncertainty in the file beside the record, under "
        raise DescriptionError.of(name, f"{message}[sensors.force], or name another parameter")
