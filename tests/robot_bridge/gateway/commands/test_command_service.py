"""What open commands are when a gateway takes them up, and what ends them but an answer of their robot."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import UncertainError
from robot_bridge.core.messages.robots import SendPos, SetPath
from robot_bridge.gateway.commands import persistence
from robot_bridge.gateway.commands.persistence import write_acknowledged
from robot_bridge.gateway.commands.service import NOWHERE

LOOP = [(20.0, 40.0), (50.0, 40.0), (50.0, 60.0), (20.0, 40.0)]
START = SendPos(20.0, 40.0, 0.0, 0.0)


def open_command(yard, id):
    return yard.fleet._commands._open.get(f"command-{id}")


async def drive(yard, id, robot="r1"):
    await yard.send(id, "SetPath", robot, points=LOOP)


async def restart(yard):
    await yard.fleet.save()
    await yard.restart()


# --- taken up by another gateway ----------------------------------------------------------------------------


async def test_what_waits_is_taken_up_as_sent_to_a_robot_that_may_have_moved_since_it_was_seen(two):
    await two.at(20.0, 40.0)
    await drive(two, "seen")
    await drive(two, "unseen", "r2")
    await restart(two)
    for id, handed in (("seen", START), ("unseen", NOWHERE)):
        taken_up = open_command(two, id)
        assert (taken_up.handed.x, taken_up.handed.y) == (handed.x, handed.y)
        assert taken_up.out_of_sight and taken_up.arrival is None
        assert taken_up.message == SetPath(LOOP)


async def test_a_robot_that_was_pushed_to_the_end_of_its_path_over_a_restart_has_not_driven_it(two):
    await two.at(20.0, 40.0)
    lanes = [(20.0, 40.0), (50.0, 40.0), (50.0, 43.0), (20.0, 43.0)]
    await two.send("a", "SetPath", points=lanes)
    await two.acknowledge_all()
    await restart(two)
    await two.ready()
    await two.at(20.0, 43.0)
    assert (await two.states())["a"] == "acknowledged"


async def test_a_robot_of_which_no_place_is_known_may_have_driven_its_loop_when_it_says_so(two):
    await drive(two, "a")
    await two.acknowledge_all()
    await restart(two)
    await two.ready()
    await two.at(20.0, 40.0)
    assert (await two.states())["a"] == "acknowledged"
    await two.fleet._commands.on_idle("r1", START)
    assert (await two.states())["a"] == "reached"


async def test_the_metres_driven_before_the_restart_stay_driven(two):
    await two.at(20.0, 40.0)
    await drive(two, "a")
    await two.acknowledge_all()
    for x in (22.0, 24.0, 26.0):
        await two.at(x, 40.0, v=1.0)
    await restart(two)
    assert open_command(two, "a").arrival.driven == 6.0


# --- a robot that says that it has nothing to do ------------------------------------------------------------


async def test_a_rest_concerns_only_the_paths_of_the_robot_that_was_seen_on_them(two):
    book = two.fleet._commands
    await two.send("target")
    await drive(two, "path", "r2")
    for robot in ("r1", "r2"):
        await two.acknowledge_all(robot)
    await book.on_idle("r1", SendPos(50.0, 40.0, 0.0, 0.0))
    await book.on_idle("r2", None)
    await book.on_idle("r2", START)
    await book.on_idle("nobody", START)
    assert await two.states() == {"target": "acknowledged", "path": "acknowledged"}
    book.lose_sight("r2")
    await two.at(24.0, 40.0, robot="r2", v=1.0)
    await two.at(20.0, 40.0, robot="r2")
    await book.on_idle("r2", START)
    assert await two.states() == {"target": "acknowledged", "path": "reached"}


# --- acknowledgements that wait to be dealt with again ------------------------------------------------------


async def test_what_is_acknowledged_once_more_is_judged_by_positions_after_that_alone(two):
    book = two.fleet._commands
    await two.send("a")
    (row,) = await two.deliver()
    await two.ack(row.id)
    book.await_again("r1", row.id + 1)
    book.await_again("r2", row.id)
    assert not open_command(two, "a").acknowledgement_waits
    book.await_again("r1", row.id)
    book.await_again("r1", row.id + 1)
    assert open_command(two, "a").acknowledgement_waits
    await two.at(50.0, 40.0)
    assert (await two.states())["a"] == "acknowledged"
    await two.ack(row.id)
    await two.at(50.0, 40.0)
    assert (await two.states())["a"] == "reached"


# --- handed over, given up ----------------------------------------------------------------------------------


async def test_a_message_is_handed_over_once_and_to_its_own_robot(two):
    book = two.fleet._commands
    await two.send("a")
    ((id,),) = two.sql("select id from sa where op = 'SetPosEnd'")
    assert await book.mark_sending("r1", 999_999)
    assert await book.mark_sending("r1", id)
    assert await two.steps("a") == ["queued", "delivered"]
    assert await book.mark_sending("r1", id)
    assert await two.steps("a") == ["queued", "delivered"]
    await two.send("b", robot="r2")
    ((other,),) = two.sql("select id from sa where robot = 'r2'")
    assert await book.mark_sending("r1", other) is False


async def test_every_command_of_a_robot_that_is_gone_fails_with_the_reason(two):
    await two.send("a")
    await two.send("x", "Abort")
    await two.send("b", robot="r2")
    two.now = 1010.0
    await two.fleet._commands.give_up("r1", "it was removed")
    assert await two.states() == {"a": "aborted", "x": "failed", "b": "queued"}
    (gone,) = [one for one in await two._stored() if one.command == "command-x"]
    step = gone.steps[-1]
    assert (step.at, step.by, step.reason) == (1010.0, "gateway", "it was removed")
    assert two.waiting("r1") == []
    await two.fleet._commands.give_up("r1", "it was removed")


async def test_what_is_reached_is_told_with_its_place_and_without_a_reason(two):
    await two.send("a")
    await two.acknowledge_all()
    await two.at(50.0, 40.1)
    (report,) = await two._stored()
    assert (report.state.value, report.steps[-1].reason) == ("reached", None)
    assert (report.deviation, report.stood) == (pytest.approx(0.1), (50.0, 40.1, 0.0))


# --- a transaction of which nobody knows whether it was done ------------------------------------------------


@pytest.mark.parametrize("done", [True, False])
async def test_what_came_of_it_is_told_and_nothing_of_what_stayed_as_it_was(two, lose, done):
    await two.send("a")
    await two.send("b", robot="r2")
    (row,) = await two.deliver()
    two.reported.clear()
    lose(two, write_acknowledged, done)
    with pytest.raises(UncertainError):
        await two.ack(row.id, ok=False, reason="no brakes")
    assert two.reported == []
    await two.fleet.save()
    assert two.reported == ([("command-a", "failed")] if done else [])
    assert (open_command(two, "a") is None) is done


async def test_where_nothing_is_done_nothing_is_to_be_stored(two):
    await two.at(20.0, 40.0)
    await drive(two, "a")
    await two.acknowledge_all()
    assert two.fleet._commands.observe("r1", START) is None
    assert two.fleet._commands.observe("r2", START) is None


async def test_a_command_that_ended_and_is_asked_for_again_changes_nothing(two):
    await two.at(20.0, 40.0)
    await drive(two, "a")
    await drive(two, "b")
    before = list(two.reported)
    assert (await two.send("a", "SetPath", points=LOOP)).state == "superseded"
    assert two.reported == before and open_command(two, "a") is None


async def test_a_command_knows_where_its_robot_was_as_it_was_ordered(two):
    await two.at(20.0, 40.0)
    await drive(two, "a")
    assert open_command(two, "a").handed == two.fleet.robots.pose("r1") != NOWHERE


async def test_a_robot_waits_for_another_until_it_is_told_something_else(two, monkeypatch):
    released = []
    monkeypatch.setattr(persistence.closures, "release", lambda _connection, robot: released.append(robot))
    two.fleet.queue_context.waiting["r1"] = None
    for robot in ("r1", "r2"):
        await two.send(f"begin-{robot}", "SetPosIni", robot, x=20.0, y=40.0)
    assert released == []
    for robot in ("r1", "r2"):
        await drive(two, f"path-{robot}", robot)
    assert released == ["r1"]
