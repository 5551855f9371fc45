"""``fleet:importnavigationmap``: real maps of Nav2 and our own, by cell and by place; bad ones are named."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fleet_supervisor.plugin.processing.algorithms import import_navigation_map
from osgeo import gdal
from PIL import Image
from qgis.core import QgsProcessingContext, QgsProcessingException, QgsProject

MAP = """\
%crs EPSG:32633
%origin 640420.000,5193480.000
%rotation 0.500000000
border;
0;20;
40;0;
#
obstacle;
1;1;4;building,Hall;src=b:1;
#
2;2;
12;2;
6;1;;
#
12;2;
12;8;
6;1;;
#
12;8;
2;8;
6;1;;
#
2;8;
2;2;
6;1;;
#
"""
YAML = """\
image: a.pgm
resolution: 0.5
origin: [10.0, 20.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


@pytest.fixture
def run(provider, listener, tmp_path):
    """Read a map: ``run(file)`` returns results, cells, features and warnings."""
    import processing

    def run(file, algorithm="fleet:importnavigationmap", **more):
        context = QgsProcessingContext()
        context.setProject(QgsProject())
        outputs = {"RASTER": str(tmp_path / "cells.tif"), "OBSTACLES": "memory:"}
        results = processing.run(
            algorithm,
            {"MAP": str(file), **(outputs if algorithm.endswith("importnavigationmap") else {}), **more},
            context=context,
            feedback=listener,
        )
        return results, list(listener.warnings)

    return run


@pytest.fixture
def grid(tmp_path):
    """A map of 4 x 3 cells: ``grid(yaml)`` writes its files and returns the YAML's."""

    def grid(text=YAML, pixels=((0, 254, 254, 205), (254, 0, 254, 254), (254, 254, 0, 0))):
        image = np.array(pixels, dtype=np.uint8)
        Image.fromarray(image).save(tmp_path / "a.pgm")
        (tmp_path / "a.yaml").write_text(text, encoding="utf-8")
        return tmp_path / "a.yaml"

    return grid


def cells(results):
    raster = gdal.Open(results["RASTER"])
    return raster.ReadAsArray(), raster.GetGeoTransform(), raster.GetProjection()


def test_cells_and_patches_lie_where_the_map_says(run, grid):
    place = {"SITE_CRS": "EPSG:32633", "ORIGIN": "640420,5193480 [EPSG:32633]", "ROTATION": 0}
    results, warnings = run(grid(), **place)
    values, transform, crs = cells(results)
    assert values.tolist() == [[100, 0, 0, -1], [0, 100, 0, 0], [0, 0, 100, 100]]
    assert transform == pytest.approx((640430.0, 0.5, 0.0, 5193501.5, 0.0, -0.5))
    assert "32633" in crs
    assert (results["OCCUPIED_COUNT"], results["UNKNOWN_COUNT"], results["OBSTACLE_COUNT"]) == (4, 1, 3)
    assert warnings == []
    patches = {f["cells"]: f.geometry().boundingBox() for f in results["OBSTACLES"].getFeatures()}
    assert sorted(patches) == [1, 2]
    low = patches[2]
    assert (low.xMinimum(), low.yMinimum(), low.xMaximum(), low.yMaximum()) == pytest.approx(
        (640431.0, 5193500.0, 640432.0, 5193500.5)
    )


def test_yaw_and_rotation_add_up_about_their_origins(run, grid):
    turned = YAML.replace("20.0, 0.0]", f"20.0, {math.pi / 2}]")
    place = {"SITE_CRS": "EPSG:32633", "ORIGIN": "640420,5193480 [EPSG:32633]", "ROTATION": 90}
    results, _ = run(grid(turned), **place)
    _, transform, _ = cells(results)
    # The site is turned by 90 degrees and the map by as much in it: upside down about its lower left corner.
    assert transform == pytest.approx((640400.0, -0.5, 0.0, 5193488.5, 0.0, 0.5), abs=1e-6)
    xy = [f.geometry().boundingBox().center() for f in results["OBSTACLES"].getFeatures() if f["cells"] == 2]
    assert (xy[0].x(), xy[0].y()) == pytest.approx((640398.5, 5193489.75))


def test_a_map_without_a_place_is_in_local_metres_and_says_so(run, grid):
    results, (warning,) = run(grid())
    assert "local metres" in warning
    assert cells(results)[1] == pytest.approx((10.0, 0.5, 0.0, 21.5, 0.0, -0.5))


@pytest.mark.parametrize("inside", ["occupied", "unknown"])
def test_what_we_wrote_comes_back_at_its_place(run, tmp_path, inside):
    (tmp_path / "site.map").write_text(MAP, encoding="utf-8")
    export = {"FORMATS": ["occupancy"], "INSIDE": inside, "RESOLUTION": 0.1, "OUTPUT": str(tmp_path / "out")}
    written, _ = run(tmp_path / "site.map", "fleet:exportnavigationmap", **export)
    results, warnings = run(written["OCCUPANCY"])
    assert warnings == []
    values, transform, _ = cells(results)
    assert values.shape == (200, 400)
    assert (values[150, 70], values[10, 10]) == (100 if inside == "occupied" else -1, 0)
    site = 640420.0 - 20 * math.sin(0.5), 5193480.0 + 20 * math.cos(0.5)
    assert (transform[0], transform[3]) == pytest.approx(site, abs=1e-3)
    (hall,) = results["OBSTACLES"].getFeatures()
    assert hall.geometry().isGeosValid()
    rings = 1 if inside == "occupied" else 2
    assert len(hall.geometry().asPolygon()) == rings
    assert hall["area_m2"] == pytest.approx(60.0 if inside == "occupied" else 3.2, rel=0.1)


@pytest.mark.parametrize("name", ["depot", "depot_keepout", "depot_speed", "systest_map_circular"])
def test_real_maps_have_the_cells_of_their_pixels(run, data, name):
    results, _ = run(data / "nav2" / "maps" / f"{name}.yaml")
    found, transform, _ = cells(results)
    dark = (255 - np.asarray(Image.open(data / "nav2" / "maps" / f"{name}.pgm")).astype(float)) / 255
    assert transform[1] == pytest.approx(0.05)
    if name == "depot_speed":
        assert (found == np.rint(dark * 100)).all()
    else:
        free = 0.196 if name == "systest_map_circular" else 0.25
        assert (found == np.where(dark > 0.65, 100, np.where(dark < free, 0, -1))).all()
    assert results["OBSTACLES"].featureCount() == results["OBSTACLE_COUNT"]
    area = sum(f.geometry().area() for f in results["OBSTACLES"].getFeatures())
    assert area == pytest.approx(results["OCCUPIED_COUNT"] * 0.05**2)


def test_a_picture_in_colour_with_holes_is_read_as_map_servers_do(run, grid, tmp_path):
    file = grid(YAML.replace("a.pgm", "a.png") + "mode: scale\n")
    pixels = np.array([[(0, 0, 0, 255), (255, 255, 255, 255), (0, 0, 0, 0)]], dtype=np.uint8)
    Image.fromarray(pixels).save(tmp_path / "a.png")
    results, _ = run(file)
    assert cells(results)[0].tolist() == [[100, 0, -1]]


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("a.pgm", "b.pgm", r"There is no image .*b\.pgm, which the map names"),
        ("[10.0", "[.nan", "origin: nan; give a number"),
        ("a.pgm", "a.yaml", r"The image .*a\.yaml cannot be read as PGM"),
        ("resolution: 0.5", "resolution: 0", "resolution: 0; give a number"),
    ],
)
def test_a_map_that_cannot_be_read_is_named_and_nothing_is_written(run, grid, tmp_path, old, new, named):
    file = grid(YAML.replace(old, new, 1))
    with pytest.raises(QgsProcessingException, match=named):
        run(file)
    assert not (tmp_path / "cells.tif").exists()


