"""Whether a draft leads into a keepout of the project's layers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from qgis.core import QgsProject, QgsVectorLayer

from ...language import tr
from ...sites.roles import KEEPOUT
from ..drafts import ROUTE, Draft, Findings
from ..placement import Placement
from ..time_slices import Steps
from .layer_features import LayerFeatures, engine_of, name_of
from .tracks import Track, boxes_of, legs, lines_in, place_in_words


class KeepoutCheck:
    """Finds for each track the keepouts that it touches."""

    roles = (KEEPOUT,)
    only_polygons = True

    def __init__(self, project: QgsProject):
        self._project = project

    def tracks(self, draft: Draft) -> Iterator[Track]:
        """Yield what of a draft is looked at: all of it."""
        return legs(draft)

    def look(
        self, layer: QgsVectorLayer, tracks: Sequence[Track], placement: Placement
    ) -> Steps[dict[int, list[str]]]:
        """Find the names of the keepouts in ``layer`` by the numbers of the tracks that enter them."""
        found: dict[int, list[str]] = {}
        lines = yield from lines_in(tracks, placement, layer, self._project)
        boxes = yield from boxes_of(lines, 0.0)
        near = yield from LayerFeatures(layer).near(boxes)
        for feature, numbers in near:
            area = feature.geometry()
            engine = engine_of(area, len(numbers))
            for number in numbers:
                if engine.intersects(lines[number].constGet()):
                    found.setdefault(number, []).append(name_of(feature, layer))
                yield 0.0
        return found

    def told(
        self, draft: Draft, found: Sequence[tuple[Track, list[str]]], is_watched: bool
    ) -> Steps[Findings]:
        """Return the findings of what was found for each track."""
        texts: dict[str, None] = {}
        for track, names in found:
            place = place_in_words(track)
            is_leg = draft.kind == ROUTE and track != draft.way.line
            way = tr("The route") if is_leg else tr("The way to {to}", to=place)
            spot = place if len(track) == 1 else way
            for name in names:
                texts[
                    tr(
                        "{spot} enters the keepout {name}. Choose a place or way outside it.",
                        spot=spot,
                        name=name,
                    )
                ] = None
            yield 1.0
        return Findings(overridable=tuple(texts))
