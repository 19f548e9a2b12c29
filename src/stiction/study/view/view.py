"""A view of a study: its store, cut to one or two dimensions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stiction.arrays import xr
from stiction.errors import DescriptionError, Fault, ResultError
from stiction.names import by_new_names
from stiction.storage.foreign import opening, refuse_size
from stiction.study.plan.coordinates import nearest
from stiction.study.plan.study import Study
from stiction.study.store import seal
from stiction.study.store.kept import stored_variables
from stiction.study.store.store import CHECKED, group_at, open_study
from stiction.study.variables.kinds import KINDS
from stiction.study.variables.measures import FORMERLY, MEASURES
from stiction.text.suggestion import Suggestion
from stiction.text.units import Quantity
from stiction.text.validation import unknown_name

REGIME = "regime"
NO_CYCLE = "the force slips, but shows no whole cycle; lengthen the run"
RUNS = ("status", "message")  # variables that are not measures
REFINED, CHANGES = "refined", "changes"  # folders in a store


class View(NamedTuple):
    """A study and its store, with some dimensions cut.

    Parameters
    ----------
    study : Study
        The study.
    data : Dataset
        Its store, without the dimensions that are cut.
    at : mapping of str to int
        The index along each of these.
    changes : sequence of Dataset
        Refined changes of the kind of motion, if any; see `stiction.study.execution.refine`.
    """

    study: Study
    data: xr.Dataset
    at: Mapping[str, int]
    changes: Sequence[xr.Dataset]


def view_study(
    path: str | Path,
    cut: Mapping[str, Quantity],
    trust: bool = False,
    measures: Sequence[str] = (),
) -> View:
    """Return a study with some of its dimensions cut, after a check that it has the measures."""
    with opening(path, "is damaged"):
        data = open_study(path)
        study = Study.from_json(data.attrs["description"], trust=trust)
    fitting(path, data, study)
    dims = study.layout.dims
    at, found = nearest(study.coordinates, dims, cut)
    left = [dim for dim in dims if dim not in at]
    found += strange_measures(data, measures)
    if not found and not 1 <= len(left) <= 2:
        at_a_value = Suggestion("at", {"NAME": "VALUE"}, of="")
        remedy = f"cut it at a value: {at_a_value}" if left else "leave one or two"
        found.append(Fault(", ".join(dims), f"{len(left)} dimensions are left; {remedy}"))
    if found:
        raise DescriptionError(found)
    part = data.isel(at)
    refuse_size(path, part.nbytes)
    with opening(path, "is damaged"):
        return View(study, part.load(), at, refined_changes(path))


def fitting(path: str | Path, data: xr.Dataset, study: Study) -> None:
    """Refuse a store whose arrays do not match its study.

    Raises
    ------
    ResultError
        With the names of the arrays.
    """
    runs = dict(zip(study.layout.dims, study.layout.shape, strict=True))
    along = {name: {each.dim: runs[each.dim]} for name, each in study.coordinates.items()}
    numbers = [each.name for each in stored_variables(study) if not each.shape]
    wanted = {**along, **dict.fromkeys(("status", *numbers), runs)}
    wrong = [
        name
        for name, sizes in wanted.items()
        if name not in data or data[name].sizes != sizes or data[name].dtype.kind not in "fiu"
    ]
    if wrong:
        raise ResultError(f"{path}: is damaged: {', '.join(wrong)} do not match the study")


def refined_changes(path: str | Path) -> list[xr.Dataset]:
    """Return the refined changes of motion, one dataset for each axis."""
    if lost := broken_changes(path):
        remedy = "refine the study again, with the same command: its runs are kept"
        raise ResultError(f"{path}: is damaged: {', '.join(lost)}; {remedy}")
    folders = sorted(Path(path).glob(f"{REFINED}/*/{CHANGES}"))
    return [xr.open_zarr(folder, consolidated=False, zarr_format=3).load() for folder in folders]


def broken_changes(path: str | Path) -> list[str]:
    """Return the tables of changes in a store that are damaged."""
    if group_at(path, "r").attrs["format"] != CHECKED:
        return []
    tables = sorted(Path(path).glob(f"{REFINED}/*/{CHANGES}"))
    return [each.relative_to(path).as_posix() for each in tables if seal.broken_files(each)]


def choose_measures(view: View, measures: Sequence[str]) -> list[str]:
    """Return the measures to draw: the given ones, which `view_study` checked, or the first."""
    kept = kept_measures(view.data)
    measures = by_new_names(measures, FORMERLY, "measure")
    if not kept:
        raise DescriptionError.of(
            "measures", "the study kept no measures; there is nothing to draw"
        )
    if measures:
        return list(measures)
    numbers = [str(each) for each in view.study.measures if each != REGIME]
    two = len(view.data["status"].dims) == 2 or not numbers
    return [REGIME] if REGIME in kept and two else numbers[:1] or [REGIME]


def kept_measures(data: xr.Dataset) -> list[str]:
    """Return the names of the measures that a study stored."""
    runs = data["status"].dims  # traces have time as well
    return [
        str(name) for name, each in data.data_vars.items() if name not in RUNS and each.dims == runs
    ]


def strange_measures(data: xr.Dataset, measures: Sequence[str]) -> Iterator[Fault]:
    """Yield a fault for each measure that a study lacks."""
    kept = kept_measures(data)
    for name in measures:
        if (now := FORMERLY.get(name, name)) in MEASURES and now not in kept:
            yield Fault(
                name,
                f"the study did not store it, but {', '.join(sorted(kept)) or 'no measure'}; add "
                "it to `measures` of the study, and sweep into another store",
            )
        elif now not in kept:
            yield Fault(name, unknown_name("measure", name, kept))


def kinds(data: xr.Dataset) -> np.ndarray:
    """Return the kind of motion of each run as text; '' if the run failed or is missing."""
    names = np.array([*KINDS, ""], dtype=object)
    found: np.ndarray = names[data[REGIME].values.astype(int)]  # -1 is the last
    return found


def undetermined_in_words(messages: Sequence[str], runs: int) -> str:
    """Return how many runs are not determined, and why, the most frequent first; '' for none.

    Examples
    --------
    >>> undetermined_in_words(["shorten it"], 5)
    '1 of 5 runs not determined: shorten it'
    >>> undetermined_in_words(["shorten it", "no cycle", "no cycle"], 5)
    '3 of 5 runs not determined: no cycle (2); shorten it (1)'
    """
    if not messages:
        return ""
    counted = Counter(messages).most_common()
    several = len(counted) > 1
    reasons = "; ".join(f"{why} ({count})" if several else why for why, count in counted)
    return f"{len(messages)} of {runs} runs not determined: {reasons}"
