"""Layers filled while connected, with a feature for each row; kept out of the project's file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsLayerTreeGroup,
    QgsLineString,
    QgsMapLayer,
    QgsMapLayerStyle,
    QgsPalLayerSettings,
    QgsPoint,
    QgsProject,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtXml import QDomDocument, QDomElement, QDomNode

from ...robot_bridge.core.messages.administration import SiteReport
from ...robot_bridge.core.sites.frame import SiteFrame
from ..ui.scheduling import CooperativeTask, Steps
from .site_transform import frame_of

# --- Detects when QGIS is reading a project, and when another one is open ---


class ProjectWatch(QObject):
    """While a project is read QGIS lets timers run, and crashes if one of them touches its layers."""

    opened = pyqtSignal()
    """Another project is open, read to its end or new, and has none of the layers before."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._is_cleared = False
        # Other receivers of the signal run first; a project from a file is not read yet.
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(0)
        self._soon.timeout.connect(self._announce)
        project.cleared.connect(self._cleared)
        project.readProject.connect(self._read)
        project.projectSaved.connect(self._complete)

    def remove(self) -> None:
        """Disconnect from the project: it outlives the plugin, and keeps each connection."""
        self._soon.stop()
        self._project.cleared.disconnect(self._cleared)
        self._project.readProject.disconnect(self._read)
        self._project.projectSaved.disconnect(self._complete)

    @property
    def is_reading(self) -> bool:
        """Whether layers are being read: a project that is new has no file yet."""
        return self._is_cleared and bool(self._project.fileName())

    def _cleared(self) -> None:
        self._is_cleared = True
        self._soon.start()

    def _read(self, *_: object) -> None:
        self._complete()
        self._soon.start()

    def _complete(self, *_: object) -> None:
        self._is_cleared = False

    def _announce(self) -> None:
        if not self.is_reading:
            self.opened.emit()


# --- Layers that the desk fills while it is connected: in the project, and never in its file ---

MARK = "fleet/live"
"""The custom property of a layer whose content is created again with each connection."""
SCOPE = "fleet_supervisor"
NOT_A_LAYER = "fleet-live"


class LiveLayers(QObject):
    """Keeps layers with :data:`MARK` out of the files of a project, and their styles in them.

    An older file, or one of another program, may contain such a layer: nobody would fill it, so it is
    removed when the project is read. :meth:`remove` undoes the constructor.
    """

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        project.writeProject.connect(self._leave_out_of_tree)
        project.writeMapLayer.connect(self._leave_out)
        project.readProject.connect(self._remove_layers)

    def remove(self) -> None:
        """Disconnect from the project's reading and writing."""
        self._project.writeProject.disconnect(self._leave_out_of_tree)
        self._project.writeMapLayer.disconnect(self._leave_out)
        self._project.readProject.disconnect(self._remove_layers)

    def _leave_out_of_tree(self, document: QDomDocument) -> None:
        left_out = {layer.id() for layer in live_layers(self._project)}
        for layer in live_layers(self._project):
            keep_style(self._project, layer)
        groups = []
        for tag in ("layer-tree-layer", "layer-setting"):
            for node in _elements(document, tag):
                if node.attribute("id") in left_out:
                    groups.append(node.parentNode())
                    node.parentNode().removeChild(node)
        for item in _elements(document, "item"):
            if item.parentNode().nodeName() == "custom-order" and item.text() in left_out:
                item.parentNode().removeChild(item)
        for group in groups:
            _remove_if_empty(group)

    def _leave_out(self, layer: QgsMapLayer, element: QDomElement, _document: QDomDocument) -> None:
        if not layer.customProperty(MARK):
            return
        # QGIS adds the element to the document after this, and reads back only elements named maplayer.
        element.setTagName(NOT_A_LAYER)
        while element.hasChildNodes():
            element.removeChild(element.firstChild())
        attributes = element.attributes()
        for name in [attributes.item(k).nodeName() for k in range(attributes.count())]:
            element.removeAttribute(name)

    def _remove_layers(self, *_: object) -> None:
        was_dirty = self._project.isDirty()
        for layer in live_layers(self._project):
            keep_style(self._project, layer)
            node = self._project.layerTreeRoot().findLayer(layer.id())
            group = node.parent() if node is not None else None
            self._project.removeMapLayer(layer.id())
            if group is not None and group.parent() is not None and not group.children():
                above: QgsLayerTreeGroup = group.parent()
                above.removeChildNode(group)
        self._project.setDirty(was_dirty)


def make_live(layer: QgsVectorLayer, kind: str) -> None:
    """Mark ``layer`` as one that only the desk fills with ``kind``.

    It cannot be edited, as drawn robots would look like real ones, and QGIS does not
    ask on closing whether its contents may be lost.
    """
    layer.setCustomProperty(MARK, kind)
    layer.setCustomProperty("skipMemoryLayersCheck", 1)
    layer.setReadOnly(True)
    _escape_map_tip(layer)


