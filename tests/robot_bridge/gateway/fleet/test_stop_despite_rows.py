"""Nothing that one robot writes, and no name, keeps an emergency stop from another robot, on any database."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import DataRefusedError, StoreError
from robot_bridge.core.messages.commands import GetCommands
from robot_bridge.core.messages.robots import OpAck, SendPos
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from robot_bridge.gateway.api import robot_sql
from robot_bridge.gateway.commands import service as book_module
from robot_bridge.gateway.commands.active_command import CommandOrder
from robot_bridge.gateway.commands.persistence import write_late
from robot_bridge.gateway.fleet import emergency_persistence, emergency_stop
from robot_bridge.gateway.model.events import CommandChanged
from robot_bridge.gateway.model.robots import Robots
from robot_bridge.gateway.storage.repositories import emergency_stops, requests
from robot_bridge.gateway.storage.repositories import requests as answers
from robot_bridge.gateway.storage.repositories import robots as stored_robots
from robot_bridge.gateway.storage.repositories.robots import FencedError
from tests.support.databases.database_client import DatabaseClient

LOST = 5.0
"""Seconds, of the processor alone or on an idle machine, that only trying again and again would take."""
NONSENSE = [
    "[" * 2000,
    '{"id":' * 2000,
    '{"id": true}',
    '{"id": 1e400}',
    f'{{"id": {"9" * 400}}}',
    '{"id": NaN}',
    '{"id": "\\u0000"}',
    '{"id": 3, "reason": "\\ud800\\u0000", "ok": false}',
    "[[[]]]",
    "null",
    "",
    "\ufeff{}",
    f'{{"id": 1, "reason": "{"x" * 70_000}"}}',
]
NAMES = ["r1", "R2", "stranger", "", "r2 ", "röbi\U0001f916"]
"""The robot that means harm, and names under which nobody is known, or nearly one."""


def write_nonsense(url):
    client = DatabaseClient(url)
    try:
        for name in NAMES:
            for params in NONSENSE:
                client.sql("insert into rr (robot, op, params) values (?, 'OpAck', ?)", name, params)
                client.sql("insert into rr (robot, op, params) values (?, 'SendPos', ?)", name, params)
        if client.kind == "sqlite":
            for values in ("'r1', 'OpAck', x'ff00'", "x'ff00', 'OpAck', '{}'", "'r1', x'ff', x'00'"):
                client.sql(f"insert into rr (robot, op, params) values ({values})")
    finally:
        client.close()


ON_ONE = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
"""For what is the same on every database."""


@pytest.fixture
async def driven(yard, monkeypatch):
    """A yard in which r2 on SQL is sent a target that it has not read; r1, on SQL too, means harm."""
    monkeypatch.setattr(emergency_stop, "STORED_WITHIN", 60.0)
    for robot in ("r1", "r2", "r3"):
        await yard.ready(robot, link="websocket" if robot == "r3" else "sql")
        await yard.acknowledge_all(robot)
    await yard.send("target", robot="r2")
    await yard.send("other", robot="r1")
    return yard


async def stop(yard, id="stop-0001", by="Ada", reason=None):
    return await yard.fleet.emergency.stop(EmergencyStop(id, reason), by)


async def ops_of(yard, robot):
    """Return the operations of a robot's stored commands, newest first."""
    return [c.op for c in (await yard.fleet.orders.newest(GetCommands(robot, 10))).commands]


def outbox(yard, robot="r2"):
    """Return what a robot reads, in the order in which it does."""
    query = "select op from sa where robot = ? order by urgent desc, id"
    return [op for (op,) in yard.sql(query, robot)]


async def test_nonsense_that_waits_is_in_nobodys_way_and_stops_no_gateway_from_starting(driven):
    write_nonsense(driven.url)
    report = await stop(driven)
    assert (report.in_force, report.stored) == (True, True)
    assert outbox(driven, "r2") == outbox(driven, "r1") == outbox(driven, "r3") == ["Abort"]
    assert (await driven.states())["target"] == "aborted"
    await driven.restart()
    assert driven.fleet.emergency.in_force
    await driven.link.poll()
    assert outbox(driven)[0] == "Abort"


