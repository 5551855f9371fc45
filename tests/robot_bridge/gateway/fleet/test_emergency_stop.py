"""An emergency stop on real databases: before all else, in force until it is cleared, never forgotten."""

from __future__ import annotations

import asyncio
import threading
import time
import uuid
from dataclasses import replace

import pytest

from robot_bridge.core.errors import RefusedError, StoreError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.commands import GetCommands, Send
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from robot_bridge.gateway.fleet import emergency_stop
from robot_bridge.protocol.codec import decode_desk_request


class Control:
    """An operator's and a supervisor's hands on the fleet of a yard."""

    def __init__(self, yard):
        self.yard = yard
        self.called = []
        yard.fleet.emergency.reach(self.called.append)

    async def stop(self, id="stop-0001", reason=None, by="Ada"):
        return await self.yard.fleet.emergency.stop(EmergencyStop(id, reason), by)

    async def clear(self, reason="all is well", stop=None, by="Eve"):
        return await self.yard.fleet.emergency.clear(ClearEmergencyStop(reason, stop), by)

    @property
    def report(self):
        return self.yard.fleet.emergency.report()

    def rows(self):
        """Return id, operator, reason and who cleared it of every stop."""
        rows = self.yard.sql("select * from emergency_stops order by at, id")
        return [(id, by, reason, cleared_by) for id, _, by, reason, _, cleared_by, _ in rows]

    def outbox(self, robot="r1"):
        """Return what a robot on SQL reads, in the order in which it does."""
        return [
            (op, bool(urgent))
            for op, urgent in self.yard.sql(
                "select op, urgent from sa where robot = ? order by urgent desc, id", robot
            )
        ]


@pytest.fixture
async def two(yard):
    """A yard with r1 over WebSocket and r2 over SQL; both have taken their maps."""
    for robot, link in (("r1", "websocket"), ("r2", "sql")):
        await yard.ready(robot, link=link)
        await yard.acknowledge_all(robot)
    yard.reported.clear()
    return yard


@pytest.fixture
def control(two, monkeypatch):
    # What is said of a disk that takes its time has a test of its own.
    monkeypatch.setattr(emergency_stop, "STORED_WITHIN", 60.0)
    return Control(two)


async def test_every_robot_is_told_before_anything_else(two, control):
    await two.ready("r1", magic=2)
    assert control.outbox() == [("SetMap", False)]
    report = await control.stop(reason="child on the track")
    assert control.outbox("r1") == [("Abort", True), ("SetMap", False)]
    assert control.outbox("r2") == [("Abort", True)]
    assert [row.op for row in await two.fleet.outboxes.outbox("r1", 0)] == ["Abort", "SetMap"]
    ((params,),) = two.sql("select params from sa where robot = 'r2'")
    assert params == '{"emergency": true}'
    assert control.called == ["emergency-stop-0001"]
    assert (report.in_force, report.stored, report.by, report.reason) == (
        True,
        True,
        "Ada",
        "child on the track",
    )
    assert (report.robots, report.acknowledged, report.waiting) == (2, 0, ["r1", "r2"])
    assert control.rows() == [("stop-0001", "Ada", "child on the track", None)]


async def test_the_log_tells_who_made_a_stop_and_who_cleared_it(two, control, caplog):
    await control.stop(reason="child on the track")
    await control.clear(reason="all is well")
    assert [record.message for record in caplog.records if record.name == emergency_stop.log.name] == [
        "emergency stop by Ada (child on the track)",
        "emergency stop of Ada cleared by Eve (all is well)",
    ]