@pytest.mark.parametrize("name", ["cells.png", "cells.asc"])
def test_a_raster_that_nobody_writes_is_refused_with_the_name_to_give(run, grid, tmp_path, name):
    with pytest.raises(QgsProcessingException, match=rf"The raster {name} .* a name that ends in \.tif"):
        run(grid(), RASTER=str(tmp_path / name))


def test_an_older_raster_stays_after_an_error_and_after_a_cancel(
    provider, run, grid, cancels_at, tmp_path, monkeypatch
):
    import processing

    file, older = grid(), tmp_path / "cells.tif"
    older.write_bytes(b"older")
    before = sorted(tmp_path.iterdir())
    made = processing.run(
        "fleet:importnavigationmap",
        {"MAP": str(file), "RASTER": str(older), "OBSTACLES": "memory:"},
        feedback=cancels_at(50),
    )
    assert "RASTER" not in made and older.read_bytes() == b"older"

    def full(*_):
        raise RuntimeError("no space left")

    monkeypatch.setattr(import_navigation_map, "_fill", full)
    with pytest.raises(QgsProcessingException, match=r"cells\.tif cannot be written"):
        run(file)
    assert older.read_bytes() == b"older"
    assert sorted(tmp_path.iterdir()) == before


def test_an_image_with_too_many_pixels_is_refused_before_it_is_read(run, grid, tmp_path):
    file = grid()
    (tmp_path / "a.pgm").write_bytes(b"P5\n30000 30000\n255\n" + bytes(100))
    with pytest.raises(QgsProcessingException, match="30000 x 30000 pixels; a map has at most 64 million"):
        run(file)


def test_an_image_of_16_bits_and_a_file_that_is_not_there_are_refused(run, grid, tmp_path):
    file = grid()
    (tmp_path / "a.pgm").write_bytes(b"P5\n2 1\n65535\n" + bytes(4))
    with pytest.raises(QgsProcessingException, match="no bands of 8 bits"):
        run(file)
    with pytest.raises(QgsProcessingException, match="There is no file"):
        run(tmp_path / "none.yaml")
