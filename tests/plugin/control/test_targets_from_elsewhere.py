"""Targets that are not just clicked: snapped, typed, pasted, or taken from a layer."""

from __future__ import annotations

import pytest
from pyproj import Transformer
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsSnappingConfig,
    QgsTolerance,
)
from qgis.gui import QgsProjectionSelectionWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QDialog, QLabel, QLineEdit, QPushButton

CTRL = Qt.KeyboardModifier.ControlModifier
X, Y = 488000.0, 5190000.0
YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
"""A CRS of its own, of which nobody knows where on the Earth it is."""


def earth(x, y):
    """Latitude and longitude of a place of the site, by PROJ."""
    lon, lat = Transformer.from_crs("EPSG:32633", "EPSG:4326", always_xy=True).transform(X + x, Y + y)
    return lat, lon


@pytest.fixture
def snapping(iface, wait):
    """Show a layer and snap to its vertices: ``snapping(layer)``."""
    config = QgsSnappingConfig(QgsProject.instance())
    config.setMode(QgsSnappingConfig.SnappingMode.AllLayers)
    config.setTypeFlag(QgsSnappingConfig.SnappingTypes.VertexFlag)
    config.setTolerance(15)
    config.setUnits(QgsTolerance.UnitType.Pixels)

    def begin(layer):
        iface.canvas.setLayers([layer])
        config.setEnabled(True)
        utils = iface.canvas.snappingUtils()
        utils.setConfig(config)
        # QGIS indexes the layer beside the window once the mouse is over the map.
        wait(lambda: utils.snapToMap(QgsPointXY(X + 70.1, Y + 55.4), None, True).isValid(), what="the index")

    yield begin
    config.setEnabled(False)
    iface.canvas.snappingUtils().setConfig(config)


def test_a_click_snaps_as_the_projects_settings_say(hand, layer_of, snapping):
    snapping(layer_of("LineString", "LineString (70.123 55.456, 90 55)"))
    hand.take("cone").click((70.9, 55.9))
    assert hand.points == (pytest.approx((70.123, 55.456), abs=1e-6),)
    hand.click((80, 70))
    assert hand.points[0] == pytest.approx((80, 70), abs=0.3)


def test_without_snapping_a_click_stays_where_it_is(hand, layer_of, iface):
    layer = layer_of("LineString", "LineString (70.123 55.456, 90 55)")
    iface.canvas.setLayers([layer])
    hand.take("cone").click((70.9, 55.9))
    assert hand.points[0] == pytest.approx((70.9, 55.9), abs=0.2)


def test_a_dragged_vertex_snaps_too(hand, layer_of, snapping):
    snapping(layer_of("LineString", "LineString (70.123 55.456, 90 55)"))
    hand.take("route").click((20, 20), (30, 40))
    hand.drag((30, 40), (70.9, 55.9))
    assert hand.points[1] == pytest.approx((70.123, 55.456), abs=1e-6)


@pytest.mark.parametrize("tool", ["cone", "start"])
def test_pasted_latitude_and_longitude_are_a_click_there(hand, tool):
    hand.take(tool)
    lat, lon = earth(70, 55)
    QApplication.clipboard().setText(f"{lat:.8f}, {lon:.8f}")
    hand.key(Qt.Key.Key_V, CTRL)
    assert hand.points == (pytest.approx((70, 55), abs=0.01),)
    assert hand.nothing_sent()


def test_pasted_places_make_a_route(hand):
    hand.take("route")
    for x, y in ((40, 30), (60, 50)):
        QApplication.clipboard().setText("{:.8f} {:.8f}".format(*earth(x, y)))
        hand.key(Qt.Key.Key_V, CTRL)
    assert list(hand.points) == [pytest.approx((40, 30), abs=0.01), pytest.approx((60, 50), abs=0.01)]


def test_what_is_pasted_and_is_no_place_is_named(hand):
    hand.take("cone")
    QApplication.clipboard().setText("meet me at noon")
    hand.key(Qt.Key.Key_V, CTRL)
    assert hand.points is None
    assert hand.complained("'meet me at noon' is no place: write latitude, longitude")


