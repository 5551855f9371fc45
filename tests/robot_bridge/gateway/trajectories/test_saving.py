"""Positions on their way into the database: none is lost, whatever fails, is cancelled or is forgotten."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
from types import SimpleNamespace

import pytest
from sqlalchemy import select

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.errors import DataRefusedError, LockedError, StoreError
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.sites.settings_tables import TrajectorySettings
from robot_bridge.gateway.model.robots import Robots
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import robots as stored_robots
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import Fix
from robot_bridge.gateway.storage.schema import trajectories as table
from robot_bridge.gateway.trajectories.recording import BATCH, TrajectoryRecorder, TrajectoryWriter
from tests.support.bridge.busy_database import kept_busy
from tests.support.patience import until

EVERY = TrajectorySettings(min_distance_m=0.0, min_turn_deg=0.0, min_interval_s=0.0)


@pytest.fixture
def url(new_database):
    """Made outside of the test's loop: the first one runs a loop of its own."""
    return new_database("sqlite")


@pytest.fixture
async def database(url):
    database = Database(url)
    await database.open()
    yield database
    await database.close()


def pose_at(t):
    return SendPos(t, 0.0, 0.0, 0.0, t=t)


def packed(*times):
    """Return what waits to be stored of a yard's robot that said where it is at these times."""
    return [trajectories.pack(Fix("r1", t, pose_at(t))) for t in times]


def recorder_of(settings):
    return TrajectoryRecorder(SimpleNamespace(settings=SimpleNamespace(trajectories=settings)))


class Yard:
    """One robot whose positions are saved in ``database``."""

    def __init__(self, database, recorder=None):
        self.database = database
        self.robots = Robots()
        self.robots.ready("r1", 1, "sql", 0.0)
        self.saving = TrajectoryWriter(
            database, self.robots, recorder or recorder_of(EVERY), ManualClock(wall=100.0)
        )

    def tell(self, *times):
        for t in times:
            pose = pose_at(t)
            assert self.robots.observe("r1", pose, "sql", t)
            self.saving.observe(t, [("r1", pose)])

    async def stored(self):
        """Return the times of the stored positions, and that of the robot's own row."""
        times = await self.database.run(
            lambda c: list(c.scalars(select(table.c.device_time).order_by(table.c.id)))
        )
        known = await self.database.run(stored_robots.load)
        return times, known[0].pose.t if known and known[0].pose else None


@pytest.fixture
def yard(database):
    return Yard(database)


@pytest.fixture
async def busy(database):
    """Let the database's thread wait until ``go`` is set; return that."""
    async with kept_busy(database) as go:
        yield go


async def test_what_is_being_saved_when_the_gateway_is_ended_is_stored_once(yard, busy):
    yard.tell(1.0, 2.0)
    saving = asyncio.ensure_future(yard.saving.save())
    await until(lambda: yard.database.waiting)
    saving.cancel()
    await asyncio.gather(saving, return_exceptions=True)
    busy.set()
    await yard.saving.save()
    assert await yard.stored() == ([1.0, 2.0], 2.0)


async def test_what_is_being_written_with_answers_when_the_gateway_is_ended_is_stored_once(yard, busy):
    yard.tell(1.0, 2.0)
    writing = asyncio.ensure_future(yard.saving.write_with(trajectories.add))
    await until(lambda: yard.database.waiting)
    writing.cancel()
    await asyncio.gather(writing, return_exceptions=True)
    busy.set()
    await yard.saving.save()
    assert await yard.stored() == ([1.0, 2.0], 2.0)


async def test_where_a_robot_is_is_never_stored_before_where_it_was(yard, busy):
    def fail(connection, fixes):
        trajectories.add(connection, fixes)
        raise StoreError("the disk is full")

    yard.tell(1.0, 2.0)
    writing = asyncio.ensure_future(yard.saving.write_with(fail))
    await asyncio.sleep(0)
    saving = asyncio.ensure_future(yard.saving.save())
    await until(lambda: yard.database.waiting)
    busy.set()
    with pytest.raises(StoreError, match="the disk is full"):
        await writing
    await saving
    assert await yard.stored() == ([1.0, 2.0], 2.0)


