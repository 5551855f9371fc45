"""A relay before the gateway that keeps every frame of a link: what each side really said."""

from __future__ import annotations

import threading
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.sync.server import ServerConnection, serve

TO_GATEWAY, TO_LINK = "to gateway", "to link"


class LinkRelay:
    """Stands for a gateway at ``address``; ``frames`` are (direction, frame) in their order."""

    def __init__(self, gateway: str) -> None:
        self._gateway = gateway
        self.frames: list[tuple[str, str | bytes]] = []
        self._server = serve(self._carry, "127.0.0.1", 0, compression=None, max_size=None)
        port = self._server.socket.getsockname()[1]
        self.address = f"{urlsplit(gateway).scheme}://127.0.0.1:{port}"
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    def _carry(self, link: ServerConnection) -> None:
        assert link.request is not None
        with connect(f"{self._gateway}{link.request.path}", compression=None, max_size=None) as gateway:
            back = threading.Thread(target=self._copy, args=(TO_LINK, gateway, link), daemon=True)
            back.start()
            self._copy(TO_GATEWAY, link, gateway)
        back.join(10)

    def _copy(self, direction, source, target) -> None:
        try:
            for frame in source:
                self.frames.append((direction, frame))
                target.send(frame)
        except ConnectionClosed:
            return
        finally:
            target.close()

    def end(self) -> None:
        """Close all connections."""
        self._server.shutdown()
        self._thread.join(10)