def test_pasted_longitude_and_latitude_are_refused_and_the_right_order_named(hand):
    hand.take("cone")
    lat, lon = earth(70, 55)
    QApplication.clipboard().setText(f"{lon:.8f}, {lat:.8f}")
    hand.key(Qt.Key.Key_V, CTRL)
    assert hand.points is None
    assert hand.complained(f"with its two numbers swapped it is. Write latitude, longitude: {lat:.8f}, ")


@pytest.fixture
def dialog(hand, iface):
    hand.window.desk.selection.select("r1")
    hand.window.actions.coordinates.trigger()
    return iface.findChild(QDialog, "fleet_coordinates_dialog")


def told(dialog):
    return dialog.findChild(QLabel, "fleet_coordinates_told").text()


def enter(dialog, text, crs=None):
    if crs is not None:
        chosen = dialog.findChild(QgsProjectionSelectionWidget, "fleet_coordinates_crs")
        chosen.setCrs(QgsCoordinateReferenceSystem(crs))
        chosen.crsChanged.emit(chosen.crs())
    field = dialog.findChild(QLineEdit, "fleet_coordinates_text")
    field.clear()
    QTest.keyClicks(field, text)


def test_typed_coordinates_say_where_they_are_and_by_which_way_and_set_a_cone(hand, dialog, iface):
    enter(dialog, "{:.8f}, {:.8f}".format(*earth(70, 55)))
    assert "70.00, 55.00 m on the site; 488070.00, 5190055.00 in EPSG:32633" in told(dialog)
    assert "By " in told(dialog)
    QTest.keyClick(dialog.findChild(QLineEdit, "fleet_coordinates_text"), Qt.Key.Key_Return)
    assert hand.points == (pytest.approx((70, 55), abs=0.01),)
    assert hand.drafts.draft.kind == "cone"
    assert hand.window.actions.cone.isChecked()
    assert hand.nothing_sent()


def test_coordinates_are_asked_for_anew_by_keyboard_alone(hand, dialog):
    field = dialog.findChild(QLineEdit, "fleet_coordinates_text")
    enter(dialog, "{:.8f}, {:.8f}".format(*earth(70, 55)))
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_coordinates_set"), Qt.MouseButton.LeftButton)
    dialog.close()
    hand.window.actions.coordinates.trigger()
    assert dialog.focusWidget() is field
    QTest.keyClicks(field, "{:.8f}, {:.8f}".format(*earth(80, 55)))
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert hand.points == (pytest.approx((80, 55), abs=0.01),)


def test_coordinates_of_another_datum_name_the_operation_and_how_exact_it_is(dialog):
    to_gauss = Transformer.from_crs("EPSG:32633", "EPSG:31257", always_xy=True)
    enter(dialog, "{:.1f}, {:.1f}".format(*to_gauss.transform(X + 70, Y + 55)), "EPSG:31257")
    text = told(dialog)
    assert "MGI to WGS 84" in text
    assert "accura" in text


def test_coordinates_in_the_sites_own_crs_need_no_change_of_datum(hand, dialog):
    enter(dialog, "488070 5190055", "EPSG:32633")
    assert "no change: it is the site's CRS" in told(dialog)
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_coordinates_set"), Qt.MouseButton.LeftButton)
    assert hand.points == (pytest.approx((70, 55), abs=1e-6),)


def test_the_dialog_adds_to_the_route_when_that_is_in_hand(hand, dialog):
    hand.take("route").click((40, 30))
    enter(dialog, "488070 5190055", "EPSG:32633")
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_coordinates_set"), Qt.MouseButton.LeftButton)
    assert list(hand.points) == [pytest.approx((40, 30), abs=0.3), pytest.approx((70, 55), abs=1e-6)]


