"""Loading of a user's code, named by its file and a name in it: ``mylaw.py:MyLaw``.

A description runs the file that it names, like a script; the file must lie in the description's
folder, unless the user trusts it. A result is data: reading it runs nothing. Its code must have
been loaded by this process from the same text, unless the user trusts the text in the result.
"""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from stiction.errors import DescriptionError, echo, one_line
from stiction.own_code.source import Text, member, module_name, module_of, read, text_of
from stiction.storage.foreign import is_within
from stiction.text.suggestion import TRUST

LARGEST_FILE = 2**20  # bytes of a file with code


class Role(NamedTuple):
    """The role of a user's code, for messages.

    Parameters
    ----------
    path : str
        Path of the key that names it.
    what, kind : str
        What it is in the description, and in Python.
    example : str
        A file and a name in it.
    """

    path: str
    what: str
    kind: str
    example: str

    def fault(self, message: str) -> DescriptionError:
        """Return the error for a fault in the reference to the code."""
        return DescriptionError.of(self.path, message)


def split(name: str, role: Role) -> tuple[str, str]:
    """Return file and name of ``file:name``."""
    file, _, inner = name.rpartition(":")
    if not file or not inner:
        raise role.fault(
            f"{echo(name)} must name a file and a {role.kind} in it; write {echo(role.example)}"
        )
    return file, inner


def module_in_folder(file: str, folder: Path, trust: bool, role: Role) -> ModuleType:
    """Run a file that lies in a folder, or, with `trust`, anywhere; return its module."""
    path = os.path.realpath(folder / file)
    if not trust and not is_within(folder, path):
        raise role.fault(
            f"{echo(file)} lies outside the folder of the description, {folder}: put the "
            f"{role.what} into it; or, if you trust who wrote this, allow it: {TRUST}"
        )
    if not os.path.isfile(path):
        raise role.fault(f"no file {echo(file)} in {folder}; write its path from there")
    return _run(Text(_relative(file), _read(Path(path), role)), path, role)


def module_of_text(file: str, text: str, role: Role) -> ModuleType:
    """Run the text of a file that was stored in a result; return its module."""
    return _run(Text(_relative(file), text), f"<{file}>", role)


def loaded_classes(file: str, name: str, text: str) -> Iterator[type[Any]]:
    """Yield the classes of that name that this process has loaded from the same text."""
    ours, base = module_name(Text(file, text)), Path(file).name
    for key, module in list(sys.modules.items()):
        own = vars(module).get("__file__") if isinstance(module, ModuleType) else None
        if key in (ours, "__main__") or (isinstance(own, str) and Path(own).name == base):
            found = member(module, name)
            known = text_of(found) if inspect.isclass(found) else None
            if known is not None and known.text == text:
                yield found


def _run(text: Text, path: str, role: Role) -> ModuleType:
    """Run a text; turn its errors into one line."""
    with errors_as_faults(f"{path} cannot be run", role):
        return module_of(text, path)


@contextmanager
def errors_as_faults(what: str, role: Role) -> Iterator[None]:
    """Turn errors of a user's text into faults; an interrupt passes through."""
    try:
        yield
    except (DescriptionError, KeyboardInterrupt):
        raise
    except BaseException as error:
        raise role.fault(f"{what}: {one_line(error)}") from None


def _read(path: Path, role: Role) -> str:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise role.fault(f"{path} holds no {role.what}: it has more than {LARGEST_FILE} bytes")
        return read(path)
    except (OSError, SyntaxError, UnicodeDecodeError) as error:
        raise role.fault(f"{path} cannot be read: {error}") from None


def _relative(file: str) -> str:
    """Return a relative path, which is meaningful on other machines."""
    return Path(file).name if Path(file).is_absolute() else file
