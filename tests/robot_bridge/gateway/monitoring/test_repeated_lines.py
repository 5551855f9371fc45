"""A robot that is refused again and again: the first lines in full, then one a minute that counts."""

from __future__ import annotations

import logging

import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.logs import IN_FULL, MOST_KEYS, RepeatedLines

log = logging.getLogger("robot_bridge.test")
R1, R2 = ("link sql:", "robot", "'r1'", "SendPos"), ("link sql:", "robot", "'r2'", "SendPos")


@pytest.fixture
def clock():
    return ManualClock()


@pytest.fixture
def lines(clock):
    return RepeatedLines(clock)


def test_a_day_of_refusals_is_a_line_a_minute(lines, clock, caplog):
    for second in range(3600):
        for k in range(10):
            lines.warn(log, R1, f"link sql: request {10 * second + k} of robot 'r1': no")
        clock.advance(1.0)
        lines.summarise()
    assert len(caplog.messages) == IN_FULL + 60
    assert caplog.messages[0] == "link sql: request 0 of robot 'r1': no"
    assert caplog.messages[IN_FULL] == (
        "link sql: robot 'r1' SendPos: 595 more such lines in 60 s, the last: link sql: request 599 of "
        "robot 'r1': no"
    )
    assert caplog.messages[-1].startswith("link sql: robot 'r1' SendPos: 600 more such lines in 60 s")


def test_one_robot_does_not_hide_another(lines, caplog):
    for _ in range(100):
        lines.warn(log, R1, "no")
    lines.warn(log, R2, "nor you")
    assert caplog.messages == ["no"] * IN_FULL + ["nor you"]


def test_after_a_quiet_minute_lines_are_written_in_full_again(lines, clock, caplog):
    for _ in range(IN_FULL):
        lines.warn(log, R1, "no")
    clock.advance(61)
    lines.summarise()
    lines.warn(log, R1, "again")
    assert caplog.messages[-1] == "again"


def test_an_internal_error_is_in_the_log_with_all_of_it_and_then_counted(lines, caplog):
    told = []
    for _ in range(IN_FULL + 3):
        try:
            raise ValueError("odd")
        except ValueError:
            told.append(lines.note_unforeseen(log, R1, "robot 'r1'"))
    assert len(caplog.records) == IN_FULL
    assert all(record.exc_info for record in caplog.records)
    assert told[0].endswith("under this number") and told[-1].startswith("internal error, again")


def test_names_without_end_take_no_memory_without_end(lines):
    for k in range(MOST_KEYS + 100):
        lines.warn(logging.getLogger("robot_bridge.silent"), ("robot", str(k)), "no")
    assert len(lines._runs) == MOST_KEYS
