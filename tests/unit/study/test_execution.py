"""A study is killed at random moments, and continues with the missing runs.

A process that has imported everything forks one that does the study, which is then killed: it is
as real as one started anew, but there in a hundredth of the time.
"""

import asyncio
import contextlib
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.waiting import PATIENCE, until

import stiction as st
from stiction.study.execution.sweep import ALIKE_TIMES, FEWEST, Pace, Tally
from stiction.study.store.store import PENDING

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")

KILLS = 20
NURSERY = """
import os, resource, sys
import stiction as st
from stiction.study.execution.engines import Scheduler
from stiction.study.execution.engines import Threads
from stiction.study.plan.layout import layout_of
import distributed, xarray, zarr

study = st.Study.from_json(sys.argv[1])
study.description((0, 0))
st.simulate(study.base.slider, 0.01)
for line in sys.stdin:
    path, address, limit = line.split()
    told, tell = os.pipe()
    child = os.fork()
    if child == 0:
        os.read(told, 1)  # the parent names it first
        if int(limit):
            resource.setrlimit(resource.RLIMIT_FSIZE, (int(limit), int(limit)))
        engine = Scheduler(address) if address != "-" else Threads(2)
        try:
            result = st.sweep(study, path, engine=engine)
            print("done", result.pending, flush=True)
        except st.StictionError as error:
            print("told", error, flush=True)
        os._exit(0)
    print(child, flush=True)
    os.write(tell, b".")
    os.waitpid(child, 0)
    os.close(told)
    os.close(tell)
    print("over", flush=True)
"""


class Nursery:
    """Has processes that do a study."""

    def __init__(self, study: st.Study) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", NURSERY, study.to_json()],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1,
        )  # fmt: skip

    def begin(self, path: Path, address: str = "-", limit: int = 0) -> int:
        print(path, address, limit, file=self.process.stdin, flush=True)
        return int(self.process.stdout.readline())

    def close(self) -> None:
        for pipe in (self.process.stdin, self.process.stdout):
            pipe.close()
        self.process.wait(timeout=PATIENCE)

    def end(self) -> str:
        """Return what the process says, once it is over."""
        said = ""
        while (line := self.process.stdout.readline()) != "over\n":
            assert line, "the nursery died"
            said += line
        return said


@pytest.fixture(scope="module")
def study() -> st.Study:
    """About 300 runs of some 2 ms."""
    base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="2 s"))
    axes = {
        "phi": st.Grid("0.5 deg", "9 deg", 15),
        "drive.velocity": st.Grid("0.5 mm/s", "5 mm/s", 21, spacing="log"),
    }
    return st.Study(base=base, axes=axes, measures=["peak_force", "stick_count", "time_stuck"])


@pytest.fixture(scope="module")
def undisturbed(study, tmp_path_factory) -> xr.Dataset:
    path = tmp_path_factory.mktemp("undisturbed") / "a.zarr"
    st.sweep(study, path)
    return xr.open_zarr(path).load()


@pytest.fixture(scope="module")
def nursery(study):
    made = Nursery(study)
    yield made
    made.close()


def marks(path: Path) -> dict[str, int]:
    """Return when each block was written, by the file of its status."""
    return {str(file): file.stat().st_mtime_ns for file in path.glob("status/c/*/*")
            if not file.name.startswith(".")}  # fmt: skip


def test_killed_twenty_times_nothing_is_lost_or_done_twice(nursery, study, undisturbed, tmp_path):
    chance, killed, finished, before = random.Random(1), 0, 0, {}
    while killed < KILLS:
        path = tmp_path / f"{finished}.zarr"
        child = nursery.begin(path)
        time.sleep(chance.uniform(0.0, 0.25))  # a sixth of what it takes, on average
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
        said = nursery.end()
        now = marks(path)
        assert before.items() <= now.items()  # what was done is there, and was not done again
        before = now
        if said:  # it was done first: once more from the beginning
            assert said == "done 0\n"
            xr.testing.assert_identical(xr.open_zarr(path).load(), undisturbed)
            finished, before = finished + 1, {}
            continue
        killed += 1
        whole(path, study, undisturbed)
    nursery.begin(path)
    assert nursery.end() == "done 0\n"
    assert before.items() <= marks(path).items()
    xr.testing.assert_identical(xr.open_zarr(path).load(), undisturbed)


