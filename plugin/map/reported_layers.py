"""Layers of the gateway's reports: robots, closed roads, conflicts, placed cones."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from itertools import compress
from operator import ne
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsCoordinateReferenceSystem,
    QgsExpression,
    QgsFeature,
    QgsGeometry,
    QgsLineSymbol,
    QgsMapLayerStyle,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsProject,
    QgsRendererCategory,
    QgsSingleSymbolRenderer,
    QgsTextFormat,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.gui import QgsMapCanvas
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.geometry import headings_of
from ...robot_bridge.core.messages.administration import SiteReport
from ...robot_bridge.core.messages.commands import CommandReport
from ...robot_bridge.core.messages.roads import ClosureReport, ConflictReport
from ...robot_bridge.core.messages.safety import RobotState
from ...robot_bridge.core.sites.frame import SiteFrame
from ..gateway_client.command_cache import is_cone_put_down
from ..gateway_client.fleet_state import FleetState, ReportedCone
from ..gateway_client.robot_states import STATES, RobotStates
from ..gateway_client.state_words import ROBOT_STATES
from ..layers import live_layers
from ..layers.site_transform import frame_of, points_of
from ..ui.glyphs import STATE_COLOURS
from ..ui.language import date_and_time, time_of_day, tr

NAME = tr("Robots (live)")
FIELDS = (
    "robot:string",
    "state:string",
    "theta:double",
    "heading_deg:double",
    "v:double",
    "battery:double",
    "status:string",
    "age:double",
    "link:string",
    "command:string",
    "accuracy:double",
)
ALIASES = (
    tr("Robot"),
    tr("State"),
    tr("Theta (rad)"),
    tr("Heading (°)"),
    tr("Speed (m/s)"),
    tr("Battery (0 to 1)"),
    tr("Status"),
    tr("Age (s)"),
    tr("Link"),
    tr("Command"),
    tr("Accuracy (m)"),
)
"""Display names of :data:`FIELDS`; expressions use the fields' own names."""
LABEL_OFFSET_MM = 6.5
"""Distance of a label below its robot: the overlay's arrow and name are above that."""
_STATE_WORDS = [state.value for state in STATES]
NAME_AT, STATE_AT, AGE_AT = (FIELDS.index(field) for field in ("robot:string", "state:string", "age:double"))


class RobotFeatures(NamedTuple):
    """Some robots as shown by the layer: for each of :data:`FIELDS` their values; (n, 2) places in the
    site's CRS, not finite where not known."""

    values: list[list[Any]]
    places: npt.NDArray[np.float64]

    @property
    def names(self) -> list[str]:
        """The robots' names."""
        return self.values[NAME_AT]

    def since(self, before: RobotFeatures) -> tuple[dict[int, dict[int, Any]], list[int]]:
        """Return by robot the values that differ from ``before``, by their fields' indices; and which
        of them have moved."""
        changed: dict[int, dict[int, Any]] = defaultdict(dict)
        for at, (column, was) in enumerate(zip(self.values, before.values, strict=True)):
            # Most columns are unchanged, which Python detects at once.
            if column != was:
                for robot in compress(range(len(column)), map(ne, column, was)):
                    changed[robot][at] = column[robot]
        place, was_at = self.places, before.places
        # NaN is equal to nothing.
        is_other = (place != was_at) & ((place == place) | (was_at == was_at))
        return changed, np.flatnonzero(is_other[:, 0] | is_other[:, 1]).tolist()

    def is_only_age(self, robot: int, changed: Iterable[int]) -> bool:
        """Return whether only the age of a reporting robot changed: not worth writing all of them again."""
        return self.values[STATE_AT][robot] == RobotState.FRESH.value and [*changed] == [AGE_AT]


def made_layer(crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
    """Return an empty memory layer in ``crs``."""
    fields = "&".join(f"field={field}" for field in FIELDS)
    layer = QgsVectorLayer(f"Point?{fields}", NAME, "memory")
    layer.setCrs(crs)
    layer.setDisplayExpression('"robot" || \' · \' || "state"')
    layer.setRenderer(_renderer())
    for at, alias in enumerate(ALIASES):
        layer.setFieldAlias(at, alias)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(_labels()))
    layer.setLabelsEnabled(False)
    return layer


def _labels() -> QgsPalLayerSettings:
    """Return the style of labels once the user switches them on: legible, and beside the overlay's."""
    labels = QgsPalLayerSettings()
    labels.fieldName = "state"
    labels.placement = QgsPalLayerSettings.Placement.OverPoint
    labels.yOffset = LABEL_OFFSET_MM
    looks = QgsTextFormat()
    looks.setSize(9)
    around = looks.buffer()
    around.setEnabled(True)
    looks.setBuffer(around)
    labels.setFormat(looks)
    return labels


