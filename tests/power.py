"""A disk that loses unsynced data, to show which states of a folder a power cut may leave.

Between any two calls that sync or rename, a file system may have written none of what is not
synced, or all of it, or names without content, of length zero or full of zeros. Each of these is a
state that the folder may be found in afterwards: what ALICE (Pillai et al., OSDI 2014) and
CrashMonkey (Mohan et al., OSDI 2018) do with block devices, here with calls of the system.
"""

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from stat import S_ISDIR

import pytest

from stiction.storage import files

State = dict[str, bytes | None]  # content by path; None for a folder


class Disk:
    """Watches a folder, and notes the states that a power cut may leave it in."""

    def __init__(self, root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.root, self.open = root, []
        self.states: list[State] = []
        self.content: dict[int, bytes] = {}  # of files, and of folders, by number: as written
        self.names: dict[int, dict[str, int]] = {}
        for each in (root, *root.rglob("*")):
            self._note_content(os.open(each, os.O_RDONLY))
        monkeypatch.setattr(files, "AT_ONCE", 1)  # one after the other: always in the same order
        for call in ("fsync", "replace"):
            monkeypatch.setattr(os, call, self._watch(getattr(os, call)))

    def _watch(self, call: Callable) -> Callable:
        def watched(*arguments):
            self.look()
            call(*arguments)
            if isinstance(arguments[0], int):
                self._note_content(os.dup(arguments[0]))
            self.look()

        return watched

    def _note_content(self, handle: int) -> None:
        """Note what is on the disk; the file stays open, so that no other takes its number."""
        self.open.append(handle)
        found = os.fstat(handle)
        if S_ISDIR(found.st_mode):
            self.names[found.st_ino] = {each.name: each.inode() for each in os.scandir(handle)}
        else:
            self.content[found.st_ino] = os.pread(handle, found.st_size, 0)

    def look(self) -> None:
        """Note the states that the folder may be found in now.

        Files are written in several threads: one that was listed may have another name by the time
        that it is read. Then all is looked at again.
        """
        while True:
            with suppress(FileNotFoundError):
                return self._look()

    def _look(self) -> None:
        lost: State = {}
        self._collect(self.root.stat().st_ino, "", lost)
        now = {each: each.stat() for each in self.root.rglob("*")}
        named, zeroed, all_there = {}, {}, {}
        for each, found in now.items():
            name = str(each.relative_to(self.root))
            if S_ISDIR(found.st_mode):
                named[name] = zeroed[name] = all_there[name] = None
            else:
                all_there[name] = each.read_bytes()
                kept = self.content.get(found.st_ino, b"")
                named[name] = kept
                zeroed[name] = kept or bytes(len(all_there[name]))
        for state in (lost, named, zeroed, all_there):
            if state not in self.states:
                self.states.append(state)

    def _collect(self, number: int, at: str, state: State) -> None:
        """Collect what is on the disk of a folder."""
        for name, inside in self.names.get(number, {}).items():
            path = os.path.join(at, name)
            state[path] = self.content.get(inside, b"" if inside not in self.names else None)
            self._collect(inside, path, state)

    def close(self) -> None:
        """Let the files go."""
        for handle in self.open:
            os.close(handle)


def put(state: State, folder: Path) -> None:
    """Make a folder as it was found."""
    for name, content in state.items():
        if content is None:
            (folder / name).mkdir(parents=True, exist_ok=True)
        else:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(content)
