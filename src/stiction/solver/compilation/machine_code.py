"""Cache of machine code on disk, shared by processes.

numba's own cache goes by the path and date of each source file, in an index that it unpickles
unchecked: two copies of the package compile everything twice, and a damaged file stops every run.
Here the name of a file is a hash of everything that its code depends on. A file is read only if its
checksum is right and nobody else can have written it. In all other cases the code is compiled anew.
"""

from __future__ import annotations

import atexit
import builtins
import hashlib
import logging
import os
import pickle
import re
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from functools import cache
from inspect import getfile
from multiprocessing import parent_process
from pathlib import Path
from typing import Any, cast

import numba
from numba.core import compiler, types
from numba.core.registry import cpu_target
from numba.core.runtime import nrt
from numba.core.serialize import dumps as _dumps
from numba.core.sigutils import normalize_signature as _normalize
from platformdirs import user_cache_path

from stiction.errors import ResultError
from stiction.solver.compilation.turn import take_turn
from stiction.storage.files import whole

context: Any = cpu_target.target_context
rtsys: Any = nrt.rtsys
rebuild: Any = compiler.CompileResult._rebuild
dumps: Any = _dumps
normalize_signature: Any = _normalize

log = logging.getLogger(__name__)

CHECKSUM = 32  # bytes of a SHA-256 digest, before the code itself
ROOMS = ("drive", "friction", "solver")  # whose parts are compiled into many functions
WAYS = {  # the solver of a room, where it needs a name beside the one that takes each step
    "multiscale": " over many periods at once",
    "smooth": " with internal states",
}
FOLDERS = 6  # versions of the package whose code is kept, the last used ones
IMPORTED = time.time()  # s: later edits of the sources are not in what this process compiles