def test_a_place_that_is_nowhere_near_the_site_cannot_be_set(dialog):
    lat, lon = earth(70, 55)
    for text, crs, why in (
        (f"{lon:.8f}, {lat:.8f}", "EPSG:4326", "two numbers swapped it is. Write latitude, longitude: "),
        ("5190055 488070", "EPSG:32633", "swapped it is. Write x, y: 488070, 5190055."),
        ("48.2, 2.35", "EPSG:4326", "km outside the site Yard. Write latitude, longitude, and check"),
        ("48.2, 120", "EPSG:4326", "Yard"),
        ("70, 55", "EPSG:32633", "km outside the site Yard. Write x, y, and check the numbers"),
    ):
        enter(dialog, f"{lat:.8f}, {lon:.8f}", "EPSG:4326")
        assert dialog.findChild(QPushButton, "fleet_coordinates_set").isEnabled()
        enter(dialog, text, crs)
        assert why in told(dialog)
        assert not dialog.findChild(QPushButton, "fleet_coordinates_set").isEnabled(), text


def test_a_place_beside_the_site_can_still_be_set_and_is_checked_as_any_other(hand, dialog):
    enter(dialog, "{:.8f}, {:.8f}".format(*earth(300, 55)))
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_coordinates_set"), Qt.MouseButton.LeftButton)
    assert hand.points == (pytest.approx((300, 55), abs=0.01),)
    assert "is outside the site Yard" in hand.draft_text


def test_what_is_no_place_cannot_be_set(dialog):
    enter(dialog, "48.2")
    assert "'48.2' is no place" in told(dialog)
    assert not dialog.findChild(QPushButton, "fleet_coordinates_set").isEnabled()


def take_from(hand, layer, *chosen, robot="r1"):
    hand.window.desk.selection.select(robot)
    hand.iface.canvas.setCurrentLayer(layer)
    if chosen:
        layer.selectByIds([feature.id() for feature in layer.getFeatures()][slice(*chosen)])
    read_layer(hand)


def read_layer(hand):
    before = len(hand.iface.texts())
    hand.window.actions.from_layer.trigger()
    hand.wait(lambda: hand.points is not None or len(hand.iface.texts()) > before, what="what is read")
    hand.wait(hand.iface.is_settled, what="the check of the draft")


def test_the_selected_point_of_a_layer_is_a_cone_target(hand, layer_of):
    layer = layer_of("Point", "Point (10 10)", "Point (70 55)")
    take_from(hand, layer, 1, 2)
    assert (hand.drafts.draft.kind, hand.drafts.draft.robot) == ("cone", "r1")
    assert hand.points == (pytest.approx((70, 55), abs=1e-6),)


def test_a_point_of_a_layer_of_which_nobody_knows_where_it_lies_is_no_target(hand, layer_of):
    layer = layer_of("Point", "Point (70 55)")
    layer.setCrs(QgsCoordinateReferenceSystem(YARD))
    take_from(hand, layer)
    assert hand.points is None
    assert hand.complained("nothing is known of how the two lie to each other")


def test_a_point_of_a_layer_in_another_crs_is_where_it_is(hand, layer_of):
    lat, lon = earth(70, 55)
    take_from(hand, layer_of("Point", f"Point ({lon} {lat})", crs="EPSG:4326"))
    assert hand.points == (pytest.approx((70, 55), abs=0.001),)


def test_a_whole_layer_of_points_are_targets_and_sending_says_that_they_are_queued(hand, layer_of, iface):
    layer = layer_of("Point", "Point (10 10)", "Point (70 55)", "Point (30 20)", names=("A", "B", "C"))
    take_from(hand, layer)
    assert hand.drafts.draft.names == ("A", "B", "C")
    assert hand.draft_text.startswith("3 cones for r1. ")
    assert hand.draft_text.endswith("Add to queue lets them be placed one after the other.")
    hand.window.actions.send.trigger()
    assert hand.complained("3 cones for r1 were not sent")
    assert hand.nothing_sent()
    assert len(hand.points) == 3


