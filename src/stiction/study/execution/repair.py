"""Repair of a study's store: find the damaged parts and compute them again."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from stiction.errors import ResultError
from stiction.storage.files import place, workshop
from stiction.storage.version import own_version
from stiction.study.execution.sweep import do
from stiction.study.plan.study import Study, study_of
from stiction.study.store import seal
from stiction.study.store.creation import lay_out
from stiction.study.store.store import CHECKED, Store, group_at, store_at
from stiction.study.view.view import REFINED


class Damage(NamedTuple):
    """The damage of a store.

    Parameters
    ----------
    head : sequence of str
        Damaged files of those written when the store was made.
    blocks : mapping of int to sequence of str
        Damaged files of each block, by its number.
    pending : int
        Number of blocks that are not done.
    """

    head: Sequence[str]
    blocks: dict[int, list[str]]
    pending: int

    @property
    def files(self) -> list[str]:
        """All damaged files."""
        return [*self.head, *(file for files in self.blocks.values() for file in files)]


def damage_of(path: Path) -> Damage:
    """Find the damage of a store; blocks are checked only if the rest is intact.

    Raises
    ------
    ResultError
        If it is not a store, or damaged beyond repair.
    """
    group = group_at(path, "r")
    head = seal.broken_files(path) if group.attrs["format"] == CHECKED else []
    if {seal.ROOT, seal.DESCRIPTION} <= {*head}:
        raise seal.damage(path, head)
    if head:
        return Damage(head, {}, 0)
    store = store_at(path, "r")
    regions = [store.layout.region(task) for task in range(store.layout.tasks)]
    found = {
        task: [file.relative_to(path).as_posix() for file in store.damaged_files(region, read=True)]
        for task, region in enumerate(regions)
    }
    pending = sum(not store.mark(region).exists() for region in regions)
    return Damage([], {task: files for task, files in found.items() if files}, pending)


def restore(path: Path, *, trust: bool = False) -> list[str]:
    """Compute the damaged parts of a store again; return the files.

    Raises
    ------
    ResultError
        If it is damaged beyond repair, or another version wrote it.
    """
    found, files = damage_of(path), []
    if not found.files:
        return []
    group = group_at(path, "r")
    if group.attrs.get("stiction_version") != own_version():
        wrote = group.attrs.get("stiction_version")
        raise ResultError(
            f"{path}: stiction {wrote} wrote it, this is {own_version()}; use that one"
        )
    study = study_of(Study.from_json(str(group.attrs["description"]), trust=trust))
    if found.head:
        _restore_head(study, path, found.head)
        files, found = [*found.head], damage_of(path)
    if found.blocks:
        _restore_blocks(study, store_at(path, "r+"), [*found.blocks])
    return [*files, *found.files]


def _restore_head(study: Study, path: Path, names: Sequence[str]) -> None:
    """Write damaged initial files of a store again."""
    with workshop(path.parent) as room:
        fresh = lay_out(study, room / "store")
        files = {name for name in (*names, seal.ROOT) if (fresh / name).is_file()}
        place({fresh / name: path / name for name in sorted(files)})
    if left := seal.broken_files(path):
        raise ResultError(f"{path}: {', '.join(left)} cannot be repaired; run the study anew")


def _restore_blocks(study: Study, store: Store, tasks: Sequence[int]) -> None:
    """Compute blocks again."""
    for task in tasks:
        store.mark(store.layout.region(task)).unlink(missing_ok=True)  # as of another repair
    do(study, store, tasks, None, None)


def stores_in(path: Path) -> list[Path]:
    """Return a store and the stores of its refinement."""
    return [path, *sorted(path.glob(f"{REFINED}/*/*.zarr"))]
