"""What the plugin adds to QGIS beside its panel: options, locator, drops, keys, help; all is undone."""

from __future__ import annotations

import gc
import threading
from pathlib import Path

import pytest
from fleet_supervisor.plugin.desk.shortcuts import KEYS
from fleet_supervisor.plugin.help.help_window import DOCS, HelpWindow, heading_link
from fleet_supervisor.plugin.help.topics import ACCOUNTS, CONNECTIONS, OPTIONS, SITES, START, TOPICS, topic_of
from fleet_supervisor.plugin.locator.robot_filter import RobotFilter, ranked
from fleet_supervisor.plugin.locator.robot_locator import PREFIX_KEY
from fleet_supervisor.plugin.settings.preferences import Preferences, read_preferences, write_preferences
from fleet_supervisor.plugin.sites.published_layers import PLAIN
from fleet_supervisor.plugin.supervisor import FleetSupervisor
from qgis.core import (
    QgsApplication,
    QgsDirectoryItem,
    QgsExpression,
    QgsLocatorContext,
    QgsLocatorResult,
    QgsMimeDataUtils,
    QgsProject,
    QgsSettings,
)
from qgis.gui import QgsGui, QgsLocatorWidget
from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt, QThread, QUrl
from qgis.PyQt.QtTest import QSignalSpy, QTest
from qgis.PyQt.QtWidgets import (
    QApplication,
    QDoubleSpinBox,
    QLineEdit,
    QPushButton,
    QTableView,
    QTabWidget,
    QWidget,
)

SITE = Path(__file__).parents[3] / "resources" / "sample_site"


# --- the locator ---


def found(iface, text, wait):
    """What QGIS's locator finds for ``text``, typed with prefix and all."""
    spy = QSignalSpy(iface.locator.finished)
    results = []

    def keep(result):
        # A copy: the locator's own is gone when this returns.
        results.append(QgsLocatorResult(result))

    iface.locator.foundResult.connect(keep)
    iface.locator.fetchResults(text, QgsLocatorContext())
    wait(lambda: len(spy) > 0)
    QApplication.processEvents()
    iface.locator.foundResult.disconnect(keep)
    return results


def test_rb_and_a_name_finds_robots_goes_there_and_selects(at_desk, iface, wait, gateway, make_robot):
    gateway.show(make_robot("forklift-12", 150, 120))
    wait(lambda: QgsExpression("robot_state('forklift-12') IS NOT NULL").evaluate())
    results = found(iface, "rb lift", wait)
    assert [result.displayString for result in results] == ["forklift-12"]
    assert ", heard of " in results[0].description
    results[0].filter.triggerResult(results[0])
    assert at_desk.desk.selection == ("forklift-12",)
    centre = iface.canvas.center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((150, 120), abs=1)


@pytest.mark.parametrize(
    ("typed", "goes_to"),
    [
        ("rb r1", ["r1"]),
        ("RB r1 ", ["r1"]),
        # QGIS has not looked for the last letters yet, and hands on what it found for those before.
        ("rb r2", ["r2"]),
        ("r2", ["r2"]),
        ("rb r27", []),
        ("roads", []),
    ],
)
def test_enter_before_the_list_is_there_goes_by_what_is_typed(
    at_desk, iface, wait, monkeypatch, typed, goes_to
):
    locator = QgsLocatorWidget(iface.mainWindow())
    locator.findChild(QLineEdit).setText(typed)
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    (result,) = found(iface, "rb r1", wait)
    gone_to = []
    monkeypatch.setattr(result.filter, "_go", gone_to.append)
    result.filter.triggerResult(result)
    assert gone_to == goes_to


def test_a_row_that_was_chosen_counts(at_desk, iface, wait):
    locator = QgsLocatorWidget(iface.mainWindow())
    locator.findChild(QLineEdit).setText("rb r")
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    _, second = found(iface, "rb r", wait)
    second.filter.triggerResult(second)
    assert at_desk.desk.selection == ("r2",)


def test_rb_alone_lists_every_robot(at_desk, iface, wait):
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    assert sorted(result.displayString for result in found(iface, "rb ", wait)) == ["r1", "r2"]


def test_robots_are_looked_for_in_the_windows_thread(at_desk, iface, wait, monkeypatch):
    """A thread of QGIS's would wait for Python while unloading, in Python, waits for that thread."""
    threads = set()
    fetch = RobotFilter.fetchResults

    def noting(self, *given):
        threads.add(threading.current_thread())
        fetch(self, *given)

    monkeypatch.setattr(RobotFilter, "fetchResults", noting)
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    assert len(found(iface, "rb ", wait)) == 2
    assert threads == {threading.main_thread()}


