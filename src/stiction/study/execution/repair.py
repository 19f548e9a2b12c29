"""What of a study's store is damaged, and computing it again."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from stiction.errors import ResultError
from stiction.storage.files import place, workshop
from stiction.study.execution.sweep import do
from stiction.study.plan.study import Study
from stiction.study.store import seal
from stiction.study.store.creation import lay_out
from stiction.study.store.store import CHECKED, Store, group_at, store_at, version
from stiction.study.view.view import REFINED


class Damage(NamedTuple):
    """What of a store is not as it was written.

    Parameters
    ----------
    head : sequence of str
        Files that were written when it was made.
    blocks : mapping of int to sequence of str
        Files of each block, by its number.
    pending : int
        Blocks that are not done.
    """

    head: Sequence[str]
    blocks: dict[int, list[str]]
    pending: int

    @property
    def files(damage) -> list[str]:
        """The files that are damaged."""
        return [*damage.head, *(file for files in damage.blocks.values() for file in files)]


def damage_of(path: Path) -> Damage:
    """Return what is damaged of a store; blocks only where the rest is whole.

    Raises
    ------
    ResultError
        If it is no store, or so damaged that it cannot be computed again.
    """
    group = group_at(path, "r")
    head = seal.broken(path) if group.attrs["format"] == CHECKED else []
    if {seal.ROOT, seal.DESCRIPTION} <= {*head}:
        raise seal.damage(path, head)
    if head:
        return Damage(head, {}, 0)
    store = store_at(path, "r")
    regions = [store.layout.region(task) for task in range(store.layout.tasks)]
    found = {
        task: [file.relative_to(path).as_posix() for file in store.damaged(region, read=True)]
        for task, region in enumerate(regions)
    }
    pending = sum(not store.mark(region).exists() for region in regions)
    return Damage([], {task: files for task, files in found.items() if files}, pending)


def restore(path: Path, *, trust: bool = False) -> list[str]:
    """Compute again what of a store is damaged; return the files that were.

    Raises
    ------
    ResultError
        If it cannot be computed again, or another version wrote it.
    """
    found, files = damage_of(path), []
    if not found.files:
        return []
    group = group_at(path, "r")
    if group.attrs.get("stiction_version") != version():
        wrote = group.attrs.get("stiction_version")
        raise ResultError(f"{path}: stiction {wrote} wrote it, this is {version()}; use that one")
    study = Study.from_json(str(group.attrs["description"]), trust=trust)
    if found.head:
        _restore_head(study, path, found.head)
        files, found = [*found.head], damage_of(path)
    if found.blocks:
        _restore_blocks(study, store_at(path, "r+"), [*found.blocks])
    return [*files, *found.files]


def _restore_head(study: Study, path: Path, names: Sequence[str]) -> None:
    """Write again what was written when the store was made."""
    with workshop(path.parent) as room:
        fresh = lay_out(study, room / "store")
        files = {name for name in (*names, seal.ROOT) if (fresh / name).is_file()}
        place({fresh / name: path / name for name in sorted(files)})
    if left := seal.broken(path):
        raise ResultError(f"{path}: {', '.join(left)} cannot be made again; do the study anew")


def _restore_blocks(study: Study, store: Store, tasks: Sequence[int]) -> None:
    """Do blocks again."""
    for task in tasks:
        store.mark(store.layout.region(task)).unlink()
    do(study, store, tasks, None, None)


def stores_in(path: Path) -> list[Path]:
    """Return a store, and those of its refinement."""
    return [path, *sorted(path.glob(f"{REFINED}/*/*.zarr"))]
