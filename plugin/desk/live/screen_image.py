"""What changes seldom and takes long to paint: painted once for a screen, into an image that is kept."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtGui import QColor, QImage, QPainter

from .screen import Screen


def screen_image(screen: Screen, paint: Callable[[QPainter], None]) -> QImage:
    """Return a clear image as large as ``screen`` with what ``paint`` paints there, in logical pixels."""
    width, height = round(screen.width * screen.ratio), round(screen.height * screen.ratio)
    image = QImage(width, height, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(screen.ratio)
    image.fill(QColor(0, 0, 0, 0))
    painter = QPainter(image)
    paint(painter)
    painter.end()
    return image
