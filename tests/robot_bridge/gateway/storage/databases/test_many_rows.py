"""Robots and positions by the hundred, on each kind of database: all of them stored, and each once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sqlalchemy import create_engine, event, func, select

from robot_bridge.core.errors import DataRefusedError
from robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from robot_bridge.core.messages.robots import OpAck, SendPos, SetMap
from robot_bridge.gateway.model.robots import Robot
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import commands, queues, requests, robots, trajectories
from robot_bridge.gateway.storage.repositories import requests as answers
from robot_bridge.gateway.storage.repositories.commands import StoredCommand
from robot_bridge.gateway.storage.repositories.trajectories import Fix, pack
from robot_bridge.gateway.storage.rows import TOGETHER
from robot_bridge.gateway.storage.schema import metadata
from robot_bridge.gateway.storage.schema import trajectories as stored_positions

NOW = 1_790_000_000.25
STATUS = "50 % 'full'; läuft ?"
SIZES = [0, 1, TOGETHER, TOGETHER + 1, 3 * TOGETHER - 1]


@pytest.fixture
async def database(url):
    opened = Database(url)
    yield opened
    await opened.close()


def robot(number, **pose):
    """Every third robot has said nothing of where it is."""
    where = SendPos(number + 0.25, -1.0, 0.5, 0.0, status=STATUS, **pose) if number % 3 else None
    return Robot(f"r{number}", number, "websocket", NOW, pose=where, pose_at=NOW if where else None)


async def save(database, known):
    await database.run(robots.save, [robots.row(one) for one in known])


async def loaded(database):
    return {one.name: one for one in await database.run(robots.load)}


@pytest.mark.parametrize("size", SIZES)
async def test_robots_are_loaded_as_they_were_saved(database, size):
    known = [robot(number) for number in range(size)]
    await save(database, known)
    found = await loaded(database)
    assert {one.name: (one.magic, one.pose, one.pose_at) for one in known} == {
        name: (one.magic, one.pose, one.pose_at) for name, one in found.items()
    }


async def test_what_is_saved_again_replaces_what_was_and_nothing_else(database):
    await save(database, [robot(number) for number in range(2 * TOGETHER)])
    await save(database, [robot(number, t=7.0) for number in range(TOGETHER + 50)])
    found = await loaded(database)
    assert len(found) == 2 * TOGETHER
    again = {int(name[1:]) for name, one in found.items() if one.pose and one.pose.t == 7.0}
    assert again == {number for number in range(TOGETHER + 50) if number % 3}


async def test_several_are_refused_as_one_is_for_a_text_that_has_no_room(database):
    """A text that is cut off is another one. SQLite has room for any."""
    too_long = replace(robot(1), link="x" * 17)
    for known in ([too_long], [robot(0), too_long]):
        if database.dialect.name == "sqlite":
            await save(database, known)
        else:
            with pytest.raises(DataRefusedError):
                await save(database, known)
    assert len(await loaded(database)) == (2 if database.dialect.name == "sqlite" else 0)


async def test_commands_are_found_as_they_were_last_written(database):
    steps = [
        CommandStep(CommandState.QUEUED, NOW, "Ödön"),
        CommandStep(CommandState.FAILED, NOW + 1, "r", "a\nb"),
    ]
    new = [
        StoredCommand(
            CommandReport(
                f"c{n}", f"r{n}", "SetPosEnd", {"x": n / 3}, "Ödön", CommandState.QUEUED, steps[:1]
            ),
            sa_id=n,
            expires_at=NOW + n / 3 if n % 2 else None,
        )
        for n in range(2 * TOGETHER)
    ]
    await database.run(commands.add_all, new)
    ended = [
        replace(one.report, state=CommandState.FAILED, steps=steps, deviation=n / 7, stood=(1.5, n / 3, -0.5))
        for n, one in enumerate(new)
    ]
    changed = [StoredCommand(report, sa_id=n, driven=n / 9) for n, report in enumerate(ended) if n % 2]
    await database.run(commands.save_all, changed)
    await database.run(commands.save_driven, {"c0": 1 / 3, "c1": 2 / 3, "unknown": 1.0})
    wanted = {**{c.report.command: c.report for c in new}, **{c.report.command: c.report for c in changed}}
    found = await database.run(commands.find_all, list(wanted))
    assert {id: one.report for id, one in found.items()} == wanted
    assert found["c3"].driven == 3 / 9 and (found["c0"].driven, found["c1"].driven) == (1 / 3, 2 / 3)
    assert found["c4"].driven is None


async def test_of_several_steps_of_a_command_at_once_the_last_counts(database):
    steps = [CommandStep(CommandState.QUEUED, NOW, "Ada"), CommandStep(CommandState.FAILED, NOW + 1, "r")]
    first = CommandReport("c1", "r1", "SetPosEnd", {}, "Ada", CommandState.QUEUED, steps[:1])
    last = replace(first, state=CommandState.FAILED, steps=steps, deviation=np.float64(0.5))
    await database.run(commands.add_all, [StoredCommand(first, sa_id=1)])
    many = [StoredCommand(first, 1)] * 20
    await database.run(commands.save_all, [*many, StoredCommand(last, np.int64(1))])
    found = await database.run(commands.find, "c1")
    assert (found.state, found.deviation) == (CommandState.FAILED, 0.5)


@pytest.mark.parametrize("size", SIZES)
async def test_every_position_is_stored_once(database, size):
    fixes = [
        Fix(f"r{n % 7}", NOW + n, SendPos(float(n), 0.0, 0.5, 1.0, t=None if n % 2 else NOW, fix_t=None))
        for n in range(size)
    ]
    await database.run(trajectories.add, list(map(pack, fixes)))
    x, t = stored_positions.c.x, stored_positions.c.device_time
    found = await database.run(lambda c: list(c.scalars(select(x).order_by(x))))
    assert found == [float(n) for n in range(size)]
    assert await database.run(lambda c: c.scalar(select(func.count(t)))) == (size + 1) // 2


async def test_answers_with_large_maps_between_them_are_all_there_in_their_order(database):
    maps = {n: bytes([n]) * 1_000_000 for n in range(0, 120, 5)}  # more than MariaDB takes in one statement
    told = [("r1", SetMap(maps[n]) if n in maps else OpAck(id=n)) for n in range(120)]
    await database.run(answers.add_answers, told)
    found = await database.read(answers.read_answers, "r1")
    assert [row.op for row in found] == [type(answer).__name__ for _, answer in told]
    assert [row.payload for row in found] == [maps.get(n) for n in range(120)]
    assert sorted(row.id for row in found) == [row.id for row in found]
    await database.run(answers.remove_answers, [row.id for row in found])
    assert await database.read(answers.read_answers, "r1") == []


async def test_requests_are_read_as_they_were_written_and_go_when_they_were_dealt_with(database):
    images = {n: bytes([n]) * 1_000_000 for n in range(0, 120, 5)}
    asked = [
        ("r1", "SendImage" if n in images else "Alive", f'{{"n": {n}}}', images.get(n)) for n in range(120)
    ]
    await database.run(requests.add_requests, asked)
    found = await database.read(requests.read_requests)
    assert [(row.robot, row.op, row.params) for row in found] == [row[:3] for row in asked]
    sizes = [await database.read(requests.payload, row.id, lambda _size: None) for row in found]
    assert sizes == [images.get(n) for n in range(120)]
    await database.run(requests.remove_requests, [row.id for row in found][:-1])
    assert [row.params for row in await database.read(requests.read_requests)] == ['{"n": 119}']


def test_sqlite_is_asked_in_few_kinds_of_statements(tmp_path):
    engine, texts = create_engine(f"sqlite:///{tmp_path}/fleet.db"), set()
    metadata.create_all(engine)
    event.listen(engine, "before_cursor_execute", lambda *call: texts.add(call[2]))
    with engine.begin() as connection:
        for size in range(1, 3 * TOGETHER):
            trajectories.add(
                connection, [pack(Fix(f"r{n}", NOW, SendPos(1.0, 2.0, 0.5, 0.0))) for n in range(size)]
            )
        found = connection.execute(select(func.count()).select_from(stored_positions)).scalar()
    assert found == sum(range(1, 3 * TOGETHER))
    assert len([text for text in texts if text.startswith("INSERT")]) <= TOGETHER.bit_length()


async def test_more_are_looked_up_than_a_statement_takes_values(database):
    # PostgreSQL is asked for all at once, and takes 65535; the others are asked for ``TOGETHER`` at a time.
    size = 70_000 if database.dialect.name == "postgresql" else 20 * TOGETHER + 1
    assert await database.run(commands.find_all, [f"command-{number}" for number in range(size)]) == {}
    assert await database.run(commands.find_messages, [("r1", number) for number in range(size)]) == {}


async def test_more_robots_are_read_by_name_than_a_statement_takes_values(database):
    """Of a fleet of 100 000 all may turn up at another gateway at once."""
    await save(database, [robot(1)])
    # MariaDB's driver writes them into the statement, and SQLite takes 250000.
    names = [f"r{number}" for number in range(70_000)]
    assert [one.name for one in await database.run(robots.load, names)] == ["r1"]
    assert await database.run(queues.load_with_ended, names, 5) == []
    assert await database.run(commands.still_open, names) == []
    assert await database.run(robots.load, []) == []
