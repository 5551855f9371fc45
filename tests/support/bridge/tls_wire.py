"""TLS for clients that read in one thread and write in another, which no TLS connection allows by itself.

OpenSSL takes one thread at a time; with two, what is sent right after the handshake is lost now and then.
"""

from __future__ import annotations

import contextlib
import select
import socket
import ssl
import threading

PATIENCE = 10.0


def plain_end(host: str, port: int, context: ssl.SSLContext) -> socket.socket:
    """Connect with TLS; return a socket whose traffic a thread of its own carries over there and back."""
    ours, theirs = socket.socketpair()
    secure = context.wrap_socket(socket.create_connection((host, port), PATIENCE), server_hostname=host)
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
                secure.settimeout(PATIENCE)
            if plain in readable and not _pass_on(plain, secure):
                return


def _pass_on(source: socket.socket, target: socket.socket) -> bool:
    data = source.recv(65536)
    target.sendall(data)
    return bool(data)
