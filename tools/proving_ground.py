"""Make a site of the real proving ground: its published form and a QGIS project with the drone photo.

    .venv/bin/python -m tools.proving_ground OUT_DIR DATA_DIR [DRIVES.csv.gz]

``DATA_DIR`` is the folder of real data beside the project (``../shared/data``, see its README). The photo is
shown from where it lies; only what is derived from the data is written, and only to ``OUT_DIR``:
``site.toml``, ``site.gpkg`` and ``proving_ground.qgz``. Lane borders are paint, not obstacles, so there are
none. With recorded drives (columns ``vehicle``, ``x_utm33``, ``y_utm33``) the site reaches as far as they do,
and they are a layer of the project.
"""

from __future__ import annotations

import csv
import gzip
import os
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

from robot_bridge.core.roads.network import GENERATED, Surface
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.core.sites.frame import SiteBounds, SiteFrame, projections
from robot_bridge.core.sites.geopackage import Centreline
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import write_site

ROOT = Path(__file__).resolve().parents[1]
CENTRELINES = "university_track_centrelines.geojson"
SURFACES = "university_track_surfaces_derived_utm33.gpkg"
PHOTO = "zalazone_university_track_utm33_35cm.tif"
SETTINGS = SiteSettings(
    id="zalazone-university-track",
    name="ZalaZONE university track",
    version=1,
    crs="EPSG:32633",
    origin=(639988.0, 5193408.4),
    bounds=SiteBounds(0.0, 0.0, 322.35, 355.6),
)
"""The origin is the south-west corner of the photo, the bounds are the photo's."""


DRIVES = "drives.gpkg"
AROUND_DRIVES_M = 60.0
BESIDE_CAR_M = 3.0
"""As much ground on each side of where a recorded car was is taken for road."""


def main(out: Path, data: Path, recording: Path | None = None) -> None:
    """Make the site and the project in ``out``."""
    source = data / "zalazone" if (data / "zalazone").is_dir() else data
    for name in (CENTRELINES, SURFACES, PHOTO):
        if not (source / name).is_file():
            raise SystemExit(f"{source / name} is missing: give the folder of real data as DATA_DIR.")
    out.mkdir(parents=True, exist_ok=True)
    surfaces = read_surfaces(source / SURFACES)
    settings, ground = SETTINGS, areas(surfaces, SETTINGS.frame)
    if recording is not None:
        drives = read_drives(recording)
        settings = reaching(drives)
        ground += driven_ground(drives)
        write_drives(drives, out / DRIVES)
    write_site(
        out,
        settings,
        Outlines.from_rows([]),
        centrelines(source / CENTRELINES, surfaces, SETTINGS.frame),
        ground,
    )
    make_project(out, source / PHOTO, settings)
    print(f"{out}: site.toml, site.gpkg and proving_ground.qgz of {settings.name}")


def read_drives(recording: Path) -> dict[str, np.ndarray]:
    """Return the (n, 2) places of each vehicle, metres in EPSG:32633."""
    if not recording.is_file():
        raise SystemExit(f"{recording} is missing: give a recording of drives, or none.")
    places: dict[str, list[tuple[float, float]]] = {}
    with gzip.open(recording, "rt", newline="") as file:
        for row in csv.DictReader(file):
            place = float(row["x_utm33"]), float(row["y_utm33"])
            places.setdefault(row["vehicle"], []).append(place)
    return {vehicle: np.array(line) for vehicle, line in places.items()}


def reaching(drives: dict[str, np.ndarray]) -> SiteSettings:
    """Return the settings of a site that reaches as far as the photo and the ``drives``."""
    places = np.concatenate(list(drives.values())) - SETTINGS.origin
    least = np.minimum(SETTINGS.bounds[:2], np.floor(places.min(axis=0)) - AROUND_DRIVES_M)
    most = np.maximum(SETTINGS.bounds[2:], np.ceil(places.max(axis=0)) + AROUND_DRIVES_M)
    bounds = SiteBounds(*least.tolist(), *most.tolist())
    return replace(SETTINGS, id="zalazone", name="ZalaZONE proving ground", bounds=bounds)


def driven_ground(drives: dict[str, np.ndarray]) -> list[Surface]:
    """Return the ground that the recorded cars drove on, of no known class: no map of lanes has it."""
    lines = [shapely.LineString(line - SETTINGS.origin).simplify(0.1) for line in drives.values()]
    strip = shapely.union_all(shapely.buffer(lines, BESIDE_CAR_M)).simplify(0.1)
    return [
        Surface(
            tuple(shapely.get_coordinates(ring) for ring in (part.exterior, *part.interiors)),
            "",
            "driven by recorded cars",
            GENERATED,
        )
        for part in shapely.get_parts(strip)
    ]


def write_drives(drives: dict[str, np.ndarray], file: Path) -> None:
    """Write a line for each vehicle."""
    file.unlink(missing_ok=True)
    _pyogrio().raw.write(
        str(file),
        shapely.to_wkb(np.array([shapely.LineString(line) for line in drives.values()])),
        [np.array(list(drives), dtype=object)],
        ["vehicle"],
        geometry_type="LineString",
        crs=SETTINGS.crs,
        driver="GPKG",
        layer="drives",
        dataset_options={"VERSION": "1.2"},
    )


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


def make_project(out: Path, photo: Path, settings: SiteSettings) -> None:
    """Write ``proving_ground.qgz``: the photo from where it lies, the published roads in the usual styles."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    with tempfile.TemporaryDirectory(prefix="fleet-qgis-") as profile:
        application = QgsApplication([], True, profile)
        application.initQgis()
        _write_project(out, photo, settings)
        application.exitQgis()


def _write_project(out: Path, photo: Path, settings: SiteSettings) -> None:
    from qgis.core import (
        QgsCoordinateReferenceSystem,
        QgsLineSymbol,
        QgsProject,
        QgsRasterLayer,
        QgsReferencedRectangle,
        QgsSingleSymbolRenderer,
        QgsVectorLayer,
    )

    # The makers of the styles import one another by their names.
    sys.path.append(str(ROOT / "resources" / "styles"))
    from symbols import style

    project = QgsProject()
    project.setTitle(settings.name)
    project.setCrs(QgsCoordinateReferenceSystem(settings.crs))
    project.writeEntry("fleet", "site", ".")
    project.setCustomVariables(
        {
            "fleet_site": settings.id,
            "fleet_site_crs": settings.crs,
            "fleet_origin_x": settings.origin[0],
            "fleet_origin_y": settings.origin[1],
            "fleet_rotation_deg": settings.rotation_deg,
        }
    )
    picture = QgsRasterLayer(str(photo), "Drone photo", "gdal")
    layers = [(picture, "orthophoto")]
    if (out / DRIVES).is_file():
        drives = QgsVectorLayer(f"{out / DRIVES}|layername=drives", "Recorded drives", "ogr")
        look = {"line_color": "255,140,26,150", "line_width": "0.3"}
        drives.setRenderer(QgsSingleSymbolRenderer(QgsLineSymbol.createSimple(look)))
        layers.append((drives, ""))
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
        if role:
            layer.setCustomProperty("fleet/role", role)
        project.addMapLayer(layer)
    project.viewSettings().setDefaultViewExtent(QgsReferencedRectangle(picture.extent(), project.crs()))
    if not project.write(str(out / "proving_ground.qgz")):
        raise SystemExit(f"{out / 'proving_ground.qgz'} cannot be written: {project.error()}")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        raise SystemExit("Write: proving_ground.py OUT_DIR DATA_DIR [DRIVES.csv.gz]")
    main(*(Path(word).resolve() for word in sys.argv[1:]))