class ForgetfulServer:
    """A database that forgets, when it is killed, what was jotted down since it stored something for good."""

    def __init__(self):
        self.session, self.kept, self.jotted = 1, [], []

    async def write_relaxed(self, _work, fixes):
        self.jotted += fixes

    async def run(self, _write, _robots, fixes, _stored, _fence):
        self.kept += [*self.jotted, *fixes]
        self.jotted = []
        return set()

    def kill(self):
        self.jotted = []
        self.session += 1


@pytest.mark.parametrize("killed", [False, True])
async def test_what_a_killed_server_may_have_forgotten_is_stored_again(killed):
    server = ForgetfulServer()
    yard = Yard(server)
    yard.tell(1.0, 2.0)
    await yard.saving.write_with(None)
    yard.tell(3.0)
    await yard.saving.write_with(None)
    if killed:
        server.kill()
    yard.tell(4.0)
    await yard.saving.save()
    server.kill()
    await yard.saving.save()
    assert server.kept == packed(1.0, 2.0, 3.0, 4.0)


async def test_a_server_that_is_killed_while_it_stores_is_sent_again_what_it_forgot():
    class KilledOnce(ForgetfulServer):
        async def run(self, write, robots, fixes, stored, fence):
            if self.session == 1:
                self.kill()
            return await super().run(write, robots, fixes, stored, fence)

    server = KilledOnce()
    yard = Yard(server)
    yard.tell(1.0, 2.0)
    await yard.saving.write_with(None)
    yard.tell(3.0)
    await yard.saving.save()
    assert sorted(server.kept) == sorted(packed(1.0, 2.0, 3.0))


async def test_a_store_that_hangs_keeps_no_more_than_may_wait_and_gets_the_newest(database, busy):
    recorder = recorder_of(dataclasses.replace(EVERY, largest_backlog=1000))
    yard = Yard(database, recorder)
    yard.tell(0.0)
    saving = asyncio.ensure_future(yard.saving.save())
    await until(lambda: yard.database.waiting)
    yard.tell(*map(float, range(1, 1501)))
    assert (recorder.waiting, recorder.given_up) == (1000, 500)
    busy.set()
    await saving
    await yard.saving.save()
    times, last = await yard.stored()
    assert times == [0.0, *map(float, range(501, 1501))]
    assert (last, recorder.waiting) == (1500.0, 0)


async def test_robots_that_are_to_be_stored_at_once_are_stored_together(yard, database, monkeypatch):
    names, run, times = [f"r{number}" for number in range(2, 22)], database.run, []

    async def counted(work, *arguments):
        times.append(work)
        return await run(work, *arguments)

    monkeypatch.setattr(database, "run", counted)
    for name in names:
        yard.robots.ready(name, 1, "websocket", 0.0)
    await asyncio.gather(*map(yard.saving.save, names))
    assert len(times) == 1
    stored = await run(stored_robots.names)
    assert stored == sorted(names)


async def test_robots_that_drive_on_meanwhile_are_not_stored_once_for_each_who_waits(
    yard, database, monkeypatch
):
    names, run, times = [f"r{number}" for number in range(2, 22)], database.run, []

    async def counted(work, *arguments):
        times.append(work)
        done = await run(work, *arguments)
        for name in names:
            yard.saving.touch(name)
        return done

    monkeypatch.setattr(database, "run", counted)
    for name in names:
        yard.robots.ready(name, 1, "websocket", 0.0)
    first = asyncio.create_task(yard.saving.save(names[0]))
    await asyncio.sleep(0)
    # These come while the first is being stored, and wait for what is stored next.
    await asyncio.gather(first, *map(yard.saving.save, names[1:]))
    assert len(times) <= 2
    assert await run(stored_robots.names) == sorted(names)