def features_of(picture: RobotStates, now: float, rows: slice, frame: SiteFrame) -> RobotFeatures:
    """Return the layer's features at ``now`` for the robots in ``rows`` of ``picture``."""
    robots = picture.arrays(now, rows)
    turn = frame.theta_to_crs(0.0)
    columns = [
        robots.names,
        [_STATE_WORDS[state] for state in robots.state.tolist()],
        _or_none(robots.theta),
        _or_none(np.round(headings_of(robots.theta + turn), 2)),
        _or_none(robots.v),
        _or_none(picture.column("battery")[rows]),
        [text or None for text in picture.texts("status", rows)],
        np.round(robots.age, 1).tolist(),
        picture.texts("link", rows),
        [text or None for text in picture.texts("command", rows)],
        _or_none(robots.accuracy),
    ]
    return RobotFeatures(columns, frame.to_crs(robots.xy))


def geometries_of(places: npt.NDArray[np.float64]) -> list[QgsGeometry]:
    """Return (n, 2) ``places`` as points, an empty geometry for one that is not finite."""
    is_there = np.isfinite(places).all(axis=1)
    if is_there.all():
        return points_of(places)
    points = iter(points_of(places[is_there]))
    return [next(points) if there else QgsGeometry() for there in is_there.tolist()]


def _or_none(column: npt.NDArray[np.float64]) -> list[float | None]:
    values = column.tolist()
    return [None if value != value else value for value in values] if np.isnan(column).any() else values


def _renderer() -> QgsCategorizedSymbolRenderer:
    """Small dots: the overlay draws the robots themselves."""
    categories = []
    for state in STATES:
        symbol = QgsMarkerSymbol.createSimple(
            {
                "name": "circle",
                "color": STATE_COLOURS[state].name(),
                "outline_color": "#ffffff",
                "outline_width": "0.3",
                "size": "1.6",
            }
        )
        categories.append(QgsRendererCategory(state.value, symbol, ROBOT_STATES[state]))
    return QgsCategorizedSymbolRenderer("state", categories)


KIND = "robots"
AT_ONCE = 100
"""Robots that are written at once; more take several events, so that the window does not block."""


