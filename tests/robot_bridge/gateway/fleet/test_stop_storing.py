"""How a stop is written where one robot is in the way: bare Aborts first, then the fleet half by half."""

from __future__ import annotations

import asyncio
import logging

import pytest
from sqlalchemy.exc import ProgrammingError

from robot_bridge.core.errors import DataRefusedError, LockedError, StoreError, UncertainError
from robot_bridge.core.messages.robots import COMMANDS, MOTION_OPS
from robot_bridge.gateway.fleet import emergency_persistence
from robot_bridge.gateway.fleet.emergency_persistence import MOST_ALIKE, StopWriter, abort_id
from robot_bridge.gateway.storage.repositories import emergency_stops
from robot_bridge.gateway.storage.repositories.emergency_stops import StopRow

ROBOTS = ["r1", "r2", "r3", "r4", "r5"]
STOP = StopRow("stop-0001", 1000.0, "Ada", "smoke")
REFUSED = DataRefusedError("refused as data")


@pytest.fixture
def database_url(sqlite_url):
    return sqlite_url


class Book:
    """The book of the yard, which fails with ``errors`` of robots; what it was asked for is listed."""

    def __init__(self, book):
        self.book = book
        self.errors, self.asked = {}, []

    def keep_aborts(self, aborts):
        self.book.keep_aborts(aborts)

    async def issue(self, orders, also=None):
        robots = [order.robot for order in orders]
        self.asked.append(robots)
        for robot in robots:
            if robot in self.errors:
                raise self.errors[robot]
        return await self.book.issue(orders, also)


class Database:
    """The database of the yard, which fails where ``fails(work, argument)`` returns an error."""

    def __init__(self, database):
        self.database = database
        self.fails = lambda _work, _argument: None

    async def run(self, work, *arguments, **more):
        if (error := self.fails(work, arguments[0] if arguments else None)) is not None:
            raise error
        return await self.database.run(work, *arguments, **more)

    run_aside = run


class Storing:
    """A writer of stops on the yard, on whose book and database errors can be set."""

    def __init__(self, yard):
        self.yard = yard
        self.book, self.database = Book(yard.fleet._commands), Database(yard.database)
        self.writer = StopWriter(self.book, self.database)

    async def write(self, stop=STOP, robots=ROBOTS):
        return await self.writer.write(stop, robots)

    def stops(self):
        return self.yard.sql('select id, "by", reason from emergency_stops')

    def aborts(self, robot):
        """Return how many Aborts wait for a robot, and how many of them belong to a command."""
        ids = {id for (id,) in self.yard.sql("select id from sa where robot = ? and op = 'Abort'", robot)}
        told = {id for (id,) in self.yard.sql("select sa_id from commands where robot = ?", robot)}
        return len(ids), len(ids & told)


@pytest.fixture
async def storing_on(yard):
    for robot in ROBOTS:
        await yard.ready(robot)
        await yard.acknowledge_all(robot)
    return Storing(yard)


def logged(caplog):
    return [record.getMessage() for record in caplog.records if record.name == emergency_persistence.log.name]


def test_the_id_of_an_abort_is_the_same_whenever_it_is_stored():
    assert abort_id(STOP, "r1") == abort_id(StopRow("stop-0001", 5.0, "Eve"), "r1")
    assert (
        len({abort_id(STOP, "r1"), abort_id(STOP, "r2"), abort_id(STOP._replace(id="stop-0002"), "r1")}) == 3
    )


async def test_all_goes_in_one_transaction_where_nothing_is_wrong(storing_on, caplog):
    await storing_on.yard.send("a")
    assert await storing_on.write() is True
    assert storing_on.book.asked == [ROBOTS]
    assert storing_on.stops() == [("stop-0001", "Ada", "smoke")]
    assert [storing_on.aborts(robot) for robot in ROBOTS] == [(1, 1)] * 5
    assert storing_on.yard.waiting("r1") == ["Abort"]
    assert not storing_on.writer.is_owing and logged(caplog) == []
    (abort,) = [one for one in await storing_on.yard._stored() if one.robot == "r1" and one.op == "Abort"]
    assert (abort.command, abort.operator, abort.params) == (abort_id(STOP, "r1"), "Ada", {"emergency": True})
    assert abort.steps[0].reason == "smoke"


