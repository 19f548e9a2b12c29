"""``stiction sweep``: many runs, over axes of parameters."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    CommandError,
    Output,
    Trust,
    changes,
    parse_assignment,
    trust_in,
)
from stiction.cli.terminal import say
from stiction.errors import DescriptionError, Faults, StictionError, argument

if TYPE_CHECKING:
    from stiction.study.execution.engines import Engine
    from stiction.study.plan.study import Study


def sweep(
    config: Path | None = None,
    /,
    *,
    output: Output,
    preset: str | None = None,
    refine: str | None = None,
    apart: Annotated[list[str] | None, Parameter(negative=())] = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    dashboard: Annotated[bool, Parameter(negative=())] = False,
    quiet: Annotated[bool, Parameter(negative=())] = False,
    json_lines: Annotated[bool, Parameter(negative=())] = False,
    trust: Trust = False,
    set: Changes = None,
) -> int:
    """Run the study that CONFIG describes: many runs, stored in zarr format.

    CONFIG is a description, as `stiction init` writes it, with the measures to keep of each run,
    and an axis for each parameter that varies:

        [study]
        measures = ["peak_force", "creep_distance"]

        [axes.phi]
        from = "0.5 deg"
        to = "10 deg"
        count = 20

        [axes."drive.velocity"]
        from = "0.1 mm/s"
        to = "10 mm/s"
        count = 20
        spacing = "log"

    The reference lists the measures; `measures = ["?"]` is refused with the names of all. One of
    your own is a function from a run to a number in a file: "mymeasures.py:friction_heat".

    There are ready studies: `stiction sweep --preset yaw-angle -o yaw.zarr`, then `stiction map
    yaw.zarr`.

    It may be stopped at any moment; the same command continues. Read the store with
    xarray.open_zarr.

    Exit status: 0 if every run reached its end, 1 if some failed (the store says which, and why),
    2 if the study cannot be run, 130 if it was interrupted.

    Parameters
    ----------
    config
        The study, in TOML.
    output
        The store to write or to continue, a folder: study.zarr. Example: -o study.zarr.
    preset
        A ready study in place of CONFIG: yaw-angle (phi x V: misalignment stabilises), anisotropy
        (k_y x phi), damping-diagram (A x theta, Fig. 5 with simulations on it). Example: --preset
        yaw-angle.
    refine
        An axis, and the accuracy with which to find changes of motion along it, for each value of
        the others: "phi = 0.01 deg". It bisects, instead of filling the grid. Example: --refine
        "phi = 0.01 deg".
    apart
        With --refine, a kind of motion to distinguish from all others, such as "settling"; repeat
        it for more. By default every change of kind counts. Example: --apart settling.
    threads
        Number of runs at a time, all in this process. By default there are as many as cores, and
        after some seconds further processes take all but one. Example: --threads 4.
    workers
        Number of processes on this machine, by dask. Example: --workers 4.
    scheduler
        A dask scheduler for the runs, tcp://host:port. Its workers write to the store themselves:
        all must see the same files. Example: --scheduler tcp://node1:8786.
    dashboard
        With --workers, show dask's dashboard at http://localhost:8787 to every user of this
        machine.
    quiet
        Print only errors.
    json_lines
        Write progress and outcome to standard output as lines of JSON, at most one a second.
    """
    from stiction.cli.tally import show_tally
    from stiction.study.execution.refine import refine as bisect
    from stiction.study.execution.refine import request
    from stiction.study.execution.sweep import count_done
    from stiction.study.execution.sweep import sweep as do
    from stiction.study.view.view import CHANGES, REFINED

    found = None
    faults = Faults()
    given = changes(set, faults)
    along, to = "", ""
    if refine is not None:
        with faults.of_part():
            along, to = parse_assignment(refine, "--refine")
    with faults.of_part():
        study = read_study(config, preset, given, trust)
        if along:  # before the first of many runs
            request(study, along, to, apart)
    with faults.of_part():
        means = engine(threads, workers, scheduler, dashboard)
    if refine is None and apart is not None:
        with faults.of_part():
            raise CommandError("--apart needs --refine; give both")
    if quiet and json_lines:
        with faults.of_part():
            raise CommandError("--quiet and --json-lines exclude each other; give one")
    faults.refuse()
    if not (quiet or json_lines):  # before the first of many runs, too
        for doubt in doubts(study):
            say(doubt, error=True)
    try:
        with show_tally(quiet, json_lines) as (report, conclude):
            before = count_done(study, output)
            result = do(study, output, engine=means, progress=report)
            if refine is not None:
                found = bisect(study, output, along, to, apart=apart, engine=means, progress=report)
    except KeyboardInterrupt:
        say(f"{output}: stopped{_so_far(study, output)}; the same command continues", error=True)
        return 130
    conclude(output, result, before)
    if found is not None and not (quiet or json_lines):
        table = output / REFINED / found.attrs["along"] / CHANGES
        say(f"{found.sizes['point']} changes along {along}, by {found.attrs['runs']} runs in all")
        if wide := found.attrs["wide"]:
            say(f"failed runs leave {wide} of them less accurate than asked for")
        say(f"wrote {table}, which xarray.open_zarr reads")
    if not (quiet or json_lines):
        say(f"next: stiction map {argument(output)}{trust_in(study.base.slider)}")
    return 1 if result.failed else 0


def _so_far(study: Study, store: Path) -> str:
    """Return how many runs of a stopped study are done; empty where the store was not made yet."""
    from stiction.study.store.store import open_store
    from stiction.study.view.summary import summary

    with suppress(StictionError, OSError):
        found = summary(study, open_store(study, store))
        return f" after {found.runs - found.pending} of {found.runs} runs"
    return ""


def doubts(study: Study) -> list[str]:
    """Return doubts about the law of a run at an allowed corner of the axes."""
    from stiction.friction.law import implausible

    for corner in product(*((0, size - 1) for size in study.layout.shape)):
        with suppress(DescriptionError):  # such a run is refused by itself
            return implausible(study.description(corner).slider.law)
    return []


def read_study(
    config: Path | None, preset: str | None, given: Mapping[str, Any], trust: bool = False
) -> Study:
    """Return the requested study, with changed parameters."""
    from stiction.study import presets
    from stiction.study.plan.reading import varied_faults
    from stiction.study.plan.study import Study
    from stiction.text.paths import with_changes

    if (config is None) == (preset is None):
        known = ", ".join(presets.PRESETS)
        raise CommandError(f"give either a study's file or --preset NAME; known: {known}")
    if config is not None:
        return Study.from_toml(config, given, trust=trust)
    study = presets.preset(str(preset))
    if not given:
        return study
    raw, strange = with_changes(study.to_dict(), given)
    return Study.from_dict(raw, known=[*strange, *varied_faults(raw, given)])


def engine(
    threads: int | None, workers: int | None, scheduler: str | None, dashboard: bool = False
) -> Engine:
    """Return the requested engine."""
    if sum(each is not None for each in (threads, workers, scheduler)) > 1:
        raise CommandError("--threads, --workers and --scheduler exclude each other; give one")
    for name, count in (("threads", threads), ("workers", workers)):
        if count is not None and count < 1:
            raise CommandError(f"--{name} must be at least 1, is {count}")
    if dashboard and workers is None:
        raise CommandError("--dashboard needs --workers; give both")
    from stiction.study.execution.cores import Cores
    from stiction.study.execution.engines import Processes, Scheduler, Threads

    if threads is not None:
        return Threads(threads)
    if workers is not None:
        return Processes(workers, dashboard)
    return Cores() if scheduler is None else Scheduler(scheduler)