class RobotLayer(QObject):
    """A memory layer in the site's CRS, in the group "Fleet", kept up to date by writes to its provider.

    The style set by the user lasts as long as the project, and is saved with it.
    """

    robots_selected = pyqtSignal(list)
    """The user selected robots by QGIS's own means: on the map or in the attribute table."""

    def __init__(self, project: QgsProject, canvas: QgsMapCanvas, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._canvas = canvas
        self._layer: QgsVectorLayer | None = None
        self._frame: SiteFrame | None = None
        self._style: QgsMapLayerStyle | None = None
        self._ids: dict[str, int] = {}
        self._written: dict[int, RobotFeatures] = {}
        """The layer's content for each batch of robots, by the row of the first."""
        self._waiting = range(0)
        self._marking = False
        self.is_new = False
        """Whether the last write added robots."""

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none (or its project was closed)."""
        return self._layer

    def show_site(self, site: SiteReport) -> None:
        """Create the layer for ``site``, in place of one for another site."""
        frame = frame_of(site)
        if self._layer is not None and frame == self._frame:
            return
        if self._layer is not None and not sip.isdeleted(self._layer):
            self._style = QgsMapLayerStyle()
            self._style.readFromLayer(self._layer)
        self.remove()
        self._frame = frame
        was_dirty = self._project.isDirty()
        self._layer = made_layer(QgsCoordinateReferenceSystem(site.crs))
        live_layers.make_live(self._layer, KIND)
        if self._style is not None:
            self._style.writeToLayer(self._layer)
        else:
            live_layers.apply_style(self._project, self._layer)
        self._layer.willBeDeleted.connect(self._gone)
        self._layer.selectionChanged.connect(self._selection_changed)
        self._project.addMapLayer(self._layer, False)
        live_layers.fleet_group(self._project).insertLayer(0, self._layer)
        live_layers.leave_clean(self._project, was_dirty)

    def begin(self, robots: int) -> None:
        """Start writing the first ``robots`` rows, unless the last round is still under way."""
        if not self._waiting:
            self._waiting = range(robots)

    def go_on(self, picture: RobotStates, now: float) -> None:
        """Write some of the pending rows; the canvas is updated when all are written."""
        self.is_new = False
        if self._layer is None or not self._waiting:
            return
        rows, self._waiting = self._waiting[:AT_ONCE], self._waiting[AT_ONCE:]
        self._write(rows.start, features_of(picture, now, slice(rows.start, rows.stop), self._frame))
        if not self._waiting:
            self._show_written()

    def drop(self, robots: Iterable[str]) -> None:
        """Remove robots from the layer that no longer exist."""
        known = [robot for robot in robots if robot in self._ids]
        if self._layer is not None and known:
            self._marking = True
            self._layer.dataProvider().deleteFeatures([self._ids[robot] for robot in known])
            self._marking = False
            self._show_written()
        for robot in known:
            del self._ids[robot]
        # The rows of a round under way, and those already written, are other robots' now.
        self._waiting = range(0)
        self._written.clear()

    def clear(self) -> None:
        """Remove every robot from the layer."""
        if self._layer is not None and self._ids:
            self._marking = True
            self._layer.removeSelection()
            self._marking = False
            self._layer.dataProvider().truncate()
            self._show_written()
        self._forget()

    def mark(self, robots: Iterable[str]) -> None:
        """Select ``robots`` in the layer, and no others."""
        if self._layer is None:
            return
        ids = [self._ids[robot] for robot in robots if robot in self._ids]
        if set(ids) == set(self._layer.selectedFeatureIds()):
            return
        self._marking = True
        self._layer.selectByIds(ids)
        self._marking = False

    def remove(self) -> None:
        """Remove the layer and, when nothing else is in it, the group from the project."""
        if self._layer is None:
            return
        was_dirty = self._project.isDirty()
        layer, self._layer = self._layer, None
        self._forget()
        if not sip.isdeleted(layer):
            layer.willBeDeleted.disconnect(self._gone)
            layer.selectionChanged.disconnect(self._selection_changed)
            self._project.removeMapLayer(layer.id())
        live_layers.remove_if_empty(self._project)
        live_layers.leave_clean(self._project, was_dirty)

    def _write(self, first: int, robots: RobotFeatures) -> None:
        """Write new and changed values only: the provider processes each one given."""
        ids = [*map(self._ids.get, robots.names)]
        changed, moved = self._changes(first, robots)
        self._written[first] = robots
        new = [robot for robot, fid in enumerate(ids) if fid is None]
        if new:
            changed = {robot: changed[robot] for robot in changed if ids[robot] is not None}
            moved = [robot for robot in moved if ids[robot] is not None]
        if changed or moved:
            attributes = {ids[robot]: values for robot, values in changed.items()}
            geometries = geometries_of(robots.places.take(moved, axis=0))
            places = dict(zip([ids[robot] for robot in moved], geometries, strict=True))
            self._layer.dataProvider().changeFeatures(attributes, places)
        if new:
            self._add(robots, new)

    def _changes(self, first: int, robots: RobotFeatures) -> tuple[dict[int, dict[int, Any]], list[int]]:
        """Return the changes of ``robots`` against the layer: as :meth:`RobotFeatures.since`, without those
        of which only the age has changed; that stays as written."""
        before = self._written.get(first)
        if before is None or before.names != robots.names:
            # Other robots were in these rows: the layer's values of each are not at hand.
            everything = enumerate(zip(*robots.values, strict=True))
            changed = {robot: dict(enumerate(values)) for robot, values in everything}
            return changed, [*changed]
        changed, moved = robots.since(before)
        for robot in changed.keys() - moved:
            if robots.is_only_age(robot, changed[robot]):
                robots.values[AGE_AT][robot] = before.values[AGE_AT][robot]
                del changed[robot]
        return changed, moved

    def _add(self, robots: RobotFeatures, new: list[int]) -> None:
        # Features with fields take twice as long to create; the provider knows the fields.
        made, values = [QgsFeature() for _ in new], [*zip(*robots.values, strict=True)]
        for feature, robot, geometry in zip(made, new, geometries_of(robots.places[new]), strict=True):
            feature.setAttributes([*values[robot]])
            feature.setGeometry(geometry)
        _, stored = self._layer.dataProvider().addFeatures(made)
        for robot, in_layer in zip(new, stored, strict=True):
            self._ids[robots.names[robot]] = in_layer.id()
        self._layer.updateExtents()
        self.is_new = True

    def _show_written(self) -> None:
        # A canvas that is still drawing would start again and, on a slow map, never finish.
        self._layer.triggerRepaint(self._canvas.isDrawing())
        # An attribute table learns of writes in no other way; checking whether one is open takes 40 ms.
        self._layer.dataChanged.emit()

    def _selection_changed(self, selected: list[int]) -> None:
        if self._marking:
            return
        chosen = set(selected)
        self.robots_selected.emit([robot for robot, fid in self._ids.items() if fid in chosen])

    def _gone(self) -> None:
        self._layer = self._style = None
        self._forget()

    def _forget(self) -> None:
        self._ids.clear()
        self._written.clear()
        self._waiting = range(0)


LABEL_MM = 1.5
CLOSED_FIELDS = "closure:string,reason:string,closed_by:string,closed_at:string,until:string,edges:integer"
CONFLICT_FIELDS = (
    "robot:string,other:string,kind:string,begins:string,nearest_at:string,ends:string,metres:double"
)


class RoadLayers(QObject):
    """A layer of closed roads and one of conflicts, created when needed and removed with the plugin."""

    def __init__(self, state: FleetState, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._state = state
        self._closures = live_layers.RowLayer(
            project, "closed_roads", tr("Closed roads"), "LineString", CLOSED_FIELDS, _style_closures
        )
        self._conflicts = live_layers.RowLayer(
            project, "conflicts", tr("Conflicts"), "Point", CONFLICT_FIELDS, _style_conflicts
        )
        state.closures_changed.connect(self._show_closures)
        state.conflicts_changed.connect(self._show_conflicts)
        state.site_changed.connect(self._show)

    def remove(self) -> None:
        """Remove both from the project."""
        self._closures.remove()
        self._conflicts.remove()

    def _show(self) -> None:
        self._show_closures()
        self._show_conflicts()

    def _show_closures(self) -> None:
        rows = [(closure.line, _closure_values(closure)) for closure in self._state.closures]
        self._closures.show(rows, self._state.site)

    def _show_conflicts(self) -> None:
        conflicts = self._state.conflicts.conflicts
        rows = [([(one.x, one.y)], _conflict_values(one)) for one in conflicts]
        self._conflicts.show(rows, self._state.site)


def _closure_values(closure: ClosureReport) -> list[Any]:
    reason, since, until = closure.reason or "", date_and_time(closure.closed_at), time_of_day(closure.until)
    return [closure.closure, reason, closure.closed_by, since, until, closure.edges]


def _conflict_values(one: ConflictReport) -> list[Any]:
    times = [time_of_day(at) for at in (one.begins, one.nearest_at, one.ends)]
    return [one.robot, one.other, one.kind, *times, one.metres]


def _style_closures(layer: QgsVectorLayer) -> None:
    line = {"line_color": "198,40,40,255", "line_width": "1.6", "line_style": "solid", "capstyle": "round"}
    symbol = QgsLineSymbol.createSimple(line)
    symbol.appendSymbolLayer(
        QgsLineSymbol.createSimple(
            {"line_color": "255,255,255,255", "line_width": "0.6", "line_style": "dash"}
        ).takeSymbolLayer(0)
    )
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    closed = QgsExpression.quotedString(tr("closed"))
    until = QgsExpression.quotedString(tr("until"))
    words = (
        f"{closed} || if(reason != '', ': ' || reason, '')"
        f" || if(until != '', ', ' || {until} || ' ' || until, '')"
    )
    live_layers.label(layer, words, QgsPalLayerSettings.Placement.Line, LABEL_MM)


def _style_conflicts(layer: QgsVectorLayer) -> None:
    mark = {
        "name": "triangle",
        "color": "255,193,7,255",
        "outline_color": "33,33,33,255",
        "outline_width": "0.5",
        "size": "6",
    }
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(mark)))
    words = "robot || ' × ' || other || ' ' || nearest_at"
    live_layers.label(layer, words, QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint, LABEL_MM)


PLACED_CONE_FIELDS = "robot:string,label:string,placed_at:string,deviation_m:double"
MOST = 2000
"""Cones that are shown: if there are more, the newest."""


class StandingCones(QObject):
    """A layer of the cones of :meth:`.FleetState.standing_cones`, which :meth:`remove` removes."""

    def __init__(self, state: FleetState, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._state = state
        self._layer = live_layers.RowLayer(
            project, "standing_cones", tr("Cones put down"), "Point", PLACED_CONE_FIELDS, _style_cones
        )
        state.commands_changed.connect(self._commands_changed)
        state.placed_cones_changed.connect(self._show)
        state.site_changed.connect(self._show)

    def remove(self) -> None:
        """Remove the layer from the project."""
        self._layer.remove()

    def _commands_changed(self, reports: Iterable[CommandReport]) -> None:
        if any(map(is_cone_put_down, reports)):
            self._show()

    def _show(self, *_: object) -> None:
        self._layer.show(list(map(_cone_row, self._state.standing_cones()[-MOST:])), self._state.site)


def _cone_row(cone: ReportedCone) -> live_layers.Row:
    return [(cone.x, cone.y)], [cone.robot, cone.label, date_and_time(cone.placed_at), cone.deviation]


def _style_cones(layer: QgsVectorLayer) -> None:
    mark = {
        "name": "triangle",
        "color": "242,106,27,255",
        "outline_color": "255,255,255,255",
        "outline_width": "0.4",
        "size": "3.6",
    }
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(mark)))
