"""Cones that robots put down: planned and as placed, and when they were collected again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Connection, insert, select, update

from ..messages import GetPlacements, PlacementReport
from .ageing import delete_oldest
from .schema import placements


class NewPlacement(NamedTuple):
    """A cone that was put down; as :class:`~..messages.PlacementReport`, before it has an id."""

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


class Collected(NamedTuple):
    """A cone that was picked up: which placement, or (None) the cone of that id in that layout."""

    robot: str
    at: float
    placement: int | None = None
    cone: str | None = None
    layout: str | None = None


def add(connection: Connection, new: NewPlacement) -> PlacementReport:
    """Write a cone that was put down; return it with its id."""
    key = connection.execute(insert(placements), new._asdict()).inserted_primary_key
    assert key is not None
    return PlacementReport(placement=int(key[0]), **new._asdict())


def collect(connection: Connection, collected: Collected) -> PlacementReport | None:
    """Note that a cone was picked up; None when it is not known to stand."""
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
    return _report({**row, **values})


def newest(connection: Connection, wanted: GetPlacements) -> list[PlacementReport]:
    """Return placed cones, newest first."""
    query = select(placements).where(*_conditions(wanted)).order_by(placements.c.id.desc())
    return [_report(row) for row in connection.execute(query.limit(wanted.limit)).mappings()]


def has_any(connection: Connection, kind: str, name: str) -> bool:
    """Tell whether a cone is stored of the layout, plan or robot ``name``; ``kind`` says which that is."""
    c = placements.c
    return connection.scalar(select(c.id).where(c[kind] == name).limit(1)) is not None


def names(connection: Connection, kind: str) -> list[str]:
    """Return the layouts, plans or robots, as ``kind`` says, of which cones are stored, sorted."""
    column = placements.c[kind]
    return sorted(connection.scalars(select(column).where(column.is_not(None)).distinct()))


def standing(connection: Connection, layout: str | None) -> list[PlacementReport]:
    """Return the cones of a layout, or of all, that were not collected, in the order they were put down."""
    query = select(placements).where(placements.c.collected_at.is_(None))
    if layout is not None:
        query = query.where(placements.c.layout == layout)
    return [_report(row) for row in connection.execute(query.order_by(placements.c.id)).mappings()]


def standing_ids(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Return those of some placements that were not collected."""
    c = placements.c
    return set(connection.scalars(select(c.id).where(c.id.in_(ids), c.collected_at.is_(None))))


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` cones that were collected before a time; return how many."""
    return len(delete_oldest(connection, placements.c.id, placements.c.collected_at, before, limit))


def _conditions(wanted: GetPlacements) -> Iterator[ColumnElement[bool]]:
    c = placements.c
    for name in ("layout", "plan", "cone", "robot"):
        value = getattr(wanted, name)
        if value is not None:
            yield c[name] == value
    if wanted.since is not None:
        yield c.placed_at >= wanted.since
    if wanted.until is not None:
        yield c.placed_at <= wanted.until
    if wanted.collected is not None:
        yield c.collected_at.is_not(None) if wanted.collected else c.collected_at.is_(None)
    if wanted.before is not None:
        yield c.id < wanted.before


def _report(row: Any) -> PlacementReport:
    values = dict(row)
    return PlacementReport(placement=values.pop("id"), **values)
