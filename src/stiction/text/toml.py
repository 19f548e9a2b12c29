"""Reading of a description's tables, with the faults of all of them."""

from __future__ import annotations

import codecs
import errno
import json
import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from stiction.errors import DescriptionError, Fault, Instruction, echo, without_middle
from stiction.storage.kinds import DESCRIPTION, STUDY, use_of
from stiction.text.paths import keys_of, with_changes
from stiction.text.validation import unknown_name

Reader = Callable[[dict[str, Any]], Any]
LONGEST_PATH = 240  # characters of a path in a message
LARGEST_FILE = 2**24  # bytes of a description: a table of a million values
DEEPEST = 16  # tables and lists inside one another; descriptions have five
TOO_DEEP = f"is nested more deeply than {DEEPEST} levels; descriptions are not"
BITS = 64  # of an integer, as TOML has it
WRITE = Instruction(
    "write a description with 'stiction init'", "st.init(path) writes a description"
)
AT_LINE = re.compile(r"\(at line (\d+), ")
MISWRITTEN = {  # a number of other programs or languages, and how TOML has it
    re.compile(r"=\s*[-+]?\d+,\d"): "the decimal sign is a point: 0.4",
    re.compile(r"=\s*[-+]?\.\d"): "a digit stands before the point: 0.4",
    re.compile(r"=\s*[-+]?\d+\.(?!\d)"): "a digit stands after the point: 1.0",
}
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
OF_STUDIES = ("axes", "study")  # tables of a description that is swept
OF_RUNS = ("initial", "run", *OF_STUDIES)  # tables beside those of a slider


def read_changed(
    path: str | Path, changes: Mapping[str, Any] | None
) -> tuple[dict[str, Any], list[Fault]]:
    """Read a TOML file or text as `read_toml` does, and change some parameters.

    Parameters
    ----------
    path : str or Path
        The file, or the text.
    changes : mapping or None
        From the path of a parameter (see `stiction.text.paths`) to its value.

    Returns
    -------
    tuple
        The tables, and a fault for each parameter that does not exist.

    Raises
    ------
    DescriptionError
        If the file cannot be read, or a value is nested too deeply.
    """
    raw, lost = with_changes(read_toml(path), changes or {})
    return tame(raw, "the changes"), lost


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read a TOML file, or a TOML text of several lines.

    Raises
    ------
    DescriptionError
        If the file cannot be read, or `path` is not a path.
    """
    if not isinstance(path, str | PathLike):
        message = f"{type(path).__name__} is not a description; give its file, or its text in TOML"
        raise DescriptionError.of("path", message)
    written = isinstance(path, str) and "\n" in path
    where = "the text" if written else without_middle(str(path), LONGEST_PATH)
    text = str(path) if written else ""
    try:
        text = text or _text_of(Path(path))
        raw = tomllib.loads(text)
    except RecursionError:
        message = TOO_DEEP
    except OSError as error:
        message = f"{error.strerror or 'cannot be read'}; {_instead(path, written) or WRITE}"
    except UnicodeDecodeError as error:
        message = f"is not text in UTF-8; {_instead(path, written) or _encoding(error.object)}"
    except ValueError as error:  # invalid TOML, and integers of thousands of digits
        use = _instead(path, written)
        message = f"is not TOML: {error}{_remedy(error, text)}{use and f'; {use}'}"
    else:
        return tame(raw, where)
    raise DescriptionError.of(where, message)


def _encoding(content: bytes) -> str:
    """Return the remedy for a file that is not UTF-8."""
    if content.startswith(UTF_16) or 0 in content[:2]:
        return "it is UTF-16, as Windows programs write it: save it in UTF-8"
    return str(WRITE) if 0 in content else "if a text editor shows it, save it in UTF-8"


def _remedy(error: ValueError, text: str) -> str:
    """Return the correct form of a line that TOML does not read, as far as the line shows it."""
    place = AT_LINE.search(str(error))
    line = text.split("\n")[int(place[1]) - 1] if place else ""
    for pattern, remedy in MISWRITTEN.items():
        if pattern.search(line):
            return f"; {remedy}"
    return "; a value with a unit goes in quotes" if "Expected newline" in str(error) else ""


def _instead(path: str | Path, written: bool) -> str:
    """Return the command for a file that is not a description."""
    return "" if written else use_of(path, DESCRIPTION, STUDY)


def read_json(text: str) -> dict[str, Any]:
    """Return the tables of a JSON text.

    Raises
    ------
    DescriptionError
        If it has none.
    """
    try:
        raw = json.loads(text)
    except (ValueError, RecursionError, TypeError) as error:
        raise DescriptionError.of("description", f"is not JSON: {error}") from None
    if not isinstance(raw, dict):
        raise DescriptionError.of("description", f"must be tables, is {echo(raw)}")
    return tame(raw, "description")


def tame(raw: dict[str, Any], where: str) -> dict[str, Any]:
    """Return tables, if they are small enough to process.

    Raises
    ------
    DescriptionError
        If they are nested too deeply, or hold integers of more than 64 bits.
    """
    level: list[tuple[str, Any]] = list(raw.items())
    found = []
    for _ in range(DEEPEST):
        inside: list[tuple[str, Any]] = []
        for path, value in level:
            if isinstance(value, dict | list):
                parts = value.items() if isinstance(value, dict) else enumerate(value, 1)
                inside += [(f"{path}.{key}", each) for key, each in parts]
            elif isinstance(value, int) and value.bit_length() > BITS:
                found.append(Fault(path, f"an integer has at most {BITS} bits; write it as 1e30"))
        level = inside
    if level:
        found.append(Fault(where, TOO_DEEP))
    if found:
        raise DescriptionError(found)
    return raw


def _text_of(path: Path) -> str:
    """Return the text of a file, if it is not larger than a description may be."""
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except ValueError as error:  # a name with a zero in it
        raise OSError(str(error)) from None
    if len(content) > LARGEST_FILE:
        raise OSError(errno.EFBIG, f"has more than {LARGEST_FILE:,} bytes")
    if 0 in content[:2]:  # UTF-16 without a mark at its beginning
        raise UnicodeDecodeError("utf-8", content, 0, 2, "a character has two bytes")
    return content.decode("utf-8-sig")


def folder_of(path: str | Path) -> Path:
    """Return the folder of a file that `read_toml` reads; for a text, the working one."""
    if not isinstance(path, str | Path) or "\n" in str(path):
        return Path()  # of what is neither, `read_toml` says so
    return Path(path).parent


def toml_text(tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Return tables as TOML; they hold numbers, texts, lists and tables of these."""
    parts = []
    for name, table in tables.items():
        lines = [f"{key} = {_value(value)}" for key, value in table.items()]
        parts.append("\n".join([f"[{name}]", *lines]) + "\n")
    return "\n".join(parts)


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_value(each)}' for key, each in value.items())} }}"
    if isinstance(value, list | tuple):
        items = [_value(each) for each in value]
        if any(isinstance(each, Mapping) for each in value):
            return "[\n" + "".join(f"    {item},\n" for item in items) + "]"
        return f"[{', '.join(items)}]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return str(value).lower() if isinstance(value, bool) else repr(value)


