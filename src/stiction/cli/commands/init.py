"""``stiction init``: write a commented description as a starting point."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.options import FromPreset
from stiction.cli.terminal import say


def init(
    path: Path = Path("slider.toml"),
    /,
    *,
    preset: FromPreset = None,
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
    say(f"wrote {path}; edit it, then: stiction run {path} --output {path.with_suffix('.nc')}")
