"""Where robots were at a moment; no QGIS canvas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import STATES
from fleet_supervisor.plugin.replay.history import SILENT_AFTER, History
from fleet_supervisor.plugin.replay.replay_map import PIECE, line_pieces
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState

T0 = 1_790_000_000.0
FRESH, LOST = STATES.index(RobotState.FRESH), STATES.index(RobotState.LOST)


def place(robot, t, x, y=0.0, theta=0.0, v=1.0):
    return [robot, T0 + t, x, y, theta, v, None, None]


@pytest.fixture
def history():
    """r1 drives 10 m in 10 s and is silent for a minute; r2 begins later and turns across south."""
    made = History()
    made.add([place("r1", 0, 0.0), place("r2", 5, 50.0, theta=3.0), place("r1", 10, 10.0)])
    made.add([place("r2", 9, 50.0, theta=-3.0), place("r1", 70, 10.0, 5.0)])
    return made


def test_between_positions_robots_are_on_the_line(history):
    then = history.at(T0 + 4)
    assert then.names == ["r1", "r2"]
    assert then.xy[0].tolist() == [4.0, 0.0]
    assert then.state[0] == FRESH
    # r2 had not been heard of.
    assert np.isnan(then.xy[1]).all()


def test_a_heading_turns_the_short_way(history):
    theta = history.at(T0 + 7).theta[1]
    assert math.cos(theta) == pytest.approx(-1.0)


def test_after_a_silence_a_robot_is_lost_where_it_was_and_does_not_slide_on(history):
    soon = history.at(T0 + 12)
    assert (soon.xy[0].tolist(), soon.state[0]) == ([10.0, 0.0], FRESH)
    later = history.at(T0 + 10 + SILENT_AFTER + 1)
    assert (later.xy[0].tolist(), later.state[0], later.v[0]) == ([10.0, 0.0], LOST, 0.0)
    assert later.age[0] == SILENT_AFTER + 1
    assert history.at(T0 + 70).xy[0].tolist() == [10.0, 5.0]


def test_more_robots_than_16_bits_count_do_not_mix():
    made, many = History(), (1 << 16) + 1
    made.add([place(f"r{k}", 0, float(k)) for k in range(many)])
    assert made.at(T0).xy[[0, 1, -1], 0].tolist() == [0.0, 1.0, float(many - 1)]


def test_pages_in_any_number_give_the_same(history):
    whole, by_one = History(), History()
    rows = [place(f"r{k % 7}", k * 0.7, float(k), theta=k) for k in range(500)]
    whole.add(rows)
    for row in rows:
        by_one.add([row])
    for moment in (T0 - 1, T0, T0 + 33.3, T0 + 349.3, T0 + 400):
        assert np.array_equal(whole.at(moment).xy, by_one.at(moment).xy, equal_nan=True)


def test_no_position_is_held_twice(history):
    """A million of them, all that a replay may have, are 48 MB."""
    history.at(T0 + 4)
    held = {id(numbers): numbers.nbytes for numbers in (*history._pages, history._sorted)}
    assert sum(held.values()) == len(history) * 6 * 8


def test_pages_that_come_after_a_look_join_those_before():
    whole, looked_at = History(), History()
    pages = [[place(f"r{k % 3}", k, float(k)) for k in range(10 * n, 10 * n + 10)] for n in range(3)]
    for page in pages:
        whole.add(page)
        looked_at.add(page)
        looked_at.at(T0)
    assert looked_at.table.tolist() == whole.table.tolist()


def test_nothing_is_nowhere():
    assert History().at(T0).names == []
    assert History().extents.size == 0


@pytest.mark.parametrize("seconds", [-1.0, 0.0, 0.5, 7.0, 13.9, 14.0, 1000.0])
def test_of_many_robots_each_is_where_it_was_then(seconds):
    """Each is at x as many metres as seconds went by, from its first position to its last."""
    made, random = History(), np.random.default_rng(3)
    ways = {f"r{k}": random.choice(15, size=1 + k % 15, replace=False) for k in range(60)}
    rows = [place(name, at, float(at)) for name, times in ways.items() for at in times.tolist()]
    made.add(sorted(rows, key=lambda row: row[1]))
    then = made.at(T0 + seconds)
    for name, x in zip(then.names, then.xy[:, 0].tolist(), strict=True):
        known = seconds >= ways[name].min()
        assert x == pytest.approx(min(seconds, ways[name].max()) if known else math.nan, nan_ok=True)


def test_the_extent_of_each_robot_has_every_position_of_it_and_no_more(history):
    of_each = {
        name: history.table[history.table[:, 0] == row][:, 2:4] for row, name in enumerate(history.names)
    }
    assert history.extents.tolist() == [
        [at.min(axis=0).tolist(), at.max(axis=0).tolist()] for at in of_each.values()
    ]
    history.add([place("r2", 80, -3.0, 7.0), place("r9", 81, 2.0, 4.0)])
    least, greatest = history.extents[history.names.index("r2")].tolist()
    assert least[0] == -3.0 and greatest[1] == 7.0
    assert history.extents[history.names.index("r9")].tolist() == [[2.0, 4.0], [2.0, 4.0]]


@pytest.mark.parametrize("row", [["r1", T0], ["r1", None, 0, 0, 0, 0], ["r1", T0, math.nan, 0, 0, 0]])
def test_what_is_no_position_is_refused(row):
    with pytest.raises(ValueError, match="stored position"):
        History().add([row])


def test_lines_are_short_and_joined_and_end_at_silences():
    times = np.array([*np.arange(0, 20, 1.0), 100.0, 101.0, 0.0, 3.0])
    robots = np.array([0] * 22 + [1] * 2)
    found = line_pieces(robots, times, PIECE)
    spans = [(times[piece[0]], times[piece[-1]]) for piece in found]
    assert spans == [(0, 5), (5, 10), (10, 15), (15, 19), (100, 101), (0, 3)]
    assert max(end - begin for begin, end in spans) <= PIECE
