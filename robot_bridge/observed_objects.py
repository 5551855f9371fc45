"""Objects that robots saw and operators accepted, as obstacles on the maps."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Sequence

from .messages import ObservationReport
from .robotmap.index import OutlineIndex
from .robotmap.model import Obstacle, RobotMap, ShapeType
from .robotmap.outlines import OutlineRow, Outlines
from .robotmap.templates import template
from .robotmap.window import Window

FIRST_ID = 1_000_000_000
"""Obstacles from here on were seen by robots; those of the site's own layers are below."""
_IDS_EACH = 8
"""A window cuts the ring around an object into four chains at most."""
_LARGEST_RADIUS = 50.0
"""metres; what is larger has an outline of its own."""
_SEMANTICS = "object"
_HEIGHT = 1.0
"""metres, where neither robot nor operator said; marked as an estimate."""


class ObservedObjects:
    """Accepted objects, each a ring around its place; ``radius`` is metres where nobody said it."""

    def __init__(self, objects: Sequence[ObservationReport], radius: float) -> None:
        self._index = OutlineIndex(Outlines.from_rows([_row(seen, radius) for seen in objects]))

    def join(self, robot_map: RobotMap) -> RobotMap:
        """Return ``robot_map`` with those of the objects that lie in it, grouped by what they are."""
        if not len(self._index):
            return robot_map
        seen = self._numbered(self._index.map_of(Window.from_bounds(*robot_map.border)).obstacles)
        if not seen:
            return robot_map
        obstacles = sorted([*robot_map.obstacles, *seen], key=lambda obstacle: _group(obstacle.semantics))
        return dataclasses.replace(robot_map, obstacles=tuple(obstacles))

    def _numbered(self, obstacles: Sequence[Obstacle]) -> list[Obstacle]:
        """Return ``obstacles`` under ids that are those of the observations in every window."""
        chains: Counter[str] = Counter()
        numbered = []
        for obstacle in obstacles:
            source = obstacle.ext["src"]
            id = FIRST_ID + _IDS_EACH * int(source.rpartition(":")[2]) + chains[source]
            chains[source] += 1
            numbered.append(dataclasses.replace(obstacle, id=id))
        return numbered


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


def _group(semantics: str) -> str:
    """Return the word by which the builder groups obstacles."""
    return semantics.partition(",")[0]
