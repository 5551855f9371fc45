"""The robots as an ordinary vector layer: attribute table, identify, labels, styling, printing."""

from __future__ import annotations

import math
from collections.abc import Sequence

from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsLayerTreeGroup,
    QgsMarkerSymbol,
    QgsPointXY,
    QgsProject,
    QgsRendererCategory,
    QgsVectorLayer,
)
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.messages import SiteReport
from ...robot_bridge.sites.frame import SiteFrame
from .colours import STATE_COLOURS
from .picture import STATES, RobotView

GROUP = "Fleet"
NAME = "Robots (live)"
MARK = "fleet/live"
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
)


class RobotLayer(QObject):
    """A memory layer in the site's CRS, in the group "Fleet", kept up to date by writes to its provider."""

    robot_selected = pyqtSignal(str)
    """The user selected a robot by QGIS's own means: on the map or in the attribute table."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._layer: QgsVectorLayer | None = None
        self._frame: SiteFrame | None = None
        self._ids: dict[str, int] = {}
        self._marking = False

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none (or its project was closed)."""
        return self._layer

    def show_site(self, site: SiteReport) -> None:
        """Make the layer for ``site``, in place of one for another site."""
        frame = SiteFrame(site.crs, site.origin, site.rotation)
        if self._layer is not None and frame == self._frame:
            return
        self.remove()
        self._frame = frame
        was_dirty = self._project.isDirty()
        self._remove_saved_ones()
        self._layer = _made(QgsCoordinateReferenceSystem(site.crs))
        self._layer.willBeDeleted.connect(self._gone)
        self._layer.selectionChanged.connect(self._selection_changed)
        self._project.addMapLayer(self._layer, False)
        self._group().insertLayer(0, self._layer)
        self._leave_clean(was_dirty)

    def update_robots(self, views: Sequence[RobotView]) -> None:
        """Write the robots as they are; those without a pose have no geometry."""
        if self._layer is None or self._frame is None:
            return
        provider = self._layer.dataProvider()
        attributes, geometries, added = {}, {}, []
        for view in views:
            values, geometry = self._row(view)
            if view.name in self._ids:
                attributes[self._ids[view.name]] = dict(enumerate(values))
                geometries[self._ids[view.name]] = geometry
            else:
                feature = QgsFeature(self._layer.fields())
                feature.setAttributes(values)
                feature.setGeometry(geometry)
                added.append(feature)
        if attributes:
            provider.changeFeatures(attributes, geometries)
        if added:
            _, stored = provider.addFeatures(added)
            self._ids.update({feature["robot"]: feature.id() for feature in stored})
            self._layer.updateExtents()
        self._layer.triggerRepaint()

    def clear(self) -> None:
        """Take every robot out of the layer."""
        if self._layer is not None and self._ids:
            self._layer.dataProvider().truncate()
            self._layer.triggerRepaint()
        self._ids.clear()

    def mark(self, robot: str | None) -> None:
        """Select ``robot`` in the layer."""
        if self._layer is None:
            return
        self._marking = True
        self._layer.selectByIds([self._ids[robot]] if robot in self._ids else [])
        self._marking = False

    def remove(self) -> None:
        """Take the layer and, when nothing else is in it, the group out of the project."""
        if self._layer is None:
            return
        was_dirty = self._project.isDirty()
        layer, self._layer = self._layer, None
        self._ids.clear()
        if not sip.isdeleted(layer):
            layer.willBeDeleted.disconnect(self._gone)
            layer.selectionChanged.disconnect(self._selection_changed)
            self._project.removeMapLayer(layer.id())
        group = self._project.layerTreeRoot().findGroup(GROUP)
        if group is not None and not group.children():
            group.parent().removeChildNode(group)
        self._leave_clean(was_dirty)

    def _leave_clean(self, was_dirty: bool) -> None:
        """A layer that comes anew with each link is no change that the user would want to save."""
        if was_dirty:
            return
        self._project.setDirty(False)
        # QGIS's layer panel notes a change once more when it has laid out the new group.
        project = self._project
        QTimer.singleShot(0, lambda: project.setDirty(False))

    def _group(self) -> QgsLayerTreeGroup:
        root = self._project.layerTreeRoot()
        return root.findGroup(GROUP) or root.insertGroup(0, GROUP)

    def _remove_saved_ones(self) -> None:
        """A project saved while the desk was open comes back with a layer that nobody fills."""
        for layer in list(self._project.mapLayers().values()):
            if layer.customProperty(MARK):
                self._project.removeMapLayer(layer.id())

    def _row(self, view: RobotView) -> tuple[list, QgsGeometry]:
        report = view.report
        values = [
            report.robot,
            view.state.value,
            report.theta,
            self._compass(report.theta),
            report.v,
            report.battery,
            report.status,
            round(view.age, 1),
            report.link,
            report.command,
        ]
        if not view.has_pose:
            return values, QgsGeometry()
        ((x, y),) = self._frame.to_crs([(report.x, report.y)])
        return values, QgsGeometry.fromPointXY(QgsPointXY(x, y))

    def _compass(self, theta: float | None) -> float | None:
        if theta is None:
            return None
        return round((90.0 - math.degrees(self._frame.heading_to_crs(theta))) % 360.0, 2)

    def _selection_changed(self, selected: list[int]) -> None:
        if self._marking or len(selected) != 1:
            return
        for robot, feature_id in self._ids.items():
            if feature_id == selected[0]:
                self.robot_selected.emit(robot)

    def _gone(self) -> None:
        self._layer = None
        self._ids.clear()


def _made(crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
    fields = "&".join(f"field={field}" for field in FIELDS)
    layer = QgsVectorLayer(f"Point?{fields}", NAME, "memory")
    layer.setCrs(crs)
    layer.setDisplayExpression("\"robot\" || ' · ' || \"state\"")
    layer.setCustomProperty(MARK, True)
    # QGIS would ask on closing whether the layer's contents may be lost; they come anew each second.
    layer.setCustomProperty("skipMemoryLayersCheck", 1)
    layer.setRenderer(_renderer())
    return layer


def _renderer() -> QgsCategorizedSymbolRenderer:
    """Small dots: the live picture over the map draws the robots themselves."""
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
        categories.append(QgsRendererCategory(state.value, symbol, state.value))
    return QgsCategorizedSymbolRenderer("state", categories)
