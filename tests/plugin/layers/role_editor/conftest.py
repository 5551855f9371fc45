"""A project of layers, and the dialog over it."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.layers.role_editor.roles_dialog import RolesDialog
from fleet_supervisor.plugin.layers.roles import LayerExpressions, LayerSetup, keep_setup
from qgis.core import QgsCoordinateReferenceSystem, QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QEvent
from qgis.PyQt.QtWidgets import QApplication

from tests.support.patience import BUSY

CRS = "EPSG:32633"


@pytest.fixture
def project(make_layer):
    """Buildings with a role, barriers and roads without, as OpenStreetMap has them."""
    project = QgsProject()
    project.setCrs(QgsCoordinateReferenceSystem(CRS))
    tags = "&field=height:string&field=barrier:string"
    buildings = make_layer(
        "buildings",
        "Polygon",
        tags,
        [("Polygon((0 0, 9 0, 9 9, 0 0))", "6"), ("Polygon((20 0, 29 0, 29 9, 20 0))",)],
    )
    barriers = make_layer(
        "barriers", "LineString", tags, [("LineString(0 20, 9 20, 9 30)", None, "wall"), (None, None, None)]
    )
    roads = make_layer("roads", "LineString", "&field=width:string", [("LineString(0 40, 90 40)", "4")])
    keep_setup(buildings, LayerSetup("obstacle", LayerExpressions(semantics="'house'")))
    project.addMapLayers(
        [buildings, barriers, roads, make_layer("trees", "Point", features=[("Point(5 50)",)])]
    )
    project.setDirty(False)
    yield project
    project.clear()


@pytest.fixture
def wait():
    """Let events pass until ``true()``."""

    def until(true, seconds=10.0):
        end = time.monotonic() + BUSY * seconds
        while not true():
            assert time.monotonic() < end, f"not within {BUSY * seconds:g} s"
            QApplication.processEvents()
            time.sleep(0.005)

    return until


@pytest.fixture
def dialog(project, wait):
    """The dialog, opened and caught up with its layers."""
    dialog = RolesDialog(project)
    dialog.open()
    wait(lambda: not dialog.preview.busy)
    yield dialog
    dialog.reject()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
