"""What robots saw and operators accepted: new objects on the maps, and what is not there any more off."""

from __future__ import annotations

import dataclasses
import logging
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .messages import ObservationReport
from .robotmap.group_texts import GroupText
from .robotmap.index import OutlineIndex
from .robotmap.model import Border, Obstacle, RobotMap, ShapeType
from .robotmap.outlines import OutlineRow, Outlines
from .robotmap.templates import template
from .robotmap.text import write_obstacles
from .robotmap.window import Window

log = logging.getLogger(__name__)

FIRST_ID = 1_000_000_000
"""Obstacles from here on were seen by robots; those of the site's own layers are below."""
_IDS_EACH = 8
"""A window cuts the ring around an object into four chains at most."""
_LARGEST_RADIUS = 50.0
"""metres; what is larger has an outline of its own."""
_ABOUT = 1.0
"""metres by which the place of what is missing may be wrong."""
_SEMANTICS = "object"
_HEIGHT = 1.0
"""metres, where neither robot nor operator said; marked as an estimate."""


class ObservedArea(NamedTuple):
    """Where an object is: the id of its obstacle, its name, and the ring around it, (n, 2)."""

    id: int
    name: str
    ring: NDArray[np.float64]


class ObservedObjects:
    """Accepted objects, each a ring around its place; ``radius`` is metres where nobody said it.

    What operators agreed is not there any more is :attr:`missing`: observations by the ``src`` of the
    obstacles that are left out. One that is elsewhere in another publication of the site is another obstacle.
    """

    def __init__(self, objects: Sequence[ObservationReport], radius: float) -> None:
        self.missing: dict[str, list[ObservationReport]] = {}
        for one in objects:
            if one.doubts is not None:
                self.missing.setdefault(one.doubts, []).append(one)
        self._rows = list(_rows([one for one in objects if one.doubts is None], radius))
        self._index = OutlineIndex.of(Outlines.from_rows(self._rows))

    def __len__(self) -> int:
        return len(self._index)

    def areas(self) -> list[ObservedArea]:
        """Return where the objects are, under what they are and the robot's id of them."""
        return [
            ObservedArea(_id(row.source), f"{_group(row.semantics)} {row.ext['id']}", row.points)
            for row in self._rows
        ]

    def texts(self, border: Border) -> list[GroupText]:
        """Return the texts of those of the objects that lie in ``border``, in the order of their groups."""
        if not len(self._index):
            return []
        seen = self._numbered(self._index.map_of(Window.from_bounds(*border)).obstacles)
        return sorted(
            (GroupText(_group(one.semantics), write_obstacles([one])) for one in seen),
            key=lambda part: part.group,
        )

    def join(self, robot_map: RobotMap) -> RobotMap:
        """Return ``robot_map`` without what is missing, and with those of the objects that lie in it.

        They are grouped by what they are.
        """
        if self.missing:
            there = [one for one in robot_map.obstacles if not self._is_missing(one)]
            robot_map = dataclasses.replace(robot_map, obstacles=tuple(there))
        if not len(self._index):
            return robot_map
        seen = self._numbered(self._index.map_of(Window.from_bounds(*robot_map.border)).obstacles)
        if not seen:
            return robot_map
        obstacles = sorted([*robot_map.obstacles, *seen], key=lambda obstacle: _group(obstacle.semantics))
        return dataclasses.replace(robot_map, obstacles=tuple(obstacles))

    def _is_missing(self, obstacle: Obstacle) -> bool:
        doubts = self.missing.get(obstacle.ext.get("src", ""), ())
        return any(_is_around(obstacle, one) for one in doubts)

    def _numbered(self, obstacles: Sequence[Obstacle]) -> list[Obstacle]:
        """Return ``obstacles`` under ids that are those of the observations in every window."""
        chains: Counter[str] = Counter()
        numbered = []
        for obstacle in obstacles:
            source = obstacle.ext["src"]
            id = _id(source) + chains[source]
            chains[source] += 1
            numbered.append(dataclasses.replace(obstacle, id=id))
        return numbered


def _is_around(obstacle: Obstacle, doubt: ObservationReport) -> bool:
    """Tell whether an obstacle is where a robot looked through it: its box is about that place."""
    ends = np.concatenate([obstacle.a, obstacle.b])
    place = np.array([doubt.x, doubt.y])
    off = np.maximum(np.maximum(ends.min(axis=0) - place, place - ends.max(axis=0)), 0.0)
    return math.hypot(*off) <= (doubt.radius or 0.0) + _ABOUT


def _rows(objects: Sequence[ObservationReport], radius: float) -> Iterator[OutlineRow]:
    for seen in objects:
        try:
            yield _row(seen, radius)
        except (ValueError, TypeError, ArithmeticError) as error:
            # One that cannot be drawn must not keep all others, and the whole map, from robots.
            log.error("observation %s is not drawn: %s", seen.observation, error)


def _row(seen: ObservationReport, radius: float) -> OutlineRow:
    across = 2 * min(_LARGEST_RADIUS, radius if seen.radius is None else seen.radius)
    ext = {"id": seen.object}
    return OutlineRow(
        points=template(f"circle {across}").at(seen.x, seen.y),
        shape_type=ShapeType.CLOSED_POLYGON,
        height=_HEIGHT if seen.height is None else seen.height,
        semantics=seen.semantics or seen.label or _SEMANTICS,
        source=f"observation:{seen.observation}",
        ext=ext if seen.height is not None else {**ext, "h": "est"},
    )


def _id(source: str) -> int:
    """Return the obstacle's id of an observation, of which its chains have the next ones."""
    return FIRST_ID + _IDS_EACH * int(source.rpartition(":")[2])


def _group(semantics: str) -> str:
    """Return the word by which the builder groups obstacles."""
    return semantics.partition(",")[0]
