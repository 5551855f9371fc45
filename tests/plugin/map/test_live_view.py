"""The whole way from what the gateway tells to what is on the canvas."""

from __future__ import annotations

import time
from types import SimpleNamespace

import numpy as np
import pytest
from fleet_supervisor.plugin.map.live_view import EVERY_SECOND
from fleet_supervisor.plugin.map.overlay.scene import FollowMode
from fleet_supervisor.plugin.ui.glyphs import TRAIL
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsPointXY
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel


def is_blue(iface, x, y):
    """Tell whether the trail's colour is at a place of the site."""
    image = iface.canvas.grab().toImage()
    at = iface.pixel(x, y)
    around = [(at.x() + dx, at.y() + dy) for dx in (-2, 0, 2) for dy in (-2, 0, 2)]
    colours = [QColor(image.pixel(*spot)) for spot in around if image.rect().contains(*spot)]
    return any(abs(colour.red() - TRAIL.red()) < 40 and colour.blue() > 230 for colour in colours)


@pytest.fixture
def driven(at_desk, gateway, make_robot, iface, wait):
    """r1 has driven 20 m to the east, half a metre a message."""
    desk = at_desk.desk
    began = desk.clock.steady()
    ahead = [0.0]
    desk.clock = SimpleNamespace(steady=lambda: began + ahead[0])
    for step in range(41):
        ahead[0] += 0.5
        gateway.show(make_robot("r1", 50 + step / 2, 40, v=1.0))
        x = 50 + step / 2
        wait(lambda x=x: desk.state.robots.view("r1", desk.clock.steady()).report.x == x)
        at_desk.view.show_now()
    return at_desk


def test_a_trail_is_painted_and_is_there_again_after_the_view_has_moved(driven, iface, wait):
    assert is_blue(iface, 62, 40)
    iface.look_at(40, 20, 80, 55)
    wait(lambda: is_blue(iface, 62, 40) and is_blue(iface, 56, 40), what="the trail")
    iface.canvas.setRotation(70)
    wait(lambda: is_blue(iface, 62, 40) and is_blue(iface, 56, 40), what="the trail")


def test_robots_are_placed_anew_when_the_map_gets_another_crs(at_desk, gateway, iface, make_robot, wait):
    gateway.show(make_robot("r1", 60, 30))
    wait(lambda: at_desk.desk.state.robots.row("r1") is not None)
    other = QgsCoordinateReferenceSystem("EPSG:3857")
    iface.canvas.setDestinationCrs(other)
    way = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem("EPSG:32633"), other, at_desk.desk.project.transformContext()
    )
    origin = at_desk.desk.state.site.origin
    place = way.transform(QgsPointXY(origin[0] + 60, origin[1] + 30))

    def is_there():
        at = iface.canvas.getCoordinateTransform().transform(place)
        return at_desk.view.overlay.robot_at(at.x(), at.y()) == "r1"

    wait(is_there, what="the robot in the other CRS")


def test_a_robot_that_the_map_cannot_place_hinders_neither_following_nor_zooming(
    at_desk, gateway, iface, make_robot, wait
):
    gateway.show(make_robot("far", 8e7, 9e7))
    wait(lambda: at_desk.desk.state.robots.row("far") is not None)
    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:3857"))
    ((x, y),) = at_desk.desk.site_to_canvas.transform().to_map(np.array([(50.0, 40.0)]))

    def sees_r1():
        return iface.canvas.extent().contains(QgsPointXY(x, y))

    iface.canvas.setCenter(QgsPointXY(x + 1e5, y))
    at_desk.view.zoom_to("r1", "far")
    assert sees_r1()
    assert any("has no place in EPSG:3857" in text for text in iface.texts())
    iface.canvas.setCenter(QgsPointXY(x + 1e5, y))
    assert not sees_r1()
    at_desk.view.follow(FollowMode.ALL)
    wait(sees_r1, what="r1, which is followed")


YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
"""A CRS of its own, of which nobody knows where on the Earth it is."""


