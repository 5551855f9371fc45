"""What the tests of the live map share."""

from __future__ import annotations

import pytest
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtWidgets import QApplication


@pytest.fixture
def canvas(qgis_app):
    made = QgsMapCanvas()
    made.resize(600, 500)
    made.show()
    QApplication.processEvents()
    yield made
    made.stopRendering()
    made.close()
    made.deleteLater()
