"""``stiction explore``: play with an apparatus in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    FromPreset,
    RecordOptions,
    Trust,
    changes,
    description_from,
    record_or_none,
    source_in,
)
from stiction.cli.terminal import note
from stiction.errors import DescriptionError, Faults


def explore(
    *source: Path,
    port: int = 0,
    browser: Annotated[bool, Parameter(negative="--no-browser")] = True,
    preset: FromPreset = None,
    trust: Trust = False,
    set: Changes = None,
    measured: RecordOptions | None = None,
) -> None:
    """Open the explorer: sliders for every parameter, and the whole motion at once.

    The page is served on this machine only (127.0.0.1), and needs no network. Ctrl-C ends it, or
    closing its last page, some seconds later.

    For example, with the paper's case, then with your own, then with a measured force over it:

        stiction explore

        stiction explore my.toml

        stiction explore my.toml force.csv --time ms --force mN

    With another duration, or a published system:

        stiction explore my.toml --set duration=100s

        stiction explore --preset leine-belt

    Parameters
    ----------
    source
        A description (.toml), a result (.nc), a study (.zarr), or a measured record, as `stiction
        import` reads it. A record may go with one of the others.
    port
        The port that it listens on; any free one by default. Example: --port 8050.
    browser
        Open the browser; otherwise the address is printed, and it serves until Ctrl-C.
    """
    from stiction.analysis.measurement.reading import is_run
    from stiction.explorer.door import explore as open_explorer
    from stiction.explorer.source import Opened
    from stiction.presets import find

    records = [each for each in source if each.suffix.lower() != ".toml" and not is_run(each)]
    read = {each: source_in(each, measured, trust) for each in records}
    if not records:
        record_or_none(None, measured, trust, "name its file")
    opened: list[object] = [read.get(each, each) for each in source]
    faults = Faults()
    given = changes(set, faults)
    faults.refuse()
    if given or preset is not None:
        configs = [each for each in source if each.suffix.lower() == ".toml"]
        systems = [each for each in source if each not in records]
        if systems != configs or len(configs) > 1:
            message = "changes a description (.toml) or a preset; give one of these"
            raise DescriptionError.of("--set" if given else "--preset", message)
        config = configs[0] if configs else None
        if config is None and preset is None:
            raise DescriptionError.of("--set", "changes a description; name its file or a preset")
        opened = [each for each in opened if each not in configs]
        made = description_from(config, preset, given, trust)
        if config is not None:
            opened.append(Opened(f"{config.name}, changed", made))
        elif preset is not None:
            found = find(preset)
            opened.append(Opened(found.title, made, preset=found.name))
    try:
        open_explorer(opened, port=port, browser=browser, trust=trust)
    except KeyboardInterrupt:  # the usual end
        note("the explorer is closed")
