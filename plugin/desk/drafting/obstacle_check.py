"""Whether a draft leads onto an obstacle of the project's layers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from qgis.core import (
    QgsCoordinateTransform,
    QgsCsException,
    QgsGeometry,
    QgsProject,
    QgsRectangle,
    QgsVectorLayer,
)

from ...errors import PlacementError
from ...language import tr
from ...sites.crs_way import check_way
from ...sites.roles import FURNITURE, OBSTACLE, STAIRS
from ..drafts import Draft, Findings
from ..placement import Placement, transformed
from ..time_slices import Steps
from .layer_features import LayerFeatures, engine_of, name_of
from .tracks import Track, boxes_of, drawn_by_hand, lines_in, place_in_words

CLEARANCE_M = 0.25
"""Metres within which a place is taken to be on an obstacle: half the width of a small robot."""

Hit = tuple[str, float]
"""The name of an obstacle, and how many metres away it is."""


class ObstacleCheck:
    """Finds for each track the obstacles, stairs and furniture in its way; ramps can be driven."""

    roles = (OBSTACLE, STAIRS, FURNITURE)
    only_polygons = False

    def __init__(self, project: QgsProject):
        self._project = project

    def tracks(self, draft: Draft) -> Iterator[Track]:
        """Yield what of a draft is looked at: what was drawn by hand."""
        return drawn_by_hand(draft)

    def look(
        self, layer: QgsVectorLayer, tracks: Sequence[Track], placement: Placement
    ) -> Steps[dict[int, list[Hit]]]:
        """Find the obstacles in ``layer`` by the numbers of the tracks that are too near to them.

        :raises PlacementError: when the layer has no place in the site's CRS.
        """
        way = QgsCoordinateTransform(layer.crs(), placement.site_crs, self._project)
        lines = yield from lines_in(tracks, placement, None, self._project)
        found: dict[int, list[Hit]] = {}
        try:
            check_way(way)
            boxes = yield from _boxes(lines, way)
            for feature, numbers in (yield from LayerFeatures(layer).near(boxes)):
                obstacle = QgsGeometry(feature.geometry())
                if way.isValid():
                    obstacle.transform(way)
                engine = engine_of(obstacle, len(numbers))
                for number in numbers:
                    away = engine.distance(lines[number].constGet())
                    if 0 <= away <= CLEARANCE_M:
                        found.setdefault(number, []).append((name_of(feature, layer), away))
                    yield 0.0
        except QgsCsException as error:
            raise PlacementError(
                tr(
                    "The layer {layer} cannot be placed on the site ({error}), so obstacles in it are not "
                    "seen. Correct its CRS, or take its role away.",
                    layer=layer.name(),
                    error=error,
                )
            ) from error
        return found

    def told(
        self, draft: Draft, found: Sequence[tuple[Track, list[Hit]]], is_watched: bool
    ) -> Steps[Findings]:
        """Return the findings, each obstacle once for each track."""
        texts = []
        for track, hits in found:
            place = place_in_words(track)
            spot = place if len(track) == 1 else tr("The way to {to}", to=place)
            # Several features may have one name: the nearest counts.
            for name in sorted({name for name, _ in hits}):
                texts.append(_told(spot, name, min(away for other, away in hits if other == name)))
            yield 1.0
        return Findings(overridable=tuple(texts))


def _boxes(tracks: Sequence[QgsGeometry], way: QgsCoordinateTransform) -> Steps[list[QgsRectangle]]:
    """Return what is to be looked at in the layer's CRS, where ``way`` leads from."""
    boxes = yield from boxes_of(tracks, CLEARANCE_M)
    if not way.isValid() or way.isShortCircuited():
        return boxes
    back = QgsCoordinateTransform(way.destinationCrs(), way.sourceCrs(), way.context())
    limits = [(box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()) for box in boxes]
    corners = [(limit[x], limit[y]) for limit in limits for x, y in ((0, 1), (2, 1), (2, 3), (0, 3))]
    # At the scale of a site the corners hold what lies between them, but for a hair.
    there = transformed(np.array(corners), back).reshape(-1, 4, 2)
    least, most = there.min(axis=1), there.max(axis=1)
    slack = (most - least) * 0.01
    sides = np.hstack([least - slack, most + slack])
    return [QgsRectangle(*side) for side in sides.tolist()]


def _told(spot: str, name: str, away: float) -> str:
    where = tr("is on") if away <= 0.0 else tr("is {away:.2f} m from", away=away)
    return tr("{spot} {where} {name}. Choose a place or way beside it.", spot=spot, where=where, name=name)
