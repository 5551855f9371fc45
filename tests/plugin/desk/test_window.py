"""The panel, the message bar, the layer; and that nothing is left when the plugin goes."""

from __future__ import annotations

import threading
import time
from itertools import pairwise

import pytest
from fleet_supervisor.plugin.supervisor import FleetSupervisor
from fleet_supervisor.robot_bridge.messages import CommandState
from qgis.core import QgsApplication, QgsProject, QgsSettings, QgsVectorLayer
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt, QTimer
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAction,
    QApplication,
    QLabel,
    QLineEdit,
    QPushButton,
    QTableView,
    QToolButton,
    QTreeView,
)

from tests.plugin.desk.left_behind import left_behind

LEFT = Qt.MouseButton.LeftButton


def press(window, kind, name):
    QTest.mouseClick(window.dock.findChild(kind, name), LEFT)


def state_line(window):
    return window.dock.findChild(QLabel, "fleet_link_state").text()


def table(window):
    view = window.dock.findChild(QTableView, "fleet_robot_table")
    model = view.model()
    titles = [model.headerData(c, Qt.Orientation.Horizontal) for c in range(model.columnCount())]
    return view, [
        {title: model.index(row, column).data() for column, title in enumerate(titles)}
        for row in range(model.rowCount())
    ]


# --- the link ---


def test_typing_an_address_and_pressing_connect_shows_the_site(plugin, gateway, wait):
    window = plugin.window
    for name, text in (("fleet_url", gateway.url), ("fleet_operator", "anna")):
        field = window.dock.findChild(QLineEdit, name)
        field.selectAll()
        QTest.keyClicks(field, text)
    press(window, QToolButton, "fleet_connect_button")
    wait(lambda: "Connected" in state_line(window))
    assert "Yard, EPSG:32633" in state_line(window)
    assert gateway.asked("hello") == [{"operator": "anna", "protocol": 1}]


def test_url_and_operator_are_remembered(at_desk, gateway):
    assert QgsSettings().value("fleet_supervisor/url") == gateway.url
    assert QgsSettings().value("fleet_supervisor/operator") == "anna"


def test_the_default_is_a_gateway_on_this_computer(plugin):
    assert plugin.window.dock.connection_panel.url() == "ws://127.0.0.1:8765/desk"


def test_a_wrong_url_is_refused_in_words_and_the_button_comes_out_again(plugin, iface):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText("http://example.org")
    press(window, QToolButton, "fleet_connect_button")
    assert any("begins with http" in text for text in iface.texts())
    assert not window.actions.connect.isChecked()


def test_no_operator_is_refused_in_words(plugin, iface):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_operator").clear()
    press(window, QToolButton, "fleet_connect_button")
    assert any("operator's name is empty" in text for text in iface.texts())


def test_a_gateway_that_is_not_there_is_told_once_in_the_bar_and_always_in_the_panel(plugin, iface, wait):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText("ws://127.0.0.1:9/desk")
    window.actions.connect.trigger()
    wait(lambda: "Retrying" in state_line(window))
    assert "Nothing listens at 127.0.0.1:9" in state_line(window)
    QTest.qWait(2500)
    assert len([text for text in iface.texts() if "Nothing listens" in text]) == 1


def test_disconnecting_shows_it_and_the_robots_stay_and_age(at_desk, wait):
    press(at_desk, QToolButton, "fleet_connect_button")
    wait(lambda: "Not connected" in state_line(at_desk))
    assert len(table(at_desk)[1]) == 2
    first = at_desk.desk.picture.view("r1", at_desk.desk.clock()).age
    QTest.qWait(200)
    assert at_desk.desk.picture.view("r1", at_desk.desk.clock()).age > first + 0.15


def test_a_gateway_gone_in_mid_session_lets_robots_turn_stale_then_lost_and_comes_back(
    plugin, gateway, site, make_robot, wait
):
    import dataclasses

    gateway.site = dataclasses.replace(site, stale_after=0.5, lost_after=1.5)
    gateway.show(make_robot("r1"), make_robot("r2", stopped=True))
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    wait(lambda: len(window.desk.picture) == 2)
    gateway.stop()

    def states():
        return [row["State"] for row in table(window)[1]]

    wait(lambda: states() == ["stale", "offline"], 3, "stale")
    wait(lambda: states() == ["lost", "offline"], 3, "lost")
    layer = window.view.layer.layer
    wait(lambda: [f["state"] for f in layer.getFeatures()] == ["lost", "offline"], 3, "the layer")
    gateway.start()

    def fresh_again():
        gateway.show(make_robot("r1"))
        return states()[0] == "fresh"

    wait(fresh_again, 15, "the new link")
    assert "Connected" in state_line(window)


