"""The pen that everything on the map is drawn with."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor, QPen


def pen(colour: QColor, width: float, strength: float = 1.0) -> QPen:
    """Return a pen with round ends, ``width`` pixels; ``strength`` 1 is the colour as it is, 0 nothing."""
    shade = QColor(colour)
    shade.setAlphaF(colour.alphaF() * strength)
    return QPen(shade, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin)
