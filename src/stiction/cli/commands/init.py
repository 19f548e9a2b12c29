"""``stiction init``: write a commented description as a starting point."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.terminal import say


def init(path: Path = Path("slider.toml"), /, *, force: bool = False) -> None:
    """Write a commented description of the paper's apparatus to adapt.

    For example:

        stiction init my.toml

    Parameters
    ----------
    path
        The file to write.
    force
        Overwrite an existing file.
    """
    from stiction.system.template import init as write

    write(path, force=force)
    say(f"wrote {path}; edit it, then: stiction run {path} --output {path.with_suffix('.nc')}")
