"""What a layer comes to when it is published with a role: counts, warnings and lines to look at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import QgsFeedback

from ...robot_bridge.robotmap.model import ShapeType
from ..errors import FleetError
from ..language import tr
from ..sites.ground_reading import read_areas, read_centrelines
from ..sites.obstacle_source import ObstacleSource
from ..sites.placing import SitePlacing
from ..sites.reading import read_outlines
from ..sites.roles import OBSTACLE_ROLES, ROAD_CENTRELINE

ESTIMATED_HEIGHT_M = 3.0
ESTIMATED_WIDTH_M = 3.5


@dataclass(frozen=True)
class Measure:
    """What one layer comes to.

    ``segments`` is (n, 4): x and y of both ends, metres in the site frame. ``warnings`` name features;
    ``refused`` says why nothing of the layer can be published.
    """

    role: str = ""
    count: int = 0
    segments: np.ndarray = field(default_factory=lambda: np.empty((0, 4)))
    warnings: Sequence[str] = ()
    refused: str = ""

    def __str__(self) -> str:
        if self.refused:
            return "refused"
        if not self.role:
            return ""
        thing = _counted(self.count, _THINGS.get(self.role, "obstacle"))
        warned = f", {_counted(len(self.warnings), 'warning')}" if self.warnings else ""
        return f"{thing}, {_counted(len(self.segments), 'segment')}{warned}"


_THINGS = {"road_centreline": "road", "road_surface": "surface", "keepout": "keepout"}


def measure(source: ObstacleSource, site: SitePlacing, feedback: QgsFeedback) -> Measure | None:
    """Return what ``source`` comes to with its role, None after a cancel; from any thread."""
    try:
        if source.role in OBSTACLE_ROLES:
            reading = read_outlines([source], site, None, ESTIMATED_HEIGHT_M, feedback)
            flights = ShapeType.STAIRS
            lines = [_risers(r.points) if r.shape_type is flights else _chain(r.points) for r in reading.rows]
            solid = sum(not row.courtyard for row in reading.rows)
            found = Measure(source.role, solid, _joined(lines), reading.warnings)
        elif source.role == ROAD_CENTRELINE:
            reading = read_centrelines([source], site, ESTIMATED_WIDTH_M, feedback)
            lines = [_chain(line.points) for line in reading.items]
            found = Measure(source.role, len(lines), _joined(lines), reading.warnings)
        else:
            reading = read_areas([source], site, source.role, feedback)
            lines = [_chain(ring) for area in reading.items for ring in area.rings]
            found = Measure(source.role, len(reading.items), _joined(lines), reading.warnings)
    except FleetError as error:
        return Measure(source.role, refused=str(error))
    return found if reading.complete else None


def summary(measures: Sequence[Measure]) -> str:
    """Return what all layers come to together, in one line."""
    counted = dict.fromkeys(("obstacle", *_THINGS.values()), 0)
    for one in measures:
        if one.role:
            counted[_THINGS.get(one.role, "obstacle")] += one.count
    segments = sum(len(one.segments) for one in measures if one.role in OBSTACLE_ROLES)
    warned = sum(len(one.warnings) for one in measures)
    things = [_counted(number, thing) for thing, number in counted.items()]
    things[0] += tr(" of {counted}", counted=_counted(segments, "segment"))
    refused = sum(bool(one.refused) for one in measures)
    if refused:
        things.append(tr("{counted} refused", counted=_counted(refused, "layer")))
    return ", ".join([*things, _counted(warned, "warning")])


def _chain(points: np.ndarray) -> np.ndarray:
    return np.hstack([points[:-1], points[1:]])


def _risers(points: np.ndarray) -> np.ndarray:
    return points.reshape(-1, 4)


def _joined(lines: Sequence[np.ndarray]) -> np.ndarray:
    return np.concatenate(lines) if lines else np.empty((0, 4))


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
