"""Rows of observations and placed cones."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Connection, func, insert, select, text, update

from ....core.errors import RefusedError, counted
from ....core.json_decoder import decode_json
from ....core.messages.records import (
    GetObservations,
    GetPlacements,
    ObservationReport,
    ObservationState,
    PlacementReport,
)
from ....core.messages.robots import SendImage, SetObject
from ..rows import beside_the_time, delete_oldest, readable
from ..schema import observations as table
from ..schema import placements

# --- Observations of robots, and operators' reviews ---

_REPORTED = [
    *(column for column in table.c if column.name != "image"),
    func.length(table.c.image).label("image_bytes"),
]
# Every change of a row gives it another xmin, in whichever order transactions are committed.
_ON_MAP = text(
    "select count(*), coalesce(sum(id * cast(cast(xmin as text) as numeric)), 0) from observations "
    f"where state = :state and kind = '{SetObject.__name__}'"  # nosec B608 # names of ours
)
_NEWEST = text("select id, cast(xmin as text) from observations order by id desc limit :newest")


class ObservationChanges(NamedTuple):
    """Values that change whenever observations change.

    ``on_map`` covers all that are drawn, ``newest`` each of the newest by its id.
    """

    on_map: tuple[int, int]
    newest: dict[int, str]


class NewObservation(NamedTuple):
    """A reported observation; ``source`` distinguishes it from others of the robot."""

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


def add_observations(
    connection: Connection, observed: NewObservation, most_pending: int
) -> tuple[ObservationReport, bool]:
    """Store an observation, once; return its report and whether it is new.

    :raises RefusedError: when ``most_pending`` of the robot's already wait.
    """
    known = find_reported(connection, observed.robot, observed.source)
    if known is None:
        _check_room(connection, observed.robot, most_pending)
        values = {**observed._asdict(), "details": json.dumps(observed.details), "state": "pending"}
        key = connection.execute(insert(table).values(values)).inserted_primary_key
        assert key is not None
        return _one(connection, int(key[0])), True
    return known, False


def find_reported(connection: Connection, robot: str, source: str) -> ObservationReport | None:
    """Return a robot's observation ``source``, None if not stored."""
    conditions = table.c.robot == robot, table.c.source == source
    found = connection.execute(select(*_REPORTED).where(*conditions)).mappings().one_or_none()
    return None if found is None else _observation_report(found)


def find(connection: Connection, id: int) -> ObservationReport | None:
    """Return an observation by its id."""
    found = connection.execute(select(*_REPORTED).where(table.c.id == id)).mappings().one_or_none()
    return None if found is None else _observation_report(found)


def newest_observations(
    connection: Connection,
    request: GetObservations,
) -> list[ObservationReport]:
    """Return observations, newest first."""
    query = select(*_REPORTED).order_by(table.c.id.desc()).limit(request.limit)
    if request.state is not None:
        query = query.where(table.c.state == request.state.value)
    if request.robot is not None:
        query = query.where(table.c.robot == request.robot)
    if request.object is not None:
        query = query.where(table.c.object == request.object)
    if request.before is not None:
        query = query.where(table.c.id < request.before)
    return _reports(connection.execute(query).mappings())


def on_map(connection: Connection) -> list[ObservationReport]:
    """Return the accepted objects, oldest first."""
    accepted = table.c.state == ObservationState.ACCEPTED.value
    query = select(*_REPORTED).where(accepted, table.c.kind == SetObject.__name__).order_by(table.c.id)
    return _reports(connection.execute(query).mappings())


def changes(connection: Connection, newest: int) -> ObservationChanges:
    """Return values that change with the observations on the map and the ``newest`` ones; PostgreSQL only."""
    count, of_all = connection.execute(_ON_MAP, {"state": ObservationState.ACCEPTED.value}).one()
    rows = connection.execute(_NEWEST, {"newest": newest}).all()
    return ObservationChanges((int(count), int(of_all)), {int(id): str(version) for id, version in rows})


def find_each(connection: Connection, ids: Sequence[int]) -> list[ObservationReport]:
    """Return those of some observations that are stored, oldest first."""
    return _reports(
        connection.execute(select(*_REPORTED).where(table.c.id.in_(ids)).order_by(table.c.id)).mappings()
    )


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
    """Write an operator's review of an observation."""
    values = {
        "state": state.value,
        "reviewed_by": by,
        "reviewed_at": at,
        "review": json.dumps({name: value for name, value in review.items() if value is not None}),
    }
    connection.execute(update(table).where(table.c.id == id).values(values))
    return _one(connection, id)


