"""Checks of a pending command's points and paths against layers: keepouts, obstacles, road surfaces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import Enum
from itertools import chain
from typing import NamedTuple

import numpy as np
from qgis.core import (
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsFeatureRequest,
    QgsGeometry,
    QgsGeometryEngine,
    QgsMapLayer,
    QgsProject,
    QgsRectangle,
    QgsSpatialIndex,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
)

from ..layers.layer_expressions import FeatureFilter
from ..layers.reading import (
    IN_MEMORY,
    FileState,
    begin_reading,
    deleted_in,
    error_of_gdal,
    file_of,
    file_state,
    has_features,
    is_empty,
    is_gone,
)
from ..layers.roles import FURNITURE, KEEPOUT, OBSTACLE, ROAD_SURFACE, STAIRS
from ..layers.site_transform import SiteToMapTransform, check_transform, line_of, transform_or_raise
from ..ui.errors import MapTransformError
from ..ui.language import tr
from ..ui.scheduling import ReadingThread, ReadingTurns, StalledError, Steps
from .pending_command import ROUTE, START, ApproachKind, Findings, PendingCommand, Point

# Each track is checked separately, so that after a change only changed tracks are checked again.

CheckedPath = tuple[Point, ...]
"""One point is a place, several are a way; metres in the site frame."""
AT_BEGINNING_M = 0.5
"""Metres within which a robot counts as standing where its route begins."""
AT_ONCE = 200
"""Tracks converted to geometries between two readings of the clock."""


def legs(draft: PendingCommand) -> Iterator[CheckedPath]:
    """Yield a draft's places and the way there, or each leg of a route with the point before it."""
    if draft.kind != ROUTE:
        yield from _places(draft)
        if draft.way.line:
            yield draft.way.line
        return
    yield from _way_to_route(draft)
    for begin, end in _spans(draft):
        # The first click of several is where the second leg begins.
        if begin > 0 or end > 1 or len(draft.points) == 1:
            yield draft.points[max(0, begin - 1) : end]


def drawn_by_hand(draft: PendingCommand) -> Iterator[CheckedPath]:
    """Yield the places of a draft and the straight way to it, and legs of a route that do not follow roads.

    Legs along the roads come from the gateway, which knows obstacles as the site was published.
    """
    if draft.kind != ROUTE:
        yield from _places(draft)
        if draft.way.kind is ApproachKind.STRAIGHT:
            yield draft.way.line
        return
    yield from _way_to_route(draft)
    if len(draft.points) == 1:
        yield from _places(draft)
    for begin, end in _spans(draft):
        if end - begin == 1 and begin > 0:
            yield draft.points[begin - 1 : end]


def stops(draft: PendingCommand) -> Iterator[CheckedPath]:
    """Yield the places of a draft, or the ends of the legs of a route."""
    if draft.kind != ROUTE:
        yield from _places(draft)
        return
    for _, end in _spans(draft):
        yield (draft.points[end - 1],)


def is_looked_at(draft: PendingCommand) -> bool:
    """Return whether a draft is checked against layers: not a start position, robots may be put there."""
    return draft.kind != START


def lines_in(
    tracks: Sequence[CheckedPath],
    transform: SiteToMapTransform,
    layer: QgsVectorLayer | None,
    project: QgsProject,
) -> Steps[list[QgsGeometry]]:
    """Convert tracks to geometries, in the CRS of ``layer``, or of the site for None.

    :raises MapTransformError: when a point has no place in the layer's CRS.
    """
    flat = np.fromiter(chain.from_iterable(chain.from_iterable(tracks)), np.float64)
    yield 0.0
    corners = transform.frame.to_crs(flat.reshape(-1, 2))
    if layer is not None and layer.crs().isValid():
        corners = transform_or_raise(
            corners, QgsCoordinateTransform(transform.site_crs, layer.crs(), project)
        )
    lines = []
    at = 0
    for number, track in enumerate(tracks):
        lines.append(line_of(corners[at : at + len(track)]))
        at += len(track)
        if number % AT_ONCE == 0:
            yield 0.0
    return lines


