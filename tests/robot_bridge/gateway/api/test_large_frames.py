"""A large message goes out in several frames: whole, in order, and without holding others up."""

from __future__ import annotations

import asyncio
import contextlib

import pytest
from websockets.asyncio.client import connect
from websockets.asyncio.server import serve

from robot_bridge.gateway.api.robot_session import FRAME_PIECE, send_frame

LARGE = "".join(f"ä{k:07d}" for k in range(12 * FRAME_PIECE // 8)) + "the end"


@pytest.fixture
async def line():
    """Both ends of a WebSocket: the gateway's, and the robot's."""
    arrived, done = asyncio.get_running_loop().create_future(), asyncio.Event()

    async def keep(connection):
        arrived.set_result(connection)
        await done.wait()

    async with serve(keep, "127.0.0.1", 0, compression=None) as server:
        port = server.sockets[0].getsockname()[1]
        async with connect(f"ws://127.0.0.1:{port}", max_size=None, compression=None) as robot:
            yield await arrived, robot
            done.set()


async def begun(sending):
    """Wait until some of the pieces are sent, of which each takes a turn of the loop."""
    for _ in range(6):
        await asyncio.sleep(0)
    assert not sending.done()


async def test_it_comes_whole_in_several_frames_and_a_small_one_in_one(line):
    gateway, robot = line
    sending = asyncio.create_task(send_frame(gateway, LARGE))
    pieces = [piece async for piece in robot.recv_streaming()]
    await sending
    assert len(pieces) > 12 and "".join(pieces) == LARGE
    await send_frame(gateway, "small")
    assert [piece async for piece in robot.recv_streaming()] == ["small"]


async def test_others_have_their_turn_while_it_is_sent(line):
    gateway, robot = line
    turns = 0

    async def take_turns():
        nonlocal turns
        while True:
            turns += 1
            await asyncio.sleep(0)

    ticking = asyncio.create_task(take_turns())
    await asyncio.gather(send_frame(gateway, LARGE), robot.recv())
    ticking.cancel()
    assert turns > 12


async def test_one_whose_sender_is_cancelled_comes_to_its_end_and_the_next_behind_it(line):
    gateway, robot = line
    sending = asyncio.create_task(send_frame(gateway, LARGE))
    await begun(sending)
    sending.cancel()
    with contextlib.suppress(asyncio.CancelledError):
        await sending
    stop = asyncio.create_task(send_frame(gateway, "Abort"))
    async with asyncio.timeout(60):
        assert [await robot.recv(), await robot.recv()] == [LARGE, "Abort"]
        await stop


async def test_a_connection_that_is_lost_in_the_midst_of_it_is_told_of(line):
    gateway, _robot = line
    sending = asyncio.create_task(send_frame(gateway, LARGE))
    await begun(sending)
    gateway.transport.abort()
    with pytest.raises(Exception, match="no close frame"):
        await sending
