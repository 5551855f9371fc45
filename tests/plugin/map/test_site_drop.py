"""A published site dragged onto the window, as files or from QGIS's browser panel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.publishing.publication import PLAIN, PLAIN_EDGE
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from fleet_supervisor.robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from fleet_supervisor.robot_bridge.core.sites.frame import SiteBounds
from fleet_supervisor.robot_bridge.core.sites.settings import SiteSettings
from fleet_supervisor.robot_bridge.core.sites.site import write_site
from qgis.core import (
    QgsDirectoryItem,
    QgsMapRendererSequentialJob,
    QgsMapSettings,
    QgsMimeDataUtils,
    QgsProject,
    QgsRectangle,
    QgsRenderContext,
)
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QColor

SITE = Path(__file__).parents[3] / "resources" / "sample_site"


def drop(iface, *paths):
    """Let each handler of the window have each file, as QGIS does."""
    return [any(handler.handleFileDrop(str(path)) for handler in iface.drop_handlers) for path in paths]


@pytest.mark.parametrize("name", ["", "site.toml", "site.gpkg"])
def test_a_published_site_that_is_dropped_is_loaded_with_roles_and_styles(plugin, iface, name):
    assert drop(iface, SITE / name) == [True]
    layers = {layer.name(): layer for layer in QgsProject.instance().mapLayers().values()}
    assert set(layers) == {"Keepouts", "Obstacles", "Road centrelines", "Road surfaces"}
    assert all(layer.isValid() and layer.featureCount() > 0 for layer in layers.values())
    assert layers["Keepouts"].customProperty("fleet/role") == "keepout"
    assert layers["Road surfaces"].renderer().type() == "categorizedSymbol"
    colours = {symbol.color().name() for symbol in layers["Obstacles"].renderer().symbols(QgsRenderContext())}
    assert colours == {PLAIN, PLAIN_EDGE}
    group = QgsProject.instance().layerTreeRoot().findGroup("Fleet")
    assert [child.name() for child in group.children()] == ["Sample proving ground and campus"]
    assert iface.texts() == ["Fleet Supervisor: Sample proving ground and campus: 4 layers loaded."]


def test_obstacles_of_every_shape_are_drawn(plugin, iface, tmp_path):
    square = np.array([[1.0, 1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 9.0], [1.0, 1.0]])
    rows = []
    for number, shape in enumerate(ShapeType):
        outline = square if shape.name.startswith(("CLOSED", "RAMP")) else square[:4]
        rows.append(OutlineRow(outline + np.array([10.0 * number, 0.0]), shape, 1.0, "", shape.name))
    settings = SiteSettings("yard", "Yard", 1, "EPSG:32633", (0.0, 0.0), SiteBounds(0.0, 0.0, 60.0, 10.0))
    write_site(tmp_path, settings, Outlines.from_rows(rows))
    drop(iface, tmp_path)
    (layer,) = QgsProject.instance().mapLayersByName("Obstacles")
    picture = drawn(layer, QgsRectangle(0.0, 0.0, 10.0 * len(rows), 10.0))
    widths = np.split(picture, len(rows), axis=1)
    assert {shape.name: bool(part.any()) for shape, part in zip(ShapeType, widths, strict=True)} == {
        shape.name: True for shape in ShapeType
    }


def drawn(layer, extent):
    """Where something of a layer is drawn, as rows of pixels, ten to a metre."""
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setOutputSize(QSize(round(10 * extent.width()), round(10 * extent.height())))
    settings.setExtent(extent)
    settings.setBackgroundColor(Qt.GlobalColor.white)
    job = QgsMapRendererSequentialJob(settings)
    job.start()
    job.waitForFinished()
    image = job.renderedImage()
    white = QColor(Qt.GlobalColor.white)
    return np.array(
        [[image.pixelColor(x, y) != white for x in range(image.width())] for y in range(image.height())]
    )


def test_dropped_twice_it_is_there_once(plugin, iface):
    drop(iface, SITE, SITE / "site.gpkg")
    assert len(QgsProject.instance().mapLayers()) == 4
    assert any("in the project already" in text for text in iface.texts())


def test_roles_that_other_layers_have_are_left_to_them(plugin, iface, make_layer):
    own = make_layer("mine", "Polygon")
    own.setCustomProperty("fleet/role", "keepout")
    QgsProject.instance().addMapLayer(own)
    drop(iface, SITE)
    loaded = QgsProject.instance().mapLayersByName("Keepouts")[0]
    assert not loaded.customProperty("fleet/role")
    assert any("other layers of the project have it: Keepouts" in text for text in iface.texts())


def drop_from_browser(iface, *items):
    """Let the window have items of QGIS's browser panel, dragged together, as QGIS does."""
    data = QgsMimeDataUtils.encodeUriList([uri for item in items for uri in item.mimeUris()])
    return any(handler.handleMimeDataV2(data) for handler in iface.drop_handlers)


def in_browser(folder):
    """The items of a folder in the browser panel, by their names."""
    return {item.name(): item for item in QgsDirectoryItem(None, "", str(folder)).createChildren()}


def test_a_published_site_comes_from_the_browser_panel(plugin, iface):
    assert drop_from_browser(iface, in_browser(SITE.parent)["sample_site"])
    assert len(QgsProject.instance().mapLayers()) == 4
    assert drop_from_browser(iface, in_browser(SITE)["site.gpkg"])
    assert any("in the project already" in text for text in iface.texts())


def test_what_is_no_site_in_the_browser_panel_is_left_to_qgis(plugin, iface):
    here = in_browser(SITE)
    assert not drop_from_browser(iface, here["drawing"])
    assert not drop_from_browser(iface, here["orthophoto.tif"])
    assert not drop_from_browser(iface, here["sample_site.gpkg"])
    assert not drop_from_browser(iface, here["site.gpkg"], here["orthophoto.tif"])
    assert not drop_from_browser(iface)
    assert QgsProject.instance().mapLayers() == {}


def test_what_is_no_site_is_left_to_qgis(plugin, iface, tmp_path):
    (tmp_path / "notes.txt").write_text("no site")
    other = tmp_path / "other.gpkg"
    other.write_bytes((SITE / "site.gpkg").read_bytes())
    assert drop(iface, tmp_path, tmp_path / "notes.txt", other, SITE / "orthophoto.tif") == [False] * 4
    assert QgsProject.instance().mapLayers() == {}


@pytest.mark.parametrize(
    ("content", "says"),
    [("", "names no site"), ('[site]\nname = "Yard"\n', "no site.gpkg"), (b"\xff\xfe", "cannot be read")],
)
def test_half_a_site_says_what_is_missing_and_loads_nothing(plugin, iface, tmp_path, content, says):
    file = tmp_path / "site.toml"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert drop(iface, tmp_path) == [True]
    assert any(says in text for text in iface.texts())
    assert QgsProject.instance().mapLayers() == {}
