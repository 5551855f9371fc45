"""The group of the project's layer tree that holds the fleet's layers."""

from __future__ import annotations

from qgis.core import QgsLayerTreeGroup, QgsProject

GROUP = "Fleet"
"""Its name; what the user moves elsewhere in the tree stays the same group."""


def fleet_group(project: QgsProject) -> QgsLayerTreeGroup:
    """Return the group, made on top of the layer tree where there is none."""
    root = project.layerTreeRoot()
    return root.findGroup(GROUP) or root.insertGroup(0, GROUP)


def remove_if_empty(project: QgsProject) -> None:
    """Take the group out of the layer tree, unless somebody keeps layers in it."""
    group = project.layerTreeRoot().findGroup(GROUP)
    if group is not None and not group.children():
        above: QgsLayerTreeGroup = group.parent()
        above.removeChildNode(group)
