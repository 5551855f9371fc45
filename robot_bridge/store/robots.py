"""The robots as they were last known."""

from __future__ import annotations

import json
from collections.abc import Sequence, Set

import msgspec
from sqlalchemy import Connection, delete, func, select

from ..messages import SendPos
from ..robots import Robot
from .rows import Row, put_rows
from .schema import robots

_ENCODER = msgspec.json.Encoder()

NAMES = ("name", "magic", "link", "received_at", "ended_in_order", "pose", "pose_at")


def row(robot: Robot) -> Row:
    """Return what is stored of a robot as it is now."""
    pose = None if robot.pose is None else _ENCODER.encode(robot.pose).decode()
    ended = int(robot.ended_in_order)
    return robot.name, robot.magic, robot.link, robot.received_at, ended, pose, robot.pose_at


def save(connection: Connection, rows: Sequence[Row]) -> None:
    """Write what is known of robots, in place of what was."""
    put_rows(connection, robots, NAMES, rows)


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


def names(connection: Connection) -> list[str]:
    """Return the names of the robots that an earlier gateway knew, sorted."""
    return sorted(connection.scalars(select(robots.c.name)))


def missing(connection: Connection, stored: Set[str]) -> set[str]:
    """Return those of the robots ``stored`` that are not there any more."""
    # Asked every second, and the answer nearly always: none.
    if connection.scalar(select(func.count()).select_from(robots)) == len(stored):
        return set()
    return set(stored).difference(names(connection))


def forget(connection: Connection, name: str) -> bool:
    """Know a robot no more; return whether it was known."""
    return connection.execute(delete(robots).where(robots.c.name == name)).rowcount > 0