def forget_rejected(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` objects reported and rejected before a time; return how many."""
    rejected = beside_the_time(table.c.state).in_([ObservationState.REJECTED.value])
    return _forget(connection, before, limit, table.c.kind == SetObject.__name__, rejected)


def forget_images(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` images reported and reviewed before a time; return how many."""
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
    return list(readable(rows, _observation_report, lambda row: f"observation {row['id']}"))


def _observation_report(row: Mapping[Any, Any]) -> ObservationReport:
    details = decode_json(row["details"]) if row["details"] else {}
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
        label=details.get("label"),
        height=review.get("height", details.get("height")),
        radius=review.get("radius", details.get("radius")),
        media_type=row["media_type"],
        image_bytes=row["image_bytes"],
        semantics=review.get("semantics"),
        reason=review.get("reason"),
        reviewed_at=row["reviewed_at"],
        reviewed_by=row["reviewed_by"],
        doubts=details.get("doubts"),
    )


# --- Placed cones: planned and actual places, and times of collection ---


_NEWEST_CONES = text(
    """
    (select id, cast(xmin as text) from placements order by id desc limit :newest)
    union
    (select id, cast(xmin as text) from placements where collected_at is not null
        order by collected_at desc limit :newest)
    """
)


class NewPlacement(NamedTuple):
    """A placed cone; as :class:`~....core.messages.records.PlacementReport`, before it has an id."""

    task: str
    robot: str
    command: str
    planned_x: float
    planned_y: float
    x: float
    y: float
    theta: float
    deviation: float
    placed_at: float
    cone: str | None = None
    label: str | None = None
    layout: str | None = None
    plan: str | None = None


class CollectedCone(NamedTuple):
    """A collected cone: its placement, or (None) the cone of that id in that layout."""

    robot: str
    at: float
    placement: int | None = None
    cone: str | None = None
    layout: str | None = None


def add_placed_cones(connection: Connection, new: NewPlacement) -> PlacementReport:
    """Write a placed cone; return it with its id."""
    key = connection.execute(insert(placements), new._asdict()).inserted_primary_key
    assert key is not None
    return PlacementReport(placement=int(key[0]), **new._asdict())


def collect(connection: Connection, collected: CollectedCone) -> PlacementReport | None:
    """Record that a cone was collected; return None when it is not known to stand."""
    c = placements.c
    query = select(placements).where(c.collected_at.is_(None))
    if collected.placement is not None:
        query = query.where(c.id == collected.placement)
    elif collected.cone is not None:
        query = query.where(c.cone == collected.cone, c.layout == collected.layout)
    else:
        return None
    row = connection.execute(query.order_by(c.id.desc()).limit(1)).mappings().first()
    if row is None:
        return None
    values = {"collected_at": collected.at, "collected_by": collected.robot}
    connection.execute(update(placements).where(c.id == row["id"]).values(values))
    return _placed_cones_report({**row, **values})


def newest_placed_cones(connection: Connection, request: GetPlacements) -> list[PlacementReport]:
    """Return placed cones, newest first."""
    query = select(placements).where(*_conditions(request)).order_by(placements.c.id.desc())
    return [_placed_cones_report(row) for row in connection.execute(query.limit(request.limit)).mappings()]


def placement_changes(connection: Connection, newest: int) -> dict[int, str]:
    """Return versions of the newest placed and the newest collected cones; PostgreSQL only."""
    rows = connection.execute(_NEWEST_CONES, {"newest": newest}).all()
    return {int(id): str(version) for id, version in rows}


def find_placements(connection: Connection, ids: Sequence[int]) -> list[PlacementReport]:
    """Return those of some placed cones that are stored, oldest first."""
    query = select(placements).where(placements.c.id.in_(ids)).order_by(placements.c.id)
    return [_placed_cones_report(row) for row in connection.execute(query).mappings()]


def has_any(connection: Connection, kind: str, name: str) -> bool:
    """Return whether a cone is stored of the layout, plan or robot ``name``; ``kind`` says which."""
    c = placements.c
    return connection.scalar(select(c.id).where(c[kind] == name).limit(1)) is not None


def names(connection: Connection, kind: str) -> list[str]:
    """Return the layouts, plans or robots, as ``kind`` says, of which cones are stored, sorted."""
    column = placements.c[kind]
    return sorted(connection.scalars(select(column).where(column.is_not(None)).distinct()))


def standing(connection: Connection, layout: str | None) -> list[PlacementReport]:
    """Return the cones of a layout, or of all, that were not collected, in the order of placement."""
    query = select(placements).where(placements.c.collected_at.is_(None))
    if layout is not None:
        query = query.where(placements.c.layout == layout)
    return [
        _placed_cones_report(row) for row in connection.execute(query.order_by(placements.c.id)).mappings()
    ]


def standing_ids(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Return those of some placements that were not collected."""
    c = placements.c
    return set(connection.scalars(select(c.id).where(c.id.in_(ids), c.collected_at.is_(None))))


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` cones that were collected before a time; return how many."""
    return len(delete_oldest(connection, placements.c.id, placements.c.collected_at, before, limit))


def _conditions(request: GetPlacements) -> Iterator[ColumnElement[bool]]:
    c = placements.c
    for name in ("layout", "plan", "cone", "robot"):
        value = getattr(request, name)
        if value is not None:
            yield c[name] == value
    if request.since is not None:
        yield c.placed_at >= request.since
    if request.until is not None:
        yield c.placed_at <= request.until
    if request.collected is not None:
        yield c.collected_at.is_not(None) if request.collected else c.collected_at.is_(None)
    if request.before is not None:
        yield c.id < request.before


def _placed_cones_report(row: Any) -> PlacementReport:
    values = dict(row)
    return PlacementReport(placement=values.pop("id"), **values)
