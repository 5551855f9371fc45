"""The list of layers, which the fleet panel squeezes where QGIS opens in a small window."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.panel.window import LAYERS_WIDTH, WIDENED, LayersWidth
from qgis.core import QgsSettings
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QDockWidget, QMainWindow, QWidget

SQUEEZED = 90


@pytest.fixture
def layers(qgis_app):
    """The list in a window of the size in which QGIS first opens on 1280 x 800, squeezed by a panel."""
    QgsSettings().remove(WIDENED)
    window = QMainWindow()
    window.setCentralWidget(QWidget())
    panel, layers = QDockWidget("Fleet", window), QDockWidget("Layers", window)
    panel.setFixedWidth(424)
    layers.setMinimumWidth(SQUEEZED)
    window.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, panel)
    window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, layers)
    window.resize(1024, 640)
    window.show()
    window.resizeDocks([layers], [SQUEEZED], Qt.Orientation.Horizontal)
    yield layers
    QgsSettings().remove(WIDENED)
    window.deleteLater()


def test_it_is_widened_once_when_the_window_has_room(layers, wait):
    window = layers.window()
    assert layers.width() == SQUEEZED

    def enlarge(size, width):
        """Enlarge the window until its map is wider, and ``width`` has looked at that."""
        before = window.centralWidget().width()
        window.resize(*size)
        wait(lambda: window.centralWidget().width() != before and not width._check.isActive())

    width = LayersWidth(window, window)
    enlarge((1100, 700), width)
    assert layers.width() == SQUEEZED, "the map would be too narrow"
    enlarge((1280, 800), width)
    wait(lambda: layers.width() == LAYERS_WIDTH)
    window.resizeDocks([layers], [SQUEEZED], Qt.Orientation.Horizontal)
    wait(lambda: layers.width() == SQUEEZED)
    enlarge((1700, 900), LayersWidth(window, window))
    assert layers.width() == SQUEEZED, "whoever narrowed it wants it so"
