"""Whether a draft can be driven: inside the site, off keepouts and obstacles, on a road surface."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from qgis.core import QgsProject, QgsVectorLayer, QgsWkbTypes
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.messages import SiteReport
from ..language import tr
from ..sites.layer_watch import LayerWatch
from ..sites.roles import layers_with_role
from .drafting.keepout_check import KeepoutCheck
from .drafting.obstacle_check import ObstacleCheck
from .drafting.surface_check import SurfaceCheck
from .drafting.tracks import Track, is_looked_at
from .drafts import ROUTE, Draft, Findings, Point
from .placement import Placement
from .time_slices import Steps, part_of

AT_ONCE = 500
"""Tracks that are gone through between two looks at the clock."""

T = TypeVar("T")
Check = KeepoutCheck | ObstacleCheck | SurfaceCheck
Found = dict[Track, list[Any]]


def check_bounds(points: Sequence[Point], site: SiteReport) -> Findings:
    """Refuse what lies outside the site's bounds; ``points`` are metres in the site frame."""
    x_min, y_min, x_max, y_max = site.bounds
    outside = [(x, y) for x, y in points if not (x_min <= x <= x_max and y_min <= y <= y_max)]
    if not outside:
        return Findings()
    where = "; ".join(f"({x:.2f}, {y:.2f})" for x, y in outside[:3])
    return Findings(
        refused=(
            tr(
                "{where} m is outside the site {name}, which reaches from ({x_min:g}, {y_min:g}) to "
                "({x_max:g}, {y_max:g}) m. Click inside it.",
                where=where,
                name=site.name,
                x_min=x_min,
                y_min=y_min,
                x_max=x_max,
                y_max=y_max,
            ),
        )
    )


def check_map(placement: Placement) -> Findings:
    """Warn where the map has no CRS: then QGIS puts layers of every CRS into one map, each by its numbers."""
    if placement.map_crs.isValid():
        return Findings()
    return Findings(
        warnings=(
            tr(
                "The project has no CRS, so the map is taken to be in the site's, {crs}; a layer in another "
                "CRS lies at a wrong place on it. Choose the project's CRS at the bottom right in QGIS.",
                crs=placement.site_crs.authid(),
            ),
        )
    )