@pytest.mark.parametrize("error", [REFUSED, RuntimeError("unforeseen")])
async def test_one_robot_that_is_in_the_way_is_found_and_left_with_a_bare_abort(storing_on, caplog, error):
    storing_on.book.errors["r3"] = error
    assert await storing_on.write() is True
    assert storing_on.stops() == [("stop-0001", "Ada", "smoke")]
    # Those of others have the bare one and their command's.
    found = {robot: storing_on.aborts(robot) for robot in ROBOTS}
    assert {robot: own for robot, (_, own) in found.items()} == {"r1": 1, "r2": 1, "r3": 0, "r4": 1, "r5": 1}
    assert min(count for count, _ in found.values()) == 1
    assert storing_on.book.asked == [ROBOTS, ROBOTS, ["r1", "r2"], ["r3", "r4", "r5"], ["r3"], ["r4", "r5"]]
    assert not storing_on.writer.is_owing
    text = str(error) if error is REFUSED else ""
    ends = f": {text}" if text else ""
    assert logged(caplog) == [
        f"the emergency stop cannot be stored in one transaction and is stored in several{ends}",
        f"the Abort of robot 'r3' cannot be stored{ends}",
        "robot 'r3' is sent an Abort that no command follows: look whether it stands",
    ]
    assert {record.levelno for record in caplog.records if record.name == emergency_persistence.log.name} == {
        logging.ERROR
    }
    if not text:
        assert "RuntimeError: unforeseen" in caplog.text


async def test_a_robot_whose_abort_may_be_stored_later_is_owed_it(storing_on):
    storing_on.book.errors["r2"] = StoreError("locked")
    assert await storing_on.write() is True
    assert storing_on.writer.is_owing
    assert storing_on.aborts("r2") == (1, 0)
    storing_on.book.asked.clear()
    storing_on.book.errors.clear()
    await storing_on.writer.write_owed()
    assert storing_on.book.asked == [["r2"]]
    assert storing_on.aborts("r2")[1] == 1
    assert not storing_on.writer.is_owing
    await storing_on.writer.write_owed()
    assert storing_on.book.asked == [["r2"]]


@pytest.fixture
async def many(storing_on):
    names = [f"m{number:02d}" for number in range(40)]
    for name in names:
        await storing_on.yard.ready(name)
    storing_on.writer.owe(STOP, names)
    return names


async def test_where_a_table_takes_nothing_not_each_robot_is_tried_by_itself(storing_on, many, caplog):
    """Else a fleet of hundreds would be tried for minutes, and nobody could clear the stop meanwhile."""
    storing_on.book.errors = dict.fromkeys(many, LockedError("commands is locked"))
    for _ in range(2):
        storing_on.book.asked.clear()
        await storing_on.writer.write_owed()
        assert len(storing_on.book.asked) <= 3 * MOST_ALIKE < len(many)
    # The second time others were tried, and it is said once of all of them.
    assert logged(caplog) == [
        "Aborts of m00, m01, m02, m03, m04, m05, m06, m07, m08, m09 and 30 more cannot be stored: "
        "commands is locked"
    ]
    storing_on.book.errors.clear()
    storing_on.book.asked.clear()
    await storing_on.writer.write_owed()
    assert [sorted(robots) for robots in storing_on.book.asked] == [many]
    assert not storing_on.writer.is_owing


async def test_many_robots_whose_rows_are_locked_keep_no_other_from_its_turn(storing_on, many):
    locked = [*many[:MOST_ALIKE], *many[MOST_ALIKE + 1 :: 4]]
    free = [robot for robot in many if robot not in locked]
    storing_on.book.errors = dict.fromkeys(locked, LockedError("its rows are locked"))
    for _ in range(3):
        await storing_on.writer.write_owed()
    assert [storing_on.aborts(robot)[1] for robot in free] == [1] * len(free)
    assert [storing_on.aborts(robot)[1] for robot in locked] == [0] * len(locked)


async def test_what_drives_is_taken_back_from_each_robot_also_then(storing_on):
    for robot in ("r1", "r3"):
        await storing_on.yard.send(robot, robot=robot)
    storing_on.yard.sql("insert into sa (robot, op, params) values ('r2', 'SetPath', '{}')")
    storing_on.book.errors["r3"] = REFUSED
    await storing_on.write()
    for robot in ROBOTS:
        assert set(storing_on.yard.waiting(robot)) == {"Abort"}


async def test_what_came_after_the_bare_abort_is_taken_back_with_the_one_that_was_owed(storing_on):
    await storing_on.yard.send("a")
    # An answer to GetPath, which is no command's.
    storing_on.yard.sql("insert into sa (robot, op, params) values ('r1', 'SetPath', '{}')")
    storing_on.writer.owe(STOP, ["r1"])
    await storing_on.writer.write_owed()
    assert storing_on.yard.waiting("r1") == ["Abort"]