def boxes_of(lines: Sequence[QgsGeometry], around: float) -> Steps[list[QgsRectangle]]:
    """Return the bounding box of each geometry, grown by ``around``, in its own units."""
    boxes = []
    for number, line in enumerate(lines):
        boxes.append(line.boundingBox().buffered(around))
        if number % AT_ONCE == 0:
            yield 0.0
    return boxes


def place_in_words(track: CheckedPath) -> str:
    """Return the end of a track as text for operators."""
    x, y = track[-1]
    return tr("({x:.2f}, {y:.2f}) m", x=x, y=y)


def _way_to_route(draft: PendingCommand) -> Iterator[CheckedPath]:
    """Yield the straight way of a robot to the beginning of its route, none to one that it stands at."""
    if draft.way.line and math.dist(*draft.way.line) > AT_BEGINNING_M:
        yield draft.way.line


def _places(draft: PendingCommand) -> Iterator[CheckedPath]:
    for point in draft.points:
        yield (point,)


def _spans(draft: PendingCommand) -> Iterator[tuple[int, int]]:
    """Yield the index of the first point of each leg of a route, and the one after its last."""
    begin = 0
    for leg in draft.legs:
        yield begin, begin + leg
        begin += leg


FEW = 20
"""Places up to which the layer is queried one by one; for more it is read once."""

Near = list[tuple[QgsFeature, list[int]]]
"""Features, each with the numbers of the places near it."""


class Unread(Enum):
    """Why the content of a layer is unknown."""

    GONE = "gone"
    """Its file or database is gone or damaged."""
    SILENT = "silent"
    """It did not answer within the time limit."""


class UnreadError(Exception):
    """A layer was not read, or not completely."""

    def __init__(self, why: Unread):
        super().__init__(why.value)
        self.why = why


class LayerReading(NamedTuple):
    """Features read from a layer; ``is_empty`` where it has no features at all."""

    near: Near
    is_empty: bool
    is_complete: bool
    file: FileState


class LayerReader:
    """Reads the relevant features of a layer, in any thread; created in the thread of the layer.

    :raises ExpressionError: when the filter of the layer is no expression.
    """

    def __init__(self, layer: QgsVectorLayer, boxes: Sequence[QgsRectangle]):
        self._boxes = boxes
        self._features = QgsVectorLayerFeatureSource(layer)
        self._counted = FeatureFilter.of_layer(layer, layer.createExpressionContext())
        self._provider = layer.providerType()
        self._stored, self._deleted = layer.source(), deleted_in(layer)
        self._has_features = False
        self._path = file_of(layer)

    def read(self, go_on: Callable[[], bool]) -> LayerReading:
        """Return the features whose boxes meet those given, in the layer's CRS, while ``go_on()`` is true."""
        file = file_state(self._path)
        begin_reading()
        near = self._near(go_on)
        # Of a damaged file QGIS returns the features before the damage, and no error.
        is_complete = not (self._provider == "ogr" and (error_of_gdal() or is_gone(self._path)))
        if not self._has_features:
            self._has_features = has_features(self._features)
        if is_complete and not self._has_features and self._provider != IN_MEMORY:
            is_complete = is_empty(self._provider, self._stored, self._deleted)
        return LayerReading(near, is_complete and not self._has_features, is_complete, file)

    def _near(self, go_on: Callable[[], bool]) -> Near:
        if len(self._boxes) <= FEW:
            return self._near_few(go_on)
        around = QgsRectangle(self._boxes[0])
        index = QgsSpatialIndex()
        for number, box in enumerate(self._boxes):
            around.combineExtentWith(box)
            index.addFeature(number, box)
        found = []
        for feature in self._in(around, go_on):
            numbers = index.intersects(feature.geometry().boundingBox())
            if numbers and self._counts(feature):
                found.append((feature, sorted(numbers)))
        return found

    def _near_few(self, go_on: Callable[[], bool]) -> Near:
        features: dict[int, QgsFeature] = {}
        near: dict[int, list[int]] = {}
        for number, box in enumerate(self._boxes):
            for feature in self._in(box, go_on):
                if self._counts(feature):
                    features[feature.id()] = feature
                    near.setdefault(feature.id(), []).append(number)
        return [(features[id], numbers) for id, numbers in near.items()]

    def _in(self, box: QgsRectangle, go_on: Callable[[], bool]) -> Iterator[QgsFeature]:
        if not go_on():
            return
        for feature in self._features.getFeatures(QgsFeatureRequest().setFilterRect(box)):
            self._has_features = True
            yield feature
            if not go_on():
                return

    def _counts(self, feature: QgsFeature) -> bool:
        doubts: list[str] = []
        # A feature for which the filter cannot be evaluated may be in the way.
        return self._counted.keeps(feature, doubts) or bool(doubts)


