"""The robots as they were last known, and which gateway may write what concerns them."""

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
from ..rows import Row, is_one_of, put_rows, readable
from ..schema import robots
from . import requests

_ENCODER = msgspec.json.Encoder()

LONGEST_POSE = 16_000
"""characters; a longer one has a status that its column does not hold everywhere, and is stored without."""
_COUNT = select(func.count()).select_from(robots)
_HEARD_SINCE = 2
"""In place of 1 in ``ended_in_order``: the robot has said more since it said Stopped."""
NAMES = ("name", "magic", "link", "received_at", "ended_in_order", "pose", "pose_at", "paths", "abilities")


def row(robot: Robot) -> Row:
    """Return what is stored of a robot as it is now."""
    pose = None if robot.pose is None else _ENCODER.encode(robot.pose).decode()
    if robot.pose is not None and pose is not None and len(pose) > LONGEST_POSE:
        pose = _ENCODER.encode(dataclasses.replace(robot.pose, status=None)).decode()
    ended = _HEARD_SINCE if robot.ended_in_order and robot.heard_since else int(robot.ended_in_order)
    seen = robot.link, robot.received_at, ended, pose, robot.pose_at
    return robot.name, robot.magic, *seen, robot.paths, robot.abilities


def save(connection: Connection, rows: Sequence[Row]) -> None:
    """Write what is known of robots, in place of what was."""
    put_rows(connection, robots, NAMES, rows)


def note_run(connection: Connection, robot: Robot, magic: int) -> bool:
    """Write that a robot starts again as ``magic``; return false where it is stored with that number already.

    Its pose stays as it is stored: positions that are earlier may wait to be stored still.
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
    """Return the robots that a gateway knew, or those of them that have one of ``names``."""
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
    """Return what a robot declared of paths; None if that cannot be read, until it says Ready again."""
    if text is None:
        return None
    return next(readable([text], _read_paths, lambda _text: f"what robot {robot} declared of paths"), None)


def _read_paths(text: str) -> PathDeclaration:
    declared: PathDeclaration = msgspec.convert(text, PathDeclaration)
    return declared


def _pose(robot: str, text: str | None) -> SendPos | None:
    """Return where a robot was; None if that cannot be read: it is a robot of the fleet all the same."""
    if not text:
        return None
    return next(readable([text], _read_pose, lambda _text: f"the place of robot {robot}"), None)


def _read_pose(text: str) -> SendPos:
    return SendPos(**decode_json(text))


def names(connection: Connection) -> list[str]:
    """Return the names of the robots that an earlier gateway knew, sorted."""
    return sorted(connection.scalars(select(robots.c.name)))


def missing(connection: Connection, stored: Set[str]) -> set[str]:
    """Return those of the robots ``stored`` that are not there any more."""
    # Asked every second, and the answer nearly always: none.
    if connection.scalar(_COUNT) == len(stored):
        return set()
    return set(stored).difference(names(connection))


def forget_all(connection: Connection, names: Sequence[str]) -> None:
    """Know these robots no more; the next that each of them reads is that it has to abort."""
    requests.add_answers(connection, [(name, Abort()) for name in names])
    for name in names:
        forget(connection, name)


def forget(connection: Connection, name: str) -> bool:
    """Know a robot no more; return whether it was known."""
    return connection.execute(delete(robots).where(robots.c.name == name)).rowcount > 0


# --- Fences: what concerns a robot is written by the gateway that has it, and by no other ---

CHECK_VALID_S = 2.0
"""seconds for which it counts that this gateway had a robot: what is sent to it later is checked again."""


class FencedError(StoreError):
    """Something of a robot was to be stored that another gateway has by now: nothing of it was."""


class OwnerFence(Protocol):
    """Tells which robots this gateway has. Those methods that take a connection are called in its thread."""

    def owns(self, robot: str) -> bool:
        """Return whether this gateway has the robot, for all that it knows."""

    def may_command(self, robot: str) -> bool:
        """Return whether the robot may be set in motion now: this gateway has it, and may trust that."""

    def check(self, connection: Connection, robots: Collection[str]) -> None:
        """Raise FencedError unless this gateway has all ``robots``, and does until the transaction ends."""

    def lost(self, connection: Connection, robots: Collection[str]) -> AbstractSet[str]:
        """Return those of ``robots`` that this gateway has not; the others stay its own until the commit."""

    def missing(self, connection: Connection, stored: AbstractSet[str]) -> set[str]:
        """Return those of its robots ``stored`` that somebody has removed from the database."""

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Have the gateway that has a robot do a request once this transaction is committed."""


class SoleFence:
    """The fence of a gateway that has its database alone: all robots are its own, and nothing is asked."""

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
        """Return those that are not stored any more."""
        return missing(connection, stored)

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Do nothing: there is no other gateway."""


SOLE_FENCE = SoleFence()
