"""``stiction design``: what to measure next."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    Library,
    MaybeOutput,
    Measured,
    Simulations,
    Trust,
    changes,
)
from stiction.cli.terminal import say

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
    seed: int = 0,
    output: MaybeOutput = None,
    trust: Trust = False,
    set: Changes = None,
    measured: Measured | None = None,
) -> None:
    """Find what to measure next: which further test tells most of a parameter. Experimental.

    Many rigs are drawn from the priors that the description RIG states, as for `stiction fit`. Each
    is tested as it is now, and in every further way: with another channel, turned by a known angle,
    at other velocities, under other loads, and once more as it is. What each test leaves open of
    the parameter is how far estimates are off, on average, for rigs that they have not seen.

    For example:

        stiction design rig.toml

        stiction design rig.toml --record data.csv --time ms --force mN

        stiction design rig.toml --of friction.mu_0 --angles 1deg 3deg --loads "2 N" "8 N"

    Parameters
    ----------
    rig
        A description in TOML with uncertain values, as phi = "2 +- 1 deg"; [run] is not used.
    record
        A measured record of the present test, whose channels, cycles and noise are taken.
    of
        The parameter of interest: phi, friction.mu_0, k_y.
    channels
        What is measured at present, without a record: force, force_across, position.
    angles
        Angles by which the rig may be turned; 2 and 5 deg unless told otherwise.
    velocities
        Drive velocities to try; a third and three times the present one unless told otherwise.
    loads
        Normal loads to try; half and twice the present one unless told otherwise.
    noise
        Standard deviation of a sample of force: "2 mN". By default that of the record, or 0.2 %
        of the friction force.
    position_noise
        Standard deviation of a sample of displacement.
    seed
        Of the simulations.
    output
        A figure: PNG, PDF or SVG.
    """
    from stiction.analysis.measurement.reading import read_source
    from stiction.analysis.record import as_record
    from stiction.cli.progress import progress
    from stiction.cli.tables import print_sections
    from stiction.inference.library import cache_folder
    from stiction.inference.next_test.design import design as find
    from stiction.inference.next_test.wanted import ANGLES
    from stiction.inference.priors import Rig
    from stiction.storage.files import placeable

    if output is not None:
        placeable(output)
    known = Rig.from_toml(rig, changes(set), trust=trust)
    said = (measured or Measured()).arguments()
    given = None if record is None else as_record(read_source(record, trust=trust, **said))
    with progress("simulating") as report:
        found = find(
            known,
            given,
            of=of,
            channels=channels or ("force",),
            angles=ANGLES if angles is None else angles,
            velocities=velocities,
            loads=loads,
            noise=noise,
            position_noise=position_noise,
            simulations=simulations,
            library=cache_folder() if library is None else library,
            seed=seed,
            progress=report,
        )
    print_sections(str(rig), found.tables())
    if output is not None:
        from stiction.plotting.inference.design import plot_design
        from stiction.plotting.page.canvas import figure_of
        from stiction.plotting.page.save import write

        say(f"wrote {write(figure_of(plot_design, found), output)}")
