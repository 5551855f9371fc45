"""The preview: the segments of every layer drawn to scale, north of the site frame up."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from qgis.core import QgsFeedback
from qgis.PyQt.QtCore import QLineF, QPointF, QSize
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QPen

from ..language import tr
from ..sites.roles import FURNITURE, KEEPOUT, OBSTACLE, RAMP, ROAD_CENTRELINE, ROAD_SURFACE, STAIRS
from .measure import Measure

GROUND = QColor("#f7f8f9")
COLOURS = {
    ROAD_SURFACE: QColor("#c3c9cf"),
    ROAD_CENTRELINE: QColor("#8a949e"),
    KEEPOUT: QColor("#c1121f"),
    OBSTACLE: QColor("#1f3b4d"),
    FURNITURE: QColor("#1f3b4d"),
    STAIRS: QColor("#7b4ea3"),
    RAMP: QColor("#b5651d"),
}
"""The colour of a role's segments, in the order of drawing."""

MARGIN = 10
_EVERY = 5000


def draw(measures: Iterable[Measure], size: QSize, ratio: float, feedback: QgsFeedback) -> QImage | None:
    """Return a picture of ``size`` widget pixels at ``ratio`` device pixels each, None after a cancel."""
    drawn = [one for one in measures if len(one.segments)]
    image = QImage(size * ratio, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(ratio)
    image.fill(GROUND)
    if not drawn:
        return image
    order = list(COLOURS)
    drawn.sort(key=lambda one: order.index(one.role))
    placed = _placed([one.segments for one in drawn], size)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    try:
        for one, segments in zip(drawn, placed, strict=True):
            painter.setPen(QPen(COLOURS[one.role], 1.2))
            for first in range(0, len(segments), _EVERY):
                if feedback.isCanceled():
                    return None
                painter.drawLines([QLineF(*row) for row in segments[first : first + _EVERY].tolist()])
        _scale_bar(painter, size, _metres_to_pixels([one.segments for one in drawn], size))
    finally:
        painter.end()
    return image


def _placed(groups: Sequence[np.ndarray], size: QSize) -> list[np.ndarray]:
    """Return the segments in pixels, without those too short to be seen."""
    low, high = _extent(groups)
    scale = _metres_to_pixels(groups, size)
    middle = (low + high) / 2
    centre = np.array([size.width() / 2, size.height() / 2])
    flip = np.array([scale, -scale])
    placed = []
    for segments in groups:
        ends = (segments.reshape(-1, 2, 2) - middle) * flip + centre
        seen = np.abs(ends[:, 1] - ends[:, 0]).max(axis=1) > 0.3
        placed.append(ends[seen].reshape(-1, 4))
    return placed


def _metres_to_pixels(groups: Sequence[np.ndarray], size: QSize) -> float:
    low, high = _extent(groups)
    width, height = np.maximum(high - low, 1.0)
    return max(min((size.width() - 2 * MARGIN) / width, (size.height() - 2 * MARGIN) / height), 1e-9)


def _extent(groups: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    boxes = [(group.reshape(-1, 2).min(axis=0), group.reshape(-1, 2).max(axis=0)) for group in groups]
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def _scale_bar(painter: QPainter, size: QSize, scale: float) -> None:
    wanted = 0.25 * size.width() / scale
    step = 10.0 ** np.floor(np.log10(wanted))
    metres = max(step * factor for factor in (1, 2, 5) if step * factor <= wanted)
    length, y = metres * scale, size.height() - MARGIN
    painter.setPen(QPen(QColor("#30383f"), 2))
    painter.drawLine(QLineF(MARGIN, y, MARGIN + length, y))
    painter.drawText(QPointF(MARGIN, y - 5), tr("{metres:g} m", metres=metres))
