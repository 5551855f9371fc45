"""Whether a draft leads to places, and along ways, on a road surface of the project's layers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from qgis.core import QgsGeometry, QgsProject, QgsVectorLayer

from ...language import tr
from ...sites.roles import ROAD_SURFACE
from ..drafts import Draft, Findings
from ..placement import Placement
from ..time_slices import Steps
from .layer_features import LayerFeatures, engine_of
from .tracks import Track, boxes_of, drawn_by_hand, lines_in, place_in_words, stops

GAP_M = 0.5
"""Metres between two surfaces that a robot is not said to leave the road for."""

Share = tuple[float, float]
"""From where to where of a track one surface reaches: 0 is its beginning, 1 its end."""
WHOLE: Share = (0.0, 1.0)


class SurfaceCheck:
    """Finds for each place, and each leg that was drawn, what of it is on a road surface."""

    roles = (ROAD_SURFACE,)
    only_polygons = True

    def __init__(self, project: QgsProject):
        self._project = project

    def tracks(self, draft: Draft) -> Iterator[Track]:
        """Yield what of a draft is looked at: where its legs end, and those that do not follow the roads."""
        yield from stops(draft)
        yield from (track for track in drawn_by_hand(draft) if len(track) > 1)

    def look(
        self, layer: QgsVectorLayer, tracks: Sequence[Track], placement: Placement
    ) -> Steps[dict[int, list[Share]]]:
        """Find what surfaces of ``layer`` hold of the tracks, by the tracks' numbers."""
        found: dict[int, list[Share]] = {}
        lines = yield from lines_in(tracks, placement, layer, self._project)
        boxes = yield from boxes_of(lines, 0.0)
        near = yield from LayerFeatures(layer).near(boxes)
        for feature, numbers in near:
            area = feature.geometry()
            engine = engine_of(area, len(numbers))
            for number in numbers:
                line = lines[number].constGet()
                if WHOLE in found.get(number, ()):
                    pass
                elif engine.contains(line):
                    found[number] = [WHOLE]
                elif len(tracks[number]) > 1 and engine.intersects(line):
                    found.setdefault(number, []).extend(_shares(lines[number], area))
                yield 0.0
        return found

    def told(
        self, draft: Draft, found: Sequence[tuple[Track, list[Share]]], is_watched: bool
    ) -> Steps[Findings]:
        """Return the findings; without any road surface nobody can tell."""
        yield 1.0
        if not is_watched:
            return Findings()
        points = [(track, shares) for track, shares in found if len(track) == 1]
        off = [track for track, shares in points if not shares]
        if off:
            return Findings(warnings=(_told_of_points(off, len(points)),))
        legs = [(track, shares) for track, shares in found if len(track) > 1]
        leave = [track for track, shares in legs if _gap(track, shares) > GAP_M]
        if leave:
            return Findings(warnings=(_told_of_legs(leave, len(legs)),))
        return Findings()


def _shares(line: QgsGeometry, area: QgsGeometry) -> list[Share]:
    """Return what of a straight line is in ``area``, in the CRS of both."""
    start, *_, end = line.vertices()
    dx, dy = end.x() - start.x(), end.y() - start.y()
    square = dx * dx + dy * dy
    inside = line.intersection(area)
    if square == 0.0 or inside.isNull():
        return []
    shares = []
    for part in inside.constParts():
        along = [((v.x() - start.x()) * dx + (v.y() - start.y()) * dy) / square for v in part.vertices()]
        shares.append((min(along), max(along)))
    return shares


def _gap(track: Track, shares: Sequence[Share]) -> float:
    """Return the longest part of a leg that is on no surface, metres."""
    reached, widest = 0.0, 0.0
    for start, end in [*sorted(shares), (1.0, 1.0)]:
        widest = max(widest, start - reached)
        reached = max(reached, end)
    return widest * math.dist(track[0], track[-1])


def _told_of_points(off: Sequence[Track], points: int) -> str:
    if len(off) == 1:
        return tr("{place} is not on a road surface.", place=place_in_words(off[0]))
    return tr("{off} of {points} points are not on a road surface.", off=len(off), points=points)


def _told_of_legs(leave: Sequence[Track], legs: int) -> str:
    if len(leave) == 1:
        return tr("The way to {to} leaves the road surface.", to=place_in_words(leave[0]))
    return tr("{leave} of {legs} legs leave the road surface.", leave=len(leave), legs=legs)
