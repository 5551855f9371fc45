"""In which order requests are dealt with, without a socket: a pause stops a robot, and waits for nothing."""

from __future__ import annotations

import asyncio

from robot_bridge import jsonrpc
from robot_bridge.desk_lanes import Asked, DeskLanes
from robot_bridge.messages import GetQueue, PauseRobot, ResumeQueue


async def test_a_pause_overtakes_what_waits_and_only_what_would_set_its_robot_in_motion():
    begun, refused, free = [], [], asyncio.Event()

    async def settle(asked, refusal):
        (begun if refusal is None else refused).append(asked.request)
        if isinstance(asked.request, GetQueue):
            await free.wait()

    lanes = DeskLanes(settle)
    question, mine, other = GetQueue(), ResumeQueue("r1", 0), ResumeQueue("r2", 0)
    for request in (question, mine, other, PauseRobot("r1")):
        await lanes.take(Asked(jsonrpc.Call(request.method, {}, 1), request, 10))
        await asyncio.sleep(0)
    assert begun == [question, PauseRobot("r1")]
    assert refused == [mine]
    free.set()
    while len(begun) < 3:
        await asyncio.sleep(0)
    assert begun[-1] == other