async def test_what_robots_have_not_fetched_is_aborted_at_once_and_everything_else_when_they_say_so(
    two, control
):
    await two.ready("r3")
    await two.acknowledge_all("r3")
    await two.send("queued")
    await two.send("delivered", robot="r2")
    await two.deliver("r2")
    await two.send("driving", robot="r3")
    await two.acknowledge_all("r3")
    await control.stop(reason="smoke")
    assert control.outbox("r1") == control.outbox("r2") == [("Abort", True)]
    states = await two.states()
    assert {id: states[id] for id in ("queued", "delivered", "driving")} == {
        "queued": "aborted",
        "delivered": "delivered",
        "driving": "acknowledged",
    }
    assert await two.reason("queued") == "before the robot acknowledged it: smoke"
    for robot, id in (("r2", "delivered"), ("r3", "driving")):
        await two.acknowledge_all(robot)
        assert (await two.states())[id] == "aborted"
        assert await two.reason(id) == "the robot acknowledged the Abort: smoke"


@pytest.mark.parametrize("restarted", [False, True])
async def test_a_target_that_was_reached_before_the_stop_came_is_reached_and_not_aborted(
    two, control, restarted
):
    await two.send("cone", cone=True)
    (row,) = await two.deliver("r1")
    await control.stop()
    if restarted:
        await two.restart()
        await two.ready()
    # It is sent nothing of that any more, and had it already: it tells in order what it did.
    assert "SetPosEnd" not in two.waiting("r1")
    await two.ack(row.id)
    await two.at(50.0, 40.0)
    assert await two.steps("cone") == ["queued", "delivered", "acknowledged", "reached"]
    await two.acknowledge_all("r1")
    assert (await two.states())["cone"] == "reached"


async def test_a_robot_that_started_anew_after_a_stop_has_given_up_what_it_was_sent(two, control):
    await two.send("a")
    await two.deliver("r1")
    await control.stop()
    await two.ready("r1", magic=2)
    assert (await two.states())["a"] == "aborted"
    assert "SetPosEnd" not in two.waiting("r1")


async def test_nothing_that_drives_is_sent_while_it_is_in_force_and_an_abort_is(two, control):
    await control.stop(reason="smoke")
    for op, params in (
        ("SetPosEnd", {"x": 1.0, "y": 1.0}),
        ("SetPath", {"points": [(1.0, 1.0), (2.0, 2.0)]}),
    ):
        with pytest.raises(
            RefusedError, match=r"emergency stop is in force since 00:16:40 UTC, by Ada \(smoke\)"
        ):
            await two.fleet.orders.send(Send("command-a", "r1", op, params), "Bob")
    assert (await two.send("x", "Abort")).state.value == "queued"
    await control.clear()
    assert (await two.send("b")).state.value == "queued"


async def test_what_was_issued_before_is_answered_as_it_stands_while_it_is_in_force(two, control):
    await two.send("a")
    await control.stop()
    assert (await two.send("a")).state.value == "aborted"


async def test_sent_twice_it_is_done_once(two, control):
    await control.stop()
    first = two.sql("select id from sa where op = 'Abort'")
    assert (await control.stop(by="Bob")).by == "Ada"
    assert two.sql("select id from sa where op = 'Abort'") == first
    assert control.called == ["emergency-stop-0001"]


async def test_under_the_id_of_one_that_was_cleared_it_is_another_one(two, control):
    ids = [(await control.stop()).stop]
    for _ in range(2):
        await control.clear()
        again = await control.stop()
        assert again.in_force and again.stop not in ids
        assert (await control.stop()).stop == again.stop
        ids.append(again.stop)
    await control.clear()
    await two.restart()
    restarted = Control(two)
    last = await restarted.stop()
    assert last.in_force and last.stop not in ids
    assert control.called == [f"emergency-{id}" for id in ids] and len(restarted.called) == 1


@pytest.mark.parametrize("id", ["stop-0001", "1"])
async def test_it_is_sent_also_under_the_id_of_an_abort_of_all_robots(two, control, id):
    all_robots = decode_desk_request("abort_all", {"command": id})
    await two.fleet.orders.abort_all(all_robots, "Ada")
    await two.acknowledge_all("r1")
    await two.acknowledge_all("r2")
    await two.send("b")
    await two.acknowledge_all("r1")
    await two.fleet.emergency.stop(decode_desk_request("emergency_stop", {"command": id}), "Ada")
    assert control.outbox("r1") == control.outbox("r2") == [("Abort", True)]


