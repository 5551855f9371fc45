"""The peer of the load: every position is forwarded to every operator at once, as plain WebSocket servers do.

``python plain_fanout.py`` prints ``listening on ws://127.0.0.1:PORT``.
"""

from __future__ import annotations

import asyncio

from websockets.asyncio.server import ServerConnection, broadcast, serve


async def main() -> None:
    """Serve until the process is ended."""
    operators: set[ServerConnection] = set()

    async def connected(connection: ServerConnection) -> None:
        assert connection.request is not None
        if connection.request.path.startswith("/desk"):
            operators.add(connection)
            await connection.wait_closed()
            operators.discard(connection)
            return
        async for frame in connection:
            broadcast(operators, frame)

    async with serve(connected, "127.0.0.1", 0, compression=None, ping_interval=None) as server:
        print(f"listening on ws://127.0.0.1:{server.sockets[0].getsockname()[1]}", flush=True)
        await asyncio.get_running_loop().create_future()


if __name__ == "__main__":
    try:
        import uvloop

        uvloop.run(main())
    except ImportError:
        asyncio.run(main())
