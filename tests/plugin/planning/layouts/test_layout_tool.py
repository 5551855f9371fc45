"""The cone layout tool, with a real mouse and wheel on a real canvas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.roles import OBSTACLE, ROAD_SURFACE, set_role
from fleet_supervisor.plugin.planning.layouts import layout_layer
from fleet_supervisor.plugin.planning.layouts.dimensions import GROUP, _value, remembered
from fleet_supervisor.plugin.planning.layouts.layout_layer import LayoutLayer
from fleet_supervisor.plugin.planning.layouts.layout_tool import LayoutAction
from fleet_supervisor.robot_bridge.core.layouts.catalogue import LAYOUTS
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsProject,
    QgsSettings,
    QgsVectorLayer,
)
from qgis.gui import QgsMapToolPan, QgsRubberBand
from qgis.PyQt.QtCore import QEvent, QPoint, QPointF, Qt
from qgis.PyQt.QtGui import QKeySequence, QWheelEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QApplication, QWidget

ORIGIN = (488000.0, 5190000.0)
NONE = Qt.KeyboardModifier.NoModifier


class Said(list):
    """Notices that are only written down: each text, and whether it is a complaint."""

    def info(self, text):
        self.append((text, False))

    def warning(self, text):
        self.append((str(text), True))


@pytest.fixture
def entry(iface):
    iface.said = Said()
    made = LayoutAction(iface, "Fleet Supervisor", iface.said)
    yield made
    made.remove()


@pytest.fixture
def slalom(entry, iface):
    entry.start_tool(LAYOUTS["slalom"].of({"spacing": 5, "count": 3}))
    return entry.tool


def turn(iface, notches, modifiers=NONE):
    viewport = iface.canvas.viewport()
    place = QPointF(iface.pixel(40, 50))
    event = QWheelEvent(
        place, QPointF(viewport.mapToGlobal(place.toPoint())), QPoint(), QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton, modifiers, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(viewport, event)
    QApplication.processEvents()


def test_the_dimensions_leave_the_middle_of_the_map_free_and_stay_where_they_are_moved_to(entry, iface):
    window = iface.mainWindow()
    window.resize(1280, 800)
    QApplication.processEvents()
    slalom = LAYOUTS["slalom"].of({})
    entry.start_tool(slalom)
    assert not entry.dimensions.geometry().contains(window.geometry().center())
    entry.dimensions.move(300, 200)
    entry.dimensions.hide()
    entry.start_tool(slalom)
    assert entry.dimensions.pos() == QPoint(300, 200)


def cones():
    (layer,) = (
        one for one in QgsProject.instance().mapLayers().values() if one.customProperty("fleet/cones")
    )
    return {
        f["id"]: (
            f.geometry().asPoint().x() - ORIGIN[0],
            f.geometry().asPoint().y() - ORIGIN[1],
            f["heading"],
        )
        for f in layer.getFeatures()
    }


def placed(wait, count):
    """Wait until so many cones stand, and return them."""
    wait(lambda: not no_layer() and len(cones()) == count, what=f"{count} cones")
    return cones()


def no_layer():
    return not QgsProject.instance().mapLayers()


def test_the_layout_is_under_the_cursor_and_goes_with_it(slalom, iface):
    iface.hover(40, 50)
    pixel = iface.canvas.mapUnitsPerPixel()
    assert slalom.preview().shape == (7, 2)
    # Gates and cones to the east of the cursor, which is where the layout begins.
    assert slalom.preview()[2] - ORIGIN == pytest.approx((46, 50), abs=2 * pixel)
    before = slalom.preview()
    iface.hover(60, 30)
    assert slalom.preview() - before == pytest.approx(np.tile((20, -20), (7, 1)), abs=2 * pixel)
    assert no_layer()


def test_the_wheel_turns_it_and_leaves_the_scale(slalom, iface):
    iface.hover(40, 50)
    scale = iface.canvas.scale()
    turn(iface, 2)
    assert slalom.heading == 120
    first, last = slalom.preview()[2], slalom.preview()[4]
    assert math.degrees(math.atan2(*(last - first))) == pytest.approx(120, abs=0.01)
    turn(iface, -1, Qt.KeyboardModifier.ShiftModifier)
    assert slalom.heading == 119
    assert iface.canvas.scale() == scale


def test_ctrl_and_the_wheel_zoom_as_with_every_tool(slalom, iface):
    scale = iface.canvas.scale()
    turn(iface, 1, Qt.KeyboardModifier.ControlModifier)
    assert slalom.heading == 90
    assert iface.canvas.scale() != scale


def test_a_click_places_it_into_a_layer_and_another_one_beside_it(slalom, iface, wait):
    pixel = iface.canvas.mapUnitsPerPixel()
    iface.hover(40, 50)
    iface.click(40, 50)
    made = placed(wait, 7)
    assert made["slalom-3"] == pytest.approx((46, 50, 90), abs=2 * pixel)
    turn(iface, 6)
    iface.click(80, 60)
    made = placed(wait, 14)
    assert made["slalom-2-3"] == pytest.approx((80, 54, 180), abs=2 * pixel)
    wait(lambda: len(iface.said) == 2, what="the checks")
    assert iface.said == [("7 cones are in the layer Cones.", False)] * 2


def test_cones_that_should_not_stand_there_are_told_and_placed(slalom, iface, wait):
    road = QgsVectorLayer("Polygon?crs=EPSG:32633&field=surface:string", "Road", "memory")
    feature = QgsFeature(road.fields())
    box = QgsGeometry.fromWkt("POLYGON((30 40,53 40,53 60,30 60,30 40))")
    box.translate(*ORIGIN)
    feature.setGeometry(box)
    road.dataProvider().addFeature(feature)
    set_role(road, ROAD_SURFACE)
    QgsProject.instance().addMapLayer(road)
    iface.click(40, 50)
    wait(lambda: iface.said, what="the check")
    # The last cone stands 16 m from the first gate, and the second gate 22 m.
    ((text, complaint),) = iface.said
    assert complaint and text.startswith(
        "3 of 7 cones should not stand there: Cone slalom-5 is on no surface"
    )
    assert len(cones()) == 7
    iface.click(40, 50)
    wait(lambda: len(iface.said) == 2, what="the check")
    assert iface.said[1][0].startswith(
        "7 of 7 cones should not stand there: Cone slalom-2-1 is 0.00 m from slalom-1"
    )


@pytest.fixture
def road():
    """A road of which the slalom at (40, 50) leaves the east end, and a wall across it."""
    for wkt, role, name in (
        ("POLYGON((30 40,53 40,53 60,30 60,30 40))", ROAD_SURFACE, "Road"),
        ("POLYGON((45 49.5,46.2 49.5,46.2 50.5,45 50.5,45 49.5))", OBSTACLE, "Wall"),
    ):
        layer = QgsVectorLayer("Polygon?crs=EPSG:32633&field=surface:string", name, "memory")
        feature = QgsFeature(layer.fields())
        box = QgsGeometry.fromWkt(wkt)
        box.translate(*ORIGIN)
        feature.setGeometry(box)
        layer.dataProvider().addFeature(feature)
        set_role(layer, role)
        QgsProject.instance().addMapLayer(layer)


def bad(tool):
    return sorted(map(tuple, np.round(tool.bad_preview() - ORIGIN).tolist()))


def test_cones_that_should_not_stand_there_are_marked_before_they_are_placed(slalom, road, iface, wait):
    iface.hover(40, 50)
    wait(lambda: len(slalom.bad_preview()) == 4, what="the marks")
    assert bad(slalom) == [(46.0, 50.0), (56.0, 50.0), (62.0, 48.0), (62.0, 52.0)]
    iface.hover(33, 56)
    assert len(slalom.bad_preview()) == 0
    wait(lambda: len(slalom.bad_preview()) == 2, what="the marks of the other place")
    iface.click(33, 56)
    wait(lambda: len(slalom.bad_preview()) == 7, what="cones on cones")
    QTest.keyClick(iface.canvas, Qt.Key.Key_Escape)
    assert len(slalom.bad_preview()) == 0


def test_a_layer_that_is_changed_under_the_preview_counts_as_it_is_now(slalom, road, iface, wait):
    iface.hover(40, 50)
    wait(lambda: len(slalom.bad_preview()) == 4, what="the marks")
    (wall,) = QgsProject.instance().mapLayersByName("Wall")
    wall.startEditing()
    wall.deleteFeatures(wall.allFeatureIds())
    assert wall.commitChanges()
    iface.hover(40.5, 50)
    wait(lambda: len(slalom.bad_preview()) == 3, what="the marks without the wall")


def test_a_layout_that_was_placed_is_taken_back_and_done_again(slalom, entry, iface, wait):
    for place in ((40, 50), (40, 80)):
        iface.click(*place)
    placed(wait, 14)
    QTest.keyClick(iface.canvas, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert sorted(placed(wait, 7)) == [f"slalom-{k}" for k in range(1, 8)]
    QTest.keySequence(iface.canvas, QKeySequence(QKeySequence.StandardKey.Redo))
    placed(wait, 14)
    assert entry.dimensions.undo.isEnabled()
    for left in (7, 0):
        QTest.mouseClick(entry.dimensions.undo, Qt.MouseButton.LeftButton)
        placed(wait, left)
    assert not entry.dimensions.undo.isEnabled()


def test_a_cone_without_a_place_is_named_and_nothing_is_placed(slalom, iface, wait):
    iface.click(40, 50)
    placed(wait, 7)
    (layer,) = QgsProject.instance().mapLayersByName("Cones")
    layer.dataProvider().addFeature(QgsFeature(layer.fields()))
    # Reads what stands there for the preview, too.
    slalom.show_layout(slalom.layout)
    wait(lambda: not slalom._standing_reading.is_under_way, what="the preview's reading")
    iface.click(40, 80)
    named = "Cones, feature 8 is not one point with a place on the site: correct or delete it."
    wait(lambda: (named, True) in iface.said, what="the refusal")
    assert layer.featureCount() == 8


def test_a_layer_whose_field_was_removed_takes_no_cones(slalom, iface, wait):
    iface.click(40, 50)
    placed(wait, 7)
    (layer,) = QgsProject.instance().mapLayersByName("Cones")
    layer.dataProvider().deleteAttributes([layer.fields().indexOf("id")])
    layer.updateFields()
    iface.click(40, 80)
    named = "The layer Cones takes no cones without the fields id: add them, or remove the layer."
    wait(lambda: (named, True) in iface.said, what="the refusal")
    assert layer.featureCount() == 7


def test_in_another_project_nothing_is_taken_back(slalom, iface, wait):
    iface.click(40, 50)
    placed(wait, 7)
    QgsProject.instance().clear()
    LayoutLayer(QgsProject.instance()).add(
        slalom.layout.cones("slalom"), "slalom", QgsCoordinateReferenceSystem("EPSG:32633")
    )
    QTest.keyClick(iface.canvas, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    wait(lambda: ("There is nothing to take back.", False) in iface.said, what="the answer")
    assert len(cones()) == 7


def test_cones_are_there_again_when_the_project_is_saved_and_opened(slalom, iface, tmp_path, wait):
    project = QgsProject.instance()
    iface.click(40, 50)
    before = placed(wait, 7)
    (layer,) = project.mapLayersByName("Cones")
    number = layer.id()
    assert project.write(str(tmp_path / "yard.qgz"))
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["yard.qgz", "yard_cones.gpkg"]
    iface.click(40, 80)
    wait(lambda: len(iface.said) == 2, what="the check")
    after = cones()
    assert len(after) == 14 and after.items() > before.items()
    project.clear()
    assert project.read(str(tmp_path / "yard.qgz"))
    assert cones() == after
    (layer,) = project.mapLayersByName("Cones")
    assert layer.id() == number and layer.renderer().type() != "singleSymbol"
    assert iface.said == [("7 cones are in the layer Cones.", False)] * 2


def test_a_file_that_is_there_already_is_not_written_over(slalom, iface, tmp_path, wait):
    (tmp_path / "yard_cones.gpkg").write_text("mine")
    iface.click(40, 50)
    placed(wait, 7)
    assert QgsProject.instance().write(str(tmp_path / "yard.qgz"))
    assert (tmp_path / "yard_cones.gpkg").read_text() == "mine"
    assert (tmp_path / "yard_cones_2.gpkg").exists()


def test_cones_that_cannot_be_saved_with_the_project_are_told(slalom, iface, tmp_path, wait, monkeypatch):
    monkeypatch.setattr(layout_layer, "_free_path", lambda _project: tmp_path / "no_such" / "cones.gpkg")
    iface.click(40, 50)
    placed(wait, 7)
    assert QgsProject.instance().write(str(tmp_path / "yard.qgz"))
    text, complaint = iface.said[-1]
    assert complaint and "The cones of the layer Cones are not saved with the project" in text
    assert len(cones()) == 7


def test_a_map_without_true_metres_is_refused_with_what_to_do(slalom, iface):
    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:3857"))
    QTest.mouseClick(iface.canvas.viewport(), Qt.MouseButton.LeftButton, NONE, QPoint(300, 300))
    ((text, complaint),) = iface.said
    assert complaint and "its metres are not metres" in text
    assert no_layer()


def test_what_it_says_hangs_where_all_notices_hang_and_is_not_cut(plugin, iface):
    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:3857"))
    iface.mainWindow().findChild(QAction, "fleet_cone_layout_slalom").trigger()
    QTest.mouseClick(iface.canvas.viewport(), Qt.MouseButton.LeftButton, NONE, QPoint(300, 300))
    (text,) = iface.texts()
    assert "its metres are not metres" in text


def test_a_right_click_a_drag_and_a_move_place_nothing(slalom, iface):
    iface.hover(40, 50)
    iface.click(40, 50, Qt.MouseButton.RightButton)
    viewport = iface.canvas.viewport()
    QTest.mousePress(viewport, Qt.MouseButton.LeftButton, NONE, iface.pixel(40, 50))
    QTest.mouseRelease(viewport, Qt.MouseButton.LeftButton, NONE, iface.pixel(60, 50))
    assert no_layer()


def test_escape_and_another_tool_take_the_preview_away(slalom, iface):
    def bands():
        return [item for item in iface.canvas.items() if isinstance(item, QgsRubberBand) and item.isVisible()]

    iface.hover(40, 50)
    assert len(bands()) == 1
    QTest.keyClick(iface.canvas, Qt.Key.Key_Escape)
    assert slalom.preview().shape == (0, 2)
    assert bands() == []
    assert iface.canvas.mapTool() is not slalom
    iface.canvas.setMapTool(slalom)
    iface.hover(50, 50)
    pan = QgsMapToolPan(iface.canvas)
    iface.canvas.setMapTool(pan)
    assert bands() == []


def test_the_plugin_has_an_entry_for_each_layout_and_leaves_none(iface):
    from fleet_supervisor.plugin.plugin import FleetPlugin

    loaded = FleetPlugin(iface)
    loaded.initGui()
    entry = iface.findChild(QAction, "fleet_cone_layout")
    names = {one.objectName() for one in entry.menu().actions()}
    assert names == {f"fleet_cone_layout_{name}" for name in LAYOUTS}
    next(one for one in entry.menu().actions() if one.objectName().endswith("fs_skidpad")).trigger()
    iface.hover(40, 50)
    assert len(iface.canvas.mapTool().preview()) == 82
    loaded.unload()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert iface.findChild(QAction, "fleet_cone_layout") is None


# --- dimensions ------------------------------------------------------------------------------------------


@pytest.fixture
def fields(entry):
    """The fields of the dimensions by name, of a layout taken from the menu; what was kept is forgotten."""
    QgsSettings().remove(GROUP)

    def take(name):
        next(one for one in entry.action.menu().actions() if one.objectName().endswith(name)).trigger()
        QApplication.processEvents()
        kind = LAYOUTS[name]
        return {
            one.name: entry.dimensions.findChild(QWidget, f"fleet_layout_{one.name}")
            for one in kind.dimensions()
        }

    yield take
    QgsSettings().remove(GROUP)


def type_into(field, text):
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Tab)


def test_every_dimension_has_a_field_with_its_unit_and_the_standards_value(entry, fields):
    for name, kind in LAYOUTS.items():
        shown = fields(name)
        assert kind.STANDARD in entry.dimensions.standard.text()
        for one in kind.dimensions():
            field = shown[one.name]
            if one.choices:
                assert field.currentData() == one.standard
                assert [field.itemData(k) for k in range(field.count())] == list(one.choices)
                assert [field.itemText(k) for k in range(field.count())] == list(one.choices.values())
                assert field.toolTip() == f"Standard: {field.currentText()}"
            else:
                assert field.value() == one.standard
                assert field.suffix().strip() == one.unit


def test_a_dimension_that_is_typed_is_what_is_shown_and_placed(entry, fields, iface, wait):
    shown = fields("slalom")
    iface.hover(40, 50)
    type_into(shown["count"], "3")
    type_into(shown["spacing"], "5")
    type_into(entry.dimensions.heading, "180")
    assert len(entry.tool.preview()) == 7
    pixel = iface.canvas.mapUnitsPerPixel()
    iface.click(40, 60)
    assert placed(wait, 7)["slalom-3"] == pytest.approx((40, 54, 180), abs=2 * pixel)
    assert shown["count"].font().bold() and not shown["gate_width"].font().bold()


def test_what_cannot_be_is_said_and_not_placed(entry, fields, iface):
    shown = fields("iso3888_1")
    iface.hover(40, 50)
    before = entry.tool.layout
    type_into(shown["vehicle_width"], "0")
    assert entry.dimensions.problem.isVisible()
    assert entry.dimensions.problem.text() == "Width of the vehicle without mirrors: give 0.1 or more."
    assert entry.tool.layout == before
    type_into(shown["vehicle_width"], "2")
    assert not entry.dimensions.problem.isVisible()
    assert entry.tool.layout.vehicle_width == 2.0


@pytest.mark.parametrize(
    ("name", "dimension", "value", "said"),
    [
        ("slalom", "count", "5001", "Cones to go round: too many cones; a plan has 5000 at most."),
        ("circle", "radius", "1", "circle: the lane is wider than the circle: give a larger radius."),
    ],
)
def test_dimensions_of_too_many_cones_or_that_do_not_go_together_are_said(
    entry, fields, name, dimension, value, said
):
    shown = fields(name)
    before = entry.tool.layout
    type_into(shown[dimension], value)
    assert entry.dimensions.problem.text() == said
    assert entry.tool.layout == before == remembered(LAYOUTS[name])


def test_the_wheel_scrolls_and_changes_no_dimension(entry, fields):
    shown = fields("iso3888_1")
    for field in (*shown.values(), entry.dimensions.heading):
        field.setFocus()
        before = _value(field)
        place = QPointF(field.rect().center())
        event = QWheelEvent(
            place, QPointF(field.mapToGlobal(place.toPoint())), QPoint(), QPoint(0, -120),
            Qt.MouseButton.NoButton, NONE, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(field, event)
        assert _value(field) == before, field.objectName()


def test_each_layout_remembers_its_dimensions_until_they_are_reset(entry, fields):
    type_into(fields("slalom")["spacing"], "30.48")
    assert fields("corridor")["spacing"].value() == LAYOUTS["corridor"].of({}).spacing
    assert fields("slalom")["spacing"].value() == 30.48
    entry.dimensions.reset.click()
    assert entry.tool.layout == LAYOUTS["slalom"].of({})
    assert fields("slalom")["spacing"].value() == 18.0


def test_what_was_kept_and_cannot_be_any_more_is_the_standards(entry, fields):
    fields("slalom")
    QgsSettings().setValue(f"{GROUP}/slalom/spacing", "-3")
    QgsSettings().setValue(f"{GROUP}/slalom/count", "many")
    assert remembered(LAYOUTS["slalom"]) == LAYOUTS["slalom"].of({})
    QgsSettings().setValue(f"{GROUP}/slalom/count", "20000")
    assert remembered(LAYOUTS["slalom"]) == LAYOUTS["slalom"].of({})


def test_a_layout_is_turned_and_placed_by_keys_alone(entry, fields, iface, wait):
    fields("slalom")
    canvas = iface.canvas
    assert len(entry.tool.preview()) == 13
    for key, modifiers, heading in (
        (Qt.Key.Key_PageDown, NONE, 105.0),
        (Qt.Key.Key_PageUp, NONE, 90.0),
        (Qt.Key.Key_PageUp, Qt.KeyboardModifier.ShiftModifier, 89.0),
    ):
        QTest.keyClick(canvas, key, modifiers)
        assert entry.tool.heading == entry.dimensions.heading.value() == heading
    QTest.keyClick(canvas, Qt.Key.Key_Return)
    placed(wait, 13)
    QTest.keyClick(canvas, Qt.Key.Key_F2)
    assert entry.dimensions.focusWidget() is entry.dimensions.heading
    QTest.keyClick(entry.dimensions, Qt.Key.Key_Escape)
    assert not entry.dimensions.isVisible()
    assert canvas.mapTool() is entry.tool
    QTest.keyClick(canvas, Qt.Key.Key_Escape)
    assert canvas.mapTool() is not entry.tool


def test_another_tool_takes_the_dimensions_away(entry, fields, iface):
    fields("circle")
    assert entry.dimensions.isVisible()
    iface.canvas.setMapTool(QgsMapToolPan(iface.canvas))
    assert not entry.dimensions.isVisible()
