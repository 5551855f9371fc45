"""All that is known of the selected robot, on the real panel."""

import base64
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.panel import robot_details
from fleet_supervisor.plugin.panel.robot_details import received_rows
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtCore import QBuffer, QIODevice, Qt
from qgis.PyQt.QtGui import QColor, QImage
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QToolButton, QTreeWidget

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def details(at_desk):
    at_desk.dock.tabs.setCurrentWidget(at_desk.dock.details)
    return at_desk.dock.details


def sections(details) -> dict[str, list[tuple[str, str]]]:
    tree = details.findChild(QTreeWidget, "fleet_details")
    tops = [tree.topLevelItem(k) for k in range(tree.topLevelItemCount())]
    return {
        top.text(0): [(top.child(k).text(0), top.child(k).text(1)) for k in range(top.childCount())]
        for top in tops
        if not top.isHidden()
    }


def an_image(colour="#ff0000", width=64, height=48) -> str:
    image = QImage(width, height, QImage.Format.Format_RGB32)
    image.fill(QColor(colour))
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image.save(buffer, "PNG")
    return base64.b64encode(bytes(buffer.data())).decode()


def seen(number, op="SendImage", **more):
    told = {"observation": number, "robot": "r1", "op": op, "object": "bin", "x": 51.0, "y": 42.0}
    return {**told, "received_at": 1.7e9, "state": "pending", **more}


def test_without_a_selection_it_says_what_to_do(details):
    assert details.findChild(QLabel, "fleet_details_title").text().startswith("Select a robot")
    assert sections(details) == {}


def test_a_long_name_of_a_row_is_not_cut_off(details, at_desk, monkeypatch):
    name = "Eltérés a pályától vagy céltól"
    monkeypatch.setattr(
        robot_details, "tr", lambda text, **values: name if text == "Task" else text.format(**values)
    )
    at_desk.desk.selection.select("r1")
    assert name in dict(sections(details)["Now"])
    tree = details.findChild(QTreeWidget, "fleet_details")
    child = tree.findItems(name, Qt.MatchFlag.MatchRecursive)[0]
    room = tree.visualItemRect(child).left() + tree.fontMetrics().horizontalAdvance(name)
    assert room < tree.columnWidth(0) <= tree.viewport().width() // 2


def test_diagnostics_are_shown_as_received_with_their_units(details, at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r1", 50.123, 40, status="brake hot", device_time=1.7e9, accuracy=0.05))
    at_desk.desk.selection.select("r1")
    wait(lambda: ("status", "brake hot") in sections(details).get("Diagnostics as received", []))
    told = dict(sections(details)["Diagnostics as received"])
    assert told["x"] == "50.123 m"
    assert told["accuracy"] == "0.05 m"
    assert told["device_time"].startswith("1700000000.0 (2023-11-1")
    now = dict(sections(details)["Now"])
    assert now["It says"] == "brake hot"
    assert now["Position, site frame"] == "50.12, 40.00"


def test_why_a_robot_may_be_elsewhere_is_told_once(details, at_desk, gateway, make_robot, wait):
    at_desk.desk.selection.select("r1")
    gateway.show(make_robot("r1", 50, 40, status="it leapt", doubt="it leapt"))
    wait(lambda: "Why elsewhere" in dict(sections(details).get("Now", [])))
    now = dict(sections(details)["Now"])
    assert now["Why elsewhere"] == "it leapt" and "It says" not in now
    assert now["State"].startswith("fresh, may be elsewhere, last heard")
    gateway.show(make_robot("r1", 50, 40, status="docking"))
    wait(lambda: "Why elsewhere" not in dict(sections(details)["Now"]))
    assert dict(sections(details)["Now"])["It says"] == "docking"


def test_what_was_not_heard_for_hours_is_told_in_hours(details, at_desk, monkeypatch):
    at_desk.desk.selection.select("r1")
    clock = at_desk.desk.clock
    monkeypatch.setattr(at_desk.desk, "clock", SimpleNamespace(steady=lambda: clock.steady() + 7215.3))
    details.refresh()
    assert "last heard 2.0 h ago over" in dict(sections(details)["Now"])["State"]


def test_nothing_received_is_left_out():
    assert received_rows({"robot": "r1", "odd": [1, 2], "v": 0.25}) == [
        ("robot", "r1"),
        ("odd", "[1, 2]"),
        ("v", "0.25 m/s"),
    ]


def test_commands_from_before_this_desk_are_asked_for(details, at_desk, gateway, wait):
    at_desk.desk.selection.select("r1")
    wait(lambda: {"robot": "r1", "limit": 200} in gateway.requests_of("get_commands"))
    gateway._queue("command-1", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0, "cone": True})
    gateway._queue("command-2", "r2", "Abort", {})
    gateway.step("command-1", CommandState.FAILED, "r1", reason="the wheel is blocked")
    wait(lambda: "Commands" in sections(details))
    ((_, told),) = sections(details)["Commands"]
    assert told == "cone at 1.00, 2.00: failed: the wheel is blocked, by anna"


