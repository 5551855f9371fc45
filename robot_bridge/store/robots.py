"""The robots as they were last known, and where they have been."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import NamedTuple

from sqlalchemy import Connection, delete, insert, select

from ..messages import SendPos, to_json
from ..robots import Robot
from .schema import robots, trajectories


class Fix(NamedTuple):
    """A pose of a robot at the gateway's time ``received_at``."""

    robot: str
    received_at: float
    pose: SendPos


def save(connection: Connection, known: Sequence[Robot]) -> None:
    """Write what is known of robots, in place of what was."""
    if not known:
        return
    connection.execute(delete(robots).where(robots.c.name.in_([robot.name for robot in known])))
    connection.execute(insert(robots), [_row(robot) for robot in known])


def load(connection: Connection) -> list[Robot]:
    """Return the robots that an earlier gateway knew."""
    return [
        Robot(
            name=row["name"],
            magic=row["magic"],
            link=row["link"],
            received_at=row["received_at"],
            ended_in_order=bool(row["ended_in_order"]),
            pose=SendPos(**json.loads(row["pose"])) if row["pose"] else None,
            pose_at=row["pose_at"],
        )
        for row in connection.execute(select(robots)).mappings()
    ]


def add_fixes(connection: Connection, fixes: Sequence[Fix]) -> None:
    """Write places where robots have been."""
    if not fixes:
        return
    rows = [
        {
            "robot": fix.robot,
            "received_at": fix.received_at,
            "x": fix.pose.x,
            "y": fix.pose.y,
            "theta": fix.pose.theta,
            "v": fix.pose.v,
            "device_time": fix.pose.t,
        }
        for fix in fixes
    ]
    connection.execute(insert(trajectories), rows)


def trajectory(connection: Connection, robot: str) -> list[tuple[float, float, float]]:
    """Return where the robot has been: gateway's time, x, y, oldest first."""
    query = select(trajectories.c.received_at, trajectories.c.x, trajectories.c.y)
    query = query.where(trajectories.c.robot == robot).order_by(trajectories.c.id)
    return [(at, x, y) for at, x, y in connection.execute(query)]


def _row(robot: Robot) -> dict[str, object]:
    return {
        "name": robot.name,
        "magic": robot.magic,
        "link": robot.link,
        "received_at": robot.received_at,
        "ended_in_order": int(robot.ended_in_order),
        "pose": None if robot.pose is None else json.dumps(to_json(robot.pose)),
        "pose_at": robot.pose_at,
    }
