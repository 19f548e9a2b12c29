"""A law of the user's own, named by file and class: ``mylaw.py:MyLaw``.

A description runs the file that it names, as a script would be run. A result is data: reading
it back runs nothing but what this process has run already, or a file that is there and says
the same as what the result holds. Only one who trusts a result has the text in it run.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from stiction.errors import DescriptionError
from stiction.friction.kinds import fault, law_in, tried
from stiction.friction.source import Text, member, module_name, module_of, read, text_of
from stiction.validation import made

# from a law's name and the text kept with it, if any, to the class
Find = Callable[[str, str | None], type[Any]]


def named(*folders: Path) -> Find:
    """Return how a description's law is found: its file is looked for in folders, and run."""

    def find(name: str, text: str | None) -> type[Any]:
        if text is not None:  # not written by hand
            return kept(*folders)(name, text)
        file, kind = split(name)
        for path in places(file, folders):
            return law_in(run(Text(_relative(file), _read(path)), str(path)), kind, name)
        looked = ", ".join(dict.fromkeys(str(folder) for folder in folders)) or "no folder"
        raise fault(f"no file {file!r} in {looked}; write its path from there")

    return find


def kept(*folders: Path) -> Find:
    """Return how the law of a result is found: nothing is run that is not there already."""

    def find(name: str, text: str | None) -> type[Any]:
        file, kind = split(name)
        if text is None:
            raise fault(
                f"the text of {name!r} was not kept: it stood in a prompt, or its file was edited "
                "after it was imported; write the law in a file, and describe or import it anew; "
                "the arrays can be read with xarray.open_dataset"
            )
        for candidate in loaded(file, kind, text):
            return candidate
        there = [path for path in places(file, folders) if _read(path) == text]
        for path in there:
            return law_in(run(Text(_relative(file), text), str(path)), kind, name)
        raise fault(
            f"{name!r} is a law of one's own, and no {file} with the text that was run is here; "
            "put it beside the result or in the working folder, or import its module first; or, "
            "if you trust where this comes from, run the text kept in it: "
            "st.load(path, trust=True), stiction plot --trust; the arrays can be read without "
            "it: xarray.open_dataset"
        )

    return find


def trusted(*folders: Path) -> Find:
    """Return how the law of a trusted result is found: if need be, the text in it is run."""

    def find(name: str, text: str | None) -> type[Any]:
        file, kind = split(name)
        try:
            return kept(*folders)(name, text)
        except DescriptionError:
            if text is None:
                raise
            return law_in(run(Text(_relative(file), text), f"<{file}>"), kind, name)

    return find


def read_own(table: dict[str, Any], find: Find) -> Any:
    """Make a law from a table [friction] that names a file and a class."""
    name, text = table.pop("law"), table.pop("source", None)
    if not isinstance(text, str | None):
        raise fault(f"must be text, is {text!r}; leave it out", "source")
    return tried(made(find(name, text), table), name)


def own_table(law: Any) -> dict[str, Any]:
    """Return how a law of the user's own is kept: its name and its text."""
    kind = type(law)
    text = text_of(kind)
    if text is None:
        return {"law": f"{kind.__module__}:{kind.__qualname__}"}
    return {"law": f"{text.name}:{kind.__qualname__}", "source": text.text}


def split(name: str) -> tuple[str, str]:
    """Return file and class of ``file:class``."""
    file, _, kind = name.rpartition(":")
    if not file or not kind:
        raise fault(f"{name!r} must name a file and a class in it; write 'mylaw.py:MyLaw'")
    return file, kind


def places(file: str, folders: tuple[Path, ...]) -> Iterator[Path]:
    """Yield the files of that name that are there."""
    for folder in dict.fromkeys(folders):
        if (folder / file).is_file():
            yield (folder / file).absolute()


def loaded(file: str, kind: str, text: str) -> Iterator[type[Any]]:
    """Yield the classes of that name that this process has from the same text."""
    ours, base = module_name(Text(file, text)), Path(file).name
    for name, module in list(sys.modules.items()):
        own = vars(module).get("__file__") if isinstance(module, ModuleType) else None
        if name in (ours, "__main__") or (isinstance(own, str) and Path(own).name == base):
            found = member(module, kind)
            known = text_of(found) if inspect.isclass(found) else None
            if known is not None and known.text == text:
                yield found


def run(text: Text, path: str) -> ModuleType:
    """Run a text; what it raises becomes one line."""
    try:
        return module_of(text, path)
    except (Exception, SystemExit) as error:
        what = f"{type(error).__name__}: {error}".splitlines()[0]
        raise fault(f"{path} cannot be run: {what}") from None


def _read(path: Path) -> str:
    try:
        return read(path)
    except (OSError, SyntaxError, UnicodeDecodeError) as error:
        raise fault(f"{path} cannot be read: {error}") from None


def _relative(file: str) -> str:
    """Return a path to keep: one that means something elsewhere."""
    return Path(file).name if Path(file).is_absolute() else file
