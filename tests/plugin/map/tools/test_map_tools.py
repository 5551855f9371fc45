"""The map tools, with real clicks and keys on a real canvas, against a gateway on a real socket."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.ui import scheduling
from qgis.core import QgsFeature, QgsGeometry, QgsProject, QgsVectorLayer
from qgis.gui import QgsRubberBand
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QLabel, QToolButton, QToolTip

from tests.support.inside_qgis.mouse import move_mouse

NONE = Qt.KeyboardModifier.NoModifier


def key(iface, which):
    QTest.keyClick(iface.canvas, which)


def drawn(at_desk):
    return at_desk.dock.findChild(QLabel, "fleet_draft_text").text()


@pytest.fixture(autouse=True)
def time_enough(monkeypatch):
    """Have small drafts looked at before their click has ended, as on a machine with nothing else to do."""
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", 60.0)


@pytest.fixture
def cone(at_desk):
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    return at_desk


@pytest.fixture
def route(at_desk):
    at_desk.desk.selection.select("r1")
    at_desk.actions.route.trigger()
    return at_desk


def sent(gateway, wait, count=1):
    wait(lambda: len(gateway.requests_of("send")) >= count, what="the command")
    return gateway.requests_of("send")[-1]


def test_a_click_puts_a_cone_and_enter_sends_it_where_it_was_put(cone, iface, gateway, wait):
    iface.click(70, 55)
    assert gateway.requests_of("send") == []
    assert drawn(cone).startswith("Cone for r1 at ")
    key(iface, Qt.Key.Key_Return)
    params = sent(gateway, wait)
    assert (params["robot"], params["op"], params["params"]["cone"]) == ("r1", "SetPosEnd", True)
    pixel = iface.canvas.mapUnitsPerPixel()
    assert params["params"]["x"] == pytest.approx(70, abs=pixel)
    assert params["params"]["y"] == pytest.approx(55, abs=pixel)
    wait(lambda: len(cone.desk.state.commands) == 1)
    assert cone.desk.drafts.draft is None


def test_the_send_button_sends(cone, iface, gateway, wait):
    iface.click(70, 55)
    QTest.mouseClick(cone.dock.findChild(QToolButton, "fleet_send_button"), Qt.MouseButton.LeftButton)
    assert sent(gateway, wait)["robot"] == "r1"


def test_another_click_moves_the_cone_and_only_the_last_is_sent(cone, iface, gateway, wait):
    iface.click(70, 55)
    iface.click(30, 20)
    key(iface, Qt.Key.Key_Enter)
    assert sent(gateway, wait)["params"]["x"] == pytest.approx(30, abs=0.3)
    QTest.qWait(200)
    assert len(gateway.requests_of("send")) == 1


def test_enter_twice_sends_once_and_the_second_says_so(cone, iface, gateway, wait):
    iface.click(70, 55)
    key(iface, Qt.Key.Key_Return)
    # Nothing comes of it while the first is still looked at, as of a double click's.
    key(iface, Qt.Key.Key_Return)
    sent(gateway, wait)
    wait(lambda: cone.desk.drafts.draft is None, what="the draft gone")
    QTest.qWait(QApplication.doubleClickInterval() + 50)
    key(iface, Qt.Key.Key_Return)
    wait(lambda: any("nothing to send" in text for text in iface.texts()), what="the answer")
    assert len(gateway.requests_of("send")) == 1


@pytest.mark.parametrize("how", ["escape", "cancel"])
def test_a_draft_is_cancelled_and_nothing_is_sent(cone, iface, gateway, how):
    iface.click(70, 55)
    if how == "escape":
        key(iface, Qt.Key.Key_Escape)
    else:
        button = cone.dock.findChild(QToolButton, "fleet_cancel_button")
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    assert cone.desk.drafts.draft is None
    QTest.qWait(200)
    assert gateway.requests_of("send") == []


def test_dragging_neither_moves_nor_sends(cone, iface, gateway):
    iface.click(70, 55)
    before = cone.desk.drafts.draft
    view = iface.canvas.viewport()
    QTest.mousePress(view, Qt.MouseButton.LeftButton, NONE, iface.pixel(70, 55))
    move_mouse(view, iface.pixel(75, 60), Qt.MouseButton.LeftButton)
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, NONE, iface.pixel(90, 70))
    assert cone.desk.drafts.draft == before
    assert gateway.requests_of("send") == []


def test_leaving_the_tool_keeps_the_draft_and_sends_nothing(cone, iface, gateway):
    iface.click(70, 55)
    iface.actionPan().trigger()
    QTest.qWait(200)
    assert gateway.requests_of("send") == []
    assert cone.desk.drafts.draft is not None
    assert not cone.actions.cone.isChecked()


def test_the_draft_stays_with_the_robot_it_was_made_for(cone, iface, gateway, wait):
    iface.click(70, 55)
    cone.desk.selection.select("r2")
    assert drawn(cone).startswith("Cone for r1 at ")
    key(iface, Qt.Key.Key_Return)
    assert sent(gateway, wait)["robot"] == "r1"


def test_a_click_with_another_robot_selected_is_for_that_robot(cone, iface, gateway, wait):
    iface.click(70, 55)
    cone.desk.selection.select("r2")
    iface.click(72, 50)
    assert drawn(cone).startswith("Cone for r2 at ")
    key(iface, Qt.Key.Key_Return)
    assert sent(gateway, wait)["robot"] == "r2"


@pytest.mark.parametrize("tool", ["cone", "route"])
def test_without_a_robot_a_click_says_whom_to_select(at_desk, iface, tool):
    getattr(at_desk.actions, tool).trigger()
    iface.click(70, 55)
    assert at_desk.desk.drafts.draft is None
    assert any("No robot is selected" in text for text in iface.texts())


def test_without_a_gateway_a_click_says_that_the_site_is_not_known(plugin, iface):
    window = plugin.window
    window.desk.selection.select("r1")
    window.actions.cone.trigger()
    iface.click(70, 55)
    assert any("The site is not known yet. Connect" in text for text in iface.texts())


def test_a_target_outside_the_site_is_refused_with_place_and_bounds(cone, iface, gateway):
    iface.look_at(-60, -60, 260, 200)
    iface.click(-20, 30)
    (text,) = [text for text in iface.texts() if "outside the site" in text]
    x, y = cone.desk.drafts.draft.points[0]
    assert f"({x:.2f}, {y:.2f}) m" in text
    assert "from (0, 0) to (200, 160) m" in text
    key(iface, Qt.Key.Key_Return)
    QTest.qWait(200)
    assert gateway.requests_of("send") == []
    assert cone.desk.drafts.draft is not None
    assert "Not to be sent" in drawn(cone)


def layer_with_role(role, x_min, y_min, x_max, y_max, crs="EPSG:32633", name="Skid pad"):
    layer = QgsVectorLayer(f"Polygon?crs={crs}&field=name:string", f"the {role}s", "memory")
    corners = [(x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max), (x_min, y_min)]
    ring = ", ".join(f"{488000 + x} {5190000 + y}" for x, y in corners)
    feature = QgsFeature(layer.fields())
    feature.setGeometry(QgsGeometry.fromWkt(f"Polygon (({ring}))"))
    feature.setAttributes([name])
    layer.dataProvider().addFeature(feature)
    layer.setCustomProperty("fleet/role", role)
    QgsProject.instance().addMapLayer(layer)
    return layer


def test_a_target_in_a_keepout_is_refused_by_name(cone, iface, gateway):
    layer_with_role("keepout", 60, 50, 80, 60, name="Loading bay")
    iface.click(70, 55)
    assert any("enters the keepout Loading bay" in text for text in iface.texts())
    key(iface, Qt.Key.Key_Return)
    QTest.qWait(200)
    assert gateway.requests_of("send") == []


def test_only_what_the_filter_of_a_layer_keeps_is_a_keepout(cone, iface):
    layer = layer_with_role("keepout", 60, 50, 80, 60, name="Loading bay")
    for text, refused in (
        ("\"name\" <> 'Pond'", True),
        ("\"name\" = 'Pond'", False),
        ("to_int('a')", True),
    ):
        layer.setCustomProperty("fleet/filter", text)
        iface.click(70, 55)
        assert ("Not to be sent" in drawn(cone)) is refused, text


WRONG_FILTER = "The filter expression '1 +' for the layer the keepouts is not one"


def test_a_filter_that_is_none_is_told_with_its_layer_and_nothing_is_drafted(cone, iface):
    layer = layer_with_role("keepout", 60, 50, 80, 60)
    layer.setCustomProperty("fleet/filter", "1 +")
    iface.click(70, 55)
    assert any(WRONG_FILTER in text for text in iface.texts())
    assert cone.desk.drafts.draft is None


def test_a_filter_that_is_none_refuses_the_draft_where_the_layer_is_come_to_later(
    cone, iface, wait, monkeypatch
):
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", scheduling.ONE_STEP)
    layer = layer_with_role("keepout", 60, 50, 80, 60)
    layer.setCustomProperty("fleet/filter", "1 +")
    iface.click(70, 55)
    wait(lambda: not cone.desk.checks.is_under_way)
    assert any(WRONG_FILTER in text for text in cone.desk.drafts.draft.findings.refused)


def test_a_target_beside_the_road_is_warned_of_and_can_be_sent(cone, iface, gateway, wait):
    layer_with_role("road_surface", 60, 50, 80, 60)
    iface.click(70, 55)
    assert "not on a road surface" not in drawn(cone)
    iface.click(30, 55)
    assert "is not on a road surface" in drawn(cone)
    key(iface, Qt.Key.Key_Return)
    sent(gateway, wait)


def test_where_no_surface_is_known_nothing_is_said_of_roads(cone, iface):
    layer = layer_with_role("road_surface", 60, 50, 80, 60)
    layer.dataProvider().truncate()
    iface.click(30, 55)
    assert "Cone for r1" in drawn(cone) and "not on a road surface" not in drawn(cone)


def test_a_route_across_a_keepout_is_refused_even_if_its_points_are_beside(route, iface, gateway):
    layer_with_role("keepout", 60, 50, 80, 60)
    iface.click(50, 55)
    iface.click(90, 55)
    assert "Not to be sent" in drawn(route)
    assert "The route enters the keepout Skid pad" in drawn(route)


def test_clicks_make_a_route_backspace_takes_the_last_back_and_enter_sends(route, iface, gateway, wait):
    for point in ((40, 30), (60, 30), (60, 50), (90, 90)):
        iface.click(*point)
    key(iface, Qt.Key.Key_Backspace)
    key(iface, Qt.Key.Key_Return)
    params = sent(gateway, wait)
    assert (params["robot"], params["op"]) == ("r1", "SetPath")
    pixel = iface.canvas.mapUnitsPerPixel()
    for (x, y), (asked_x, asked_y) in zip(
        params["params"]["points"], ((40, 30), (60, 30), (60, 50)), strict=True
    ):
        assert x == pytest.approx(asked_x, abs=pixel)
        assert y == pytest.approx(asked_y, abs=pixel)


def test_backspace_on_the_last_point_ends_the_route(route, iface):
    iface.click(40, 30)
    key(iface, Qt.Key.Key_Backspace)
    assert route.desk.drafts.draft is None


def test_backspace_is_reported_to_qgis_as_taken(route, iface):
    # QGIS deletes the selected features on a Backspace that no tool took.
    left_to_qgis = []
    iface.canvas.keyPressed.connect(lambda event: left_to_qgis.append(event.isAccepted()))
    iface.click(40, 30)
    iface.click(60, 30)
    key(iface, Qt.Key.Key_Backspace)
    assert True not in left_to_qgis
    assert len(route.desk.drafts.draft.points) == 1


def test_a_double_click_adds_one_point_and_sends_nothing(route, iface, gateway):
    iface.click(40, 30)
    view, at = iface.canvas.viewport(), iface.pixel(60, 50)
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, NONE, at)
    QTest.mouseDClick(view, Qt.MouseButton.LeftButton, NONE, at)
    QTest.qWait(200)
    assert len(route.desk.drafts.draft.points) == 2
    assert gateway.requests_of("send") == []


def test_a_route_of_one_point_is_not_sent_and_says_what_is_missing(route, iface, gateway):
    iface.click(40, 30)
    key(iface, Qt.Key.Key_Return)
    assert any("at least two points" in text for text in iface.texts())
    QTest.qWait(200)
    assert gateway.requests_of("send") == []
    assert len(route.desk.drafts.draft.points) == 1


def test_the_next_leg_follows_the_mouse(route, iface):
    iface.click(40, 30)
    iface.hover(80, 70)
    assert route.desk.drafts.cursor == pytest.approx((80, 70), abs=0.3)
    assert len(route.desk.drafts.draft.points) == 1


def test_a_route_is_not_given_to_another_robot_nor_lost(route, iface):
    iface.click(40, 30)
    route.desk.selection.select("r2")
    iface.click(60, 50)
    assert route.desk.drafts.draft.robot == "r1"
    assert len(route.desk.drafts.draft.points) == 1
    assert any("is for r1, but r2 is selected" in text for text in iface.texts())


def test_a_cone_click_does_not_wipe_out_a_route(route, iface):
    iface.click(40, 30)
    iface.click(60, 30)
    route.actions.cone.trigger()
    iface.click(60, 50)
    assert len(route.desk.drafts.draft.points) == 2
    assert any("is still on the map" in text for text in iface.texts())


def test_a_draft_that_the_gateway_refuses_comes_back(cone, iface, gateway, wait):
    gateway.refuse["send"] = "robot r1 is lost; wait until it is heard again"
    iface.click(70, 55)
    key(iface, Qt.Key.Key_Return)
    wait(lambda: any("robot r1 is lost" in text for text in iface.texts()))
    assert cone.desk.drafts.draft.robot == "r1"


def test_a_draft_without_a_link_is_not_sent_and_not_lost(cone, iface, gateway, wait):
    iface.click(70, 55)
    gateway.stop()
    wait(lambda: cone.desk.state.link.phase.value == "retrying")
    key(iface, Qt.Key.Key_Return)
    assert any("was NOT sent" in text for text in iface.texts())
    assert cone.desk.drafts.draft is not None
    gateway.start()
    wait(lambda: cone.desk.state.link.phase.value == "connected", 8)
    QTest.qWait(300)
    assert gateway.requests_of("send") == []


def test_a_click_on_a_robot_selects_it_and_beside_it_selects_none(at_desk, iface, wait):
    wait(lambda: at_desk.view.overlay.robot_at(*pair(iface.pixel(80, 60))) == "r2")
    at_desk.actions.select.trigger()
    iface.click(80, 60)
    assert at_desk.desk.selection.last == "r2"
    iface.click(20, 90)
    assert at_desk.desk.selection.last is None


def pair(point: QPoint):
    return point.x(), point.y()


def test_the_button_of_the_tool_in_hand_keeps_it_in_hand(cone, iface):
    tool = iface.canvas.mapTool()
    cone.actions.cone.trigger()
    assert iface.canvas.mapTool() is tool
    assert cone.actions.cone.isChecked()
    cone.actions.route.trigger()
    assert iface.canvas.mapTool() is not tool
    assert not cone.actions.cone.isChecked()


def bands(iface):
    """What is drawn of ways to the mouse: how many points each has."""
    items = iface.canvas.scene().items()
    return [item.numberOfVertices() for item in items if isinstance(item, QgsRubberBand) and item.isVisible()]


@pytest.mark.parametrize("how", ["another robot", "another tool"])
def test_the_way_to_the_mouse_goes_with_the_robot_and_with_the_tool(cone, iface, gateway, wait, how):
    way = {"points": [[50, 40], [60, 40], [70, 55]], "metres": 28.0, "seconds": 20.0}
    gateway.answers["get_route"] = lambda _: {"result": way}
    for place in ((60, 50), (70, 55)):
        iface.hover(*place)
    wait(lambda: 3 in bands(iface), what="the way")
    assert "28" in QToolTip.text()
    if how == "another robot":
        cone.desk.selection.select("r2")
    else:
        cone.actions.select.trigger()
    assert 3 not in bands(iface)
    wait(lambda: not QToolTip.isVisible(), what="the words going")
