"""Positions that are taken in at once, one by one or many of a link together."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.robots import SendPos

TARGET = SendPos(50.0, 40.0, 0.0, 0.0, t=9.0)


@pytest.fixture
async def driving(yard):
    """A yard whose robot r1 drives to (50, 40), and has just been at (49, 40)."""
    await yard.ready()
    await yard.acknowledge_all()
    await yard.at(20.0, 40.0)
    await yard.send("a")
    await yard.acknowledge_all()
    assert yard.fleet.accept_pose("r1", "websocket", SendPos(49.0, 40.0, 0.0, 1.0, t=8.0)) is None
    yard.now += 0.1
    return yard


def take_one(yard, pose):
    return yard.fleet.accept_pose("r1", "websocket", pose)


def take_many(yard, pose):
    rests = yard.fleet.accept_poses("websocket", [("r1", pose)])
    assert [robot for robot, _ in rests] in ([], ["r1"])
    rest = rests[0][1] if rests else None
    if isinstance(rest, Exception):
        raise rest
    return rest


both = pytest.mark.parametrize("take", [take_one, take_many])


@both
async def test_a_position_at_the_target_ends_the_command(driving, take):
    await take(driving, TARGET)
    assert await driving.states() == {"a": "reached"}
    assert driving.fleet.counters.requests["websocket", "SendPos"] == 3


@both
async def test_every_position_that_moves_a_robot_is_stored(driving, take):
    await driving.fleet.save()
    await take(driving, TARGET)
    await driving.fleet.save()
    ((stored,),) = driving.sql("select pose from robots where name = ?", "r1")
    assert (json.loads(stored)["x"], json.loads(stored)["t"]) == (50.0, 9.0)


@both
async def test_a_late_position_moves_nothing(driving, take):
    assert take(driving, SendPos(50.0, 40.0, 0.0, 0.0, t=7.0)) is None
    assert driving.fleet.robots.get("r1").pose.x == 49.0
    assert await driving.states() == {"a": "acknowledged"}


@both
async def test_a_position_far_from_the_one_before_is_refused(driving, take):
    with pytest.raises(RefusedError, match="from where it was a moment ago"):
        take(driving, SendPos(5000.0, 40.0, 0.0, 1.0, t=9.0))
    assert driving.fleet.robots.get("r1").pose.x == 49.0
    assert driving.fleet.robots.get("r1").doubt is not None
