"""Directives that write tables from the package itself: keys of a description, presets, columns."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from benchmarks.cases import CASES
from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList

import stiction as st
from stiction.presets import PRESETS
from stiction.result.table import STICKS, VARIABLES
from stiction.study.variables.measures import MEASURES
from stiction.system.schema import schema


def table(headers: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    """Return the lines of a table in Markdown."""

    def line(cells: tuple[str, ...]) -> str:
        texts = (each.replace("|", "\\|").replace("\n", " ") for each in cells)
        return f"| {' | '.join(texts)} |"

    return [line(headers), line(("---",) * len(headers)), *map(line, rows)]


def directive(lines: Callable[[], list[str]]) -> type[Directive]:
    """Return a directive that parses lines of Markdown in place."""

    class Written(Directive):
        def run(self) -> list[nodes.Node]:
            self.state.document.settings.env.note_reread()  # the package may change, the page not
            inside = nodes.section()
            inside.document = self.state.document
            self.state.nested_parse(StringList(lines(), source="description"), 0, inside)
            return inside.children

    return Written


def preset_lines() -> list[str]:
    """Return all presets with their references."""
    rows = [(f"`{name}`", preset.reference) for name, preset in PRESETS.items()]
    return table(("preset", "reference"), rows)


def verification_lines() -> list[str]:
    """Return each known number beside the computed one."""
    rows = [
        (case.name, each.what, f"{each.stated:.10g}", f"{each.computed:.10g}", each.unit)
        for case in CASES
        for each in case.numbers(case.rtol)
    ]
    return table(("case", "quantity", "known", "computed", "unit"), rows)


def column_lines() -> list[str]:
    """Return the variables of a result file."""
    rows = [(f"`{name}`", unit, meaning) for name, (unit, meaning) in VARIABLES.items()]
    rows += [(f"`sticks/{name}`", unit, text) for name, (unit, text) in STICKS.items()]
    return table(("variable", "unit", "meaning"), rows)


def measure_lines() -> list[str]:
    """Return the measures that a study can keep."""
    rows = [(f"`{name}`", each.unit, each.long_name) for name, each in MEASURES.items()]
    return table(("measure", "unit", "meaning"), rows)


def key_lines() -> list[str]:
    """Return every key of a description, table by table, and of each law and piece."""
    lines: list[str] = []
    for name, part in schema()["properties"].items():
        lines += part_lines(f"[{name}]", part)
    return lines


def part_lines(heading: str, part: dict) -> list[str]:
    """Return the keys of a table, then those of the tables within it."""
    title, name = heading.partition(",")[0], heading.partition(",")[0].strip("[]")
    rows = keys(part)
    lines = [f"**`{heading}`**", "", *rows, ""] if rows else []
    for case in part.get("allOf", []):
        for key, choice in case.get("if", {}).get("properties", {}).items():
            lines += part_lines(f'{title}, {key} = "{choice["const"]}"', case["then"])
    for key, inner in part.get("properties", {}).items():
        if "properties" in inner and (key != "anisotropy" or '"coulomb"' in heading):
            lines += part_lines(f"[{name}.{key}]", inner)
        lines += part_lines(f"[[{name}.{key}]]", inner.get("items", {}))
    return lines


def keys(part: dict) -> list[str]:
    """Return the table of the keys of a part of the schema."""
    rows = []
    for name, key in part.get("properties", {}).items():
        if "const" not in key:
            needed = name in part.get("required", [])
            default = "required" if needed else f"`{key.get('default', 'none')}`"
            default = default.replace("`None`", "none").replace("`none`", "none")
            meaning = key.get(
                "description", "a table, below" if "properties" in key else "the kind"
            )
            rows.append((f"`{name}`", find(key, "unit") or "", default, limit(key), meaning))
    return table(("key", "SI unit", "default", "limit", "meaning"), rows) if rows else []


BOUNDS = {
    "exclusiveMinimum": "above",
    "minimum": "from",
    "maximum": "to",
    "exclusiveMaximum": "below",
}


def limit(key: dict) -> str:
    """Return the bounds of a key in words, or its choices."""
    found = [
        f"{word} {bound:g}"
        for name, word in BOUNDS.items()
        if (bound := find(key, name)) is not None
    ]
    choices = find(key, "enum")
    return " ".join(found) or (
        "" if choices is None else ", ".join(f"`{each}`" for each in choices)
    )


def find(key: dict, name: str) -> Any:
    """Return what a key, or the first of its alternatives that has it, says under a name."""
    if name in key:
        return key[name]
    found = (find(each, name) for each in key.get("anyOf", []))
    return next((each for each in found if each is not None), None)


DIRECTIVES = {
    "preset-table": preset_lines,
    "column-table": column_lines,
    "key-table": key_lines,
    "measure-table": measure_lines,
    "verification-table": verification_lines,
}


def setup(app):
    """Register the directives."""
    for name, lines in DIRECTIVES.items():
        app.add_directive(name, directive(lines))
    return {"version": st.__version__, "parallel_read_safe": True}
