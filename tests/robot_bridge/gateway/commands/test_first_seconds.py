"""What a gateway goes by in its first seconds: robots have driven on since what is stored of them."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import RefusedError, StoreError
from robot_bridge.core.messages.roads import ResolveConflict
from robot_bridge.core.messages.robots import GetPath, Stopped
from robot_bridge.gateway.commands.persistence import write_again
from tests.support.bridge.road_places import SOUTH, highest

PATH = [(20.0, 40.0), (40.0, 40.0), (40.0, 60.0)]


async def test_a_path_that_was_driven_before_its_acknowledgement_came_is_reached(roads):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*PATH[0])
    await roads.fleet.save()
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.restart()
    await roads.ready()
    await roads.at(*PATH[-1])
    await roads.ack(row.id)
    assert (await roads.states())["a"] == "acknowledged"
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


async def test_a_path_that_was_driven_before_it_was_stored_where_its_robot_is_is_reached(roads):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*PATH[0])
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.restart()
    await roads.ready()
    await roads.ack(row.id)
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


async def test_a_path_that_was_driven_while_the_link_was_broken_is_reached(roads):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*PATH[0])
    await roads.send("a", "SetPath", points=PATH)
    (row,) = await roads.deliver()
    await roads.ready()
    await roads.at(*PATH[-1])
    await roads.ack(row.id)
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


async def test_a_path_that_was_driven_although_its_delivery_was_not_noted_is_reached(roads):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*PATH[0])
    await roads.fleet.save()
    await roads.send("a", "SetPath", points=PATH)
    assert [row.op for row in await roads.fleet.outboxes.outbox("r1", 0)] == ["SetPath"]
    await roads.restart()
    await roads.ready()
    await roads.at(*PATH[1])
    assert await roads.acknowledge_all() == ["SetPath", "SetMap"]
    await roads.at(*PATH[-1])
    assert (await roads.states())["a"] == "reached"


LAP = [(20.0, 40.0), (40.0, 40.0), (40.0, 60.0), (20.0, 60.0), (20.0, 41.0)]
"""It ends beside its beginning."""


async def stopped(yard):
    await yard.fleet.receive("r1", "websocket", Stopped(), 9)


@pytest.mark.parametrize("restarts", [True, False], ids=["the gateway restarts", "the link broke"])
@pytest.mark.parametrize("stops_first", [True, False])
async def test_a_lap_that_was_driven_unseen_is_reached_when_the_robot_has_nothing_to_do(
    roads, restarts, stops_first
):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*LAP[-1])
    await roads.fleet.save()
    await roads.send("a", "SetPath", points=LAP)
    (row,) = await roads.deliver()
    if restarts:
        await roads.restart()
    roads.now += 60
    await roads.ready()
    await roads.at(*LAP[-1])
    # What it did before it is sent once more.
    await stopped(roads)
    await roads.ack(row.id)
    if stops_first:
        await stopped(roads)
    await roads.at(*LAP[-1])
    if not stops_first:
        assert (await roads.states())["a"] == "acknowledged"
        await stopped(roads)
    assert (await roads.states())["a"] == "reached"


async def test_a_lap_is_not_reached_by_a_robot_that_was_seen_not_to_drive_it(roads):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*LAP[-1])
    await roads.drive("a", [LAP[-1], *LAP])
    await roads.at(*LAP[-1])
    await stopped(roads)
    assert (await roads.states())["a"] == "acknowledged"


@pytest.mark.parametrize("restarts", [True, False], ids=["the gateway restarts", "the database is back"])
async def test_a_robot_that_starts_anew_while_the_database_fails_is_sent_its_task_again(
    roads, monkeypatch, restarts
):
    await roads.ready(magic=1)
    await roads.acknowledge_all()
    await roads.send("a")
    await roads.acknowledge_all()
    run = roads.database.run

    async def fail(work, *arguments):
        if work is write_again:
            raise StoreError("the disk is full")
        return await run(work, *arguments)

    monkeypatch.setattr(roads.database, "run", fail)
    with pytest.raises(StoreError):
        await roads.ready(magic=2)
    await roads.fleet.save()
    monkeypatch.undo()
    if restarts:
        await roads.restart()
    await roads.ready(magic=2)
    assert "SetPosEnd" in await roads.acknowledge_all()
    assert await roads.steps("a") == ["queued", "delivered", "acknowledged", "acknowledged", "acknowledged"]


async def test_robots_whose_road_was_closed_when_the_gateway_died_are_led_round(roads, monkeypatch):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    await roads.fleet.save()

    async def died(*_):
        raise StoreError("the gateway is gone")

    monkeypatch.setattr(roads.fleet.roads.closures._detours, "around", died)
    with pytest.raises(StoreError):
        await roads.close_road(*SOUTH, reason="tree")
    await roads.restart()
    await roads.ready()
    await roads.fleet.watch_roads()
    assert "SetPath" not in await roads.acknowledge_all()
    await roads.at(15.0, 8.0, v=1.0)
    await roads.fleet.watch_roads()
    points = await roads.new_path()
    assert points[0] == [15.0, 8.0]
    assert highest(points) == pytest.approx(22.0, abs=0.5)
    assert (roads.news["replanned"]["robot"], roads.news["replanned"]["became"]) == ("r1", "another way")
    await roads.acknowledge_all()
    await roads.fleet.watch_roads()
    assert await roads.acknowledge_all() == []


async def test_a_robot_that_is_not_heard_when_its_road_is_closed_is_led_round_from_where_it_comes_back(roads):
    await roads.drive("one", [(10.0, 8.0), (126.0, 8.0)])
    roads.now += 20
    roads.fleet.age()
    (robot,) = (await roads.close_road(*SOUTH, reason="tree")).robots
    assert (robot.robot, robot.became) == ("r1", "later")
    assert await roads.acknowledge_all() == []
    await roads.ready()
    await roads.at(15.0, 8.0, v=1.0)
    await roads.fleet.watch_roads()
    assert (await roads.new_path())[0] == [15.0, 8.0]
    assert roads.news["replanned"]["became"] == "another way"


async def test_a_robot_that_waits_is_sent_on_although_it_was_stored_where_it_had_not_come_to_yet(roads):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.fleet.save()
    hold = await roads.wait_at_the_crossing()
    await roads.restart()
    await roads.fleet.watch_roads()
    await roads.ready()
    await roads.fleet.watch_roads()
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == [hold]
    await roads.at(hold.x, hold.y)
    await roads.at(60.0, 40.0, robot="r2")
    roads.now = hold.until + 1
    await roads.fleet.watch_roads()
    assert (await roads.new_path())[0] == [hold.x, hold.y]


async def test_nobody_gives_way_from_where_he_was(roads):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    await roads.fleet.save()
    await roads.restart()
    with pytest.raises(RefusedError, match="it is not known where r1 is now"):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")
    await roads.ready()
    await roads.at(16.0, 8.0, v=1.0)
    assert (await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2"), "Ada")).robot == "r1"


async def test_a_way_is_told_from_where_a_robot_is_not_from_where_it_was(roads):
    await roads.ready()
    await roads.at(10.0, 8.0)
    await roads.send("cone", x=126.0, y=8.0)
    await roads.acknowledge_all()
    await roads.ready()
    with pytest.raises(
        RefusedError, match="GetPath: it is not known where robot 'r1' is; send SendPos first"
    ):
        await roads.fleet.receive("r1", "websocket", GetPath(), 7)
    await roads.at(40.0, 8.0)
    answer = (await roads.fleet.receive("r1", "websocket", GetPath(), 8)).answer
    assert answer.points[0] == (40.0, 8.0)