def whole(path: Path, study: st.Study, undisturbed: xr.Dataset) -> None:
    """Check that each block that is marked is whole, and as it should be."""
    if path.exists():
        part = xr.open_zarr(path).load()
        there = (part["status"] != PENDING).values
        for name in (*study.measures, "status", "message"):
            found, right = part[name].values[there], undisturbed[name].values[there]
            np.testing.assert_array_equal(found, right)


def test_a_full_disk_is_told_and_mended(nursery, undisturbed, tmp_path):
    """The system lets files grow to 2 kB, too few for some: it is told, and made good later."""
    nursery.begin(tmp_path / "a.zarr", limit=2000)
    said = nursery.end()
    assert said.startswith("told")
    assert "cannot be written" in said
    assert "repeat the command" in said
    nursery.begin(tmp_path / "a.zarr")
    assert nursery.end() == "done 0\n"
    xr.testing.assert_identical(xr.open_zarr(tmp_path / "a.zarr").load(), undisturbed)


DASK = "from distributed.cli.dask_{0} import main; main()"
# a worker does no block more than a file allows: the study cannot be over before the test is
GATE = """
import json, pathlib, time
from stiction.study.execution import sweep

gate = pathlib.Path({0!r})
do_block = sweep.ungated = getattr(sweep, "ungated", sweep.do_block)  # loaded more than once

def allowed(study, store, *arguments):
    while len([*store.path.glob("status/c/*/[!.]*")]) >= json.loads(gate.read_text()):
        time.sleep(0.01)
    return do_block(study, store, *arguments)

sweep.do_block = allowed
"""


@contextlib.contextmanager
def dask(what: str, *arguments: str):
    """Run a dask scheduler or worker in a process of its own."""
    command = [sys.executable, "-c", DASK.format(what), *arguments]
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        yield process
    finally:
        os.killpg(process.pid, signal.SIGKILL)  # a worker waits long for its scheduler
        process.wait(timeout=PATIENCE)


def test_workers_client_and_scheduler_killed(nursery, study, undisturbed, tmp_path):
    """A scheduler and two workers in processes of their own, on loopback."""
    from distributed import Client

    path, chance, gate = tmp_path / "a.zarr", random.Random(2), tmp_path / "gate.json"
    found = tmp_path / "scheduler.json"
    serve = ("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    work = ("--nworkers", "2", "--nthreads", "1", "--no-dashboard")

    def some_done() -> None:
        """Wait until more blocks are done; two more are allowed."""
        before = len(marks(path))
        allow(gate, before + 2)
        until(lambda: len(marks(path)) > before)

    allow(gate, 0)
    with dask(*serve, "--scheduler-file", str(found)) as scheduler:
        until(lambda: found.exists() and found.read_text())
        address = json.loads(found.read_text())["address"]
        preload = ("--preload", GATE.format(str(gate)))
        with dask("worker", address, *work, *preload) as pool:
            with Client(address) as watch:
                for _ in range(2):  # the client dies
                    child = nursery.begin(path, address)
                    some_done()
                    time.sleep(chance.uniform(0.0, 0.2))
                    os.kill(child, signal.SIGKILL)
                    assert not nursery.end()
                allow(gate, study.layout.tasks)  # workers finish what they have in hand
                until(lambda: at_rest(watch))
                before = marks(path)
                nursery.begin(path, address)
                for _ in range(2):  # workers die, and are started anew
                    some_done()
                    time.sleep(chance.uniform(0.0, 0.1))
                    os.kill(chance.choice(workers(pool.pid)), signal.SIGKILL)
                some_done()
            scheduler.kill()
            assert nursery.end().startswith("told dask's scheduler is lost")
    assert len(marks(path)) < study.layout.tasks
    nursery.begin(path)
    assert nursery.end() == "done 0\n"
    assert before.items() <= marks(path).items()
    xr.testing.assert_identical(xr.open_zarr(path).load(), undisturbed)


def test_a_scheduler_that_does_not_answer_is_lost(monkeypatch):
    """One that was killed while it was asked for its workers was waited for for ever."""
    from distributed import Client

    from stiction.study.execution import engines

    asked = asyncio.Event()

    async def silence(**_: object) -> None:
        asked.set()
        await asyncio.Event().wait()

    monkeypatch.setattr(engines, "ANSWERS", 0.1)
    with Client(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None) as it:
        monkeypatch.setattr(it.scheduler, "ncores", silence, raising=False)
        with pytest.raises(st.StictionError, match="scheduler is lost"), engines.lost_and_told():
            next(engines.outcomes(it, lambda task, _: task, [1, 2]))
    assert asked.is_set()


def allow(gate: Path, blocks: int) -> None:
    """Let workers do blocks until so many are done."""
    part = gate.with_suffix(".part")
    part.write_text(str(blocks))
    part.replace(gate)


def at_rest(watch) -> bool:
    """Return whether nothing is left to do, and no worker does anything."""
    waiting = watch.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks))
    busy = watch.run(lambda dask_worker: len(dask_worker.state.all_running_tasks))
    return waiting == 0 and not any(busy.values())


