"""From the site frame to the map: by the operation that the project prefers, and to a map without a CRS."""

from __future__ import annotations

import numpy as np
import pytest
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsPointXY,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel

from tests.plugin.conftest import ORIGIN

SITE, ED50 = (QgsCoordinateReferenceSystem(f"EPSG:{number}") for number in (32633, 23033))
OTHER_OPERATION = (
    "+proj=pipeline +step +inv +proj=utm +zone=33 +ellps=WGS84 +step +proj=push +v_3"
    " +step +proj=cart +ellps=WGS84 +step +proj=helmert +x=112 +y=77 +z=145"
    " +step +inv +proj=cart +ellps=intl +step +proj=pop +v_3 +step +proj=utm +zone=33 +ellps=intl"
)
"""ED50 to WGS 84 (16), which is Tunisia's: metres off what QGIS takes by itself."""


def on_map(window, x, y) -> QgsPointXY:
    """Where QGIS itself draws a place of the site."""
    way = QgsCoordinateTransform(SITE, ED50, window.desk.project.transformContext())
    return way.transform(QgsPointXY(ORIGIN[0] + x, ORIGIN[1] + y))


def pixel(iface, place):
    return iface.canvas.getCoordinateTransform().transform(place).toQPointF().toPoint()


def test_robots_and_clicks_follow_the_operation_that_the_project_prefers(at_desk, iface, wait):
    iface.canvas.setDestinationCrs(ED50)
    usual = on_map(at_desk, 50, 40)
    at_desk.view.zoom_to("r1")
    wait(lambda: at_desk.view.overlay.robot_at(pixel(iface, usual).x(), pixel(iface, usual).y()) == "r1")
    context = QgsCoordinateTransformContext()
    assert context.addCoordinateOperation(SITE, ED50, OTHER_OPERATION)
    at_desk.desk.project.setTransformContext(context)
    there = on_map(at_desk, 50, 40)
    assert there.distance(usual) > 10.0
    at_desk.view.zoom_to("r1")
    at = pixel(iface, there)
    wait(lambda: at_desk.view.overlay.robot_at(at.x(), at.y()) == "r1", what="the robot in its new place")
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    QTest.mouseClick(iface.canvas.viewport(), Qt.MouseButton.LeftButton, pos=at)
    wait(lambda: at_desk.desk.drafts.draft is not None, what="the cone")
    assert at_desk.desk.drafts.draft.points[0] == pytest.approx((50, 40), abs=0.5)


def test_in_a_project_without_a_crs_a_draft_says_what_the_map_is_taken_for(at_desk, iface, gateway, wait):
    told = at_desk.dock.findChild(QLabel, "fleet_draft_text")
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    assert "no CRS" not in told.text()
    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem())
    iface.look_at(0, 0, 120, 100)
    at = iface.pixel(50, 40)
    wait(lambda: at_desk.view.overlay.robot_at(at.x(), at.y()) == "r1", what="the robot")
    iface.click(70, 56)
    assert "The project has no CRS, so the map is taken to be in the site's, EPSG:32633" in told.text()
    np.testing.assert_allclose(at_desk.desk.drafts.draft.points, [(70, 56)], atol=0.5)
    QTest.keyClick(iface.canvas, Qt.Key.Key_Return)
    wait(lambda: gateway.requests_of("send"), what="the command")
