"""``stiction fit``: the parameters of a rig, from measured records."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    Library,
    Output,
    RecordOptions,
    Seed,
    Simulations,
    Trust,
    changes,
    library_or_cache,
    records_in,
)
from stiction.cli.terminal import say
from stiction.cli.writing import check_output, write_figure
from stiction.errors import DescriptionError, Faults
from stiction.text.sections import Section

if TYPE_CHECKING:
    from stiction.analysis.record import Record


def fit(
    records: list[Path],
    /,
    *,
    rig: Path,
    output: Output,
    figures: Path | None = None,
    mechanism: Annotated[bool, Parameter(negative=())] = False,
    simulations: Simulations = 4000,
    library: Library = None,
    seed: Seed = 0,
    trust: Trust = False,
    set: Changes = None,
    measured: RecordOptions | None = None,
) -> None:
    """Estimate a rig's parameters from RECORDS. Experimental.

    Many records are simulated, each with parameters drawn from the priors that the rig's
    description states, with friction that differs from cycle to cycle, sampled and with noise as
    the measured ones are. They are compared by their features. What the records do not say is
    reported "not identifiable", with the prior beside it. Nothing promises the coverage of the
    intervals on your rig: each fit measures it on simulated records that it leaves out.

    In the description a value may be uncertain:

        phi = "2 +- 1 deg"

        k_x = {value = "2.3 kN/m", uncertainty = "5 %"}

        mu_0 = {low = 0.5, high = 0.7}

    For example, two records of one rig together:

        stiction fit slow.nc fast.nc --rig rig.toml -o fit.nc --figures fit

        stiction fit data.csv --time ms --force mN --rig rig.toml -o fit.nc

    Of a drive that goes to and fro, each stroke is a record:

        stiction fit data.csv --drive-position stage=mm --stroke all --rig rig.toml -o fit.nc

    With --mechanism, records are simulated by other mechanisms too: static friction in one
    dimension, rate and state, LuGre. The odds say which of them the measured ones are like, beside
    how often such odds are right; they say "undecided" rather than guess.

        stiction fit data.csv --time ms --force mN --rig rig.toml -o fit.nc --mechanism

    Parameters
    ----------
    records
        Measured records with stick-slip, of any format that `stiction import` reads; results of
        `stiction run` are taken as if measured.
    rig
        A description in TOML with uncertain values; [run] is not used. Example: --rig rig.toml.
    output
        The posterior: NetCDF, a variable for each parameter, with the prior in the group "prior".
        Example: -o fit.nc.
    figures
        A folder for figures: prior against posterior, all pairs, and the odds of mechanisms. Made
        if it does not exist. Example: --figures figures.
    mechanism
        Give the odds of mechanisms too, from a quarter as many simulations of each: with fewer than
        -n 4000 more records of unknown laws pass, and -n 400 is the least. They are written in the
        group "mechanism" of the output.
    """
    from stiction.cli.tables import print_sections
    from stiction.inference.fit import check, fit_observed
    from stiction.inference.measured.observed_rig import observe_rig
    from stiction.inference.mechanism.comparison import (
        check_comparable,
        odds_or_reason,
        refuse_incomparable,
    )
    from stiction.inference.mechanism.odds import SHARE
    from stiction.inference.rig import Rig, load_of_records
    from stiction.inference.simulated.library import library_folder
    from stiction.progress.display import show_progress
    from stiction.storage.files import NETCDF, placeable, usable_folder

    faults, known = Faults(), None
    read: dict[str, Record] = {}
    altered = changes(set, faults)
    check_output(output, faults, placeable, NETCDF)
    check_output(figures, faults, usable_folder)
    if len(records) > 1 and measured is not None and measured.turned is not None:
        message = "would hold for each of these records; import the one that was turned with it"
        with faults.of_part():
            raise DescriptionError.of(
                "--turned", f"{message}, or state it in a file beside that one"
            )
    with faults.of_part():
        known = Rig.from_toml(rig, altered, trust=trust)
    load = None if known is None else load_of_records(known)
    for path in records:
        with faults.of_part():
            read |= records_in(path, measured, trust, load)
    faults.refuse()
    assert known is not None
    given, names = [*read.values()], [*read]
    kept, of_each = library_or_cache(library), simulations // SHARE
    if mechanism:
        check_comparable(known, of_each)
    else:
        check(known, simulations)
    place = library_folder(kept)
    with show_progress("observing the records"):
        its = observe_rig(given, known)
    if mechanism:  # a fit takes long
        with show_progress("simulating the first of each mechanism") as report:
            refuse_incomparable(its, of_each, place, seed, report)
    with show_progress("simulating and learning") as report:
        found = fit_observed(its, simulations, place, seed, report)
    sections, groups = found.tables(), {}
    plots: dict[str, Any] = {"posterior": found, "corner": found}
    if mechanism:
        with show_progress("simulating and telling mechanisms apart") as report:
            odds = odds_or_reason(its, simulations, place, seed, report)
        if isinstance(odds, str):  # seldom: the first simulations did not tell it
            sections = [*sections, Section("Mechanism", [f"Not compared: {odds}."])]
        else:
            sections = [*sections, *odds.tables()]
            groups["mechanism"], plots["mechanism"] = odds.data, odds
    sections = [*sections, *warnings(names, given), *origins(names, given)]
    print_sections(", ".join(names), sections)
    say(f"wrote {found.save(output, **groups)}")
    if figures is not None:
        write_figures(plots, figures)


def origins(paths: Sequence[str], records: Sequence[Record]) -> list[Section]:
    """Return how records were read; of several, each with its name."""
    pairs = [(x, y.origin) for x, y in zip(paths, records, strict=True) if y.origin is not None]
    found = [(path, part) for path, origin in pairs for part in origin.tables()]
    if len(found) == 1:
        return [part for _, part in found]
    return [part._replace(title=f"{path}: read as") for path, part in found]


def warnings(paths: Sequence[str], records: Sequence[Record]) -> list[Section]:
    """Return the warnings of the records' analyses, which a fit ignores."""
    from stiction.analysis.report import analyse

    found = [(path, analyse(each).warnings) for path, each in zip(paths, records, strict=True)]
    return [Section(f"Warnings about {path}", [*said]) for path, said in found if said]


def write_figures(plots: Mapping[str, Any], folder: Path) -> None:
    """Write figures by their names, drawn by `stiction.plotting`."""
    from stiction import plotting
    from stiction.storage.files import make_folder

    make_folder(folder)
    for name, what in plots.items():
        write_figure(folder / f"{name}.png", getattr(plotting, f"plot_{name}"), what)
