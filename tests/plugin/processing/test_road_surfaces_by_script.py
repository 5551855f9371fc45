"""Road surfaces with no display: made, told and read by expressions, in processes as a script starts them."""

from __future__ import annotations

import pyogrio.raw
import pytest

PLACES = {
    (20.5, 8.5): "asphalt",
    (66.5, 44.5): "slippery",
    (20.5, 101.5): "parking pavement",
    (100.5, 101.0): None,
}
ORIGIN = (640420.0, 5193480.0)


@pytest.fixture(scope="module")
def points(tmp_path_factory, qgis_process):
    """Places of the sample site, in degrees."""
    folder = tmp_path_factory.mktemp("points")
    rows = [f"{ORIGIN[0] + x},{ORIGIN[1] + y}" for x, y in PLACES]
    (folder / "points.csv").write_text("\n".join(["x,y", *rows]))
    made = folder / "metres.gpkg"
    done = qgis_process(
        "run", "native:createpointslayerfromtable", "--", f"INPUT={folder / 'points.csv'}",
        "XFIELD=x", "YFIELD=y", "TARGET_CRS=EPSG:32633", f"OUTPUT={made}",
    )  # fmt: skip
    assert done.status == 0, done.said
    degrees = folder / "degrees.gpkg"
    done = qgis_process(
        "run", "native:reprojectlayer", "--", f"INPUT={made}", "TARGET_CRS=EPSG:4326", f"OUTPUT={degrees}"
    )
    assert done.status == 0, done.said
    return degrees


def column(file, name):
    meta, _, _, columns = pyogrio.raw.read(file)
    return dict(zip(meta["fields"], columns, strict=True))[name].tolist()


def test_surfaces_made_of_centrelines_are_told_at_points(qgis_process, root, points, tmp_path):
    roads = root / "resources" / "sample_site" / "site.gpkg"
    made = tmp_path / "surfaces.gpkg"
    given = f"ROADS={roads}|layername=road_centrelines"
    done = qgis_process("run", "fleet:buildroadsurfaces", "--", given, f"SURFACES={made}")
    assert done.status == 0, done.said
    assert done.result("SURFACE_COUNT") == 5
    told = tmp_path / "told.gpkg"
    # What QGIS itself brings is enough to ask.
    done = qgis_process(
        "run", "fleet:surfaceatpoint", "--", f"POINTS={points}", f"SURFACES={made}", f"OUTPUT={told}",
        packages=False,
    )  # fmt: skip
    assert done.status == 0, done.said
    assert (done.result("ON_COUNT"), done.result("OFF_COUNT")) == (3, 1)
    assert column(told, "surface") == list(PLACES.values())
    assert column(told, "surface_origin") == ["generated", "generated", "generated", None]


def test_the_expression_function_is_there_with_no_display(qgis_process, root, points, tmp_path):
    project = root / "resources" / "sample_site" / "sample_site.qgz"
    told = tmp_path / "told.gpkg"
    done = qgis_process(
        "run", "native:fieldcalculator", f"--PROJECT_PATH={project}", "--", f"INPUT={points}",
        "FIELD_NAME=ground", "FIELD_TYPE=2", "FORMULA=road_surface($x, $y)", f"OUTPUT={told}",
        packages=False,
    )  # fmt: skip
    assert done.status == 0, done.said
    assert column(told, "ground") == list(PLACES.values())


def test_without_shapely_it_says_what_to_install(qgis_process, root, tmp_path):
    roads = root / "resources" / "sample_site" / "site.gpkg"
    given = f"ROADS={roads}|layername=road_centrelines"
    done = qgis_process(
        "run", "fleet:buildroadsurfaces", "--", given, f"SURFACES={tmp_path / 'made.gpkg'}", packages=False
    )
    if done.status == 0:
        pytest.skip("this QGIS has shapely by itself")
    assert "The Python package shapely 2 is missing" in done.said
    assert "Traceback" not in done.said
