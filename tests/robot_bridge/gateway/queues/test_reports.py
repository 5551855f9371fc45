"""What operators are told of queues and cones comes through JSON as it was."""

import json

import pytest

from robot_bridge.core.messages.base import to_json
from robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep, command_report
from robot_bridge.core.messages.queues import QueueState, QueueTask, TaskKind, TaskState, queue_report
from robot_bridge.core.messages.records import PlacementReport, placement_report
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.gateway.model import task_queue as queues

TASK = QueueTask("task-0001", 3.0, 4.0, 0.5, TaskKind.PLACE, [(0.0, 0.0), (3.0, 4.0)], "c1", "7", "row", "p1")
CURRENT = queues.QueuedTask(TASK, "Ada", 1.0, TaskState.CURRENT, 0, 1, 2, "command", 2.0, reason="again")
QUEUE = queues.Queue("r1", 3, QueueState.PAUSED, (CURRENT,), "paused by Ada", "Ada", 5.0)


def through_json(report):
    return json.loads(json.dumps(to_json(report)))


@pytest.mark.parametrize("paths", [False, True])
def test_a_queue_is_told_as_it_is(paths):
    done = queues.QueuedTask(TASK, "Ada", 1.0, TaskState.DONE, ended_at=6.0, deviation=0.1)
    report = queues.queue_report(QUEUE, RobotState.LOST, [done], paths=paths)
    assert queue_report(through_json(report)) == report
    assert (report.tasks[0].path, report.tasks[0].path_points) == (TASK.path if paths else None, 2)
    assert (report.tasks[0].attempts, report.ended[0].deviation) == (2, 0.1)


def test_what_a_newer_gateway_says_beside_is_passed_over():
    values = through_json(queues.queue_report(QUEUE, RobotState.FRESH))
    values["tasks"][0]["colour"] = values["colour"] = "red"
    assert queue_report(values) == queues.queue_report(QUEUE, RobotState.FRESH)


def test_a_placed_cone_and_where_a_robot_stood_are_told_as_they_are():
    placed = PlacementReport(1, "task-0001", "r1", 3.0, 4.0, 3.1, 4.0, 0.5, 0.1, 9.0, "command", cone="c1")
    assert placement_report(through_json(placed)) == placed
    steps = [CommandStep(CommandState.REACHED, 9.0, "gateway")]
    command = CommandReport(
        "command", "r1", "SetPosEnd", {}, "Ada", CommandState.REACHED, steps, 0.1, (3.1, 4.0, 0.5)
    )
    assert command_report(through_json(command)) == command