async def test_nonsense_that_waits_at_the_start_keeps_no_stop_back(driven):
    await driven.database.close()
    write_nonsense(driven.url)
    await driven.start()
    report = await stop(driven)
    assert report.stored
    assert outbox(driven)[0] == "Abort"
    assert "SetPosEnd" not in outbox(driven)
    await driven.link.poll()
    assert driven.sql("select count(*) from rr") == [(0,)]


async def test_nonsense_that_comes_all_the_time_is_answered_and_keeps_no_stop_back(driven):
    writing = True

    def write():
        while writing:
            write_nonsense(driven.url)

    thread = threading.Thread(target=write)
    thread.start()
    serving = asyncio.create_task(driven.link.run())
    try:
        while not driven.sql("select 1 from sa where robot = 'r1' and op = 'OpAck'"):
            await asyncio.sleep(0.01)
        began = time.monotonic()
        report = await stop(driven)
        took = time.monotonic() - began
    finally:
        writing = False
        serving.cancel()
        await asyncio.to_thread(thread.join)
        await asyncio.gather(serving, return_exceptions=True)
    assert report.stored
    assert took < LOST
    assert outbox(driven)[0] == "Abort"
    assert "SetPosEnd" not in outbox(driven)


@ON_ONE
async def test_rows_that_take_a_while_leave_turns_to_whatever_stops(driven, monkeypatch):
    monkeypatch.setattr(robot_sql, "TURN_S", 0.0)
    client = DatabaseClient(driven.url)
    for _ in range(50):
        client.sql("insert into rr (robot, op, params) values ('r1', 'OpAck', ?)", "[" * 2000)
    client.close()
    turns = []

    async def count():
        while True:
            turns.append(None)
            await asyncio.sleep(0)

    counting = asyncio.create_task(count())
    rows = await driven.fleet.outboxes.read_requests("sql")
    before = len(turns)
    await driven.link._deal_with_robot(rows)
    counting.cancel()
    assert len(turns) - before >= len(rows) == 50


async def test_a_robot_is_not_said_to_have_acknowledged_by_another_ones_row_nor_by_true(driven):
    (target,) = [id for (id,) in driven.sql("select id from sa where robot = 'r2'")]
    for robot, id in (("r1", target), ("R2", target), ("r2", True), ("r2", "1"), ("r2", target + 0.0)):
        params = json.dumps({"id": id})
        driven.sql("insert into rr (robot, op, params) values (?, 'OpAck', ?)", robot, params)
    found = await driven.database.read(requests.acknowledged, ["r1", "r2"])
    assert found == {"r1": {target}, "r2": set()}
    driven.ask("r2", OpAck(id=target))
    newest, found = await driven.database.read(requests.backlog, ["r2"])
    assert found == {"r2": {target}}
    assert (newest,) == driven.sql("select max(id) from rr")[0]


@ON_ONE
async def test_of_robots_that_nothing_is_asked_about_nothing_is_read(driven, monkeypatch):
    write_nonsense(driven.url)
    decoded = []
    decode = requests.decode_json
    monkeypatch.setattr(
        requests, "decode_json", lambda text, *more: decoded.append(text) or decode(text, *more)
    )
    await driven.database.read(requests.acknowledged, ["r2"])
    await driven.database.read(requests.acknowledged, [])
    assert decoded == []
    assert await driven.database.read(every_row_read) == []
    await driven.database.read(requests.acknowledged, ["r1"])
    assert len(decoded) >= len(NONSENSE) - 2
    # What is too long to be an acknowledgement is not even read.
    assert max(map(len, decoded)) < 20_000


def every_row_read(connection):
    """Return all that is fetched for what r2 acknowledges."""
    return connection.execute(requests._ACKS, {"robots": ["r2"], "newest": 2**62}).all()


@pytest.mark.parametrize("op", ["\ud800", "\udcff"])
async def test_what_a_driver_cannot_even_send_is_refused_as_data(yard, op):
    with pytest.raises(DataRefusedError, match="refuses a value"):
        await yard.database.run(requests.add_requests, [("r1", op, "{}", None)])
    await yard.database.run(requests.add_requests, [("r1", "Alive", "{}", None)])
    assert yard.sql("select op from rr") == [("Alive",)]