def escaped(expression: str) -> str:
    """Return the QGIS expression for the text of ``expression`` in HTML, as in map tips."""
    # A map's entries are replaced one after the other, by the order of their keys: & comes first.
    return f"replace(to_string({expression}), map('&','&amp;','<','&lt;','>','&gt;'))"


def _escape_map_tip(layer: QgsMapLayer) -> None:
    """Have texts of robots shown as they are: without a template QGIS takes them for HTML."""
    if not layer.mapTipTemplate():
        layer.setMapTipTemplate(f"[% {escaped('display_expression()')} %]")


def live_layers(project: QgsProject) -> list[QgsMapLayer]:
    """Return the layers of ``project`` that the desk fills."""
    return [layer for layer in project.mapLayers().values() if layer.customProperty(MARK)]


def keep_style(project: QgsProject, layer: QgsMapLayer) -> None:
    """Store the style of a live layer in ``project``, under the layer's kind."""
    style = QgsMapLayerStyle()
    style.readFromLayer(layer)
    project.writeEntry(SCOPE, _entry(layer), style.xmlData())


def apply_style(project: QgsProject, layer: QgsMapLayer) -> bool:
    """Apply the style of a live layer stored in ``project``; false where there is none."""
    text, found = project.readEntry(SCOPE, _entry(layer))
    if not found or not text:
        return False
    QgsMapLayerStyle(text).writeToLayer(layer)
    _escape_map_tip(layer)
    return True


def _entry(layer: QgsMapLayer) -> str:
    return f"styles/{layer.customProperty(MARK)}"


def _elements(document: QDomDocument, tag: str) -> list[QDomElement]:
    nodes = document.elementsByTagName(tag)
    return [nodes.item(k).toElement() for k in range(nodes.count())]


def _remove_if_empty(group: QDomNode) -> None:
    """Remove a group from the saved tree when only its properties are left."""
    children = group.childNodes()
    names = {children.item(k).nodeName() for k in range(children.count())}
    is_inner = group.nodeName() == "layer-tree-group" and group.parentNode().nodeName() == "layer-tree-group"
    if is_inner and not names & {"layer-tree-layer", "layer-tree-group"}:
        group.parentNode().removeChild(group)


# --- The group for the fleet's layers in the project's layer tree ---

GROUP = "Fleet"
"""Its name; if the user moves it in the tree it stays the same group."""


def fleet_group(project: QgsProject) -> QgsLayerTreeGroup:
    """Return the group, created on top of the layer tree where there is none."""
    root = project.layerTreeRoot()
    return root.findGroup(GROUP) or root.insertGroup(0, GROUP)


def leave_clean(project: QgsProject, was_dirty: bool) -> None:
    """Restore the saved state of ``project``: layers created with each link are no change to save."""
    if was_dirty:
        project.setDirty(True)
        return
    project.setDirty(False)
    # QGIS's layer panel marks the project as changed again after it has laid out a new group.
    QTimer.singleShot(0, lambda: project.setDirty(False))


def remove_if_empty(project: QgsProject) -> None:
    """Remove the group from the layer tree, unless somebody keeps layers in it."""
    group = project.layerTreeRoot().findGroup(GROUP)
    if group is not None and not group.children():
        above: QgsLayerTreeGroup = group.parent()
        above.removeChildNode(group)


# --- A memory layer with a feature for each row of the desk's data ---

Row = tuple[Sequence[tuple[float, float]], Sequence[Any]]
"""Points in the site frame, one for a point layer, and the values of the fields."""

AT_ONCE = 50
"""Features written in one step of a slice."""


