"""Road centrelines, road surfaces and keepouts read from their layers, with the attributes of each road."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, NamedTuple, TypeVar, cast

import numpy as np
import numpy.typing as npt
from qgis.core import QgsAbstractGeometry, QgsFeature, QgsFeedback, QgsGeometry, QgsPointXY

from ...robot_bridge.core.roads.network import (
    BACKWARD,
    BOTH,
    DEFAULT_SPEED,
    DRAWN,
    FORWARD,
    GENERATED,
    Network,
    Surface,
)
from ...robot_bridge.core.sites.geopackage import Area, Centreline
from ..ui.language import tr
from .geometry import (
    NO_PLACE,
    SAGITTA_M,
    GeometryParts,
    RingTable,
    geometry_of,
    lines_with_length,
    parts_of,
    polygons_of,
    rings_of,
    shapes_of,
)
from .layer_expressions import UNKNOWN, FeatureFilter, LayerRules, Memory, Rule, as_flag, as_metres
from .layer_source import (
    FeatureReader,
    FeatureRow,
    FeatureWarnings,
    ObstacleSource,
    SomeFeatures,
    check_readable,
)
from .roles import KEEPOUT, ROAD_CENTRELINE, ROAD_SURFACE
from .site_transform import LayerToSiteTransform, SiteGeoreference

# --- Attributes of roads for the network: width, surface, direction, speed, closed or not, level

_DIRECTIONS = {
    **dict.fromkeys(("both", "no", "false", "0", "f,t", "b", "none"), BOTH),
    **dict.fromkeys(("forward", "yes", "true", "1", "ft", "f", "->"), FORWARD),
    **dict.fromkeys(("backward", "reverse", "-1", "tf", "t", "<-"), BACKWARD),
}
_KMH = re.compile(r"\s*(\d+(?:[.,]\d+)?)\s*(km/h|kmh)?\s*", re.ASCII)
_MPH = re.compile(r"\s*(\d+(?:[.,]\d+)?)\s*mph\s*", re.ASCII)

WIDTH_FIELDS = ("width_m", "width")
DIRECTION_FIELDS = ("direction", "oneway", "one_way")
DIRECTION_TAGS = ("oneway",)
"""OpenStreetMap's tags; its ``direction`` is where a sign or a bench faces."""
ROUNDABOUTS = ("roundabout", "circular")
SPEED_FIELDS = ("speed_ms",)
KMH_FIELDS = ("maxspeed", "speed_limit")
LEVEL_FIELDS = ("level", "layer")


@dataclass(frozen=True)
class RoadExpressions:
    """QGIS expressions; an empty one stands for the usual fields of such layers."""

    width: str = ""
    surface: str = ""
    direction: str = ""
    speed: str = ""
    closed: str = ""
    level: str = ""


@dataclass(frozen=True)
class Traffic:
    """Driving restrictions of one road; ``speed`` in m/s is None where it is not known."""

    direction: int
    speed: float | None
    closed: bool
    level: int


@dataclass(frozen=True)
class RoadAttributes:
    """Attributes of one road; ``width`` in metres is None where it is not known."""

    width: float | None
    surface: str
    traffic: Traffic