async def test_two_operators_at_once_are_both_heard_and_cleared_together(two, control):
    reports = await asyncio.gather(control.stop("stop-of-ada"), control.stop("stop-of-bob", by="Bob"))
    assert all(report.in_force and report.stored for report in reports)
    assert control.outbox("r1") == [("Abort", True)]
    assert control.called == ["emergency-stop-of-ada", "emergency-stop-of-bob"]
    assert [row[:2] for row in control.rows()] == [("stop-of-ada", "Ada"), ("stop-of-bob", "Bob")]
    with pytest.raises(RefusedError, match=r"Bob made another emergency stop at .*; look at that one first"):
        await control.clear(stop="stop-of-ada")
    assert (await control.clear(stop="stop-of-bob")).in_force is False
    assert [row[3] for row in control.rows()] == ["Eve", "Eve"]


async def test_a_stop_made_while_another_is_being_cleared_is_in_force(two, control):
    await control.stop("stop-of-ada")
    await asyncio.gather(control.clear(), control.stop("stop-of-bob", by="Bob"))
    assert (control.report.in_force, control.report.stored, control.report.by) == (True, True, "Bob")
    await two.restart()
    assert Control(two).report.in_force


async def test_a_path_that_a_robot_asked_for_is_taken_back(two, control):
    two.sql("insert into sa (robot, op, params) values ('r2', 'SetPath', '{\"points\": [[1, 1], [2, 2]]}')")
    await control.stop()
    assert control.outbox("r2") == [("Abort", True)]


async def test_a_target_sent_in_the_same_moment_does_not_set_a_robot_in_motion(two, control):
    for k in range(10):
        results = await asyncio.gather(
            two.send(f"target-{k}"), control.stop(f"stop-{k:04}"), return_exceptions=True
        )
        states = await two.states()
        assert isinstance(results[0], RefusedError) or states[f"target-{k}"] == "aborted"
        assert control.outbox("r1") == [("Abort", True)]
        await control.clear()
        await two.acknowledge_all("r1")


async def test_a_robot_that_says_ready_meanwhile_is_stopped_before_it_gets_its_map(two, control):
    await control.stop(reason="smoke")
    await two.acknowledge_all("r1")
    assert control.report.waiting == ["r2"]
    await two.ready("new", link="sql")
    (told,) = (await two.fleet.orders.newest(GetCommands("new", 10))).commands
    assert uuid.UUID(told.command)
    assert (told.steps[0].by, told.steps[0].reason) == ("Ada", "smoke")
    await two.ready("r1", magic=2)
    assert control.outbox("new")[0] == control.outbox("r1")[0] == ("Abort", True)
    assert (control.report.robots, control.report.waiting) == (3, ["new", "r1", "r2"])
    before = two.sql("select id from sa where robot = 'new' and op = 'Abort'")
    await two.ready("new", link="sql")
    assert two.sql("select id from sa where robot = 'new' and op = 'Abort'") == before
    await control.clear()
    await two.ready("newer")
    assert ("Abort", True) not in control.outbox("newer")


async def test_it_is_counted_who_acknowledged_who_stands_and_who_refuses(two, control):
    await two.ready("r3")
    await two.acknowledge_all("r3")
    await control.stop()
    await two.acknowledge_all("r1")
    (abort,) = await two.deliver("r3")
    await two.ack(abort.id, "r3", ok=False, reason="no brakes")
    counted = control.report
    assert (counted.acknowledged, counted.standing, counted.waiting, counted.refused) == (
        1,
        0,
        ["r2"],
        ["r3"],
    )
    await two.at(1.0, 1.0, v=0.8)
    assert control.report.standing == 0
    await two.at(1.5, 1.0, v=0.0)
    await two.acknowledge_all("r2")
    two.fleet.age()
    counted = control.report
    assert (counted.acknowledged, counted.standing, counted.waiting, counted.refused) == (2, 1, [], ["r3"])
    before = control.report
    await two.restart()
    # Where r1 is now it has not said to this gateway.
    assert Control(two).report == replace(before, standing=0, unheard=["r1", "r2"])