# --- names and words ----------------------------------------------------------------------------------


@pytest.mark.parametrize("by", ["Ada\0", "Ada\ud800", "Ada\nBob", "\0", "x" * 5000])
async def test_whoever_makes_a_stop_it_is_stored_and_what_comes_after_it_too(driven, by):
    report = await stop(driven, by=by, reason="a\0b\ud800\n" + "c" * 5000)
    assert report.stored
    assert report.by.isprintable() and len(report.by) <= 128
    assert outbox(driven) == ["Abort"]
    assert (await stop(driven, "stop-0002")).stored
    cleared = await driven.fleet.emergency.clear(ClearEmergencyStop("fine"), by)
    assert (cleared.in_force, cleared.stored) == (False, True)
    await driven.restart()
    assert not driven.fleet.emergency.in_force


@pytest.mark.parametrize("reason", ["no\0", "no\ud800", "no\n" * 3, "x" * 100_000])
async def test_whatever_a_robot_refuses_with_it_is_stored(driven, reason):
    ((id,),) = driven.sql("select id from sa where robot = 'r2'")
    await driven.ack(id, "r2", ok=False, reason=reason)
    assert (await driven.states())["target"] == "failed"
    told = await driven.reason("target")
    assert told.startswith(reason[:2])
    assert told.isprintable()
    assert len(told) <= 500
    assert outbox(driven) == []


# --- each robot's Abort by itself ---------------------------------------------------------------------


class Trap:
    """Lets the writing of one robot's Abort fail, once it is written with others or by itself."""

    def __init__(self, monkeypatch, error, robot="r1", bare_too=False):
        self.calls, self.error, self.robot = 0, error, robot
        self._numbered, self._all = answers.add_numbered, answers.add_answers
        monkeypatch.setattr(answers, "add_numbered", self.add_numbered)
        if bare_too:
            monkeypatch.setattr(answers, "add_answers", self.add_all)

    def add_numbered(self, connection, rows):
        self._check(rows)
        return self._numbered(connection, rows)

    def add_all(self, connection, rows):
        self._check(rows)
        self._all(connection, rows)

    def _check(self, rows):
        if any(robot == self.robot for robot, _ in rows):
            self.calls += 1
            raise self.error


@pytest.mark.parametrize("error", [DataRefusedError("refused"), ZeroDivisionError("unforeseen")])
async def test_a_robot_whose_abort_cannot_be_stored_keeps_nobody_elses(driven, monkeypatch, error, caplog):
    trap = Trap(monkeypatch, error)
    report = await stop(driven)
    assert report.stored
    for robot in ("r2", "r3"):
        assert outbox(driven, robot)[0] == "Abort"
        assert "SetPosEnd" not in outbox(driven, robot)
        assert (await ops_of(driven, robot)).count("Abort") == 1
    # It is told by a row that no command follows, once, and is not tried again for ever.
    assert outbox(driven, "r1") == ["Abort"]
    assert "robot 'r1' is sent an Abort that no command follows" in caplog.text
    calls = trap.calls
    await driven.fleet.save()
    assert trap.calls == calls
    assert "r1" in driven.fleet.emergency.report().waiting


@ON_ONE
async def test_a_robot_whose_rows_are_locked_has_an_abort_at_once_and_the_command_later(driven, monkeypatch):
    with monkeypatch.context() as patch:
        Trap(patch, StoreError("its rows are locked"))
        assert (await stop(driven)).stored
        assert outbox(driven, "r1") == ["Abort"]
        assert await ops_of(driven, "r1") == ["SetPosEnd"]
        await driven.fleet.save()
    await driven.fleet.save()
    assert await ops_of(driven, "r1") == ["Abort", "SetPosEnd"]
    await driven.fleet.save()
    assert outbox(driven, "r1") == ["Abort", "Abort"]


