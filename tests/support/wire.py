"""Plain JSON-RPC to the gateway, written against the protocol and not with the bridge's own code.

What an operator says on it is in :mod:`.operators`, what a robot says in :mod:`.robots.robot_wires`.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import select
import socket
import ssl
import threading
import time
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from tests.support.patience import BUSY

TLS_PATIENCE_S = 10.0


class RefusedError(Exception):
    """An error that the gateway answered with."""

    def __init__(self, error: dict[str, Any]):
        super().__init__(error["message"])
        self.code = error["code"]
        self.data = error.get("data")


def is_refused(wire: Wire, method: str) -> bool:
    """Call ``method`` and tell whether the gateway refused it."""
    try:
        wire.ask(method)
    except RefusedError:
        return True
    return False


def is_shut(open_wire: Callable[[], Wire]) -> bool:
    """Tell whether nobody gets in without a token."""
    try:
        open_wire().connection.close()
    except InvalidStatus as error:
        return error.response.status_code == 401
    except ConnectionClosed:
        # Let in just before, and put out as the first account came into use.
        return False
    return False


class Wire:
    """One connection, and a context that closes it. What comes in between is handed to ``_hear``.

    ``options`` are those of :func:`websockets.sync.client.connect`.
    """

    def __init__(self, url: str, **options: Any):
        if (context := options.pop("ssl", None)) is not None:
            address = urlsplit(url)
            options |= {"unix": True, "sock": _plain_end(address.hostname, address.port, context)}
            url = url.replace("wss://", "ws://", 1)
        # All that comes is taken in at once, pings too: a test that does something else is not gone.
        options = {"max_queue": None, "ping_interval": None, "close_timeout": 1} | options
        self.connection = connect(url, max_size=None, compression=None, **options)
        self._ids = itertools.count(1)

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.connection.close()

    def ask(self, method: str, params: Any = None, seconds: float = 10.0) -> Any:
        """Call ``method`` and return its result; raises RefusedError."""
        return self.answer(self.begin(method, params), seconds)

    def begin(self, method: str, params: Any = None) -> int:
        """Call ``method`` and return the id of the call."""
        id = next(self._ids)
        frame = {"jsonrpc": "2.0", "method": method, "id": id}
        self.connection.send(json.dumps(frame if params is None else {**frame, "params": params}))
        return id

    def answer(self, id: Any, seconds: float = 10.0) -> Any:
        """Return the result of call ``id``; ``seconds`` are an idle machine's."""
        until = time.monotonic() + BUSY * seconds
        while True:
            frame = json.loads(self.connection.recv(until - time.monotonic()))
            if "method" in frame:
                self._hear(frame)
            elif frame["id"] == id:
                if "error" in frame:
                    raise RefusedError(frame["error"])
                return frame["result"]

    def receive(self, seconds: float) -> dict[str, Any]:
        """Return the next frame as it is, an empty one where none comes within ``seconds``."""
        try:
            return dict(json.loads(self.connection.recv(seconds)))
        except TimeoutError:
            return {}

    def tell(self, method: str, params: Any = None) -> None:
        """Send a notification."""
        frame = {"jsonrpc": "2.0", "method": method}
        self.connection.send(json.dumps(frame if params is None else {**frame, "params": params}))

    def until(self, condition: Callable[[], Any], seconds: float = 10.0) -> Any:
        """Listen until ``condition`` is true and return it; ``seconds`` are an idle machine's."""
        until = time.monotonic() + BUSY * seconds
        while not (found := condition()):
            left = until - time.monotonic()
            assert left > 0, f"did not come about within {BUSY * seconds:g} s; {self.state()}"
            if frame := self.receive(min(left, 0.1)):
                self._hear(frame)
        return found

    def listen(self, seconds: float) -> None:
        """Take in what comes for ``seconds``."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            if frame := self.receive(left):
                self._hear(frame)

    def state(self) -> str:
        """Return what is known, for a failure's message."""
        return ""

    def hang_up(self) -> None:
        """Cut the connection; a close in good order would wait for what nobody read."""
        with contextlib.suppress(OSError):
            self.connection.socket.shutdown(socket.SHUT_RDWR)

    def _hear(self, frame: dict[str, Any]) -> None:
        raise NotImplementedError


def _plain_end(host: str, port: int, context: ssl.SSLContext) -> socket.socket:
    """Connect with TLS; return a socket whose traffic a thread of its own carries over there and back.

    The client reads in one thread and writes in another, which no TLS connection allows by itself: with two,
    what is sent right after the handshake is lost now and then.
    """
    ours, theirs = socket.socketpair()
    secure = context.wrap_socket(socket.create_connection((host, port), TLS_PATIENCE_S), server_hostname=host)
    threading.Thread(target=_carry, args=(secure, ours), daemon=True).start()
    return theirs


def _carry(secure: ssl.SSLSocket, plain: socket.socket) -> None:
    with secure, plain, contextlib.suppress(OSError):
        while True:
            # What was decrypted already makes no socket readable.
            readable = [secure] if secure.pending() else select.select([secure, plain], [], [])[0]
            if secure in readable:
                secure.settimeout(0)
                # A ticket for the next session is no data.
                with contextlib.suppress(ssl.SSLWantReadError):
                    if not _pass_on(secure, plain):
                        return
                secure.settimeout(TLS_PATIENCE_S)
            if plain in readable and not _pass_on(plain, secure):
                return


def _pass_on(source: socket.socket, target: socket.socket) -> bool:
    data = source.recv(65536)
    target.sendall(data)
    return bool(data)