def test_selected_points_come_in_the_order_of_their_table_and_unsaved_ones_last(hand, layer_of):
    wkts = [f"Point ({10 + k} 20)" for k in range(40)]
    layer = layer_of("Point", *wkts, names=[f"P{k:02}" for k in range(40)])
    layer.startEditing()
    for name in ("new1", "new2"):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(X + 15, Y + 40)))
        feature["name"] = name
        layer.addFeature(feature)
    hand.window.desk.selection.select("r1")
    hand.iface.canvas.setCurrentLayer(layer)
    layer.selectAll()
    read_layer(hand)
    assert hand.drafts.draft.names == (*(f"P{k:02}" for k in range(40)), "new1", "new2")
    layer.rollBack()


def test_a_selected_line_is_a_route_that_can_be_changed(hand, layer_of):
    layer = layer_of("LineString", "LineString (1 1, 2 2)", "LineString (40 30, 60 30, 60 60)")
    take_from(hand, layer, 1, 2)
    assert list(hand.points) == [pytest.approx(p, abs=1e-6) for p in ((40, 30), (60, 30), (60, 60))]
    hand.take("route")
    hand.drag((60, 30), (70, 25))
    assert hand.points[1] == pytest.approx((70, 25), abs=0.3)


def test_what_cannot_be_taken_is_named(hand, layer_of):
    for kind, wkts, text in (
        ("Polygon", ["Polygon ((1 1, 9 1, 9 9, 1 1))"], "holds polygons: take a layer of points"),
        ("LineString", ["LineString (1 1, 2 2)"] * 2, "A route is one line, and 2 of the layer"),
        ("MultiLineString", ["MultiLineString ((1 1, 2 2), (5 5, 6 6))"], "has 2 parts"),
        ("Point", [], "has no feature with a place to go to"),
        ("Point", ["Point (1 1)"] * 1001, "has 1001 features and a queue takes 1000"),
    ):
        take_from(hand, layer_of(kind, *wkts))
        assert hand.points is None
        assert hand.complained(text)


def test_without_a_robot_or_a_layer_it_says_what_is_wanting(hand, layer_of):
    take_from(hand, layer_of("Point", "Point (1 1)"), robot=None)
    assert hand.complained("No robot is selected")
    hand.window.desk.selection.select("r1")
    hand.iface.canvas.setCurrentLayer(None)
    hand.window.actions.from_layer.trigger()
    assert hand.complained("No layer of points or lines is active")


def test_a_draft_on_the_map_is_not_wiped_out_by_a_layer(hand, layer_of):
    hand.take("cone").click((20, 20))
    before = hand.drafts.draft
    take_from(hand, layer_of("Point", "Point (70 55)"))
    assert hand.drafts.draft == before
    assert hand.complained("is still on the map")


def test_targets_out_of_sight_are_shown(hand, layer_of, iface):
    take_from(hand, layer_of("Point", "Point (180 150)"))
    middle = iface.canvas.center()
    assert (middle.x() - X, middle.y() - Y) == pytest.approx((180, 150), abs=0.01)


def test_a_target_in_a_corner_that_a_rotated_map_does_not_show_is_shown(hand, layer_of, iface):
    canvas = iface.canvas
    canvas.setRotation(45)
    corner, middle = canvas.extent(), canvas.center()
    at = corner.xMaximum() - 0.02 * corner.width() - X, corner.yMaximum() - 0.02 * corner.height() - Y
    take_from(hand, layer_of("Point", f"Point ({at[0]} {at[1]})"))
    assert hand.points == (pytest.approx(at, abs=1e-6),)
    assert (canvas.center().x(), canvas.center().y()) != pytest.approx((middle.x(), middle.y()), abs=1.0)


def test_ctrl_and_arrows_move_a_cone_exactly(hand):
    hand.take("cone").click((70, 55))
    (x, y) = hand.points[0]
    hand.key(Qt.Key.Key_Right, CTRL)
    hand.key(Qt.Key.Key_Up, CTRL, Qt.KeyboardModifier.ShiftModifier)
    assert hand.points[0] == pytest.approx((x + 0.1, y + 1.0), abs=1e-3)
    assert hand.nothing_sent()
