"""Reading a description's tables, and gathering the faults of all of them."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

from stiction.errors import DescriptionError, Fault
from stiction.paths import with_changes
from stiction.validation import unknown

Reader = Callable[[dict[str, Any]], Any]


def read_toml(path: str | Path, changes: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Read a TOML file, with other values of some parameters.

    Parameters
    ----------
    path : str or Path
        The file.
    changes : mapping, optional
        For the path of a parameter (see `stiction.paths`) its value.

    Raises
    ------
    DescriptionError
        Saying why the file cannot be read, or which parameter is none.
    """
    try:
        raw = tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
        return with_changes(raw, changes) if changes else raw
    except OSError as error:
        message = f"{error.strerror or 'cannot be read'}; write a description with 'stiction init'"
    except UnicodeDecodeError:
        message = "is not text in UTF-8; write a description with 'stiction init'"
    except tomllib.TOMLDecodeError as error:
        unquoted = (
            "; a value with a unit goes in quotes" if "Expected newline" in str(error) else ""
        )
        message = f"is not TOML: {error}{unquoted}"
    raise DescriptionError([Fault(str(path), message)])


def gather(
    raw: Mapping[str, Any],
    readers: Mapping[str, Reader],
    optional: Collection[str] = (),
    absent: Collection[str] = (),
) -> dict[str, Any]:
    """Read every table with its reader.

    A table that is not there is an error, or read as an empty one if it is `optional`, or
    left out of what is returned if it may be `absent`.

    Raises
    ------
    DescriptionError
        With every fault in every table, each below the table's name.
    """
    found = [Fault(name, unknown("table", name, readers)) for name in raw if name not in readers]
    parts: dict[str, Any] = {}
    for name, read in readers.items():
        if name in absent and name not in raw:
            continue
        table = raw.get(name, {} if name in optional else None)
        if table is None:
            found.append(Fault(name, f"missing; write a table [{name}]"))
        elif not isinstance(table, Mapping):
            found.append(Fault(name, f"must be a table [{name}], is {table!r}"))
        else:
            try:
                parts[name] = read(dict(table))
            except DescriptionError as error:
                found += [
                    Fault(".".join([name, *fault.path.split(".")[1:]]), fault.message)
                    for fault in error.faults
                ]
    if found:
        raise DescriptionError(found)
    return parts


def choose(
    table: dict[str, Any], key: str, known: Mapping[str, type[Any]], default: str | None = None
) -> Any:
    """Make the kind of law or drive that ``table[key]`` names, from the rest of the table."""
    name = table.pop(key, default)
    if not isinstance(name, str) or name not in known:
        listed = f"missing; known: {', '.join(known)}"
        message = listed if name is None else unknown(key, str(name), known)
        raise DescriptionError([Fault(f"table.{key}", message)])
    return known[name](**table)