class RoadRules:
    """Evaluates the expressions of one layer of roads.

    :raises ExpressionError: when one of them is invalid, or reads a missing field.
    """

    def __init__(self, rules: LayerRules, given: RoadExpressions) -> None:
        self._rules = rules
        column = rules.column
        self._width = self._rule("width", given.width, *WIDTH_FIELDS)
        self._surface = self._rule("surface", given.surface, "surface")
        self._direction = self._direction_rule(given.direction)
        self._junction = None if given.direction else rules.rule("direction", column("junction"))
        self._speed = self._rule("speed", given.speed, *SPEED_FIELDS)
        self._kmh = None if self._speed else rules.rule("speed", column(*KMH_FIELDS))
        self._closed = self._rule("closed", given.closed, "closed")
        self._level = self._rule("level", given.level, *LEVEL_FIELDS)
        over_and_under = (1, "bridge"), (-1, "tunnel")
        self._structures = [
            (level, rules.rule("level", column(name))) for level, name in over_and_under if not given.level
        ]
        about_ways = (self._direction, self._junction, self._speed, self._kmh, self._closed, self._level)
        self.of_traffic = [*about_ways, *(rule for _, rule in self._structures)]
        """The rules used by :meth:`traffic`."""

    def of(self, notes: list[str]) -> RoadAttributes:
        """Return the attributes of the road that the rules are set to; unreadable ones become a note."""
        surface = self._rules.value("surface", self._surface, notes)
        return RoadAttributes(
            width=self._rules.metres("width", self._width, notes),
            surface="" if surface is None else str(surface),
            traffic=self.traffic(notes),
        )

    def traffic(self, notes: list[str]) -> Traffic:
        """Return the driving restrictions of the road that the rules are set to."""
        return Traffic(
            direction=self._direction_of(notes),
            speed=self._speed_of(notes),
            closed=self._closed_of(notes),
            level=self._level_of(notes),
        )

    def _rule(self, what: str, given: str, *fields: str) -> Rule | None:
        if given.strip():
            return self._rules.needed_rule(what, given)
        return self._rules.rule(what, self._rules.column(*fields))

    def _direction_rule(self, given: str) -> Rule | None:
        if given.strip():
            return self._rules.needed_rule("direction", given)
        column = self._rules.own_column(*DIRECTION_FIELDS) or self._rules.column(*DIRECTION_TAGS)
        if not column:
            self._rules.warn_of_layer(
                tr(
                    "none of its fields direction, oneway, one_way and other_tags is there to tell one-way "
                    "roads; all are taken as driven both ways"
                )
            )
        return self._rules.rule("direction", column)

    def _value(self, what: str, rule: Rule | None, notes: list[str]) -> Any:
        value = self._rules.value(what, rule, notes)
        return None if value is None or str(value).strip() == "" else value

    def _direction_of(self, notes: list[str]) -> int:
        value = self._value("direction", self._direction, notes)
        if value is None:
            junction = self._value("direction", self._junction, notes)
            # OpenStreetMap: a roundabout is one-way unless it says otherwise.
            return FORWARD if junction in ROUNDABOUTS else BOTH
        direction = _DIRECTIONS.get(str(value).strip().lower())
        if direction is None:
            notes.append(
                tr(
                    "its direction {value!r} is none of yes, -1 and no; it is taken as driven both ways",
                    value=value,
                )
            )
        return direction or BOTH

    def _speed_of(self, notes: list[str]) -> float | None:
        value = self._value("speed", self._speed or self._kmh, notes)
        if value is None:
            return None
        speed = as_metres(value) if self._speed else _from_kmh(value)
        if speed is None or speed <= 0:
            notes.append(tr("its speed {value!r} is no number above 0; the default is used", value=value))
            return None
        return speed

    def _closed_of(self, notes: list[str]) -> bool:
        value = self._value("closed", self._closed, notes)
        closed = False if value is None else as_flag(value)
        if closed is None:
            notes.append(
                tr(
                    "whether it is closed, {value!r}, is neither true nor false; it is taken as closed",
                    value=value,
                )
            )
        return closed is not False

    def _level_of(self, notes: list[str]) -> int:
        value = self._value("level", self._level, notes)
        number = None if value is None else as_metres(value)
        if value is not None and number is None:
            notes.append(tr("its level {value!r} is no number; it is taken to be on the ground", value=value))
        if number is not None:
            return round(number)
        for level, rule in self._structures:
            there = self._value("level", rule, notes)
            # There are many kinds of bridges and tunnels; none is called no, or F as in Geofabrik's
            # shapefiles.
            if there is not None and as_flag(there) is not False and str(there).strip() not in ("F", "f"):
                return level
        return 0


def _from_kmh(value: Any) -> float | None:
    text = str(value).lower()
    for pattern, factor in ((_KMH, 1 / 3.6), (_MPH, 0.44704)):
        if match := pattern.fullmatch(text):
            return float(match[1].replace(",", ".")) * factor
    return None


# --- Road centrelines, road surfaces and keepouts read from their layers into plain arrays ---

DEFAULT_WIDTH_M = 3.5
"""The width of a road where none is known: one lane."""

TOGETHER = 1000
"""Roads that are checked and placed at a time."""

LABEL_FIELDS = {ROAD_CENTRELINE: "surface", ROAD_SURFACE: "surface", KEEPOUT: "name"}
"""The field that labels a feature of each role where no expression does."""

# A named variable: typing caches type variables, and would keep the classes of an unloaded plugin.
Item = TypeVar("Item", bound="Centreline | Area | Surface")


@dataclass
class GroundReading(Generic[Item]):
    """Items in the site frame, and warnings by layer and feature.

    ``complete`` is false if cancelled.
    """

    items: list[Item] = field(default_factory=list)
    notes: FeatureWarnings = field(default_factory=FeatureWarnings)
    complete: bool = True

    @property
    def warnings(self) -> list[str]:
        """The warnings, naming layer and feature."""
        return self.notes.texts()

    def note_layer(self, warnings: Sequence[str]) -> None:
        """Add warnings about a layer as a whole."""
        for warning in warnings:
            self.notes.add_text(warning)


