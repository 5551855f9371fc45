"""Whether a draft leads to places on a road surface of the project's layers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from qgis.core import QgsProject, QgsVectorLayer

from ...language import tr
from ...sites.roles import ROAD_SURFACE
from ..drafts import Draft, Findings
from ..placement import Placement
from .layer_features import LayerFeatures, engine_of
from .slices import Steps
from .tracks import Track, boxes_of, lines_in, stops


class SurfaceCheck:
    """Finds for each place whether it is on a road surface."""

    roles = (ROAD_SURFACE,)
    only_polygons = True

    def __init__(self, project: QgsProject):
        self._project = project

    def tracks(self, draft: Draft) -> Iterator[Track]:
        """Yield what of a draft is looked at: of a route only the ends of its legs."""
        return stops(draft)

    def look(
        self, layer: QgsVectorLayer, tracks: Sequence[Track], placement: Placement
    ) -> Steps[dict[int, list[bool]]]:
        """Find the numbers of the tracks that are on a surface of ``layer``."""
        found: dict[int, list[bool]] = {}
        spots = yield from lines_in(tracks, placement, layer, self._project)
        boxes = yield from boxes_of(spots, 0.0)
        near = yield from LayerFeatures(layer).near(boxes)
        for feature, numbers in near:
            area = feature.geometry()
            engine = engine_of(area, len(numbers))
            for number in numbers:
                if number not in found and engine.contains(spots[number].constGet()):
                    found[number] = [True]
                yield 0.0
        return found

    def told(self, found: Sequence[tuple[Track, list[bool]]], is_watched: bool) -> Steps[Findings]:
        """Return the findings; without any road surface nobody can tell."""
        yield 1.0
        off = [track for track, is_on in found if not is_on]
        if not off or not is_watched:
            return Findings()
        ((x, y),) = off[0]
        where = (
            tr("({x:.2f}, {y:.2f}) m is", x=x, y=y)
            if len(off) == 1
            else tr("{off} of {points} points are", off=len(off), points=len(found))
        )
        return Findings(warnings=(tr("{where} not on a road surface.", where=where),))
