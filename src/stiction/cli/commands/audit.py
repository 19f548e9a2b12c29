"""``stiction audit``: audit an apparatus before its measurements are trusted."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    FromPreset,
    Library,
    MaybeOutput,
    MaybeSeed,
    MaybeSimulations,
    RecordOptions,
    Trust,
    changes,
    library_or_cache,
    record_or_none,
    rig_from,
)
from stiction.cli.terminal import say
from stiction.cli.writing import check_output
from stiction.errors import Faults


def audit(
    config: Path | None = None,
    /,
    *,
    output: MaybeOutput = None,
    json: Annotated[Path | None, Parameter(name="--json")] = None,
    preset: FromPreset = None,
    trust: Trust = False,
    set: Changes = None,
    record: Path | None = None,
    simulations: MaybeSimulations = None,
    library: Library = None,
    seed: MaybeSeed = None,
    measured: RecordOptions | None = None,
) -> int:
    """Audit the apparatus that CONFIG describes: will it measure friction, or itself?

    Prints theoretical predictions beside the results of a simulated test: damping number, critical
    misalignment and the margin to it, true rest and creep in apparent stick, apparent friction
    coefficients, period, the frequency of the transverse oscillation and the sampling rate that
    shows it; and, if it does not slide steadily, advice, the mildest change first, each tried in a
    simulation, with the travel that it needs to reach steady sliding. Of springs in series: which
    is the softest, and what each replaced by a stiffer one changes. Where values are uncertain in
    CONFIG, as in phi = "2 +- 1 deg": what that does to a test, and how well to align.

    For example, with what `stiction init my.toml` writes:

        stiction audit my.toml -o my.html

        stiction audit my.toml --set phi=3deg --set W=20N

        stiction audit rig.toml --record data.csv --time ms --force mN -o rig.html

    The drive and the load must be steady; [run] is not used. Exit status: 0 if every simulation
    reached its end, 1 if one ended earlier, 2 if the description cannot be audited.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    output
        An HTML page to write: the same report with figures, in one file. Example: -o my.html.
    json
        Write the numbers as JSON, too, each with its unit. Example: --json my.json.
    record
        A measured record of the apparatus, of any format that `stiction import` reads; CONFIG
        states what is uncertain, as for `stiction fit`. The report begins with what it says:
        verdict, grounds, prior against posterior, and what would change it. Example: --record
        data.csv.
    """
    from stiction.auditing.report import audit as examine
    from stiction.cli.tables import print_sections
    from stiction.inference.simulated import SIMULATIONS
    from stiction.progress.display import show_progress
    from stiction.storage.files import placeable, write_text

    faults, rig = Faults(), None
    given = changes(set, faults)
    with faults.of_part():
        rig = rig_from(config, preset, given, trust)
    title = str(config or preset)
    if output is not None:
        from stiction.plotting.page.html import page_path

        check_output(output, faults, page_path)
    check_output(json, faults, placeable)
    with faults.of_part():
        seen = record_or_none(
            record, measured, trust, rig=rig, simulations=simulations, library=library, seed=seed
        )
    faults.refuse()
    assert rig is not None
    kept = None if seen is None else library_or_cache(library)
    count = SIMULATIONS if simulations is None else simulations
    with show_progress("auditing") as report:
        found = examine(rig, seen, simulations=count, library=kept, seed=seed or 0, progress=report)
    print_sections(title, found.tables())
    if output is not None:
        with show_progress("drawing"):
            written = found.write_html(output, title if config is None else config.name)
        say(f"wrote {written}")
    if json is not None:
        text = dumps(found.to_dict(), indent=2) + "\n"
        say(f"wrote {write_text(text, json)}")
    return 0 if found.ok else 1