@ON_ONE
async def test_a_robot_that_cannot_be_written_to_at_all_is_tried_again_and_keeps_nobody_elses(
    driven, monkeypatch
):
    with monkeypatch.context() as patch:
        Trap(patch, DataRefusedError("refused"), bare_too=True)
        report = await stop(driven)
        assert report.stored
        assert outbox(driven, "r2")[0] == outbox(driven, "r3")[0] == "Abort"
        assert outbox(driven, "r1") == ["SetPosEnd"]
        await driven.fleet.save()
    await driven.fleet.save()
    assert outbox(driven, "r1") == ["Abort"]


async def test_a_database_that_is_away_is_told_from_a_robot_that_is_in_the_way(driven, monkeypatch):
    driven.client.break_table("sa")
    driven.client.break_table("emergency_stops")
    tried = []
    run = driven.database.run
    monkeypatch.setattr(driven.database, "run", lambda work, *more: tried.append(work) or run(work, *more))
    report = await stop(driven)
    assert (report.in_force, report.stored) == (True, False)
    assert len(tried) <= 4
    with pytest.raises(StoreError):
        await driven.fleet.emergency.store()
    driven.client.mend_table("emergency_stops")
    driven.client.mend_table("sa")
    await driven.fleet.save()
    assert driven.fleet.emergency.report().stored
    assert outbox(driven) == ["Abort"]


@ON_ONE
async def test_a_database_that_goes_away_in_between_is_not_tried_robot_by_robot(driven, monkeypatch):
    run, tried = driven.database.run, []

    async def go_away(work, *more):
        tried.append(work)
        if work is emergency_stops.add:
            return await run(work, *more)
        raise StoreError("away")

    with monkeypatch.context() as patch:
        patch.setattr(driven.database, "run", go_away)
        assert not (await stop(driven)).stored
    # All at once, the stop alone, the bare Aborts, and whether the database can be used at all.
    assert len(tried) == 4
    await driven.fleet.save()
    assert driven.fleet.emergency.report().stored
    assert outbox(driven)[0] == "Abort"


@ON_ONE
async def test_a_stop_that_is_refused_is_listed_in_plain_letters(driven, monkeypatch):
    add = emergency_stops.add

    def refuse(connection, row):
        if not row.by.isascii() or row.reason is not None:
            raise DataRefusedError("refused")
        add(connection, row)

    monkeypatch.setattr(emergency_stops, "add", refuse)
    report = await stop(driven, by="Édith", reason="smoke")
    assert (report.stored, report.by) == (True, "Édith")
    assert set(outbox(driven)) == {"Abort"}
    ((id, _, by, reason, *_),) = driven.sql("select * from emergency_stops")
    assert (id, by, reason) == ("stop-0001", "\\xc9dith", None)


@ON_ONE
async def test_a_stop_that_can_be_listed_nowhere_stops_robots_and_is_cleared_all_the_same(
    driven, monkeypatch
):
    def refuse(_connection, _row):
        raise DataRefusedError("refused")

    journal = Journal()
    driven.fleet.emergency._journal = journal
    monkeypatch.setattr(emergency_stops, "add", refuse)
    await stop(driven)
    assert set(outbox(driven)) == {"Abort"}
    await stop(driven, "stop-0002")
    assert [row.id for row in journal.noted] == ["stop-0001", "stop-0002"]
    await driven.fleet.save()
    cleared = await driven.fleet.emergency.clear(ClearEmergencyStop("fine"), "Eve")
    assert not cleared.in_force
    assert journal.noted == []


class Journal:
    """Keeps what was noted last."""

    def __init__(self, error=None):
        self.noted, self.error = [], error

    def write(self, stops):
        if self.error is not None:
            raise self.error
        self.noted = list(stops)
        done = asyncio.get_running_loop().create_future()
        done.set_result(None)
        return done

    def read(self):
        return self.noted


def fail(*_):
    raise ZeroDivisionError("unforeseen")


