"""The peers of the load, on the same library: messages decoded and dropped, or forwarded to every operator.

``python plain_fanout.py [--drop]`` prints ``listening on ws://127.0.0.1:PORT``.
"""

from __future__ import annotations

import asyncio
import json
import sys

from websockets.asyncio.server import ServerConnection, broadcast, serve


async def main() -> None:
    """Serve until the process is ended."""
    operators: set[ServerConnection] = set()
    drop = "--drop" in sys.argv

    async def connected(connection: ServerConnection) -> None:
        assert connection.request is not None
        if connection.request.path.startswith("/desk"):
            operators.add(connection)
            await connection.wait_closed()
            operators.discard(connection)
            return
        async for frame in connection:
            if drop:
                json.loads(frame)
            else:
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
