"""Emergency stops across gateways: learnt over the bus or from the database, ended only by what is stored."""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import Future, ThreadPoolExecutor

import msgspec
import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.errors import RefusedError, StoreError
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop, StoppedGateways
from robot_bridge.gateway.cluster import stop_relay
from robot_bridge.gateway.cluster.bus import STOP
from robot_bridge.gateway.cluster.messages import Beat, Codec, Exchange, StopCall, StopSeen, Wake
from robot_bridge.gateway.cluster.stop_relay import CUT_OFF_S, EmergencyStopRelay
from robot_bridge.gateway.fleet import emergency_stop
from robot_bridge.gateway.fleet.emergency_persistence import abort_id
from robot_bridge.gateway.storage.repositories import commands, emergency_stops
from robot_bridge.gateway.storage.repositories.emergency_stops import StopRow
from tests.support.patience import BUSY

KEY = b"k" * 32
CODEC = Codec(KEY)


class Bus:
    """Keeps what is sent, and hands in what others send."""

    connected = True

    def __init__(self):
        self.sent = []

    def publish(self, subject, content):
        message = CODEC.decode(content)
        if isinstance(message, (StopCall, StopSeen)):
            message = msgspec.structs.replace(message, number=0)
        self.sent.append(message)
        return True

    def of(self, kind):
        return [message for message in self.sent if isinstance(message, kind)]


class Company:
    """The other gateways that live, as the database says."""

    def __init__(self, *names):
        self.names, self.lost = names, ()

    def others(self):
        return list(self.names)

    def just_lost(self):
        return list(self.lost)

    def database_time(self):
        return 5000.0


class Lease:
    """The connection by which stops are looked up, as long as the database is there."""

    def __init__(self, database):
        self.database, self.away = database, False

    async def read(self, work, *arguments):
        if self.away:
            raise StoreError("the database is away")
        return await self.database.read(work, *arguments)


class Place:
    """Gateway b with the robots of a yard."""

    def __init__(self, yard, **how):
        self.yard, self.stops = yard, yard.fleet.emergency
        self.bus, self.company, self.clock = Bus(), Company("a"), ManualClock(uptime=100.0)
        self.exchange, self.lease = Exchange("b", KEY, [self.bus]), Lease(yard.database)
        parts = self.stops, self.company, self.exchange, self.lease, self.clock
        self.relay = EmergencyStopRelay(*parts, **how)
        self.stops.relay_by(self.relay)
        self.told = []
        self.stops.reach(self.told.append)

    def say(self, message, subject=STOP):
        self.exchange.receive(subject, CODEC.encode(message))

    async def until(self, condition):
        async with asyncio.timeout(10 * BUSY):
            while not condition():
                await asyncio.sleep(0.005)

    async def store(self, stop):
        await self.yard.database.run(emergency_stops.add, stop)


@pytest.fixture
async def place(two):
    return Place(two)


CALL = StopCall("a", "stop-number-a", 1000.0, "Ada", "smoke")


async def test_a_call_stops_the_robots_here_is_answered_and_stored(place):
    place.say(CALL)
    await place.until(lambda: place.bus.of(StopSeen))
    assert place.told == ["emergency-stop-number-a"]
    assert place.bus.of(StopSeen)[0] == StopSeen("b", "stop-number-a", 2, 0, 0, ["r1", "r2"], [])
    await place.until(lambda: place.stops.report().stored)
    assert await place.yard.database.run(emergency_stops.find, "stop-number-a") == StopRow(
        "stop-number-a", 1000.0, "Ada", "smoke"
    )
    assert [op for op in place.yard.waiting("r1") if op == "Abort"] == ["Abort"]
    # However often, and by whichever way, it comes.
    place.say(CALL)
    await place.relay.read_stored()
    await place.until(lambda: len(place.bus.of(StopSeen)) >= 2)
    assert place.told == ["emergency-stop-number-a"]


async def test_an_operator_sees_how_many_gateways_have_it(place):
    await place.stops.stop(EmergencyStop("stop-number-b", "a child"), "Bob")
    assert [(call.id, call.by) for call in place.bus.of(StopCall)] == [("stop-number-b", "Bob")]
    assert place.stops.report().gateways == StoppedGateways(1, 2, ["a"])
    place.say(StopSeen("a", "stop-number-b", 3, 2, 1, ["x"], []))
    report = place.stops.report()
    assert report.gateways == StoppedGateways(2, 2, [])
    assert (report.robots, report.acknowledged, report.standing) == (5, 2, 1)
    assert report.waiting == ["r1", "r2", "x"]
    # An answer to another stop says nothing of this one.
    place.say(StopSeen("c", "stop-number-other", 9, 9, 9))
    assert place.stops.report().gateways == StoppedGateways(2, 3, ["c"])


