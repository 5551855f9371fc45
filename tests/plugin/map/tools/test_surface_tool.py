"""The road surface tool, with a real mouse on a real canvas."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.layers import road_surfaces
from fleet_supervisor.plugin.layers.road_surfaces import SurfaceStore
from fleet_supervisor.plugin.layers.roles import ROAD_SURFACE, set_role
from fleet_supervisor.plugin.map.tools.road_tools import SurfaceAction
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsFeature,
    QgsGeometry,
    QgsProject,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.gui import QgsMapToolPan
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QApplication, QToolTip

from tests.support.patience import BUSY

ORIGIN = (488000.0, 5190000.0)


def until(condition, what):
    end = time.monotonic() + 10 * BUSY
    while not condition():
        assert time.monotonic() < end, what
        QApplication.processEvents()


def box(x0, y0, x1, y1):
    x, y = ORIGIN
    return QgsGeometry.fromRect(QgsRectangle(x + x0, y + y0, x + x1, y + y1))


def feature(layer, geometry, *values):
    made = QgsFeature(layer.fields())
    made.setGeometry(geometry)
    made.setAttributes(list(values))
    return made


@pytest.fixture
def layer(iface):
    fields = "field=surface:string&field=name:string&field=origin:string"
    layer = QgsVectorLayer(f"Polygon?crs=EPSG:32633&{fields}", "Surfaces", "memory")
    layer.dataProvider().addFeatures(
        [
            feature(layer, box(10, 10, 60, 60), "asphalt", "Yard", "generated"),
            feature(layer, box(20, 20, 30, 30), "slippery", None, None),
        ]
    )
    set_role(layer, ROAD_SURFACE)
    QgsProject.instance().addMapLayer(layer)
    return layer


class Said(list):
    """Notices that are only written down: each text, and whether it is a complaint."""

    def info(self, text):
        self.append((text, False))

    def warning(self, text):
        self.append((str(text), True))


@pytest.fixture
def entry(iface):
    store = SurfaceStore(QgsProject.instance())
    iface.said = Said()
    made = SurfaceAction(iface, "Fleet Supervisor", store, iface.said)
    yield made
    made.remove()
    store.remove()


@pytest.fixture
def ready(entry, layer):
    entry.action.trigger()
    until(lambda: entry.tool._surfaces() is not None, "the surfaces are read")
    return entry


def test_a_click_says_surface_name_and_coordinates(ready, iface):
    iface.click(50, 50)
    ((text, complaint),) = iface.said
    assert text.startswith("Asphalt (“Yard”, generated) at 4880") and text.endswith(" (EPSG:32633)")
    assert not complaint
    x, y = (float(number) for number in text.split(" at ")[1].split(" (")[0].split(","))
    pixel = iface.canvas.mapUnitsPerPixel()
    assert (x - ORIGIN[0], y - ORIGIN[1]) == pytest.approx((50, 50), abs=pixel)
    iface.click(25, 25)
    assert iface.said[1][0].startswith("Slippery (drawn) at ")
    iface.click(80, 80)
    assert iface.said[2][0].startswith("No road surface at ")


def test_a_right_click_says_nothing_and_keeps_the_tool(ready, iface):
    iface.click(50, 50, Qt.MouseButton.RightButton)
    assert iface.said == []
    assert iface.canvas.mapTool() is ready.tool


def test_the_tool_tip_goes_with_the_cursor(ready, iface):
    for (x, y), text in {(50, 50): "asphalt", (25, 25): "slippery", (80, 80): "no road surface"}.items():
        iface.hover(x, y)
        assert QToolTip.text() == text


def test_a_click_before_the_surfaces_are_read_is_answered_when_they_are(entry, layer, iface):
    entry.action.trigger()
    assert entry.tool._surfaces() is None
    iface.click(50, 50)
    until(lambda: iface.said, "the click is answered")
    assert iface.said[0][0].startswith("Asphalt")


def test_a_click_is_answered_once_from_what_others_read(entry, layer, iface, monkeypatch):
    monkeypatch.setattr(road_surfaces, "_WAIT_S", BUSY * road_surfaces._WAIT_S)
    entry.action.trigger()
    # As an expression does.
    entry.tool._store.read([layer])
    iface.click(50, 50)
    assert [text[:7] for text, _ in iface.said] == ["Asphalt"]
    QTest.qWait(60)
    assert len(iface.said) == 1


def test_what_is_drawn_while_the_tool_is_in_hand_counts(ready, layer, iface):
    layer.startEditing()
    layer.addFeature(feature(layer, box(70, 70, 90, 90), "sand", None, None))
    iface.click(80, 80)
    until(lambda: iface.said, "the click is answered")
    assert iface.said[-1][0].startswith("Sand (drawn)")
    layer.rollBack()
    iface.click(80, 80)
    until(lambda: len(iface.said) == 2, "the click is answered")
    assert iface.said[-1][0].startswith("No road surface")


def test_in_degrees_the_coordinates_have_six_places(ready, iface):
    degrees = QgsCoordinateReferenceSystem("EPSG:4326")
    way = QgsCoordinateTransform(QgsCoordinateReferenceSystem("EPSG:32633"), degrees, QgsProject.instance())
    iface.canvas.setDestinationCrs(degrees)
    iface.canvas.setExtent(way.transformBoundingBox(box(40, 40, 60, 60).boundingBox()))
    QApplication.processEvents()
    viewport = iface.canvas.viewport()
    QTest.mouseClick(viewport, Qt.MouseButton.LeftButton, pos=viewport.rect().center())
    assert iface.said[0][0].startswith("Asphalt (“Yard”, generated) at 14.84")
    assert len(iface.said[0][0].split(" at ")[1].split(",")[0].split(".")[1]) == 6


def test_without_a_layer_of_that_role_it_says_what_to_do(entry, iface):
    entry.action.trigger()
    ((text, complaint),) = iface.said
    assert "No layer of the project has the role road surface" in text and complaint
    iface.click(50, 50)
    assert len(iface.said) == 2


def test_what_it_says_hangs_where_all_notices_hang_and_is_not_cut(plugin, iface):
    iface.mainWindow().findChild(QAction, "fleet_surface_at_point").trigger()
    (text,) = iface.texts()
    assert "No layer of the project has the role road surface" in text


def test_a_layer_that_cannot_be_used_is_named(entry, iface):
    lost = QgsVectorLayer("Polygon?field=surface:string", "Nowhere", "memory")
    lost.setCrs(QgsCoordinateReferenceSystem())
    lost.dataProvider().addFeatures([feature(lost, box(0, 0, 9, 9), "asphalt")])
    set_role(lost, ROAD_SURFACE)
    QgsProject.instance().addMapLayer(lost)
    entry.action.trigger()
    until(lambda: iface.said, "the layer is complained of")
    assert "The layer Nowhere has no CRS" in iface.said[0][0] and iface.said[0][1]


def test_the_layer_may_go_while_the_tool_is_in_hand(ready, layer, iface):
    QgsProject.instance().removeMapLayer(layer.id())
    QApplication.processEvents()
    iface.click(50, 50)
    assert "No layer of the project has the role road surface" in iface.said[-1][0]


def test_escape_puts_the_tool_away(ready, iface):
    iface.canvas.setFocus()
    QTest.keyClick(iface.canvas, Qt.Key.Key_Escape)
    assert iface.canvas.mapTool() is not ready.tool
    assert not ready.action.isChecked()


def test_another_tool_ends_it_and_it_can_be_taken_up_again(ready, layer, iface):
    pan = QgsMapToolPan(iface.canvas)
    iface.canvas.setMapTool(pan)
    assert not ready.action.isChecked()
    layer.startEditing()
    layer.addFeature(feature(layer, box(70, 70, 90, 90), "sand", None, None))
    layer.rollBack()
    readings = ready.tool._store._readings.values()
    assert not any(one.is_under_way for one in readings), "a tool that is put away reads nothing"
    ready.action.trigger()
    iface.click(50, 50)
    until(lambda: iface.said, "the click is answered")
    assert iface.said[-1][0].startswith("Asphalt")
    iface.canvas.unsetMapTool(pan)


def test_the_plugin_brings_the_entry_and_takes_it_away(plugin, iface):
    assert iface.findChild(QAction, "fleet_surface_at_point") is not None
    plugin.unload()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()
    assert iface.findChild(QAction, "fleet_surface_at_point") is None