@ON_ONE
async def test_robots_are_told_whatever_else_goes_wrong(driven, caplog):
    """A journal, a link, a session of an operator: each may fail, and all that comes after it is done."""
    emergency = driven.fleet.emergency
    emergency._journal = Journal(ZeroDivisionError("unforeseen"))
    called, told = [], []
    emergency.reach(fail)
    emergency.reach(called.append)

    class Session:
        def __init__(self, notify):
            self.notify = notify

    sessions = [Session(fail), Session(lambda method, *_: told.append(method)), Session(fail)]
    for session in sessions:
        driven.fleet.listeners.add(session)
    report = await stop(driven)
    assert report.stored
    assert called == ["emergency-stop-0001"]
    assert "emergency" in told
    assert outbox(driven) == ["Abort"]
    assert caplog.text.count("unforeseen") >= 3
    failed = [record.getMessage().partition(" failed;")[0] for record in caplog.records]
    assert "noting an emergency stop" in failed
    assert "sending an emergency stop over open connections" in failed


@ON_ONE
@pytest.mark.parametrize(
    ("owner", "name"), [(emergency_persistence, "abort_id"), (Robots, "get"), (CommandOrder, "__init__")]
)
async def test_a_robot_of_which_no_abort_can_be_made_keeps_it_from_no_other(driven, monkeypatch, owner, name):
    real = getattr(owner, name)

    def fail_for_one(*arguments):
        if "r1" in arguments:
            raise ZeroDivisionError("unforeseen")
        return real(*arguments)

    monkeypatch.setattr(owner, name, fail_for_one)
    await stop(driven)
    # A bare one comes first, and may be followed by that of the command.
    assert set(outbox(driven)) == set(outbox(driven, "r1")) == {"Abort"}
    assert (await ops_of(driven, "r2"))[0] == "Abort"


@ON_ONE
async def test_a_robot_that_another_gateway_has_by_now_is_left_to_that(driven, monkeypatch):
    async def fenced(*_):
        raise FencedError("connected to another gateway by now")

    writer = driven.fleet.emergency._writer
    monkeypatch.setattr(writer._commands, "issue", fenced)
    assert (await stop(driven)).stored
    assert not writer.is_owing


@ON_ONE
async def test_operators_who_cannot_be_told_are_named_and_the_stop_goes_on(driven, monkeypatch, caplog):
    monkeypatch.setattr(driven.fleet.emergency, "_listeners", SimpleNamespace(announce=fail))
    assert (await stop(driven)).stored
    assert outbox(driven) == ["Abort"]
    assert "announcing an emergency stop failed;" in caplog.text


# --- over a restart -----------------------------------------------------------------------------------


async def test_who_was_sent_no_abort_before_the_gateway_died_is_sent_it_by_the_next_one(driven):
    row = emergency_stops.StopRow("stop-0001", driven.now, "Ada")
    await driven.database.run(emergency_stops.add, row)
    await driven.restart()
    assert driven.fleet.emergency.in_force
    assert outbox(driven)[0] == outbox(driven, "r1")[0] == "Abort"
    assert "SetPosEnd" not in outbox(driven)
    await driven.restart()
    assert outbox(driven).count("Abort") == 1


@ON_ONE
async def test_rows_that_were_damaged_are_left_out_and_the_gateway_starts(driven, caplog):
    await driven.send("third", robot="r3")
    await driven.at(10.0, 10.0, robot="r3")
    await driven.fleet.save()
    driven.sql("update commands set params = ? where id = 'command-other'", "[" * 2000)
    driven.sql("update command_steps set state = 'flying' where command = 'command-third'")
    driven.sql("update robots set pose = '{\"x\": [' where name = 'r3'")
    await driven.restart()
    assert {"r1", "r2", "r3"} <= set(driven.fleet.robots.names())
    assert driven.fleet.robots.get("r3").pose is None
    for what in ("command command-other", "a step of command command-third", "the place of robot r3"):
        assert f"{what} cannot be read in the database and is left out" in caplog.text
    assert "target" in await driven.states()
    assert (await stop(driven)).stored
    assert outbox(driven)[0] == "Abort"
    assert "SetPosEnd" not in outbox(driven)


# --- what is saved every second -----------------------------------------------------------------------


