"""What links play on the map is paused, sped up and sought by an operator."""

from __future__ import annotations

import pytest
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.links import LinkReport, Links, PlaybackReport
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QCheckBox, QComboBox, QDialog, QDoubleSpinBox, QLineEdit, QSlider

LINKS = Links([LinkReport("cars", "replay", True), LinkReport("agvs", "vda5050", True)])


@pytest.fixture
def window(plugin, iface, gateway, wait):
    """The window, open at a gateway whose link *cars* plays a recording of 600 s."""
    state = {
        "file": "cars.csv",
        "speed": 1.0,
        "paused": False,
        "loop": False,
        "place_s": 30.0,
        "length_s": 600.0,
    }

    def play(params):
        state.update({name: value for name, value in params.items() if name != "link"})
        return {"result": to_json(PlaybackReport(**state))}

    gateway.answers["set_playback"] = play
    panel = plugin.window.dock.connection_panel
    panel.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    plugin.window.actions.connect.trigger()
    desk = plugin.window.desk
    wait(lambda: desk.state.link.phase.value == "connected" and desk.state.site is not None, what="the link")
    wait(lambda: gateway.subscriptions, what="the subscription")
    iface.findChild(QAction, "fleet_recordings").trigger()
    dialog = iface.findChild(QDialog, "fleet_recordings_dialog")
    assert dialog.status.text() == "No link plays a recording at this gateway."
    assert not dialog.findChild(QSlider).isEnabled()
    gateway.tell("links", to_json(LINKS))
    wait(lambda: dialog.status.text() == "cars.csv: 30 s of 600 s", what="how it is played")
    return dialog


def changes(gateway):
    return [asked for asked in gateway.requests_of("set_playback") if len(asked) > 1]


def test_it_is_paused_sought_and_sped_up(window, gateway, wait):
    links = window.findChild(QComboBox, "fleet_recordings_link")
    assert [links.itemText(row) for row in range(links.count())] == ["cars"]
    slider = window.findChild(QSlider, "fleet_recordings_place")
    assert (slider.value(), slider.maximum()) == (30, 600)
    window.findChild(QCheckBox, "fleet_recordings_paused").click()
    QTest.keyClick(slider, Qt.Key.Key_PageUp)
    for name, value in (("fleet_recordings_seconds", "120.5"), ("fleet_recordings_speed", "10")):
        field = window.findChild(QDoubleSpinBox, name)
        field.lineEdit().setText(value)
        QTest.keyClick(field, Qt.Key.Key_Return)
    wait(lambda: len(changes(gateway)) == 4, what="four changes")
    told = [{name: value for name, value in one.items() if name != "link"} for one in changes(gateway)]
    assert told == [{"paused": True}, {"place_s": 40.0}, {"place_s": 120.5}, {"speed": 10.0}]
    assert window.isVisible(), "Enter closes nothing"
    wait(lambda: window.status.text() == "cars.csv: 120 s of 600 s")


def test_a_refusal_is_told_with_its_reason(window, gateway, wait):
    gateway.answers["set_playback"] = lambda _: {
        "error": {"code": -32000, "message": "link cars does not answer"}
    }
    window.findChild(QCheckBox, "fleet_recordings_loop").click()
    wait(lambda: window.status.text() == "✘ Recording of cars: link cars does not answer")
