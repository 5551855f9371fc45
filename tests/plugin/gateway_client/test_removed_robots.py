"""A robot that was removed is gone from the desk: row, arrow, trail, layer, alarms; drafts for it, too."""

from __future__ import annotations

import time

import numpy as np
import pytest
from fleet_supervisor.plugin.control.messages import Level, robot_topic
from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.robot_states import RobotStates, table_from_frame, table_from_rows
from fleet_supervisor.plugin.map.overlay.trails import LENGTHS, Trails
from fleet_supervisor.plugin.panel.alarms.rules import PairHysteresis, RowHysteresis
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.core import QgsExpression

from robot_bridge.gateway.fleet.operator_updates import table_frame
from robot_bridge.gateway.model.robots import Robots

FRESH = {"state": "fresh", "age": 0.0, "link": "sql"}


def told(*names, received=0.0, **absent):
    return table_from_rows([{"robot": name, **FRESH} for name in names], received, absent)


def remove(gateway, *names, **params):
    """Tell the desks as a gateway does from whose database an administrator has taken robots."""
    for name in names:
        del gateway.robots[name]
    gateway.tell("positions", {"t": time.time(), "robots": [], "removed": list(names), **params})


def rows_of(window):
    model = window.dock.table.model()
    return [model.name_at(row) for row in range(model.rowCount())]


def layer_of(window):
    (layer,) = [one for one in window.desk.project.mapLayers().values() if one.name().endswith("(live)")]
    return sorted(feature["robot"] for feature in layer.getFeatures())


def test_its_queue_and_what_was_told_of_it_are_gone(at_desk, gateway, wait, iface):
    desk = at_desk.desk
    task = {"task": "t1", "kind": "place", "state": "waiting", "added_by": "anna", "added_at": 1.0}
    for robot in ("r1", "r2"):
        tasks = [{**task, "robot": robot, "x": 6.0, "y": 5.0}]
        queue = {"robot": robot, "revision": 1, "state": "paused", "robot_state": "lost", "tasks": tasks}
        gateway.tell("queue", queue)
        desk.messages.post(f"{robot} strays", Level.ERROR, robot_topic(robot))
    wait(lambda: len(list(desk.state.queues)) == 2, what="the queues")
    gateway.refuse["remove_task"] = "not now"
    at_desk.queue_edits.remove("r1", "t1")
    wait(lambda: any("not now" in text for text in iface.texts()), what="the refusal")
    remove(gateway, "r1")
    wait(lambda: len(desk.state.robots) == 1, what="the news")
    assert [queue.robot for queue in desk.state.queues] == ["r2"]
    wait(lambda: not any("not now" in text or "r1 strays" in text for text in iface.texts()))
    assert any("r2 strays" in text for text in iface.texts())


@pytest.mark.parametrize("removed", ["r1", "r2"])
def test_it_is_gone_from_table_map_layer_and_expressions(at_desk, gateway, wait, iface, removed):
    left = {"r1": "r2", "r2": "r1"}[removed]
    wait(lambda: layer_of(at_desk) == ["r1", "r2"], what="both robots in the layer")
    at_desk.desk.selection.select(removed)
    remove(gateway, removed)
    wait(lambda: len(at_desk.desk.state.robots) == 1, what="the news")
    assert rows_of(at_desk) == [left]
    assert layer_of(at_desk) == [left]
    assert at_desk.desk.selection.robots == ()
    assert QgsExpression(f"robot_state('{removed}')").evaluate() is None
    assert QgsExpression(f"robot_state('{left}')").evaluate() == "fresh"
    at = {"r1": iface.pixel(50, 40), "r2": iface.pixel(80, 60)}
    overlay = at_desk.view.overlay
    wait(lambda: overlay.robot_at(at[removed].x(), at[removed].y()) is None, what="the map without it")
    assert overlay.robot_at(at[left].x(), at[left].y()) == left


def test_a_draft_for_it_is_taken_away_and_that_is_said(at_desk, gateway, wait, iface):
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    assert at_desk.desk.drafts.draft is not None
    remove(gateway, "r1")
    wait(lambda: at_desk.desk.drafts.draft is None, what="the draft taken away")
    assert any("was not sent: robot r1 was removed." in text for text in iface.texts())


def test_a_draft_for_another_stays(at_desk, gateway, wait, iface):
    at_desk.desk.selection.select("r2")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    remove(gateway, "r1")
    wait(lambda: len(at_desk.desk.state.robots) == 1, what="the news")
    assert at_desk.desk.drafts.draft.robot == "r2"
    assert at_desk.desk.selection.robots == ("r2",)


def test_one_that_was_removed_while_the_link_was_away_is_gone_when_it_is_back(at_desk, gateway, wait):
    gateway.stop()
    wait(lambda: at_desk.desk.state.link.phase.value == "retrying", what="the loss of the link")
    del gateway.robots["r1"]
    gateway.start()
    wait(lambda: at_desk.desk.state.link.phase.value == "connected", 10, "the link")
    told = [to_json(robot) for robot in gateway.robots.values()]
    gateway.tell("positions", {"t": time.time(), "robots": told, "everything": True})
    wait(lambda: len(at_desk.desk.state.robots) == 1, what="the news")
    assert rows_of(at_desk) == ["r2"]


