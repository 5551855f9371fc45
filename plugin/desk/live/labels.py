"""Short texts as pictures, readable on any ground."""

from __future__ import annotations

import math

from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPixmap, QStaticText

from ...language import tr
from ..colours import PAPER

INK = QColor("#101418")
MOST = 600
"""Pictures that are kept: about twice as many as fit on a screen."""
MARGIN = 4
CASING = 1.6
"""Pixels of light around the letters."""
_AT = QPointF(MARGIN, MARGIN)
_AROUND = [
    _AT + QPointF(CASING * math.cos(turn), CASING * math.sin(turn))
    for turn in (k * math.pi / 4 for k in range(8))
]
"""Where the letters stand in their picture, and where the light around them."""
HEIGHT = 18
"""Logical pixels that a text needs from the one below it."""


class Labels:
    """Makes each picture once; painting text anew for each robot and frame would cost more than all else."""

    def __init__(self) -> None:
        self._pictures: dict[tuple[str, float], QPixmap] = {}

    def known(self, text: str, ratio: float) -> bool:
        """Tell whether the picture of ``text`` is there already."""
        return (text, ratio) in self._pictures

    def picture(self, text: str, ratio: float) -> QPixmap:
        """Return ``text`` as a picture for ``ratio`` device pixels per logical pixel."""
        key = (text, ratio)
        picture = self._pictures.pop(key, None)
        if picture is None:
            picture = _drawn(text, ratio)
        # Those longest unused stand first, and go first.
        self._pictures[key] = picture
        if len(self._pictures) > MOST:
            del self._pictures[next(iter(self._pictures))]
        return picture


def age_in_words(seconds: float) -> str:
    """Return how long ago, as in ``12 s``, ``5 min``, ``3 h``, ``2 d``."""
    if seconds < 60:
        return tr("{seconds:.0f} s", seconds=seconds)
    if seconds < 3600:
        return tr("{minutes:.0f} min", minutes=seconds / 60)
    return (
        tr(
            "{hours:.0f} h",
            hours=seconds / 3600,
        )
        if seconds < 48 * 3600
        else tr("{days:.0f} d", days=seconds / 86400)
    )


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
    painter = QPainter(pixmap)
    painter.setFont(font)
    painter.setPen(PAPER)
    written = QStaticText(text)
    written.setTextFormat(Qt.TextFormat.PlainText)
    # To stroke the letters' outlines would take six times as long as to write them eight times.
    for beside in _AROUND:
        painter.drawStaticText(beside, written)
    painter.setPen(INK)
    painter.drawStaticText(_AT, written)
    painter.end()
    return pixmap