async def test_a_robot_whose_turn_failed_is_stored_in_the_next_ones(yard, database, monkeypatch):
    run, times = database.run, []

    async def fail_first(work, *arguments):
        times.append(work)
        if len(times) == 1:
            raise StoreError("the disk is full")
        return await run(work, *arguments)

    monkeypatch.setattr(database, "run", fail_first)
    yard.robots.ready("r2", 1, "websocket", 0.0)
    first, second = await asyncio.gather(
        yard.saving.save("r1"), yard.saving.save("r2"), return_exceptions=True
    )
    assert (type(first), second) == (StoreError, None)
    assert await run(stored_robots.names) == ["r1", "r2"]


@pytest.mark.parametrize("positions", [1, BATCH + 1], ids=["with robots", "before robots"])
async def test_a_lock_is_waited_for_once_by_all_who_are_registered_meanwhile(
    yard, database, monkeypatch, positions
):
    names, run, times = [f"r{number}" for number in range(2, 22)], database.run, []

    async def wait_for_lock(work, *arguments):
        times.append(work)
        await asyncio.sleep(0)
        raise LockedError("a backup has it locked")

    yard.tell(*map(float, range(positions)))
    for name in names:
        yard.robots.ready(name, 1, "websocket", 0.0)
    with monkeypatch.context() as locked:
        locked.setattr(database, "run", wait_for_lock)
        await asyncio.gather(*map(yard.saving.save, names))
        assert len(times) == 1
        # Who comes later looks whether it is over, and the periodic save reports it.
        await yard.saving.save("r2")
        with pytest.raises(LockedError):
            await yard.saving.save()
        assert len(times) == 3
    await yard.saving.save("r2")
    assert await run(stored_robots.names) == sorted([*names, "r1"])
    assert len(await of_all(database)) == positions


async def test_answers_that_are_refused_with_positions_are_written_without_and_each_position_alone(yard):
    yard.tell(1.0, 2.0)
    written = []

    def write(_connection, fixes):
        if fixes:
            raise DataRefusedError("one of the positions is refused")
        written.append("answers")

    await yard.saving.write_with(write)
    assert written == ["answers"]
    await yard.saving.save()
    assert await yard.stored() == ([1.0, 2.0], 2.0)


async def refuse(database, table, robots="new.robot is not null"):
    rule = f"create trigger refusing before insert on {table} when {robots} "
    await database.run(lambda c: c.exec_driver_sql(rule + "begin select raise(abort, 'no room'); end"))


async def allow(database):
    await database.run(lambda c: c.exec_driver_sql("drop trigger refusing"))


async def of_all(database):
    return sorted(await database.run(lambda c: list(c.execute(select(table.c.robot, table.c.device_time)))))


@pytest.fixture
def crowd(yard):
    """A yard with another robot; both have told where they are twice."""
    yard.robots.ready("r2", 2, "sql", 0.0)
    for name, t in (("r1", 1.0), ("r2", 2.0), ("r1", 3.0), ("r2", 4.0)):
        assert yard.robots.observe(name, pose_at(t), "sql", t)
        yard.saving.observe(t, [(name, pose_at(t))])
    return yard


async def test_positions_are_kept_while_none_of_any_robot_is_taken_and_robots_come_in(crowd, database):
    await refuse(database, "trajectories")
    for _ in range(2):
        with pytest.raises(StoreError, match="no room; so it is with every robot: positions are kept"):
            await crowd.saving.save()
    crowd.robots.ready("r3", 3, "sql", 5.0)
    await crowd.saving.save("r3")
    assert await database.run(stored_robots.names) == ["r1", "r2", "r3"]
    written = []
    await crowd.saving.write_with(lambda _connection, fixes: written.append(fixes))
    assert written == [[]]
    await allow(database)
    await crowd.saving.save()
    assert await of_all(database) == [("r1", 1.0), ("r1", 3.0), ("r2", 2.0), ("r2", 4.0)]


