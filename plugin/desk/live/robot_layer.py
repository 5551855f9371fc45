"""The robots as an ordinary vector layer: attribute table, identify, labels, styling, printing."""

from __future__ import annotations

from collections.abc import Iterable

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsMapLayerStyle,
    QgsProject,
    QgsVectorLayer,
)
from qgis.gui import QgsMapCanvas
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import RobotState, SiteReport
from ....robot_bridge.sites.frame import SiteFrame
from ...sites.fleet_group import fleet_group, leave_clean, remove_if_empty
from ..live_layers import give_style, make_live
from ..picture import RobotPicture
from ..placement import frame_of
from .robot_features import AGE_AT, NAME_AT, STATE_AT, RobotFeature, features_of, geometry_at, made_layer

KIND = "robots"
AT_ONCE = 100
"""Robots that are written in one go; more take several, so that the window does not wait for them."""


class RobotLayer(QObject):
    """A memory layer in the site's CRS, in the group "Fleet", kept up to date by writes to its provider.

    The way a user has styled it lasts as long as the project, saved with it.
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
        self._written: dict[str, RobotFeature] = {}
        self._waiting = range(0)
        self._marking = False
        self.is_new = False
        """Whether the last write brought robots that were not there before."""

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none (or its project was closed)."""
        return self._layer

    def show_site(self, site: SiteReport) -> None:
        """Make the layer for ``site``, in place of one for another site."""
        frame = frame_of(site)
        if self._layer is not None and frame == self._frame:
            return
        self.remove()
        self._frame = frame
        was_dirty = self._project.isDirty()
        self._layer = made_layer(QgsCoordinateReferenceSystem(site.crs))
        make_live(self._layer, KIND)
        if self._style is not None:
            self._style.writeToLayer(self._layer)
        else:
            give_style(self._project, self._layer)
        self._layer.willBeDeleted.connect(self._gone)
        self._layer.selectionChanged.connect(self._selection_changed)
        self._project.addMapLayer(self._layer, False)
        fleet_group(self._project).insertLayer(0, self._layer)
        leave_clean(self._project, was_dirty)

    def begin(self, robots: int) -> None:
        """Have every one of the first ``robots`` rows written, unless the last round is still under way."""
        if not self._waiting:
            self._waiting = range(robots)

    def go_on(self, picture: RobotPicture, now: float) -> None:
        """Write some of those that wait; the canvas takes it up when all are written."""
        self.is_new = False
        if self._layer is None or not self._waiting:
            return
        rows, self._waiting = self._waiting[:AT_ONCE], self._waiting[AT_ONCE:]
        self._write(features_of(picture, now, slice(rows.start, rows.stop), self._frame))
        if not self._waiting:
            self._show_written()

    def drop(self, robots: Iterable[str]) -> None:
        """Take robots out of the layer that are there no more."""
        known = [robot for robot in robots if robot in self._ids]
        if self._layer is not None and known:
            self._marking = True
            self._layer.dataProvider().deleteFeatures([self._ids[robot] for robot in known])
            self._marking = False
            self._show_written()
        for robot in known:
            del self._ids[robot], self._written[robot]
        # A round that is under way goes by rows that are others' now.
        self._waiting = range(0)

    def clear(self) -> None:
        """Take every robot out of the layer."""
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
        """Take the layer and, when nothing else is in it, the group out of the project."""
        if self._layer is None:
            return
        was_dirty = self._project.isDirty()
        layer, self._layer = self._layer, None
        self._forget()
        if not sip.isdeleted(layer):
            self._keep_style(layer)
            layer.willBeDeleted.disconnect(self._gone)
            layer.selectionChanged.disconnect(self._selection_changed)
            self._project.removeMapLayer(layer.id())
        remove_if_empty(self._project)
        leave_clean(self._project, was_dirty)

    def _write(self, features: list[RobotFeature]) -> None:
        """Write what is not in the layer yet, and no value that is: the provider looks at each one given."""
        attributes, geometries, new = {}, {}, []
        for feature in features:
            name = feature.values[NAME_AT]
            before = self._written.get(name)
            if before is None:
                new.append(feature)
                continue
            changed = feature.since(before)
            has_moved = feature.place != before.place
            if not has_moved and (not changed or _is_only_age(feature, changed)):
                continue
            self._written[name] = feature
            if changed:
                attributes[self._ids[name]] = changed
            if has_moved:
                geometries[self._ids[name]] = geometry_at(feature.place)
        if attributes or geometries:
            self._layer.dataProvider().changeFeatures(attributes, geometries)
        if new:
            self._add(new)

    def _add(self, features: list[RobotFeature]) -> None:
        made = []
        for feature in features:
            made.append(QgsFeature(self._layer.fields()))
            made[-1].setAttributes(feature.values)
            made[-1].setGeometry(geometry_at(feature.place))
        _, stored = self._layer.dataProvider().addFeatures(made)
        for feature, in_layer in zip(features, stored, strict=True):
            self._ids[feature.values[NAME_AT]] = in_layer.id()
            self._written[feature.values[NAME_AT]] = feature
        self._layer.updateExtents()
        self.is_new = True

    def _show_written(self) -> None:
        # A canvas that is still drawing would begin anew and, on a slow map, never come to its end.
        self._layer.triggerRepaint(self._canvas.isDrawing())
        # An attribute table learns of writes in no other way; to look whether one is open takes 40 ms.
        self._layer.dataChanged.emit()

    def _keep_style(self, layer: QgsVectorLayer) -> None:
        self._style = QgsMapLayerStyle()
        self._style.readFromLayer(layer)

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


def _is_only_age(feature: RobotFeature, changed: Iterable[int]) -> bool:
    """Tell whether it is only the age of a robot that talks: not worth writing all of them anew."""
    return feature.values[STATE_AT] == RobotState.FRESH.value and set(changed) == {AGE_AT}