async def test_one_whose_lease_has_just_run_out_counts_until_its_robots_are_anothers(place):
    """Else everybody would seem to stand while its robots drive and are counted nowhere."""
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    place.company.names, place.company.lost = (), ("a",)
    assert place.stops.report().gateways == StoppedGateways(1, 2, ["a"])
    place.company.lost = ()
    assert place.stops.report().gateways == StoppedGateways(1, 1, [])


async def test_robots_that_move_or_are_not_heard_elsewhere_are_named_and_counted(place):
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    many = [f"x{k:02}" for k in range(50)]
    for gateway in ("a", "c"):
        names = [f"{gateway}-{name}" for name in many]
        moves = {"moving": names, "moving_more": 3, "unheard": names[:1], "unheard_more": 1}
        place.say(StopSeen(gateway, "stop-number-b", 60, 60, 6, **moves))
    report = place.stops.report()
    assert (report.standing, report.unheard, report.unheard_more) == (12, ["a-x00", "c-x00"], 2)
    assert (len(report.moving), report.moving_more) == (50, 56)


async def test_what_a_silent_gateway_said_is_not_counted_and_it_is_called_again(place, monkeypatch):
    """It may have been frozen, and its robots drive on."""
    monkeypatch.setattr(stop_relay, "LOOK_S", 0.01)
    monkeypatch.setattr(stop_relay, "COUNTS_HOLD_S", 0.2)
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    place.say(StopSeen("a", "stop-number-b", 3, 3, 3))
    assert (place.stops.report().standing, place.stops.report().gateways.missing) == (3, [])
    task = asyncio.create_task(place.relay.run())
    await place.until(lambda: place.stops.report().gateways.missing == ["a"])
    assert place.stops.report().standing == 0
    calls = len(place.bus.of(StopCall))
    await place.until(lambda: len(place.bus.of(StopCall)) > calls)
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


async def test_who_has_not_answered_is_called_again(place, monkeypatch):
    looks = []
    monkeypatch.setattr(stop_relay, "until_tick", lambda _seconds: looks.append(1) or 0.01)
    task = asyncio.create_task(place.relay.run())
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    await place.until(lambda: len(place.bus.of(StopCall)) >= 4)
    place.say(StopSeen("a", "stop-number-b", 0, 0, 0))
    calls = len(place.bus.of(StopCall))
    looks.clear()
    # At the database and at who has not answered.
    await place.until(lambda: len(looks) >= 10)
    assert len(place.bus.of(StopCall)) == calls
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


class Disk:
    """A journal that knows who had heard of a stop by the time it was noted; ``stuck`` notes none."""

    def __init__(self, place, *, stuck):
        self._place, self._stuck, self._thread = place, stuck, ThreadPoolExecutor(1)
        self.heard = []

    def write(self, _stops):
        return Future() if self._stuck else self._thread.submit(self._write)

    def _write(self):
        time.sleep(0.05)
        self.heard.append((len(self._place.bus.of(StopCall)), list(self._place.told)))


@pytest.fixture
async def disk(place, monkeypatch):
    monkeypatch.setattr(emergency_stop, "NOTED_WITHIN", 60.0)
    place.stops._journal = Disk(place, stuck=False)
    return place.stops._journal


async def test_others_hear_of_a_stop_before_it_is_noted_and_robots_here_after_that(place, disk):
    """All of it without a turn of the loop."""
    place.stops.begin(EmergencyStop("stop-number-b"), "Bob")
    assert disk.heard == [(1, [])]
    assert place.stops.in_force and place.told == ["emergency-stop-number-b"]


async def test_a_disk_that_hangs_keeps_no_robot_going(place):
    place.stops._journal = Disk(place, stuck=True)
    place.stops.begin(EmergencyStop("stop-number-b"), "Bob")
    assert place.told == ["emergency-stop-number-b"]


async def test_a_stop_from_elsewhere_waits_for_no_disk_here(place, disk):
    place.say(CALL)
    assert place.told == ["emergency-stop-number-a"] and not disk.heard


