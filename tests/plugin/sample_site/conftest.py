"""The sample site's folder, and a way to open a project as QGIS Desktop does and to draw it."""

import numpy as np
import pytest
from qgis.core import QgsApplication, QgsMapRendererParallelJob, QgsMapSettings, QgsProject, QgsRectangle
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QImage


@pytest.fixture(scope="session")
def sample_site(root):
    """The folder of the sample site."""
    return root / "resources" / "sample_site"


@pytest.fixture
def opened(qgis_app):
    """Return a function that opens a project and returns it with what QGIS complained about."""
    projects, complaints = [], []
    log = QgsApplication.messageLog()

    def listen(text, tag, level):
        complaints.append(f"{tag}: {text}")

    log.messageReceived.connect(listen)

    def open_project(file):
        project = QgsProject()
        projects.append(project)
        assert project.read(str(file)), project.error()
        return project, complaints

    yield open_project
    log.messageReceived.disconnect(listen)
    for project in projects:
        project.clear()


@pytest.fixture
def drawn():
    """Return a function that draws a project's default view as an array of (rows, columns, 3)."""

    def draw(project, layers=None, width=800, height=500):
        settings = QgsMapSettings()
        settings.setLayers(project.layerTreeRoot().layerOrder() if layers is None else layers)
        settings.setDestinationCrs(project.crs())
        settings.setOutputSize(QSize(width, height))
        settings.setExtent(QgsRectangle(project.viewSettings().defaultViewExtent()))
        job = QgsMapRendererParallelJob(settings)
        job.start()
        job.waitForFinished()
        assert job.errors() == []
        image = job.renderedImage().convertToFormat(QImage.Format.Format_RGB32)
        bits = image.constBits()
        bits.setsize(image.sizeInBytes())
        pixels = np.frombuffer(bytes(bits), dtype=np.uint8).reshape(image.height(), image.width(), 4)
        return pixels[..., 2::-1].astype(float)

    return draw
