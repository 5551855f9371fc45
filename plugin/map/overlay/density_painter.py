"""Robots that are too many to be drawn one by one: cells as dark as there are robots in them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, QRectF
from qgis.PyQt.QtGui import QImage, QPainter, QTransform

from ....robot_bridge.core.messages.positions import Density
from ....robot_bridge.core.messages.safety import RobotState
from ...layers.site_transform import SiteToMapTransform
from ...ui.glyphs import STATE_COLOURS
from ...ui.language import tr_count
from .labels import Labels
from .primitives import FORMAT
from .scene import MapScene, Screen

FAINTEST, DARKEST = 0.3, 0.9
"""How much of the map a cell with one robot covers, and the fullest one."""
LEGEND_AT = 12
"""Pixels of the legend from the left and from below."""

Points = npt.NDArray[np.float64]


class DensityPainter:
    """Paints the density of a scene, and says beneath what it is."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._made: tuple[Density, SiteToMapTransform] | None = None
        self._image = QImage()
        self._corners: Points = np.empty((0, 2))
        """(3, 2): the first corner of the grid in the map, the one along its x, and the one along its y."""

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint it, where the scene has one."""
        fleet = placed.scene.fleet
        if fleet is None or fleet.density is None:
            self._made = None
            return
        density = fleet.density
        if self._made is None or self._made[0] is not density or self._made[1] is not placed.placement:
            self._made = density, placed.placement
            self._image, self._corners = _picture(density), _corners(density, placed.placement)
        (x, y), along, up = screen.pixels(self._corners).tolist()
        columns, rows = density.columns, density.rows
        painter.save()
        to_screen = QTransform(
            (along[0] - x) / columns, (along[1] - y) / columns, (up[0] - x) / rows, (up[1] - y) / rows, x, y
        )
        painter.setTransform(to_screen, True)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
        painter.drawImage(QRectF(0, 0, columns, rows), self._image)
        painter.restore()
        text = tr_count(
            fleet.inside,
            "1 robot here, shown as a density; zoom in to see it",
            "%n robots here, shown as a density; zoom in to see each",
        )
        legend = self._labels.picture(text, screen.ratio)
        height = legend.height() / screen.ratio
        painter.drawPixmap(QPointF(LEGEND_AT, screen.height - LEGEND_AT - height), legend)


def _corners(density: Density, placement: SiteToMapTransform) -> Points:
    x, y = density.x, density.y
    width, height = density.columns * density.cell, density.rows * density.cell
    return placement.to_map(np.array([(x, y), (x + width, y), (x, y + height)]))


def _picture(density: Density) -> QImage:
    """Return a pixel for each cell: its colour is that of its robots' states, its cover by how many."""
    counts = np.array([density.fresh, density.silent, density.offline], dtype=np.float64)
    total = counts.sum(axis=0)
    colours = [STATE_COLOURS[state] for state in (RobotState.FRESH, RobotState.LOST, RobotState.OFFLINE)]
    rgb = np.array([(c.red(), c.green(), c.blue()) for c in colours], dtype=np.float64)
    mixed = (counts / np.maximum(total, 1.0)).T @ rgb
    # By the root: a cell with four times as many covers twice as much, and the emptiest ones are seen.
    cover = FAINTEST + (DARKEST - FAINTEST) * np.sqrt(total / total.max(initial=1.0))
    pixels = np.zeros((density.rows * density.columns, 4), dtype=np.uint8)
    cells = np.array(density.cells, dtype=np.intp)
    # Premultiplied, and in memory blue first.
    pixels[cells, :3] = (mixed * cover[:, None])[:, ::-1]
    pixels[cells, 3] = 255 * cover
    image = QImage(pixels.tobytes(), density.columns, density.rows, 4 * density.columns, FORMAT)
    # Of its own: what it was made of goes.
    return image.copy()