async def test_a_stop_that_no_message_told_of_is_found_in_the_database(place):
    await place.store(StopRow("stop-number-a", 1000.0, "Ada"))
    await place.relay.read_stored()
    assert place.stops.in_force and place.told == ["emergency-stop-number-a"]


async def test_it_ends_when_its_own_row_says_so(place):
    place.say(CALL)
    await place.until(lambda: place.stops.in_force and place.stops.report().stored)
    await place.yard.database.run(emergency_stops.clear, 1010.0, "Eve", "clear", {"stop-number-a"})
    await place.relay.read_stored()
    report = place.stops.report()
    assert (report.in_force, report.cleared_by, report.clear_reason) == (False, "Eve", "clear")
    # A call that was late does not begin it again.
    place.say(CALL)
    await asyncio.sleep(0)
    assert not place.stops.in_force


async def test_of_two_stops_at_the_same_time_each_is_answered_and_both_have_to_end(place):
    """Each of two operators' gateways hears of the other one's last."""
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    place.say(CALL)
    await place.until(lambda: place.stops.report().stored)
    assert place.stops.report().stop == "stop-number-a"
    place.bus.sent.clear()
    place.say(StopCall("a", "stop-number-b", 1000.0, "Bob"))
    assert {seen.id for seen in place.bus.of(StopSeen)} == {"stop-number-a", "stop-number-b"}
    # That one of both that a gateway did not know of as the other was cleared stays in force.
    place.yard.sql(
        "update emergency_stops set cleared_at = ?, cleared_by = ? where id = ?", 1010.0, "Eve", CALL.id
    )
    await place.relay.read_stored()
    assert (place.stops.in_force, place.stops.report().stop) == (True, "stop-number-b")
    assert not (await place.stops.clear(ClearEmergencyStop(), "Eve")).in_force


async def test_a_stop_that_was_over_when_the_next_one_came_does_not_come_back(place):
    """It was cleared elsewhere, and this gateway has not looked since."""

    def clear(id, at):
        place.yard.sql("update emergency_stops set cleared_at = ?, cleared_by = 'Eve' where id = ?", at, id)

    place.say(CALL)
    await place.until(lambda: place.stops.report().stored)
    clear(CALL.id, 1009.9)
    place.say(StopCall("a", "stop-number-c", 1010.0, "Bob"))
    await place.until(lambda: place.stops.report().stored)
    await place.relay.read_stored()
    assert (place.stops.in_force, place.stops.report().stop) == (True, "stop-number-c")
    clear("stop-number-c", 1020.0)
    await place.relay.read_stored()
    assert (place.stops.in_force, place.stops.report().stop) == (False, "stop-number-c")


async def test_a_gateway_that_is_heard_without_a_lease_is_missed_until_it_has_one(place, monkeypatch):
    """It is cut off from the database, and its robots may be there still."""
    monkeypatch.setattr(place.exchange, "heard_without_lease", lambda: ["c"])
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    place.say(StopSeen("a", "stop-number-b", 3, 2, 1, ["x"], []))
    assert place.stops.report().gateways == StoppedGateways(2, 3, ["c"])


async def test_another_stop_that_was_cleared_ends_nothing_here(place):
    await place.store(StopRow("old", 900.0, "Ada", None, 950.0, "Eve"))
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    await place.relay.read_stored()
    assert place.stops.in_force


@pytest.fixture
def held(place, monkeypatch):
    """An event until which no Abort is stored."""
    book, may_store = place.yard.fleet._commands, asyncio.Event()

    async def issue(orders, also=None, _issue=book.issue):
        await may_store.wait()
        return await _issue(orders, also)

    monkeypatch.setattr(book, "issue", issue)
    return may_store


async def test_one_that_others_have_cleared_stays_in_force_until_it_is_stored_here(place, held):
    place.say(CALL)
    await place.until(lambda: place.stops.in_force)
    await place.store(StopRow("stop-number-a", 1000.0, "Ada", "smoke", 1001.0, "Eve"))
    place.yard.now += 5.0
    await place.relay.read_stored()
    assert place.stops.in_force
    # What robots of other gateways have been sent since is theirs.
    for robot in ("r1", "elsewhere"):
        place.yard.sql("insert into sa (robot, op, urgent) values (?, 'SetPath', ?)", robot, False)
    held.set()
    await place.until(lambda: place.stops.report().stored)
    assert (place.yard.waiting("r1"), place.yard.waiting("elsewhere")) == (["Abort"], ["SetPath"])
    await place.relay.read_stored()
    assert not place.stops.in_force