async def test_what_a_robot_answers_to_the_direct_call_counts_and_that_to_another_does_not(two, control):
    await control.stop()
    emergency = two.fleet.emergency
    emergency.answered("r1", "emergency-of-another-kind", refused=False)
    assert control.report.acknowledged == 0
    emergency.answered("r1", control.called[0], refused=False)
    emergency.answered("r2", control.called[0], refused=True)
    assert (control.report.acknowledged, control.report.refused) == (1, ["r2"])
    await two.acknowledge_all("r2")
    assert (control.report.acknowledged, control.report.refused) == (2, [])


async def test_every_operator_is_told_of_each_change(two, control):
    told = []

    class Listener:
        def notify(self, method, key, params):
            if method == "emergency":
                told.append((params["in_force"], params["stored"], params["acknowledged"]))

    two.fleet.listeners.add(Listener())
    await control.stop()
    await two.acknowledge_all("r1")
    async with asyncio.timeout(30):
        while len(told) < 3:
            await asyncio.sleep(0.01)
    await control.clear()
    assert told == [(True, False, 0), (True, True, 0), (True, True, 1), (False, True, 1)]


async def test_it_is_in_force_until_it_is_cleared_however_often_the_gateway_starts_anew(two, control):
    await two.send("driving")
    await two.acknowledge_all("r1")
    await control.stop(reason="smoke")
    for _ in range(2):
        two.now += 10_000.0
        await two.fleet.save()
        await two.restart()
        control = Control(two)
        assert (control.report.in_force, control.report.by, control.report.reason) == (True, "Ada", "smoke")
        assert control.outbox("r1") == [("Abort", True)]  # however old, it is not given up
        with pytest.raises(RefusedError, match="an emergency stop is in force"):
            await two.send("b")
    assert (await control.clear("smoke is gone")).cleared_by == "Eve"
    await two.restart()
    report = two.fleet.emergency.report()
    assert (report.in_force, report.clear_reason) == (False, "smoke is gone")
    assert (await two.send("b")).state.value == "queued"


async def test_an_ordinary_abort_does_not_take_its_place(two, control):
    await control.stop()
    await two.send("x", "Abort")
    assert control.outbox("r1") == [("Abort", True), ("Abort", False)]


async def test_a_robot_that_missed_it_is_stopped_before_it_is_sent_on(two, control):
    await two.send("driving")
    await two.acknowledge_all("r1")
    await control.stop()
    await control.clear()
    await two.send("next")
    assert control.outbox("r1") == [("Abort", True), ("SetPosEnd", False)]


async def test_there_is_nothing_to_clear_twice(two, control):
    with pytest.raises(RefusedError, match="no emergency stop is in force; there is nothing to clear"):
        await control.clear()
    await control.stop()
    await control.clear(stop="stop-0001")
    assert (await control.clear(stop="stop-0001", by="Max")).cleared_by == "Eve"  # asked again
    with pytest.raises(RefusedError, match="no emergency stop is in force"):
        await control.clear()


# --- the database is away ---------------------------------------------------------------------------------


async def test_a_stop_that_cannot_be_stored_is_in_force_and_on_its_way_and_stored_later(two, control):
    await two.send("queued")
    two.client.break_table("emergency_stops")
    report = await control.stop(reason="smoke")
    assert (report.in_force, report.stored, control.called) == (True, False, ["emergency-stop-0001"])
    # Of no command; the target was withdrawn, and would be held back.
    assert [row.op for row in await two.fleet.outboxes.outbox("r1", 0)] == two.waiting("r1") == ["Abort"]
    with pytest.raises(RefusedError, match="an emergency stop is in force"):
        await two.send("b")
    with pytest.raises(StoreError):
        await two.fleet.save()
    with pytest.raises(StoreError):
        await control.clear()
    assert control.report.in_force
    two.client.mend_table("emergency_stops")
    await two.fleet.save()
    assert control.report.stored
    assert control.outbox("r1") == control.outbox("r2") == [("Abort", True)] * 2
    assert [row[:3] for row in control.rows()] == [("stop-0001", "Ada", "smoke")]
    await two.restart()
    assert Control(two).report.in_force


