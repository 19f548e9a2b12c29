"""Engines, which do tasks in parallel: on threads, on processes, or on a cluster, by dask."""

from __future__ import annotations

import logging
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from itertools import islice
from types import ModuleType
from typing import Annotated, Any, NamedTuple, Protocol, TypeVar, runtime_checkable
from uuid import uuid4

from pydantic import Field

from stiction.errors import DescriptionError, StictionError, echo
from stiction.machine import CORES
from stiction.study.plan.layout import AHEAD
from stiction.text.units import Whole
from stiction.text.validation import validate

T = TypeVar("T")
PATIENCE = 0.2  # s; on some systems a thread that waits for ever cannot be interrupted

# does a task; its second argument returns whether the task is no longer wanted
Work = Callable[[int, Callable[[], bool]], T]
AGAIN = "the finished runs are kept, and the same command continues"
# an interrupt in a terminal reaches all its processes; only the client should act on it
UNINTERRUPTED = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"
LOOPBACK = "127.0.0.1"
ANSWERS = 60.0  # s: a scheduler that takes longer is lost
DEATHS = 10  # of workers during one task, before the task is blamed


@runtime_checkable
class Engine(Protocol):
    """The interface of engines."""

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield the outcome of each task in any order, with few tasks in flight.

        Closing the iterator, or an error, drops the tasks in flight.
        """


def refuse_other(engine: object) -> None:
    """Refuse what is not an engine, before a store is made."""
    if engine is not None and (isinstance(engine, type) or not isinstance(engine, Engine)):
        message = f"{echo(engine)} is not an engine; write for example st.Threads(4)"
        raise DescriptionError.of("engine", message)


Workers = Annotated[Whole, Field(ge=1)]


@validate
class Threads(NamedTuple):
    """Threads of this process; the solver runs outside Python's lock.

    Parameters
    ----------
    workers : int, optional
        Number of threads; by default that of the cores.

    Examples
    --------
    As `engine` of `stiction.sweep`:

    >>> import stiction as st
    >>> st.Threads(4)
    st.Threads(workers=4)
    """

    workers: Workers = CORES

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield the outcome of each task."""
        return in_threads(self.workers, work, tasks)


def in_threads(
    count: int, work: Work[T], tasks: Iterable[int], end: Callable[[], None] | None = None
) -> Iterator[T]:
    """Yield the outcome of each task, of which some threads do one each; `end` is called last.

    It is called before the threads are waited for, so it may end what they wait for.
    """
    unwanted = threading.Event()
    waiting = iter(tasks)
    with ThreadPoolExecutor(count, "study") as pool:

        def submit(more: int) -> set[Future[T]]:
            return {pool.submit(work, task, unwanted.is_set) for task in islice(waiting, more)}

        try:
            flying = submit(AHEAD * count)
            while flying:
                done, flying = wait(flying, PATIENCE, FIRST_COMPLETED)
                flying |= submit(len(done))
                for future in done:
                    yield future.result()
        finally:
            unwanted.set()
            if end is not None:
                end()
            pool.shutdown(wait=True, cancel_futures=True)


