"""stiction.explore(...): open the explorer in the browser."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import Future
from importlib.util import find_spec
from threading import Thread
from typing import Any

from stiction.errors import StictionError
from stiction.explorer.source import open_sources

PORTS = 65_535
ENDS = ("Ctrl-C ends it", "it ends with the notebook, or when its last page is closed")
Tell = Callable[[str], Any]


def explore(
    source: Any = (),
    *,
    port: int = 0,
    browser: bool = True,
    trust: bool = False,
) -> None:
    """Open the explorer in the browser: sliders for every parameter, and the motion at once.

    The page is served on this machine only. It ends with Ctrl-C, or some seconds after its last
    page was closed.
    In a notebook the cell is done at once, and the page is served beside the next ones.
    It needs ``stiction[explorer]``.

    Parameters
    ----------
    source : str, Path, Description, Slider, Trajectory or Record, or list, optional
        A description, a run, a study (.zarr) or a measured record, or its file; by default the
        paper's case. A record may go with one of the others: it lies under the simulated curves.
    port : int, optional
        On which it listens; any free one by default.
    browser : bool, optional
        Whether the browser is opened; otherwise the address is only printed.
    trust : bool, optional
        Whether a user's law that the source names may be run; see `stiction.load`.

    Raises
    ------
    StictionError
        If the source cannot be read, the port is in use, or ``stiction[explorer]`` is not
        installed.
    """
    if find_spec("websockets") is None:
        raise StictionError(
            "the explorer needs the package websockets; install stiction[explorer], or start it "
            "with: uv run --extra explorer stiction explore"
        )
    if not 0 <= port <= PORTS:
        raise StictionError(f"port must lie between 0 and {PORTS}, is {port}; 0 is any free one")
    from stiction.explorer.server import serve_until_closed

    several = type(source) in (list, tuple)  # a description is a tuple of its own kind
    opened = open_sources(source if several else [source], trust=trust)

    def tell(address: str) -> None:
        print(f"{opened.name}: {address}\n{ENDS[beside]}", flush=True)
        if browser:
            import webbrowser

            webbrowser.open(address)

    beside = is_loop_running()
    if beside:
        serve_beside(lambda told: serve_until_closed(opened, port, browser, told), tell)
    else:
        asyncio.run(serve_until_closed(opened, port, browser, tell))


def is_loop_running() -> bool:
    """Return whether an event loop runs in this thread, as in a notebook."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True


def serve_beside(serve: Callable[[Tell], Coroutine[Any, Any, None]], tell: Tell) -> None:
    """Serve in a thread of its own; return when the address is known.

    Raises
    ------
    StictionError
        If it cannot listen.
    """
    address: Future[str] = Future()

    def work() -> None:
        try:
            asyncio.run(serve(address.set_result))
        except BaseException as error:
            if address.done():
                raise
            address.set_exception(error)

    Thread(target=work, name="explorer", daemon=True).start()  # ends with the notebook
    tell(address.result())