class Shelf:
    """The machine code of one function, with the interface of numba's caches.

    Parameters
    ----------
    function
        The Python function.
    own
        Digest of the user's law for which it is compiled; "" for the package's own laws.
    counts
        Whether numba counts who keeps an array, as it must where arrays are made.
    """

    def __init__(self, function: Callable[..., Any], own: str = "", *, counts: bool = True) -> None:
        """Store the function, the digest of the user's law, and whether arrays are counted."""
        self._own, self.counts = own, counts
        self._name = f"{function.__module__}.{function.__qualname__}"
        digest = hashlib.sha256(Path(getfile(function)).read_bytes())
        for called in function.__globals__.values():
            if isinstance(shelf := getattr(called, "_cache", None), Shelf):
                digest.update(shelf._made_from.encode())
        self._made_from: str = digest.hexdigest() + own

    @property
    def cache_path(self) -> str:
        """Return the folder, for numba's statistics."""
        return str(folder())

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return the code for a signature, or None if it is missing or damaged."""
        path = self._path(signature, context.codegen())
        code = _read_code(path)
        if code is None:
            if solver := _in_words(self._name, signature):  # others take less than a second
                _inform(f"compiling {solver}, once")
            take_turn(path)
            code = _read_code(path)
        if code is None:
            return None
        if self._own:
            context.refresh()  # whatever a user's law calls, of NumPy's linear algebra for example
        if self.counts:
            rtsys.initialize(context)  # all else that the package's own code calls
        return rebuild(context, *pickle.loads(code))

    def save_overload(self, signature: Any, result: Any) -> None:
        """Store compiled code; if this fails, the next process compiles anew."""
        if result.lifted or result.library.has_dynamic_globals:
            return  # the code contains addresses of this process
        if _stale():
            return
        code = dumps(result._reduce())
        path = self._path(signature, result.codegen)
        with suppress(ResultError), whole(path) as part:
            part.write_bytes(hashlib.sha256(code).digest() + code)

    def holds(self, kinds: tuple[Any, ...]) -> bool:
        """Return whether there is code for arguments of some types."""
        return self._path(kinds, context.codegen()).exists()

    def flush(self) -> None:
        """Do nothing: code that is named after its origin is never out of date."""

    def _path(self, signature: Any, codegen: Any) -> Path:
        arguments, _ = normalize_signature(signature)
        origin = (self._name, self._made_from, [*map(_full_name, arguments)], codegen.magic_tuple())
        return folder() / f"{self._name}-{hashlib.sha256(repr(origin).encode()).hexdigest()}.code"


def _read_code(path: Path) -> bytes | None:
    """Return the code in a file; discard a damaged file."""
    try:
        content = path.read_bytes()
    except OSError:
        return None
    checksum, code = content[:CHECKSUM], content[CHECKSUM:]
    if hashlib.sha256(code).digest() == checksum:
        return code
    path.unlink(missing_ok=True)
    return None


def _in_words(name: str, signature: Any) -> str:
    """Return a solver with the drive and load of its signature in words; "" for other functions."""
    names = dict.fromkeys(each for kind in signature for each in _class_names(kind))
    if not names:
        return ""
    way = next((words for room, words in WAYS.items() if room in name.split(".")), "")
    drives = (re.sub(r"(?<=[a-z])(?=[A-Z])", " ", each).lower() for each in names)
    return f"the solver{way} for {' and '.join(drives)}"


def _inform(text: str) -> None:
    """Log a text, and print it for a user who waits for the first run, and has set no level.

    That is a user at a terminal or in a notebook; scripts that run by themselves stay silent.
    """
    log.info(text)
    levels = (logging.getLogger(name).level for name in ("stiction", log.name))
    if log.isEnabledFor(logging.INFO) or any(levels) or parent_process() is not None:
        return
    if hasattr(builtins, "__IPYTHON__") or (sys.stderr is not None and sys.stderr.isatty()):
        print(f"stiction: {text}", file=sys.stderr, flush=True)


def _class_names(kind: Any) -> Iterator[str]:
    if isinstance(kind, types.BaseTuple):
        made_by = getattr(kind, "instance_class", tuple)
        if made_by.__module__.startswith("stiction.drive"):
            yield made_by.__name__
        for part in cast(Iterable[Any], kind):
            yield from _class_names(part)


def _full_name(kind: Any) -> str:
    """Return a type in full: numba names a tuple by its class, without the module."""
    if isinstance(kind, types.CPointer):
        return f"{_full_name(kind.dtype)}*"
    if not isinstance(kind, types.BaseTuple):
        return str(kind)
    made_by, parts = getattr(kind, "instance_class", tuple), cast(Iterable[Any], kind)
    return f"{made_by.__module__}.{made_by.__qualname__}({', '.join(map(_full_name, parts))})"


@cache
def folder() -> Path:
    """Return the folder for this version of the package: a private one.

    It lies below ``NUMBA_CACHE_DIR`` if that is set, else below the user's cache. Its content is
    run: if others may write to it, or nobody may, this process uses a temporary folder of its own.
    So it does if the sources have been edited since it imported them.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else user_cache_path("stiction")
    try:
        place = root / f"compiled-{fingerprint()}"
        if not place.exists():
            root.mkdir(parents=True, exist_ok=True)
            _prune(root)
            place.mkdir(mode=0o700, exist_ok=True)
        if _private(place) and not _stale():
            os.utime(place)  # removed last
            return place
    except OSError:
        pass
    alone = tempfile.mkdtemp(prefix="stiction-")
    atexit.register(shutil.rmtree, alone, ignore_errors=True)
    return Path(alone)


def _private(place: Path) -> bool:
    """Return whether a folder is this user's, and only this user may write to it."""
    if not hasattr(os, "getuid"):  # Windows: a user's folders are private
        return os.access(place, os.W_OK)
    found = place.lstat()
    own = stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid()
    return own and not found.st_mode & 0o022 and os.access(place, os.W_OK)


def _prune(root: Path) -> None:
    """Remove the code of all versions but the last used ones, to make room for one more."""
    versions = sorted(root.glob("compiled-*"), key=lambda each: each.lstat().st_mtime)
    for old in versions[: len(versions) - FOLDERS + 1]:
        shutil.rmtree(old, ignore_errors=True)


@cache
def fingerprint() -> str:
    """Return a hash of every compiled source file, and of the compiler.

    An edit in any of them leads to a new folder, because one compiled function contains code of
    many files.
    """
    digest = hashlib.sha256(f"{sys.implementation.cache_tag} {numba.__version__}".encode())
    for file in _sources():
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def _stale() -> bool:
    """Return whether a source was edited, or another version installed, after the import."""
    try:
        found = [file.stat() for file in _sources()]
    except OSError:  # one of them is being exchanged
        return True
    return any(max(each.st_mtime, each.st_ctime) > IMPORTED for each in found)


def _sources() -> list[Path]:
    """Return the files from which the parts of compiled functions come."""
    package = Path(__file__).parent.parent.parent
    files = [file for room in ROOMS for file in sorted((package / room).rglob("*.py"))]
    return [file for file in files if file.stem != "reference"]  # that is plain Python
