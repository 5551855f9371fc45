"""Positions as a table of numbers say the same as positions in rows."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.messages.positions import (
    POSITION_FLAGS,
    POSITION_NUMBERS,
    POSITION_TEXTS,
    PositionForm,
    RobotReport,
)
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.fleet.operator_updates import reports_of, table_frame
from robot_bridge.gateway.model.robots import Robots

places = st.floats(-1e5, 1e5)
maybe = st.none() | places
poses = st.builds(
    SendPos,
    x=places,
    y=places,
    theta=places,
    v=st.floats(-100, 100),
    t=maybe,
    fix_t=maybe,
    altitude=st.none() | st.floats(-12_000, 100_000),
    battery=st.none() | st.floats(0, 1),
    accuracy=st.none() | st.floats(0, 100),
    status=st.none() | st.text(max_size=5),
    theta_from=st.sampled_from([None, "course", "unknown"]),
)
fleets = st.dictionaries(st.text(min_size=1, max_size=6), st.none() | poses, min_size=1, max_size=6)


def unpacked(data: bytes, value="<f8"):
    """Return the head's params and, of each robot, what is known, as the guide says that it is read."""
    begin = 4 + int.from_bytes(data[:4], "little")
    assert begin % 8 == 0
    head = json.loads(data[4:begin])
    assert (head["jsonrpc"], head["method"]) == ("2.0", "positions")
    params = head["params"]
    table = np.frombuffer(data, value, offset=begin).reshape(len(params["columns"]), len(params["robots"]))
    robots = {}
    for name, values in zip(params["robots"], table.T.tolist(), strict=True):
        told = dict(zip(params["columns"], values, strict=True))
        known = {column: value for column, value in told.items() if not math.isnan(value)}
        texts = {column: params["words"][int(known[column])] for column in POSITION_TEXTS if column in known}
        robots[name] = {**known, **texts}
    return params, robots


def fleet_of(poses):
    robots = Robots()
    for number, (name, pose) in enumerate(poses.items()):
        robots.ready(name, number, "sql" if number % 2 else "websocket", 10.0)
        if pose is not None:
            robots.observe(name, pose, "websocket", 10.0 + number)
        if number % 4 == 1:
            robots.disbelieve(name, "websocket", 10.0 + number, "it leapt")
        if number % 3 == 0:
            robots.assign(name, f"command-{number}")
            robots.measured(name, 0.0123456)
    return robots


@given(fleets, st.floats(10.0, 60.0))
def test_it_says_of_each_robot_what_the_rows_say(poses, now):
    robots = fleet_of(poses)
    _, found = unpacked(table_frame(1.0, robots.changed(-1), now))
    for report in reports_of(robots.changed(-1), now, RobotReport):
        told = {k: v for k, v in dataclasses.asdict(report).items() if v is not None and k != "robot"}
        told["state"] = told["state"].value
        if report.doubt is not None:
            # Rows say it to desks that do not know the field as well, in place of what the robot says.
            assert told["status"] == "it leapt"
            pose = robots.get(report.robot).pose
            told = {k: v for k, v in told.items() if k != "status"}
            told |= {} if pose is None or pose.status is None else {"status": pose.status}
        assert found[report.robot].keys() == told.keys()
        for name, value in told.items():
            expected = value if isinstance(value, str) else pytest.approx(float(value), abs=0.00051)
            assert found[report.robot][name] == expected


def test_its_columns_are_the_fields_of_a_report():
    fields = [field.name for field in dataclasses.fields(RobotReport)]
    assert sorted([*POSITION_NUMBERS, *POSITION_FLAGS, *POSITION_TEXTS, "robot"]) == sorted(fields)


def test_who_asks_for_no_view_is_told_nothing_of_views():
    params, _ = unpacked(table_frame(1.0, fleet_of({"a": None}).changed(-1), 12.0))
    assert list(params) == ["t", "robots", "columns", "words", "removed", "everything"]


def test_what_no_robot_has_said_takes_no_column():
    params, _ = unpacked(table_frame(1.0, fleet_of({"a": None}).changed(-1), 12.0))
    assert sorted(params["columns"]) == ["age", "command", "latency", "link", "state", "stopped"]


def test_a_place_keeps_every_digit():
    x = 640420.123456789 / 3
    _, found = unpacked(table_frame(1.0, fleet_of({"a": SendPos(x, -x, math.pi, 0.1)}).changed(-1), 12.0))
    assert (found["a"]["x"], found["a"]["y"], found["a"]["theta"]) == (x, -x, math.pi)


def test_in_the_form_places_state_and_place_are_told_in_half_as_many_bits():
    poses = {"a": SendPos(123.456, -7.5, 1.25, 0.4, battery=0.5)}
    fleet = fleet_of(poses)
    fleet.ready("b", 2, "sql", 10.0)
    robots = fleet.changed(-1)
    params, found = unpacked(table_frame(1.0, robots, 12.0, form=PositionForm.PLACES), "<f4")
    assert params["columns"] == ["state", "x", "y", "theta"]
    assert found["b"] == {"state": "fresh"}
    told = found["a"]
    assert (told["state"], told["y"], told["theta"]) == ("fresh", -7.5, 1.25)
    assert told["x"] == pytest.approx(123.456, abs=1e-5)


def test_in_the_form_places_a_robot_that_may_be_elsewhere_is_told_as_such():
    robots = fleet_of({"a": SendPos(1.0, 2.0, 0.0, 0.5, battery=0.5), "b": SendPos(1.0, 2.0, 0.0, 0.5)})
    params, found = unpacked(table_frame(1.0, robots.changed(-1), 12.0, form=PositionForm.PLACES), "<f4")
    assert params["columns"] == ["state", "x", "y", "theta", "doubt"]
    assert (found["b"]["doubt"], found["b"]["state"]) == ("it leapt", "fresh")
    assert "doubt" not in found["a"]
    robots.observe("b", SendPos(1.5, 2.0, 0.0, 0.5), "websocket", 12.0)
    params, _ = unpacked(table_frame(1.0, robots.changed(-1), 12.0, form=PositionForm.PLACES), "<f4")
    assert params["columns"] == ["state", "x", "y", "theta"]
