"""What nobody foresaw of one robot is logged, and keeps nothing of the others, nor what comes after it."""

from __future__ import annotations

import asyncio
import re
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import DataRefusedError, StoreError
from robot_bridge.core.messages.commands import AbortAll, AbortTask
from robot_bridge.core.messages.queues import QueueTask, SetQueue
from robot_bridge.core.messages.robots import SetObject
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.commands.active_command import CommandOrder
from robot_bridge.gateway.commands.validation import CommandValidator, StopTimes
from robot_bridge.gateway.fleet import robot_outboxes
from robot_bridge.gateway.model.events import CommandChanged, Listeners, ObservationChanged
from robot_bridge.gateway.model.robots import Robots
from robot_bridge.gateway.storage.repositories import requests
from tests.support.patience import until


@pytest.fixture
async def two(roads):
    for robot, y in (("r1", 40.0), ("r2", 42.0)):
        await roads.ready(robot)
        await roads.acknowledge_all(robot)
        await roads.at(20.0, y, robot=robot)
    return roads


def subscribe_first(fleet, kind, handler):
    """Let ``handler`` hear of events of a kind before all others."""
    fleet.events._subscribers[kind].insert(0, handler)


def fail_once(monkeypatch, owner, method, error, is_meant):
    """Let ``method`` of ``owner`` raise ``error`` the first time that ``is_meant`` of its first argument."""
    real, meant = getattr(owner, method), [is_meant]

    async def failing(first, *more):
        if meant and meant[0](first):
            meant.clear()
            raise error
        return await real(first, *more)

    monkeypatch.setattr(owner, method, failing)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (KeyError("nobody foresaw this"), "queue of r1; it is looked at again: internal error"),
        (StoreError("the disk is full"), "queue of r1: the disk is full; it is looked at again"),
    ],
)
async def test_a_queue_in_trouble_holds_up_no_other_and_is_looked_at_again(
    two, monkeypatch, caplog, error, said
):
    driving = two.fleet.driving
    fail_once(monkeypatch, driving._settling, "settle", error, lambda queue: queue.robot == "r1")
    for robot in ("r1", "r2"):
        await two.fleet.queues.set(SetQueue(robot, 0, [QueueTask(f"task-{robot}-1", 24.0, 40.0)]), "Ada")
    await driving.advance()
    assert (two.waiting("r1"), two.waiting("r2")) == ([], ["SetPath"])
    assert said in caplog.text
    driving.schedule_all()
    await driving.advance()
    assert two.waiting("r1") == ["SetPath"]


@pytest.mark.parametrize(
    ("error", "lines"), [(KeyError("nobody foresaw this"), 2), (StoreError("the disk is full"), 1)]
)
async def test_queues_in_a_trouble_that_lasts_fill_no_log(two, monkeypatch, caplog, error, lines):
    """They are looked at every two seconds; a database that takes nothing is said once of all of them."""
    driving = two.fleet.driving

    async def fail(_queue):
        raise error

    monkeypatch.setattr(driving._settling, "settle", fail)
    for robot in ("r1", "r2"):
        await two.fleet.queues.set(SetQueue(robot, 0, [QueueTask(f"task-{robot}-1", 24.0, 40.0)]), "Ada")
    for _ in range(3):
        driving.schedule_all()
        await driving.advance()
    assert caplog.text.count("it is looked at again") == lines


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (KeyError("nobody foresaw this"), "robot r1, which waits for r2: internal error"),
        (StoreError("the disk is full"), "robot r1, which waits for r2, is not sent on: the disk is full"),
    ],
)
async def test_one_that_waits_in_trouble_holds_up_no_other_that_waits(
    roads, monkeypatch, caplog, error, said
):
    await roads.wait_at_the_crossing()
    waiting, sent_on = roads.fleet.roads.waiting, []
    monkeypatch.setitem(waiting._rows, "r2", waiting._rows["r1"]._replace(robot="r2", other="r1"))

    async def send_on(row, _seen):
        if row.robot == "r1":
            raise error
        sent_on.append(row.robot)

    monkeypatch.setattr(waiting, "_send_on", send_on)
    await roads.fleet.watch_roads()
    assert sent_on == ["r2"]
    # It is tried every second, and said once.
    await roads.fleet.watch_roads()
    assert sent_on == ["r2", "r2"]
    assert caplog.text.count(said) == 1


