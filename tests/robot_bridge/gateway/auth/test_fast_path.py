"""What may go past the queue, and what may not: nothing overtakes, and every message counts."""

from __future__ import annotations

import pytest
from websockets.frames import Frame, Opcode

from robot_bridge.gateway.auth.client_connection import FastPath, RateLimit

REQUEST = b"GET /robot HTTP/1.1\r\nHost: x\r\n\r\n"


def text(content):
    return Frame(Opcode.TEXT, content.encode()).serialize(mask=True)


class Taken(list):
    """A handler that takes what begins with "p"."""

    def __call__(self, message):
        if not message.startswith(b"p"):
            return False
        self.append(message.decode())
        return True


@pytest.fixture
def taken():
    return Taken()


@pytest.fixture
def short_cut(taken):
    way = FastPath()
    way.set_handler(taken)
    way.begin(REQUEST)
    return way


@pytest.fixture
def plenty():
    return RateLimit(1000.0, 1000.0)


def test_short_messages_are_taken_up_to_the_first_that_is_not(short_cut, taken, plenty):
    data = text("p1") + text("p2") + text("other") + text("p3")
    assert short_cut.handle_messages(data, plenty) == 2 * len(text("p1"))
    assert taken == ["p1", "p2"]


def test_nothing_overtakes_what_is_on_the_long_way(short_cut, taken, plenty):
    short_cut.on_the_long_way = 1
    assert short_cut.handle_messages(text("p1"), plenty) == 0
    short_cut.on_the_long_way = 0
    assert short_cut.handle_messages(text("p1"), plenty) == len(text("p1"))
    assert taken == ["p1"]


def test_nothing_is_taken_out_of_the_middle_of_a_frame(short_cut, taken, plenty):
    frame = Frame(Opcode.BINARY, b"x" * 30 + text("p1")).serialize(mask=False)
    head = len(frame) - len(text("p1"))
    short_cut.pass_over(frame[:head])
    assert short_cut.handle_messages(frame[head:], plenty) == 0
    short_cut.pass_over(frame[head:])
    assert short_cut.handle_messages(text("p2"), plenty) > 0
    assert taken == ["p2"]


def test_frames_behind_the_request_leave_no_short_cut(taken, plenty):
    way = FastPath()
    way.set_handler(taken)
    way.begin(REQUEST + text("a message whose edges nobody followed")[:9])
    assert way.handle_messages(text("p1"), plenty) == 0


def test_every_message_counts_once(short_cut, taken):
    bucket = RateLimit(1e-9, 3.0)
    data = text("p1") + text("other")
    assert short_cut.handle_messages(data, bucket) == len(text("p1"))
    assert [bucket.consume(), bucket.consume(), bucket.consume()] == [True, True, False]


def test_what_is_too_much_is_left_to_be_refused(short_cut, taken):
    bucket = RateLimit(1e-9, 2.0)
    data = b"".join(text(f"p{number}") for number in range(5))
    assert len(data) - short_cut.handle_messages(data, bucket) == 3 * len(text("p0"))
    assert taken == ["p0", "p1"]


def test_what_counts_as_no_message_is_handed_on_beyond_the_limit(taken):
    way, none = FastPath(), RateLimit(0.001, 0.5)
    way.set_handler(taken)
    way.begin(REQUEST)
    assert way.handle_messages(text("p1"), none) == 0
    assert taken == []
    way.set_handler(taken, counted=False)
    assert way.handle_messages(text("p1"), none) == len(text("p1"))
    assert taken == ["p1"]