def read_centrelines(
    sources: Sequence[ObstacleSource], site: SiteGeoreference, default_width: float, feedback: QgsFeedback
) -> GroundReading[Centreline]:
    """Return the roads of layers of lines; other geometries are left out with a warning.

    :raises LayerReadingError: when a layer has no known place on the site or an expression is not one.
    """
    reading: GroundReading[Centreline] = GroundReading()
    reading.items += each_centreline(sources, site, default_width, reading, feedback)
    return reading


def each_centreline(
    sources: Sequence[ObstacleSource],
    site: SiteGeoreference,
    default_width: float,
    reading: GroundReading[Centreline],
    feedback: QgsFeedback,
) -> Iterator[Centreline]:
    """Yield the items of :func:`read_centrelines`; ``reading`` receives the warnings and no items."""
    for source in sources:
        unknown = SomeFeatures()
        layer = _GroundLayer(source, site, ROAD_CENTRELINE)
        yield from _roads(layer, default_width, unknown, reading, feedback)
        if unknown.count:
            reading.notes.add_text(
                tr(
                    "Layer {layer}: the width of {count} of its roads is not known and taken as "
                    "{width:g} m (feature {first} is the first)",
                    layer=source.name,
                    count=unknown.count,
                    width=default_width,
                    first=unknown.first[0],
                )
            )


def _roads(
    layer: _GroundLayer,
    default_width: float,
    unknown: SomeFeatures,
    reading: GroundReading[Centreline],
    feedback: QgsFeedback,
) -> Iterator[Centreline]:
    """Yield the roads of one layer; ``unknown`` receives the features of unknown width."""
    values, waiting = _RoadValues(layer), _RoadColumns()
    for row in layer.rows(reading, feedback):
        about = None if row.geometry is None else values.of(row.feature)
        if about is not None and about.width is None:
            unknown.add(row.feature.id())
        waiting.add(row, about)
        if len(waiting.ids) == TOGETHER:
            yield from _placed(waiting, layer, default_width, reading)
            waiting = _RoadColumns()
    yield from _placed(waiting, layer, default_width, reading)
    reading.note_layer(layer.rules.warnings)


class _KnownRoad(NamedTuple):
    """Attributes of a road besides its line, with notes on its width and on the rest."""

    width: float | None
    label: str
    traffic: Traffic
    of_width: Sequence[str]
    of_rest: Sequence[str]


class _RoadValues:
    """Evaluates the attributes of roads of ``layer``."""

    def __init__(self, layer: _GroundLayer) -> None:
        given = layer.source.expressions.width or layer.rules.column(*WIDTH_FIELDS)
        self._layer = layer
        self._width = layer.rules.rule("width", given)
        self._roads = RoadRules(layer.rules, RoadExpressions())
        self._memory = Memory([self._width, layer.label_rule, *self._roads.of_traffic])

    def of(self, feature: QgsFeature) -> _KnownRoad:
        """Return the attributes of ``feature``, which the rules of the layer are set to."""
        known, key = self._layer.rules.known(self._memory)
        if known is UNKNOWN:
            of_width: list[str] = []
            of_rest: list[str] = []
            metres = self._layer.rules.metres("width", self._width, of_width)
            label = self._layer.label(feature, of_rest)
            known = _KnownRoad(metres, label, self._roads.traffic(of_rest), of_width, of_rest)
            self._memory.keep(key, known)
        return cast(_KnownRoad, known)


class _RoadColumns:
    """Features of a layer of roads, a list for each of their properties."""

    def __init__(self) -> None:
        self.ids: list[int] = []
        self.notes: list[Sequence[str]] = []
        self.wkb: list[bytes] = []
        self.about: list[_KnownRoad | None] = []
        """None for those without a geometry."""
        self.points: list[bytes] = []
        self.counts: list[int] = []
        """The number of plain lines of each; ``points`` has those of all."""

    def add(self, row: FeatureRow, about: _KnownRoad | None) -> None:
        wkb = b"" if row.geometry is None else row.geometry.asWkb().data()
        lines = rings_of(wkb) if wkb else None
        points = [] if lines is None or lines.closed else lines.points
        self.ids.append(row.feature.id())
        self.notes.append(tuple(row.notes))
        self.wkb.append(wkb)
        self.about.append(about)
        self.points += points
        self.counts.append(len(points))