def test_alarms_of_the_robot_are_among_it(details, at_desk, gateway, make_robot, wait):
    at_desk.desk.selection.select("r1")
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: "Alarms" in sections(details))
    assert sections(details)["Alarms"][0][1] == "r1 has 10% of its battery left (new)"


def test_the_last_image_is_fetched_decoded_and_shown(details, at_desk, gateway, wait):
    gateway.answers["get_observations"] = lambda params: {
        "result": {"observations": [seen(9, "SetObject"), seen(8), seen(7)]}
    }
    gateway.answers["get_image"] = lambda params: {"result": {"media_type": "image/png", "image": an_image()}}
    at_desk.desk.selection.select("r1")
    picture = details.findChild(QLabel, "fleet_last_image")
    wait(lambda: picture.isVisible())
    assert gateway.requests_of("get_image") == [{"observation": 8}]
    assert details.findChild(QLabel, "fleet_image_text").text() == "bin at 51.0, 42.0 m"
    shown = picture.pixmap().toImage()
    assert QColor(shown.pixel(shown.width() // 2, shown.height() // 2)) == QColor("#ff0000")
    gateway.answers["get_image"] = lambda params: {"result": {"image": an_image("#0000ff")}}
    QTest.mouseClick(details.findChild(QToolButton, "fleet_details_ask"), LEFT)
    wait(lambda: picture.pixmap().toImage().pixel(5, 5) == QColor("#0000ff").rgb())


@pytest.mark.parametrize("image", ["bm90IGFuIGltYWdl", "%%%"])
def test_an_image_that_cannot_be_read_is_said(details, at_desk, gateway, wait, image):
    gateway.answers["get_observations"] = lambda params: {"result": {"observations": [seen(8)]}}
    gateway.answers["get_image"] = lambda params: {"result": {"image": image}}
    at_desk.desk.selection.select("r1")
    wait(lambda: "cannot be read" in details.findChild(QLabel, "fleet_image_text").text())
    assert not details.findChild(QLabel, "fleet_last_image").isVisible()


def test_a_refused_image_and_no_image_are_said(details, at_desk, gateway, wait):
    gateway.refuse["get_observations"] = "viewers see no observations here"
    at_desk.desk.selection.select("r1")
    text = details.findChild(QLabel, "fleet_image_text")
    wait(lambda: text.text() == "No image: viewers see no observations here")
    gateway.refuse.clear()
    at_desk.desk.selection.select("r2")
    wait(lambda: text.text() == "r2 has sent no image lately")


def test_an_image_of_another_robot_is_not_shown_for_this_one(details, at_desk, gateway, wait):
    gateway.answers["get_observations"] = lambda params: {"result": {"observations": [seen(8)]}}
    gateway.answers["get_image"] = lambda params: {"result": {"image": an_image()}}
    at_desk.desk.selection.select("r1")
    picture = details.findChild(QLabel, "fleet_last_image")
    wait(lambda: picture.isVisible())
    gateway.mute.add("get_observations")
    at_desk.desk.selection.select("r2")
    wait(lambda: not picture.isVisible())