async def test_who_stores_a_stop_first_takes_back_what_robots_of_all_gateways_were_to_do(place):
    place.yard.sql("insert into sa (robot, op, urgent) values (?, 'SetPath', ?)", "elsewhere", False)
    place.say(CALL)
    await place.until(lambda: place.stops.in_force and place.stops.report().stored)
    assert place.yard.waiting("elsewhere") == []


def over_at(cleared_at):
    """A stop that Eve has cleared."""
    return StopRow("stop-number-a", cleared_at - 1.0, "Ada", "smoke", cleared_at, "Eve")


async def test_robots_that_drive_since_before_a_stop_that_is_over_are_aborted(place):
    """This gateway did not hear of it in time."""
    await place.yard.send("before")
    await place.yard.acknowledge_all()
    over = over_at(place.yard.now + 2.0)
    place.yard.now += 10.0
    await place.yard.send("after", robot="r2")
    await place.store(over)
    await place.relay.read_stored()
    report = place.stops.report()
    assert (report.stop, report.in_force, report.cleared_by) == ("stop-number-a", False, "Eve")
    await place.yard.fleet.save()
    assert (place.yard.waiting("r1"), place.yard.waiting("r2")) == (["Abort"], ["SetPosEnd"])
    await place.yard.acknowledge_all()
    assert await place.yard.states() == {
        "before": "aborted", "after": "queued", abort_id(over, "r1"): "acknowledged"
    }  # fmt: skip
    # Not each time that it is read.
    await place.relay.read_stored()
    await place.yard.fleet.save()
    assert place.yard.waiting("r1") == []


async def test_so_are_those_whose_abort_of_an_earlier_stop_has_not_ended(place):
    """Nobody saw the robot stand between the two stops."""
    place.say(CALL)
    await place.until(lambda: place.stops.report().stored)
    await place.stops.clear(ClearEmergencyStop(), "Eve")
    await place.yard.acknowledge_all()
    await place.yard.send("before")
    over = StopRow("stop-number-c", place.yard.now + 1.0, "Ada", None, place.yard.now + 2.0, "Eve")
    place.yard.now += 10.0
    await place.store(over)
    await place.relay.read_stored()
    await place.yard.fleet.save()
    assert place.yard.waiting("r1")[-1] == "Abort"


@pytest.mark.parametrize(("later", "waiting"), [(5.0, "Abort"), (90.0, "SetPosEnd")])
async def test_so_are_those_sent_by_a_clock_that_is_minutes_ahead_for_a_while(place, later, waiting):
    place.yard.now += 300.0
    await place.yard.send("before")
    over = over_at(place.yard.now - 298.0)
    place.yard.now += later - 298.0
    await place.store(over)
    await place.relay.read_stored()
    await place.yard.fleet.save()
    assert place.yard.waiting("r1")[-1] == waiting


async def test_a_stop_that_was_over_at_a_time_to_come_tells_nothing(place):
    await place.yard.send("before")
    await place.store(over_at(place.yard.now + 1000.0))
    await place.relay.read_stored()
    await place.yard.fleet.save()
    assert place.yard.waiting("r1") == ["SetPosEnd"]


async def test_a_robot_of_a_gateway_that_died_over_a_stop_is_aborted_when_that_is_over(place):
    for robot in ("r1", "r2"):
        await place.yard.send(f"before-{robot}", robot=robot)
    place.yard.now += 10.0
    await place.store(over_at(place.yard.now - 5.0))
    place.stops.take_over(["r1"], over_at(place.yard.now - 5.0))
    await place.yard.fleet.save()
    assert (place.yard.waiting("r1"), place.yard.waiting("r2")) == (["Abort"], ["SetPosEnd"])
    await place.yard.restart()
    await place.yard.fleet.save()
    assert (place.yard.waiting("r1"), place.yard.waiting("r2")) == (["Abort"], ["Abort"])


