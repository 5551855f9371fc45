"""What the gateway tells of robots, taken apart into columns, and how far it can be trusted."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.robot_states import (
    STATES,
    RobotStates,
    RobotTable,
    table_from_rows,
)
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from fleet_supervisor.robot_bridge.gateway.model.robots import liveness
from hypothesis import given
from hypothesis import strategies as st


def told(robot="r1", **more):
    return {"robot": robot, "state": "fresh", "age": 0.5, "link": "sql", "x": 1.0, "y": 2.0, **more}


def test_a_message_becomes_columns_and_what_was_not_said_is_nan():
    made = table_from_rows([told(v=1.5), told("r2", x=None, y=None, accuracy=0.3)], 7.0)
    assert made.names == ["r1", "r2"]
    np.testing.assert_array_equal(made.column("x"), [1.0, np.nan])
    np.testing.assert_array_equal(made.column("v"), [1.5, np.nan])
    np.testing.assert_array_equal(made.column("accuracy"), [np.nan, 0.3])
    assert made.column("received").tolist() == [7.0, 7.0]
    assert made.report(0).v == 1.5
    assert made.report(1).x is None


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), "3", True, [1], 10**400])
def test_a_number_that_is_none_is_named_with_its_robot(bad):
    with pytest.raises(ValueError, match="theta of robot r2 is"):
        table_from_rows([told(), told("r2", theta=bad)], 0.0)


@pytest.mark.parametrize("missing", ["robot", "state", "age", "link"])
def test_what_every_report_has_may_not_be_missing(missing):
    values = told()
    del values[missing]
    with pytest.raises((KeyError, ValueError)):
        table_from_rows([values], 0.0)


def test_a_robot_that_is_told_twice_counts_as_told_last():
    made = table_from_rows([told(x=1.0), told("r2"), told(x=9.0)], 0.0)
    assert made.names == ["r1", "r2"]
    assert made.column("x")[0] == 9.0
    assert made.report(0).x == 9.0


reports = st.lists(
    st.tuples(st.sampled_from(["a", "b", "c", "d"]), st.floats(-9, 9), st.integers(0, 5)), max_size=30
)


@given(st.lists(reports, max_size=6))
def test_merging_messages_keeps_of_each_robot_what_arrived_last(messages):
    known: dict[str, tuple[int, float]] = {}
    table = RobotTable()
    for message in messages:
        arrived = message[0][2] if message else 0
        table.merge(table_from_rows([told(name, x=x) for name, x, _ in message], float(arrived)))
        for name, x in {name: x for name, x, _ in message}.items():
            if name not in known or arrived >= known[name][0]:
                known[name] = (arrived, x)
    found = {name: table.column("x")[row] for row, name in enumerate(table.names)}
    assert found == {name: x for name, (_, x) in known.items()}
    assert {name: table.report(table.row(name)).x for name in known} == found


def test_a_robot_keeps_its_row():
    picture = RobotStates()
    picture.merge(table_from_rows([told("b"), told("a")], 0.0))
    picture.merge(table_from_rows([told("a", x=5.0)], 1.0))
    picture.merge(table_from_rows([told("c"), told("b", x=7.0)], 2.0))
    arrays = picture.arrays(2.0)
    assert arrays.names == ["b", "a", "c"]
    assert arrays.xy[:, 0].tolist() == [7.0, 5.0, 1.0]
    assert [picture.row(name) for name in "bac"] == [0, 1, 2]


def test_words_that_are_told_in_another_order_stay_what_they_are():
    table = RobotTable()
    table.merge(table_from_rows([told("a", status="driving", link="sql"), told("b", status="docked")], 0.0))
    table.merge(
        table_from_rows(
            [told("a", link="websocket"), told("b", status="driving"), told("c", status="new")], 1.0
        )
    )
    assert [table.row_values(row).get("status") for row in range(3)] == [None, "driving", "new"]
    assert [table.row_values(row)["link"] for row in range(3)] == ["websocket", "sql", "sql"]


def test_the_names_are_the_same_list_until_there_are_more_of_them():
    picture = RobotStates()
    picture.merge(table_from_rows([told("a"), told("b")], 0.0))
    names = picture.arrays(0.0).names
    picture.merge(table_from_rows([told("b", x=2.0)], 1.0))
    assert picture.arrays(1.0).names is names
    picture.merge(table_from_rows([told("c")], 2.0))
    assert (names, picture.arrays(2.0).names) == (["a", "b"], ["a", "b", "c"])
    picture.clear()
    picture.merge(table_from_rows([told("x"), told("y"), told("z")], 3.0))
    assert picture.arrays(3.0).names == ["x", "y", "z"]
    assert picture.arrays(3.0, slice(1, 2)).names == ["y"]


def test_after_another_site_nothing_is_known_of_robots_before():
    picture = RobotStates()
    picture.merge(table_from_rows([told("a")], 0.0))
    picture.clear()
    assert len(picture) == 0
    picture.merge(table_from_rows([told("b")], 0.0))
    assert [view.name for view in picture.views(0.0)] == ["b"]


def eighths(least, most):
    """Seconds whose sums are exact."""
    return st.integers(8 * least, 8 * most).map(lambda number: number / 8)


@given(
    eighths(0, 30),
    st.booleans(),
    st.sampled_from(list(RobotState)),
    eighths(1, 5),
    eighths(1, 10),
    eighths(0, 20),
)
def test_columns_age_as_liveness_says_for_one_robot(age, stopped, state, stale_after, more, later):
    lost_after = stale_after + more
    picture = RobotStates(stale_after, lost_after)
    picture.merge(table_from_rows([told(age=age, stopped=stopped, state=state.value)], 100.0))
    here = liveness(age + later, ended_in_order=False, stale_after=stale_after, lost_after=lost_after)
    expected = state if here is RobotState.FRESH or state in (RobotState.LOST, RobotState.OFFLINE) else here
    view = picture.view("r1", 100.0 + later)
    assert view.state is expected
    assert STATES[picture.arrays(100.0 + later).state[0]] is expected


def test_a_window_that_looks_seldom_finds_the_newest_of_every_robot():
    mailbox = UpdateBuffer()
    for second in range(5):
        mailbox.add(robots=table_from_rows([told(f"r{second % 2}", x=float(second))], float(second)))
    taken = mailbox.collect().robots
    assert {name: taken.report(row).x for row, name in enumerate(taken.names)} == {"r0": 4.0, "r1": 3.0}
    assert len(mailbox.collect().robots) == 0
