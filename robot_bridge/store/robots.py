"""The robots as they were last known."""

from __future__ import annotations

import json
from collections.abc import Sequence

from sqlalchemy import Connection, delete, insert, select

from ..messages import SendPos, to_json
from ..robots import Robot
from .schema import robots


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