class LayerCheck(QObject):
    """Checks drafts against the project's layers that carry the roles of obstacles, keepouts and surfaces.

    What was found for a part of a draft is kept until a layer changes or another check needs it no more.
    """

    changed = pyqtSignal()
    """A layer is not as it was: what is under way has to begin anew."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._checks: tuple[Check, ...] = (
            KeepoutCheck(project),
            ObstacleCheck(project),
            SurfaceCheck(project),
        )
        self._kept: dict[Check, Found] = {}
        self._kept_for: tuple[Any, ...] = ()
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self._forget)

    def remove(self) -> None:
        """Watch no layer any longer."""
        self._watch.remove()

    def look(self, draft: Draft, placement: Placement, afresh: bool = False) -> Steps[Findings]:
        """Find what touches a keepout or an obstacle, warn of what leaves the road; ``afresh`` all of it.

        Where a robot says that it stands is not looked at: it may have been put there.

        :raises PlacementError: when a point has no place in a layer's CRS.
        :raises ExpressionError: when the filter of a layer is no expression.
        """
        if not is_looked_at(draft):
            return Findings()
        layers = {check: self._layers(check) for check in self._checks}
        looked_at = (placement, *(tuple(layer.id() for layer in of_one) for of_one in layers.values()))
        if afresh or looked_at != self._kept_for:
            self._kept.clear()
        self._kept_for = looked_at
        for of_one in layers.values():
            self._watch.watch(of_one)
        findings = self._unseen()
        for number, check in enumerate(self._checks):
            work = self._look_by(check, layers[check], draft, placement)
            findings += yield from part_of(work, number, len(self._checks))
        return findings

    def _look_by(
        self, check: Check, layers: Sequence[QgsVectorLayer], draft: Draft, placement: Placement
    ) -> Steps[Findings]:
        kept = self._kept.get(check, {})
        tracks = yield from _listed(check.tracks(draft))
        new: Found = {}
        for number, track in enumerate(tracks):
            if track not in kept:
                new[track] = []
            if number % AT_ONCE == 0:
                yield 0.0
        missing = list(new)
        for number, layer in enumerate(layers if missing else ()):
            hits = yield from part_of(check.look(layer, missing, placement), number, len(layers))
            for place, found in hits.items():
                new[missing[place]] += found
        found_for: list[tuple[Track, list[Any]]] = []
        still_needed: Found = {}
        for number, track in enumerate(tracks):
            found = new[track] if track in new else kept[track]
            found_for.append((track, found))
            still_needed[track] = found
            if number % AT_ONCE == 0:
                yield 0.0
        self._kept[check] = still_needed
        # As with the alarms: of layers with nothing in them, as published sites without surfaces have them.
        is_watched = any(layer.featureCount() != 0 for layer in layers)
        return (yield from _told(check, draft, _without_repetition(draft, found_for), is_watched))

    def _unseen(self) -> Findings:
        """Tell of what a draft has to be held against and cannot be."""
        layers = layers_with_role(self._project, *(role for check in self._checks for role in check.roles))
        if not layers:
            return Findings(
                warnings=(
                    tr(
                        "No layer of the project says where obstacles and keepouts are, so nobody has "
                        "looked. Open the site's project, or give layers their roles."
                    ),
                )
            )
        return Findings(
            overridable=tuple(
                tr(
                    "The layer {layer} cannot be read, so what is in it was not looked at. Repair its "
                    "source, or take its role away.",
                    layer=layer.name(),
                )
                for layer in layers
                if not layer.isValid()
            )
        )

    def _layers(self, check: Check) -> list[QgsVectorLayer]:
        return [
            layer
            for layer in layers_with_role(self._project, *check.roles)
            if isinstance(layer, QgsVectorLayer)
            and layer.isValid()
            and layer.isSpatial()
            and (not check.only_polygons or _has_areas(layer))
        ]

    def _forget(self) -> None:
        self._kept.clear()
        self.changed.emit()


def _told(
    check: Check, draft: Draft, found: Sequence[tuple[Track, list[Any]]], is_watched: bool
) -> Steps[Findings]:
    """Return what is to be told of what was ``found``, and which of that is about the way to the draft."""
    if not draft.way.line:
        return (yield from check.told(draft, found, is_watched))
    of_place = yield from check.told(draft, [one for one in found if one[0] != draft.way.line], is_watched)
    if draft.kind == ROUTE:
        # By itself: what is told of the route's own legs must not change as its robot moves.
        way = [one for one in found if one[0] == draft.way.line]
        of_way = yield from check.told(draft, way, is_watched)
        return of_place + replace(of_way, of_way=of_way.overridable + of_way.warnings)
    told = yield from check.told(draft, found, is_watched)
    texts = told.overridable + told.warnings
    # What is told of the place alone is not of the way to it.
    return replace(told, of_way=tuple(text for text in texts if text not in of_place.all_texts))


def _without_repetition(
    draft: Draft, found: Sequence[tuple[Track, list[Any]]]
) -> Sequence[tuple[Track, list[Any]]]:
    """Return what was ``found``, but of the way to a target not what is at the target as well."""
    if not draft.way.line:
        return found
    at_target = {_name(hit) for track, hits in found if len(track) == 1 for hit in hits}
    return [
        (track, hits if len(track) == 1 else [hit for hit in hits if _name(hit) not in at_target])
        for track, hits in found
    ]


def _name(hit: Any) -> Any:
    """Return the name of a keepout or an obstacle; what a surface holds of a track has none."""
    if isinstance(hit, str):
        return hit
    return hit[0] if isinstance(hit[0], str) else object()


def _has_areas(layer: QgsVectorLayer) -> bool:
    return layer.geometryType() == QgsWkbTypes.GeometryType.PolygonGeometry


def _listed(things: Iterable[T]) -> Steps[list[T]]:
    found = []
    for number, thing in enumerate(things):
        found.append(thing)
        if number % AT_ONCE == AT_ONCE - 1:
            yield 0.0
    return found