def test_a_prefix_of_the_users_own_stays(iface, plugin):
    assert QgsSettings().value(PREFIX_KEY) == "rb"
    plugin.unload()
    assert QgsSettings().value(PREFIX_KEY, "") == ""
    QgsSettings().setValue(PREFIX_KEY, "bot")
    again = FleetSupervisor(iface)
    again.initGui()
    try:
        assert "bot" in [one.activePrefix() for one in iface.locator.filters()]
    finally:
        again.unload()
        assert QgsSettings().value(PREFIX_KEY) == "bot"
        QgsSettings().remove(PREFIX_KEY)


def test_the_same_name_comes_first_then_those_that_begin_so():
    names = ["x-r1", "r10", "r1", "b2"]
    assert [name for _, name in ranked("R1", names)] == ["r1", "r10", "x-r1"]


# --- drops ---


def drop(iface, *paths):
    """Let each handler of the window have each file, as QGIS does."""
    return [any(handler.handleFileDrop(str(path)) for handler in iface.drop_handlers) for path in paths]


@pytest.mark.parametrize("name", ["", "site.toml", "site.gpkg"])
def test_a_published_site_that_is_dropped_is_loaded_with_roles_and_styles(plugin, iface, name):
    assert drop(iface, SITE / name) == [True]
    layers = {layer.name(): layer for layer in QgsProject.instance().mapLayers().values()}
    assert set(layers) == {"Keepouts", "Obstacles", "Road centrelines", "Road surfaces"}
    assert all(layer.isValid() and layer.featureCount() > 0 for layer in layers.values())
    assert layers["Keepouts"].customProperty("fleet/role") == "keepout"
    assert layers["Road surfaces"].renderer().type() == "categorizedSymbol"
    assert layers["Obstacles"].renderer().symbol().color().name() == PLAIN
    group = QgsProject.instance().layerTreeRoot().findGroup("Fleet")
    assert [child.name() for child in group.children()] == ["Sample proving ground and campus"]
    assert iface.texts() == ["Fleet Supervisor: Sample proving ground and campus: 4 layers loaded."]


def test_dropped_twice_it_is_there_once(plugin, iface):
    drop(iface, SITE, SITE / "site.gpkg")
    assert len(QgsProject.instance().mapLayers()) == 4
    assert any("in the project already" in text for text in iface.texts())


def test_roles_that_other_layers_have_are_left_to_them(plugin, iface, make_layer):
    own = make_layer("mine", "Polygon")
    own.setCustomProperty("fleet/role", "keepout")
    QgsProject.instance().addMapLayer(own)
    drop(iface, SITE)
    loaded = QgsProject.instance().mapLayersByName("Keepouts")[0]
    assert not loaded.customProperty("fleet/role")
    assert any("Keepouts have no role" in text for text in iface.texts())


def drop_from_browser(iface, *items):
    """Let the window have items of QGIS's browser panel, dragged together, as QGIS does."""
    data = QgsMimeDataUtils.encodeUriList([uri for item in items for uri in item.mimeUris()])
    return any(handler.handleMimeDataV2(data) for handler in iface.drop_handlers)


def in_browser(folder):
    """The items of a folder in the browser panel, by their names."""
    return {item.name(): item for item in QgsDirectoryItem(None, "", str(folder)).createChildren()}


def test_a_published_site_comes_from_the_browser_panel(plugin, iface):
    assert drop_from_browser(iface, in_browser(SITE.parent)["sample_site"])
    assert len(QgsProject.instance().mapLayers()) == 4
    assert drop_from_browser(iface, in_browser(SITE)["site.gpkg"])
    assert any("in the project already" in text for text in iface.texts())


def test_what_is_no_site_in_the_browser_panel_is_left_to_qgis(plugin, iface):
    here = in_browser(SITE)
    assert not drop_from_browser(iface, here["drawing"])
    assert not drop_from_browser(iface, here["orthophoto.tif"])
    assert not drop_from_browser(iface, here["sample_site.gpkg"])
    assert not drop_from_browser(iface, here["site.gpkg"], here["orthophoto.tif"])
    assert not drop_from_browser(iface)
    assert QgsProject.instance().mapLayers() == {}


def test_what_is_no_site_is_left_to_qgis(plugin, iface, tmp_path):
    (tmp_path / "notes.txt").write_text("no site")
    other = tmp_path / "other.gpkg"
    other.write_bytes((SITE / "site.gpkg").read_bytes())
    assert drop(iface, tmp_path, tmp_path / "notes.txt", other, SITE / "orthophoto.tif") == [False] * 4
    assert QgsProject.instance().mapLayers() == {}


