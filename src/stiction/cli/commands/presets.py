"""``stiction presets``: published systems to run by name."""

from __future__ import annotations


def presets(name: str | None = None, /) -> None:
    """List published systems, or tell all about one.

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
    from stiction.cli.tables import printed
    from stiction.presets import find
    from stiction.presets.report import overview, story

    if name is None:
        printed("stiction run --preset NAME --output RESULT.nc", overview())
        return
    first, *others = story(find(name))
    printed(first.title, [first._replace(title="What it is"), *others])