@pytest.mark.parametrize(
    ("owner", "name"),
    [
        (CommandValidator, "draft"),
        (StopTimes, "check"),
        (CommandOrder, "is_stop"),
        (requests, "_named"),
    ],
)
async def test_an_abort_of_all_comes_to_the_others_whatever_is_wrong_with_one(two, monkeypatch, owner, name):
    await two.ready("r3", link="sql")
    call, real = [], getattr(owner, name)

    def fail_for_one(*arguments):
        if any("r1" in (one, getattr(one, "robot", None)) for one in arguments):
            raise KeyError("nobody foresaw this")
        return real.fget(*arguments) if isinstance(real, property) else real(*arguments)

    monkeypatch.setattr(owner, name, property(fail_for_one) if isinstance(real, property) else fail_for_one)
    find = Robots.get
    monkeypatch.setattr(Robots, "get", lambda robots, robot: find(robots, {"r1": "nobody"}.get(robot, robot)))
    two.fleet.orders.reach(lambda robot, _id: call.append(robot) or True)
    with pytest.raises(StoreError, match=r"internal error .* it was sent to r1, r2"):
        await two.fleet.orders.abort_all(AbortAll(), "Ada")
    assert call[:2] == ["r1", "r2"]
    assert ("Abort",) in two.sql("select op from sa where robot = ?", "r3")
    # As it is done every second.
    await two.fleet.orders._commands.save_progress()
    assert two.waiting("r2") == ["Abort"]


async def test_a_map_that_cannot_be_stored_for_long_fills_no_log(two, monkeypatch, caplog):
    monkeypatch.setattr(robot_outboxes, "RETRY_AFTER", 0.0)
    tried = []

    async def fail(robot):
        tried.append(robot)
        raise StoreError("the disk is full")

    monkeypatch.setattr(two.fleet.maps, "_follow", fail)
    two.fleet.outboxes.parts.put_nowait("r1")
    running = asyncio.create_task(two.fleet.maps.run())
    await until(lambda: len(tried) > 3)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
    assert caplog.text.count("the map for robot 'r1': the disk is full") == 1


async def test_an_observation_that_cannot_be_told_of_is_stored_and_acknowledged(two, caplog):
    subscribe_first(two.fleet, ObservationChanged, fail)
    outcome = await two.fleet.receive("r1", "websocket", SetObject(100.0, 80.0, "cone-7"), 7)
    assert (outcome.ack.id, outcome.ack.ok) == (7, True)
    assert two.sql("select object from observations") == [("cone-7",)]
    assert "telling of observation 1 failed; what comes after it is done all the same" in caplog.text


def test_a_desk_that_cannot_be_told_keeps_no_other_from_hearing():
    class Desk:
        def __init__(self, error=None):
            self.heard, self.error = [], error

        def notify(self, method, key, params):
            self.heard.append(method)
            if self.error is not None:
                raise self.error

    desks, listeners = [Desk(), Desk(KeyError("nobody foresaw this")), Desk()], Listeners()
    for desk in desks:
        listeners.add(desk)
    listeners.announce("emergency", "emergency", {})
    assert [desk.heard for desk in desks] == [["emergency"]] * 3


def fail(*_anything):
    raise KeyError("nobody foresaw this")


def no_journal(fleet):
    fleet.emergency._journal = SimpleNamespace(write=fail)


def no_link(fleet):
    fleet.emergency.reach(fail)