class LayerReadings:
    """Reads layers in threads, one thread per layer at a time.

    A layer whose file has been replaced since it was added to the project, or has reappeared, is
    opened again first: QGIS may continue to read the old file. :meth:`remove` undoes the constructor.
    """

    def __init__(self, project: QgsProject) -> None:
        self._project = project
        self._files: dict[str, FileState] = {}
        project.layersAdded.connect(self._record_files)
        self._record_files(list(project.mapLayers().values()))
        self._turns: dict[str, ReadingTurns] = {}
        self.empty: set[str] = set()
        """Ids of layers that had no features at the last reading."""

    def near(self, layer: QgsVectorLayer, boxes: Sequence[QgsRectangle]) -> Steps[Near]:
        """Find the features of ``layer`` near ``boxes``.

        :raises UnreadError: when it cannot be read, or not in time.
        :raises ExpressionError: when the filter of the layer is no expression.
        """
        # The layer is not accessed afterwards: it may be gone when it has been read.
        id = layer.id()
        reading = yield from self._read(id, LayerReader(layer, boxes))
        is_replaced = self._is_replaced(id, reading.file)
        self._files[id] = reading.file
        if is_replaced:
            # This restarts the check where the layer is watched.
            again = self._project.mapLayer(id)
            if isinstance(again, QgsVectorLayer) and not again.isEditable():
                again.dataProvider().reloadData()
                reading = yield from self._read(id, LayerReader(again, boxes))
        if not reading.is_complete:
            raise UnreadError(Unread.GONE)
        self.empty.discard(id)
        if reading.is_empty:
            self.empty.add(id)
        return reading.near

    def remove(self) -> None:
        """Stop recording layers that are added."""
        self._project.layersAdded.disconnect(self._record_files)

    def _read(self, id: str, reader: LayerReader) -> Steps[LayerReading]:
        try:
            return (yield from self._turns.setdefault(id, ReadingTurns()).read(reader))
        except StalledError as error:
            raise UnreadError(Unread.SILENT) from error

    def _is_replaced(self, id: str, file: FileState) -> bool:
        return file is not None and self._files.get(id, file) != file

    def _record_files(self, layers: Sequence[QgsMapLayer]) -> None:
        paths = {layer.id(): file_of(layer) for layer in layers}
        ReadingThread(_FileStates(paths, self._files)).start()


class _FileStates:
    """Records the state of layers' files in ``states``, in a thread: a network share may not answer."""

    def __init__(self, paths: Mapping[str, str], states: dict[str, FileState]):
        self._paths, self._states = paths, states

    def read(self, go_on: Callable[[], bool]) -> None:
        for id, path in self._paths.items():
            self._states[id] = file_state(path)


def engine_of(geometry: QgsGeometry, times: int) -> QgsGeometryEngine:
    """Return an engine for that many queries about ``geometry``, which must outlive it."""
    engine = QgsGeometry.createGeometryEngine(geometry.constGet())
    if times > 1:
        engine.prepareGeometry()
    return engine


def name_of(feature: QgsFeature, layer: QgsVectorLayer) -> str:
    """Return the name of a feature: its attribute ``name``, else its layer and number."""
    index = layer.fields().lookupField("name")
    name = feature.attribute(index) if index >= 0 else None
    if isinstance(name, str) and name:
        return name
    return tr("{layer} (feature {id})", layer=layer.name(), id=feature.id())