async def test_an_account_that_may_lock_nothing_waits_and_says_who_mends_that(
    storing_on, caplog, monkeypatch
):
    storing_on.yard.sql("insert into sa (robot, op, params) values ('r3', 'SetPath', '{}')")

    def refuse(*_):
        raise ProgrammingError("select", {}, Exception("permission denied for table sa"))

    monkeypatch.setattr(emergency_persistence.requests, "remove_unlocked", refuse)
    storing_on.book.errors["r3"] = REFUSED
    await storing_on.write()
    assert storing_on.yard.waiting("r3") == ["Abort"]
    assert (
        "an administrator has to run: robot-bridge database upgrade (permission denied for table sa)"
    ) in caplog.text


async def test_a_bare_abort_reads_as_that_of_a_command(storing_on):
    storing_on.book.errors["r3"] = REFUSED
    await storing_on.write()
    said = storing_on.yard.sql("select distinct op, params, urgent from sa where robot in ('r1', 'r3')")
    assert len(said) == 1


async def test_whether_a_transaction_was_done_that_nobody_knows_of_is_not_tried_in_parts(storing_on):
    storing_on.book.errors["r3"] = UncertainError("lost during the commit")
    with pytest.raises(UncertainError):
        await storing_on.write()
    assert storing_on.book.asked == [ROBOTS]
    assert not storing_on.writer.is_owing


async def test_a_database_that_cannot_be_used_is_said_so_and_the_stop_is_written_again(storing_on):
    away = StoreError("the database is away")
    storing_on.book.errors["r1"] = away
    storing_on.database.fails = lambda _work, _argument: away
    with pytest.raises(StoreError, match="the database is away"):
        await storing_on.write()
    assert storing_on.stops() == []
    storing_on.database.fails = lambda _work, _argument: None
    storing_on.book.errors.clear()
    assert await storing_on.write() is True
    assert storing_on.stops() == [("stop-0001", "Ada", "smoke")]


@pytest.mark.parametrize(("refusals", "row"), [(1, ("stop-0001", "\\xc9va", None)), (2, None)])
async def test_a_stop_that_is_refused_as_data_is_kept_in_plain_letters_or_not_at_all(
    storing_on, caplog, refusals, row
):
    left = [REFUSED] * refusals

    def fails(work, _argument):
        return left.pop() if work is emergency_stops.add and left else None

    storing_on.book.errors = dict.fromkeys(ROBOTS[:1], REFUSED)
    storing_on.database.fails = fails
    assert await storing_on.write(STOP._replace(by="Éva")) is (row is not None)
    assert storing_on.stops() == ([row] if row else [])
    assert logged(caplog)[1 : 1 + refusals] == ["emergency stop 'stop-0001': refused as data"] * refusals
    assert storing_on.aborts("r5")[1] == 1


async def test_a_name_in_plain_letters_has_room(storing_on):
    left = [REFUSED]
    storing_on.book.errors = {"r1": REFUSED}
    storing_on.database.fails = lambda work, _: left.pop() if work is emergency_stops.add and left else None
    await storing_on.write(STOP._replace(by="É" * 100))
    ((_, by, reason),) = storing_on.stops()
    assert (by, reason) == ("\\xc9" * 32, None)


async def test_a_robot_for_which_even_the_bare_abort_failed_is_owed_that_too(storing_on, caplog):
    storing_on.book.errors["r2"] = REFUSED
    bare = {"fails": True}

    def fails(work, robots):
        return (
            StoreError("locked")
            if work is emergency_persistence._write_bare and "r2" in robots and bare["fails"]
            else None
        )

    storing_on.database.fails = fails
    assert await storing_on.write() is True
    assert storing_on.writer.is_owing and storing_on.aborts("r2") == (0, 0)
    assert "robot 'r2' is sent an Abort that no command follows: look whether it stands" not in logged(caplog)
    bare["fails"] = False
    await storing_on.writer.write_owed()
    assert storing_on.aborts("r2") == (1, 0) and not storing_on.writer.is_owing
    assert logged(caplog)[-1] == "robot 'r2' is sent an Abort that no command follows: look whether it stands"


async def test_a_new_stop_sends_the_bare_abort_again(storing_on):
    storing_on.book.errors["r2"] = REFUSED
    await storing_on.write()
    storing_on.yard.sql("delete from sa")
    await storing_on.write(STOP._replace(id="stop-0002", at=1001.0))
    assert storing_on.aborts("r2") == (1, 0)
    assert {row[0] for row in storing_on.stops()} == {"stop-0001", "stop-0002"}


