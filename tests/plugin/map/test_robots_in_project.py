"""The layer of robots in the project: its CRS, its changes, its file."""

from __future__ import annotations

import pytest
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtWidgets import QLineEdit


def test_the_layer_carries_the_robots_in_the_sites_crs(at_desk, wait):
    layer = at_desk.view.layer.layer
    wait(lambda: layer.featureCount() == 2, 3)
    names = [field.name() for field in layer.fields()]
    assert names == [
        "robot",
        "state",
        "theta",
        "heading_deg",
        "v",
        "battery",
        "status",
        "age",
        "link",
        "command",
        "accuracy",
    ]
    assert layer.crs().authid() == "EPSG:32633"
    group = QgsProject.instance().layerTreeRoot().findGroup("Fleet")
    assert [child.layerId() for child in group.children()] == [layer.id()]
    first = next(iter(layer.getFeatures("robot = 'r1'")))
    assert (first.geometry().asPoint().x(), first.geometry().asPoint().y()) == (488050.0, 5190040.0)
    assert first["heading_deg"] == 90.0
    assert not layer.isEditable()


@pytest.mark.parametrize("unsaved", [False, True])
def test_the_layer_neither_makes_nor_hides_unsaved_changes(plugin, gateway, make_robot, wait, unsaved):
    project = QgsProject.instance()
    # As QGIS's layer panel does, at once and again when it has laid out the group.
    project.layerTreeRoot().addedChildren.connect(lambda *_: project.setDirty(True))
    project.layerTreeRoot().addedChildren.connect(lambda *_: QTimer.singleShot(0, project.setDirty))
    project.setDirty(unsaved)
    gateway.show(make_robot("r1"))
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    wait(lambda: window.view.layer.layer is not None and window.view.layer.layer.featureCount() == 1, 3)
    assert project.isDirty() is unsaved


def test_a_new_project_gets_the_layer_anew(at_desk, wait):
    wait(lambda: at_desk.view.layer.layer.featureCount() == 2, 3)
    QgsProject.instance().clear()
    assert at_desk.view.layer.layer is None
    wait(lambda: at_desk.view.layer.layer is not None and at_desk.view.layer.layer.featureCount() == 2, 3)


def test_a_layer_that_was_saved_with_a_project_is_not_doubled(at_desk, iface, tmp_path, wait):
    wait(lambda: at_desk.view.layer.layer.featureCount() == 2, 3)
    path = str(tmp_path / "saved.qgz")
    assert QgsProject.instance().write(path)
    assert QgsProject.instance().read(path)
    wait(lambda: at_desk.view.layer.layer is not None and at_desk.view.layer.layer.featureCount() == 2, 3)
    assert [layer.name() for layer in QgsProject.instance().mapLayers().values()] == ["Robots (live)"]
