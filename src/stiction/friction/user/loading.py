"""Loading of a user's law, named by file and class: ``mylaw.py:MyLaw``.

A description runs the file that it names, like a script; the file must lie in the description's
folder, unless the user trusts it. A result is data: reading it runs nothing. Its law must have been
loaded by this process from the same text, unless the user trusts the text in the result.
"""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from stiction.errors import DescriptionError, echo, one_line
from stiction.friction.user.source import Text, member, module_name, module_of, read, text_of
from stiction.friction.user.validation import fault, is_law, law_in, try_law
from stiction.storage.foreign import is_within
from stiction.text.suggestion import TRUST
from stiction.text.validation import make

# from a law's name, and its text if stored, to the class
Find = Callable[[str, str | None], type[Any]]
LARGEST = 2**20  # bytes of a law's file


def finder_for_descriptions(folder: Path, trust: bool = False) -> Find:
    """Return a finder for laws of descriptions: it runs a file that lies in `folder`.

    With `trust` the file may lie anywhere.
    """

    def find(name: str, text: str | None) -> type[Any]:
        if text is not None:  # stored by a program, not written by hand
            return finder_for_results(trust)(name, text)
        file, kind = split(name)
        path = _there(folder, file, trust)
        return law_in(run(Text(_relative(file), _read(path)), str(path)), kind, name)

    return find


def finder_for_results(trust: bool = False) -> Find:
    """Return a finder for laws of results: it runs nothing unless `trust` is given."""

    def find(name: str, text: str | None) -> type[Any]:
        file, kind = split(name)
        if text is None:
            raise fault(
                f"the text of {echo(name)} was not stored: it came from a prompt, or its file "
                "changed "
                "after it was imported; write the law in a file, and describe or import it anew; "
                "the arrays can be read with xarray.open_dataset"
            )
        for candidate in loaded_classes(file, kind, text):
            return is_law(candidate, name)  # the file may name any module and class
        if trust:
            return law_in(run(Text(_relative(file), text), f"<{file}>"), kind, name)
        raise fault(
            f"{echo(name)} is a user's law, and the code stored with it is not run without "
            f"permission: if you trust the source, allow it: {TRUST}; in Python you may import its "
            "module first instead; the arrays can be read without it: xarray.open_dataset"
        )

    return find


def read_own(table: dict[str, Any], find: Find) -> Any:
    """Make a law from a table [friction] that names a file and a class."""
    name, text = table.pop("law"), table.pop("source", None)
    if not isinstance(text, str | None):
        raise fault(f"must be text, is {echo(text)}; leave it out", "source")
    kind = find(name, text)
    with errors_as_faults(f"{echo(name)} cannot be made"):
        return try_law(make(kind, table), name)


def is_own(table: Any) -> bool:
    """Return whether a table [friction] names a file that must be run."""
    name = table.get("law") if isinstance(table, dict) else None
    return isinstance(name, str) and ":" in name


def own_table(law: Any) -> dict[str, Any]:
    """Return a user's law as a table [friction]: its name and its text."""
    kind = type(law)
    text = text_of(kind)
    if text is None:
        return {"law": f"{kind.__module__}:{kind.__qualname__}"}
    return {"law": f"{text.name}:{kind.__qualname__}", "source": text.text}


def split(name: str) -> tuple[str, str]:
    """Return file and class of ``file:class``."""
    file, _, kind = name.rpartition(":")
    if not file or not kind:
        raise fault(f"{echo(name)} must name a file and a class in it; write 'mylaw.py:MyLaw'")
    return file, kind


def _there(folder: Path, file: str, trust: bool) -> Path:
    """Return the file of a law, links resolved, if it exists and may be run."""
    path = os.path.realpath(folder / file)
    if not trust and not is_within(folder, path):
        raise fault(
            f"{echo(file)} lies outside the folder of the description, {folder}: put the law "
            f"into it; or, if you trust who wrote this, allow it: {TRUST}"
        )
    if not os.path.isfile(path):
        raise fault(f"no file {echo(file)} in {folder}; write its path from there")
    return Path(path)


def loaded_classes(file: str, kind: str, text: str) -> Iterator[type[Any]]:
    """Yield the classes of that name that this process has loaded from the same text."""
    ours, base = module_name(Text(file, text)), Path(file).name
    for name, module in list(sys.modules.items()):
        own = vars(module).get("__file__") if isinstance(module, ModuleType) else None
        if name in (ours, "__main__") or (isinstance(own, str) and Path(own).name == base):
            found = member(module, kind)
            known = text_of(found) if inspect.isclass(found) else None
            if known is not None and known.text == text:
                yield found


def run(text: Text, path: str) -> ModuleType:
    """Run a text; turn its errors into one line."""
    with errors_as_faults(f"{path} cannot be run"):
        return module_of(text, path)


@contextmanager
def errors_as_faults(what: str) -> Iterator[None]:
    """Turn errors of a user's text into faults; an interrupt passes through."""
    try:
        yield
    except (DescriptionError, KeyboardInterrupt):
        raise
    except BaseException as error:
        raise fault(f"{what}: {one_line(error)}") from None


def _read(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST:
            raise fault(f"{path} is not a friction law: it has more than {LARGEST} bytes")
        return read(path)
    except (OSError, SyntaxError, UnicodeDecodeError) as error:
        raise fault(f"{path} cannot be read: {error}") from None


def _relative(file: str) -> str:
    """Return a relative path, which is meaningful on other machines."""
    return Path(file).name if Path(file).is_absolute() else file
