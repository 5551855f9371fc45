"""What is stored once in a while of all robots, when one of them is another gateway's by now."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.robots import Abort
from robot_bridge.gateway.commands.active_command import CommandOrder
from robot_bridge.gateway.commands.persistence import RobotLocks
from robot_bridge.gateway.storage.repositories.robots import FencedError, SoleFence
from tests.support.bridge.busy_database import done_together

PATHS = {"r1": [(20.0, 40.0), (60.0, 40.0)], "r2": [(20.0, 50.0), (60.0, 50.0)]}


class Elsewhere(SoleFence):
    """The fence of a gateway that had r1, and does not know yet that another one has it."""

    def check(self, connection, robots):
        if "r1" in robots:
            raise FencedError("r1: connected to another gateway by now")


@pytest.fixture
async def book(two):
    for robot, path in PATHS.items():
        await two.at(*path[0], robot=robot)
        await two.send(f"path-{robot}", "SetPath", robot, points=path)
        await two.acknowledge_all(robot)
        for x in (25.0, 30.0):
            await two.at(x, path[0][1], v=1.0, robot=robot)
    book = two.fleet._commands
    book._held = RobotLocks(two.database, book, Elsewhere())
    return book


async def test_how_far_the_others_have_come_is_stored(two, book):
    await book.save_progress()
    assert two.sql("select robot, driven from commands order by robot") == [
        ("r1", 0.0),
        ("r2", pytest.approx(10.0)),
    ]


async def test_aborts_of_the_others_that_were_kept_are_stored(two, book):
    book._unstored.keep([CommandOrder(f"abort-{robot}", robot, Abort(), "Ada") for robot in PATHS])
    await book.save_progress()
    assert [(r, op) for r, op in two.sql("select robot, op from commands") if op == "Abort"] == [
        ("r2", "Abort")
    ]
    assert book._unstored.robots() == ["r1"]


async def test_what_waits_for_the_database_beside_them_is_stored(two, book):
    theirs, ours = await done_together(two.database, *(book.give_up(robot, "gone") for robot in PATHS))
    assert isinstance(theirs, FencedError) and ours is None
    assert await two.states() == {"path-r1": "acknowledged", "path-r2": "failed"}
