"""Presets in words, and as files to start from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap

from stiction.presets.preset import GRADES, PRESETS, Number, Preset, Published, find
from stiction.system.template import template_text, write_description
from stiction.text.sections import Section, Table

WIDTH = 96  # characters of a comment
LAST = "9999"


def overview() -> list[Section]:
    """Return the table of all presets, oldest first: those with numbers, then the scenarios."""
    ordered = sorted(PRESETS.values(), key=lambda each: (each.year or LAST, each.name))
    parts = []
    for title, scenarios in (
        ("Published with parameters: the numbers come out", False),
        ("Scenarios: what is published is qualitative, and parameters are assumed", True),
    ):
        rows = [
            (each.name, each.publication, each.shows)
            for each in ordered
            if (each.grade == "scenario") == scenarios
        ]
        parts.append(Section(title, [], Table(("name", "published by", "shows"), rows)))
    return parts


def story(preset: Preset) -> list[Section]:
    """Return everything about a preset: its system, source, numbers and assumptions."""
    paragraphs = [" ".join(each.split()) for each in preset.story.split("\n\n")]
    source = [preset.reference, *([f"doi:{preset.doi}"] if preset.doi else [])]
    parts = [
        Section(f"{preset.name}: {preset.shows}", paragraphs),
        Section("Source", [*source, f"Grade: {preset.grade}, {GRADES[preset.grade]}."]),
    ]
    if preset.assumed:
        parts.append(Section("Assumed", [*preset.assumed]))
    parts.append(Section("To be reproduced", [], _numbers(preset.published)))
    return parts


def _numbers(published: Sequence[Published]) -> Table:
    rows = [
        (each.what, *_value(each.value, each.tolerance, each.unit), each.where)
        for each in published
    ]
    return Table(("quantity", "value", "to", "source"), rows)


def _value(value: float, tolerance: float, unit: str) -> tuple[str, str]:
    """Return a value with its unit, and its tolerance; a statement holds."""
    name = "" if unit == "1" else f" {unit}"
    if tolerance == 0.0:
        return ("holds" if value == 1.0 and not name else f"{value:g}{name}"), "exactly"
    return f"{value:.10g}{name}", f"{tolerance:.1g}"


def comparison(numbers: Sequence[Number]) -> Section:
    """Return the numbers of a run beside the published ones."""
    rows = [
        (
            each.what,
            _value(each.stated, each.tolerance, each.unit)[0],
            _value(each.computed, each.tolerance, each.unit)[0]
            if each.tolerance or each.agrees
            else f"{each.computed:g}",
            f"{each.tolerance:.1g}",
            "agrees" if each.agrees else "DIFFERS",
        )
        for each in numbers
    ]
    agree = sum(each.agrees for each in numbers)
    said = f"{agree} of {len(numbers)} agree."
    return Section(
        "Published and computed", [said], Table(("quantity", "known", "computed", "to", ""), rows)
    )


def init(
    path: str | Path = "slider.toml",
    *,
    preset: str | None = None,
    force: bool = False,
    schema: bool = False,
) -> Path:
    """Write a commented description to adapt, by default of the paper's apparatus; return its path.

    Parameters
    ----------
    path : str or Path, optional
        The file to write.
    preset : str, optional
        The name of a published system to start from, as ``stiction presets`` lists them.
    force : bool, optional
        Whether to overwrite an existing file.
    schema : bool, optional
        Whether to write ``stiction.schema.json`` beside it, by which an editor completes and
        checks what you write; an existing description stays as it is.

    Raises
    ------
    StictionError
        If the file exists, or cannot be written, or if there is no such preset.

    Examples
    --------
    >>> import stiction as st
    >>> st.init("my.toml").name
    'my.toml'
    >>> st.Slider.from_toml("my.toml").mass
    0.25
    """
    text = template_text() if preset is None else comment(find(preset))
    return write_description(path, text, force=force, schema=schema)


def comment(preset: Preset) -> str:
    """Return the description of a preset in TOML, below all knowledge of it as comments."""
    lines: list[str] = []
    for part in story(preset)[:-1]:
        lines += [*wrap(part.title, WIDTH)]
        for sentence in part.sentences:
            lines += wrap(sentence, WIDTH, initial_indent="  ", subsequent_indent="  ")
    comment = "\n".join(f"# {line}".rstrip() for line in lines)
    return f"{comment}\n\n{preset.make().to_toml()}"