def no_operators(fleet):
    fleet.emergency._listeners = SimpleNamespace(announce=fail)


def no_command_told(fleet):
    subscribe_first(fleet, CommandChanged, fail)


@pytest.mark.parametrize(
    ("part", "said"),
    [
        (no_journal, ["noting an emergency stop", "noting that an emergency stop is stored"]),
        (no_link, ["sending an emergency stop over open connections"]),
        (no_operators, ["announcing an emergency stop"]),
        (no_command_told, ["telling of command"]),
    ],
)
async def test_an_emergency_stop_goes_on_whatever_fails_of_it(two, caplog, part, said):
    part(two.fleet)
    called = []
    two.fleet.emergency.reach(called.append)
    report = await two.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    assert (report.in_force, report.stored, called) == (True, True, ["emergency-stop-0001"])
    assert (two.waiting("r1"), two.waiting("r2")) == (["Abort"], ["Abort"])
    for what in said:
        assert re.search(f"{what}.* failed; what comes after it is done all the same", caplog.text)


async def test_an_emergency_stop_that_cannot_be_stored_at_once_is_stored_soon(two, monkeypatch, caplog):
    fail_once(monkeypatch, two.fleet.emergency._writer, "write", KeyError("nobody foresaw this"), bool)
    report = await two.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    assert (report.in_force, report.stored) == (True, False)
    assert "the emergency stop is in force and not stored yet" in caplog.text
    await two.fleet.save()
    assert two.fleet.emergency.report().stored
    assert two.waiting("r1") == ["Abort"]


@pytest.mark.parametrize("error", [KeyError("nobody foresaw this"), DataRefusedError("it is refused")])
async def test_a_late_acknowledgement_in_trouble_is_forgotten_and_others_have_their_turn(
    two, monkeypatch, error
):
    book, taken = two.fleet._commands, []
    monkeypatch.setattr(book, "_late", {("r1", 1), ("r2", 2), ("r1", 3)})

    async def acknowledge(robot, ack):
        if robot == "r1":
            raise error
        taken.append((robot, ack.id))

    monkeypatch.setattr(book, "acknowledge", acknowledge)
    await two.fleet.save()
    assert (taken, book._late) == ([("r2", 2)], set())


async def test_a_late_acknowledgement_is_kept_while_the_database_is_away(two, monkeypatch):
    book = two.fleet._commands
    monkeypatch.setattr(book, "_late", {("r1", 1)})
    fail_once(monkeypatch, book, "acknowledge", StoreError("the disk is full"), bool)
    with pytest.raises(StoreError, match="the disk is full"):
        await two.fleet.save()
    assert book._late == {("r1", 1)}


HEAR_OF_STEPS = ["emergency.note_step", "driving.note_step", "roads.note_step"]


@pytest.mark.parametrize("part", ["robots.assign", *HEAR_OF_STEPS])
async def test_a_part_that_fails_at_an_event_keeps_it_from_no_other_and_stops_from_no_robot(
    two, monkeypatch, caplog, part
):
    for name in HEAR_OF_STEPS:
        owner, method = getattr(two.fleet, name.split(".")[0]), name.split(".")[1]
        real = getattr(owner, method)
        monkeypatch.setattr(owner, method, lambda report, n=name, real=real: (seen.add(n), real(report)))
    seen = set()
    owner, method = part.split(".")
    monkeypatch.setattr(getattr(two.fleet, owner), method, fail)
    two.reported.clear()
    report = await two.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    assert report.stored and two.reported
    assert seen | {part} >= set(HEAR_OF_STEPS)
    await two.fleet.orders.abort(AbortTask("abort-0001", robot="r1"), "Ada")
    assert (two.waiting("r1"), two.waiting("r2")) == (["Abort", "Abort"], ["Abort"])
    assert re.search("telling of command .* failed; what comes after it is done all the same", caplog.text)
