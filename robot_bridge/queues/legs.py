"""The commands that a task is driven by: its path first, then what is done at its end.

A path carries no cone (paper 1, table III: SetPath), so a cone's task with a path takes two commands.
"""

from __future__ import annotations

import math

from ..errors import RefusedError
from ..messages import QueueTask, SetPath, SetPosEnd, TaskKind
from ..polyline import Polyline

Offset = tuple[float, float]
"""Metres ahead of a robot and to its left where the cone that it puts down stands."""
Place = tuple[float, float]

CORRIDOR = 2.0
"""metres that a robot may stand off a path that it is sent along."""
_LEAST = 0.05
"""metres of path that are worth a command."""
_BRING = "drive it there, or give the task another path"


def legs(task: QueueTask, offset: Offset) -> list[SetPath | SetPosEnd]:
    """Return the commands of ``task`` in order; raises RefusedError where it cannot be driven."""
    if task.kind is TaskKind.DRIVE:
        if task.path is not None:
            return [SetPath(task.path, task.theta)]
        return [SetPosEnd(task.x, task.y, task.theta)]
    x, y = standing_place(task, offset)
    collect = True if task.kind is TaskKind.COLLECT else None
    end = SetPosEnd(x, y, task.theta, cone=task.kind is TaskKind.PLACE, collect=collect)
    path = _approach(task, math.hypot(*offset))
    return [end] if path is None else [SetPath(path), end]


def standing_place(task: QueueTask, offset: Offset) -> Place:
    """Return where the robot stands when the cone stands at the task's place; raises RefusedError."""
    if offset == (0.0, 0.0):
        return task.x, task.y
    if task.theta is None:
        raise RefusedError(
            f"task {task.task} has no theta, and on this site a cone stands {math.hypot(*offset):.2f} m off "
            "its robot (cones of site.toml): give the heading that the robot is to stand in"
        )
    ahead, left = _turned(offset, task.theta)
    return task.x - ahead, task.y - left


def cone_place(stood: tuple[float, float, float], offset: Offset) -> Place:
    """Return where the cone stands of a robot that stands at x, y, theta."""
    x, y, theta = stood
    ahead, left = _turned(offset, theta)
    return x + ahead, y + left


def path_left(path: SetPath, here: Place, driven: float, *, join: bool) -> SetPath:
    """Return what a robot that stands ``here`` has to drive of ``path``, of which it has driven some metres.

    With ``join`` it may go on from where it is beside it, else it has to stand at the beginning.

    :raises RefusedError: when the robot is too far off; how it gets there is for people to say.
    """
    away = math.dist(here, path.points[0])
    if away <= CORRIDOR and driven <= CORRIDOR:
        return path
    line = Polyline(path.points)
    if not join:
        raise RefusedError(f"the robot stands {away:.1f} m from where the path begins; {_BRING}")
    station, off = line.feet(*here)
    ahead = station >= driven - CORRIDOR
    near = ahead & (off <= CORRIDOR)
    if not near.any():
        away = min([math.dist(here, line.at(driven)), *off[ahead]])
        raise RefusedError(f"the robot stands {away:.1f} m off what is left of the path; {_BRING}")
    # Where a path passes a place twice the sooner one counts: nothing of it is left out.
    near &= station <= station[near].min() + 2 * CORRIDOR
    joint = float(station[near][off[near].argmin()])
    rest = [p for p, at in zip(path.points, line.stations, strict=True) if at > joint + _LEAST]
    return SetPath([here, *(rest or [line.end])], path.theta)


def to_the_end(task: QueueTask, offset: Offset, left: list[Place]) -> list[Place]:
    """Return what is ``left`` of the path that a robot was sent along for ``task``, up to the task's place.

    A cone's path was sent without its last metres.
    """
    short_by = 0.0 if task.kind is TaskKind.DRIVE else math.hypot(*offset)
    if short_by == 0:
        return left
    if task.path is None:
        # It was found by the gateway, to where the robot stands for the cone.
        return [*left, (task.x, task.y)]
    line = Polyline(task.path)
    tail = [point for point, at in zip(task.path, line.stations, strict=True) if at > line.length - short_by]
    return [*left, *(tail or [line.end])]


def _approach(task: QueueTask, short_by: float) -> list[Place] | None:
    """Return the path of a cone's task without its last metres, where the cone stands; None if none."""
    if task.path is None:
        return None
    if short_by == 0:
        return task.path
    line = Polyline(task.path)
    end = line.length - short_by
    if end <= _LEAST:
        return None
    kept = [point for point, at in zip(task.path, line.stations, strict=True) if at < end - _LEAST]
    return [*kept, line.at(end)]


def _turned(offset: Offset, theta: float) -> Place:
    ahead, left = offset
    cos, sin = math.cos(theta), math.sin(theta)
    return ahead * cos - left * sin, ahead * sin + left * cos
