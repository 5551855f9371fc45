"""Nothing is done with a robot while nobody knows what was stored of the robots before."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import StoreError, UncertainError
from robot_bridge.gateway.commands.persistence import RobotLocks


class Database:
    """Loses every transaction on its way."""

    async def run(self, work, *_arguments):
        raise UncertainError("the connection was lost during the commit")


class Stored:
    """Is asked what holds; ``meanwhile`` happens while it is asked for the first time."""

    def __init__(self, meanwhile=None):
        self.asked = 0
        self.meanwhile = meanwhile

    async def read_again(self):
        self.asked += 1
        if self.asked == 1 and self.meanwhile is not None:
            await self.meanwhile()


def held_robots(meanwhile=None):
    stored = Stored(meanwhile)
    return RobotLocks(Database(), stored), stored


async def lose(held):
    with pytest.raises(UncertainError):
        await held.run((), None)


async def test_what_is_in_doubt_is_looked_up_once_before_any_robot_is_held():
    held, stored = held_robots()
    async with held.of(["r1"]):
        await lose(held)
    assert held.has_uncertain_commit and stored.asked == 0
    for robots in (["r2", "r1"], ["r1"], []):
        async with held.of(robots):
            assert not held.has_uncertain_commit and stored.asked == 1


async def test_what_comes_into_doubt_while_another_is_looked_up_is_looked_up_too():
    held, stored = held_robots(meanwhile=lambda: lose(held))
    await lose(held)
    async with held.of(["r1"]):
        assert held.has_uncertain_commit and stored.asked == 1
    async with held.of(["r2"]):
        assert not held.has_uncertain_commit and stored.asked == 2


async def test_a_later_doubt_outlasts_whoever_looked_up_the_earlier_one_beside_it():
    async def another_looks_it_up_and_a_third_is_lost():
        async with held.of(["r2"]):
            await lose(held)

    held, stored = held_robots(another_looks_it_up_and_a_third_is_lost)
    await lose(held)
    async with held.of(["r1"]):
        assert held.has_uncertain_commit and stored.asked == 2


async def test_what_cannot_be_looked_up_stays_in_doubt():
    async def fail():
        raise StoreError("the database is not there")

    held, _ = held_robots(fail)
    await lose(held)
    with pytest.raises(StoreError):
        async with held.of(["r1"]):
            pytest.fail("nothing is known of it")
    assert held.has_uncertain_commit
    async with held.of(["r1"]):
        assert not held.has_uncertain_commit
