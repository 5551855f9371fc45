"""A robot that an administrator removes while the gateway runs is gone at once; its commands have ended."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.errors import NotReadyError, RefusedError, StoreError, UncertainError
from robot_bridge.core.messages.administration import RemoveRobots
from robot_bridge.core.messages.positions import PositionForm
from robot_bridge.core.messages.queues import GetQueue
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.commands.persistence import write_steps
from robot_bridge.gateway.fleet.operator_updates import EVERYTHING
from robot_bridge.gateway.trajectories import recording
from tests.support.bridge.queue_line import task


def remove(yard, robot="r1"):
    """Remove a robot as ``robot-bridge robots remove`` does, which also takes away what waits for it."""
    yard.sql("delete from robots where name = ?", robot)
    yard.sql("delete from sa where robot = ?", robot)


def told(yard, revision, form=PositionForm.ROWS):
    frame = yard.fleet.snapshots.after(revision, form=form).frame
    if form is PositionForm.ROWS:
        return json.loads(frame)["params"]
    length = int.from_bytes(frame[:4], "little")
    return json.loads(frame[4 : 4 + length])["params"]


@pytest.fixture
async def stored(line):
    await line.yard.fleet.save()
    return line


async def test_it_is_known_no_more_and_desks_are_told(stored):
    yard = stored.yard
    seen = yard.fleet.snapshots.after(EVERYTHING).revision
    remove(yard)
    await yard.fleet.save()
    assert yard.fleet.robots.names() == ["r2"]
    for form in PositionForm:
        news = told(yard, seen, form)
        assert (news["removed"], news["robots"], news.get("everything", False)) == (["r1"], [], False)
        everything = told(yard, EVERYTHING, form)
        assert (len(everything["robots"]), everything["everything"]) == (1, True)
    with pytest.raises(NotReadyError):
        await yard.at(1.0, 2.0)
    assert yard.sql("select name from robots") == [("r2",)]


async def test_what_it_says_until_then_does_not_bring_it_back(stored):
    yard = stored.yard
    remove(yard)
    await yard.at(21.0, 40.0, v=1.0)
    await yard.fleet.save()
    assert yard.fleet.robots.names() == ["r2"]
    assert yard.sql("select name from robots") == [("r2",)]


async def test_its_commands_have_failed_and_those_of_others_go_on(stored):
    yard = stored.yard
    for id, robot in (("queued", "r1"), ("other", "r2")):
        await yard.send(id, robot=robot)
    remove(yard)
    await yard.fleet.save()
    assert await yard.states() == {"queued": "failed", "other": "queued"}
    assert await yard.reason("queued") == "the robot was removed"
    assert ("command-queued", "failed") in yard.reported


async def test_so_they_have_when_it_was_removed_while_no_gateway_ran(stored):
    yard = stored.yard
    await yard.send("a")
    await yard.acknowledge_all()
    remove(yard)
    await yard.restart()
    await yard.fleet.save()
    assert await yard.states() == {"a": "failed"}


@pytest.mark.parametrize("error", [StoreError, UncertainError])
async def test_a_database_that_fails_then_is_tried_again(stored, lose, error):
    yard = stored.yard
    await yard.send("a")
    remove(yard)
    lose(yard, recording._write, done=False, error=error)
    with pytest.raises(StoreError):
        await yard.fleet.save()
    assert "r1" in yard.fleet.robots
    lose(yard, write_steps, done=False, error=error)
    with pytest.raises(StoreError):
        await yard.fleet.save()
    await yard.fleet.save()
    assert "r1" not in yard.fleet.robots
    assert await yard.states() == {"a": "failed"}


async def test_one_that_says_ready_again_is_there_again(stored):
    yard = stored.yard
    seen = yard.fleet.snapshots.after(EVERYTHING).revision
    remove(yard)
    await yard.fleet.save()
    await yard.ready()
    await yard.at(3.0, 4.0)
    assert [robot["robot"] for robot in told(yard, seen)["robots"]] == ["r1"]
    assert "removed" not in told(yard, seen)
    await yard.fleet.save()
    assert yard.sql("select name from robots order by name") == [("r1",), ("r2",)]


async def test_nobody_waits_for_its_answer_to_an_emergency_stop(stored):
    yard = stored.yard
    await yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    remove(yard)
    await yard.fleet.save()
    report = yard.fleet.emergency.report()
    assert (report.robots, report.waiting) == (1, ["r2"])


async def test_it_waits_for_nobody_any_more(roads):
    await roads.wait_at_the_crossing()
    await roads.fleet.save()
    remove(roads)
    await roads.fleet.save()
    assert (await roads.fleet.roads.traffic.conflicts()).waiting == []
    await roads.fleet.watch_roads()
    assert roads.sql("select count(*) from holds") == [(0,)]


async def test_its_queue_is_told_no_more_and_sends_nothing(stored):
    await stored.set(task("a", "place"))
    assert len((await stored.queues.read(GetQueue())).queues) == 1
    remove(stored.yard)
    await stored.yard.fleet.save()
    await stored.advance()
    assert (await stored.queues.read(GetQueue())).queues == []
    assert stored.yard.waiting() == []


# --- at a desk --------------------------------------------------------------------------------------------


async def silence(yard, robot="r1", others=("r2",)):
    """Let nothing be heard of a robot for longer than the site's limits; ``others`` go on talking."""
    yard.now += 60.0
    for other in others:
        await yard.at(1.0, 2.0, robot=other)
    yard.fleet.robots.age(yard.now)
    assert yard.fleet.robots.get(robot).state.value == "lost"


