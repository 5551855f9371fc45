"""The view goes after the robots that are followed."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.scene import keep_in_view, show_places
from qgis.core import QgsPointXY
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtTest import QTest

from tests.plugin.map.on_canvas import scene_of, show


def is_shown(iface, x, y):
    at = iface.pixel(x, y)
    return iface.canvas.rect().contains(at)


def test_all_robots_are_kept_in_view(at_desk, gateway, iface, make_robot, wait):
    at_desk.actions.follow_all.trigger()
    gateway.show(make_robot("r1", 300, 20), make_robot("r2", -90, 60))
    wait(lambda: is_shown(iface, 300, 20) and is_shown(iface, -90, 60), 4, "both robots")
    assert is_shown(iface, 100, 40)


def test_several_selected_robots_are_kept_in_view_and_others_may_go(
    at_desk, gateway, iface, make_robot, wait
):
    gateway.show(make_robot("r3", 20, 20))
    wait(lambda: len(at_desk.desk.state.robots) == 3)
    at_desk.desk.selection.select_all(["r1", "r2"])
    at_desk.actions.follow.trigger()
    gateway.show(make_robot("r1", 260, 20), make_robot("r2", 330, 60))
    wait(lambda: is_shown(iface, 260, 20) and is_shown(iface, 330, 60), 4, "both robots")
    assert not is_shown(iface, 20, 20)


def test_only_one_of_both_ways_to_follow_is_on(at_desk, gateway, iface, make_robot):
    at_desk.desk.selection.select("r1")
    at_desk.actions.follow.trigger()
    at_desk.actions.follow_all.trigger()
    assert not at_desk.actions.follow.isChecked() and at_desk.actions.follow_all.isChecked()
    at_desk.actions.follow_all.trigger()
    centre = iface.canvas.center().x()
    gateway.show(make_robot("r1", 900, 900))
    QTest.qWait(1300)
    assert iface.canvas.center().x() == centre


@pytest.mark.parametrize("rotation", [0, 50])
def test_a_view_that_has_all_of_them_stays(at_desk, iface, rotation):
    iface.canvas.setRotation(rotation)
    iface.look_at(-100, -100, 300, 300)
    at_desk.actions.follow_all.trigger()
    before = _view(iface.canvas)
    QTest.qWait(1300)
    assert _view(iface.canvas) == pytest.approx(before)


@pytest.mark.parametrize("rotation", [0, 35, 90, 180, 260])
@pytest.mark.parametrize("across", [(180.0, 5.0), (5.0, 180.0), (90.0, -120.0)])
def test_all_of_the_places_that_are_gone_to_are_shown_and_little_else(canvas, rotation, across):
    canvas.resize(720, 400)
    canvas.setRotation(rotation)
    places = np.array([(1000.0, 2000.0), (1000.0 + across[0], 2000.0 + across[1])])
    show_places(canvas, places)
    to_pixel = canvas.getCoordinateTransform()
    seen = [to_pixel.transform(QgsPointXY(*place)) for place in places.tolist()]
    parts = np.array([(at.x() / canvas.width(), at.y() / canvas.height()) for at in seen])
    assert (parts > -0.01).all() and (parts < 1.01).all()
    assert np.ptp(parts, axis=0).max() > 0.98


@pytest.mark.parametrize("rotation", [0, 45, 200, 315])
def test_who_is_followed_comes_into_view_and_stays_there_on_a_rotated_map(canvas, site, rotation):
    places = np.array([(1000.0, 2000.0), (1090.0, 2000.0), (1000.0, 2090.0)])
    overlay = show(canvas, site, scene_of(), rotation=rotation)
    assert keep_in_view(canvas, overlay.screen(), places)
    assert not keep_in_view(canvas, overlay.screen(), places)
    to_pixel = canvas.getCoordinateTransform()
    for place in places.tolist():
        at = to_pixel.transform(QgsPointXY(*place))
        assert 0 < at.x() < canvas.width() and 0 < at.y() < canvas.height()


def _view(canvas: QgsMapCanvas) -> tuple[float, float, float]:
    """Where the view is and how large: a panel whose words change may take a pixel of the map's extent."""
    return canvas.center().x(), canvas.center().y(), canvas.mapUnitsPerPixel()
