"""Road surfaces by a script's words: made, and told at places."""

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
def points(tmp_path_factory, by_words):
    """Places of the sample site, in degrees."""
    folder = tmp_path_factory.mktemp("points")
    rows = [f"{ORIGIN[0] + x},{ORIGIN[1] + y}" for x, y in PLACES]
    (folder / "points.csv").write_text("\n".join(["x,y", *rows]))
    made = folder / "metres.gpkg"
    done = by_words(
        "run", "native:createpointslayerfromtable", "--", f"INPUT={folder / 'points.csv'}",
        "XFIELD=x", "YFIELD=y", "TARGET_CRS=EPSG:32633", f"OUTPUT={made}",
    )  # fmt: skip
    assert done.status == 0, done.said
    degrees = folder / "degrees.gpkg"
    done = by_words(
        "run", "native:reprojectlayer", "--", f"INPUT={made}", "TARGET_CRS=EPSG:4326", f"OUTPUT={degrees}"
    )
    assert done.status == 0, done.said
    return degrees


def column(file, name):
    meta, _, _, columns = pyogrio.raw.read(file)
    return dict(zip(meta["fields"], columns, strict=True))[name].tolist()


def test_surfaces_made_of_centrelines_are_told_at_points(by_words, root, points, tmp_path):
    roads = root / "resources" / "sample_site" / "site.gpkg"
    made = tmp_path / "surfaces.gpkg"
    given = f"ROADS={roads}|layername=road_centrelines"
    done = by_words("run", "fleet:buildroadsurfaces", "--", given, f"SURFACES={made}")
    assert done.status == 0, done.said
    assert done.result("SURFACE_COUNT") == 5
    told = tmp_path / "told.gpkg"
    done = by_words(
        "run", "fleet:surfaceatpoint", "--", f"POINTS={points}", f"SURFACES={made}", f"OUTPUT={told}"
    )
    assert done.status == 0, done.said
    assert (done.result("ON_COUNT"), done.result("OFF_COUNT")) == (3, 1)
    assert column(told, "surface") == list(PLACES.values())
    assert column(told, "surface_origin") == ["generated", "generated", "generated", None]
