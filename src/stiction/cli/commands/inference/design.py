"""``stiction design``: the further test that narrows a parameter most."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    Library,
    MaybeOutput,
    RecordOptions,
    Seed,
    Simulations,
    Trust,
    changes,
    library_or_cache,
    record_in,
    record_or_none,
)
from stiction.cli.writing import check_figure, check_output, write_figure
from stiction.errors import Faults

Several = Annotated[list[str] | None, Parameter(consume_multiple=True, negative=())]


def design(
    rig: Path,
    /,
    *,
    record: Path | None = None,
    of: str = "phi",
    channels: Several = None,
    angles: Several = None,
    velocities: Several = None,
    loads: Several = None,
    noise: str | None = None,
    position_noise: str | None = None,
    simulations: Simulations = 2000,
    library: Library = None,
    seed: Seed = 0,
    output: MaybeOutput = None,
    trust: Trust = False,
    set: Changes = None,
    measured: RecordOptions | None = None,
) -> None:
    """Find what to measure next: which further test tells most about a parameter. Experimental.

    Many rigs are drawn from the priors that the description RIG states, as for `stiction fit`. Each
    is tested as it is now, and in every further way: with another channel, turned by a known angle,
    at other velocities, under other loads, and once more as it is. What each test leaves open of
    the parameter is how far estimates are off, on average, for rigs that they have not seen.

    A first call simulates for minutes; its simulations are stored for the next.

    For example:

        stiction design rig.toml

        stiction design rig.toml --record data.csv --time ms --force mN

        stiction design rig.toml --of friction.mu_0 --angles 1deg 3deg --loads "2 N" "8 N"

    Parameters
    ----------
    rig
        A description in TOML with uncertain values, as phi = "2 +- 1 deg"; [run] is not used.
    record
        Measured record of the present test, in any format that `stiction import` reads: its
        channels, cycles and noise are those of the tests to come. Example: --record data.csv.
    of
        Parameter to learn more about, by its name in RIG; or jitter, the spread of friction from
        cycle to cycle. Example: --of friction.mu_0.
    channels
        Channels that the present test measures, where there is no --record. Example: --channels
        force position.
    angles
        Angles by which the rig may be turned, by default 2 and 5 deg. Example: --angles 1deg 3deg.
    velocities
        Drive velocities to try, by default a third of the present one and three times it.
        Example: --velocities "0.5 mm/s" "2 mm/s".
    loads
        Normal loads to try, by default half the present one and twice it. Example: --loads "2 N"
        "8 N".
    noise
        Standard deviation of a sample of force, taken as often as the record's, by default that of
        the record, or 0.2 % of the friction force. Example: --noise "2 mN".
    position_noise
        Standard deviation of a sample of displacement, by default that of the record, or the noise
        of the force over k_x. Example: --position-noise "50 nm".
    output
        A figure: PNG, PDF or SVG. Example: -o design.png.
    """
    from stiction.cli.tables import print_sections
    from stiction.inference.next_test.design import answer
    from stiction.inference.next_test.further import ANGLES
    from stiction.inference.next_test.question import ask
    from stiction.inference.simulated.library import library_folder
    from stiction.progress.display import show_progress

    faults = Faults()
    altered = changes(set, faults)
    check_figure(output, faults)
    check_output(library, faults, library_folder)
    if record is None:
        with faults.of_part():
            record_or_none(None, measured, trust)
    question = ask(
        rig,
        None if record is None else partial(record_in, record, measured, trust),
        of,
        faults,
        changes=altered,
        trust=trust,
        channels=channels or ("force",),
        angles=ANGLES if angles is None else angles,
        velocities=velocities,
        loads=loads,
        noise=noise,
        position_noise=position_noise,
        simulations=simulations,
    )
    with show_progress("simulating and learning") as report:
        found = answer(question, library_or_cache(library), seed, report)
    print_sections(str(rig), found.tables())
    if output is not None:
        from stiction.plotting.inference.design import plot_design

        write_figure(output, plot_design, found)
