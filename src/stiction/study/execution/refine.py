"""Refinement of a study where the kind of motion changes, without a finer grid.

Between neighbours of different kind on the grid, bisection finds the change. All intervals are
halved at once, by a study inside the store, so that an interrupted refinement can be continued.
Where the run in the middle fails, quarter points are tried; an interval is left as it is where
these fail too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pydantic_core import PydanticCustomError

from stiction.arrays import Floats, xr
from stiction.errors import DescriptionError, Fault, ResultError, echo
from stiction.names import by_new_names
from stiction.progress.audience import with_progress
from stiction.storage.files import place, workshop
from stiction.study.execution.engines import Engine
from stiction.study.execution.sweep import Tally, sweep, told_by
from stiction.study.plan.axes import Values
from stiction.study.plan.coordinates import ascending, number
from stiction.study.plan.study import Study, study_of
from stiction.study.store.creation import create
from stiction.study.store.kept import UNKNOWN, flag_attributes
from stiction.study.store.seal import seal
from stiction.study.store.store import errors_as_message, group_at, open_study
from stiction.study.variables.kinds import FORMERLY, KINDS
from stiction.study.view.view import CHANGES, REFINED, REGIME, kinds
from stiction.text.paths import canonical_path
from stiction.text.units import Quantity
from stiction.text.validation import unknown_name

MOST_HALVINGS = 50  # to the distance of two floats
INSIDE = (0.5, 0.25, 0.75)  # of an interval: the next is tried where the run at the former fails


class Intervals(NamedTuple):
    """Pairs of runs with different motion: the axes' values and the kinds of motion.

    Parameters
    ----------
    low, high : mapping of str to ndarray
        (n,) for each axis, in the unit of the study's store.
    below, above : ndarray
        (n,) kinds of motion at both.
    """

    low: Mapping[str, Floats]
    high: Mapping[str, Floats]
    below: np.ndarray
    above: np.ndarray


def changes(study: Study, data: xr.Dataset, along: str, apart: Sequence[str] | None) -> Intervals:
    """Return neighbouring runs of different kind on a study's grid; failed runs are skipped.

    Neighbours along the axis have neighbouring values, in whatever order the study has them.
    """
    dims, order = study.layout.dims, ascending(study.coordinates, along)
    axis = dims.index(along)
    found = np.moveaxis(kinds(data), axis, -1)[..., order]
    sides = side(found, apart)
    differ = (sides[..., 1:] != sides[..., :-1]) & (found[..., 1:] != "") & (found[..., :-1] != "")
    places = np.argwhere(differ)

    def end(step: int) -> dict[str, Floats]:
        index = np.insert(places[:, :-1], axis, order[places[:, -1] + step], axis=1)
        axes = study.coordinates.items()
        return {name: each.values[index[:, dims.index(each.dim)]] for name, each in axes}

    last = found.reshape(-1, found.shape[-1])
    row = np.ravel_multi_index(tuple(places[:, :-1].T), found.shape[:-1]) if found.ndim > 1 else 0
    return Intervals(end(0), end(1), last[row, places[:, -1]], last[row, places[:, -1] + 1])


def side(found: np.ndarray, apart: Sequence[str] | None) -> np.ndarray:
    """Return the kinds as they are compared: themselves, or whether they are in `apart`."""
    return found if apart is None else np.isin(found.astype(str), list(apart))


def between(low: Floats, high: Floats, share: float) -> Floats:
    """Return the values at a share of the way between others, or the value of two equal ones."""
    return np.where(low == high, low, (1.0 - share) * low + share * high)


def narrow(
    found: Intervals, inside: Mapping[str, Floats], at: np.ndarray, apart: Sequence[str] | None
) -> Intervals:
    """Return the part of each interval, on one side of a point inside, that contains a change.

    If the point has a third kind, this is the lower part. Where it has no kind, because its run
    failed, nothing is known of either part: the interval stays.
    """
    upper = (at != "") & (side(at, apart) == side(found.below, apart))
    lower = (at != "") & ~upper
    return Intervals(
        {name: np.where(upper, inside[name], low) for name, low in found.low.items()},
        {name: np.where(lower, inside[name], high) for name, high in found.high.items()},
        np.where(upper, at, found.below),
        np.where(lower, at, found.above),
    )


def widths(found: Intervals, along: str) -> Floats:
    """Return the width of each interval."""
    return np.abs(found.high[along] - found.low[along])


@with_progress("simulating", told_by)
def refine(
    study: Study | str | Path,
    path: str | Path,
    along: str,
    to: Quantity,
    *,
    apart: Sequence[str] | None = None,
    engine: Engine | None = None,
    progress: Callable[[Tally], None] | None = None,
) -> xr.Dataset:
    """Find the changes of motion along one axis of a study, for each value of the others.

    Parameters
    ----------
    study : Study, str or Path
        The study, or its file. Its grid along the axis must be fine enough to show each change,
        which a failed run hides; it keeps "regime".
    path : str or Path
        Its store; missing runs are done first.
    along : str
        The axis.
    to : float or str
        The desired width of the interval of each change, in the axis's unit.
    apart : sequence of str, optional
        Kinds to distinguish from all others, e.g. those that come to rest; by default every
        change of kind counts.
    engine, progress
        Those of `stiction.sweep`.

    Returns
    -------
    Dataset
        The changes over ``point``: the value of every axis, for ``along`` the middle of the final
        interval; its ``half_width``; ``below`` and ``above``, the kinds on both sides, coded like
        "regime" in the store. An interval stays wider than `to` where the runs at its middle and
        its quarter points failed. Attributes ``runs``: the total number of runs; ``wide``: the
        number of such intervals; and ``apart``, if given. The dataset is also kept in the store, in
        the group ``refined/ALONG/changes``, in place of an earlier one; `stiction map` draws it.
        Refinements with other kinds share runs.

    Raises
    ------
    DescriptionError
        If there is no such axis, or the study keeps no regime.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "3 s")
    >>> axes = {"phi": st.Grid("8 deg", "12 deg", 3)}
    >>> study = st.Study(base=base, axes=axes, measures=["regime"])
    >>> found = st.refine(study, "yaw.zarr", along="phi", to="1 deg")
    >>> found.sizes["point"] > 0
    True
    """
    study = study_of(study)
    along, width, apart = request(study, along, to, apart)
    sweep(study, path, engine=engine, progress=progress)
    found, runs = changes(study, open_study(path).load(), along, apart), study.layout.runs
    folder = Path(path) / REFINED / along
    folder.mkdir(parents=True, exist_ok=True)
    left = np.zeros(len(found.below), bool)
    for level in range(1, MOST_HALVINGS):
        if np.max(widths(found, along), initial=0.0, where=~left) <= width:
            break
        waiting = ~left
        for share in INSIDE:
            inside = {
                name: between(low, found.high[name], share) for name, low in found.low.items()
            }
            part = samples(study, {name: values[waiting] for name, values in inside.items()})
            store = _store_of(part, folder, level)
            sweep(part, store, engine=engine, progress=progress)
            at = np.full(len(left), "", object)
            at[waiting] = kinds(open_study(store).load())
            found, runs = narrow(found, inside, at, apart), runs + part.layout.runs
            waiting &= at == ""
            if not waiting.any():
                break
        left |= waiting
    made = table(study, found, along, runs)
    made.attrs["wide"] = int(np.count_nonzero(left & (widths(found, along) > width)))
    made.attrs |= {} if apart is None else {"apart": apart}
    _keep(made, folder / CHANGES)
    return made


def _store_of(part: Study, folder: Path, level: int) -> Path:
    """Return the store of a level's runs: the first that has them, or is made for them.

    Intervals depend on the kinds that are compared: one level may have several sets of runs.
    Another refinement may make one of them meanwhile.
    """
    paths = (folder / f"{level}{f'-{n}' if n > 1 else ''}.zarr" for n in count(1))
    wanted = part.to_json()
    for path in paths:
        if not path.exists():
            try:
                create(part, path)
            except ResultError:
                if not path.exists():  # otherwise another refinement was faster
                    raise
        if group_at(path, "r").attrs.get("description") == wanted:
            break
    return path


def request(
    study: Study, along: str, to: Quantity, apart: Sequence[str] | None
) -> tuple[str, float, list[str] | None]:
    """Return axis, width and kinds of `refine` in their standard form, or refuse them.

    Raises
    ------
    DescriptionError
        If there is no such axis or kind, or the study keeps no regime.
    """
    along = canonical_path(along)
    return along, _requested_width(study, along, to), _kinds(apart)


def _keep(changes: xr.Dataset, target: Path) -> None:
    """Write the changes, sealed, in place of earlier ones."""
    with errors_as_message(target), workshop(target.parent) as room:
        changes.to_zarr(room / CHANGES, zarr_format=3, consolidated=False)
        seal(room / CHANGES)
        for turn in count():
            with suppress(FileNotFoundError):
                target.replace(room / f"earlier-{turn}")
            try:
                place({room / CHANGES: target})
                break
            except OSError:
                if not target.exists():  # otherwise another refinement was faster
                    raise


def _requested_width(study: Study, along: str, to: Quantity) -> float:
    """Return the desired width, if the arguments are valid."""
    found = []
    if along not in study.coordinates or along not in study.layout.dims:
        found.append(Fault("along", unknown_name("dimension", along, study.layout.dims)))
    if REGIME not in study.measures:
        found.append(Fault("study.measures", f"lacks {REGIME!r}, which shows the changes"))
    if found:
        raise DescriptionError(found)
    try:
        width = number(to, study.coordinates[along].unit)
    except PydanticCustomError as error:
        raise DescriptionError.of("to", error.message()) from None
    if not width > 0.0:
        raise DescriptionError.of("to", f"must be greater than 0, is {echo(to)}")
    return width


def _kinds(apart: Sequence[str] | None) -> list[str] | None:
    """Return kinds of motion, with old names replaced."""
    if apart is None:
        return None
    now = by_new_names(apart, FORMERLY, "kind of motion")
    if strange := [name for name in now if name not in KINDS]:
        raise DescriptionError(
            [Fault("apart", unknown_name("kind of motion", name, KINDS)) for name in strange]
        )
    return now


def samples(study: Study, values: Mapping[str, Floats]) -> Study:
    """Return a study of single runs."""
    axes: dict[str, Any] = {}
    for name, each in values.items():
        unit = " deg" if study.coordinates[name].unit == "deg" else ""
        listed = [f"{v!r}{unit}" if unit else v for v in each.tolist()]
        axes[name] = Values(listed, "sample")
    return Study(base=study.base, axes=axes, measures=[REGIME])


def table(study: Study, found: Intervals, along: str, runs: int) -> xr.Dataset:
    """Return the changes as labelled arrays."""
    data: dict[str, Any] = {
        name: (
            "point",
            between(found.low[name], found.high[name], 0.5),
            {"units": each.unit or "1", "long_name": name},
        )
        for name, each in study.coordinates.items()
    }
    unit = study.coordinates[along].unit or "1"
    half = 0.5 * widths(found, along)
    names = {"units": unit, "long_name": f"half the width of what is left in {along}"}
    data["half_width"] = ("point", half, names)
    for name in ("below", "above"):
        codes = np.array([KINDS.index(kind) for kind in getattr(found, name)], np.int8)
        meaning = {"long_name": f"kind of motion {name}", **flag_attributes(UNKNOWN, KINDS)}
        data[name] = ("point", codes, meaning)
    return xr.Dataset(data, attrs={"along": along, "runs": runs})