@pytest.mark.parametrize(
    ("content", "says"),
    [("", "names no site"), ('[site]\nname = "Yard"\n', "no site.gpkg"), (b"\xff\xfe", "cannot be read")],
)
def test_half_a_site_says_what_is_missing_and_loads_nothing(plugin, iface, tmp_path, content, says):
    file = tmp_path / "site.toml"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert drop(iface, tmp_path) == [True]
    assert any(says in text for text in iface.texts())
    assert QgsProject.instance().mapLayers() == {}


# --- options ---


@pytest.fixture
def page(plugin, iface):
    (factory,) = iface.options_pages
    page = factory.createWidget(iface)
    page.show()
    yield page
    page.close()
    page.deleteLater()


def test_what_is_set_is_kept_and_works_at_once(page, plugin):
    page.findChild(QTabWidget, "fleet_options_tabs").setCurrentIndex(1)
    for name, value in (("robot_size", 2.0), ("positions_rate", 4), ("layer_seconds", 3)):
        page.findChild(QDoubleSpinBox, f"fleet_{name}").setValue(value)
    page.findChild(QDoubleSpinBox, "fleet_low_battery").setValue(35)
    assert read_preferences() == Preferences()
    page.apply()
    assert read_preferences() == Preferences(4.0, 3.0, 2.0, "")
    window = plugin.window
    assert window.desk.connection.rate == 4.0
    assert window.view.layer_every == 60
    assert window.view.overlay._painter.robots.magnification == 2.0
    assert QgsSettings().value("fleet_supervisor/alarms/low_battery", type=float) == pytest.approx(0.35)


def test_what_was_set_counts_after_a_restart(iface):
    write_preferences(Preferences(robot_size=1.5))
    plugin = FleetSupervisor(iface)
    plugin.initGui()
    try:
        assert plugin.window.view.overlay._painter.robots.magnification == 1.5
    finally:
        plugin.unload()


def test_positions_are_asked_for_at_the_rate_that_was_set(iface, gateway, wait):
    write_preferences(Preferences(positions_rate=4.0))
    plugin = FleetSupervisor(iface)
    plugin.initGui()
    try:
        plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
        plugin.window.actions.connect.trigger()
        wait(lambda: gateway.asked("subscribe"))
        assert [params["rate"] for params in gateway.asked("subscribe")] == [4.0]
    finally:
        plugin.unload()


@pytest.mark.parametrize("value", ["many", "-1", "1e9", "nan"])
def test_settings_that_are_none_count_as_never_set(qgis_app, value):
    QgsSettings().setValue("fleet_supervisor/preferences/robot_size", value)
    assert read_preferences().robot_size == 1.0
    QgsSettings().remove("fleet_supervisor")


def test_larger_robots_are_painted_larger(at_desk, iface, wait, gateway, make_robot):
    at_desk.desk.select("r1")

    def blue():
        # Anew: one that was silent for a while is of another colour.
        gateway.show(make_robot("r2", 80, 60))
        revision = at_desk.desk.picture.revision
        wait(lambda: at_desk.desk.picture.revision > revision)
        at_desk.view.show_now()
        QApplication.processEvents()
        image = iface.canvas.grab().toImage()
        at = iface.pixel(80, 60)
        return sum(
            image.pixelColor(at.x() + dx, at.y() + dy).blue() > 150
            and image.pixelColor(at.x() + dx, at.y() + dy).red() < 60
            for dx in range(-40, 40)
            for dy in range(-40, 40)
        )

    as_it_comes = blue()
    at_desk.view.overlay.magnify(2.0)
    assert as_it_comes > 0
    assert blue() > 2.5 * as_it_comes


# --- keys ---


def test_keys_are_in_qgis_list_and_no_two_are_the_same(plugin):
    manager = QgsGui.shortcutsManager()
    for action in plugin.window.actions.all():
        if action.objectName() in KEYS:
            assert manager.defaultKeySequence(action) == KEYS[action.objectName()]
            assert action.shortcut().toString() == KEYS[action.objectName()]
    keys = [key.toString() for action in plugin.window.actions.all() for key in action.shortcuts()]
    assert len(keys) == len(set(keys))
    assert {"F10", "Pause"} <= set(keys)


def test_a_key_that_something_else_has_stays_with_it(iface):
    from qgis.PyQt.QtWidgets import QAction

    other = QAction("Something else", iface)
    QgsGui.shortcutsManager().registerAction(other, "F8")
    plugin = FleetSupervisor(iface)
    plugin.initGui()
    try:
        assert plugin.window.actions.cone.shortcut().isEmpty()
        assert other.shortcut().toString() == "F8"
    finally:
        plugin.unload()
        QgsGui.shortcutsManager().unregisterAction(other)