async def test_a_database_that_does_not_answer_delays_no_stop(two, control, monkeypatch):
    await two.ready("r1", magic=1)
    monkeypatch.setattr(emergency_stop, "STORED_WITHIN", 1.0)
    thawed = threading.Event()
    frozen = asyncio.ensure_future(two.database.run(lambda connection: thawed.wait(60)))
    await asyncio.sleep(0.05)
    began = time.monotonic()
    stopping = asyncio.ensure_future(control.stop())
    async with asyncio.timeout(20):
        while not control.called:
            await asyncio.sleep(0)
    report = await stopping
    assert time.monotonic() - began > 0.9
    assert (report.in_force, report.stored) == (True, False)
    thawed.set()
    await frozen
    await two.fleet.save()
    assert control.report.stored


async def test_a_stop_is_stored_before_it_is_cleared(two, control):
    two.client.break_table("emergency_stops")
    await control.stop()
    two.client.mend_table("emergency_stops")
    await control.clear()
    assert control.rows() == [("stop-0001", "Ada", None, "Eve")]
    assert control.outbox("r1") == [("Abort", True)] * 2
    await two.fleet.save()
    await two.restart()
    assert Control(two).report.in_force is False


async def test_a_stop_that_is_pressed_again_goes_out_over_sql_though_the_first_one_is_not_stored(
    two, control
):
    await two.ready("r2", magic=2, link="sql")
    two.client.break_table("emergency_stops")
    aborts = []
    for number in (1, 2, 3):
        await control.stop(f"stop-000{number}")
        aborts.append(two.waiting("r2").count("Abort"))
    assert aborts[0] < aborts[1] < aborts[2]
    two.client.mend_table("emergency_stops")


async def test_two_stops_without_a_database_are_both_stored_when_it_is_back(two, control):
    two.client.break_table("emergency_stops")
    await control.stop("stop-of-ada")
    await control.stop("stop-of-bob", by="Bob")
    two.client.mend_table("emergency_stops")
    await two.fleet.save()
    assert [row[:2] for row in control.rows()] == [("stop-of-ada", "Ada"), ("stop-of-bob", "Bob")]
    assert control.outbox("r1") == [("Abort", True)] * 2


# --- what is not possible ---------------------------------------------------------------------------------


@pytest.mark.parametrize("id", ["id", "x" * 65, "stop\x000001"])
def test_a_stop_without_an_id_of_its_own_is_refused(id):
    with pytest.raises(MessageError, match="give an id of 8 to 64 characters"):
        EmergencyStop(id)


@pytest.mark.parametrize(
    ("reason", "stored"),
    [("smoke\nin\x00hall 3 ", "smoke in hall 3"), ("x" * 600, "x" * 500), ("\ud800", None), ("", None)],
)
async def test_a_stop_is_not_refused_for_what_is_said_about_it(two, control, reason, stored):
    assert (await control.stop(reason=reason)).stored
    assert [row[2] for row in control.rows()] == [stored]


@pytest.mark.parametrize("reason", ["x" * 501, "two\nlines", "\x00"])
def test_a_reason_that_is_no_line_of_the_log_is_refused(reason):
    with pytest.raises(MessageError, match="give one line of at most 500 printable ones"):
        ClearEmergencyStop(reason)


async def test_nobody_makes_an_emergency_of_one_robot(two):
    with pytest.raises(MessageError, match="emergency is for every robot; ask for emergency_stop"):
        await two.fleet.orders.send(Send("command-a", "r1", "Abort", {"emergency": True}), "Bob")
