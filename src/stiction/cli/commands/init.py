"""``stiction init`` and ``stiction presets``: descriptions to start from, and published systems."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.terminal import say
from stiction.errors import argument


def init(
    path: Path = Path("slider.toml"),
    /,
    *,
    preset: str | None = None,
    force: bool = False,
    schema: bool = False,
) -> None:
    """Write a commented description of the paper's apparatus to adapt.

    For example:

        stiction init my.toml

        stiction init my.toml --schema

        stiction init belt.toml --preset veraszto-stepan

    Parameters
    ----------
    path
        The file to write.
    preset
        A published system in place of the paper's apparatus; `stiction presets` lists them.
        Example: --preset leine-belt.
    force
        Overwrite an existing file.
    schema
        Write stiction.schema.json beside it, by which an editor completes and checks a description
        as you type; an existing description is left as it is.
    """
    from stiction.presets.report import init as write
    from stiction.system.template import BY_SCHEMA, SCHEMA

    there = path.exists() and not force
    write(path, preset=preset, force=force, schema=schema)
    if schema:
        say(f"wrote {path.with_name(SCHEMA)}")
    if schema and there:
        say(f"{path} is as it was; its editor needs the first line: {BY_SCHEMA.strip()}")
        return
    config, result = argument(path), argument(path.with_suffix(".nc"))
    say(f"wrote {path}; edit it, then: stiction run {config} --output {result}")


def presets(name: str | None = None, /) -> None:
    """List published systems, or describe one.

    Each has its parameters, its reference, and the numbers that a run must give.

    For example:

        stiction presets

        stiction presets earthquake-cycle

        stiction run --preset earthquake-cycle -o cycle.nc

        stiction init my.toml --preset earthquake-cycle

    Parameters
    ----------
    name
        The name of a preset, as the list has it.
    """
    from stiction.cli.tables import print_sections
    from stiction.presets import find
    from stiction.presets.report import overview, story

    if name is None:
        print_sections("stiction run --preset NAME --output RESULT.nc", overview())
        return
    first, *others = story(find(name))
    print_sections(first.title, [first._replace(title="What it is"), *others])