# --- robots ---


def test_the_table_tells_what_is_known_of_each_robot(at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r3", x=None, y=None, theta=None, v=None, battery=None, link="sql"))
    wait(lambda: len(table(at_desk)[1]) == 3)
    first, _, third = table(at_desk)[1]
    assert (first["Robot"], first["State"], first["Speed"], first["Batt."]) == (
        "r1",
        "fresh",
        "0.5 m/s",
        "80%",
    )
    assert first["Link"] == "ws"
    assert (third["Robot"], third["Speed"], third["Batt."], third["Link"]) == ("r3", "", "", "sql")


def test_the_table_sorts_by_number_and_keeps_the_selection(at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r3", v=10.0), make_robot("r4", v=9.0))
    wait(lambda: len(table(at_desk)[1]) == 4)
    at_desk.desk.select("r4")
    view, rows = table(at_desk)
    view.sortByColumn(list(rows[0]).index("Speed"), Qt.SortOrder.DescendingOrder)
    assert [row["Robot"] for row in table(at_desk)[1]][:2] == ["r3", "r4"]
    assert [index.data() for index in view.selectionModel().selectedRows()] == ["r4"]


def test_a_click_in_the_table_selects_on_the_map_and_in_the_layer(at_desk, wait):
    layer = at_desk.view.layer.layer
    wait(lambda: layer.featureCount() == 2, 3)
    view, _ = table(at_desk)
    wait(lambda: view.model().rowCount() == 2)
    QTest.mouseClick(view.viewport(), LEFT, pos=view.visualRect(view.model().index(1, 0)).center())
    assert at_desk.desk.selected == "r2"
    assert [feature["robot"] for feature in layer.selectedFeatures()] == ["r2"]


def test_a_selection_in_the_layer_selects_in_the_table(at_desk, wait):
    layer = at_desk.view.layer.layer
    wait(lambda: layer.featureCount() == 2, 3)
    layer.selectByExpression("robot = 'r2'")
    assert at_desk.desk.selected == "r2"
    view, _ = table(at_desk)
    assert [index.data() for index in view.selectionModel().selectedRows()] == ["r2"]


def test_a_double_click_in_the_table_goes_to_the_robot(at_desk, iface, wait):
    view, _ = table(at_desk)
    wait(lambda: view.model().rowCount() == 2)
    at = view.visualRect(view.model().index(1, 0)).center()
    QTest.mouseClick(view.viewport(), LEFT, pos=at)
    QTest.mouseDClick(view.viewport(), LEFT, pos=at)
    centre = iface.canvas.center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((80, 60), abs=1)
    assert 60 <= iface.canvas.extent().height() < 110


def test_a_followed_robot_stays_in_view(at_desk, gateway, iface, make_robot, wait):
    at_desk.desk.select("r1")
    at_desk.actions.follow.trigger()
    gateway.show(make_robot("r1", 190, 150))
    wait(lambda: abs(iface.canvas.center().x() - 488190) < 30, 4, "the map to follow")
    at_desk.actions.follow.trigger()
    gateway.show(make_robot("r1", 10, 10))
    QTest.qWait(1300)
    assert abs(iface.canvas.center().x() - 488190) < 30


def test_following_nobody_says_so(at_desk, iface):
    at_desk.actions.follow.trigger()
    assert any("No robot is selected to be followed" in text for text in iface.texts())


# --- the layer ---


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


# --- commands ---


def test_abort_asks_the_selected_robot_only(at_desk, gateway, wait):
    at_desk.desk.select("r2")
    press(at_desk, QToolButton, "fleet_abort_button")
    wait(lambda: gateway.asked("send"))
    (params,) = gateway.asked("send")
    assert (params["robot"], params["op"], params["params"]) == ("r2", "Abort", {})


def test_abort_without_a_robot_says_so(at_desk, iface, gateway):
    press(at_desk, QToolButton, "fleet_abort_button")
    assert any("none was aborted" in text for text in iface.texts())
    assert gateway.asked("send") == []


def test_abort_all_is_one_press_and_no_question(at_desk, gateway, wait):
    press(at_desk, QPushButton, "fleet_abort_all_button")
    assert QApplication.activeModalWidget() is None
    wait(lambda: gateway.asked("abort_all"))
    wait(lambda: len(at_desk.desk.book) == 2, what="both aborts")
    assert at_desk.dock.findChild(QLabel, "fleet_draft_text").text() == "ABORT ALL: sent to 2 robots"


def test_abort_all_without_a_link_says_loudly_that_nothing_was_sent(plugin, iface):
    press(plugin.window, QPushButton, "fleet_abort_all_button")
    (text,) = iface.texts()
    assert "ABORT ALL was NOT sent" in text
    assert "emergency stop" in text


def test_abort_all_is_repeated_when_the_link_broke_before_the_answer(at_desk, gateway, wait):
    gateway.mute.add("abort_all")
    press(at_desk, QPushButton, "fleet_abort_all_button")
    wait(lambda: gateway.asked("abort_all"))
    gateway.stop()
    gateway.mute.clear()
    wait(lambda: at_desk.desk.link.phase.value == "retrying")
    gateway.start()
    wait(lambda: len(gateway.asked("abort_all")) == 2, 8)
    first, again = gateway.asked("abort_all")
    assert first["command"] == again["command"]
    wait(lambda: len(at_desk.desk.orders) == 0)


def test_an_order_that_is_not_answered_is_told(at_desk, gateway, iface, wait):
    gateway.mute.add("abort_all")
    press(at_desk, QPushButton, "fleet_abort_all_button")
    wait(lambda: any("has not answered for 5 s" in text for text in iface.texts()), 7)


def test_the_log_shows_each_step_with_time_who_and_how_far_off(at_desk, gateway, iface, wait):
    at_desk.desk.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    press(at_desk, QToolButton, "fleet_send_button")
    wait(lambda: gateway.commands)
    (command,) = gateway.commands
    gateway.step(command, CommandState.DELIVERED, "gateway")
    gateway.step(command, CommandState.ACKNOWLEDGED, "r1")
    gateway.step(command, CommandState.REACHED, "r1", deviation=0.073)
    model = at_desk.dock.findChild(QTreeView, "fleet_command_log").model()
    wait(lambda: model.rowCount() == 1 and model.index(0, 2).data() == "reached")
    top = model.index(0, 0)
    assert model.index(0, 1).data().startswith("r1 · cone at ")
    assert model.index(0, 3).data() == "0.07 m off"
    steps = [
        [model.index(row, column, top).data() for column in (1, 2, 3)] for row in range(model.rowCount(top))
    ]
    assert steps == [
        ["by anna", "queued", ""],
        ["by gateway", "delivered", ""],
        ["by r1", "acknowledged", ""],
        ["by r1", "reached", "0.07 m off"],
    ]
    assert all(len(model.index(row, 0, top).data()) == 8 for row in range(4))


def test_the_log_is_filled_with_what_was_asked_before_this_desk_came(plugin, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    gateway._queue("command-1", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0, "cone": True})
    gateway._queue("command-2", "r1", "Abort", {})
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    model = window.dock.findChild(QTreeView, "fleet_command_log").model()
    wait(lambda: model.rowCount() == 2)
    assert [model.index(row, 1).data() for row in range(2)] == ["r1 · abort", "r1 · cone at 1.00, 2.00"]


# --- the window does not wait ---


def test_the_window_goes_on_while_a_gateway_hangs(at_desk, gateway, wait):
    release = threading.Event()
    gateway._loop.call_soon_threadsafe(release.wait)
    ticks = []
    timer = QTimer()
    timer.timeout.connect(lambda: ticks.append(time.monotonic()))
    timer.start(20)
    at_desk.desk.select("r1")
    at_desk.actions.abort.trigger()
    press(at_desk, QPushButton, "fleet_abort_all_button")
    at_desk.actions.connect.trigger()
    at_desk.actions.connect.trigger()
    QTest.qWait(1500)
    timer.stop()
    release.set()
    gaps = [b - a for a, b in pairwise(ticks)]
    assert max(gaps) < 0.35


def test_after_a_blocked_window_the_newest_position_is_shown_first(at_desk, gateway, make_robot):
    for x in range(100):
        gateway.show(make_robot("r1", float(x), 40))
    time.sleep(0.5)
    shown = []
    at_desk.desk.pulled.connect(lambda: shown.append(at_desk.desk.picture.view("r1", 0.0).report.x))
    QTest.qWait(250)
    assert shown[0] == 99.0


def test_a_text_is_not_repeated_while_it_is_shown_and_is_when_it_was_closed(plugin, iface):
    notices = plugin.window.notices
    for _ in range(5):
        notices.error("The bridge is up.")
    assert len(iface.texts()) == 1
    iface.bar.clearWidgets()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    notices.error("The bridge is up.")
    assert notices.texts() == ["The bridge is up."]


def test_long_texts_are_shown_whole(plugin, iface):
    text = "A long sentence that says what, where and what to do. " * 6
    plugin.window.notices.error(text)
    QTest.qWait(50)
    label = iface.bar.findChild(QLabel, "fleet_notice")
    needed = label.fontMetrics().boundingRect(
        0, 0, label.width(), 1000, Qt.TextFlag.TextWordWrap, label.text()
    )
    assert label.height() >= needed.height()


# --- unloading ---


def test_unloading_leaves_nothing_twice(iface, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    before = left_behind(iface)
    before_tool = iface.canvas.mapTool()
    for _ in range(2):
        plugin = FleetSupervisor(iface)
        plugin.initGui()
        window = plugin.window
        window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
        window.actions.connect.trigger()
        wait(lambda window=window: len(window.desk.picture) == 1)
        window.desk.select("r1")
        window.actions.cone.trigger()
        iface.click(60, 50)
        window.desk.abort_all()
        window.notices.error("Something")
        wait(lambda window=window: window.view.layer.layer.featureCount() == 1, 3)
        during = left_behind(iface)
        assert [kind for kind in before if during[kind] <= before[kind]] == []
        began = time.monotonic()
        plugin.unload()
        assert time.monotonic() - began < 4.0
        assert plugin.window is None
        assert left_behind(iface) == before
    assert iface.canvas.mapTool() is before_tool


def test_unloading_while_a_gateway_hangs_does_not_hang(iface, gateway, wait):
    plugin = FleetSupervisor(iface)
    plugin.initGui()
    plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    plugin.window.actions.connect.trigger()
    wait(lambda: plugin.window.desk.site is not None)
    release = threading.Event()
    gateway._loop.call_soon_threadsafe(release.wait)
    began = time.monotonic()
    plugin.unload()
    took = time.monotonic() - began
    release.set()
    assert took < 4.0


def test_a_group_with_layers_of_the_users_own_is_left_to_the_user(iface, plugin, gateway, wait):
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    wait(lambda: window.view.layer.layer is not None)
    own = QgsVectorLayer("Point?crs=EPSG:32633", "mine", "memory")
    QgsProject.instance().addMapLayer(own, False)
    QgsProject.instance().layerTreeRoot().findGroup("Fleet").addLayer(own)
    plugin.unload()
    assert [layer.name() for layer in QgsProject.instance().mapLayers().values()] == ["mine"]
    assert QgsProject.instance().layerTreeRoot().findGroup("Fleet") is not None


def test_unloading_twice_or_before_loading_does_no_harm(iface):
    plugin = FleetSupervisor(iface)
    plugin.unload()
    plugin.initGui()
    plugin.unload()
    plugin.unload()


def test_without_a_window_only_processing_is_loaded():
    before = len(QgsApplication.processingRegistry().providers())
    plugin = FleetSupervisor(None)
    plugin.initGui()
    assert plugin.window is None
    assert len(QgsApplication.processingRegistry().providers()) == before + 1
    plugin.unload()
    assert len(QgsApplication.processingRegistry().providers()) == before


def test_scripts_find_every_action_and_button_by_its_name(plugin, iface):
    names = [
        "connect",
        "cone_target",
        "draw_route",
        "send",
        "cancel",
        "select",
        "follow",
        "abort",
        "abort_all",
        "panel",
    ]
    assert all(iface.findChild(QAction, f"fleet_{name}") is not None for name in names)