def _placed(
    roads: _RoadColumns, layer: _GroundLayer, default_width: float, reading: GroundReading[Centreline]
) -> Iterator[Centreline]:
    """Yield the lines of ``roads``; the plain ones are checked and placed together, which is quick."""
    count = len(roads.ids)
    table = RingTable(roads.points, roads.counts, [False] * count, [True] * count)
    # Values of unsound features, such as NaN, are not read from it.
    with np.errstate(all="ignore"):
        placed = layer.placing.to_site(table.coordinates(table.rings(0, count)))
    for k, (about, is_sound) in enumerate(zip(roads.about, table.sound.tolist(), strict=True)):
        notes, lines = list(roads.notes[k]), []
        if about is not None:
            notes += about.of_width
            if is_sound:
                lines = table.apart(placed, k)
            else:
                lines = list(map(layer.placing.to_site, lines_of(geometry_of(roads.wkb[k]), notes)))
            notes += about.of_rest
            for line in lines:
                yield Centreline(
                    line,
                    about.width or default_width,
                    about.label,
                    direction=about.traffic.direction,
                    speed_ms=about.traffic.speed or DEFAULT_SPEED,
                    closed=about.traffic.closed,
                    level=about.traffic.level,
                )
        layer.add_warnings(roads.ids[k], notes, reading)


def read_areas(
    sources: Sequence[ObstacleSource], site: SiteGeoreference, role: str, feedback: QgsFeedback
) -> GroundReading[Area]:
    """Return the polygons of layers of ``role``; other geometries are left out with a warning.

    :raises LayerReadingError: as :func:`read_centrelines`.
    """
    reading: GroundReading[Area] = GroundReading()
    reading.items += each_area(sources, site, role, reading, feedback)
    return reading


def each_area(
    sources: Sequence[ObstacleSource],
    site: SiteGeoreference,
    role: str,
    reading: GroundReading[Area],
    feedback: QgsFeedback,
) -> Iterator[Area]:
    """Yield the items of :func:`read_areas`; ``reading`` receives the warnings and no items."""
    for source in sources:
        layer = _GroundLayer(source, site, role)
        for rings, label in _polygons(layer, reading, feedback):
            yield Area(rings, label)
        reading.note_layer(layer.rules.warnings)


def read_surfaces(
    sources: Sequence[ObstacleSource], site: SiteGeoreference, feedback: QgsFeedback
) -> GroundReading[Surface]:
    """Return the road surfaces of layers of polygons, with their fields ``name`` and ``origin``.

    One that is not marked as generated was drawn.

    :raises LayerReadingError: as :func:`read_centrelines`.
    """
    reading: GroundReading[Surface] = GroundReading()
    reading.items += each_surface(sources, site, reading, feedback)
    return reading


def each_surface(
    sources: Sequence[ObstacleSource],
    site: SiteGeoreference,
    reading: GroundReading[Surface],
    feedback: QgsFeedback,
) -> Iterator[Surface]:
    """Yield the items of :func:`read_surfaces`; ``reading`` receives the warnings and no items."""
    for source in sources:
        layer = _GroundLayer(source, site, ROAD_SURFACE)
        name, origin = (layer.rules.rule(field, layer.rules.column(field)) for field in ("name", "origin"))
        for rings, label in _polygons(layer, reading, feedback):
            notes: list[str] = []
            made = layer.rules.value("origin", origin, notes) == GENERATED
            called = str(layer.rules.value("name", name, notes) or "")
            yield Surface(rings, label, called, GENERATED if made else DRAWN)
        reading.note_layer(layer.rules.warnings)


def _polygons(
    layer: _GroundLayer, reading: GroundReading, feedback: QgsFeedback
) -> Iterator[tuple[tuple[np.ndarray, ...], str]]:
    """Yield the rings of each polygon, in the site frame, with its label."""
    for feature, geometry in layer.features(reading, feedback):
        shapes, notes = shapes_of(geometry)
        if any(not shape.closed for shape in shapes):
            notes.append(tr("has a line, which is no area; it is left out"))
        label = layer.label(feature, notes)
        layer.add_warnings(feature.id(), notes, reading)
        for rings in polygons_of(shapes):
            yield tuple(layer.placing.to_site(ring) for ring in rings), label


def check_ground_sources(sources: Sequence[ObstacleSource], site: SiteGeoreference, role: str) -> None:
    """Raise :class:`LayerReadingError` for what reading ``sources`` would refuse, without reading."""
    for source in sources:
        rules = _GroundLayer(source, site, role).rules
        rules.rule("width", source.expressions.width)


