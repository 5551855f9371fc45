"""The last known state of robots, and the fence of writes about them."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping, Sequence, Set
from collections.abc import Set as AbstractSet
from typing import Any, Protocol

import msgspec
from sqlalchemy import Connection, delete, func, select, update

from ....core.errors import StoreError
from ....core.json_decoder import decode_json
from ....core.messages.base import DeskRequest
from ....core.messages.robots import Abort, SendPos
from ....core.messages.safety import PathDeclaration
from ...model.robots import Robot
from ..rows import Row, is_one_of, readable, upsert_rows
from ..schema import robots
from . import requests

_ENCODER = msgspec.json.Encoder()

LONGEST_POSE = 16_000
"""characters; a longer one has a status too long for the column of some databases, and is stored without
it."""
_COUNT = select(func.count()).select_from(robots)
_HEARD_SINCE = 2
"""In place of 1 in ``ended_in_order``: the robot has sent more since its Stopped."""
NAMES = ("name", "magic", "link", "received_at", "ended_in_order", "pose", "pose_at", "paths", "abilities")


def row(robot: Robot) -> Row:
    """Return the row of a robot's present state."""
    pose = None if robot.pose is None else _ENCODER.encode(robot.pose).decode()
    if robot.pose is not None and pose is not None and len(pose) > LONGEST_POSE:
        pose = _ENCODER.encode(dataclasses.replace(robot.pose, status=None)).decode()
    ended = _HEARD_SINCE if robot.ended_in_order and robot.heard_since else int(robot.ended_in_order)
    seen = robot.link, robot.received_at, ended, pose, robot.pose_at
    return robot.name, robot.magic, *seen, robot.paths, robot.abilities


def save(connection: Connection, rows: Sequence[Row]) -> None:
    """Write the states of robots, replacing the old ones."""
    upsert_rows(connection, robots, NAMES, rows)


def note_run(connection: Connection, robot: Robot, magic: int) -> bool:
    """Record that a robot restarts as ``magic``; return false if it is stored with that number already.

    Its stored pose stays: earlier positions may still wait to be stored.
    """
    number = connection.scalar(select(robots.c.magic).where(robots.c.name == robot.name))
    if number == magic:
        return False
    if number is None:
        save(connection, [row(dataclasses.replace(robot, magic=magic, pose=None, pose_at=None))])
    else:
        connection.execute(update(robots).where(robots.c.name == robot.name).values(magic=magic))
    return True


def load(connection: Connection, names: Sequence[str] | None = None) -> list[Robot]:
    """Return the stored robots, or those of them with one of ``names``."""
    query = select(robots)
    if names is not None:
        query = query.where(is_one_of(connection, robots.c.name, names))
    return [_robot(row) for row in connection.execute(query).mappings()]


def _robot(row: Mapping[Any, Any]) -> Robot:
    pose = _pose(row["name"], row["pose"])
    return Robot(
        name=row["name"],
        magic=row["magic"],
        link=row["link"],
        received_at=row["received_at"],
        ended_in_order=bool(row["ended_in_order"]),
        heard_since=row["ended_in_order"] == _HEARD_SINCE,
        pose=pose,
        pose_at=None if pose is None else row["pose_at"],
        paths=_paths(row["name"], row["paths"]),
        abilities=row["abilities"],
    )


def _paths(robot: str, text: str | None) -> PathDeclaration | None:
    """Return a robot's path declaration; None if unreadable, until its next Ready."""
    if text is None:
        return None
    return next(readable([text], _read_paths, lambda _text: f"what robot {robot} declared of paths"), None)


def _read_paths(text: str) -> PathDeclaration:
    declared: PathDeclaration = msgspec.convert(text, PathDeclaration)
    return declared


def _pose(robot: str, text: str | None) -> SendPos | None:
    """Return a robot's stored pose; None if unreadable: it remains a robot of the fleet."""
    if not text:
        return None
    return next(readable([text], _read_pose, lambda _text: f"the place of robot {robot}"), None)


def _read_pose(text: str) -> SendPos:
    return SendPos(**decode_json(text))


def names(connection: Connection) -> list[str]:
    """Return the names of the robots that an earlier gateway knew, sorted."""
    return sorted(connection.scalars(select(robots.c.name)))


def missing(connection: Connection, stored: Set[str]) -> set[str]:
    """Return those of the robots ``stored`` that no longer exist."""
    # Called every second, and nearly always empty.
    if connection.scalar(_COUNT) == len(stored):
        return set()
    return set(stored).difference(names(connection))


def forget_all(connection: Connection, names: Sequence[str]) -> None:
    """Delete these robots; the next message that each of them reads is an Abort."""
    requests.add_answers(connection, [(name, Abort()) for name in names])
    for name in names:
        forget(connection, name)


def forget(connection: Connection, name: str) -> bool:
    """Delete a robot; return whether it was known."""
    return connection.execute(delete(robots).where(robots.c.name == name)).rowcount > 0


# --- Fences: data of a robot is written only by the gateway that owns it ---

CHECK_VALID_S = 2.0
"""seconds for which a check of ownership is valid: later messages to the robot are checked again."""


class FencedError(StoreError):
    """Data of a robot now owned by another gateway was to be stored: nothing was written."""


class OwnerFence(Protocol):
    """Checks which robots this gateway owns. Methods with a connection are called in its thread."""

    def owns(self, robot: str) -> bool:
        """Return whether this gateway owns the robot, as far as it knows."""

    def may_command(self, robot: str) -> bool:
        """Return whether the robot may be set in motion now: this gateway owns it, and may trust that."""

    def check(self, connection: Connection, robots: Collection[str]) -> None:
        """Raise FencedError unless this gateway owns all ``robots``, and will until the transaction ends."""

    def lost(self, connection: Connection, robots: Collection[str]) -> AbstractSet[str]:
        """Return those of ``robots`` not owned by this gateway; the others stay its own until the commit."""

    def missing(self, connection: Connection, stored: AbstractSet[str]) -> set[str]:
        """Return those of its robots ``stored`` that were removed from the database."""

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Have the owner of a robot do a request once this transaction is committed."""


class SoleFence:
    """The fence of a sole gateway on its database: all robots are its own, without any check."""

    def owns(self, robot: str) -> bool:
        """Return true."""
        return True

    def may_command(self, robot: str) -> bool:
        """Return true."""
        return True

    def check(self, connection: Connection, robots: Collection[str]) -> None:
        """Do nothing."""

    def lost(self, connection: Connection, robots: Collection[str]) -> AbstractSet[str]:
        """Return none of them."""
        return frozenset()

    def missing(self, connection: Connection, stored: AbstractSet[str]) -> set[str]:
        """Return those that are no longer stored."""
        return missing(connection, stored)

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Do nothing: there is no other gateway."""


SOLE_FENCE = SoleFence()
