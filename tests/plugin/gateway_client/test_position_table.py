"""Positions as a table of numbers become the same sightings as positions in rows."""

from __future__ import annotations

import json

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.robot_states import (
    COLUMNS,
    SPARE_WORDS,
    STATES,
    UNSURE,
    RobotStates,
    RobotTable,
    table_from_frame,
    table_from_rows,
)
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.messages.positions import PositionForm
from fleet_supervisor.robot_bridge.core.messages.robots import SendPos
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from fleet_supervisor.robot_bridge.gateway.fleet.operator_updates import EVERYTHING, Snapshots
from fleet_supervisor.robot_bridge.gateway.model.robots import Robots


def gateway(number=3):
    robots = Robots()
    for k in range(number):
        robots.ready(f"r{k}", k, "sql", 100.0)
    robots.observe("r1", SendPos(1.25, 2.5, 0.5, 1.0, battery=0.5, status="docking"), "websocket", 101.0)
    robots.assign("r2", "target-7")
    return robots


def frames(robots):
    made = Snapshots(robots, ManualClock(wall=102.5))
    return [made.after(EVERYTHING, form=form).frame for form in (PositionForm.ROWS, PositionForm.COLUMNS)]


def test_who_may_be_elsewhere_is_known_from_rows_and_from_columns_until_it_is_believed():
    robots = gateway()
    robots.disbelieve("r1", "websocket", 102.0, "it leapt")
    for form, frame in zip(("rows", "columns"), frames(robots), strict=True):
        states = RobotStates()
        table = (
            table_from_rows(json.loads(frame)["params"]["robots"], 7.0)
            if form == "rows"
            else table_from_frame(frame, 7.0)
        )
        states.merge(table)
        seen = states.arrays(7.0)
        row = states.row("r1")
        assert (seen.doubted.tolist().index(True), seen.doubted.sum(), states.doubts()) == (
            row,
            1,
            {row: "it leapt"},
        )
        assert seen.shown_as[row] == UNSURE and (seen.shown_as == seen.state).sum() == 2
        # Silent, it is as any other: nobody knows where it is.
        assert states.arrays(1000.0).shown_as.tolist() == [STATES.index(RobotState.LOST)] * 3
        view = states.view("r1", 7.0)
        assert (view.shown_as, view.report.doubt) == (UNSURE, "it leapt")
        # A robot that has a place says what it says itself in columns; rows say it to older desks as well.
        assert view.report.status == ("it leapt" if form == "rows" else "docking")
    robots.observe("r1", SendPos(1.5, 2.5, 0.5, 1.0), "websocket", 102.2)
    for frame in frames(robots)[1:]:
        states.merge(table_from_frame(frame, 8.0))
    assert states.doubts() == {} and not states.arrays(8.0).doubted.any()


def test_it_is_what_the_rows_are():
    rows, table = frames(gateway())
    by_row = table_from_rows(json.loads(rows)["params"]["robots"], 7.0)
    by_column = table_from_frame(table, 7.0)
    assert by_column.names == by_row.names == ["r0", "r1", "r2"]
    assert [by_column.row_values(row) for row in range(3)] == [by_row.row_values(row) for row in range(3)]
    assert by_column.report(1) == by_row.report(1)
    numbers = [name for name in COLUMNS if name not in ("link", "status", "command", "theta_from")]
    for name in numbers:
        np.testing.assert_array_equal(by_column.column(name), by_row.column(name))


def test_the_newer_form_replaces_the_older_of_the_same_robots():
    rows, _ = frames(gateway())
    known = table_from_rows(json.loads(rows)["params"]["robots"], 7.0)
    later = gateway()
    later.observe("r1", SendPos(9.0, 2.5, 0.5, 1.0, status="docked"), "sql", 102.0)
    known.merge(table_from_frame(frames(later)[1], 8.0))
    assert (known.row_values(1)["x"], known.row_values(1)["status"]) == (9.0, "docked")
    assert known.row_values(2)["command"] == "target-7"
    assert "battery" not in known.row_values(1)


