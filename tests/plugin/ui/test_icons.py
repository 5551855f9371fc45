"""Every icon is legible on light and on dark themes: enough of it stands out from what it lies on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from qgis.PyQt.QtGui import QColor, QIcon, QImage, QPainter
from qgis.PyQt.QtWidgets import QToolButton

ICONS = Path(__file__).parents[3] / "resources" / "icons"
SIZE = 24
STANDS_OUT = 3.0
"""The least contrast of graphics that have to be understood (WCAG 2.1, 1.4.11)."""
PART = 0.06
"""Of the icon's square: a line across it, a pixel and a half wide, is as much."""
GROUNDS = {"light": "#EFEFEF", "grey": "#727272", "dark": "#323232"}
"""Of QGIS's own look, and its themes Blend of Gray and Night Mapping."""


def luminance(rgb):
    part = rgb / 255.0
    linear = np.where(part <= 0.03928, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
    return linear @ np.array([0.2126, 0.7152, 0.0722])


def contrast(one, other):
    lighter, darker = np.maximum(one, other), np.minimum(one, other)
    return (lighter + 0.05) / (darker + 0.05)


def pixels(icon, ground):
    """(SIZE, SIZE, 3) RGB of an icon on a ground."""
    image = QImage(SIZE, SIZE, QImage.Format.Format_RGB32)
    image.fill(QColor(ground))
    painter = QPainter(image)
    icon.paint(painter, 0, 0, SIZE, SIZE)
    painter.end()
    raw = image.constBits().asstring(image.sizeInBytes())
    return np.frombuffer(raw, dtype=np.uint8).reshape(SIZE, SIZE, 4)[:, :, 2::-1].astype(float)


def share_that_stands_out(icon, ground):
    colour = QColor(ground)
    under = luminance(np.array([colour.red(), colour.green(), colour.blue()], dtype=float))
    return float((contrast(luminance(pixels(icon, ground)), under) >= STANDS_OUT).mean())


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("file", sorted(ICONS.glob("*.svg")), ids=lambda file: file.stem)
def test_an_icon_stands_out_from_what_it_lies_on(qgis_app, file, ground):
    assert share_that_stands_out(QIcon(str(file)), GROUNDS[ground]) >= PART


@pytest.mark.parametrize("ground", GROUNDS)
def test_the_button_of_the_connections_stands_out_too(plugin, ground):
    """QGIS's own icon of a connection is dark in each of its themes."""
    button = plugin.window.dock.findChild(QToolButton, "fleet_connections_button")
    assert share_that_stands_out(button.icon(), GROUNDS[ground]) >= PART


def test_an_icon_in_the_colour_of_its_ground_does_not(qgis_app, tmp_path):
    file = tmp_path / "dim.svg"
    file.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="24" height="24" viewBox="0 0 24 24">'
        '<path d="M3 12h18" stroke="#5f6b76" stroke-width="4"/></svg>'
    )
    assert share_that_stands_out(QIcon(str(file)), GROUNDS["dark"]) < PART
