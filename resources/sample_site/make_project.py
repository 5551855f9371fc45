"""Make ``sample_site.qgz`` beside this file and the layer styles in ``resources/styles``.

Needs PyQGIS; ``make_sample_site.py`` runs it as a process of its own.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(ROOT), str(ROOT / "resources" / "styles")]

from project_file import save_project  # noqa: E402
from qgis.core import (  # noqa: E402
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsReferencedRectangle,
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QColor  # noqa: E402
from symbols import LOOKS, style  # noqa: E402

from robot_bridge.core.sites.settings import SiteSettings  # noqa: E402

GROUPS = {
    "Rules": ["keepouts"],
    "Obstacles": ["litter_bins", "benches", "columns", "walls", "stairs", "ramp", "buildings"],
    "Roads": ["road_centrelines", "road_surfaces"],
}
"""Groups and their layers, topmost first."""
ROLES = {
    "buildings": ("obstacle", '"height_m"', "'building,' || \"name\""),
    "walls": ("obstacle", '"height_m"', "'wall,' || \"name\""),
    "columns": ("obstacle", '"height_m"', "'column,' || \"name\""),
    "litter_bins": ("furniture", '"height_m"', "'litter bin,' || \"name\""),
    "benches": ("furniture", '"height_m"', "'bench,' || \"name\""),
    "stairs": ("stairs", '"height_m"', "'stairs,' || \"name\""),
    "ramp": ("ramp", "0", "'ramp,' || \"name\""),
    "road_centrelines": ("road_centreline", None, None),
    "road_surfaces": ("road_surface", None, None),
    "keepouts": ("keepout", None, None),
}
"""Role, height and semantics expression of each layer."""
TITLES = {
    "buildings": "Buildings",
    "walls": "Walls",
    "columns": "Columns",
    "litter_bins": "Litter bins",
    "benches": "Benches",
    "stairs": "Stairs",
    "ramp": "Ramp",
    "road_centrelines": "Road centrelines",
    "road_surfaces": "Road surfaces",
    "keepouts": "Keepouts",
    "orthophoto": "Orthophoto",
}


def main() -> None:
    """Write the project and the styles."""
    with tempfile.TemporaryDirectory(prefix="fleet-qgis-") as profile:
        application = QgsApplication([], True, profile)
        application.initQgis()
        _write_project(QgsProject.instance())
        application.exitQgis()


def _write_project(project: QgsProject) -> None:
    from published import SETTINGS

    project.setFileName(str(HERE / "sample_site.qgs"))
    project.setTitle(SETTINGS.name)
    project.setCrs(QgsCoordinateReferenceSystem(SETTINGS.crs))
    project.setBackgroundColor(QColor(232, 234, 230))
    project.writeEntry("fleet", "site", ".")
    _set_frame(project, SETTINGS)
    for name, members in GROUPS.items():
        _add_group(project, name, [_vector_layer(member) for member in members])
    _add_group(project, "Background", [_photo()])
    b, (x, y) = SETTINGS.bounds, SETTINGS.origin
    view = QgsRectangle(x + b.x_min - 4, y + b.y_min - 4, x + b.x_max + 4, y + b.y_max + 4)
    project.viewSettings().setDefaultViewExtent(QgsReferencedRectangle(view, project.crs()))
    save_project(project, HERE / "sample_site.qgz")
    project.clear()


def _set_frame(project: QgsProject, settings: SiteSettings) -> None:
    """Let expressions and layouts of the project use the site frame."""
    project.setCustomVariables(
        {
            "fleet_site": settings.id,
            "fleet_site_crs": settings.crs,
            "fleet_origin_x": settings.origin[0],
            "fleet_origin_y": settings.origin[1],
            "fleet_rotation_deg": settings.rotation_deg,
        }
    )


def _vector_layer(name: str) -> QgsVectorLayer:
    layer = QgsVectorLayer(f"{HERE / 'sample_site.gpkg'}|layername={name}", TITLES[name], "ogr")
    look = "ramps" if name == "ramp" else name
    style(layer, look)
    _save_style(layer, ROOT / "resources" / "styles" / f"{look}.qml")
    role, height, semantics = ROLES[name]
    layer.setCustomProperty("fleet/role", role)
    if height is not None:
        layer.setCustomProperty("fleet/height", height)
        layer.setCustomProperty("fleet/semantics", semantics)
        layer.setCustomProperty("fleet/outdoor", "true")
    layer.setDisplayExpression('"surface"' if name.startswith("road") else '"name"')
    return layer


def _save_style(layer: QgsVectorLayer, file: Path) -> None:
    """Keep how ``layer`` looks, and nothing that would take the role of the layer it is given to."""
    category = QgsMapLayer.StyleCategory
    looks = QgsMapLayer.StyleCategories(category.Symbology | category.Labeling | category.Rendering)
    message, saved = layer.saveNamedStyle(str(file), looks)
    if not saved:
        raise SystemExit(f"{file} cannot be written: {message}")


def _photo() -> QgsRasterLayer:
    layer = QgsRasterLayer(str(HERE / "orthophoto.tif"), TITLES["orthophoto"], "gdal")
    layer.setCustomProperty("fleet/role", "orthophoto")
    return layer


def _add_group(project: QgsProject, name: str, layers: list[QgsMapLayer]) -> None:
    group = project.layerTreeRoot().addGroup(name)
    for layer in layers:
        if not layer.isValid():
            raise SystemExit(
                f"{layer.source()} is not a layer QGIS can open: make the layers and the photo first."
            )
        project.addMapLayer(layer, False)
        group.addLayer(layer).setExpanded(layer.customProperty("fleet/role") == "road_surface")


assert set(LOOKS) - {"ramps"} == set(ROLES) - {"ramp"}, "every layer has a look"

if __name__ == "__main__":
    main()
