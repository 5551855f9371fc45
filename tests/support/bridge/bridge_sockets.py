"""WebSockets by hand: clients that do not read, do not answer, and do not close."""

from __future__ import annotations

import contextlib
import socket
from pathlib import Path
from typing import Any


def plain_socket(bridge: Any, path: str, *headers: str) -> socket.socket:
    """Open a WebSocket; nothing on this side reads it or answers a ping or a close."""
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    raw.connect(("127.0.0.1", bridge.port))
    lines = [f"GET {path} HTTP/1.1", "Host: x", "Upgrade: websocket", "Connection: Upgrade", *headers]
    lines += ["Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==", "Sec-WebSocket-Version: 13", "", ""]
    raw.sendall("\r\n".join(lines).encode())
    assert raw.recv(4096).startswith(b"HTTP/1.1 101")
    return raw


def frame(text: str, opcode: int = 1) -> bytes:
    """Return a frame as a client sends it, masked with zeros."""
    payload = text.encode()
    length = bytes([0x80 | len(payload)]) if len(payload) < 126 else b"\xfe" + len(payload).to_bytes(2, "big")
    return bytes([0x80 | opcode]) + length + bytes(4) + payload


def open_sockets(bridge: Any) -> int:
    """Return how many sockets a gateway has open."""
    found = 0
    for entry in Path(f"/proc/{bridge.gateway.pid}/fd").iterdir():
        # One that was closed meanwhile is none.
        with contextlib.suppress(FileNotFoundError):
            found += str(entry.readlink()).startswith("socket:")
    return found
