"""The group of the project's layer tree that holds the fleet's layers."""

from __future__ import annotations

from qgis.core import QgsLayerTreeGroup, QgsProject
from qgis.PyQt.QtCore import QTimer

GROUP = "Fleet"
"""Its name; what the user moves elsewhere in the tree stays the same group."""


def fleet_group(project: QgsProject) -> QgsLayerTreeGroup:
    """Return the group, made on top of the layer tree where there is none."""
    root = project.layerTreeRoot()
    return root.findGroup(GROUP) or root.insertGroup(0, GROUP)


def leave_clean(project: QgsProject, was_dirty: bool) -> None:
    """Have ``project`` as saved as it was: layers that come anew with each link are no change to save."""
    if was_dirty:
        project.setDirty(True)
        return
    project.setDirty(False)
    # QGIS's layer panel notes a change once more when it has laid out a new group.
    QTimer.singleShot(0, lambda: project.setDirty(False))


def remove_if_empty(project: QgsProject) -> None:
    """Take the group out of the layer tree, unless somebody keeps layers in it."""
    group = project.layerTreeRoot().findGroup(GROUP)
    if group is not None and not group.children():
        above: QgsLayerTreeGroup = group.parent()
        above.removeChildNode(group)
