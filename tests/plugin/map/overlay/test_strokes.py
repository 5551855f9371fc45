"""Many lines as one path."""

from __future__ import annotations

import numpy as np
from fleet_supervisor.plugin.ui.glyphs import segments
from qgis.PyQt.QtGui import QColor, QImage, QPainter


def test_each_line_goes_from_its_start_to_its_end_and_to_no_other(qgis_app):
    start = np.array([(1.5, 2.0), (30.0, 40.0), (5.0, 5.0)])
    end = np.array([(9.25, 2.0), (30.0, 10.0), (6.0, 7.0)])
    path = segments(start, end)
    elements = [path.elementAt(k) for k in range(path.elementCount())]
    assert [element.isMoveTo() for element in elements] == [True, False] * 3
    assert [(element.x, element.y) for element in elements[0::2]] == [tuple(p) for p in start.tolist()]
    assert [(element.x, element.y) for element in elements[1::2]] == [tuple(p) for p in end.tolist()]


def test_they_are_drawn_where_they_are(qgis_app):
    image = QImage(60, 40, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(QColor(0, 0, 0, 0))
    painter = QPainter(image)
    start, end = np.array([(5.5, 10.5), (40.5, 30.5)]), np.array([(20.5, 10.5), (50.5, 30.5)])
    painter.strokePath(segments(start, end), painter.pen())
    painter.end()
    shown = [image.pixelColor(x, y).alpha() > 0 for x, y in ((12, 10), (45, 30), (30, 20), (30, 10))]
    assert shown == [True, True, False, False]