class RowLayer:
    """A layer of one kind of geometry in the site's CRS; created when there is a row to show.

    It is removed with its project, and created again in the next one: it shows the desk's data, not the
    project's. It is written in slices, between which the window handles events.
    """

    def __init__(
        self,
        project: QgsProject,
        mark: str,
        name: str,
        kind: str,
        fields: str,
        style: Callable[[QgsVectorLayer], None],
    ):
        self._project, self._mark = project, mark
        self._name, self._kind, self._fields, self._style = name, kind, fields, style
        self._id: str | None = None
        self._frame: SiteFrame | None = None
        self._written: dict[tuple[Any, ...], list[tuple[Sequence[tuple[float, float]], int]]] = {}
        """The points and the id of each feature, by its values."""
        self._has_changed = False
        """Whether it was written since it was last painted."""
        self._shown: tuple[Sequence[Row], SiteReport | None] = ((), None)
        self._writing = CooperativeTask()
        self._watch = ProjectWatch(project)
        self._watch.opened.connect(self._renew)

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none, or the user removed it."""
        return self._project.mapLayer(self._id) if self._id is not None else None

    def show(self, rows: Sequence[Row], site: SiteReport | None) -> None:
        """Start updating to a feature for each of ``rows``; existing ones are left as they are."""
        self._shown = rows, site
        self._renew()

    def finish(self) -> None:
        """Write all pending rows at once: the layer is about to be used."""
        self._writing.finish()

    def remove(self) -> None:
        """Remove the layer from the project for good, and show nothing in the next one."""
        self._watch.remove()
        self._writing.stop()
        self._shown = (), None
        self._remove_layers()

    def _renew(self) -> None:
        self._writing.begin_soon(self._renewed())

    def _renewed(self) -> Steps[None]:
        """Write pending rows; start again where the layer is removed meanwhile."""
        for share in self._steps(*self._shown):
            yield share
            if self.layer is None:
                self._renew()
                return

    def _steps(self, rows: Sequence[Row], site: SiteReport | None) -> Iterator[float]:
        if self._watch.is_reading or site is None or (not rows and self.layer is None):
            return
        self._have_layer(site)
        yield 0.0
        new = self._left_of(rows)
        for first in range(0, len(new), AT_ONCE):
            yield first / len(new)
            self._write(new[first : first + AT_ONCE])
        if self._has_changed:
            self._has_changed = False
            self.layer.updateExtents()
            self.layer.triggerRepaint()

    def _have_layer(self, site: SiteReport) -> None:
        """Provide a layer in the site's CRS, without features written for a site elsewhere."""
        if self.layer is not None and self.layer.crs() != QgsCoordinateReferenceSystem(site.crs):
            self._remove_layers()
        frame = frame_of(site)
        if self.layer is None:
            self._make(site.crs)
        elif frame != self._frame:
            self.layer.dataProvider().truncate()
        else:
            return
        self._frame, self._written = frame, {}

    def _remove_layers(self) -> None:
        if self.layer is not None:
            dirty = self._project.isDirty()
            self._project.removeMapLayer(self._id)
            remove_if_empty(self._project)
            leave_clean(self._project, dirty)
        self._id = None

    def _left_of(self, rows: Sequence[Row]) -> list[Row]:
        """Delete features whose rows are gone, and return the rows that have none yet."""
        before, after = self._written, {}
        new: list[Row] = []
        for points, values in rows:
            same = before.get(tuple(values), [])
            at = next((k for k, (known, _) in enumerate(same) if known == points), None)
            if at is None:
                new.append((points, values))
            else:
                after.setdefault(tuple(values), []).append(same.pop(at))
        gone = [number for features in before.values() for _, number in features]
        self.layer.dataProvider().deleteFeatures(gone)
        self._written = after
        self._has_changed = self._has_changed or bool(gone or new)
        return new

    def _write(self, rows: Sequence[Row]) -> None:
        """Add a feature for each of ``rows``."""
        _, added = self.layer.dataProvider().addFeatures(_features(self.layer, rows, self._frame))
        for (points, values), feature in zip(rows, added, strict=True):
            self._written.setdefault(tuple(values), []).append((points, feature.id()))

    def _make(self, crs: str) -> None:
        dirty = self._project.isDirty()
        fields = "&".join(f"field={field}" for field in self._fields.split(","))
        layer = QgsVectorLayer(f"{self._kind}?{fields}", self._name, "memory")
        layer.setCrs(QgsCoordinateReferenceSystem(crs))
        make_live(layer, self._mark)
        if not apply_style(self._project, layer):
            self._style(layer)
        self._project.addMapLayer(layer, False)
        fleet_group(self._project).addLayer(layer)
        self._id = layer.id()
        leave_clean(self._project, dirty)


def _features(layer: QgsVectorLayer, rows: Sequence[Row], frame: SiteFrame) -> list[QgsFeature]:
    fields = layer.fields()
    # All at once: transforming each row's few points separately takes longer than all else.
    placed = frame.to_crs(np.concatenate([np.array(points) for points, _ in rows]))
    ends = np.cumsum([len(points) for points, _ in rows])[:-1]
    features = []
    for (_, values), line in zip(rows, np.split(placed, ends), strict=True):
        x, y = line.T.tolist()
        feature = QgsFeature(fields)
        feature.setGeometry(QgsGeometry(QgsPoint(x[0], y[0]) if len(x) == 1 else QgsLineString(x, y)))
        feature.setAttributes(list(values))
        features.append(feature)
    return features


def label(
    layer: QgsVectorLayer,
    expression: str,
    placement: QgsPalLayerSettings.LabelPlacement,
    millimetres: float,
) -> None:
    """Label the features with an expression, at that distance, readable on any background."""
    settings = QgsPalLayerSettings()
    settings.fieldName, settings.isExpression = expression, True
    settings.placement, settings.dist = placement, millimetres
    letters = settings.format()
    letters.setSize(9)
    letters.setColor(QColor("#101418"))
    ground = letters.buffer()
    ground.setEnabled(True)
    ground.setColor(QColor("#FFFFFF"))
    ground.setOpacity(1.0)
    ground.setSize(1.0)
    letters.setBuffer(ground)
    settings.setFormat(letters)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
    layer.setLabelsEnabled(True)
