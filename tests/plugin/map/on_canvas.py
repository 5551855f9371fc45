"""Scenes made by hand, shown on a bare canvas, and what is to be seen there."""

from __future__ import annotations

import math

import numpy as np
from fleet_supervisor.plugin.gateway_client.robot_states import STATES, RobotArrays
from fleet_supervisor.plugin.layers.site_transform import SiteToMapTransform
from fleet_supervisor.plugin.map.overlay.fleet_overlay import FleetOverlay
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer, SiteScene, TaskPath
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsProject, QgsRectangle
from qgis.PyQt.QtGui import QColor, QImage
from qgis.PyQt.QtWidgets import QApplication


def arrays(*robots, v=np.nan, accuracy=np.nan, age=0.0, doubted=False) -> RobotArrays:
    number = len(robots)
    return RobotArrays(
        names=[f"r{k}" for k in range(1, number + 1)],
        xy=np.array([(x, y) for x, y, _, _ in robots], dtype=float).reshape(-1, 2),
        theta=np.array([theta for _, _, theta, _ in robots], dtype=float),
        v=np.full(number, v),
        accuracy=np.full(number, accuracy),
        state=np.array([STATES.index(state) for _, _, _, state in robots], dtype=np.intp),
        age=np.full(number, age),
        doubted=np.full(number, doubted),
    )


def scene_of(*robots, chosen=(), plans=(), draft=None, now=100.0, **more) -> SiteScene:
    known = arrays(*robots, **more)
    rows = {name: row for row, name in enumerate(known.names)}
    return SiteScene(known, now=now, chosen=chosen, plans=list(plans), draft=draft, rows=rows)


def plan(robot, *points, cone=False) -> TaskPath:
    return TaskPath(f"command-{robot}", robot, np.array(points, dtype=float), cone)


def placement_of(canvas, site) -> SiteToMapTransform:
    return SiteToMapTransform(
        site, canvas.mapSettings().destinationCrs(), QgsProject.instance().transformContext()
    )


def show(canvas, site, scene, crs="EPSG:32633", rotation=0.0, trails=None) -> FleetOverlay:
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem(crs))
    placement = placement_of(canvas, site)
    canvas.setRotation(rotation)
    corners = placement.to_map(np.array([(0, 0), (120, 0), (120, 100), (0, 100)], dtype=float))
    canvas.setExtent(QgsRectangle(*corners.min(axis=0), *corners.max(axis=0)))
    QApplication.processEvents()
    overlay = FleetOverlay(canvas, trails)
    overlay.show_scene(SceneTransformer().placed(scene, placement))
    QApplication.processEvents()
    return overlay


def spots(canvas, colour: QColor, tolerance: int = 12) -> np.ndarray:
    """Return the (n, 2) pixels of the canvas that have ``colour``."""
    image = canvas.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    return where(image, colour, tolerance)


def where(image: QImage, colour: QColor, tolerance: int = 12) -> np.ndarray:
    bits = image.bits()
    bits.setsize(image.sizeInBytes())
    pixels = np.frombuffer(bits, np.uint8).reshape(image.height(), image.bytesPerLine() // 4, 4)
    wanted = np.array([colour.blue(), colour.green(), colour.red()], dtype=int)
    y, x = np.nonzero((np.abs(pixels[:, : image.width(), :3].astype(int) - wanted) <= tolerance).all(axis=2))
    return np.column_stack([x, y])


def expected(canvas, site, x, y) -> np.ndarray:
    """Return the pixel of a place in the site frame, by a way of its own through QGIS point by point."""
    from qgis.core import QgsCoordinateTransform

    c, s = math.cos(site.rotation), math.sin(site.rotation)
    east, north = site.origin[0] + c * x - s * y, site.origin[1] + s * x + c * y
    to_map = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem(site.crs), canvas.mapSettings().destinationCrs(), QgsProject.instance()
    )
    at = canvas.getCoordinateTransform().transform(to_map.transform(QgsPointXY(east, north)))
    return np.array([at.x(), at.y()])
