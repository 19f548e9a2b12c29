"""An explorer that is served while a test runs, and what its page would ask."""

import asyncio
import json
import struct
import threading
from contextlib import contextmanager

import numpy as np
from websockets.sync.client import connect

from stiction.explorer.server import Explorer
from stiction.explorer.source import Opened, the_papers
from stiction.system.description import Settings

SHORT = 0.05  # s


def an_opened(duration=SHORT, **others):
    """Return the paper's case over a short time."""
    return Opened("a test", the_papers()._replace(run=Settings(duration=duration)), **others)


@contextmanager
def serving(what=None, **options):
    """Serve the explorer in a thread of its own."""
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()

    async def start():
        explorer = Explorer(what or an_opened(), **options)
        await explorer.start()
        return explorer

    explorer = asyncio.run_coroutine_threadsafe(start(), loop).result()
    try:
        yield explorer
    finally:
        asyncio.run_coroutine_threadsafe(explorer.stop(), loop).result()
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


def page_of(explorer):
    """Return a web socket as the page opens it."""
    address = explorer.address.replace("http:", "ws:") + "socket"
    return connect(address, origin=explorer.origin, compression=None, max_size=None)


def decode(message):
    """Return the head and the arrays of a message, as the page reads them."""
    (length,) = struct.unpack_from("<I", message)
    head = json.loads(message[4 : 4 + length])
    arrays = {}
    for name, kind, shape, offset in head["arrays"]:
        count = int(np.prod(shape))
        values = np.frombuffer(message, "<" + kind, count, 4 + length + offset)
        arrays[name] = values.reshape(shape)
    return head, arrays


def ask(page, number=1, **request):
    """Return every part of the answer to a request."""
    page.send(json.dumps({"id": number, **request}))
    found = []
    while True:
        head, arrays = decode(page.recv())
        if head["id"] != number:
            continue
        if head.get("end"):
            return found
        found.append((head, arrays))
        if "faults" in head or "error" in head:
            return found