async def test_robots_are_owed_the_abort_of_their_own_stop(storing_on):
    second = STOP._replace(id="stop-0002", by="Bob")
    storing_on.writer.owe(STOP, ["r2", "r1"])
    storing_on.writer.owe(second, ["r3", "r2"])
    await storing_on.writer.write_owed()
    assert storing_on.book.asked == [["r2", "r3"], ["r1"]] or storing_on.book.asked == [["r1"], ["r2", "r3"]]
    by = {one.robot: one.operator for one in await storing_on.yard._stored() if one.op == "Abort"}
    assert by == {"r1": "Ada", "r2": "Bob", "r3": "Bob"}


async def test_who_was_removed_is_owed_nothing_and_what_is_owed_when_it_is_over_is_left_to_the_book(
    storing_on,
):
    storing_on.writer.owe(STOP, ["r1", "r2"])
    storing_on.writer.forget("r1")
    storing_on.writer.forget("nobody")
    assert storing_on.writer.is_owing
    await storing_on.writer.write_owed()
    assert storing_on.book.asked == [["r2"]]
    storing_on.writer.owe(STOP, ["r3"])
    storing_on.writer.end()
    assert not storing_on.writer.is_owing
    await storing_on.writer.write_owed()
    assert storing_on.book.asked == [["r2"]] and storing_on.aborts("r3") == (0, 0)
    await storing_on.yard.fleet.save()
    assert storing_on.aborts("r3") == (1, 1)


async def test_a_motion_that_was_written_behind_a_bare_abort_is_withdrawn(storing_on, monkeypatch):
    monkeypatch.setattr(emergency_persistence, "BARE_AFTER_S", 0.01)
    yard, has_abort = storing_on.yard, asyncio.Event()
    run_aside = storing_on.database.run_aside

    async def run_and_tell(work, *arguments):
        await run_aside(work, *arguments)
        has_abort.set()

    async def fail_late(_orders, _also=None):
        await has_abort.wait()
        # As a target's transaction that had begun before the stop.
        yard.sql("insert into sa (robot, op, params) values ('r1', 'SetPosEnd', '{\"x\": 1, \"y\": 2}')")
        raise StoreError("locked")

    storing_on.database.run_aside = run_and_tell
    storing_on.book.issue = fail_late
    storing_on.database.fails = lambda work, _: StoreError("locked") if work is emergency_stops.add else None
    with pytest.raises(StoreError):
        await storing_on.writer.write(STOP, ["r1", "r2"], ["r1"])
    assert set(yard.waiting("r1")) == {"Abort"}
    before = storing_on.aborts("r1")
    for _ in range(3):
        with pytest.raises(StoreError):
            await storing_on.writer.write(STOP, ["r1", "r2"], ["r1"])
    assert storing_on.aborts("r1") == before


async def test_each_stop_is_sent_once_to_robots_that_hear_of_it_by_the_database(storing_on):
    later = STOP._replace(id="stop-0002")
    assert await storing_on.writer.add_bare(STOP, ["r1", "r2"]) == ["r1", "r2"]
    assert await storing_on.writer.add_bare(later, ["r1"]) == ["r1"]
    for stop in (STOP, later, STOP):
        assert await storing_on.writer.add_bare(stop, ["r1"]) == []
    assert storing_on.aborts("r1") == (2, 0) and storing_on.aborts("r2") == (1, 0)


async def test_a_robot_that_is_removed_while_its_abort_is_written_is_no_trouble(storing_on):
    issue = storing_on.book.issue

    async def issue_and_forget(orders, also=None):
        storing_on.writer.forget("r1")
        return await issue(orders, also)

    storing_on.book.issue = issue_and_forget
    storing_on.writer.owe(STOP, ["r1", "r2"])
    await storing_on.writer.write_owed()
    assert not storing_on.writer.is_owing


async def test_a_fleet_without_robots_stores_its_stop(storing_on):
    assert await storing_on.write(robots=[]) is True
    assert storing_on.stops() == [("stop-0001", "Ada", "smoke")]
    assert await storing_on.writer._halve([], None, None) == {}


def test_of_each_command_it_is_known_whether_it_sets_a_robot_in_motion():
    assert COMMANDS.keys() - {"SetPosIni", "Abort"} == {*MOTION_OPS} == {"SetPosEnd", "SetPath"}
