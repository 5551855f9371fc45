"""A process that speaks the desk's wire to one desk and tells of driving robots.

    python -m benchmarks.desk_feed SITE_JSON ROBOTS RATE X Y WIDTH HEIGHT

RATE is in messages a second, each a table of all the robots. It prints its port. ``device_time`` of each
robot is this machine's monotonic clock when the message was sent.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time

import numpy as np
from websockets.asyncio.server import ServerConnection, serve

from benchmarks.desk_fleet import DrivingFleet


async def main() -> None:
    """Serve until killed."""
    site = json.loads(sys.argv[1])
    number, interval = int(sys.argv[2]), 1.0 / float(sys.argv[3])
    fleet = DrivingFleet(number, tuple(map(float, sys.argv[4:8])))

    async def desk(socket: ServerConnection) -> None:
        async for text in socket:
            asked = json.loads(text)
            result = {"protocol": 1, "site": site} if asked["method"] == "hello" else {}
            await socket.send(json.dumps({"jsonrpc": "2.0", "id": asked["id"], "result": result}))
            if asked["method"] == "subscribe":
                break
        due = time.monotonic()
        while True:
            fleet.drive(interval)
            frame = fleet.frame()
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            due += interval
            # The clock is put in at the last moment: making the message is not the desk's time.
            await socket.send(frame + np.full(number, time.monotonic()).tobytes())

    async with serve(desk, "127.0.0.1", 0, compression=None) as server:
        print(server.sockets[0].getsockname()[1], flush=True)
        await asyncio.Future()


if __name__ == "__main__":
    asyncio.run(main())
