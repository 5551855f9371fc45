"""Where results are put in the layer tree: above what would cover them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from qgis.core import (
    QgsLayerTreeGroup,
    QgsLayerTreeLayer,
    QgsLayerTreeNode,
    QgsMapLayer,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingLayerPostProcessorInterface,
    QgsProcessingUtils,
    QgsProject,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt import sip

_AREAS = QgsWkbTypes.GeometryType.PolygonGeometry


def put_above_areas(sources: Sequence[str], context: QgsProcessingContext) -> None:
    """Have QGIS put the layers ``sources``, from top to bottom, above all polygons and pictures.

    QGIS puts a result above the layer that happens to be current, where an aerial photo or buildings may
    cover it. ``context`` is to load all of them.
    """
    layers = [QgsProcessingUtils.mapLayerFromString(one, context) for one in sources]
    order = _Order([layer.id() for layer in layers if layer is not None])
    for source in sources:
        raising = _Raising(order)
        context.layerToLoadOnCompletionDetails(source).setPostProcessor(raising)
        # The context deletes it, and does not keep it; its own owner it lives until then.
        sip.transferto(raising, raising)


@dataclass
class _Order:
    """The ids of the layers of one run from top to bottom, and of those that are in the layer tree."""

    wanted: list[str]
    loaded: set[str] = field(default_factory=set)


class _Raising(QgsProcessingLayerPostProcessorInterface):
    """Puts a layer in its place, once QGIS has loaded it."""

    def __init__(self, order: _Order) -> None:
        super().__init__()
        self._order = order

    def postProcessLayer(
        self, layer: QgsMapLayer, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        project = context.project()
        if project is None or project.layerTreeRoot().findLayer(layer.id()) is None:
            return
        self._order.loaded.add(layer.id())
        ids = [one for one in self._order.wanted if one in self._order.loaded]
        _raise_in_tree(project.layerTreeRoot(), ids)
        _raise_in_custom_order(project, ids)


def _raise_in_tree(root: QgsLayerTreeGroup, ids: Sequence[str]) -> None:
    nodes = [node for node in (root.findLayer(one) for one in ids) if node is not None]
    children = root.children()
    place = next((k for k, child in enumerate(children) if _covers(child, ids)), len(children))
    # Before the old ones go: QGIS takes a layer out of the project that is nowhere in the tree.
    root.insertChildNodes(place, [node.clone() for node in nodes])
    for node in nodes:
        parent = node.parent()
        if isinstance(parent, QgsLayerTreeGroup):
            parent.removeChildNode(node)


def _raise_in_custom_order(project: QgsProject, ids: Sequence[str]) -> None:
    root = project.layerTreeRoot()
    if not root.hasCustomLayerOrder():
        return
    others = [layer for layer in root.customLayerOrder() if layer.id() not in ids]
    place = next((k for k, layer in enumerate(others) if _is_opaque(layer)), len(others))
    raised = [layer for layer in (project.mapLayer(one) for one in ids) if layer is not None]
    root.setCustomLayerOrder([*others[:place], *raised, *others[place:]])


def _covers(node: QgsLayerTreeNode, ids: Sequence[str]) -> bool:
    """Tell whether ``node`` is or holds a layer, none of ``ids``, that may cover what lies below it."""
    if isinstance(node, QgsLayerTreeGroup):
        return any(_covers(child, ids) for child in node.children())
    return isinstance(node, QgsLayerTreeLayer) and node.layerId() not in ids and _is_opaque(node.layer())


def _is_opaque(layer: QgsMapLayer | None) -> bool:
    """Tell whether ``layer`` may cover what lies below it, as all do but points, lines and tables."""
    if isinstance(layer, QgsVectorLayer):
        return bool(layer.geometryType() == _AREAS)
    return layer is not None
