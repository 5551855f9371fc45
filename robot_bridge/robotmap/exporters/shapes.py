"""A robot map as geometries with attributes, for formats that people's programs read."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ..model import Obstacle, RobotMap, ShapeType
from .lines import Points, is_ring, lines_of, signed_area

Kind = Literal["Polygon", "MultiLineString", "LineString"]

_RINGS = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)


@dataclass(frozen=True, eq=False)
class Shape:
    """One geometry, metres in the site frame, and its attributes.

    ``parts`` are the rings of a polygon, the outer one first, or lines; each is (n, 2).
    """

    kind: Kind
    parts: tuple[Points, ...]
    attributes: dict[str, Any]


def obstacle_shapes(robot_map: RobotMap) -> list[Shape]:
    """Return a shape for each obstacle: a polygon where its segments close, else lines.

    A courtyard becomes a hole of the obstacle round it that has the same source; where there is none it
    remains a polygon of its own, marked ``courtyard``. Attributes: ``id``, ``shape_type`` and its name
    ``shape``, ``semantics``, ``height_m`` of the highest segment, ``outdoor`` (of all segments),
    ``segments``, ``courtyards`` (ids of those that are holes), ``courtyard``, ``source`` and ``ext``.
    """
    outer, courtyards, lines = _sorted_out(robot_map.obstacles)
    holes: dict[int, list[tuple[Points, Obstacle]]] = {}
    alone = []
    for ring, obstacle in courtyards:
        host = _host_of(ring, obstacle, outer)
        if host is None:
            alone.append((ring, obstacle))
        else:
            holes.setdefault(host, []).append((ring, obstacle))
    shapes = []
    for k, (ring, obstacle) in enumerate(outer):
        inner = holes.get(k, [])
        attributes = _attributes(obstacle, courtyards=[hole.id for _, hole in inner])
        shapes.append(Shape("Polygon", (ring, *(hole for hole, _ in inner)), attributes))
    shapes += [Shape("Polygon", (ring,), _attributes(o, courtyard=True)) for ring, o in alone]
    shapes += [Shape("MultiLineString", tuple(parts), _attributes(o)) for parts, o in lines]
    return shapes


def segment_shapes(robot_map: RobotMap) -> list[Shape]:
    """Return a line a→b for each segment, free space on its right.

    Attributes: ``obstacle`` (id), ``number`` from 1 within it, ``shape_type``, ``height_m``, ``outdoor``,
    ``semantics``, ``obstacle_semantics``, ``source`` and ``ext``.
    """
    return [
        Shape(
            "LineString",
            (np.array([obstacle.a[k], obstacle.b[k]]),),
            {
                "obstacle": obstacle.id,
                "number": k + 1,
                "shape_type": int(obstacle.shape_type),
                "height_m": float(obstacle.height[k]),
                "outdoor": bool(obstacle.outdoor[k]),
                "semantics": obstacle.segment_semantics[k],
                "obstacle_semantics": obstacle.semantics,
                "source": obstacle.ext.get("src", ""),
                "ext": dict(obstacle.segment_ext[k]) if obstacle.segment_ext else {},
            },
        )
        for obstacle in robot_map.obstacles
        for k in range(len(obstacle.a))
    ]


Ring = tuple[Points, Obstacle]


def _sorted_out(
    obstacles: Iterable[Obstacle],
) -> tuple[list[Ring], list[Ring], list[tuple[list[Points], Obstacle]]]:
    """Return outer rings, courtyards, and the lines of everything that does not close."""
    outer: list[Ring] = []
    courtyards: list[Ring] = []
    lines: list[tuple[list[Points], Obstacle]] = []
    for obstacle in obstacles:
        parts = lines_of(obstacle)
        if obstacle.shape_type not in _RINGS or not all(is_ring(part) for part in parts):
            lines += [(parts, obstacle)] if parts else []
            continue
        for part in parts:
            (outer if signed_area(part) > 0 else courtyards).append((part, obstacle))
    return outer, courtyards, lines


def _host_of(ring: Points, courtyard: Obstacle, outer: Sequence[Ring]) -> int | None:
    """Return the smallest outer ring of the same source that holds a courtyard."""
    identity = _identity(courtyard)
    around = [
        (signed_area(other), k)
        for k, (other, obstacle) in enumerate(outer)
        if _identity(obstacle) == identity and _holds(other, ring)
    ]
    return min(around)[1] if around else None


def _identity(obstacle: Obstacle) -> tuple[str, str]:
    return obstacle.semantics, obstacle.ext.get("src", "")


def _holds(outer: Points, ring: Points) -> bool:
    """Tell whether the middle of the ring's first side is in ``outer``: its corners may touch."""
    if (ring.min(axis=0) < outer.min(axis=0)).any() or (ring.max(axis=0) > outer.max(axis=0)).any():
        return False
    x, y = (ring[0] + ring[1]) / 2
    a, b = outer[:-1], outer[1:]
    across = (a[:, 1] > y) != (b[:, 1] > y)
    a, b = a[across], b[across]
    at = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return int((at > x).sum()) % 2 == 1


def _attributes(
    obstacle: Obstacle, courtyards: Sequence[int] = (), courtyard: bool = False
) -> dict[str, Any]:
    return {
        "id": obstacle.id,
        "shape_type": int(obstacle.shape_type),
        "shape": obstacle.shape_type.name.lower().replace("_", " "),
        "semantics": obstacle.semantics,
        "height_m": float(obstacle.height.max()),
        "outdoor": bool(obstacle.outdoor.all()),
        "segments": len(obstacle.a),
        "courtyards": list(courtyards),
        "courtyard": courtyard,
        "source": obstacle.ext.get("src", ""),
        "ext": dict(obstacle.ext),
    }
