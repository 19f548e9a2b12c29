"""The server of the page: on this machine only, and for its own page only.

It listens on 127.0.0.1. Every request must name this host and carry the token of the address that
was opened; the web socket must come from the page's own origin. So another page in the same browser
can neither read nor drive it, nor can another user of the machine who does not know the token;
while the browser is started, the list of processes may show it to them.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from contextlib import suppress
from hmac import compare_digest
from http import HTTPStatus
from importlib.resources import files
from mimetypes import guess_type
from secrets import token_urlsafe
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from stiction.errors import StictionError
from stiction.explorer.session import Session
from stiction.explorer.source import Opened

HOST = "127.0.0.1"
SOCKET = "socket"
LARGEST_REQUEST = 2**24  # bytes of a request: records of a drive are in it
PATIENCE = 15.0  # s between the last page that closes and the end: one may come back to it
PAGES = files("stiction.explorer").joinpath("pages")
TYPES = {
    ".js": "text/javascript",
    ".css": "text/css",
    ".html": "text/html",
    ".svg": "image/svg+xml",
}
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self' {socket}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


class Explorer:
    """The server, and the pages that it serves."""

    def __init__(self, opened: Opened, *, ends: bool = False) -> None:
        """Store the explored source; `ends` says whether the server ends with its last page."""
        self.token = token_urlsafe(18)
        self._opened, self._ends = opened, ends
        self._pages: set[ServerConnection] = set()
        self._server: Server | None = None
        self._done = asyncio.Event()
        self._leaving: asyncio.TimerHandle | None = None

    @property
    def port(self) -> int:
        """The port that it listens on."""
        assert self._server is not None
        return int(next(iter(self._server.sockets)).getsockname()[1])

    @property
    def origin(self) -> str:
        """The origin of its page."""
        return f"http://{HOST}:{self.port}"

    @property
    def address(self) -> str:
        """The address of its page, with the token."""
        return f"{self.origin}/{self.token}/"

    async def start(self, port: int = 0) -> None:
        """Listen; port 0 is any free one.

        Raises
        ------
        StictionError
            If the port is in use, or may not be used.
        """
        try:
            self._server = await serve(
                self._serve_page,
                HOST,
                port,
                process_request=self._admit,
                compression=None,  # it takes longer than it saves on one machine
                max_size=LARGEST_REQUEST,
            )
        except OSError as error:
            why = os.strerror(error.errno) if error.errno else str(error)
            raise StictionError(
                f"port {port} cannot be listened on: {why}; choose another, or 0 for any free one"
            ) from None

    async def wait(self) -> None:
        """Wait for the last page to be closed, if it ends with that; else for ever."""
        await self._done.wait()

    async def stop(self) -> None:
        """End the pages and their computations."""
        assert self._server is not None
        self._server.close()
        await self._server.wait_closed()

    def _admit(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the answer to a request; None for the web socket, which goes on."""
        path = request.path.partition("?")[0]
        token, _, name = path.removeprefix("/").partition("/")
        if not self._is_ours(request.headers):
            return refusal(HTTPStatus.FORBIDDEN, "this address answers its own page only\n")
        if not compare_digest(token.encode(), self.token.encode()):
            return refusal(HTTPStatus.NOT_FOUND, "open the address that stiction explore printed\n")
        if name == SOCKET:
            if request.headers.get("Origin") != self.origin:
                return refusal(HTTPStatus.FORBIDDEN, "the web socket is for its own page only\n")
            return None
        return self._file(name or "index.html")

    def _is_ours(self, headers: Headers) -> bool:
        """Return whether a request names this host, and comes from no other page."""
        hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
        return hosts == [f"{HOST}:{self.port}"] and origins in ([], [self.origin])

    def _file(self, name: str) -> Response:
        """Return a file of the page."""
        known = {each.name: each for each in PAGES.iterdir()}
        if name not in known:
            return refusal(HTTPStatus.NOT_FOUND, "there is no such file\n")
        kind = TYPES.get("." + name.rpartition(".")[2]) or guess_type(name)[0] or "text/plain"
        headers = {
            "Content-Type": f"{kind}; charset=utf-8",
            "Content-Security-Policy": POLICY.format(socket=self.origin.replace("http", "ws", 1)),
            "Referrer-Policy": "no-referrer",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Cross-Origin-Opener-Policy": "same-origin",
            "X-Content-Type-Options": "nosniff",
            "Cache-Control": "no-store",
        }
        return response(HTTPStatus.OK, headers, known[name].read_bytes())

    async def _serve_page(self, connection: ServerConnection) -> None:
        """Answer one page until it is closed."""
        if self._leaving is not None:
            self._leaving.cancel()
        self._pages.add(connection)

        async def send(message: bytes) -> None:
            with suppress(ConnectionClosed):  # nobody reads it any more
                await connection.send(message)

        session = Session(self._opened, send)
        try:
            with suppress(ConnectionClosed):
                async for text in connection:
                    session.receive(text)
        finally:
            await session.close()
            self._pages.discard(connection)
            if self._ends and not self._pages:
                loop = asyncio.get_running_loop()
                self._leaving = loop.call_later(PATIENCE, self._leave)

    def _leave(self) -> None:
        if not self._pages:
            self._done.set()


def response(status: HTTPStatus, headers: dict[str, str], body: bytes) -> Response:
    """Return an answer of HTTP."""
    known = {**headers, "Content-Length": str(len(body)), "Connection": "close"}
    return Response(status.value, status.phrase, Headers(known), body)


def refusal(status: HTTPStatus, text: str) -> Response:
    """Return a refusal in words."""
    return response(status, {"Content-Type": "text/plain; charset=utf-8"}, text.encode())


async def serve_until_closed(
    opened: Opened, port: int, ends: bool, tell: Callable[[str], Any]
) -> None:
    """Serve the page until it is closed or interrupted; `tell` is given its address."""
    explorer = Explorer(opened, ends=ends)
    await explorer.start(port)
    try:
        tell(explorer.address)
        await explorer.wait()
    finally:
        await explorer.stop()
