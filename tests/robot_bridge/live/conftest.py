"""A robot that has plugged in, on either wire, and the desk of an operator who sees it."""

from __future__ import annotations

import itertools

import pytest

from robot_bridge.core.robotmap.binary import decode
from tests.support.bridge.either_wire import WIRES

NUMBERS = itertools.count(1)


@pytest.fixture(params=sorted(WIRES))
def robot(bridge, request):
    """A robot at (20, 8) that has plugged in."""
    robot = WIRES[request.param](bridge, f"{request.param}-{next(NUMBERS)}")
    robot.name = robot.ask("Ready", {"magic": 1})["robot"]
    assert decode(robot.hear("SetMap")).border == (0.0, 0.0, 200.0, 160.0)
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    yield robot
    robot.close()


@pytest.fixture
def desk(bridge, robot):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    desk.wait_for_robots(robot.name)
    return desk