def workers(pool: int) -> list[int]:
    """Return the processes that a pool has started, one at least.

    Asked through the scheduler, a worker that has just died may never answer.
    """
    import psutil

    found: list[int] = []

    def begun() -> bool:
        for each in psutil.Process(pool).children():
            with contextlib.suppress(psutil.Error):  # it may have ended since
                found.extend([each.pid] if "spawn_main" in " ".join(each.cmdline()) else [])
        return bool(found)

    until(begun)
    return found


@pytest.mark.parametrize(("workers", "compilation"), [(1, 10.0), (4, 1.0), (16, 0.1)])
def test_the_rate_leaves_compilation_out(workers, compilation):
    """From the third round of tasks of 1 s on several workers, it is theirs."""
    pace, told = Pace(), []
    for done in range(1, 12 * workers + 1):
        seconds = compilation + (done - 1) // workers + 1.0
        tally = Tally(1000, 0, done, 0, seconds, pace.since(done, seconds), pace.trend, pace.pause)
        if done % workers == 0 and done // workers > max(2, 0.1 * compilation + 1):
            told.append(tally.rate)
    assert told == pytest.approx([workers] * len(told))
    assert tally.left == pytest.approx((1000 - 12 * workers) / workers)


def tallies(costs, runs=None):
    """Return the tally of each task of a study of one worker, which take so many seconds."""
    pace, seconds = Pace(), np.cumsum(costs)
    runs = len(costs) if runs is None else runs
    return [
        Tally(runs, 0, done, 0, float(at), pace.since(done, float(at)), pace.trend, pace.pause)
        for done, at in enumerate(seconds, 1)
    ]


def told_and_right(found):
    """Return each time left that is told, over what it should be."""
    ends = found[-1].seconds
    return [each.left / (ends - each.seconds) for each in found[:-1] if np.isfinite(each.left)]


def test_no_time_left_is_told_where_runs_differ_by_orders_of_magnitude():
    """`damping-diagram` had done half of its runs in 4 s, and then one task took 3 minutes."""
    found = tallies([0.3] * 14 + [177.0] + [0.3] * 17)
    assert not any(np.isfinite(each.left) for each in found[:FEWEST])
    assert found[13].left == pytest.approx(18 * 0.3)  # nobody can know of the long one
    assert found[13].left_after(0.5) == pytest.approx(18 * 0.3 - 0.5)
    assert not np.isfinite(found[13].left_after(1.0))  # but soon that it is one
    assert not any(np.isfinite(each.left) for each in found[14:-1])
    assert found[-1].left == 0.0


@pytest.mark.parametrize("seed", range(200))
def test_the_time_left_is_that_of_runs_in_a_random_order(seed):
    """Their times differ by a factor of 10 at most: by 0.65 of their mean, as standard deviation.

    The rate of 40 runs is then right to a tenth, that of the last 40 runs too: 3.5 times both
    together are a factor of 1.6.
    """
    rng = np.random.default_rng(seed)
    found = tallies([20.0, *10.0 ** rng.uniform(0.0, rng.uniform(0.0, 1.0), 400)])
    known = [each for each in found[80:361] if np.isfinite(each.left)]  # 20 s of compilation
    assert len(known) > 140
    assert all(1 / 1.6 < each.left / (found[-1].seconds - each.seconds) < 1.6 for each in known)


@pytest.mark.parametrize("decades", np.linspace(-2.0, 2.0, 17).tolist())
def test_the_time_left_of_runs_that_become_ever_longer_or_shorter(decades):
    """As along an axis of speeds: it is told as far as the trend would not change it much."""
    told = told_and_right(tallies(10.0 ** (decades * np.linspace(0.0, 1.0, 100))))
    assert all(1.0 / (1.5 * ALIKE_TIMES) < ratio < 1.5 * ALIKE_TIMES for ratio in told)
    assert (len(told) > 80) is (-0.75 <= decades <= 0.5)
    assert bool(told) is (-1.0 <= decades < 1.5)
