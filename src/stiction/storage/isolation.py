"""Reading in a separate process, so that a damaged file cannot crash or hang this one.

HDF5 trusts the sizes that a file states: in some damaged files it reads without end.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from math import ceil
from pathlib import Path
from signal import Signals
from typing import TypeVar

from stiction.errors import ResultError, StictionError, one_line

try:
    import resource
    from signal import SIGXCPU
except ImportError:  # Windows: wall-clock seconds there
    resource = None  # type: ignore[assignment]

ENDLESS = "reading it does not end"
CHILD = "from stiction.storage.isolation import answer; answer()"
PATIENCE, PER_BYTE = 30.0, 1e-6  # processor time, s: for any file, and for each byte; ample

T = TypeVar("T")


def apart(work: Callable[[str], T], path: str | Path) -> T:
    """Call a function on a file in another process; return its result, as JSON has it.

    Raises
    ------
    ResultError
        If the function raises one, or its process crashes or does not end.
    """
    seconds = ceil(PATIENCE + PER_BYTE * os.path.getsize(path))
    # -P: import nothing from the working folder
    command = [sys.executable, "-P", "-c", CHILD, work.__module__, work.__qualname__, str(path)]
    try:
        done = subprocess.run(
            [*command, str(seconds)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=seconds if resource is None else None,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise _damage_error(path, ENDLESS) from None
    if resource is not None and done.returncode == -SIGXCPU:
        raise _damage_error(path, ENDLESS)
    if done.returncode:
        raise _damage_error(path, f"reading it ends in {_name(done.returncode)}")
    refused, answered = json.loads(done.stdout)
    if refused:
        raise ResultError(answered)
    returned: T = answered
    return returned


def answer() -> None:
    """Call the function that `apart` names, and write out its result or error."""
    module, name, path, seconds = sys.argv[1:]
    if resource is not None:
        most = resource.getrlimit(resource.RLIMIT_CPU)[1]
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), most))
    out = os.dup(sys.stdout.fileno())  # only the answer goes there
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    try:
        answered = False, getattr(import_module(module), name)(path)
    except StictionError as error:
        answered = True, str(error)
    except Exception as error:
        answered = True, f"{path}: cannot be read: {one_line(error)}"
    with open(out, "w", encoding="ascii") as pipe:
        json.dump(answered, pipe)


def _name(code: int) -> str:
    return Signals(-code).name if code < 0 else f"exit status {code}"


def _damage_error(path: str | Path, how: str) -> ResultError:
    return ResultError(f"{path}: is damaged: {how}; run it again")
