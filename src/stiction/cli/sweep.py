"""``stiction sweep``: many runs, over axes of parameters."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

if TYPE_CHECKING:
    from stiction.study.engines import Engine


def sweep(
    config: Path,
    /,
    *,
    output: Annotated[Path, Parameter(alias="-o")],
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    quiet: bool = False,
    json_lines: bool = False,
) -> int:
    """Do the study that CONFIG describes: many runs, kept in a zarr store.

    CONFIG is a description, as `stiction init` writes it, with an axis for each parameter that
    varies, and what to keep of each run:

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

    Stopped at any moment and started again with the same command, it does what is missing. Read
    the store with xarray.open_zarr.

    Exit status: 0 when every run came to its end, 1 when some failed (the store says which, and
    why; the others are there), 2 when the study cannot be run, 130 when it was interrupted.

    Parameters
    ----------
    config
        The study, in TOML.
    output
        The store to write or to go on with, a folder: study.zarr.
    threads
        How many runs at a time in this process; as many as there are cores when left out.
    workers
        So many processes of this machine in place of threads, by dask.
    scheduler
        A dask scheduler to hand the runs to, as tcp://host:port; its workers write the store
        themselves, so that all must see the same files.
    quiet
        Say nothing but what went wrong.
    json_lines
        Write progress and outcome to standard output as JSON, a line each, at most one a second.
    """
    from stiction.cli.tally import shown
    from stiction.study.plan import Study

    study, means = Study.from_toml(config), engine(threads, workers, scheduler)
    try:
        with shown(quiet, json_lines) as (report, conclude):
            result = study.run(output, engine=means, progress=report)
    except KeyboardInterrupt:
        print(f"{output}: stopped; the same command goes on where it was", file=sys.stderr)
        return 130
    conclude(output, result)
    return 1 if result.failed else 0


def engine(threads: int | None, workers: int | None, scheduler: str | None) -> Engine:
    """Return the engine that is asked for."""
    from stiction.errors import StictionError
    from stiction.study.engines import Threads

    if sum(each is not None for each in (threads, workers, scheduler)) > 1:
        raise StictionError("--threads, --workers and --scheduler exclude each other; give one")
    for name, count in (("threads", threads), ("workers", workers)):
        if count is not None and count < 1:
            raise StictionError(f"--{name} must be 1 at least, is {count}")
    if workers is None and scheduler is None:
        return Threads() if threads is None else Threads(threads)
    from stiction.study.cluster import Processes, Scheduler

    return Processes(workers) if workers is not None else Scheduler(str(scheduler))
