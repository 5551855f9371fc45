"""What robots saw, and what operators made of it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Connection, func, insert, select, update

from ..core.decoding import decode_json
from ..counting import counted
from ..errors import RefusedError
from ..messages import GetObservations, ObservationReport, ObservationState, SendImage, SetObject
from .ageing import beside_the_time, delete_oldest
from .rows import readable
from .schema import observations as table

_REPORTED = [
    *(column for column in table.c if column.name != "image"),
    func.length(table.c.image).label("image_bytes"),
]


class NewObservation(NamedTuple):
    """What a robot told; ``source`` tells it from everything else that the robot told."""

    robot: str
    source: str
    kind: str
    object: str
    x: float
    y: float
    details: Mapping[str, Any]
    seen_at: float | None
    received_at: float
    image: bytes | None = None
    media_type: str | None = None


def add(connection: Connection, told: NewObservation, most_pending: int) -> tuple[ObservationReport, bool]:
    """Store an observation, once; return its report and whether it is new.

    :raises RefusedError: when ``most_pending`` of the robot's wait already.
    """
    known = find_told(connection, told.robot, told.source)
    if known is None:
        _check_room(connection, told.robot, most_pending)
        values = {**told._asdict(), "details": json.dumps(told.details), "state": "pending"}
        key = connection.execute(insert(table).values(values)).inserted_primary_key
        assert key is not None
        return _one(connection, int(key[0])), True
    return known, False


def find_told(connection: Connection, robot: str, source: str) -> ObservationReport | None:
    """Return what a robot told under ``source``, None where that is not stored."""
    told = table.c.robot == robot, table.c.source == source
    found = connection.execute(select(*_REPORTED).where(*told)).mappings().one_or_none()
    return None if found is None else _report(found)


def find(connection: Connection, id: int) -> ObservationReport | None:
    """Return an observation by its id."""
    found = connection.execute(select(*_REPORTED).where(table.c.id == id)).mappings().one_or_none()
    return None if found is None else _report(found)


def newest(
    connection: Connection,
    wanted: GetObservations,
) -> list[ObservationReport]:
    """Return observations, newest first."""
    query = select(*_REPORTED).order_by(table.c.id.desc()).limit(wanted.limit)
    if wanted.state is not None:
        query = query.where(table.c.state == wanted.state.value)
    if wanted.robot is not None:
        query = query.where(table.c.robot == wanted.robot)
    if wanted.object is not None:
        query = query.where(table.c.object == wanted.object)
    if wanted.before is not None:
        query = query.where(table.c.id < wanted.before)
    return _reports(connection.execute(query).mappings())


def on_map(connection: Connection) -> list[ObservationReport]:
    """Return the accepted objects, oldest first."""
    accepted = table.c.state == ObservationState.ACCEPTED.value
    query = select(*_REPORTED).where(accepted, table.c.kind == SetObject.__name__).order_by(table.c.id)
    return _reports(connection.execute(query).mappings())


def image(connection: Connection, id: int) -> tuple[bytes, str] | None:
    """Return the image of an observation and its media type."""
    row = connection.execute(select(table.c.image, table.c.media_type).where(table.c.id == id)).one_or_none()
    return None if row is None or row[0] is None else (bytes(row[0]), row[1])


def review(
    connection: Connection,
    id: int,
    state: ObservationState,
    by: str,
    at: float,
    review: Mapping[str, Any],
) -> ObservationReport:
    """Write what an operator made of an observation."""
    values = {
        "state": state.value,
        "reviewed_by": by,
        "reviewed_at": at,
        "review": json.dumps({name: value for name, value in review.items() if value is not None}),
    }
    connection.execute(update(table).where(table.c.id == id).values(values))
    return _one(connection, id)


def forget_rejected(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` objects that were told and rejected before a time; return how many."""
    rejected = beside_the_time(table.c.state).in_([ObservationState.REJECTED.value])
    return _forget(connection, before, limit, table.c.kind == SetObject.__name__, rejected)


def forget_images(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` images that were told and reviewed before a time; return how many."""
    ends = [ObservationState.ACCEPTED.value, ObservationState.REJECTED.value]
    reviewed = beside_the_time(table.c.state).in_(ends)
    return _forget(connection, before, limit, table.c.kind == SendImage.__name__, reviewed)


def _forget(connection: Connection, before: float, limit: int, *only: ColumnElement[bool]) -> int:
    reviewed_too = table.c.reviewed_at < before
    return len(delete_oldest(connection, table.c.id, table.c.received_at, before, limit, *only, reviewed_too))


def _check_room(connection: Connection, robot: str, most_pending: int) -> None:
    pending = select(func.count()).where(table.c.robot == robot, table.c.state == "pending")
    if (waiting := connection.scalar(pending) or 0) >= most_pending:
        raise RefusedError(
            f"{counted(waiting, 'observation')} of robot {robot!r} to be reviewed, and no more may wait "
            "([observations] most_pending); try again when an operator has reviewed some"
        )


def _one(connection: Connection, id: int) -> ObservationReport:
    found = find(connection, id)
    assert found is not None
    return found


def _reports(rows: Iterable[Mapping[Any, Any]]) -> list[ObservationReport]:
    return list(readable(rows, _report, lambda row: f"observation {row['id']}"))


def _report(row: Mapping[Any, Any]) -> ObservationReport:
    told = decode_json(row["details"]) if row["details"] else {}
    review = decode_json(row["review"]) if row["review"] else {}
    return ObservationReport(
        observation=row["id"],
        robot=row["robot"],
        op=row["kind"],
        object=row["object"],
        x=row["x"],
        y=row["y"],
        received_at=row["received_at"],
        state=ObservationState(row["state"]),
        seen_at=row["seen_at"],
        label=told.get("label"),
        height=review.get("height", told.get("height")),
        radius=review.get("radius", told.get("radius")),
        media_type=row["media_type"],
        image_bytes=row["image_bytes"],
        semantics=review.get("semantics"),
        reason=review.get("reason"),
        reviewed_at=row["reviewed_at"],
        reviewed_by=row["reviewed_by"],
        doubts=told.get("doubts"),
    )
