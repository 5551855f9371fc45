"""The commands of a task: what is sent first, and from where on a path goes on."""

from __future__ import annotations

import math

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.queues import QueueTask, TaskKind
from robot_bridge.core.messages.robots import SetPath, SetPosEnd
from robot_bridge.gateway.queues.task_life import (
    commands_of_task,
    cone_place,
    remaining_task_path,
    standing_place,
)

LINE = [(0.0, 0.0), (10.0, 0.0), (20.0, 0.0)]
LOOP = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]
NOWHERE = (0.0, 0.0)


def task(kind="drive", end=(20.0, 0.0), **more):
    return QueueTask("task-0001", *end, kind=TaskKind(kind), **more)


@pytest.mark.parametrize(
    ("wanted", "commands"),
    [
        (task(theta=1.0), [SetPosEnd(20.0, 0.0, 1.0)]),
        (task(path=LINE, theta=1.0), [SetPath(LINE, 1.0)]),
        (task("place"), [SetPosEnd(20.0, 0.0, cone=True)]),
        (task("collect"), [SetPosEnd(20.0, 0.0, collect=True)]),
        (task("place", path=LINE), [SetPath(LINE), SetPosEnd(20.0, 0.0, cone=True)]),
    ],
)
def test_a_task_takes_these_commands(wanted, commands):
    assert commands_of_task(wanted, NOWHERE) == commands


def test_a_robot_whose_cones_stand_ahead_of_it_stops_short_of_them():
    path, end = commands_of_task(task("collect", path=LINE, theta=0.0), (0.5, 0.0))
    assert path.points == [(0.0, 0.0), (10.0, 0.0), (19.5, 0.0)]
    assert (end.x, end.y) == (19.5, 0.0)
    assert (
        len(
            commands_of_task(
                task("collect", end=(0.4, 0.0), path=[(0.0, 0.0), (0.4, 0.0)], theta=0.0), (0.5, 0.0)
            )
        )
        == 1
    )
    # What is only driven ends where it was drawn.
    assert commands_of_task(task(path=LINE), (0.5, 0.0)) == [SetPath(LINE)]


@pytest.mark.parametrize("theta", [0.0, 1.0, math.pi, -2.0])
def test_where_a_robot_stands_and_where_its_cone_does_belong_together(theta):
    x, y = standing_place(task("place", theta=theta), (0.6, -0.2))
    assert cone_place((x, y, theta), (0.6, -0.2)) == pytest.approx((20.0, 0.0))


def test_without_a_heading_nobody_knows_where_that_is():
    with pytest.raises(RefusedError, match=r"has no theta, and on this site a cone stands 0\.50 m off"):
        commands_of_task(task("place"), (0.5, 0.0))


def test_a_path_is_sent_whole_to_a_robot_at_its_beginning():
    assert remaining_task_path(SetPath(LINE), (0.5, 1.0), 0.0, join=False) == SetPath(LINE)


def test_what_is_left_goes_on_from_the_robot():
    assert remaining_task_path(SetPath(LINE, 0.5), (6.0, 0.5), 5.0, join=True) == SetPath(
        [(6.0, 0.5), *LINE[1:]], 0.5
    )
    assert remaining_task_path(SetPath(LINE), (20.0, 0.1), 19.0, join=True).points == [(20.0, 0.1), LINE[-1]]


def test_of_a_loop_nothing_is_left_out_that_was_not_driven():
    assert remaining_task_path(SetPath(LOOP), (0.0, 5.0), 34.0, join=True).points == [(0.0, 5.0), (0.0, 0.0)]
    assert remaining_task_path(SetPath(LOOP), (0.0, 0.0), 0.0, join=True) == SetPath(LOOP)
    # At the crossing of an eight the sooner passage counts.
    eight = [(0.0, 0.0), (20.0, 20.0), (20.0, 0.0), (0.0, 20.0)]
    assert remaining_task_path(SetPath(eight), (10.0, 10.0), 0.0, join=True).points == [
        (10.0, 10.0),
        *eight[1:],
    ]
    assert remaining_task_path(SetPath(eight), (10.0, 10.0), 45.0, join=True).points == [
        (10.0, 10.0),
        eight[-1],
    ]


@pytest.mark.parametrize(
    ("here", "driven", "join", "said"),
    [
        ((10.0, 0.0), 0.0, False, r"stands 10\.0 m from where the path begins"),
        ((10.0, 3.0), 0.0, True, r"stands 3\.0 m off what is left of the path"),
        ((0.0, 0.0), 15.0, True, r"stands 15\.0 m off what is left"),
    ],
)
def test_a_robot_that_is_not_on_its_path_is_sent_nowhere(here, driven, join, said):
    with pytest.raises(RefusedError, match=said):
        remaining_task_path(SetPath(LINE), here, driven, join=join)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"task": "short"}, "give an id of 8 to 64 characters"),
        ({"x": math.nan}, "x is nan"),
        ({"path": [(0.0, 0.0)]}, "path holds 1 points"),
        ({"path": [(0.0, 0.0), (1.0, 0.0)]}, "let the path end there"),
        ({"placement": 3}, "placement is for what is collected, not drive"),
        ({"cone": "x" * 129}, "give 1 to 128 printable characters"),
        ({"layout": ""}, "give 1 to 128 printable characters"),
    ],
)
def test_what_is_no_task_is_refused(wrong, said):
    with pytest.raises(MessageError, match=said):
        QueueTask(**{"task": "task-0001", "x": 20.0, "y": 0.0, **wrong})
