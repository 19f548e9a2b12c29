"""Directives that write tables from the package itself: keys of a description, presets, columns."""

from __future__ import annotations

from collections.abc import Callable

from benchmarks.cases import CASES
from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList

import stiction as st
from stiction.presets import PRESETS
from stiction.result.columns import STICKS, VARIABLES
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


def key_lines() -> list[str]:
    """Return every key of a description, table by table, and of each friction law."""
    lines: list[str] = []
    for name, part in schema()["properties"].items():
        lines += [f"**`[{name}]`**", "", *keys(part), ""]
        for key, inner in part["properties"].items():
            if rows := keys(inner.get("items", {})):
                lines += [f"**`[[{name}.{key}]]`**", "", *rows, ""]
        for case in part.get("allOf", []):
            law = case["if"]["properties"]["law"]["const"]
            lines += [f'**`[{name}]`, `law = "{law}"`**', "", *keys(case["then"]), ""]
    return lines


def keys(part: dict) -> list[str]:
    """Return the table of the keys of a part of the schema."""
    rows = []
    for name, key in part.get("properties", {}).items():
        if "description" in key:
            needed = name in part.get("required", [])
            default = "required" if needed else f"`{key.get('default', 'none')}`"
            rows.append((f"`{name}`", default.replace("`None`", "none"), key["description"]))
    return table(("key", "default", "meaning and unit"), rows) if rows else []


DIRECTIVES = {
    "preset-table": preset_lines,
    "column-table": column_lines,
    "key-table": key_lines,
    "verification-table": verification_lines,
}


def setup(app):
    """Register the directives."""
    for name, lines in DIRECTIVES.items():
        app.add_directive(name, directive(lines))
    return {"version": st.__version__, "parallel_read_safe": True}