class KeepoutCheck:
    """Finds for each track the keepouts that it touches."""

    roles = (KEEPOUT,)
    only_polygons = True

    def __init__(self, project: QgsProject, readings: LayerReadings):
        self._project = project
        self._readings = readings

    def tracks(self, draft: PendingCommand) -> Iterator[CheckedPath]:
        """Yield the tracks of a draft to check: all of them."""
        return legs(draft)

    def check_paths(
        self, layer: QgsVectorLayer, tracks: Sequence[CheckedPath], transform: SiteToMapTransform
    ) -> Steps[dict[int, list[str]]]:
        """Find the names of the keepouts in ``layer``, by the numbers of the tracks that enter them."""
        found: dict[int, list[str]] = {}
        lines = yield from lines_in(tracks, transform, layer, self._project)
        boxes = yield from boxes_of(lines, 0.0)
        near = yield from self._readings.near(layer, boxes)
        for feature, numbers in near:
            area = feature.geometry()
            engine = engine_of(area, len(numbers))
            for number in numbers:
                if engine.intersects(lines[number].constGet()):
                    found.setdefault(number, []).append(name_of(feature, layer))
                yield 0.0
        return found

    def findings(
        self, draft: PendingCommand, found: Sequence[tuple[CheckedPath, list[str]]], is_watched: bool
    ) -> Steps[Findings]:
        """Return the findings for the hits of each track."""
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


CLEARANCE_M = 0.25
"""Metres within which a place is taken to be on an obstacle: half the width of a small robot."""

Hit = tuple[str, float]
"""The name of an obstacle, and its distance in metres."""


class ObstacleCheck:
    """Finds for each track the obstacles, stairs and furniture in its way; ramps can be driven."""

    roles = (OBSTACLE, STAIRS, FURNITURE)
    only_polygons = False

    def __init__(self, project: QgsProject, readings: LayerReadings):
        self._project = project
        self._readings = readings

    def tracks(self, draft: PendingCommand) -> Iterator[CheckedPath]:
        """Yield the tracks of a draft to check: those drawn by hand."""
        return drawn_by_hand(draft)

    def check_paths(
        self, layer: QgsVectorLayer, tracks: Sequence[CheckedPath], transform: SiteToMapTransform
    ) -> Steps[dict[int, list[Hit]]]:
        """Find the obstacles in ``layer`` by the numbers of the tracks that are too near to them.

        :raises MapTransformError: when the layer has no place in the site's CRS.
        """
        way = QgsCoordinateTransform(layer.crs(), transform.site_crs, self._project)
        lines = yield from lines_in(tracks, transform, None, self._project)
        found: dict[int, list[Hit]] = {}
        try:
            check_transform(way)
            boxes = yield from _boxes(lines, way)
            for feature, numbers in (yield from self._readings.near(layer, boxes)):
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
            raise MapTransformError(
                tr(
                    "The layer {layer} cannot be placed on the site ({error}), so obstacles in it are not "
                    "seen. Correct its CRS, or take its role away.",
                    layer=layer.name(),
                    error=error,
                )
            ) from error
        return found

    def findings(
        self, draft: PendingCommand, found: Sequence[tuple[CheckedPath, list[Hit]]], is_watched: bool
    ) -> Steps[Findings]:
        """Return the findings, each obstacle once for each track."""
        texts = []
        for track, hits in found:
            place = place_in_words(track)
            spot = place if len(track) == 1 else tr("The way to {to}", to=place)
            # Several features may share a name: the nearest counts.
            for name in sorted({name for name, _ in hits}):
                texts.append(_obstacle_text(spot, name, min(away for other, away in hits if other == name)))
            yield 1.0
        return Findings(overridable=tuple(texts))


