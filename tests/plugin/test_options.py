"""The plugin's page in QGIS's options: what is set there is kept, and works at once."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.help import OPTIONS, HelpWindow
from fleet_supervisor.plugin.plugin import FleetPlugin
from fleet_supervisor.plugin.settings.profile import Preferences, read_preferences, write_preferences
from qgis.core import QgsSettings
from qgis.PyQt.QtCore import QPoint, QPointF, Qt
from qgis.PyQt.QtGui import QWheelEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QComboBox, QDoubleSpinBox, QLineEdit, QPushButton, QTabWidget


def wheel(at: QPointF, on_screen: QPoint) -> QWheelEvent:
    """A notch of the wheel towards the operator."""
    buttons, keys, phase = (
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
    )
    return QWheelEvent(at, QPointF(on_screen), QPoint(), QPoint(0, -120), buttons, keys, phase, False)


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
    assert read_preferences() == Preferences(4.0, 3.0, 2.0)
    window = plugin.window
    assert window.desk.connection.rate == 4.0
    assert window.view.layer_every == 60
    assert window.view.overlay._painter.robots.magnification == 2.0
    assert QgsSettings().value("fleet_supervisor/alarms/low_battery", type=float) == pytest.approx(0.35)


def test_what_was_set_counts_after_a_restart(iface):
    write_preferences(Preferences(robot_size=1.5))
    plugin = FleetPlugin(iface)
    plugin.initGui()
    try:
        assert plugin.window.view.overlay._painter.robots.magnification == 1.5
    finally:
        plugin.unload()


def test_positions_are_asked_for_at_the_rate_that_was_set(iface, gateway, wait):
    write_preferences(Preferences(positions_rate=4.0))
    plugin = FleetPlugin(iface)
    plugin.initGui()
    try:
        plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
        plugin.window.actions.connect.trigger()
        wait(lambda: gateway.requests_of("subscribe"))
        assert [params["rate"] for params in gateway.requests_of("subscribe")] == [4.0]
    finally:
        plugin.unload()


@pytest.mark.parametrize("value", ["many", "-1", "1e9", "nan"])
def test_settings_that_are_none_count_as_never_set(qgis_app, value):
    QgsSettings().setValue("fleet_supervisor/preferences/robot_size", value)
    assert read_preferences().robot_size == 1.0
    QgsSettings().remove("fleet_supervisor")


def test_larger_robots_are_painted_larger(at_desk, iface, wait, gateway, make_robot):
    at_desk.desk.selection.select("r1")

    def blue():
        # Anew: one that was silent for a while is of another colour.
        gateway.show(make_robot("r2", 80, 60))
        revision = at_desk.desk.state.robots.revision
        wait(lambda: at_desk.desk.state.robots.revision > revision)
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


def test_the_options_have_a_help_button(page):
    QTest.mouseClick(page.findChild(QPushButton, "fleet_options_help"), Qt.MouseButton.LeftButton)
    window = page.window().findChild(HelpWindow)
    assert window.topic == OPTIONS
    window.close()


def test_the_layers_style_draws_the_robots_where_the_layer_is_on_the_map(page, at_desk, iface):
    painter = at_desk.view.overlay._painter.robots
    box = page.findChild(QComboBox, "fleet_drawn_by_layer")
    assert box.currentData() is False
    box.setCurrentIndex(box.findData(True))
    page.apply()
    assert read_preferences().drawn_by_layer
    iface.canvas.setLayers([])
    at_desk.view.show_now()
    assert painter.arrows, "no robot would be seen"
    iface.canvas.setLayers([at_desk.view.layer.layer])
    at_desk.view.show_now()
    assert not painter.arrows
    box.setCurrentIndex(box.findData(False))
    page.apply()
    at_desk.view.show_now()
    assert painter.arrows and not read_preferences().drawn_by_layer


def test_alarms_are_scrolled_where_the_page_is_too_low_for_them(page, wait):
    tabs = page.findChild(QTabWidget, "fleet_options_tabs")
    tabs.setCurrentIndex(2)
    page.resize(960, 400)
    wait(lambda: page.height() == 400)
    last = tabs.currentWidget().findChildren(QDoubleSpinBox)[-1]
    assert last.visibleRegion().isEmpty()
    tabs.currentWidget().ensureWidgetVisible(last)
    wait(lambda: not last.visibleRegion().isEmpty())


def test_the_wheel_that_scrolls_the_alarms_changes_no_number(page, wait):
    tabs = page.findChild(QTabWidget, "fleet_options_tabs")
    tabs.setCurrentIndex(2)
    page.resize(960, 400)
    wait(lambda: page.height() == 400)
    area = tabs.currentWidget()
    numbers = area.findChildren(QDoubleSpinBox)
    before = [one.value() for one in numbers]
    for under in (area.viewport(), *numbers):
        middle = QPointF(under.rect().center())
        QApplication.sendEvent(under, wheel(middle, under.mapToGlobal(middle.toPoint())))
    assert area.verticalScrollBar().value() > 0
    assert [one.value() for one in numbers] == before