async def at_desk(yard, *robots, reason=None):
    return await yard.fleet.removals.remove(RemoveRobots(list(robots), reason), "Ada")


async def test_a_supervisor_removes_one_that_is_lost_with_its_queue_and_its_command(stored):
    yard = stored.yard
    await stored.set(task("a", "place"), task("b"))
    await yard.send("other", robot="r2")
    await silence(yard)
    seen = yard.fleet.snapshots.after(EVERYTHING).revision
    report = await at_desk(yard, "r1")
    assert (report.removed, report.kept) == (["r1"], [])
    assert told(yard, seen)["removed"] == ["r1"]
    assert yard.sql("select name from robots") == [("r2",)]
    assert set((await yard.states()).values()) == {"failed", "queued"}
    assert (await yard.states())["other"] == "queued"
    await yard.ready()
    assert (await stored.report()).tasks == []
    assert {one.state.value for one in (await stored.report()).ended} == {"removed"}


@pytest.mark.parametrize("restarts", [False, True])
async def test_one_that_comes_back_is_told_to_abort_what_it_may_still_do(stored, restarts):
    yard = stored.yard
    await yard.send("a")
    await yard.acknowledge_all()
    await silence(yard)
    await at_desk(yard, "r1")
    if restarts:
        await yard.restart()
    await yard.ready()
    assert "Abort" in await yard.acknowledge_all()
    assert "Abort" not in await yard.acknowledge_all()


async def test_of_many_those_that_are_back_are_left_alone_and_named(stored):
    yard = stored.yard
    await silence(yard)
    report = await at_desk(yard, "r2", "r1", "r1", "r9")
    assert report.removed == ["r1"]
    assert [(one.robot, one.reason) for one in report.kept] == [
        ("r2", "robot 'r2' is fresh; only robots that are lost or offline are removed"),
        ("r9", "robot 'r9' is not known to this gateway"),
    ]
    with pytest.raises(RefusedError, match="'r2' is fresh; only robots that are lost or offline"):
        await at_desk(yard, "r2")
    assert yard.fleet.robots.names() == ["r2"]


async def test_while_an_emergency_stop_is_in_force_nobody_is_removed_from_its_count(stored):
    yard = stored.yard
    await silence(yard)
    await yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    with pytest.raises(RefusedError, match="an emergency stop is in force"):
        await at_desk(yard, "r1")
    assert yard.fleet.emergency.report().waiting == ["r1", "r2"]


@pytest.mark.parametrize("error", [StoreError, UncertainError])
async def test_what_could_not_be_stored_of_a_removal_is_done_later(stored, lose, error):
    yard = stored.yard
    await yard.send("a")
    await silence(yard)
    lose(yard, write_steps, done=False, error=error)
    assert (await at_desk(yard, "r1")).removed == ["r1"]
    await yard.fleet.save()
    assert (await yard.states())["a"] == "failed"
    assert "r1" not in yard.fleet.robots
