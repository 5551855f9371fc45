"""WebSocket by hand, for those who must cost little: frames made once, sockets opened in one line."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import socket
import struct

BINARY, CLOSE, PING, TEXT = 2, 8, 9, 1
END = b"\r\n\r\n"
"""of the answer to a handshake."""


def frame(text: str | bytes, opcode: int = TEXT) -> bytes:
    """Return a client's frame; its mask is zero, which leaves the payload as it is."""
    payload = text.encode() if isinstance(text, str) else text
    if len(payload) < 126:
        return struct.pack("!BBI", 0x80 | opcode, 0x80 | len(payload), 0) + payload
    return struct.pack("!BBHI", 0x80 | opcode, 0x80 | 126, len(payload), 0) + payload


def pong(payload: bytes) -> bytes:
    """Return the frame that answers a ping."""
    return frame(payload, 10)


def call(method: str, params: object, id: int | None = None) -> bytes:
    """Return the frame of a JSON-RPC call."""
    value = {"jsonrpc": "2.0", "method": method, "params": params}
    return frame(json.dumps(value if id is None else {**value, "id": id}))


def result(id: int) -> bytes:
    """Return the frame that acknowledges the call ``id``."""
    return frame(json.dumps({"jsonrpc": "2.0", "id": id, "result": {}}))


def handshake(host: str, port: int, path: str) -> bytes:
    """Return what asks a server for a connection."""
    key = base64.b64encode(os.urandom(16)).decode()
    return (
        f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )


def connect(host: str, port: int, path: str, receive_buffer: int | None = None) -> socket.socket:
    """Return a socket on which the handshake is done."""
    sock = socket.socket()
    if receive_buffer:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    sock.connect((host, port))
    sock.sendall(handshake(host, port, path))
    answer = b""
    while not answer.endswith(END):
        # Byte by byte: what comes behind the answer belongs to whoever reads frames.
        byte = sock.recv(1)
        if not byte:
            raise ConnectionError(f"{path}: the server closed: {answer.decode(errors='replace')}")
        answer += byte
    check(path, answer)
    sock.setblocking(False)
    return sock


def check(path: str, answer: bytes) -> None:
    """Raise ConnectionError for the answer of a server that does not take a connection."""
    if b" 101 " not in answer.splitlines()[0]:
        raise ConnectionError(f"{path}: {answer.decode(errors='replace')}")


class Inbox:
    """Takes frames out of what a server sends."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def take(self, data: bytes) -> list[tuple[int, bytes]]:
        """Return the frames that are whole with ``data``: opcode and payload."""
        self._bytes += data
        found, at = [], 0
        while (size := self._header(at)) is not None:
            header, length = size
            if len(self._bytes) < at + header + length:
                break
            begin = at + header
            found.append((self._bytes[at] & 0x0F, bytes(self._bytes[begin : begin + length])))
            at = begin + length
        del self._bytes[:at]
        return found

    def _header(self, at: int) -> tuple[int, int] | None:
        left = len(self._bytes) - at
        if left < 2:
            return None
        length = self._bytes[at + 1] & 0x7F
        if length < 126:
            return 2, length
        extended = 2 if length == 126 else 8
        if left < 2 + extended:
            return None
        return 2 + extended, int.from_bytes(self._bytes[at + 2 : at + 2 + extended], "big")


class Peer:
    """A robot's or a link's end of a connection, for crowds in one thread: nobody waits for a socket."""

    def __init__(self, host: str, port: int, path: str) -> None:
        self._where = host, port, path
        self._answer: bytes | None = None
        self.open()

    def open(self) -> None:
        """Connect, also for another time.

        :raises ConnectionError: when the server does not take it.
        """
        self.sock = connect(*self._where)
        self._inbox = Inbox()
        self._left = b""

    def begin_open(self, host: str, port: int) -> None:
        """Ask a server for a connection; :meth:`opened` is called once it has agreed.

        Nobody waits for that: what asks is sent by :meth:`send` once the socket can be written to.
        """
        self._where = host, port, self._where[2]
        self.sock = socket.socket()
        self.sock.setblocking(False)
        self.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.sock.connect_ex((host, port))
        self._inbox, self._left, self._answer = Inbox(), handshake(*self._where), b""

    def opened(self) -> None:
        """Do what comes first on a connection that was asked for."""

    def send(self, message: bytes = b"") -> None:
        """Send a frame; what the socket does not take now goes first the next time."""
        self._left += message
        try:
            while self._left:
                self._left = self._left[self.sock.send(self._left) :]
        except (BlockingIOError, ConnectionError):
            # A wire that is closed is seen when it is read.
            return

    def offer(self, message: bytes) -> bool:
        """Send a frame, or return false where the socket does not take it."""
        try:
            self._left = self._left[self.sock.send(self._left) :] if self._left else b""
            if not self._left:
                self._left = message[self.sock.send(message) :]
                return True
        except BlockingIOError:
            pass
        return False

    def received(self) -> list[tuple[int, bytes]]:
        """Return the frames that have come, opcode and payload; pings are answered.

        :raises ConnectionError: when the server has closed the connection.
        """
        data = self.sock.recv(1 << 16)
        if not data:
            raise ConnectionError(f"{self._where[2]}: the server closed")
        if self._answer is not None:
            answer, end, data = (self._answer + data).partition(END)
            if not end:
                self._answer = answer
                return []
            check(self._where[2], answer)
            self._answer = None
            self.opened()
        frames = self._inbox.take(data)
        for opcode, payload in frames:
            if opcode == PING:
                self.send(pong(payload))
            elif opcode == CLOSE:
                code, reason = int.from_bytes(payload[:2], "big"), payload[2:].decode(errors="replace")
                raise ConnectionError(f"{self._where[2]}: the server closed with {code}: {reason}")
        return frames


class Stream:
    """One connection of an operator."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader, self.writer = reader, writer

    @classmethod
    async def on(cls, sock: socket.socket) -> Stream:
        """Return a stream on a socket that is connected."""
        return cls(*await asyncio.open_connection(sock=sock, limit=1 << 22))

    async def receive(self) -> tuple[int, bytes]:
        """Return the next frame that is TEXT or BINARY, and its payload; pings are answered."""
        while True:
            first, second = await self.reader.readexactly(2)
            length = second & 0x7F
            if length >= 126:
                length = int.from_bytes(await self.reader.readexactly(2 if length == 126 else 8), "big")
            payload = await self.reader.readexactly(length)
            if first & 0x0F == PING:
                self.writer.write(pong(payload))
            elif first & 0x0F in (BINARY, TEXT):
                return first & 0x0F, payload