@pytest.mark.parametrize("read", [StopRow("stop-number-a", 1001.0, "Ada", "smoke"), None, over_at(900.0)])
async def test_such_a_robot_is_aborted_also_where_the_stop_was_over_after_it_was_read(place, read):
    await place.yard.send("before")
    over = over_at(place.yard.now + 2.0)
    place.yard.now += 10.0
    await place.store(over)
    place.yard.fleet._commands.drop(["r1"])
    await place.relay.read_stored()
    place.yard.fleet._commands.adopt(await place.yard.database.run(commands.still_open, ["r1"]))
    place.stops.take_over(["r1"], read)
    await place.yard.fleet.save()
    assert place.yard.waiting("r1") == ["Abort"]


async def test_an_abort_that_could_not_be_stored_before_the_stop_was_over_is_stored(place, monkeypatch):
    """And before any other message of its robot."""
    book = place.yard.fleet._commands
    await place.yard.send("before")

    async def issue(orders, also=None, _issue=book.issue):
        if any(order.robot == "r1" for order in orders):
            raise StoreError("the robot's rows are locked")
        return await _issue(orders, also)

    monkeypatch.setattr(book, "issue", issue)
    place.say(CALL)
    await place.until(lambda: place.stops.in_force and place.stops.report().stored)
    await place.yard.database.run(emergency_stops.clear, 1010.0, "Eve", "clear", {"stop-number-a"})
    await place.relay.read_stored()
    assert not place.stops.in_force
    monkeypatch.undo()
    await place.yard.send("after")
    states = await place.yard.states()
    assert list(states)[-2:] == [abort_id(StopRow("stop-number-a", 0.0, ""), "r1"), "after"]
    assert place.yard.waiting("r1")[-2:] == ["Abort", "SetPosEnd"]


async def test_a_newer_stop_holds_when_the_one_before_ends(place):
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    await place.yard.database.run(emergency_stops.clear, 1010.0, "Eve", None, {"stop-number-b"})
    await place.store(StopRow("stop-number-a", 1011.0, "Ada"))
    await place.relay.read_stored()
    assert place.stops.in_force and place.stops.report().stop == "stop-number-a"


async def test_nobody_clears_a_stop_that_this_gateway_does_not_know_of(place):
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    await place.store(StopRow("stop-number-a", 1011.0, "Ada", "smoke"))
    with pytest.raises(
        RefusedError, match=r"Ada made another emergency stop .*\(smoke\), at another gateway"
    ):
        await place.stops.clear(ClearEmergencyStop(), "Eve")
    assert place.stops.in_force
    await place.relay.read_stored()
    assert not (await place.stops.clear(ClearEmergencyStop(), "Eve")).in_force


async def test_nobody_clears_a_stop_that_came_while_the_clearing_waited(place, held):
    place.stops.begin(EmergencyStop("stop-number-b"), "Bob")
    clearing = asyncio.create_task(place.stops.clear(ClearEmergencyStop(), "Eve"))
    await asyncio.sleep(0)
    place.say(CALL)
    held.set()
    with pytest.raises(RefusedError, match="Ada made another emergency stop"):
        await clearing
    assert place.stops.in_force
    assert len(await place.yard.database.run(emergency_stops.in_force)) == 2


async def cut_off(place):
    await place.relay.read_stored()
    place.lease.away = True
    place.clock.advance(CUT_OFF_S + 0.1)
    with pytest.raises(StoreError):
        await place.relay.read_stored()
    await place.relay._stop_if_cut_off()


async def test_a_gateway_that_reaches_nobody_stops_its_robots(place):
    await cut_off(place)
    report = place.stops.report()
    assert report.in_force and report.by == "gateway b" and place.told
    assert report.reason == "cut off from the database and from every other gateway"
    # By the database's clock, as all stops.
    assert report.at == 5000.0


async def test_not_where_another_gateway_is_heard(place):
    place.say(Beat("a"))
    await cut_off(place)
    assert not place.stops.in_force


async def test_not_where_it_was_alone_before(place):
    place.company.names = ()
    await cut_off(place)
    assert not place.stops.in_force


async def test_not_where_the_site_wants_them_to_go_on(two):
    place = Place(two, stops_when_cut_off=False)
    await cut_off(place)
    assert not place.stops.in_force


async def test_others_are_woken_when_a_stop_is_cleared(place, monkeypatch):
    monkeypatch.setattr(stop_relay, "TELL_S", 0.0)
    task = asyncio.create_task(place.relay.run())
    await place.stops.stop(EmergencyStop("stop-number-b"), "Bob")
    await place.stops.clear(ClearEmergencyStop(), "Eve")
    await place.until(lambda: Wake("b", "stops") in place.bus.sent)
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