@ON_ONE
@pytest.mark.parametrize("error", [StoreError("away"), DataRefusedError("refused"), ZeroDivisionError("bad")])
@pytest.mark.parametrize(
    "step", ["_saving.save", "removals.carry_out", "observations.catch_up", "emergency.store"]
)
async def test_each_step_of_what_is_saved_survives_every_other(driven, monkeypatch, error, step, caplog):
    async def failing(*_):
        raise error

    part, method = step.split(".")
    monkeypatch.setattr(getattr(driven.fleet, part), method, failing)
    driven.now += 10_000.0
    for _ in range(2):
        if isinstance(error, StoreError):
            with pytest.raises(type(error)):
                await driven.fleet.save()
        else:
            await driven.fleet.save()
    # The last of the steps.
    assert (await driven.states())["target"] == "expired"
    assert caplog.text.count(str(error)) >= 1
    assert len([record for record in caplog.records if record.message.startswith("save, ")]) == 1


@ON_ONE
async def test_what_is_refused_of_one_robot_is_left_out_and_all_others_are_saved(driven, monkeypatch, caplog):
    save = stored_robots.save

    def refuse(connection, rows):
        if any(row[0] == "r1" for row in rows):
            raise DataRefusedError("refused")
        save(connection, rows)

    monkeypatch.setattr(stored_robots, "save", refuse)
    for robot in ("r1", "r2", "r3"):
        await driven.at(11.0, 12.0, robot=robot)
    for _ in range(2):
        await driven.fleet.save()
    assert {name for (name,) in driven.sql("select name from robots where pose like '%11.0%'")} == {
        "r2",
        "r3",
    }
    assert "r1" in driven.fleet.robots
    assert caplog.text.count("what is to be stored of robot r1 is left out: refused") == 1


async def test_a_status_of_any_length_keeps_no_robot_from_being_stored(driven):
    pose = SendPos(1.0, 2.0, 0.0, 0.0, status="ő" * 70_000)
    await driven.fleet.receive("r1", "sql", pose, None)
    await driven.fleet.save()
    ((stored,),) = driven.sql("select pose from robots where name = 'r1'")
    assert json.loads(stored)["x"] == 1.0


@ON_ONE
async def test_what_is_refused_of_one_robots_answers_is_left_out_and_all_others_are_answered(
    driven, monkeypatch
):
    add = answers.add_answers

    def refuse(connection, rows):
        if any(robot == "r1" for robot, _ in rows):
            raise DataRefusedError("refused")
        add(connection, rows)

    monkeypatch.setattr(answers, "add_answers", refuse)
    driven.sql("delete from sa")
    for robot in ("r1", "r2", "r4"):
        driven.sql("insert into rr (robot, op) values (?, 'Stopped')", robot)
    await driven.link.poll()
    assert (outbox(driven, "r2"), outbox(driven, "r1")) == (["OpAck"], [])
    assert driven.sql("select count(*) from rr") == [(0,)]


@ON_ONE
async def test_a_robot_that_fails_with_its_request_keeps_nobody_from_an_answer(driven, monkeypatch):
    receive = driven.fleet.receive

    async def fail_for_one(robot, *more, **how):
        if robot == "r1":
            raise StoreError("its rows are locked")
        return await receive(robot, *more, **how)

    monkeypatch.setattr(driven.fleet, "receive", fail_for_one)
    driven.sql("delete from sa")
    for robot in ("r1", "r2"):
        driven.sql("insert into rr (robot, op) values (?, 'Stopped')", robot)
    with pytest.raises(StoreError, match="its rows are locked"):
        await driven.link.poll()
    assert (outbox(driven, "r2"), driven.sql("select robot from rr")) == (["OpAck"], [("r1",)])


@ON_ONE
async def test_an_acknowledgement_that_came_too_late_and_goes_wrong_is_forgotten(driven, monkeypatch):
    book = driven.fleet._commands
    book._late = {("r1", 4711), ("r2", 4712)}
    late = book._record_late

    async def refuse(robot, sa_id):
        if robot == "r1":
            raise DataRefusedError("refused")
        await late(robot, sa_id)

    monkeypatch.setattr(book, "_record_late", refuse)
    await book.save_progress()
    assert book._late == set()


