"""Layers that the desk fills while it is connected: they are in the project, and never in its file."""

from __future__ import annotations

from qgis.core import QgsLayerTreeGroup, QgsMapLayer, QgsMapLayerStyle, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtXml import QDomDocument, QDomElement, QDomNode

MARK = "fleet/live"
"""The custom property of a layer whose content comes anew with each connection."""
SCOPE = "fleet_supervisor"
NOT_A_LAYER = "fleet-live"


class LiveLayers(QObject):
    """Keeps layers with :data:`MARK` out of the files of a project, and their styles in them.

    An older file, or one of another program, may bring such a layer along: nobody would fill it, so it is
    taken out when the project is read. :meth:`remove` undoes the constructor.
    """

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        project.writeProject.connect(self._leave_out_of_tree)
        project.writeMapLayer.connect(self._leave_out)
        project.readProject.connect(self._take_out)

    def remove(self) -> None:
        """Leave the project's reading and writing alone."""
        self._project.writeProject.disconnect(self._leave_out_of_tree)
        self._project.writeMapLayer.disconnect(self._leave_out)
        self._project.readProject.disconnect(self._take_out)

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
        # QGIS adds the element to the document after this, and reads back only those that are a maplayer.
        element.setTagName(NOT_A_LAYER)
        while element.hasChildNodes():
            element.removeChild(element.firstChild())
        attributes = element.attributes()
        for name in [attributes.item(k).nodeName() for k in range(attributes.count())]:
            element.removeAttribute(name)

    def _take_out(self, *_: object) -> None:
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
    """Make ``layer`` one that the desk alone fills with ``kind``.

    It cannot be edited, as robots that somebody drew would look like those that there are, and QGIS does not
    ask on closing whether its contents may be lost.
    """
    layer.setCustomProperty(MARK, kind)
    layer.setCustomProperty("skipMemoryLayersCheck", 1)
    layer.setReadOnly(True)


def live_layers(project: QgsProject) -> list[QgsMapLayer]:
    """Return the layers of ``project`` that the desk fills."""
    return [layer for layer in project.mapLayers().values() if layer.customProperty(MARK)]


def keep_style(project: QgsProject, layer: QgsMapLayer) -> None:
    """Keep the style of a live layer with ``project``, under the layer's kind."""
    style = QgsMapLayerStyle()
    style.readFromLayer(layer)
    project.writeEntry(SCOPE, _entry(layer), style.xmlData())


def give_style(project: QgsProject, layer: QgsMapLayer) -> bool:
    """Style a live layer as ``project`` has kept it; false where it has kept nothing."""
    text, found = project.readEntry(SCOPE, _entry(layer))
    if not found or not text:
        return False
    QgsMapLayerStyle(text).writeToLayer(layer)
    return True


def _entry(layer: QgsMapLayer) -> str:
    return f"styles/{layer.customProperty(MARK)}"


def _elements(document: QDomDocument, tag: str) -> list[QDomElement]:
    nodes = document.elementsByTagName(tag)
    return [nodes.item(k).toElement() for k in range(nodes.count())]


def _remove_if_empty(group: QDomNode) -> None:
    """Take a group out of the saved tree when nothing is left in it but its properties."""
    children = group.childNodes()
    names = {children.item(k).nodeName() for k in range(children.count())}
    is_inner = group.nodeName() == "layer-tree-group" and group.parentNode().nodeName() == "layer-tree-group"
    if is_inner and not names & {"layer-tree-layer", "layer-tree-group"}:
        group.parentNode().removeChild(group)
