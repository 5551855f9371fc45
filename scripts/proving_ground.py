"""Make a site of the real proving ground: its published form and a QGIS project with the drone photo.

    .venv/bin/python scripts/proving_ground.py OUT_DIR DATA_DIR

``DATA_DIR`` is the folder of real data beside the project (``../shared/data``, see its README). The photo is
shown from where it lies; only what is derived from the data is written, and only to ``OUT_DIR``:
``site.toml``, ``site.gpkg`` and ``proving_ground.qgz``. Lane borders are paint, not obstacles, so there are
none.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import shapely

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "resources" / "styles")]

from robot_bridge.roads.surfaces.surface import Surface  # noqa: E402
from robot_bridge.robotmap.outlines import Outlines  # noqa: E402
from robot_bridge.sites.features import Centreline  # noqa: E402
from robot_bridge.sites.frame import SiteFrame  # noqa: E402
from robot_bridge.sites.projections import projections  # noqa: E402
from robot_bridge.sites.publication import write_site  # noqa: E402
from robot_bridge.sites.settings import Bounds, SiteSettings  # noqa: E402

CENTRELINES = "university_track_centrelines.geojson"
SURFACES = "university_track_surfaces_derived_utm33.gpkg"
PHOTO = "zalazone_university_track_utm33_35cm.tif"
SETTINGS = SiteSettings(
    id="zalazone-university-track",
    name="ZalaZONE university track",
    version=1,
    crs="EPSG:32633",
    origin=(639988.0, 5193408.4),
    bounds=Bounds(0.0, 0.0, 322.35, 355.6),
)
"""The origin is the south-west corner of the photo, the bounds are the photo's."""


def main(out: Path, data: Path) -> None:
    """Make the site and the project in ``out``."""
    source = data / "zalazone" if (data / "zalazone").is_dir() else data
    for name in (CENTRELINES, SURFACES, PHOTO):
        if not (source / name).is_file():
            raise SystemExit(f"{source / name} is missing: give the folder of real data as DATA_DIR.")
    out.mkdir(parents=True, exist_ok=True)
    surfaces = read_surfaces(source / SURFACES)
    write_site(
        out,
        SETTINGS,
        Outlines.from_rows([]),
        centrelines(source / CENTRELINES, surfaces, SETTINGS.frame),
        areas(surfaces, SETTINGS.frame),
    )
    make_project(out, source / PHOTO)
    print(f"{out}: site.toml, site.gpkg and proving_ground.qgz of {SETTINGS.name}")


def read_surfaces(file: Path) -> list[tuple[str, shapely.Geometry]]:
    """Return (class, geometry in EPSG:32633) of each digitised road surface."""
    pyogrio = _pyogrio()
    _, _, wkb, (classes,) = pyogrio.raw.read(str(file), columns=["surface"])
    words = [name.replace("_", " ") for name in classes]
    return list(zip(words, shapely.from_wkb(wkb), strict=True))


def centrelines(
    file: Path, surfaces: list[tuple[str, shapely.Geometry]], frame: SiteFrame
) -> list[Centreline]:
    """Return the lanes' middles, each with the surface that most of it lies on."""
    transformer = projections().Transformer.from_crs("EPSG:4326", SETTINGS.crs, always_xy=True)
    _, _, wkb, (widths,) = _pyogrio().raw.read(str(file), columns=["width_m"])
    lines = []
    for geometry, width in zip(shapely.from_wkb(wkb), widths, strict=True):
        longitude, latitude = shapely.get_coordinates(geometry).T
        xy = np.column_stack(transformer.transform(longitude, latitude))
        line = shapely.LineString(xy)
        surface, _ = max(surfaces, key=lambda item: item[1].intersection(line).length)
        lines.append(Centreline(frame.to_site(xy), float(width), surface))
    return lines


def _pyogrio():
    projections()  # which imports pyproj without its warning
    import pyogrio.raw

    return pyogrio


def areas(surfaces: list[tuple[str, shapely.Geometry]], frame: SiteFrame) -> list[Surface]:
    """Return the road surfaces as polygons in the site frame."""
    return [
        Surface(
            tuple(frame.to_site(shapely.get_coordinates(r)) for r in (part.exterior, *part.interiors)),
            surface,
        )
        for surface, geometry in surfaces
        for part in shapely.get_parts(geometry)
    ]


def make_project(out: Path, photo: Path) -> None:
    """Write ``proving_ground.qgz``: the photo from where it lies, the published roads in the usual styles."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    with tempfile.TemporaryDirectory(prefix="fleet-qgis-") as profile:
        application = QgsApplication([], True, profile)
        application.initQgis()
        _write_project(out, photo)
        application.exitQgis()


def _write_project(out: Path, photo: Path) -> None:
    from qgis.core import (
        QgsCoordinateReferenceSystem,
        QgsProject,
        QgsRasterLayer,
        QgsReferencedRectangle,
        QgsVectorLayer,
    )
    from symbols import style

    project = QgsProject()
    project.setTitle(SETTINGS.name)
    project.setCrs(QgsCoordinateReferenceSystem(SETTINGS.crs))
    project.writeEntry("fleet", "site", ".")
    project.setCustomVariables(
        {
            "fleet_site": SETTINGS.id,
            "fleet_site_crs": SETTINGS.crs,
            "fleet_origin_x": SETTINGS.origin[0],
            "fleet_origin_y": SETTINGS.origin[1],
            "fleet_rotation_deg": SETTINGS.rotation_deg,
        }
    )
    picture = QgsRasterLayer(str(photo), "Drone photo", "gdal")
    layers = [(picture, "orthophoto")]
    for name, title, role in (
        ("road_surfaces", "Road surfaces", "road_surface"),
        ("road_centrelines", "Road centrelines", "road_centreline"),
        ("keepouts", "Keepouts", "keepout"),
    ):
        layer = QgsVectorLayer(f"{out / 'site.gpkg'}|layername={name}", title, "ogr")
        style(layer, name)
        layers.append((layer, role))
    for layer, role in layers:
        if not layer.isValid():
            raise SystemExit(f"QGIS cannot open {layer.source()}.")
        layer.setCustomProperty("fleet/role", role)
        project.addMapLayer(layer)
    project.viewSettings().setDefaultViewExtent(QgsReferencedRectangle(picture.extent(), project.crs()))
    if not project.write(str(out / "proving_ground.qgz")):
        raise SystemExit(f"{out / 'proving_ground.qgz'} cannot be written: {project.error()}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit("Write: proving_ground.py OUT_DIR DATA_DIR")
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
