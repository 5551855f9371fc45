"""Checks that take longer than the window can wait: what may happen meanwhile, and what must not."""

from __future__ import annotations

import threading
import time
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.control import request_tracker
from fleet_supervisor.plugin.control.keepout_checks import KeepoutCheck, ObstacleCheck, SurfaceCheck
from fleet_supervisor.plugin.ui import scheduling
from fleet_supervisor.plugin.ui.errors import NotSentError
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.core import (
    QgsApplication,
    QgsExpression,
    QgsExpressionContext,
    QgsFeature,
    QgsGeometry,
    QgsProject,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QApplication, QDockWidget, QToolButton

from tests.support.databases.frozen_layer import frozen_for_layers, layer_in_database
from tests.support.patience import START

SQUARE = "Polygon ((60 50, 80 50, 80 60, 60 60, 60 50))"
ENTER, ESCAPE = Qt.Key.Key_Return, Qt.Key.Key_Escape
CTRL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def slow(hand, monkeypatch):
    """A desk where every check takes as many slices as it has steps; clicks and keys do not wait for it."""
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", 0.0)
    hand.settled, hand.iface.is_settled = hand.iface.is_settled, lambda: True
    return hand


def settle(hand):
    hand.wait(hand.settled, what="the check of the draft")


@pytest.fixture
def looked_at(monkeypatch):
    """How many tracks each check looked at, in order: [(check, number)]."""
    seen = []

    def counting(check):
        look = check.check_paths

        def counted(self, layer, tracks, placement):
            seen.append((check.__name__, len(tracks)))
            return look(self, layer, tracks, placement)

        monkeypatch.setattr(check, "check_paths", counted)

    for check in (KeepoutCheck, ObstacleCheck, SurfaceCheck):
        counting(check)
    return seen


def test_the_panel_says_that_it_is_checked_and_nothing_goes_out_before(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((20, 20))
    assert slow.window.desk.checks.is_under_way
    assert ". Being checked: " in slow.draft_text
    assert not slow.window.actions.override.isEnabled()
    with pytest.raises(NotSentError, match="it has not been checked to its end"):
        slow.window.desk.orders.send(slow.drafts.draft)
    slow.key(ENTER)
    assert "It goes out when nothing speaks against it; Esc keeps it back." in slow.draft_text
    assert slow.gateway.requests_of("send") == []
    assert slow.sent()["params"]["x"] == pytest.approx(20, abs=0.3)
    assert slow.points is None


def test_what_is_found_at_last_keeps_it_here_although_it_was_ordered(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((70, 55))
    slow.key(ENTER)
    settle(slow)
    assert slow.nothing_sent()
    assert "enters the keepout Bay" in slow.draft_text
    assert slow.complained("enters the keepout Bay")


def test_a_draft_that_was_moved_meanwhile_has_nothing_of_the_check_before(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((70, 55))
    slow.key(ENTER)
    slow.click((20, 20))
    assert not slow.window.desk.checks.has_order
    slow.wait(lambda: not len(slow.window.desk.sending.outgoing), what="the check of what was sent")
    assert slow.complained("(70.00, 55.00)", "was not sent: ")
    settle(slow)
    assert slow.nothing_sent()
    assert slow.drafts.draft.findings.faults == ()
    slow.click((70, 55))
    settle(slow)
    assert "enters the keepout Bay" in slow.draft_text


def test_a_cancelled_draft_is_not_sent_by_its_check(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((20, 20))
    slow.key(ENTER)
    slow.key(ESCAPE)
    assert not slow.window.desk.checks.is_under_way
    assert slow.nothing_sent()
    assert slow.points is None
    assert not slow.has_message("was not sent")


def ends(slow, count=1):
    """Wait for so many commands; return robot and x of each, in the order in which they were sent."""
    slow.sent(count)
    return [(sent["robot"], round(sent["params"]["x"])) for sent in slow.gateway.requests_of("send")]


def test_a_cone_for_another_robot_does_not_undo_the_send_of_the_first(slow, layer_of):
    # Not at r2's feet, nor between it and its target.
    layer_of("Polygon", "Polygon ((60 40, 78 40, 78 50, 60 50, 60 40))", role="keepout", names=["Bay"])
    slow.take("cone").click((20, 20))
    first = slow.drafts.draft.in_words()
    slow.key(ENTER)
    slow.window.desk.selection.select("r2")
    slow.click((30, 70))
    told = slow.window.dock.draft_panel._text.text()
    assert told.startswith(f"{first} is being checked: ")
    assert slow.drafts.draft.robot == "r2"
    assert ends(slow) == [("r1", 20)]
    settle(slow)
    assert not slow.has_message("was not sent")
    assert slow.drafts.draft.robot == "r2" and slow.drafts.draft.is_checked
    slow.key(ENTER)
    assert ends(slow, 2) == [("r1", 20), ("r2", 30)]


def test_what_was_sent_goes_out_in_the_order_of_the_presses(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone")
    for x in (20, 25, 30):
        slow.click((x, 20))
        slow.key(ENTER)
    assert ends(slow, 3) == [("r1", 20), ("r1", 25), ("r1", 30)]
    QTest.qWait(150)
    assert len(slow.gateway.requests_of("send")) == 3
    assert slow.points is None


def test_a_route_that_was_sent_gets_no_further_leg(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("route").click((20, 20), (30, 20))
    slow.key(ENTER)
    slow.click((40, 30))
    sent = slow.sent()["params"]["points"]
    assert len(sent) == 2
    assert len(slow.points) == 1


@pytest.mark.parametrize("how", ["abort_all", "emergency"])
def test_a_stop_keeps_back_what_is_checked_beside_the_draft_too(slow, layer_of, how):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((20, 20))
    slow.key(ENTER)
    slow.window.desk.selection.select("r2")
    slow.click((20, 40))
    getattr(slow.window.actions, how).trigger()
    settle(slow)
    QTest.qWait(150)
    assert slow.gateway.requests_of("send") == []
    assert slow.complained("was not sent: robots were told to stop")


@pytest.mark.parametrize("how", ["keys", "button", "toolbar"])
def test_a_double_click_or_enter_twice_sends_once(hand, how):
    QApplication.setDoubleClickInterval(60_000)
    hand.gateway.refuse["send"] = "not now"
    hand.take("cone").click((20, 20))
    if how == "keys":
        hand.key(ENTER)
        wait_until_back(hand)
        hand.key(ENTER)
    else:
        where = hand.window.dock if how == "button" else hand.window.toolbar
        button = (
            where.findChild(QToolButton, "fleet_send_button")
            if how == "button"
            else where.widgetForAction(hand.window.actions.send)
        )
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)
        wait_until_back(hand)
        QTest.mouseDClick(button, Qt.MouseButton.LeftButton)
    QTest.qWait(100)
    assert len(hand.gateway.requests_of("send")) == 1


def wait_until_back(hand):
    hand.wait(lambda: hand.points is not None and hand.gateway.requests_of("send"), what="the refused draft")


@pytest.mark.parametrize("how", ["abort", "abort_all", "emergency"])
def test_who_stops_robots_wants_nothing_sent_any_more(slow, layer_of, how):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((20, 20))
    slow.key(ENTER)
    getattr(slow.window.actions, how).trigger()
    settle(slow)
    assert slow.gateway.requests_of("send") == [] or {s["op"] for s in slow.gateway.requests_of("send")} == {
        "Abort"
    }
    QTest.qWait(150)
    assert "SetPosEnd" not in {sent["op"] for sent in slow.gateway.requests_of("send")}
    assert slow.points is not None
    assert slow.complained("was not sent: robots were told to stop")


def test_stop_in_the_list_of_conflicts_keeps_it_back_too(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    window, gateway = slow.window, slow.gateway
    window.dock.tabs.setCurrentWidget(window.dock.conflict_panel)
    at = {"begins": time.time() + 20.0, "nearest_at": time.time() + 20.0, "x": 50.0, "y": 40.0}
    meeting = {"robot": "r1", "other": "r2", "kind": "head-on", "metres": 0.4, **at}
    gateway.tell("conflicts", {"t": time.time(), "conflicts": [meeting], "waiting": []})
    slow.wait(lambda: window.dock.findChild(QToolButton, "fleet_stop_r1"), what="the conflict")
    slow.take("cone").click((20, 20))
    window.desk.sending.send()
    assert window.desk.checks.has_order
    window.dock.findChild(QToolButton, "fleet_stop_r1").click()
    assert slow.complained("was not sent: robots were told to stop")
    settle(slow)
    slow.wait(lambda: gateway.requests_of("pause_robot"), what="the pause")
    assert slow.points is not None
    assert slow.nothing_sent()


def test_a_draft_for_the_queue_waits_for_its_check_too(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((70, 55))
    slow.window.actions.enqueue.trigger()
    settle(slow)
    assert slow.nothing_sent()
    assert slow.complained("was not put into the queue: ")


def test_a_warning_that_nobody_has_seen_is_shown_before_it_is_sent(slow, layer_of):
    layer_of("Polygon", SQUARE, role="road_surface", names=["Road"])
    slow.take("cone").click((20, 20))
    slow.key(ENTER)
    settle(slow)
    assert slow.nothing_sent()
    assert slow.complained("was not sent, since only now this is known")
    assert "is not on a road surface" in slow.draft_text
    slow.key(ENTER)
    assert slow.sent()["params"]["x"] == pytest.approx(20, abs=0.3)


def test_only_what_has_changed_of_a_route_is_looked_at_again(hand, layer_of, looked_at):
    for role in ("keepout", "obstacle", "road_surface"):
        layer_of("Polygon", SQUARE, role=role, name=role)
    hand.take("route").click((20, 20), (30, 20), (40, 20), (50, 20), (50, 30))
    looked_at.clear()
    hand.drag((40, 20), (40, 25))
    # Two legs meet in a vertex, and it is one place where legs end.
    assert looked_at == [("KeepoutCheck", 2), ("ObstacleCheck", 2), ("SurfaceCheck", 3)]
    looked_at.clear()
    hand.drag((50, 30), (70, 55))
    assert looked_at == [("KeepoutCheck", 1), ("ObstacleCheck", 1), ("SurfaceCheck", 2)]
    assert "4 of 5 points are not on a road surface" not in hand.draft_text
    assert len(hand.drafts.draft.findings.overridable) == 2
    hand.key(ENTER)
    # What goes out is looked at afresh, all of it, with the way of the robot to its beginning.
    assert looked_at[3:] == [("KeepoutCheck", 5), ("ObstacleCheck", 5), ("SurfaceCheck", 10)]
    assert hand.nothing_sent()


def test_a_layer_that_changes_is_looked_at_anew(hand, layer_of, looked_at):
    layer = layer_of("Polygon", role="obstacle")
    hand.take("route").click((20, 20), (30, 20), (90, 60))
    feature = QgsFeature(layer.fields())
    square = QgsGeometry.fromWkt(SQUARE)
    square.translate(488000, 5190000)
    feature.setGeometry(square)
    layer.dataProvider().addFeatures([feature])
    layer.dataChanged.emit()
    looked_at.clear()
    hand.drag((20, 20), (20, 25))
    # The first leg, the one behind the layer's change, and the way of the robot to where they begin.
    assert looked_at == [("ObstacleCheck", 3)]
    assert "is on things" in hand.draft_text


def test_a_layer_that_changes_under_a_check_has_it_begin_anew(slow, layer_of):
    layer = layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((70, 55))
    layer.setCustomProperty("fleet/filter", "\"name\" <> 'Bay'")
    settle(slow)
    assert slow.drafts.draft.is_checked
    assert slow.drafts.draft.findings.faults == ()


def test_a_layer_that_goes_under_a_check_does_no_harm(slow, layer_of):
    layer = layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((70, 55))
    QgsProject.instance().removeMapLayer(layer.id())
    settle(slow)
    assert slow.drafts.draft.findings.faults == ()


def test_a_layer_that_cannot_be_read_any_more_keeps_the_draft_here(slow, layer_of):
    layer = layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((20, 20))
    layer.setCustomProperty("fleet/filter", "1 +")
    settle(slow)
    assert "The filter expression '1 +' for the layer things" in slow.draft_text
    slow.key(ENTER)
    settle(slow)
    assert slow.nothing_sent()
    assert slow.complained("was not sent: The filter expression")


def test_a_draft_that_is_come_back_to_before_it_was_checked_is_checked_then(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("cone").click((70, 55))
    slow.click((20, 20))
    settle(slow)
    slow.key(Qt.Key.Key_Z, CTRL)
    assert not slow.drafts.draft.is_checked
    settle(slow)
    assert "enters the keepout Bay" in slow.draft_text


def test_what_the_mouse_drags_is_looked_at_when_it_is_let_go(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("route").click((20, 20), (30, 20))
    settle(slow)
    slow.drag((30, 20), (70, 55), let_go=False)
    QTest.qWait(50)
    assert not slow.window.desk.checks.is_under_way
    assert not slow.drafts.draft.is_checked
    view = slow.iface.canvas.viewport()
    none = Qt.KeyboardModifier.NoModifier
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, none, slow.iface.pixel(70, 55))
    settle(slow)
    assert "The route enters the keepout Bay" in slow.draft_text


def test_the_vertex_in_hand_stays_there_when_the_check_ends(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.take("route").click((20, 20), (30, 20), (40, 30))
    slow.move(100, 90)
    slow.type(">>")
    slow.key(Qt.Key.Key_Up, CTRL)
    assert slow.window.desk.checks.is_under_way
    settle(slow)
    slow.key(Qt.Key.Key_Delete)
    assert len(slow.points) == 2


def test_a_thousand_targets_of_a_layer_are_checked_each(hand, layer_of):
    places = [f"Point ({20 + k % 40} {20 + k // 40})" for k in range(1000)]
    points = layer_of("Point", *places)
    layer_of("Polygon", "Polygon ((29.5 29.5, 32.5 29.5, 32.5 31.5, 29.5 31.5, 29.5 29.5))", role="keepout")
    layer_of("LineString", "LineString (19 40.1, 60 40.1)", role="obstacle", names=["Fence"])
    hand.window.desk.selection.select("r1")
    hand.iface.canvas.setCurrentLayer(points)
    hand.window.actions.from_layer.trigger()
    hand.wait(lambda: hand.points is not None and hand.iface.is_settled(), 60)
    found = hand.drafts.draft.findings.overridable
    assert len([text for text in found if "keepout" in text]) == 3 * 2
    assert len([text for text in found if "Fence" in text]) == 40
    assert len(found) == 46


# --- Sources of layers that hang: nothing in the window may wait for them ---


BAY = "POLYGON((488060 5190050,488080 5190050,488080 5190060,488060 5190060,488060 5190050))"


@pytest.fixture
def bays(postgis_server, layer_of):
    """The uri of keepouts in a PostGIS whose server can be frozen: nobody has read of them yet."""
    return layer_in_database(postgis_server, BAY)


@pytest.fixture
def layer_in_postgis(bays):
    def make(role):
        layer = QgsVectorLayer(bays, "Bays", "postgres")
        assert layer.isValid()
        layer.setCustomProperty("fleet/role", role)
        QgsProject.instance().addMapLayer(layer)
        return layer

    return make


@pytest.mark.parametrize("role", ["keepout", "obstacle", "road_surface"])
@pytest.mark.parametrize("how", ["button", "keys"])
def test_the_emergency_stop_goes_out_while_a_layer_of_a_draft_hangs(
    hand, layer_in_postgis, postgis_server, role, how
):
    layer_in_postgis(role)
    hand.iface.is_settled = lambda: True
    with frozen_for_layers(postgis_server) as server:
        hand.take("cone").click((70, 55))
        hand.move(60, 55)
        assert hand.window.desk.checks.is_under_way
        if how == "button":
            hand.window.actions.emergency.trigger()
        else:
            QTest.keyClick(hand.iface.canvas, Qt.Key.Key_F10)
        hand.wait(lambda: hand.gateway.requests_of("emergency_stop"), what="the emergency stop")
        assert server.is_frozen


def test_a_draft_whose_layer_does_not_answer_is_not_sent_before_it_does(
    hand, layer_in_postgis, postgis_server, monkeypatch
):
    monkeypatch.setattr(scheduling, "STALLED_AFTER", 0.3)
    layer_in_postgis("keepout")
    with frozen_for_layers(postgis_server) as server:
        hand.take("cone").click((20, 20))
        assert hand.complained("The layer Bays has not answered for ")
        # At once, and by the same thread: each that hangs holds a connection of the server.
        hand.click((30, 20), (40, 20))
        hand.key(ENTER)
        assert server.is_frozen
        readers = [one for one in threading.enumerate() if isinstance(one, scheduling.ReadingThread)]
        assert len(readers) == 1
        assert hand.nothing_sent()
        assert hand.drafts.draft.can_be_overridden
    readers[0].join()
    monkeypatch.setattr(scheduling, "STALLED_AFTER", START)
    hand.click((70, 55))
    assert hand.complained("enters the keepout Bay.")
    hand.click((20, 20))
    hand.key(ENTER)
    assert hand.sent()["params"]["x"] == pytest.approx(20, abs=0.3)


def test_what_was_not_read_for_a_leg_is_read_with_the_next_one(
    hand, layer_in_postgis, postgis_server, monkeypatch
):
    monkeypatch.setattr(scheduling, "STALLED_AFTER", 0.3)
    layer_in_postgis("keepout")
    with frozen_for_layers(postgis_server):
        hand.take("route").click((55, 55), (90, 55))
        assert hand.complained("The layer Bays has not answered for ")
        readers = [one for one in threading.enumerate() if isinstance(one, scheduling.ReadingThread)]
    readers[0].join()
    monkeypatch.setattr(scheduling, "STALLED_AFTER", START)
    hand.click((95, 55))
    assert "The route enters the keepout Bay" in hand.draft_text


@pytest.mark.parametrize("role", ["keepout", "obstacle"])
def test_a_layer_damaged_in_the_middle_keeps_the_draft_here(hand, layer_of, save_layer, tmp_path, role):
    squares = [f"Polygon (({x} {y}, {x}.4 {y}, {x}.4 {y}.4, {x} {y}))" for x in range(100) for y in range(50)]
    drawn = layer_of("Polygon", *squares, names=["x" * 200] * len(squares))
    layer = save_layer(drawn, "bays.gpkg")
    QgsProject.instance().removeMapLayer(drawn.id())
    file = tmp_path / "bays.gpkg"
    content = bytearray(file.read_bytes())
    page = 4096
    names = [at for at in range(0, len(content), page) if content[at : at + page].count(b"x" * 200) > 5]
    for at in names[len(names) // 3 : 2 * len(names) // 3]:
        content[at : at + page] = bytes(page)
    file.write_bytes(content)
    layer = QgsVectorLayer(str(file), "Bays", "ogr")
    assert layer.isValid()
    layer.setCustomProperty("fleet/role", role)
    QgsProject.instance().addMapLayer(layer)
    # A route over all of it: what of the layer can be read is read, and that some cannot.
    hand.take("route").click((0.6, 0.6), (99.6, 49.6))
    assert hand.complained("The layer Bays cannot be read, so what is in it was not looked at.")


@pytest.mark.parametrize("form", ["gpkg", "fgb", "shp"])
def test_keepouts_of_a_file_that_took_the_place_of_another_count(hand, layer_of, save_layer, tmp_path, form):
    drawn = layer_of("Polygon", "Polygon ((100 50, 110 50, 110 60, 100 60, 100 50))", names=["Far"])
    layer = save_layer(drawn, f"bays.{form}")
    later = layer_of("Polygon", SQUARE, names=["Later bay"])
    save_layer(later, f"later.{form}")
    for one in (drawn, later):
        QgsProject.instance().removeMapLayer(one.id())
    layer.setCustomProperty("fleet/role", "keepout")
    QgsProject.instance().addMapLayer(layer)
    hand.take("cone").click((70, 55))
    assert not hand.drafts.draft.findings.overridable
    # As a program does that synchronises a folder.
    for file in tmp_path.glob("later.*"):
        if file.suffix[1:] in (form, "shx", "dbf"):
            file.replace(tmp_path / f"bays{file.suffix}")
    hand.key(ENTER)
    assert hand.complained("enters the keepout Later bay.")
    assert hand.nothing_sent()


def test_a_draft_of_a_layer_that_hangs_is_not_made_and_nothing_waits_for_it(
    hand, postgis_server, monkeypatch
):
    monkeypatch.setattr(scheduling, "STALLED_AFTER", 0.3)
    layer = QgsVectorLayer(
        layer_in_database(postgis_server, "POINT(488070 5190055)", "Point"), "Stops", "postgres"
    )
    with frozen_for_layers(postgis_server) as server:
        hand.window.desk.selection.select("r1")
        hand.iface.canvas.setCurrentLayer(layer)
        hand.window.actions.from_layer.trigger()
        assert hand.complained("so no draft was made of it.")
        assert server.is_frozen
    assert hand.points is None


def place_slalom(hand):
    hand.iface.findChild(QAction, "fleet_cone_layout_slalom").trigger()
    hand.iface.hover(40, 50)
    hand.iface.click(40, 50)


def points_in(server, number):
    layer = QgsVectorLayer(
        layer_in_database(server, f"POINT({488070 + number} 5190055)", "Point"), "Points", "postgres"
    )
    assert layer.isValid()
    QgsProject.instance().addMapLayer(layer)
    return layer


def place_among_cones_that_hang(hand, server):
    points_in(server, 0).setCustomProperty("fleet/cones", "1")
    return lambda: place_slalom(hand)


def plan_with(setting):
    def prepare(hand, server):
        layer = points_in(server, 1)
        hand.iface.findChild(QAction, "fleet_plan_panel").trigger()
        dock = hand.iface.findChild(QDockWidget, "fleet_plan_dock")
        cones = QgsVectorLayer("Point?crs=EPSG:32633", "Own", "memory")
        cone = QgsFeature(cones.fields())
        cone.setGeometry(QgsGeometry.fromWkt("POINT(488070 5190055)"))
        cones.dataProvider().addFeature(cone)
        QgsProject.instance().addMapLayer(cones)
        chosen = {"cones": cones.id(), "stores": "", setting: layer.id()}
        dock.drafts.settings = replace(dock.drafts.settings, **chosen)
        hand.wait(lambda: dock.robots.model().rowCount() == 2)
        return lambda: dock.make(preview=True)

    return prepare


def evaluate_road_surface(hand, server):
    layer = QgsVectorLayer(layer_in_database(server, BAY), "Roads", "postgres")
    QgsProject.instance().addMapLayer(layer)
    layer.setCustomProperty("fleet/role", "road_surface")

    def evaluate():
        for _ in range(50):
            # An expression has to be answered at once: it waits a moment for the first answer alone.
            expression = QgsExpression("road_surface(488070, 5190055)")
            expression.evaluate(QgsExpressionContext())
            assert "still being read (Roads)" in expression.evalErrorString()

    return evaluate


@pytest.mark.parametrize(
    "prepare",
    [place_among_cones_that_hang, plan_with("cones"), plan_with("stores"), evaluate_road_surface],
    ids=["cones of layouts", "cones of a plan", "stores of a plan", "expression"],
)
def test_the_emergency_stop_goes_out_while_other_layers_hang(hand, postgis_server, prepare):
    hand.iface.is_settled = lambda: True
    act = prepare(hand, postgis_server)
    with frozen_for_layers(postgis_server) as server:
        act()
        QTest.keyClick(hand.iface.canvas, Qt.Key.Key_F10)
        hand.wait(lambda: hand.gateway.requests_of("emergency_stop"), what="the emergency stop")
        assert server.is_frozen


@pytest.mark.parametrize("role", ["road_surface", "obstacle"])
def test_cones_stand_unchecked_where_a_layer_hangs_and_its_threads_do_not_pile_up(
    hand, layer_in_postgis, postgis_server, role, monkeypatch
):
    monkeypatch.setattr(scheduling, "STALLED_AFTER", 0.3)
    layer = layer_in_postgis(role)
    hand.iface.is_settled = lambda: True
    with frozen_for_layers(postgis_server) as server:
        for number in range(3):
            place_slalom(hand)
            hand.iface.findChild(QAction, "fleet_surface_at_point").trigger()
            layer.setCustomProperty("changed", number)
        assert hand.complained("The cones in the layer Cones were not checked: ")
        assert len(QgsProject.instance().mapLayersByName("Cones")[0]) == 3 * 13
        readers = [one for one in threading.enumerate() if isinstance(one, scheduling.ReadingThread)]
        # One of the layout tool, one of the store of road surfaces.
        assert len(readers) == (2 if role == "road_surface" else 1)
        assert QgsApplication.taskManager().count() == 0
        assert server.is_frozen


def test_the_plugin_is_unloaded_while_layers_hang(hand, layer_in_postgis, postgis_server, plugin):
    layer_in_postgis("road_surface")
    hand.iface.is_settled = lambda: True
    with frozen_for_layers(postgis_server) as server:
        place_slalom(hand)
        hand.iface.findChild(QAction, "fleet_surface_at_point").trigger()
        plugin.unload()
        assert server.is_frozen


def answered_late(hand, method, free):
    """Have the gateway answer ``method`` only when the event ``free`` is set."""
    gateway = hand.gateway

    def answer(params):
        assert free.wait(START)
        return {"result": to_json(gateway._queue(**params)) if method == "send" else {}}

    gateway.answers[method] = answer


def test_what_is_not_sent_after_another_is_on_the_map_again_and_its_message_stays(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    free = threading.Event()
    answered_late(slow, "send", free)
    slow.take("cone")
    for x in (20, 70):
        slow.click((x, 55))
        slow.key(ENTER)
    free.set()
    slow.wait(lambda: slow.has_message("m enters the keepout Bay"), what="the message")
    slow.wait(lambda: slow.window.desk.state.commands.task_of("r1"), what="the report of the first")
    assert len(slow.gateway.requests_of("send")) == 1
    assert slow.points[0] == pytest.approx((70, 55), abs=0.3)
    assert slow.has_message("m enters the keepout Bay")


def test_a_message_stays_when_a_command_is_reported_that_was_asked_for_before_it(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    free = threading.Event()
    answered_late(slow, "send", free)
    slow.take("cone")
    for x in (20, 25):
        slow.click((x, 20))
        slow.key(ENTER)
    slow.wait(lambda: len(slow.window.desk.orders), what="the first one to be sent")
    slow.window.actions.abort_all.trigger()
    text = "was not sent: robots were told to stop"
    slow.wait(lambda: slow.has_message(text), what="the message about the second one")
    free.set()
    slow.wait(lambda: slow.window.desk.state.commands.task_of("r1"), what="the report of the first")
    assert slow.has_message(text)
    slow.click((30, 20))
    settle(slow)
    slow.key(ENTER)
    slow.wait(lambda: not slow.has_message(text), what="the end of the message")


def test_targets_that_are_queued_quickly_are_all_queued_in_their_order(slow, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    free = threading.Event()
    answered_late(slow, "add_tasks", free)
    slow.take("cone")
    for x in (20, 25, 30):
        slow.click((x, 20))
        slow.window.actions.enqueue.trigger()
    slow.wait(lambda: slow.gateway.requests_of("add_tasks"), what="the first one")
    outgoing = slow.window.desk.sending.outgoing
    slow.wait(lambda: not outgoing._slices.is_busy, what="nothing being checked")
    assert len(outgoing) == 2
    free.set()
    slow.wait(lambda: len(slow.gateway.requests_of("add_tasks")) == 3, what="all of them")
    places = [one["tasks"][0]["x"] for one in slow.gateway.requests_of("add_tasks")]
    assert places == pytest.approx([20, 25, 30], abs=0.3)
    assert slow.iface.texts() == []


def test_what_waits_for_an_answer_that_is_late_is_on_the_map_again(slow, layer_of, monkeypatch):
    monkeypatch.setattr(request_tracker, "SLOW_AFTER", 0.0)
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    slow.gateway.mute.add("add_tasks")
    slow.take("cone")
    for x in (20, 25):
        slow.click((x, 20))
        slow.window.actions.enqueue.trigger()
    assert slow.complained("The gateway has not answered yet what was asked of the queue of r1 before.")
    assert slow.points[0] == pytest.approx((25, 20), abs=0.3)


def test_a_fault_in_the_check_of_one_order_keeps_no_other_back(slow, layer_of, monkeypatch):
    layer_of("Polygon", SQUARE, role="keepout", names=["Bay"])
    outgoing = slow.window.desk.sending.outgoing
    work = outgoing._work

    def faulty(draft, afresh):
        if round(draft.points[0][0]) == 25:
            raise KeyError("x")
        return (yield from work(draft, afresh))

    monkeypatch.setattr(outgoing, "_work", faulty)
    slow.take("cone")
    for x in (20, 25, 30):
        slow.click((x, 20))
        slow.key(ENTER)
    assert ends(slow, 2) == [("r1", 20), ("r1", 30)]
    assert slow.complained("was not sent: a fault of the plugin: KeyError 'x'.")
