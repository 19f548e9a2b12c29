"""One page and its computations: of each kind of request the newest wins.

Each kind has a lane. A lane computes one thing at a time, in a thread (the solver releases the
interpreter); a newer request replaces one that waits, and interrupts one that is computed.
"""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Awaitable, Callable, Iterator, Mapping
from contextlib import suppress
from math import isfinite
from struct import pack
from traceback import print_exc
from typing import Any

import numpy as np

from stiction.errors import DescriptionError, StictionError, one_line
from stiction.explorer.answers import ANSWERS, Request, answer
from stiction.explorer.motion import Reply
from stiction.explorer.source import Opened
from stiction.own_code.source import raised_in_law

Send = Callable[[bytes], Awaitable[None]]
STILL = 0.12  # s without a newer request before the slower part of an answer is computed
LANES = 2  # of each kind: the run that is shown, and the one that it is compared with
ALIGNED = 8  # bytes


class Superseded(Exception):
    """Nobody waits for an answer any more."""


class Lane:
    """A queue of requests of one kind, in which only the newest is answered."""

    def __init__(self, opened: Opened, send: Send) -> None:
        """Store the explored source, and the receiver of the answers."""
        self._opened, self._send = opened, send
        self._waiting: Request | None = None
        self._current = -1
        self._newer = asyncio.Event()
        self._work: asyncio.Task[None] | None = None

    def submit(self, request: Request) -> None:
        """Answer a request next, and none that came before it."""
        self._waiting = request
        self._current = -1  # what is computed now has no reader any more
        self._newer.set()
        if self._work is None or self._work.done():
            self._work = asyncio.create_task(self._answer_all())

    async def close(self) -> None:
        """End what is computed, and wait for that."""
        self._waiting, self._current = None, -1
        self._newer.set()
        if self._work is not None:
            await asyncio.gather(self._work, return_exceptions=True)

    async def _answer_all(self) -> None:
        while (request := self._waiting) is not None:
            self._waiting, self._current = None, int(request["id"])
            self._newer.clear()
            await self._answer(request)

    async def _answer(self, request: Request) -> None:
        number = self._current
        about = {"id": number, "do": request["do"], "lane": request.get("lane", 0)}

        def check() -> None:
            if self._current != number:
                raise Superseded

        try:
            replies = answer(self._opened, request, check)
            while (reply := await asyncio.to_thread(following, replies, check)) is not None:
                check()
                await self._send(encode({**about, **reply[0]}, reply[1]))
                if reply[0].get("quick"):  # a slider may be on its way
                    with suppress(TimeoutError):
                        await asyncio.wait_for(self._newer.wait(), STILL)
            await self._send(encode({**about, "end": True}, {}))
        except Superseded:
            return
        except DescriptionError as error:
            faults = [{"path": fault.path, "message": fault.message} for fault in error.faults]
            await self._send(encode({**about, "faults": faults}, {}))
        except StictionError as error:
            await self._send(encode({**about, "error": str(error)}, {}))
        except Exception as error:  # the page stays as it is, and says so
            if (said := raised_in_law(error)) is None:
                print_exc(file=sys.stderr)
            await self._send(encode({**about, "error": said or one_line(error)}, {}))


def following(replies: Iterator[Reply], check: Callable[[], None]) -> Reply | None:
    """Return the next part of an answer; None if there is none."""
    check()
    return next(replies, None)


class Session:
    """The requests of one page."""

    def __init__(self, opened: Opened, send: Send) -> None:
        """Store the explored source, and the receiver of the answers."""
        self._opened, self._send = opened, send
        self._lanes: dict[tuple[str, int], Lane] = {}

    def receive(self, text: str | bytes) -> None:
        """Receive a request of the page: JSON with ``do``, ``id`` and its arguments.

        Anything else is ignored: it is not from our page.
        """
        try:
            request: Any = json.loads(text)
            kind, lane, _ = request["do"], int(request.get("lane", 0)), int(request["id"])
        except (ArithmeticError, LookupError, ValueError, TypeError, AttributeError, RuntimeError):
            return
        if isinstance(kind, str) and kind in ANSWERS and 0 <= lane < LANES:
            known = self._lanes.setdefault((kind, lane), Lane(self._opened, self._send))
            known.submit(request)

    async def close(self) -> None:
        """End every computation of the page."""
        await asyncio.gather(*(lane.close() for lane in self._lanes.values()))


def encode(head: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return a message of a head and named arrays, as they lie in memory.

    The first four bytes are the length of the head in JSON (little-endian); the head is padded with
    spaces so that the arrays begin at a multiple of eight, as typed arrays of the browser need it.

    Examples
    --------
    >>> message = encode({"reply": "run"}, {"time": np.array([0.0, 1.0])})
    >>> message[-16:] == np.array([0.0, 1.0]).tobytes()
    True
    """
    parts: list[bytes] = []
    places: list[list[Any]] = []
    offset = 0
    for name, values in arrays.items():
        content = values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes()
        places.append([name, values.dtype.str[1:], list(values.shape), offset])
        content += bytes(-len(content) % ALIGNED)
        parts.append(content)
        offset += len(content)
    text = json.dumps(finite({**head, "arrays": places}), allow_nan=False).encode()
    text += b" " * (-(len(text) + 4) % ALIGNED)
    return b"".join([pack("<I", len(text)), text, *parts])


def finite(value: Any) -> Any:
    """Return a value for JSON, which has neither NaN nor infinity: None stands for them."""
    if isinstance(value, Mapping):
        return {str(key): finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [finite(each) for each in value]
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not isfinite(value) else value
