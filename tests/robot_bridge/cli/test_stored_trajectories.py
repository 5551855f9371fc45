"""Stored trajectories on each kind of database: read in pages by robot, time and area."""

import pytest

from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.records import GetTrajectory
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.storage.database import Database, read_address
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import Fix, pack
from robot_bridge.gateway.trajectories.recording import TrajectoryPages

NOW = 1_790_000_000.25


@pytest.fixture
async def database(url):
    opened = Database(read_address(url))
    yield opened
    await opened.close()


async def store(database, places):
    fixes = [Fix(robot, at, SendPos(x, y, 0.5, 1.0, fix_t=at - 1)) for robot, at, x, y in places]
    await database.run(trajectories.add, list(map(pack, fixes)))


async def pages(database, **wanted):
    """Return the positions of every page, and how many pages there were."""
    found, after, count = [], None, 0
    while True:
        page = await TrajectoryPages(database).read(GetTrajectory(after=after, **wanted))
        found += page.places
        count += 1
        if page.next is None:
            return found, count
        after = page.next


async def test_pages_hold_each_position_once_however_many_share_a_time(database):
    await store(database, [("r1", NOW + n // 7 / 3, 1.0 * n, 0.0) for n in range(100)])
    whole, _ = await pages(database, limit=5000)
    assert [place.x for place in whole] == [1.0 * n for n in range(100)]
    assert whole[0] == ("r1", NOW, 0.0, 0.0, 0.5, 1.0, None, NOW - 1)
    in_pages, count = await pages(database, limit=9)
    assert in_pages == whole and count == 12


async def test_they_are_read_by_robot_time_and_area(database):
    await store(database, [(f"r{n % 3}", NOW + n, 10.0 * n, 5.0) for n in range(12)])

    async def xs(**wanted):
        return [place.x / 10 for place in (await pages(database, **wanted))[0]]

    assert await xs(robots=["r1"]) == [1, 4, 7, 10]
    assert await xs(robots=["r1", "r2"], limit=3) == [1, 2, 4, 5, 7, 8, 10, 11]
    assert await xs(since=NOW + 9) == [9, 10, 11]
    assert await xs(until=NOW + 1) == [0, 1]
    assert await xs(bounds=(20.0, 0.0, 40.0, 5.0)) == [2, 3, 4]
    assert await xs(bounds=(20.0, 0.0, 40.0, 4.9)) == []
    assert await xs(robots=["R1"]) == []


@pytest.mark.parametrize(
    ("wanted", "says"),
    [
        ({"limit": 0}, "limit is 0; give a number from 1 to 5000"),
        ({"limit": 5001}, "limit is 5001"),
        ({"after": "yesterday"}, "after is 'yesterday'; give 'next' of the page before"),
        ({"after": "1; drop table"}, "give 'next' of the page before"),
        ({"bounds": (5.0, 0.0, 1.0, 1.0)}, "hold nothing"),
        ({"since": float("nan")}, "since"),
    ],
)
def test_what_cannot_be_asked_is_refused(wanted, says):
    with pytest.raises(MessageError, match=says):
        GetTrajectory(**wanted)