def test_that_the_map_cannot_show_the_site_is_reported_once_and_until_it_can(at_desk, iface, wait):
    desk, view = at_desk.desk, at_desk.view
    site_crs = iface.canvas.mapSettings().destinationCrs()

    def is_told():
        return any("Choose the site's CRS as the project's" in text for text in iface.texts())

    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem(YARD))
    wait(is_told, what="why the map is empty")
    desk.failed.emit("EMERGENCY STOP is NOT sent yet")
    posted = []
    desk.messages.posted.connect(lambda text, level: posted.append(text))
    view.follow(FollowMode.ALL)
    updates = []
    desk.state.updated.connect(lambda: updates.append(1))
    wait(lambda: len(updates) > 2 * EVERY_SECOND, 20.0, what="updates")
    view.show_now()
    assert posted == []
    assert "NOT sent yet" in iface.bar.currentItem().findChild(QLabel, "fleet_notice").text()
    iface.canvas.setDestinationCrs(site_crs)
    wait(lambda: not is_told(), what="the end of the message")
    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem(YARD))
    wait(is_told, what="the message again")


def test_a_new_position_is_painted_without_anything_else_happening(at_desk, gateway, iface, make_robot, wait):
    for x in (30, 70, 100):
        gateway.show(make_robot("r1", x, 20))
        at = iface.pixel(x, 20)
        wait(lambda at=at: at_desk.view.overlay.robot_at(at.x(), at.y()) == "r1")
        frames = at_desk.view.overlay.frames
        wait(lambda frames=frames: at_desk.view.overlay.frames > frames, 2)


def test_nothing_is_painted_in_vain(at_desk, wait):
    overlay = at_desk.view.overlay
    QTest.qWait(300)
    before, began = overlay.frames, time.monotonic()
    QTest.qWait(2000)
    # Ages go on twice a second; nothing else does.
    assert overlay.frames - before <= 4 * (time.monotonic() - began)
    wait(lambda: overlay.frames >= before + 2, what="two frames")


def test_robots_of_another_site_leave_nothing_behind(driven, gateway, site, iface, make_robot, wait):
    from dataclasses import replace

    gateway.stop()
    gateway.robots.clear()
    gateway.site = replace(site, id="other", name="Other")
    gateway.show(make_robot("z9", 20, 20))
    wait(lambda: driven.desk.state.link.phase.value == "retrying")
    gateway.start()
    wait(lambda: len(driven.desk.state.robots) == 1 and driven.desk.state.robots.row("z9") == 0, 15)
    wait(lambda: driven.view.layer.layer.featureCount() == 1)
    assert [feature["robot"] for feature in driven.view.layer.layer.getFeatures()] == ["z9"]
    assert not is_blue(iface, 62, 40)
    at = iface.pixel(20, 20)
    wait(lambda: driven.view.overlay.robot_at(at.x(), at.y()) == "z9")


def test_another_gateway_of_the_same_site_has_nothing_of_the_one_before(
    driven, gateway, site, iface, make_robot, wait
):
    desk = driven.desk
    desk.selection.select("r1")
    desk.orders.abort("r1")
    wait(lambda: len(desk.state.commands) == 1)
    other = type(gateway)(site)
    other.start()
    try:
        other.show(make_robot("z9", 20, 20))
        rows = []
        desk.state.site_changed.connect(lambda: rows.append(driven.dock.table.model().rowCount()))
        desk.open_link(other.url, "anna")
        wait(lambda: len(desk.state.robots) == 1 and desk.state.robots.row("z9") == 0)
        assert len(desk.state.commands) == 0 and desk.selection.last is None
        assert driven.dock.log.view.model().rowCount() == 0
        # Not for a moment does a row show what another robot said.
        assert rows == [0]
        assert "Abort" not in driven.dock.findChild(QLabel, "fleet_draft_text").text()
        assert not is_blue(iface, 62, 40)
    finally:
        desk.close_link()
        other.stop()


def test_the_same_gateway_again_takes_nothing_away(driven, gateway, wait):
    desk = driven.desk
    desk.selection.select("r1")
    desk.close_link()
    wait(lambda: desk.state.link.phase.value == "closed")
    desk.open_link(gateway.url, "anna")
    wait(lambda: desk.state.link.phase.value == "connected")
    assert desk.selection.last == "r1" and len(desk.state.robots) == 2


def test_a_thousand_newcomers_are_in_table_and_layer_without_the_window_waiting(
    at_desk, gateway, iface, make_robot, wait
):
    rng = np.random.default_rng(2)
    crowd = [make_robot(f"n{k}", *rng.uniform(0, 100, 2).tolist()) for k in range(1000)]
    gateway.show(*crowd)
    wait(lambda: len(at_desk.desk.state.robots) == 1002, 20)
    wait(lambda: at_desk.view.layer.layer.featureCount() == 1002, 20)
    model = at_desk.dock.table.model()
    wait(lambda: model.rowCount() == 1002, 20)
    names = [model.index(row, 0).data() for row in range(3)]
    assert names == sorted(names)
