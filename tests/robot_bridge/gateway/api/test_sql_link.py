"""Tables RR and SA as the gateway serves them: what robots write is answered, whatever it is."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.errors import DataRefusedError, StoreError
from robot_bridge.core.logs import IN_FULL
from robot_bridge.core.messages.robots import Alive, GetMap, OpAck, Ready, SendPos, SetMap, Stopped
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.gateway.storage.repositories import requests as answers
from robot_bridge.gateway.storage.repositories import robots as stored_robots


async def hello(yard, robot="r1", magic=7):
    yard.ask(robot, Ready(magic))
    await yard.link.poll()
    yard.sql("delete from sa where robot = ?", robot)


async def test_ready_is_answered_with_the_magic_number_the_name_and_the_map_of_the_site(yard):
    yard.ask("r1", Ready(4711))
    await yard.link.poll()
    rows = yard.sql("select op, params, payload from sa where robot = 'r1' order by id")
    assert [row[0] for row in rows] == ["OpAck", "SetMap"]
    answer = json.loads(rows[0][1])
    assert len(answer.pop("database")) == 36
    assert answer == {"id": 1, "ok": True, "magic": 4711, "robot": "r1"}
    assert decode(rows[1][2]).border == (0.0, 0.0, 200.0, 160.0)
    assert yard.sql("select count(*) from rr") == [(0,)]


async def test_get_map_is_answered_with_a_square(yard):
    await hello(yard)
    yard.ask("r1", GetMap(60.0, 90.0, 2500.0))
    await yard.link.poll()
    rows = yard.sql("select op, payload from sa order by id")
    assert [op for op, _ in rows] == ["OpAck", "SetMap"]
    cut = decode(rows[1][1])
    assert cut.border == (35.0, 65.0, 85.0, 115.0)
    assert cut.segment_count > 0


async def test_a_newer_map_takes_the_place_of_one_that_was_not_read(yard):
    await hello(yard)
    for area in (100.0, 400.0):
        yard.ask("r1", GetMap(60.0, 90.0, area))
        await yard.link.poll()
    ((content,),) = yard.sql("select payload from sa where op = 'SetMap'")
    assert decode(content).border.area == 400


async def test_positions_and_alive_are_not_acknowledged_and_stopped_is(yard):
    await hello(yard)
    for request in (SendPos(1.0, 2.0, 0.0, 0.0), Alive(), Stopped()):
        yard.ask("r1", request)
    await yard.link.poll()
    ((op, params),) = yard.sql("select op, params from sa")
    assert (op, json.loads(params)["id"]) == ("OpAck", 4)
    (report,) = yard.fleet.reports()
    assert (report.x, report.stopped, report.link) == (1.0, True, "sql")


async def test_a_robot_that_reads_and_deletes_its_row_has_been_delivered_the_command(yard):
    await hello(yard)
    await yard.send("a")
    await yard.link.poll()
    assert await yard.states() == {"a": "queued"}
    ((id,),) = yard.sql("select id from sa where op = 'SetPosEnd'")
    yard.sql("delete from sa where id = ?", id)
    await yard.link.poll()
    assert await yard.states() == {"a": "delivered"}
    yard.ask("r1", OpAck(id=id))
    await yard.link.poll()
    assert await yard.steps("a") == ["queued", "delivered", "acknowledged"]


async def test_a_robot_that_never_said_ready_is_told_start_once(yard):
    told = []
    for _ in range(3):
        yard.ask("r5", SendPos(1.0, 2.0, 0.0, 0.0))
        await yard.link.poll()
        told.append(yard.waiting("r5"))
        yard.sql("delete from sa")
    assert told == [["Start"], [], []]
    assert yard.fleet.reports() == []


async def test_ready_takes_the_place_of_what_an_earlier_run_left_unread(yard):
    yard.ask("r1", SendPos(1.0, 2.0, 0.0, 0.0))
    for magic in (1, 2):
        yard.ask("r1", Ready(magic))
        await yard.link.poll()
        yard.now += 60.0
    assert yard.waiting() == ["OpAck", "SetMap"]


@pytest.mark.parametrize("request_", [Alive(), OpAck(id=1), GetMap(60.0, 90.0, 100.0)])
async def test_a_stopped_robot_stays_stopped_whatever_it_says_at_a_standstill(yard, request_):
    await hello(yard)
    for request in (Stopped(), request_):
        yard.ask("r1", request)
    await yard.link.poll()
    (report,) = yard.fleet.reports()
    assert report.stopped is True


async def test_robots_on_sql_are_told_start_when_the_gateway_starts_anew(yard):
    await hello(yard)
    await yard.ready("r2")
    await yard.restart()
    assert (yard.waiting("r1"), "Start" in yard.waiting("r2")) == (["Start"], False)


JUNK = [
    ("r1", "SendPos", '{"x": 1', "SendPos: params is not JSON"),
    ("r1", "SendPos", '{"x": NaN, "y": 1, "theta": 0, "v": 0}', "SendPos: params is not JSON"),
    ("r1", "SendPos", '{"x": 1e400, "y": 1, "theta": 0, "v": 0}', "SendPos: params is not JSON"),
    ("r1", "SendPos", "[1, 2, 3, 4]", "SendPos: params is list"),
    ("r1", "SendPos", None, "SendPos: Object missing required field `x`"),
    ("r1", "SendPos", "17", "SendPos: params is int"),
    ("r1", "SendPos", "[" * 10_000, "SendPos: params is not JSON"),
    ("r1", "SendPos", "[" * 100_000, "SendPos: params has 100000 characters; at most 65536"),
    ("r1", "Ready", '{"magic": 1000000000000000000000000000000}', "Ready: magic is 1000"),
    ("r1", "OpAck", '{"id": 1000000000000000000000000000000}', "OpAck: id is 1000"),
    ("r1", "GetMap", '{"x": 1, "y": 1, "area": 0}', "GetMap: area is 0"),
    ("r1", "Fly", None, "unknown operation 'Fly'; known are Ready"),
]


async def asked_junk(yard, reason):
    """A junk request of id 2 is dealt with, and the good one that follows it too."""
    yard.ask("r1", SendPos(5.0, 6.0, 0.0, 0.0))
    await yard.link.poll()
    ((op, params),) = yard.sql("select op, params from sa")
    answer = json.loads(params)
    assert (op, answer["id"], answer["ok"]) == ("OpAck", 2, False)
    assert reason in answer["reason"]
    assert yard.sql("select count(*) from rr") == [(0,)]
    (report,) = yard.fleet.reports()
    assert report.x == 5.0


@pytest.mark.parametrize(("robot", "op", "params", "reason"), JUNK, ids=range(len(JUNK)))
async def test_junk_is_answered_with_the_reason_and_removed_and_holds_up_nobody(
    yard, robot, op, params, reason
):
    await hello(yard)
    yard.sql("insert into rr (robot, op, params) values (?, ?, ?)", robot, op, params)
    await asked_junk(yard, reason)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ("'r1', 'SendPos', 17", "SendPos: params is int"),
        ("'r1', 'SendPos', x'ff00'", "SendPos: params is not JSON"),
        ("'r1', 'SendPos', cast(x'ff41' as text)", "SendPos: params is not JSON"),
        ("'r1', x'ff00', null", "unknown operation"),
    ],
)
async def test_what_only_sqlite_takes_for_text_is_answered_too(yard, values, reason):
    await hello(yard)
    yard.sql(f"insert into rr (robot, op, params) values ({values})")
    await asked_junk(yard, reason)


NAMES = ["''", "'r 1'", "'röbi \U0001f916'"]


async def asked_under_no_name(yard, caplog, robot):
    """A request that no robot can have made is removed, and logged: nobody reads an answer to it."""
    await hello(yard)
    yard.sql(f"insert into rr (robot, op, params) values ({robot}, 'Alive', null)")
    yard.ask("r1", SendPos(5.0, 6.0, 0.0, 0.0))
    await yard.link.poll()
    assert yard.sql("select count(*) from sa") == yard.sql("select count(*) from rr") == [(0,)]
    assert "cannot be used" in caplog.text
    (report,) = yard.fleet.reports()
    assert report.x == 5.0


@pytest.mark.parametrize("robot", NAMES)
async def test_what_is_asked_under_no_name_of_a_robot_is_removed_without_an_answer(yard, caplog, robot):
    await asked_under_no_name(yard, caplog, robot)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
@pytest.mark.parametrize("robot", ["x'ff00'", "cast(x'ff41' as text)"])
async def test_nor_is_what_only_sqlite_takes_for_a_name(yard, caplog, robot):
    await asked_under_no_name(yard, caplog, robot)


async def test_what_goes_wrong_inside_is_answered_without_a_word_of_it_and_logged(yard, monkeypatch, caplog):
    await hello(yard)

    async def fail(*_, **_how):
        raise ZeroDivisionError("the secret is 42")

    monkeypatch.setattr(yard.fleet, "receive", fail)
    for request in (Stopped(), GetMap(60.0, 90.0, 100.0)):
        yard.ask("r1", request)
    await yard.link.poll()
    told = [json.loads(params) for (params,) in yard.sql("select params from sa order by id")]
    assert [(answer["id"], answer["ok"]) for answer in told] == [(2, False), (3, False)]
    assert told[0]["reason"].startswith("Stopped: internal error ")
    assert "secret" not in str(told)
    assert "the secret is 42" in caplog.text
    assert told[0]["reason"].split()[3].rstrip(";") in caplog.text
    assert yard.sql("select count(*) from rr") == [(0,)]


async def test_a_value_that_the_database_refuses_is_answered_and_holds_up_nobody(yard, monkeypatch):
    await hello(yard)

    async def refuse(*_):
        await yard.database.run(_write_nothing_where_something_must_be)

    receive = yard.fleet.receive
    monkeypatch.setattr(
        yard.fleet,
        "receive",
        lambda robot, link, request, id, **how: (
            refuse() if id == 2 else receive(robot, link, request, id, **how)
        ),
    )
    yard.ask("r1", Stopped())
    await asked_junk(yard, "refuses a value")


async def test_a_ready_that_cannot_be_stored_keeps_no_other_robot_waiting(yard, monkeypatch):
    """As while an administrator has the table of the robots locked, which only a Ready needs."""
    await hello(yard)

    def locked(*_):
        raise StoreError("somebody else has it locked")

    with monkeypatch.context() as patch:
        patch.setattr(stored_robots, "save", locked)
        yard.ask("r2", Ready(8))
        yard.ask("r1", Stopped())
        with pytest.raises(StoreError, match="locked"):
            await yard.link.poll()
    assert (yard.waiting("r1"), yard.waiting("r2")) == (["OpAck"], [])
    await yard.link.poll()
    assert yard.waiting("r2") == ["OpAck", "SetMap"]


async def test_answers_that_the_database_refuses_fill_no_log(yard, monkeypatch, caplog):
    """As by a rule of an administrator for the rows of one robot; it asks again and again."""
    for robot in ("r1", "r2"):
        await hello(yard, robot)
    write = answers.add_answers

    def refuse(connection, rows):
        if any(robot == "r1" for robot, _ in rows):
            raise DataRefusedError("r1 is out of service")
        write(connection, rows)

    monkeypatch.setattr(answers, "add_answers", refuse)
    for _ in range(2 * IN_FULL):
        for robot in ("r1", "r2"):
            yard.ask(robot, Stopped())
        await yard.link.poll()
    assert yard.sql("select count(*) from rr") == [(0,)]
    assert len(yard.waiting("r2")) == 2 * IN_FULL and yard.waiting("r1") == []
    assert "Traceback" not in caplog.text
    assert caplog.text.count("stay without an answer: r1 is out of service") == IN_FULL


def _write_nothing_where_something_must_be(connection):
    connection.exec_driver_sql("insert into rr (robot, op) values (null, 'Alive')")


async def test_what_many_robots_say_at_once_costs_few_transactions(yard, monkeypatch):
    names = [f"r{number}" for number in range(20)]
    for name in names:
        await hello(yard, name)
        yard.ask(name, SendPos(1.0, 2.0, 0.0, 0.0))
        yard.ask(name, Stopped())
    calls = []
    run = yard.database.run
    monkeypatch.setattr(yard.database, "run", lambda work, *rest: calls.append(work) or run(work, *rest))
    await yard.link.poll()
    assert yard.sql("select count(*) from sa") == [(20,)]
    assert len(calls) <= 3


async def test_a_request_and_its_answer_are_one_transaction(yard):
    await hello(yard)
    yard.client.break_table("sa")
    yard.ask("r1", Stopped())
    with pytest.raises(StoreError, match="sa"):
        await yard.link.poll()
    assert yard.sql("select op from rr") == [("Stopped",)]
    yard.client.mend_table("sa")
    await yard.link.poll()
    assert (yard.sql("select op from rr"), yard.waiting()) == ([], ["OpAck"])


async def test_a_map_goes_as_the_payload_and_not_as_a_parameter(yard):
    outcome = await yard.fleet.receive("r1", "sql", Ready(1), 1)
    assert isinstance(outcome.answer, SetMap)
    await yard.fleet.outboxes.finish([outcome], [], acks=True)
    ((params, payload),) = yard.sql("select params, payload from sa where op = 'SetMap'")
    assert params == "{}"
    assert decode(payload).border == (0.0, 0.0, 200.0, 160.0)