class _GroundLayer:
    """One layer of roads or areas: its transform, its expressions, its features."""

    def __init__(self, source: ObstacleSource, site: SiteGeoreference, role: str):
        self.source = source
        self.placing: LayerToSiteTransform = site.of_layer(source.name, source.crs)
        self.rules = LayerRules(source.name, source.fields, source.context)
        self._filter = FeatureFilter(source.name, source.fields, source.expressions.filter, source.context)
        column = self.rules.column(LABEL_FIELDS[role])
        self.label_rule = self.rules.rule("semantics", source.expressions.semantics or column)
        self._otherwise = source.name if role == KEEPOUT else ""

    def rows(self, reading: GroundReading, feedback: QgsFeedback) -> Iterator[FeatureRow]:
        """Yield every feature; the rules are set to one with a geometry until the next is requested."""
        source = self.source
        reader = FeatureReader(source.name, source.features, self.placing, self._filter, feedback)
        for row in reader:
            if row.geometry is not None:
                self.rules.at(row.feature)
            yield row
        reading.complete = reading.complete and reader.complete
        if reader.complete:
            check_readable(source)
            reading.note_layer(self.placing.doubts(source.name))

    def features(
        self, reading: GroundReading, feedback: QgsFeedback
    ) -> Iterator[tuple[QgsFeature, QgsGeometry]]:
        """Yield each feature that counts with its geometry in metres; warn of those without one."""
        for row in self.rows(reading, feedback):
            self.add_warnings(row.feature.id(), row.notes, reading)
            if row.geometry is not None:
                yield row.feature, row.geometry

    def label(self, feature: QgsFeature, notes: list[str]) -> str:
        """Return the label of the feature that was yielded last."""
        value = self.rules.value("semantics", self.label_rule, notes)
        return self._otherwise if value is None else str(value)

    def add_warnings(self, id: int, notes: Sequence[str], reading: GroundReading) -> None:
        """Add warnings about the feature with this id."""
        for note in notes:
            reading.notes.add(self.source.name, id, note)


def lines_of(geometry: QgsGeometry, notes: list[str]) -> list[np.ndarray]:
    """Return the lines of ``geometry`` that have a length, (n, 2) each; curves as chords."""
    rings = rings_of(geometry.asWkb().data())
    if rings is not None and not rings.closed:
        plain = GeometryParts(
            [], [np.frombuffer(points, "<f8").reshape(-1, 2) for points in rings.points], []
        )
        return _lines_in(plain, notes)
    if geometry.constGet().hasCurvedSegments():
        maximum = QgsAbstractGeometry.SegmentationToleranceType.MaximumDifference
        geometry = QgsGeometry(geometry.constGet().segmentize(SAGITTA_M, maximum))
    return _lines_in(parts_of(geometry), notes)


def _lines_in(parts: GeometryParts, notes: list[str]) -> list[np.ndarray]:
    notes += parts.notes
    if not parts.on_earth:
        notes.append(NO_PLACE)
        return []
    if parts.polygons:
        notes.append(tr("has a polygon, which is no centreline; it is left out"))
    lines, line_notes = lines_with_length(parts.lines)
    notes += line_notes
    return lines


# --- Roads that lead through keepout areas, found by QGIS's own geometry ---

Floats = npt.NDArray[np.float64]


def edges_through(network: Network, areas: Sequence[Sequence[Floats]]) -> list[int]:
    """Return the edges that enter one of ``areas``, each an outer ring and its holes, (n, 2) each.

    An edge along the boundary enters none.
    """
    if not len(network):
        return []
    lines = [network.edges.line(edge) for edge in range(len(network))]
    lowest = np.array([line.min(axis=0) for line in lines])
    highest = np.array([line.max(axis=0) for line in lines])
    found: set[int] = set()
    for rings in areas:
        area = QgsGeometry.fromPolygonXY([_points(ring) for ring in rings]).makeValid()
        engine = QgsGeometry.createGeometryEngine(area.constGet())
        engine.prepareGeometry()
        near = (lowest <= rings[0].max(axis=0)).all(axis=1) & (highest >= rings[0].min(axis=0)).all(axis=1)
        for edge in np.flatnonzero(near).tolist():
            line = QgsGeometry.fromPolylineXY(_points(lines[edge]))
            if engine.crosses(line.constGet()) or engine.contains(line.constGet()):
                found.add(edge)
    return sorted(found)


def _points(xy: Floats) -> list[QgsPointXY]:
    return [QgsPointXY(x, y) for x, y in xy.tolist()]
