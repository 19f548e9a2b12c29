"""Loading of a user's law, named by file and class: ``mylaw.py:MyLaw``; see `own_code.loading`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from stiction.errors import echo
from stiction.friction.user.validation import fault, is_law, law_in, try_law
from stiction.own_code.identity import differences, values_outside
from stiction.own_code.loading import (
    Role,
    errors_as_faults,
    loaded_classes,
    module_in_folder,
    module_of_text,
    split,
)
from stiction.own_code.source import text_of
from stiction.text.suggestion import TRUST
from stiction.text.validation import make

# from a law's name, and its text if stored, to the class
Find = Callable[[str, str | None], type[Any]]
LAW = Role("friction.law", "law", "class", "mylaw.py:MyLaw")


def finder_for_descriptions(folder: Path, trust: bool = False) -> Find:
    """Return a finder for laws of descriptions: it runs a file that lies in `folder`.

    With `trust` the file may lie anywhere.
    """

    def find(name: str, text: str | None) -> type[Any]:
        if text is not None:  # stored by a program, not written by hand
            return finder_for_results(trust)(name, text)
        file, kind = split(name, LAW)
        return law_in(module_in_folder(file, folder, trust, LAW), kind, name)

    return find


def finder_for_results(trust: bool = False) -> Find:
    """Return a finder for laws of results: it runs nothing unless `trust` is given."""

    def find(name: str, text: str | None) -> type[Any]:
        file, kind = split(name, LAW)
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
            return law_in(module_of_text(file, text, LAW), kind, name)
        raise fault(
            f"{echo(name)} is a user's law, and the code stored with it is not run without "
            f"permission: if you trust the source, allow it: {TRUST}; in Python you may import its "
            "module first instead; the arrays can be read without it: xarray.open_dataset"
        )

    return find


def read_own(table: dict[str, Any], find: Find) -> Any:
    """Make a law from a table [friction] that names a file and a class."""
    name, text, then = table.pop("law"), table.pop("source", None), table.pop("reads", None)
    if not isinstance(text, str | None):
        raise fault(f"must be text, is {echo(text)}; leave it out", "source")
    if not isinstance(then, dict | None):
        raise fault(f"must be a table, is {echo(then)}; leave it out", "reads")
    kind = find(name, text)
    with errors_as_faults(f"{echo(name)} cannot be made", LAW):
        law = try_law(make(kind, table), name)
    if then is not None and (said := differences(then, values_outside(kind))):
        raise fault(f"{echo(name)} reads what has changed since it was stored: {said}", "reads")
    return law


def is_own(table: Any) -> bool:
    """Return whether a table [friction] names a file that must be run."""
    name = table.get("law") if isinstance(table, dict) else None
    return isinstance(name, str) and ":" in name


def own_table(law: Any) -> dict[str, Any]:
    """Return a user's law as a table [friction]: its name, its text, and the values it reads."""
    kind = type(law)
    text, reads = text_of(kind), values_outside(kind)
    if text is None:
        return {"law": f"{kind.__module__}:{kind.__qualname__}", "reads": reads}
    return {"law": f"{text.name}:{kind.__qualname__}", "source": text.text, "reads": reads}
