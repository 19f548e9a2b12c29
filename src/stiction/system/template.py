"""A commented description as a starting point."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path

from stiction.errors import StictionError
from stiction.friction.registry import LAWS
from stiction.storage.files import whole
from stiction.system.schema import schema as description_schema
from stiction.text.suggestion import Suggestion
from stiction.text.units import hints_of, unit_of

SCHEMA = "stiction.schema.json"
BY_SCHEMA = f"#:schema {SCHEMA}\n"  # as editors of TOML understand it


def template_text() -> str:
    """Return a commented description of the paper's apparatus."""
    text = files("stiction").joinpath("template.toml").read_text(encoding="utf-8")
    return text.replace("# {laws}\n", "".join(map(_law_lines, LAWS)))


def write_description(
    path: str | Path, text: str, *, force: bool = False, schema: bool = False
) -> Path:
    """Write a description to a new file; see `stiction.init` for the arguments."""
    target = Path(path)
    if target.is_dir():
        raise StictionError(f"{target} is a folder; name a file in it")
    if not target.parent.is_dir():
        raise StictionError(f"{target}: folder {target.parent} does not exist; make it first")
    if schema:
        with whole(target.with_name(SCHEMA)) as part:
            part.write_text(json.dumps(description_schema(), indent=1) + "\n", encoding="utf-8")
        if target.exists() and not force:
            return target
    if target.exists() and not force:
        raise StictionError(
            f"{target} exists already; choose another name, or overwrite it with "
            f"{Suggestion('force', True, of='')}"
        )
    with whole(target) as part:
        part.write_text(BY_SCHEMA * schema + text, encoding="utf-8")
    return target


def _law_lines(name: str) -> str:
    """Return a law as a comment: its name, its description, and its parameters."""
    kind = LAWS[name]
    hints = hints_of(kind)
    takes: dict[bool, list[str]] = {True: [], False: []}
    for field in kind._fields:
        its = unit_of(hints.get(field))
        takes[field not in kind._field_defaults].append(f"{field} ({its})" if its else field)
    optional = f"; if you like {', '.join(takes[False])}" if takes[False] else ""
    what = str(kind.__doc__).splitlines()[0]
    return f'# law = "{name}"\n#     {what}\n#     takes {", ".join(takes[True])}{optional}\n'