@ON_ONE
async def test_an_acknowledgement_that_came_too_late_waits_for_a_database_that_is_away(driven, monkeypatch):
    book = driven.fleet._commands
    book._late = {("r1", 4711)}

    async def fail_to_store(_robot, _sa_id):
        raise StoreError("away")

    monkeypatch.setattr(book, "_record_late", fail_to_store)
    with pytest.raises(StoreError, match="away"):
        await book.save_progress()
    assert book._late == {("r1", 4711)}


@ON_ONE
async def test_acknowledgements_that_came_too_late_wait_up_to_a_number_and_each_once(
    driven, lose, monkeypatch
):
    monkeypatch.setattr(book_module, "MOST_LATE", 1)
    book = driven.fleet._commands
    for sa_id in (4711, 4712):
        lose(driven, write_late, False, StoreError)
        with pytest.raises(StoreError):
            await book.acknowledge("r1", OpAck(id=sa_id))
    assert book._late == {("r1", 4711)}
    await book.acknowledge("r1", OpAck(id=4711))
    assert book._late == set()


@ON_ONE
async def test_a_robot_whose_removal_fails_keeps_no_other_in_the_fleet(driven, monkeypatch):
    give_up = driven.fleet._commands.give_up

    async def fail_for_one(robot, reason):
        if robot == "r1":
            raise StoreError("its rows are locked")
        await give_up(robot, reason)

    monkeypatch.setattr(driven.fleet._commands, "give_up", fail_for_one)
    driven.sql("delete from robots where name in ('r1', 'r2')")
    with pytest.raises(StoreError, match="its rows are locked"):
        await driven.fleet.save()
    assert (await driven.states())["target"] == "failed"
    monkeypatch.undo()
    await driven.fleet.save()
    assert (await driven.states())["other"] == "failed"


@ON_ONE
async def test_a_command_that_cannot_be_told_of_keeps_no_other_from_being_followed(driven):
    def fail_for_one(event):
        if event.report.robot == "r1":
            raise ZeroDivisionError("unforeseen")

    driven.fleet.events._subscribers[CommandChanged].insert(0, fail_for_one)
    await stop(driven)
    assert all(driven.fleet._commands.awaits_stop(robot) for robot in ("r1", "r2", "r3"))


@ON_ONE
async def test_a_long_look_at_one_robots_path_keeps_no_abort_from_it(driven, monkeypatch):
    """Whoever checks a long path holds no robot meanwhile: the stop overtakes it, and the path is refused."""
    looking, go_on = asyncio.Event(), asyncio.Event()

    async def look_long(_message):
        looking.set()
        await go_on.wait()

    monkeypatch.setattr(driven.fleet.roads.closures, "prepare", look_long)
    sending = asyncio.create_task(driven.send("long", robot="r2"))
    await looking.wait()
    monkeypatch.undo()
    report = await asyncio.wait_for(stop(driven), 60)
    assert report.stored
    assert outbox(driven)[0] == "Abort"
    go_on.set()
    with pytest.raises(Exception, match="an emergency stop is in force"):
        await sending


@ON_ONE
async def test_damaged_rows_of_queues_and_roads_are_left_out(driven, caplog):
    """Each is read for itself; a queue goes on with the tasks that can be read."""
    columns = "id, robot, place, state, content, leg, attempts, added_by, added_at"
    task = f"insert into queue_tasks ({columns}) values"
    for number, content in enumerate(
        ["[" * 2000, '{"task": "task-0002", "kind": "drive", "x": 1.0, "y": 2.0}']
    ):
        values = f"task-000{number + 1}", "r2", number, "waiting", content
        driven.sql(f"{task} (?, ?, ?, ?, ?, 0, 0, 'Ada', 1.0)", *values)
    driven.sql("insert into queues (robot, revision, state) values ('r2', 1, 'running'), ('r1', 1, 'flying')")
    driven.sql(
        "insert into closures (id, line, level, closed_at, closed_by) values ('c', '[[1', 0, 1.0, 'Ada')"
    )
    await driven.restart()
    assert [task.id for task in driven.fleet._queue_registry.get("r2").tasks] == ["task-0002"]
    for what in ("task task-0001 of the queue of robot r2", "the queue of robot r1", "closed road c"):
        assert f"{what} cannot be read in the database and is left out" in caplog.text