@validate
class Processes(NamedTuple):
    """Processes of this machine, which start and end with the study.

    They need the extra ``stiction[cluster]``.

    Anyone with access to a scheduler can run code on its workers. These processes accept
    connections only from this machine, with a certificate that is made for the study.

    Parameters
    ----------
    workers : int
        Number of processes; each does one run at a time, and is restarted if it dies.
    dashboard : bool, optional
        Whether to show dask's dashboard to every user of this machine, at
        http://localhost:8787 if that port is free.

    Examples
    --------
    As `engine` of `stiction.sweep`:

    >>> import stiction as st
    >>> st.Processes(4)
    st.Processes(workers=4)
    """

    workers: Workers
    dashboard: Annotated[bool, Field(strict=True)] = False

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield what comes of each task."""
        dask = import_distributed()
        from dask import config

        settings: dict[str, Any] = {"distributed.scheduler.allowed-failures": DEATHS}
        if not self.dashboard:
            settings |= {f"distributed.{who}.http.routes": [] for who in ("scheduler", "worker")}
        with config.set(settings), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Port .* is already in use")
            cluster = dask.LocalCluster(
                n_workers=self.workers,
                threads_per_worker=1,
                preload=[UNINTERRUPTED],
                host=LOOPBACK,
                protocol="tls://",
                security=temporary_certificate(),
                # otherwise any free port: another scheduler may use dask's own
                dashboard_address=f"{LOOPBACK}:{8787 if self.dashboard else 0}",
                scheduler_kwargs={"dashboard": self.dashboard},
                silence_logs=logging.ERROR,  # hides the logs of cancelled tasks
            )
            with lost_and_told(), cluster, dask.Client(cluster) as client:
                yield from outcomes(client, work, tasks)


@validate
class Scheduler(NamedTuple):
    """A running dask scheduler with its workers, for which ``stiction[cluster]`` is needed.

    Parameters
    ----------
    address : str
        tcp://host:port, or tls://host:port with the certificates in dask's settings. It and its
        workers run code of this process, and this process trusts their answers.

    Examples
    --------
    As `engine` of `stiction.sweep`:

    >>> import stiction as st
    >>> st.Scheduler("tcp://node-1:8786")
    st.Scheduler(address='tcp://node-1:8786')
    """

    address: Annotated[str, Field(strict=True)]

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield what comes of each task."""
        dask = import_distributed()
        try:
            client = dask.Client(self.address)
        except (OSError, ValueError) as error:
            raise StictionError(
                f"no dask scheduler answers at {self.address}: {error}; start one with "
                "'dask scheduler' and workers with 'dask worker ADDRESS'"
            ) from None
        with lost_and_told(), client:
            yield from outcomes(client, work, tasks)


def temporary_certificate() -> Any:
    """Return a certificate that only this process and its workers have."""
    try:
        return import_distributed().Security.temporary()
    except ImportError:
        raise StictionError(
            "processes need a certificate, and cryptography to make it, which is not installed; "
            "write: pip install 'stiction[cluster]'"
        ) from None


def import_distributed() -> ModuleType:
    """Return the module of dask's scheduler, an optional dependency."""
    try:
        import distributed as dask
    except ImportError:
        raise StictionError(
            "processes need dask, which is not installed; write: pip install 'stiction[cluster]'"
        ) from None
    return dask


def outcomes(client: Any, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
    """Yield the outcome of each task; few are handed out at a time per worker thread."""
    from distributed import as_completed

    waiting = iter(tasks)
    flying: Any = as_completed(loop=client.loop)  # type: ignore[no-untyped-call]

    def hand_out() -> None:
        # workers come and go; a scheduler that is killed while it is asked may never answer
        threads = sum(client.nthreads(callback_timeout=ANSWERS).values()) or 1
        for task in islice(waiting, max(AHEAD * threads - flying.count(), 0)):
            name = f"block-{uuid4().hex}-{task}"  # shown in dask's dashboard
            flying.add(client.submit(work, task, never, pure=False, key=name))

    hand_out()
    for future in flying:
        yield future.result(timeout=ANSWERS)
        hand_out()


def never() -> bool:
    """Return False: dask itself drops or ends unwanted tasks."""
    return False


@contextmanager
def lost_and_told() -> Iterator[None]:
    """Turn dask's errors and logs about a lost scheduler into a message."""
    from concurrent.futures import CancelledError

    from distributed import KilledWorker
    from distributed.comm.core import CommClosedError

    logs = [logging.getLogger(name) for name in ("distributed.client", "tornado.application")]
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL)
    try:
        yield
    except KilledWorker as error:
        raise StictionError(
            f"{DEATHS} workers died at one task ({error.task}); is there enough memory? {AGAIN}"
        ) from None
    except (CancelledError, CommClosedError, TimeoutError) as error:
        raise StictionError(f"dask's scheduler is lost ({error}); {AGAIN}") from None
    finally:
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)