def _boxes(tracks: Sequence[QgsGeometry], way: QgsCoordinateTransform) -> Steps[list[QgsRectangle]]:
    """Return the boxes to search in the layer's CRS; ``way`` leads from it."""
    boxes = yield from boxes_of(tracks, CLEARANCE_M)
    if not way.isValid() or way.isShortCircuited():
        return boxes
    back = QgsCoordinateTransform(way.destinationCrs(), way.sourceCrs(), way.context())
    limits = [(box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()) for box in boxes]
    corners = [(limit[x], limit[y]) for limit in limits for x, y in ((0, 1), (2, 1), (2, 3), (0, 3))]
    # At the scale of a site the transformed corners bound what lies between them, but for a hair.
    there = transform_or_raise(np.array(corners), back).reshape(-1, 4, 2)
    least, most = there.min(axis=1), there.max(axis=1)
    slack = (most - least) * 0.01
    sides = np.hstack([least - slack, most + slack])
    return [QgsRectangle(*side) for side in sides.tolist()]


def _obstacle_text(spot: str, name: str, away: float) -> str:
    where = tr("is on") if away <= 0.0 else tr("is {away:.2f} m from", away=away)
    return tr("{spot} {where} {name}. Choose a place or way beside it.", spot=spot, where=where, name=name)


GAP_M = 0.5
"""Metres between two surfaces that do not count as leaving the road."""

Share = tuple[float, float]
"""The part of a track on one surface, from and to: 0 is the track's beginning, 1 its end."""
WHOLE: Share = (0.0, 1.0)


class SurfaceCheck:
    """Finds for each place, and each leg drawn by hand, the part that is on a road surface."""

    roles = (ROAD_SURFACE,)
    only_polygons = True

    def __init__(self, project: QgsProject, readings: LayerReadings):
        self._project = project
        self._readings = readings

    def tracks(self, draft: PendingCommand) -> Iterator[CheckedPath]:
        """Yield the tracks of a draft to check: ends of legs, and legs that do not follow the roads."""
        yield from stops(draft)
        yield from (track for track in drawn_by_hand(draft) if len(track) > 1)

    def check_paths(
        self, layer: QgsVectorLayer, tracks: Sequence[CheckedPath], transform: SiteToMapTransform
    ) -> Steps[dict[int, list[Share]]]:
        """Find the parts of the tracks on surfaces of ``layer``, by the tracks' numbers."""
        found: dict[int, list[Share]] = {}
        lines = yield from lines_in(tracks, transform, layer, self._project)
        boxes = yield from boxes_of(lines, 0.0)
        near = yield from self._readings.near(layer, boxes)
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

    def findings(
        self, draft: PendingCommand, found: Sequence[tuple[CheckedPath, list[Share]]], is_watched: bool
    ) -> Steps[Findings]:
        """Return the findings; without any road surface nothing can be said."""
        yield 1.0
        if not is_watched:
            return Findings()
        points = [(track, shares) for track, shares in found if len(track) == 1]
        off = [track for track, shares in points if not shares]
        if off:
            return Findings(warnings=(_points_text(off, len(points)),))
        legs = [(track, shares) for track, shares in found if len(track) > 1]
        leave = [track for track, shares in legs if _gap(track, shares) > GAP_M]
        if leave:
            return Findings(warnings=(_legs_text(leave, len(legs)),))
        return Findings()


def _shares(line: QgsGeometry, area: QgsGeometry) -> list[Share]:
    """Return the parts of a straight line in ``area``, in the CRS of both."""
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


def _gap(track: CheckedPath, shares: Sequence[Share]) -> float:
    """Return the longest part of a leg that is on no surface, metres."""
    reached, widest = 0.0, 0.0
    for start, end in [*sorted(shares), (1.0, 1.0)]:
        widest = max(widest, start - reached)
        reached = max(reached, end)
    return widest * math.dist(track[0], track[-1])


def _points_text(off: Sequence[CheckedPath], points: int) -> str:
    if len(off) == 1:
        return tr("{place} is not on a road surface.", place=place_in_words(off[0]))
    return tr("{off} of {points} points are not on a road surface.", off=len(off), points=points)


def _legs_text(leave: Sequence[CheckedPath], legs: int) -> str:
    if len(leave) == 1:
        return tr("The way to {to} leaves the road surface.", to=place_in_words(leave[0]))
    return tr("{leave} of {legs} legs leave the road surface.", leave=len(leave), legs=legs)
