"""A commit of which nobody knows whether it was done: the gateway finds out by itself, and goes by that."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import StoreError, UncertainError
from robot_bridge.core.messages.records import GetObservations, ReviewObservation
from robot_bridge.core.messages.roads import OpenRoad, ResolveConflict
from robot_bridge.core.messages.robots import SetObject
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.gateway.commands.persistence import insert_commands, write_acknowledged, write_again
from robot_bridge.gateway.storage.repositories import closures, records
from tests.support.bridge.road_places import SOUTH

LANE = [(20.0, 40.0), (50.0, 40.0)]
DONE = pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])


@DONE
async def test_an_acknowledgement_is_looked_up_and_its_robot_is_seen_to_arrive(roads, lose, done):
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(*LANE[0])
    await roads.send("a", "SetPath", points=LANE)
    (row,) = await roads.deliver()
    lose(roads, write_acknowledged, done)
    with pytest.raises(UncertainError):
        await roads.ack(row.id)
    await roads.fleet.save()
    if not done:
        await roads.acknowledge_all()
    for x in (30.0, 40.0, 50.0):
        await roads.at(x, 40.0, v=float(x < 50))
    assert (await roads.states())["a"] == "reached"


async def carrying_out(yard):
    """Have robot r1 carry out a target."""
    await yard.ready()
    await yard.acknowledge_all()
    await yard.at(20.0, 40.0)
    await yard.send("a")
    await yard.acknowledge_all()
    assert await yard.states() == {"a": "acknowledged"}


def targets(yard):
    return [id for (id,) in yard.sql("select id from sa where robot = 'r1' and op = 'SetPosEnd'")]


@DONE
async def test_a_robot_that_starts_anew_is_sent_its_task_once_by_a_commit_in_doubt(roads, lose, done):
    await carrying_out(roads)
    lose(roads, write_again, done)
    with pytest.raises(UncertainError):
        await roads.ready(magic=2)
    sent = targets(roads)
    assert len(sent) == done
    await roads.ready(magic=2)
    assert len(targets(roads)) == 1 and targets(roads)[: len(sent)] == sent
    assert await roads.acknowledge_all() == ["SetMap", "SetPosEnd"]
    assert await roads.states() == {"a": "acknowledged"}


async def test_a_gateway_that_dies_as_a_robot_has_started_anew_sends_it_nothing_again(roads, monkeypatch):
    await carrying_out(roads)
    await roads.fleet.save()
    # A position that waits to be stored; a pose that is stored ahead of it would have it left out as late.
    await roads.at(21.0, 40.0, v=1.0)

    async def die(_robot=None):
        raise StoreError("the gateway is killed")

    monkeypatch.setattr(roads.fleet.reception._saving, "save", die)
    with pytest.raises(StoreError):
        await roads.ready(magic=2)
    (sent,) = targets(roads)
    await roads.restart()
    assert roads.fleet.robots.get("r1").pose.x == 20.0
    await roads.ready(magic=2)
    assert targets(roads) == [sent]


@DONE
async def test_a_road_is_closed_here_too_if_its_closure_is_stored(roads, lose, done):
    await roads.drive("a", [(10.0, 8.0), (126.0, 8.0)])
    lose(roads, closures.add, done)
    with pytest.raises(UncertainError):
        await roads.close_road(*SOUTH)
    assert roads.fleet.roads.closures.report().closures == []
    await roads.fleet.watch_roads()
    closed = [(one.closure, one.edges) for one in roads.fleet.roads.closures.report().closures]
    assert closed == ([("closure-1", 1)] if done else [])
    # The robot is led round, as when the road is closed at once.
    assert [one for one, _ in (await roads.states()).items()] != (["a"] if done else [])
    assert (await roads.states())["a"] == ("superseded" if done else "acknowledged")


async def test_an_operator_who_asks_for_it_again_is_told_what_holds(roads, lose):
    await roads.drive("a", [(10.0, 8.0), (126.0, 8.0)])
    lose(roads, closures.add, True)
    with pytest.raises(UncertainError):
        await roads.close_road(*SOUTH)
    assert (await roads.close_road(*SOUTH)).closure.edges == 1
    assert (await roads.states())["a"] == "superseded"


@DONE
async def test_a_road_is_open_here_too_if_that_is_stored(roads, lose, done):
    await roads.close_road(*SOUTH)
    lose(roads, closures.end, done)
    with pytest.raises(UncertainError):
        await roads.fleet.roads.closures.open(OpenRoad("closure-1"), "Bob")
    await roads.fleet.watch_roads()
    assert len(roads.fleet.roads.closures.report().closures) == (not done)
    assert (await roads.open_road()).opened_by == "Bob"
    await roads.send("a", "SetPath", robot=await plugged(roads), points=[(50.0, 8.0), (70.0, 8.0)])


async def plugged(roads):
    await roads.ready()
    return "r1"


async def test_a_robot_that_could_not_be_led_round_is_when_the_database_is_back(roads, lose):
    await roads.drive("a", [(10.0, 8.0), (126.0, 8.0)])
    lose(roads, insert_commands, False, StoreError)
    (led,) = (await roads.close_road(*SOUTH)).robots
    assert led.became == "later"
    assert "Look after it" in led.text
    await roads.fleet.watch_roads()
    assert (await roads.states())["a"] == "superseded"


@DONE
async def test_a_robot_waits_if_that_is_stored(roads, lose, done):
    await roads.drive("one", [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)])
    await roads.drive("two", [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)], robot="r2")
    lose(roads, insert_commands, done)
    with pytest.raises(UncertainError):
        await roads.fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    await roads.fleet.watch_roads()
    waiting = (await roads.fleet.roads.traffic.conflicts()).waiting
    assert [one.robot for one in waiting] == (["r1"] if done else [])


@DONE
async def test_an_observation_is_told_to_operators_if_it_is_stored(roads, lose, done):
    await roads.ready()
    lose(roads, records.add_observations, done)
    with pytest.raises(UncertainError):
        await roads.fleet.receive("r1", "sql", SetObject(100.0, 80.0, "cone-7"), 7)
    assert "observation" not in roads.news
    await roads.fleet.save()
    assert [roads.news[name]["object"] for name in roads.news if name == "observation"] == ["cone-7"] * done
    # Each is told once.
    roads.news.clear()
    await roads.fleet.save()
    assert "observation" not in roads.news


async def test_an_observation_that_its_robot_tells_again_meanwhile_is_told_to_operators_once(roads, lose):
    await roads.ready()
    lose(roads, records.add_observations, True)
    with pytest.raises(UncertainError):
        await roads.fleet.receive("r1", "sql", SetObject(100.0, 80.0, "cone-7"), 7)
    await roads.fleet.receive("r1", "sql", SetObject(100.0, 80.0, "cone-7"), 7)
    assert roads.news.pop("observation")["object"] == "cone-7"
    await roads.fleet.save()
    assert "observation" not in roads.news


@pytest.mark.parametrize(("work", "error"), [(records.review, UncertainError), (records.on_map, StoreError)])
async def test_a_review_is_told_to_operators_whatever_failed_after_it_was_stored(roads, lose, work, error):
    await roads.ready()
    await roads.fleet.receive("r1", "sql", SetObject(100.0, 80.0, "cone-7"), 7)
    (seen,) = (await roads.fleet.observations.newest(GetObservations())).observations
    roads.news.clear()
    lose(roads, work, True, error)
    with pytest.raises(error):
        await roads.fleet.observations.review(ReviewObservation(seen.observation, True), "Ada")
    await roads.fleet.save()
    assert roads.news["observation"]["state"] == "accepted"


@pytest.mark.parametrize("error", [UncertainError, StoreError])
async def test_what_was_accepted_is_on_the_map_whatever_failed(roads, lose, error):
    await roads.ready()
    await roads.fleet.receive("r1", "sql", SetObject(100.0, 80.0, "cone-7"), 7)
    (seen,) = (await roads.fleet.observations.newest(GetObservations())).observations
    # The review is stored; an UncertainError comes of its commit, a StoreError of drawing it.
    lose(roads, records.review if error is UncertainError else records.on_map, True, error)
    with pytest.raises(error):
        await roads.fleet.observations.review(ReviewObservation(seen.observation, True), "Ada")
    await roads.fleet.save()
    drawn = {one.ext["id"] for one in decode(roads.site.whole_map()).obstacles if "id" in one.ext}
    assert drawn == {"cone-7"}
