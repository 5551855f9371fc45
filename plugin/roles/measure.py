"""What a layer comes to when it is published with a role: counts, warnings and lines to look at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import QgsFeedback

from ...robot_bridge.robotmap.model import ShapeType
from ..errors import FleetError
from ..language import tr, tr_count
from ..sites.ground_reading import read_areas, read_centrelines
from ..sites.obstacle_source import ObstacleSource
from ..sites.placing import SitePlacing
from ..sites.reading import read_outlines
from ..sites.roles import KEEPOUT, OBSTACLE, OBSTACLE_ROLES, ROAD_CENTRELINE, ROAD_SURFACE

ESTIMATED_HEIGHT_M = 3.0
ESTIMATED_WIDTH_M = 3.5
_KINDS = (OBSTACLE, ROAD_CENTRELINE, ROAD_SURFACE, KEEPOUT)


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
            return tr("refused")
        if not self.role:
            return ""
        told = [_things(self.role, self.count), _segments(len(self.segments))]
        return ", ".join(told + ([_warnings(len(self.warnings))] if self.warnings else []))


def measure(source: ObstacleSource, site: SitePlacing, feedback: QgsFeedback) -> Measure | None:
    """Return what ``source`` comes to with its role, None after a cancel; from any thread."""
    try:
        if source.role in OBSTACLE_ROLES:
            reading = read_outlines([source], site, None, ESTIMATED_HEIGHT_M, feedback)
            flights = ShapeType.STAIRS
            rows = reading.rows
            lines = [_risers(row.points) if row.shape_type is flights else _chain(row.points) for row in rows]
            solid = sum(not row.courtyard for row in rows)
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
    counted = dict.fromkeys(_KINDS, 0)
    for one in measures:
        if one.role:
            counted[one.role if one.role in counted else OBSTACLE] += one.count
    segments = sum(len(one.segments) for one in measures if one.role in OBSTACLE_ROLES)
    told = [_things(kind, number) for kind, number in counted.items()]
    told[0] = tr("{obstacles} of {segments}", obstacles=told[0], segments=_segments(segments))
    refused = sum(bool(one.refused) for one in measures)
    if refused:
        told.append(tr_count(refused, "1 layer refused", "%n layers refused"))
    return ", ".join([*told, _warnings(sum(len(one.warnings) for one in measures))])


def _things(role: str, number: int) -> str:
    """Return how many things a layer of ``role`` has; ramps, stairs and furniture are obstacles."""
    if role == ROAD_CENTRELINE:
        return tr_count(number, "1 road", "%n roads")
    if role == ROAD_SURFACE:
        return tr_count(number, "1 surface", "%n surfaces")
    if role == KEEPOUT:
        return tr_count(number, "1 keepout", "%n keepouts")
    return tr_count(number, "1 obstacle", "%n obstacles")


def _segments(number: int) -> str:
    return tr_count(number, "1 segment", "%n segments")


def _warnings(number: int) -> str:
    return tr_count(number, "1 warning", "%n warnings")


def _chain(points: np.ndarray) -> np.ndarray:
    return np.hstack([points[:-1], points[1:]])


def _risers(points: np.ndarray) -> np.ndarray:
    return points.reshape(-1, 4)


def _joined(lines: Sequence[np.ndarray]) -> np.ndarray:
    return np.concatenate(lines) if lines else np.empty((0, 4))
