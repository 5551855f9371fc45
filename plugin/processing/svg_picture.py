"""An SVG as pixels, by Qt."""

from __future__ import annotations

from qgis.PyQt.QtCore import QBuffer, QByteArray, QIODevice, Qt
from qgis.PyQt.QtGui import QImage, QPainter
from qgis.PyQt.QtSvg import QSvgRenderer

from ..errors import FleetError
from ..language import tr

_SHARPNESS = 2
"""Pixels of the picture for each of the SVG, so that it can be printed."""


class PictureError(FleetError):
    """Qt cannot draw the picture."""


def png_of(svg: bytes) -> bytes:
    """Return the PNG of ``svg``; raises PictureError when Qt does not take it."""
    renderer = QSvgRenderer(QByteArray(svg))
    image = QImage(renderer.defaultSize() * _SHARPNESS, QImage.Format.Format_RGB32)
    if not renderer.isValid() or image.isNull():
        raise PictureError(
            tr("Qt cannot draw the picture of this map: choose svg and open that in a browser.")
        )
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    renderer.render(painter)
    painter.end()
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image.save(buffer, "PNG")
    return bytes(buffer.data())