async def test_answers_that_meet_a_table_first_that_takes_no_position_are_written_and_these_kept(
    crowd, database
):
    await refuse(database, "trajectories")
    await crowd.saving.write_with(trajectories.add)
    await allow(database)
    await crowd.saving.save()
    assert len(await of_all(database)) == 4


async def test_positions_of_a_robot_that_alone_is_refused_are_left_out(crowd, database):
    await refuse(database, "trajectories", "new.robot = 'r1'")
    await crowd.saving.save()
    await allow(database)
    await crowd.saving.save()
    assert await of_all(database) == [("r2", 2.0), ("r2", 4.0)]


async def test_robots_of_whom_none_can_be_stored_are_reported_and_stored_later(crowd, database):
    await refuse(database, "robots", "new.name is not null")
    with pytest.raises(StoreError, match="every robot: where they are is stored as soon as it goes"):
        await crowd.saving.save()
    assert len(await of_all(database)) == 4 and await database.run(stored_robots.names) == []
    await allow(database)
    await crowd.saving.save()
    assert await database.run(stored_robots.names) == ["r1", "r2"] and len(await of_all(database)) == 4


@pytest.fixture
def writes(database, monkeypatch):
    """The names of the robots in each write of robots and positions."""
    run, writes = database.run, []

    async def noted(work, *arguments):
        if len(arguments) == 4:
            writes.append({row[0] for row in arguments[0]})
        return await run(work, *arguments)

    monkeypatch.setattr(database, "run", noted)
    return writes


async def test_a_table_that_takes_no_robot_is_not_asked_for_each_and_those_who_come_in_are_tried(
    crowd, database, writes
):
    names = {f"r{number}" for number in range(1, 41)}
    for name in (*names, "r41", "s1"):
        crowd.robots.ready(name, 1, "websocket", 5.0)
    await refuse(database, "robots", "new.name like 'r%'")
    # The registration comes while the table is not known to refuse; it leaves nobody out.
    for save in (crowd.saving.save("r1"), crowd.saving.save()):
        for name in names:
            crowd.saving.touch(name)
        with contextlib.suppress(StoreError):
            await save
        assert writes[0] == names and len(writes) <= 8
        writes.clear()
    await crowd.saving.save("r41")
    assert writes == [{"r41"}, {"r41"}, set()]
    await crowd.saving.save("s1")
    assert await database.run(stored_robots.names) == ["s1"]
    with pytest.raises(StoreError, match="so it is with every robot: where they are"):
        await crowd.saving.save()
    await allow(database)
    await crowd.saving.save()
    assert set(await database.run(stored_robots.names)) == {*names, "r41", "s1"}
    assert len(await of_all(database)) == 4


async def test_how_a_robot_fell_silent_is_stored(database):
    yard = Yard(database)
    for said, state in ((["stops"], "offline"), (["stops", "says more"], "lost"), (["drives"], "lost")):
        for what in said:
            if what == "drives":
                yard.robots.observe("r1", dataclasses.replace(pose_at(2.0), v=1.0), "sql", 2.0)
            else:
                yard.robots.note_received("r1", "sql", 2.0, stopped=what == "stops")
        yard.saving.touch("r1")
        await yard.saving.save()
        (stored,) = await database.run(stored_robots.load)
        later = Robots()
        later.restore(stored, 60.0)
        assert later.get("r1").state.value == state


async def test_where_there_is_nothing_to_store_the_database_is_left_alone(database):
    yard, written = Yard(database), []
    database.add_observer(written.append)
    await yard.saving.save()
    assert written == []
    yard.tell(1.0)
    await yard.saving.save()
    # From now on it is looked at, for robots that others remove.
    await yard.saving.save()
    assert len(written) == 2