def _tables_in(table: Any, names: Iterable[str]) -> Iterator[str]:
    """Yield which of some names a table has as tables within it: ``[slider.friction]``."""
    if isinstance(table, Mapping):
        yield from (name for name in names if isinstance(table.get(name), Mapping))


def read_slider(
    path: str | Path, changes: Mapping[str, Any] | None
) -> tuple[dict[str, Any], list[Fault]]:
    """Read a slider as `read_changed` does, without tables of runs; refuse changes of these."""
    raw, faults = read_changed(path, changes)
    lost = {fault.path for fault in faults}
    idle = [name for name in changes or () if name not in lost and keys_of(raw, name)[0] in OF_RUNS]
    faults += [Fault(name, "has no effect: only a run reads it; take it out") for name in idle]
    return {name: table for name, table in raw.items() if name not in OF_RUNS}, faults


def _strange(name: str, readers: Mapping[str, Reader]) -> str:
    """Return the fault of a table without a reader."""
    if name in OF_STUDIES:
        reader = Instruction("'stiction sweep' runs", "st.Study.from_toml reads")
        return f"is a table of a study, which {reader}; take it out for a single run"
    return unknown_name("table", name, readers)


def gather(
    raw: Mapping[str, Any],
    readers: Mapping[str, Reader],
    optional: Collection[str] = (),
    absent: Collection[str] = (),
    last: Collection[str] = (),
    known: Sequence[Fault] = (),
) -> dict[str, Any]:
    """Read every table with its reader.

    A missing table is an error, unless it is `optional` (then it is read as an empty one) or may
    be `absent` (then it is left out). Tables that come `last`, because they run a user's code, are
    read only if no other table has a fault and there is no `known` one.

    Raises
    ------
    DescriptionError
        With the known faults, then those of every table, each below the table's name.
    """
    found = [*known]
    strange = [name for name in raw if name not in readers]
    found += [Fault(name or '""', _strange(name, readers)) for name in strange]
    inner = {name: [*_tables_in(raw.get(name), readers)] for name in readers}
    found += [
        Fault(f"{name}.{each}", f"is a table of its own; write [{each}]")
        for name, names in inner.items()
        for each in names
    ]
    elsewhere = {each for names in inner.values() for each in names}
    parts: dict[str, Any] = {}
    for name, read in sorted(readers.items(), key=lambda item: item[0] in last):
        if (name in absent and name not in raw) or (name in last and found):
            continue
        table = raw.get(name, {} if name in optional else None)
        if table is None:
            if name not in elsewhere:
                found.append(Fault(name, f"missing; write a table [{name}]"))
        elif not isinstance(table, Mapping):
            found.append(Fault(name, f"must be a table [{name}], is {echo(table)}"))
        else:
            try:
                parts[name] = read({k: v for k, v in table.items() if k not in inner[name]})
            except DescriptionError as error:
                found += error.at(name).faults
    if found:
        raise DescriptionError(found)
    return parts


def choose(table: dict[str, Any], key: str, known: Mapping[str, type[Any]]) -> Any:
    """Make the law or drive that ``table[key]`` names from the rest of the table."""
    name = table.pop(key, None)
    if not isinstance(name, str) or name not in known:
        listed = f"missing; known: {', '.join(known)}"
        message = listed if name is None else unknown_name(key, str(name), known)
        raise DescriptionError.of(f"table.{key}", message)
    return known[name](**table)
