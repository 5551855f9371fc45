"""A line to a gateway that can be cut: bytes wait or are lost, and nobody is told."""

from __future__ import annotations

import contextlib
import socket
import struct
import threading


class CutLine:
    """Forwards TCP connections to ``port`` of this computer; ``address`` is where to connect instead."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._is_whole = threading.Event()
        self._is_whole.set()
        self._sockets: list[socket.socket] = []
        self._server = socket.create_server(("127.0.0.1", 0))
        self.address = f"ws://127.0.0.1:{self._server.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Let no byte through any more, in either direction."""
        self._is_whole.clear()

    def mend(self, *, reset: bool = False) -> None:
        """Let bytes through again; with ``reset`` what waited is lost with its connections."""
        if reset:
            self._reset()
        self._is_whole.set()

    def close(self) -> None:
        """End the line for good."""
        self._server.close()
        self._reset()
        self._is_whole.set()

    def _reset(self) -> None:
        sockets, self._sockets = self._sockets, []
        for end in sockets:
            # RST in place of FIN: what is in its buffers is thrown away.
            with contextlib.suppress(OSError):
                end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                end.close()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._server.accept()
                self._is_whole.wait()
                far = socket.create_connection(("127.0.0.1", self._port))
                self._sockets += [near, far]
                for source, target in ((near, far), (far, near)):
                    threading.Thread(target=self._pump, args=(source, target), daemon=True).start()

    def _pump(self, source: socket.socket, target: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while data := source.recv(65_536):
                self._is_whole.wait()
                target.sendall(data)
            self._is_whole.wait()
            target.shutdown(socket.SHUT_WR)
