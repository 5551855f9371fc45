"""Commands on a real SQLite file: every step stored before it is told, none done twice, none lost."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import RefusedError, StoreError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.commands import AbortAll, GetCommands, Send, SetPositions, TargetPosition

FULL_LIFE = ["queued", "delivered", "acknowledged", "reached"]


@pytest.fixture
async def ready(yard):
    """A yard with robot r1, which has taken its map."""
    await yard.ready()
    await yard.acknowledge_all()
    return yard


async def test_a_target_is_queued_delivered_acknowledged_and_reached(ready):
    report = await ready.send("a", x=50.0, y=40.0)
    assert (report.state.value, report.operator) == ("queued", "Ada")
    assert await ready.acknowledge_all() == ["SetPosEnd"]
    await ready.at(20.0, 40.0, v=1.0)
    await ready.at(49.95, 40.1, v=0.5)
    assert await ready.steps("a") == FULL_LIFE[:3]
    await ready.at(49.95, 40.1)
    assert await ready.steps("a") == FULL_LIFE
    assert ready.reported == [("command-a", state) for state in FULL_LIFE]
    ((deviation,),) = ready.sql("select deviation from commands")
    assert deviation == pytest.approx(0.1118, abs=1e-4)
    assert ready.waiting() == []


async def test_a_command_is_stored_with_its_message_before_it_is_told(ready):
    seen = []
    ready.notify = lambda *news: seen.append(ready.sql("select state from commands"))
    ready.fleet.listeners.add(ready)
    await ready.send("a")
    assert seen == [[("queued",)]]
    assert ready.waiting() == ["SetPosEnd"]


async def test_a_robot_at_its_target_has_not_reached_what_it_did_not_acknowledge(ready):
    await ready.send("a", x=50.0, y=40.0)
    await ready.deliver()
    await ready.at(50.0, 40.0)
    assert await ready.states() == {"a": "delivered"}


async def test_the_newer_target_supersedes_the_older_at_any_point_of_its_life(ready):
    await ready.send("a")
    await ready.send("b")
    assert ready.waiting() == ["SetPosEnd"]
    await ready.deliver()
    await ready.send("c")
    await ready.acknowledge_all()
    await ready.send("d", "SetPath", points=[(1.0, 1.0), (2.0, 2.0)])
    assert await ready.states() == {"a": "superseded", "b": "superseded", "c": "superseded", "d": "queued"}
    assert await ready.reason("c") == "by command command-d"
    assert ready.waiting() == ["SetPath"]


async def test_targets_of_other_robots_are_left_alone(ready):
    await ready.ready("r2")
    await ready.send("a")
    await ready.send("b", robot="r2")
    assert await ready.states() == {"a": "queued", "b": "queued"}


async def test_an_abort_before_delivery_ends_the_target_at_once(ready):
    await ready.send("a")
    await ready.send("x", "Abort")
    assert await ready.states() == {"a": "aborted", "x": "queued"}
    assert await ready.reason("a") == "before the robot acknowledged it"
    assert ready.waiting() == ["Abort"]


async def test_an_abort_after_delivery_ends_the_target_when_the_robot_acknowledges(ready):
    await ready.send("a")
    await ready.acknowledge_all()
    await ready.send("x", "Abort")
    assert await ready.states() == {"a": "acknowledged", "x": "queued"}
    await ready.acknowledge_all()
    assert await ready.states() == {"a": "aborted", "x": "acknowledged"}
    await ready.at(20.0, 20.0, v=0.8)
    assert (await ready.states())["x"] == "acknowledged"
    await ready.at(20.4, 20.0, v=0.0)
    assert (await ready.states())["x"] == "reached"


async def test_a_target_sent_after_an_abort_outlives_it(ready):
    await ready.send("a")
    await ready.acknowledge_all()
    await ready.send("x", "Abort")
    await ready.send("b")
    await ready.acknowledge_all()
    assert await ready.states() == {"a": "superseded", "x": "acknowledged", "b": "acknowledged"}


async def test_abort_all_tells_every_robot(ready):
    await ready.ready("r2", link="sql")
    aborts = (await ready.fleet.orders.abort_all(AbortAll(), "Ada")).commands
    assert sorted(abort.robot for abort in aborts) == ["r1", "r2"]
    assert ready.waiting("r1") == ["Abort"]
    assert "Abort" in ready.waiting("r2")


async def test_abort_all_asked_again_under_its_id_changes_nothing(ready):
    await ready.ready("r2", link="sql")
    first = (await ready.fleet.orders.abort_all(AbortAll("one-press-of-the-button"), "Ada")).commands
    again = (await ready.fleet.orders.abort_all(AbortAll("one-press-of-the-button"), "Ada")).commands
    assert [abort.command for abort in again] == [abort.command for abort in first]
    assert ready.waiting("r1") == ["Abort"]
    other = (await ready.fleet.orders.abort_all(AbortAll(), "Ada")).commands
    assert {abort.command for abort in other}.isdisjoint(abort.command for abort in first)


async def test_an_abort_ends_without_a_deviation(ready):
    await ready.send("x", "Abort")
    await ready.acknowledge_all()
    await ready.at(3.0, 4.0)
    (report,) = (await ready.fleet.orders.newest(GetCommands("r1", 1))).commands
    assert (report.state.value, report.deviation) == ("reached", None)


async def test_a_repeated_id_changes_nothing(ready):
    await ready.send("a", x=50.0)
    await ready.acknowledge_all()
    ready.reported.clear()
    again = await ready.send("a", x=60.0)
    assert again.state.value == "acknowledged"
    assert again.params["x"] == 50.0
    assert (ready.reported, ready.waiting()) == ([], [])
    await ready.send("b")
    assert (await ready.send("a")).state.value == "superseded"
    assert await ready.states() == {"a": "superseded", "b": "queued"}


async def test_a_refusal_of_the_robot_fails_the_command_with_its_reason(ready):
    await ready.send("a")
    (row,) = await ready.deliver()
    await ready.ack(row.id, ok=False, reason="battery empty")
    assert await ready.states() == {"a": "failed"}
    assert await ready.reason("a") == "battery empty"
    assert ready.waiting() == []


async def test_a_robot_may_give_up_what_it_had_acknowledged(ready):
    await ready.send("a")
    (row,) = await ready.deliver()
    await ready.ack(row.id)
    await ready.ack(row.id, ok=False, reason="way blocked")
    assert await ready.steps("a") == ["queued", "delivered", "acknowledged", "failed"]


async def test_acknowledgements_that_come_twice_or_of_nothing_change_nothing(ready):
    await ready.send("a")
    (row,) = await ready.deliver()
    for id in (row.id, row.id, row.id + 1000, None):
        await ready.ack(id)
    assert await ready.steps("a") == ["queued", "delivered", "acknowledged"]


async def test_a_robot_cannot_acknowledge_for_another(ready):
    await ready.ready("r2")
    await ready.send("a")
    (row,) = await ready.deliver()
    await ready.ack(row.id, robot="r2")
    assert await ready.states() == {"a": "delivered"}
    assert ready.waiting() == ["SetPosEnd"]


async def test_a_command_that_is_never_fetched_expires_and_a_delivered_one_does_not(ready):
    await ready.ready("r2")
    await ready.send("a")
    await ready.send("b", robot="r2")
    await ready.deliver("r2")
    ready.now += 299.0
    await ready.fleet.save()
    assert await ready.states() == {"a": "queued", "b": "delivered"}
    ready.now += 2.0
    await ready.fleet.save()
    assert await ready.states() == {"a": "expired", "b": "delivered"}
    assert await ready.reason("a") == "the robot did not fetch it in time"
    assert ready.waiting() == []


# --- a robot that starts anew -----------------------------------------------------------------------------


async def test_a_robot_that_started_anew_gets_its_task_again_under_a_new_id(ready):
    await ready.send("a", x=50.0, y=40.0)
    (first,) = await ready.deliver()
    await ready.ack(first.id)
    await ready.ready(magic=2)
    rows = {row.op: row for row in await ready.deliver()}
    assert rows["SetPosEnd"].id > first.id
    await ready.at(50.0, 40.0)
    assert await ready.states() == {"a": "acknowledged"}
    await ready.ack(rows["SetPosEnd"].id)
    await ready.at(50.0, 40.0)
    assert (await ready.steps("a"))[-1] == "reached"


async def test_a_robot_that_only_reconnected_gets_nothing_again(ready):
    await ready.send("a")
    await ready.acknowledge_all()
    await ready.ready(magic=1)
    assert await ready.acknowledge_all() == ["SetMap"]
    assert await ready.steps("a") == ["queued", "delivered", "acknowledged"]


async def test_what_was_delivered_and_not_acknowledged_waits_until_it_is(ready):
    await ready.send("a")
    await ready.deliver()
    await ready.ready(magic=1)
    assert "SetPosEnd" in await ready.acknowledge_all()
    assert await ready.states() == {"a": "acknowledged"}


@pytest.mark.parametrize("abort_delivered", [False, True])
async def test_a_robot_that_started_anew_is_not_sent_what_an_operator_aborted(ready, abort_delivered):
    await ready.send("a")
    await ready.acknowledge_all()
    await ready.send("x", "Abort")
    if abort_delivered:
        await ready.deliver()
    await ready.ready(magic=2)
    assert [op for op in await ready.acknowledge_all() if op != "SetMap"] == ["Abort"]
    assert await ready.states() == {"a": "aborted", "x": "acknowledged"}


@pytest.mark.parametrize("acknowledged", [False, True])
async def test_a_robot_that_started_anew_gets_what_it_forgot_in_the_order_it_was_asked(ready, acknowledged):
    await ready.send("x", "Abort")
    await ready.deliver()
    await ready.send("b")
    if acknowledged:
        await ready.ack((await ready.deliver())[-1].id)
    await ready.ready(magic=2)
    assert [op for op in await ready.acknowledge_all() if op != "SetMap"] == ["Abort", "SetPosEnd"]
    assert await ready.states() == {"x": "acknowledged", "b": "acknowledged"}


# --- a gateway that starts anew ---------------------------------------------------------------------------


async def test_open_commands_outlive_the_gateway(ready):
    for robot in ("r2", "r3"):
        await ready.ready(robot)
    await ready.send("a", x=50.0, y=40.0)
    await ready.acknowledge_all()
    await ready.send("b", robot="r2")
    await ready.deliver("r2")
    await ready.send("c", robot="r3")
    await ready.restart()
    assert await ready.states() == {"a": "acknowledged", "b": "delivered", "c": "queued"}
    assert {r.robot: r.command for r in ready.fleet.reports()} == {
        "r1": "command-a",
        "r2": "command-b",
        "r3": "command-c",
    }
    await ready.at(50.0, 40.0)
    assert "SetPosEnd" in await ready.acknowledge_all("r2")
    assert "SetPosEnd" in await ready.acknowledge_all("r3")
    assert await ready.states() == {"a": "reached", "b": "acknowledged", "c": "acknowledged"}


async def test_a_path_half_driven_is_followed_to_its_end_when_the_gateway_starts_anew(ready):
    await ready.send("a", "SetPath", points=[(10.0, 10.0), (60.0, 10.0)])
    await ready.acknowledge_all()
    for x in range(10, 31, 2):
        await ready.at(float(x), 10.0, v=2.0)
    await ready.restart()
    for x in range(32, 60, 2):
        await ready.at(float(x), 10.0, v=2.0)
    assert await ready.states() == {"a": "acknowledged"}
    await ready.at(60.0, 10.0)
    assert await ready.states() == {"a": "reached"}


async def test_ended_commands_stay_ended_when_the_gateway_starts_anew(ready):
    await ready.send("a")
    await ready.send("b")
    await ready.send("x", "Abort")
    await ready.acknowledge_all()
    await ready.at(1.0, 1.0)
    before = await ready.states()
    await ready.restart()
    assert before == await ready.states() == {"a": "superseded", "b": "aborted", "x": "reached"}
    assert (ready.reported, ready.waiting()) == ([], [])


async def test_a_robot_is_where_it_was_when_the_gateway_starts_anew(ready):
    await ready.at(12.0, 34.0, v=1.0)
    await ready.fleet.save()
    ready.now += 5.0
    await ready.restart()
    (report,) = ready.fleet.reports()
    assert (report.x, report.y, report.state.value, report.age) == (12.0, 34.0, "stale", 5.0)
    assert ready.sql("select robot, x, y, received_at from trajectories") == [("r1", 12.0, 34.0, 1000.0)]


# --- all or none ------------------------------------------------------------------------------------------


async def test_set_positions_sends_all_targets(ready):
    await ready.ready("r2")
    targets = [TargetPosition("r1", 1.0, 2.0, cone=True), TargetPosition("r2", 3.0, 4.0, 0.5)]
    reports = await ready.fleet.orders.set_positions(SetPositions(targets), "Ada")
    # Left out, no cone is placed, by whichever request a target comes.
    assert [(r.robot, r.op, r.params, r.state.value) for r in reports.commands] == [
        ("r1", "SetPosEnd", {"x": 1.0, "y": 2.0, "cone": True}, "queued"),
        ("r2", "SetPosEnd", {"x": 3.0, "y": 4.0, "theta": 0.5, "cone": False}, "queued"),
    ]


@pytest.mark.parametrize(
    ("second", "text"),
    [
        (TargetPosition("r9", 3.0, 4.0), r"robot 'r9' is not known to this gateway; known are: r1, r2"),
        (TargetPosition("r2", 300.0, 4.0), r"\(300.00, 4.00\) lies outside site 'Sample proving ground"),
        (TargetPosition("r1", 3.0, 4.0), r"r1 is named more than once"),
    ],
)
async def test_set_positions_sends_none_when_one_is_refused(ready, second, text):
    await ready.ready("r2")
    with pytest.raises(RefusedError, match=text):
        await ready.fleet.orders.set_positions(SetPositions([TargetPosition("r1", 1.0, 2.0), second]), "Ada")
    assert await ready.states() == {}
    assert ready.waiting() == []


async def test_a_transaction_that_fails_leaves_nothing_in_memory(ready):
    await ready.ready("r2")
    await ready.acknowledge_all("r2")
    await ready.send("a")
    ready.reported.clear()
    refuse_commands_of_r2(ready)
    with pytest.raises(StoreError, match=r"database .* refuses a value"):
        await ready.fleet.orders.set_positions(
            SetPositions([TargetPosition("r1", 1.0, 2.0), TargetPosition("r2", 3.0, 4.0)]), "Ada"
        )
    assert await ready.states() == {"a": "queued"}
    assert ready.reported == []
    assert (ready.waiting("r1"), ready.waiting("r2")) == (["SetPosEnd"], [])
    assert {r.robot: r.command for r in ready.fleet.reports()} == {"r1": "command-a", "r2": None}
    await ready.acknowledge_all()
    assert await ready.states() == {"a": "acknowledged"}


def refuse_commands_of_r2(yard):
    """Let the second of two commands fail when the first is written already."""
    if yard.client.kind == "sqlite":
        how = "create trigger refused before insert on commands when new.robot = 'r2'"
        yard.sql(f"{how} begin select raise(abort, 'not r2'); end")
    else:
        yard.sql("alter table commands add constraint refused check (robot <> 'r2')")


async def test_a_step_that_cannot_be_stored_is_not_told_and_not_lost(ready):
    await ready.send("a")
    (row,) = await ready.deliver()
    ready.reported.clear()
    ready.client.break_table("command_steps")
    with pytest.raises(StoreError, match="command_steps"):
        await ready.ack(row.id)
    assert (ready.reported, ready.waiting()) == ([], ["SetPosEnd"])
    ready.client.mend_table("command_steps")
    await ready.ack(row.id)
    assert ready.reported == [("command-a", "acknowledged")]


# --- what is not sent -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("op", "params", "error", "text"),
    [
        (
            "SetPosEnd",
            {"x": 200.5, "y": 4.0},
            RefusedError,
            r"\(200.50, 4.00\) lies outside .* \(0.00",
        ),
        ("SetPath", {"points": [[1, 1], [1, -1]]}, RefusedError, r"\(1.00, -1.00\) lies outside"),
        ("SetPosEnd", {"x": 1.0}, MessageError, "SetPosEnd: Object missing required field `y`"),
        ("SetPosEnd", {"x": 1.0, "y": "2"}, MessageError, r"SetPosEnd: .*\$\.y"),
        (
            "SetMap",
            {},
            MessageError,
            "op 'SetMap' cannot be sent to a robot; choose one of",
        ),
    ],
)
async def test_what_cannot_be_driven_is_refused_and_not_stored(ready, op, params, error, text):
    with pytest.raises(error, match=text):
        await ready.fleet.orders.send(Send("command-a", "r1", op, params), "Ada")
    assert await ready.states() == {}


async def test_a_target_on_the_edge_of_the_site_is_on_it(ready):
    assert (await ready.send("a", x=200.0, y=160.0)).state.value == "queued"


async def test_an_acknowledgement_proves_a_delivery_that_was_not_seen(ready):
    await ready.send("a", x=50.0, y=40.0)
    (row,) = await ready.fleet.outboxes.outbox("r1", 0)
    await ready.ack(row.id)
    await ready.fleet.outboxes.delivered([row.id])
    await ready.at(50.0, 40.0)
    assert await ready.steps("a") == FULL_LIFE
    assert ready.reported == [("command-a", state) for state in FULL_LIFE]
