"""How an outbox goes out over a connection: in order, once each, an emergency stop before all else."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json

import pytest
from websockets.exceptions import ConnectionClosedOK

from robot_bridge.core.clock import steady_time
from robot_bridge.core.errors import DataRefusedError, StoreError
from robot_bridge.core.logs import IN_FULL, RepeatedLines
from robot_bridge.gateway.api import delivery, robot_session
from robot_bridge.gateway.api.delivery import Delivery
from robot_bridge.gateway.api.robot_session import RobotChannel
from robot_bridge.gateway.storage.repositories.requests import AnswerRow
from tests.support.patience import BUSY

TARGET = '{"x": 1.0, "y": 2.0}'


def row(id, op="SetPosEnd", params=TARGET, payload=None, urgent=False):
    return AnswerRow(id, op, params, payload, urgent)


class Mailboxes:
    """The outbox of one robot, and what was noted of it; ``before`` is awaited as one is handed over.

    ``late`` are answers to whether what was handed over may be sent still; true when there are none left.
    """

    def __init__(self):
        self.rows, self.noted, self.asked = [], [], []
        self.ended = set()
        self.signal = asyncio.Event()
        self.before = None
        self.late = []
        self.fails, self.fault = 0, StoreError("the database is away")

    def event(self, robot):
        assert robot == "r1"
        return self.signal

    async def outbox(self, robot, after, after_urgent):
        assert robot == "r1"
        self.asked.append((after, after_urgent))
        if self.fails:
            self.fails -= 1
            raise self.fault
        new = [one for one in self.rows if one.id > (after_urgent if one.urgent else after)]
        return sorted(new, key=lambda one: (not one.urgent, one.id))

    async def waiting_aborts(self, robot, after, after_urgent):
        if self.fails:
            self.fails -= 1
            raise self.fault
        new = [one for one in self.rows if one.id > (after_urgent if one.urgent else after)]
        return {one.id for one in new if one.op == "Abort"}

    async def mark_sending(self, robot, id):
        assert robot == "r1"
        self.noted.append(("handed over", id))
        if self.before is not None:
            await self.before()
        return id not in self.ended

    def may_send(self, robot, checked_at):
        assert robot == "r1" and checked_at <= steady_time()
        return self.late.pop() if self.late else True

    async def delivered(self, ids):
        self.noted.append(("delivered", *ids))


class Fleet:
    def __init__(self):
        self.outboxes = Mailboxes()
        self.maps = self
        self.repeated = RepeatedLines()

    async def whole_or_around(self, robot):
        assert robot == "r1"
        return b"the whole site"


class Connection:
    """Keeps what is sent; once it is shut nothing can be sent any more."""

    def __init__(self):
        self.frames = []
        self.is_shut = self.is_sending = False
        self.is_slow, self.began, self.may_end = False, asyncio.Event(), asyncio.Event()
        self.unheard_cuts = 0
        self.overtaken: int | None = None
        """messages that had been sent when a stop asked for the rest of a large one to end."""

    @property
    def is_busy(self):
        return self.is_sending

    def write_at_once(self, frame):
        if self.is_shut or self.is_sending:
            return False
        self.frames.append(json.loads(frame))
        return True

    async def send(self, frame):
        if self.is_shut:
            raise ConnectionClosedOK(None, None)
        if not isinstance(frame, str):
            frame = "".join([piece async for piece in frame])
            self.began.set()
            if self.is_slow:
                await self.may_end.wait()
        self.frames.append(json.loads(frame))

    async def cut_if_busy(self):
        if self.is_slow and self.unheard_cuts:
            # Nothing was in pieces yet.
            self.unheard_cuts -= 1
        elif self.is_slow:
            self.is_slow = False
            self.may_end.set()
            self.overtaken = len(self.frames)

    @property
    def sent(self):
        return [(frame["id"], frame["method"]) for frame in self.frames]


class Line:
    """A delivery over a connection."""

    def __init__(self):
        self.fleet, self.connection = Fleet(), Connection()
        self.boxes = self.fleet.outboxes
        self.delivery = Delivery(self.fleet, RobotChannel(self.connection), "r1")

    async def put(self, *rows):
        self.boxes.rows += rows
        self.boxes.signal.set()
        await rest()


async def rest():
    """Let everything happen that can happen by now."""
    for _ in range(20):
        await asyncio.sleep(0)


class SharedChannel(RobotChannel):
    """A channel on which the turn of what is not urgent comes when it is given."""

    def __init__(self, connection):
        super().__init__(connection)
        self.asked, self.turn = [], asyncio.Event()

    @property
    def is_busy(self):
        return not self.turn.is_set()

    @contextlib.asynccontextmanager
    async def lane(self, *, urgent, large):
        self.asked.append((urgent, large))
        if not urgent:
            await self.turn.wait()
        yield


@pytest.fixture
async def line():
    line = Line()
    yield line
    line.delivery.end()


async def test_a_map_without_content_is_that_of_the_whole_site(line):
    await line.put(row(1, "SetMap", "{}", b"a window"), row(2, "SetMap", "{}"))
    line.delivery.begin()
    await rest()
    maps = [base64.b64decode(frame["params"]["map"]) for frame in line.connection.frames]
    assert maps == [b"a window", b"the whole site"]
    assert line.delivery.reader == ("r1", 2, 0)


async def test_what_waits_goes_out_once_in_order_and_what_comes_later_after_it(line):
    await line.put(row(1, "Start", "{}"), row(2))
    line.delivery.begin()
    await rest()
    await line.put(row(3, "Abort", "{}"))
    assert line.connection.frames == [
        {"jsonrpc": "2.0", "id": 1, "method": "Start"},
        {"jsonrpc": "2.0", "id": 2, "method": "SetPosEnd", "params": {"x": 1.0, "y": 2.0}},
        {"jsonrpc": "2.0", "id": 3, "method": "Abort"},
    ]
    assert line.boxes.asked == [(0, 0), (2, 0)]


async def test_what_drives_is_noted_before_it_is_sent_and_all_else_afterwards(line):
    await line.put(row(1), row(2, "SetPath", '{"points": [[1, 2], [3, 4]]}'), row(3, "SetPosIni"))
    line.delivery.begin()
    await rest()
    assert line.boxes.noted == [("handed over", 1), ("handed over", 2), ("delivered", 3)]
    assert line.connection.sent == [(1, "SetPosEnd"), (2, "SetPath"), (3, "SetPosIni")]


async def test_what_is_urgent_waits_for_no_turn_and_what_a_stop_overtakes_in_its_turn_is_looked_at_again(
    line, monkeypatch
):
    frame = len('{"jsonrpc":"2.0","method":"SetPosEnd","params":{"x":1.0,"y":2.0},"id":1}')
    monkeypatch.setattr(delivery, "LARGE", frame)
    channel = SharedChannel(line.connection)
    line.delivery = Delivery(line.fleet, channel, "r1")
    await line.put(row(1, "Abort", "{}", urgent=True), row(2), row(3, "SetPosEnd", '{"x": 1.0, "y": 22.0}'))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(1, "Abort")] and channel.asked == [(True, False), (False, False)]
    line.delivery.stop_now("stop-1")
    line.boxes.ended = {2}
    channel.turn.set()
    await rest()
    assert line.connection.sent == [(1, "Abort"), ("stop-1", "Abort"), (3, "SetPosEnd")]
    assert channel.asked[2:] == [(False, True)]


async def test_what_may_not_be_sent_any_more_when_its_turn_comes_is_handed_over_again(line):
    """Another gateway may have the robot by then."""
    line.boxes.late = [False]
    await line.put(row(1), row(2))
    line.delivery.begin()
    await rest()
    assert line.boxes.noted == [("handed over", 1), ("handed over", 1), ("handed over", 2)]
    assert line.connection.sent == [(1, "SetPosEnd"), (2, "SetPosEnd")]


async def test_what_has_ended_meanwhile_is_not_sent_and_not_asked_for_again(line):
    line.boxes.ended = {1}
    await line.put(row(1), row(2))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(2, "SetPosEnd")]
    await line.put()
    assert line.boxes.asked[-1] == (2, 0)


async def test_a_message_that_cannot_be_read_is_left_out_and_in_the_log(line, caplog):
    await line.put(row(1, params="[" * 2000), row(2))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(2, "SetPosEnd")]
    (record,) = caplog.records
    assert record.getMessage().startswith("link websocket: message 1 for robot 'r1': SetPosEnd: ")


async def test_an_abort_is_sent_before_all_that_waits_and_what_it_revokes_is_not_sent(line):
    waiting = row(1, "SetMap", "{}", b"a window"), row(2), row(3, "SetPosIni"), row(4, "Abort", "{}")
    await line.put(*waiting, row(5, "SetPath", '{"points": [[1, 2], [3, 4]]}'))
    line.delivery.begin()
    await rest()
    assert [id for id, _ in line.connection.sent] == [4, 1, 3, 5]
    assert line.boxes.noted == [*(("delivered", id) for id in (4, 1, 3)), ("handed over", 5)]
    # The Abort that is not acknowledged yet is not sent once more; the next one is.
    await line.put(row(6, "Abort", "{}"), row(7))
    assert [id for id, _ in line.connection.sent[4:]] == [6, 7]
    line.boxes.rows.clear()
    await line.put()
    assert line.delivery._sent.aborts == set()


async def test_a_map_that_an_abort_overtook_is_sent_when_the_database_is_back(line, monkeypatch):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.0)
    await line.put(row(1, "SetMap", "{}", b"a window"), row(2, "Abort", "{}"))
    monkeypatch.setattr(line.boxes, "delivered", failing_once(line.boxes.delivered))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(2, "Abort"), (1, "SetMap")]


def failing_once(work):
    failures = [StoreError("the database is away")]

    async def work_or_fail(*arguments):
        if failures:
            raise failures.pop()
        await work(*arguments)

    return work_or_fail


@pytest.mark.parametrize("waiting", [row(1, "SetMap", "{}", b"a window"), row(1), row(1, "SetPosIni")])
async def test_an_abort_waits_for_the_turn_of_no_message_of_its_robot(line, waiting):
    channel = SharedChannel(line.connection)
    line.delivery = Delivery(line.fleet, channel, "r1")
    await line.put(waiting)
    line.delivery.begin()
    await rest()
    assert channel.asked == [(False, False)] and line.connection.sent == []
    await line.put(row(2, "Abort", "{}"))
    assert line.connection.sent == [(2, "Abort")]
    channel.turn.set()
    await rest()
    # A target that the Abort revokes is not sent at all.
    assert line.connection.sent[1:] == [(1, waiting.op)] * (waiting.op != "SetPosEnd")


async def test_an_abort_does_not_wait_until_a_map_is_made(line):
    is_made = asyncio.Event()

    async def make(_robot):
        await is_made.wait()
        return b"the whole site"

    line.fleet.whole_or_around = make
    await line.put(row(1, "SetMap", "{}"))
    line.delivery.begin()
    await rest()
    await line.put(row(2, "Abort", "{}"))
    assert line.connection.sent == [(2, "Abort")]
    is_made.set()
    await rest()
    assert line.connection.sent[1:] == [(1, "SetMap")]


async def test_an_abort_that_cannot_be_read_amid_a_map_is_read_again(line, monkeypatch):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.01)
    channel = SharedChannel(line.connection)
    line.delivery = Delivery(line.fleet, channel, "r1")
    await line.put(row(1, "SetMap", "{}", b"a window"))
    line.delivery.begin()
    await rest()
    line.boxes.fails = 2
    await line.put(row(2, "Abort", "{}"))
    assert line.connection.sent == []
    async with asyncio.timeout(BUSY * 5):
        while line.connection.sent != [(2, "Abort")]:
            await asyncio.sleep(0.001)


@pytest.mark.parametrize("comes", ["before", "meanwhile", "never"])
async def test_an_abort_does_not_wait_for_the_result_of_ready_behind_the_map_of_another_robot(line, comes):
    line.connection.is_sending = line.connection.is_slow = True
    abort = row(1, "Abort", "{}")
    if comes == "before":
        await line.put(abort)
        line.boxes.signal.clear()

    async def after_the_map(frame):
        await line.connection.may_end.wait()
        line.connection.frames.append(json.loads(frame))

    line.connection.send = after_the_map
    sending = asyncio.create_task(line.delivery.send_result('{"id": 7, "method": "the result"}'))
    await rest()
    if comes == "meanwhile":
        assert line.connection.overtaken is None
        await line.put(abort)
    assert line.connection.overtaken == (None if comes == "never" else 0)
    line.connection.may_end.set()
    await sending
    assert line.connection.sent == [(7, "the result")]


async def test_an_abort_does_not_wait_for_the_end_of_a_map_that_is_being_sent(line, monkeypatch):
    monkeypatch.setattr(robot_session, "FRAME_PIECE", 40)
    monkeypatch.setattr(delivery, "LARGE", 60)
    line.connection.is_slow, line.connection.unheard_cuts = True, 1
    await line.put(row(1, "SetMap", "{}", bytes(100)), row(2, "SetPosIni"))
    line.delivery.begin()
    async with asyncio.timeout(BUSY * 5):
        await line.connection.began.wait()
    await line.put(row(3))
    assert line.connection.sent == []
    # What the Abort takes back is gone from the outbox.
    del line.boxes.rows[2]
    await line.put(row(4, "Abort", "{}"))
    async with asyncio.timeout(BUSY * 5):
        while (2, "SetPosIni") not in line.connection.sent:
            await asyncio.sleep(0.001)
    assert line.connection.overtaken == 0
    assert line.connection.sent == [(1, "SetMap"), (4, "Abort"), (2, "SetPosIni")]


async def test_the_bytes_of_a_map_go_out_as_text(line):
    await line.put(row(1, "SetMap", "{}", b"\x00map"))
    line.delivery.begin()
    await rest()
    assert line.connection.frames[0]["params"]["map"] == "AG1hcA=="


@pytest.mark.parametrize("more", [0, 1, 2])
async def test_the_bytes_of_a_large_map_are_the_same_whatever_they_are_cut_into(line, monkeypatch, more):
    monkeypatch.setattr(delivery, "LARGE", 10)
    monkeypatch.setattr(delivery, "PIECE", 6)
    content = bytes(range(24 + more))
    await line.put(row(1, "SetMap", '{"map": "what comes with the row"}', content), row(2))
    await line.put(row(3, "Alive", "{}", bytes(100)), row(4))
    line.delivery.begin()
    async with asyncio.timeout(60):
        while (4, "SetPosEnd") not in line.connection.sent:
            await asyncio.sleep(0.01)
    assert base64.b64decode(line.connection.frames[0]["params"]["map"]) == content
    assert [id for id, _ in line.connection.sent][:2] == [1, 2]


async def test_an_urgent_message_is_sent_before_older_ones_and_what_is_left_is_read_on_for_each_kind(line):
    await line.put(row(4, "SetPosIni"), row(5, "Abort", '{"emergency": true}', urgent=True))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(5, "Abort"), (4, "SetPosIni")]
    await line.put(row(6))
    assert line.boxes.asked[-1] == (4, 5)
    assert line.connection.sent[2:] == [(6, "SetPosEnd")]


async def test_an_emergency_stop_is_called_at_once_under_an_id_of_its_own(line):
    line.delivery.stop_now("emergency-stop-0001")
    await rest()
    assert line.connection.frames == [
        {"jsonrpc": "2.0", "id": "emergency-stop-0001", "method": "Abort", "params": {"emergency": True}}
    ]


async def test_a_stop_that_comes_as_a_target_is_handed_over_leaves_that_unsent(line):
    async def stop():
        line.boxes.before = None
        line.delivery.stop_now("emergency-stop-0001")
        # What the stop takes back is gone from the outbox when it is read again.
        line.boxes.rows.clear()

    line.boxes.before = stop
    await line.put(row(1), row(2))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [("emergency-stop-0001", "Abort")]
    # Read again from where it was, without waiting for anything new; after a second stop too.
    assert line.boxes.asked == [(0, 0), (0, 0)]
    line.boxes.before = stop
    await line.put(row(3))
    assert line.connection.sent[1:] == [("emergency-stop-0001", "Abort")]


async def test_a_stop_over_a_connection_that_is_closed_is_no_trouble(line, caplog):
    line.connection.is_shut = True
    line.delivery.stop_now("emergency-stop-0001")
    await rest()
    assert len(line.delivery._stopping) == 0 and caplog.records == []


async def test_a_stop_that_is_on_its_way_is_kept_until_it_is_sent(line):
    line.connection.is_sending = True
    line.delivery.stop_now("emergency-stop-0001")
    assert len(line.delivery._stopping) == 1
    await rest()
    assert len(line.delivery._stopping) == 0


async def test_a_connection_that_is_closed_ends_its_delivery(line):
    line.delivery.begin()
    await rest()
    line.connection.is_shut = True
    await line.put(row(1))
    assert line.delivery._work.done() and line.delivery._work.exception() is None


async def test_a_database_that_is_away_is_asked_again(line, caplog, monkeypatch):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.0)
    line.boxes.fails = 2
    await line.put(row(1))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(1, "SetPosEnd")]
    assert [record.getMessage() for record in caplog.records] == [
        "link websocket: robot 'r1': the database is away"
    ] * 2


async def test_a_database_that_stays_away_fills_no_log(line, caplog, monkeypatch):
    """Each robot is tried again every second: a line each time would be thousands in an hour."""
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.0)
    line.boxes.fails = 2 * IN_FULL
    line.delivery.begin()
    while line.boxes.fails:
        await rest()
    assert len(caplog.records) == IN_FULL
    # What is refused of this robot alone is another trouble.
    line.boxes.fails, line.boxes.fault = 1, DataRefusedError("refused")
    line.delivery.begin()
    await rest()
    assert caplog.records[-1].getMessage() == "link websocket: robot 'r1': refused"


async def test_what_nobody_foresaw_keeps_back_nothing_that_comes_after_it(line, caplog, monkeypatch):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.0)
    line.boxes.fails, line.boxes.fault = 1, KeyError("robot")
    line.delivery.begin()
    await line.put(row(1, "Abort", "{}", urgent=True))
    assert line.connection.sent == [(1, "Abort")]
    assert "what waits for robot 'r1': internal error" in caplog.text


async def test_a_database_that_is_away_is_not_asked_without_a_pause(line, monkeypatch):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 60.0)
    line.boxes.fails = 1
    line.delivery.begin()
    await line.put(row(1))
    assert (line.connection.sent, len(line.boxes.asked)) == ([], 1)


async def test_begun_again_it_sends_all_again_and_only_once(line):
    await line.put(row(1))
    line.delivery.begin()
    await rest()
    first = line.delivery._work
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(1, "SetPosEnd")] * 2
    assert first.cancelled()
    await line.put(row(2))
    assert line.connection.sent[2:] == [(2, "SetPosEnd")]


async def test_begun_later_it_sends_all_again_after_a_pause(line, monkeypatch):
    monkeypatch.setattr(delivery, "RETRY_AFTER", 0.02)
    await line.put(row(1))
    line.delivery.begin()
    await rest()
    first = line.delivery._work
    line.delivery.begin_later()
    await rest()
    assert first.cancelled() and line.connection.sent == [(1, "SetPosEnd")]
    async with asyncio.timeout(BUSY * 5):
        while len(line.connection.sent) < 2:
            await asyncio.sleep(0.001)
    assert line.connection.sent == [(1, "SetPosEnd")] * 2


async def test_ended_it_sends_nothing_more(line):
    line.delivery.end()
    line.delivery.begin()
    await rest()
    line.delivery.end()
    await line.put(row(1))
    assert line.connection.sent == []


async def test_a_stop_is_written_before_the_loop_has_another_turn():
    line = Line()
    line.delivery.stop_now("emergency-stop-0001")
    assert line.connection.sent == [("emergency-stop-0001", "Abort")]
    await rest()
    assert len(line.connection.sent) == 1


async def test_a_stop_does_not_wait_for_the_rest_of_a_long_message(line):
    line.connection.is_sending = line.connection.is_slow = True
    line.delivery.stop_now("emergency-stop-0001")
    await rest()
    assert line.connection.overtaken == 0
    assert line.connection.sent == [("emergency-stop-0001", "Abort")]


async def test_an_abort_waits_for_no_turn_among_messages_of_other_robots(line):
    channel = SharedChannel(line.connection)
    line.delivery = Delivery(line.fleet, channel, "r1")
    await line.put(row(1, "Abort", "{}"), row(2))
    line.delivery.begin()
    await rest()
    assert line.connection.sent == [(1, "Abort")] and channel.asked == [(True, False), (False, False)]


@pytest.mark.parametrize("how", ["a message is being sent", "it fails"])
async def test_a_stop_that_cannot_be_written_at_once_is_sent_as_soon_as_can_be(how, monkeypatch, caplog):
    line = Line()
    line.connection.is_sending = how == "a message is being sent"
    if how == "it fails":
        monkeypatch.setattr(line.connection, "write_at_once", lambda _frame: 1 / 0)
    line.delivery.stop_now("emergency-stop-0001")
    assert line.connection.sent == []
    await rest()
    assert line.connection.sent == [("emergency-stop-0001", "Abort")]
    assert ("stopping robot 'r1' at once failed" in caplog.text) is (how == "it fails")