def test_a_part_of_the_robots_changes_those_alone():
    robots = gateway()
    known = table_from_frame(frames(robots)[1], 7.0)
    seen = robots.revision
    robots.observe("r0", SendPos(3.0, 4.0, 0.0, 0.0, status="new"), "sql", 102.0)
    part = Snapshots(robots, ManualClock(wall=102.5)).after(seen, form=PositionForm.COLUMNS).frame
    known.merge(table_from_frame(part, 8.0))
    assert known.names == ["r0", "r1", "r2"]
    assert [known.row_values(row).get("status") for row in range(3)] == ["new", "docking", None]
    assert known.row_values(1)["x"] == 1.25


def test_messages_of_the_same_robots_share_one_list_of_names_that_newcomers_leave_as_it_is():
    mailbox, known, robots = UpdateBuffer(), RobotTable(), gateway()

    def receive(seen=EVERYTHING):
        made = Snapshots(robots, ManualClock(wall=102.5)).after(seen, form=PositionForm.COLUMNS).frame
        mailbox.add(robots=table_from_frame(made, 7.0))
        table = mailbox.collect().robots
        known.merge(table)
        return table.names

    first = receive()
    assert receive() is first and known.names is first
    seen = robots.revision
    robots.ready("r3", 3, "sql", 102.0)
    assert receive(seen) == ["r3"]
    assert first == ["r0", "r1", "r2"] and known.names == [*first, "r3"]
    robots.observe("r3", SendPos(8.0, 2.5, 0.5, 1.0), "sql", 102.0)
    assert receive() is not first
    assert known.row_values(3)["x"] == 8.0


def test_the_words_of_a_day_do_not_pile_up():
    mailbox = UpdateBuffer()
    known, robots = RobotTable(), gateway()
    made = Snapshots(robots, ManualClock(wall=102.5))
    for minute in range(SPARE_WORDS + 99):
        robots.assign("r2", f"target-{minute}")
        frame = made.after(EVERYTHING, form=PositionForm.COLUMNS).frame
        mailbox.add(robots=table_from_frame(frame, float(minute)))
        known.merge(mailbox.collect().robots)
        assert len(known._words) <= SPARE_WORDS + 6
    assert known.row_values(2)["command"] == f"target-{SPARE_WORDS + 98}"
    assert known.row_values(1)["status"] == "docking"


def head_of(table):
    begin = 4 + int.from_bytes(table[:4], "little")
    return json.loads(table[4:begin]), table[begin:]


def with_head(head, rest):
    text = json.dumps(head).encode()
    text = text.ljust(-(-(4 + len(text)) // 8) * 8 - 4)
    return len(text).to_bytes(4, "little") + text + rest


@pytest.mark.parametrize(
    "change",
    [
        {"robots": ["r0", "r1", "r1"]},
        {"robots": ["r0", "r1"]},
        {"robots": ["r0", "r1", 2]},
        {"words": ["fresh"]},
        {"words": ["sunny", "sql", "websocket", "docking", "target-7"]},
        {"words": []},
        {"columns": []},
        {"columns": None},
    ],
)
def test_a_head_that_cannot_be_is_refused(change):
    head, rest = head_of(frames(gateway())[1])
    head["params"].update(change)
    with pytest.raises((ValueError, KeyError)):
        table_from_frame(with_head(head, rest), 0.0)


@pytest.mark.parametrize(
    ("column", "value"),
    [("x", np.inf), ("age", np.nan), ("state", np.nan), ("state", 5.0), ("status", -1.0), ("link", 0.5)],
)
def test_a_number_that_cannot_be_is_named_with_its_robot(column, value):
    head, rest = head_of(frames(gateway())[1])
    table = np.frombuffer(rest).reshape(-1, 3).copy()
    table[head["params"]["columns"].index(column), 1] = value
    with pytest.raises(ValueError, match=f"{column} of robot r1"):
        table_from_frame(with_head(head, table.tobytes()), 0.0)


@pytest.mark.parametrize("frame", [b"", b"\0\0", b"\xff" * 40, b"\4\0\0\0null", b"\2\0\0\0{}"])
def test_other_binary_frames_are_refused(frame):
    with pytest.raises((ValueError, KeyError)):
        table_from_frame(frame, 0.0)
