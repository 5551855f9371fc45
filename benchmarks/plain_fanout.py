"""The peers of the load, on the same library: positions decoded and dropped, or forwarded to every operator.

They decode and check with the gateway's own function.

``python plain_fanout.py [--drop]`` prints ``listening on ws://127.0.0.1:PORT``. ``/metrics`` tells, as the
gateway does, how many messages were read.
"""

from __future__ import annotations

import asyncio
import contextlib
import http
import sys

from websockets.asyncio.server import ServerConnection, broadcast, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from robot_bridge.protocol.codec import decode_position


async def main() -> None:
    """Serve until the process is ended."""
    operators: set[ServerConnection] = set()
    drop = "--drop" in sys.argv
    read = 0

    def page(connection: ServerConnection, request: Request) -> Response | None:
        if request.path != "/metrics":
            return None
        text = f'robot_bridge_requests_total{{link="websocket",op="SendPos"}} {read}\n'
        return connection.respond(http.HTTPStatus.OK, text)

    async def connected(connection: ServerConnection) -> None:
        assert connection.request is not None
        if connection.request.path.startswith("/desk"):
            operators.add(connection)
            await connection.wait_closed()
            operators.discard(connection)
            return
        nonlocal read
        with contextlib.suppress(ConnectionClosed):
            while True:
                frame = await connection.recv(decode=False)
                if decode_position(frame) is None:
                    raise ValueError(f"this is no position: {frame!r}")
                read += 1
                if not drop:
                    broadcast(operators, frame)

    options = {"compression": None, "ping_interval": None, "process_request": page}
    async with serve(connected, "127.0.0.1", 0, **options) as server:
        print(f"listening on ws://127.0.0.1:{server.sockets[0].getsockname()[1]}", flush=True)
        await asyncio.get_running_loop().create_future()


if __name__ == "__main__":
    try:
        import uvloop

        uvloop.run(main())
    except ImportError:
        asyncio.run(main())