def test_rows_move_up_and_what_was_known_of_the_others_moves_with_them():
    picture = RobotStates()
    picture.merge(told("a", "b", "c", received=1.0))
    before = picture.arrangement, picture.by_name()
    gone = picture.merge(told("d", received=2.0, removed=["b", "x"]))
    assert (gone.names, gone.rows.tolist()) == ({"b"}, [1])
    assert picture.arrangement == before[0] + 1
    assert picture.arrays(2.0).names == ["a", "c", "d"]
    assert [picture.row(name) for name in "abcd"] == [0, None, 1, 2]
    assert picture.column("received").tolist() == [1.0, 1.0, 2.0]
    assert picture.by_name() == [0, 1, 2]


def test_those_that_report_again_do_so_in_the_rows_that_they_moved_to():
    picture = RobotStates()
    picture.merge(told("a", "b", "c", "d", received=1.0))
    picture.merge(told("b", "d", received=2.0))
    picture.merge(told("b", "d", received=3.0, removed=["a"]))
    assert picture.arrays(3.0).names == ["b", "c", "d"]
    assert picture.column("received").tolist() == [3.0, 1.0, 3.0]


def test_everything_takes_out_who_is_not_in_it():
    picture = RobotStates()
    picture.merge(told("a", "b", received=1.0))
    assert picture.merge(told("b", received=2.0, everything=True)).names == {"a"}
    assert picture.merge(told(received=3.0, everything=True)).names == {"b"}
    assert len(picture) == 0


@pytest.mark.parametrize(
    ("messages", "left"),
    [
        ([told("a"), told(removed=["a"])], {"b", "c"}),
        ([told(removed=["a"]), told("a")], {"a", "b", "c"}),
        ([told(removed=["a"]), told(removed=["b"])], {"c"}),
        ([told("a", everything=True), told("b")], {"a", "b"}),
        ([told("a", "b", everything=True), told(removed=["b"])], {"a"}),
        ([told(removed=["b"]), told("a", "b", everything=True)], {"a", "b"}),
    ],
)
def test_what_arrives_between_two_looks_counts_in_its_order(messages, left):
    picture, mailbox = RobotStates(), UpdateBuffer()
    picture.merge(told("a", "b", "c"))
    for message in messages:
        mailbox.add(robots=message)
    picture.merge(mailbox.collect().robots)
    assert set(picture.arrays(0.0).names) == left


def test_a_table_of_numbers_tells_it_too():
    robots = Robots()
    robots.ready("a", 1, "sql", 0.0)
    made = table_from_frame(table_frame(0.0, robots.changed(-1), 0.0, ["b"]), 0.0)
    assert (made.names, made.removed, made.everything) == (["a"], {"b"}, False)
    made = table_from_frame(table_frame(0.0, [], 0.0, everything=True), 0.0)
    assert (made.names, made.removed, made.everything) == ([], set(), True)


@pytest.mark.parametrize("wrong", [{"removed": "r1"}, {"removed": [1]}, {"everything": 1}])
def test_what_cannot_be_is_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        told("a", **wrong)


def test_trails_move_up_with_their_robots():
    trails = Trails()
    for second in range(10):
        trails.extend(np.array([[second, 0.0], [second, 1.0], [second, 2.0]], dtype=float), float(second))
    generation = trails.generation
    trails.drop(np.array([1]))
    assert len(trails) == 2 and trails.generation > generation
    assert [set(trails.of(row, 9.0)[:, 1].tolist()) for row in range(2)] == [{0.0}, {2.0}]
    trails.extend(np.array([[10.0, 0.0], [10.0, 2.0]]), 10.0)
    assert trails.of(1, 10.0)[-1].tolist() == [10.0, 2.0, 0.0]


def test_trails_that_grew_shorter_stay_so_until_all_are_forgotten():
    trails = Trails()
    trails.extend(np.zeros((LENGTHS[0].robots + 1, 2)), 0.0)
    assert trails.length == LENGTHS[1]
    trails.drop(np.array([0]))
    trails.extend(np.ones((LENGTHS[0].robots, 2)), 5.0)
    assert trails.length == LENGTHS[1]
    trails.clear()
    trails.extend(np.ones((1, 2)), 6.0)
    assert trails.length == LENGTHS[0]


def test_what_is_on_stays_on_for_the_others():
    rows, pairs = RowHysteresis(), PairHysteresis()
    rows.update(np.array([False, False, True]), np.array([True, True, False]), 0.0, 0.0, 0.0)
    rows.drop(np.array([0]))
    assert rows.on.tolist() == [False, True]
    one, other = np.array([0, 1, 2], dtype=np.int64), np.array([3, 2, 3], dtype=np.int64)
    pairs.update(one, other, np.zeros(3), 1.0)
    pairs.drop(np.array([1]))
    # Robots 0, 2 and 3 are 0, 1 and 2 now; their pairs are on already.
    assert pairs.update(np.array([0, 1]), np.array([2, 2]), np.zeros(2), 1.0) == ([], [])
    pairs.drop(np.array([0, 1, 2]))
    assert pairs.update(one[:0], other[:0], np.zeros(0), 1.0) == ([], [])