def test_f8_takes_the_cone_tool_and_f9_hides_the_panel(plugin, iface):
    QTest.keyClick(iface, Qt.Key.Key_F8)
    assert plugin.window.actions.cone.isChecked()
    was_shown = not plugin.window.dock.isHidden()
    QTest.keyClick(iface, Qt.Key.Key_F9)
    assert (not plugin.window.dock.isHidden()) is not was_shown


def test_tab_leads_through_the_connection_in_its_order(plugin, iface):
    panel = plugin.window.dock.connection_panel
    plugin.window.dock.show()
    iface.activateWindow()
    panel.findChild(QLineEdit, "fleet_url").setFocus()
    names = []
    for _ in range(4):
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Tab)
        names.append(QApplication.focusWidget().objectName())
    order = ["access_button", "operator", "connect_button", "connections_button"]
    assert names == [f"fleet_{name}" for name in order]


# --- help ---


def test_f1_explains_what_has_the_keyboard(plugin, iface):
    panel = plugin.window.dock
    panel.show()
    panel.findChild(QLineEdit, "fleet_operator").setFocus()
    QTest.keyClick(panel.findChild(QLineEdit, "fleet_operator"), Qt.Key.Key_F1)
    window = iface.findChild(HelpWindow)
    assert window.topic == TOPICS["fleet_operator"]
    panel.findChild(QTableView, "fleet_robot_table").setFocus()
    QTest.keyClick(panel.findChild(QTableView, "fleet_robot_table"), Qt.Key.Key_F1)
    assert window.topic == TOPICS["fleet_robot_table"]
    assert window.browser.verticalScrollBar().value() > 0
    assert len(iface.findChildren(HelpWindow)) == 1


def test_a_link_leads_to_another_page(plugin, iface):
    iface.plugin_help.actions()[-1].trigger()
    window = iface.findChild(HelpWindow)
    assert window.topic == START
    window._follow(QUrl("roads.md#closed-roads"))
    assert (window.topic.page, window.topic.heading) == ("roads", "closed-roads")
    assert "Closed roads" in window.browser.toPlainText()


@pytest.mark.parametrize(
    "topic", sorted({START, CONNECTIONS, OPTIONS, ACCOUNTS, SITES, *TOPICS.values()}, key=str), ids=str
)
def test_every_topic_is_a_heading_of_a_guide(topic):
    text = (DOCS / f"{topic.page}.md").read_text(encoding="utf-8")
    headings = [heading_link(line.lstrip("# ")) for line in text.splitlines() if line.startswith("#")]
    assert not topic.heading or topic.heading in headings


def test_every_widget_of_a_topic_is_in_the_panel(plugin):
    for name in TOPICS:
        widget = plugin.window.dock.findChild(QWidget, name)
        assert widget is not None, name
        assert topic_of(widget) == TOPICS[name]


def test_the_options_have_a_help_button(page):
    QTest.mouseClick(page.findChild(QPushButton, "fleet_options_help"), Qt.MouseButton.LeftButton)
    window = page.window().findChild(HelpWindow)
    assert window.topic == OPTIONS
    window.close()


# --- ten times over ---


def registered(iface):
    """What of the plugin QGIS knows, by kind."""
    QApplication.processEvents()
    gc.collect()
    manager = QgsGui.shortcutsManager()
    return {
        "locator filters": len(iface.locator.filters()),
        "options pages": len(iface.options_pages),
        "drop handlers": len(iface.drop_handlers),
        "help entries": len(iface.plugin_help.actions()),
        "menu entries": len(iface.plugins.actions()),
        "shortcuts": len(manager.listActions()),
        "expression functions": len(QgsExpression.Functions()),
        "providers": len(QgsApplication.processingRegistry().providers()),
        "layers": len(QgsProject.instance().mapLayers()),
        "groups": len(QgsProject.instance().layerTreeRoot().children()),
        "canvas items": len(iface.canvas.scene().items()),
        "message bar": len(iface.texts()),
        "threads": threading.active_count(),
        "Qt threads": len([one for one in gc.get_objects() if isinstance(one, QThread) and one.isRunning()]),
    }


def test_loaded_ten_times_nothing_is_doubled_and_nothing_left(iface, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    # As QGIS does when it starts, with the actions of plugins that are there by then.
    manager = QgsGui.shortcutsManager()
    manager.registerAllChildren(iface)
    before, loaded = registered(iface), None
    for _ in range(10):
        plugin = FleetSupervisor(iface)
        plugin.initGui()
        plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
        plugin.window.actions.connect.trigger()
        wait(lambda plugin=plugin: plugin.window.view.layer.layer is not None)
        manager.registerAllChildren(iface)
        now = registered(iface)
        loaded = loaded or now
        assert now == loaded
        plugin.unload()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        assert registered(iface) == before
    for kind in ("locator filters", "options pages", "drop handlers", "help entries", "shortcuts"):
        assert loaded[kind] > before[kind]
