"""Short texts as pictures, readable on any ground."""

from __future__ import annotations

import math

from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPixmap

from .colours import PAPER

INK = QColor("#101418")
MOST = 2000
MARGIN = 4


class Labels:
    """Makes each picture once; painting text anew for each robot and frame would cost more than all else."""

    def __init__(self) -> None:
        self._pictures: dict[tuple[str, float], QPixmap] = {}

    def picture(self, text: str, ratio: float) -> QPixmap:
        """Return ``text`` as a picture for ``ratio`` device pixels per logical pixel."""
        key = (text, ratio)
        if key not in self._pictures:
            if len(self._pictures) >= MOST:
                self._pictures.clear()
            self._pictures[key] = _drawn(text, ratio)
        return self._pictures[key]


def _drawn(text: str, ratio: float) -> QPixmap:
    font = QFont()
    font.setPixelSize(13)
    font.setBold(True)
    metrics = QFontMetricsF(font)
    width = math.ceil(metrics.horizontalAdvance(text)) + 2 * MARGIN
    height = math.ceil(metrics.height()) + 2 * MARGIN
    pixmap = QPixmap(math.ceil(width * ratio), math.ceil(height * ratio))
    pixmap.setDevicePixelRatio(ratio)
    pixmap.fill(QColor(0, 0, 0, 0))
    letters = QPainterPath()
    letters.addText(QPointF(MARGIN, MARGIN + metrics.ascent()), font, text)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(
        QPen(PAPER, 3.4, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin)
    )
    painter.drawPath(letters)
    painter.fillPath(letters, INK)
    painter.end()
    return pixmap
