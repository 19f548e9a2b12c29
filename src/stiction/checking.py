"""check(path): find damage in a result or a study's store."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from stiction.errors import Instruction, ResultError, Status, echo
from stiction.recording.stored import read_stored, root_attributes
from stiction.result.attributes import (
    SEAL,
    TIMES,
    intact_description,
    intact_times,
    legible_attributes,
)
from stiction.result.file import (
    ATTRIBUTES,
    FIT_KIND,
    RECORD_KIND,
    TEXTS,
    DamageError,
    LayoutError,
    SelectionError,
    is_netcdf,
    read_tables,
    repair_of,
    unlike_parts,
)
from stiction.result.fit_file import refuse_damaged_fit
from stiction.result.table import stick_table
from stiction.simulation import run
from stiction.storage.checksums import broken_parts, bytes_of
from stiction.storage.isolation import apart
from stiction.storage.kinds import RESULT, use_of
from stiction.storage.version import own_version
from stiction.study.execution.repair import damage_of, restore, stores_in
from stiction.study.store.store import CHECKED, group_at
from stiction.study.view.view import broken_changes
from stiction.system.description import Description
from stiction.text.sections import Section, as_html, as_text
from stiction.trajectory import Trajectory

# ends of a run by a limit that its description does not hold
LIMITED = (Status.TOO_MANY_STEPS.name, Status.TOO_MANY_STICKS.name)


class Check(NamedTuple):
    """The findings of a check.

    Parameters
    ----------
    path : Path
        The result or the store.
    damaged : sequence of str
        Names of the parts that are damaged, or were before a repair.
    repaired : bool
        Whether the damaged parts were computed again.
    pending : int
        Number of blocks of a study that are not computed yet.
    checked : bool
        Whether there are checksums, as from version 0.5 on.

    Examples
    --------
    >>> import stiction as st
    >>> path = st.simulate(st.presets.nakano_popov_2020(), "1 ms").save("run.nc")
    >>> found = st.check("run.nc")
    >>> found.ok, list(found.damaged)
    (True, [])
    """

    path: Path
    damaged: Sequence[str]
    repaired: bool = False
    pending: int = 0
    checked: bool = True

    @property
    def ok(self) -> bool:
        """Whether nothing is damaged now."""
        return self.repaired or not self.damaged

    def __repr__(self) -> str:
        """Return a one-line summary."""
        state = "repaired" if self.repaired else "whole" if self.ok else "damaged"
        return f"<Check {self.path}: {state}>"

    def __str__(self) -> str:
        """Return the report as text."""
        return as_text(self.tables())

    def _repr_html_(self) -> str:
        return as_html(self.tables())

    def tables(self) -> list[Section]:
        """Return the damaged parts and the remedy, as sentences."""
        lines = [f"Damaged: {name}." for name in self.damaged] or ["Nothing is damaged."]
        if self.repaired:
            lines.append("It was computed again.")
        elif self.damaged:
            lines.append(f"Compute it again with: {repair_of(self.path)}")
        elif not self.checked:
            lines.append("There are no checksums: only what is missing or cut off would show.")
        if self.pending:
            lines.append(f"{self.pending} blocks of runs are still to be done.")
        return [Section(str(self.path), lines)]


def check(path: str | Path, *, repair: bool = False, trust: bool = False) -> Check:
    """Check a result, a stored record, the file of a fit or the store of a study for damage.

    Versions before 0.5 wrote no checksums: in their files, only missing and truncated parts show.

    Parameters
    ----------
    path : str or Path
        A result of `stiction.run`, a record of `stiction import`, the file of a `stiction.fit` or
        a store of `stiction.sweep`.
    repair : bool, optional
        Whether to compute damaged parts again: a result from the description in it, a study
        block by block.
    trust : bool, optional
        Whether a repair may run the text of a friction law that is stored there; see
        `stiction.load`.

    Returns
    -------
    Check
        The findings.

    Raises
    ------
    ResultError
        If `path` is none of these, or a repair needs a description that is damaged too, or the
        description does not give the same run: `max_steps` ended it, or another version wrote it;
        or if a record is damaged, which must be imported again, or a fit, which must be made again.

    Examples
    --------
    >>> import stiction as st, tempfile
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="1 kHz")
    >>> st.check(run.save(tempfile.mkdtemp() + "/run.nc")).ok
    True
    """
    target = Path(path)
    if target.is_dir():
        return _check_store(target, repair, trust)
    return _check_result(target, repair, trust)


def _check_result(path: Path, repair: bool, trust: bool) -> Check:
    if path.suffix.lower() in (".toml", ".csv", ".parquet", ".mat") and os.path.isfile(path):
        writers = Instruction("stiction run or stiction sweep", "run.save(path) or st.sweep")
        use = use_of(path, RESULT) or f"check reads what {writers} wrote"
        raise ResultError(f"{path}: a {path.suffix} file is not a result; {use}")
    attributes = root_attributes(path) if os.path.isfile(path) else None
    if attributes is not None and RECORD_KIND in attributes:
        read_stored(path)  # or it says what is damaged
        return Check(path, [])
    if attributes is not None and FIT_KIND in attributes:
        refuse_damaged_fit(path)
        return Check(path, [])
    try:
        read_tables(path)
        return Check(path, [], checked=SEAL in (attributes or ()))
    except (LayoutError, SelectionError):  # no damage, and not to be written anew
        raise
    except DamageError as damage:
        told = damage.lost
    except ResultError as error:
        if not (os.path.isfile(path) and is_netcdf(path)):
            raise
        if attributes is not None and not {*TEXTS} & {*attributes}:  # somebody else's
            raise
        told = str(error).removeprefix(f"{path}: ")
    text, known = apart(intact_description, path)
    if not repair:
        return Check(path, [told])
    before = apart(legible_attributes, path)
    _refuse_unrepeatable(path, before)
    again = _computed_again(path, Description.from_json(text, trust=trust), known)
    _refuse_another(path, before, again, known)
    again.save(path)
    return Check(path, [told], repaired=True)


def _refuse_unrepeatable(path: Path, before: Mapping[str, Any]) -> None:
    """Refuse a damaged result whose description does not give the same run."""
    status, version = before.get("status"), before.get("stiction_version", own_version())
    if version != own_version():
        raise ResultError(
            f"{path}: stiction {version} wrote it, this is {own_version()}; use that one"
        )
    if status in LIMITED:
        raise ResultError(
            f"{path}: is damaged, and its description does not hold the limit that ended it: "
            f"{Status[status].value}; run it again"
        )


def _refuse_another(path: Path, before: Mapping[str, Any], again: Trajectory, known: str) -> None:
    """Refuse a run computed again that ended otherwise than the damaged one, as far as it tells."""
    parts = unlike_parts(known, again.samples, stick_table(again.stick_intervals))
    if ATTRIBUTES not in parts:
        return
    now: dict[str, Any] = {"status": again.status.name}
    now |= {name: getattr(again.statistics, name) for name in ("steps", "stick_count")}
    if unlike := [name for name in now if before.get(name, now[name]) != now[name]]:
        name = unlike[0]
        raise ResultError(
            f"{path}: is damaged, and its description gives another run: {name} was "
            f"{echo(before[name])}, is {echo(now[name])}; run it again"
        )


def _computed_again(path: Path, description: Description, known: str) -> Trajectory:
    """Return the run of a damaged result, sampled as that was; `known` are its checksums."""
    again = run(description)
    if TIMES not in broken_parts(known, {TIMES: bytes_of(again.samples["time"])}):
        return again
    return run(description, times=apart(intact_times, path))


def _check_store(path: Path, repair: bool, trust: bool) -> Check:
    files: list[str] = []
    pending, stores = 0, stores_in(path)
    checked = all(group_at(store, "r").attrs["format"] == CHECKED for store in stores)
    for store in stores:
        found = damage_of(store)
        own = restore(store, trust=trust) if repair else found.files
        files += [(store / name).relative_to(path).as_posix() for name in own]
        pending += found.pending
    if changes := broken_changes(path):
        if repair:
            raise ResultError(
                f"{path}: {', '.join(changes)} is damaged; refine the study again, with the same "
                "command: its runs are kept"
            )
        files += changes
    return Check(path, files, repair and bool(files), pending, checked)
