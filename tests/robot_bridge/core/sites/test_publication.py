"""A site published and read back, and every way in which a publication can be damaged."""

import shutil
import sqlite3
import struct
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pyogrio.raw
import pytest
import shapely

from robot_bridge.core.errors import LayerError, SettingsError, SiteError
from robot_bridge.core.roads.network import GENERATED, Surface
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.text_format import write_text
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.geopackage import Area, Centreline
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import read_site, write_site

SETTINGS = SiteSettings(
    id="yard",
    name="Yard",
    version=1,
    crs="EPSG:32633",
    origin=(640420.0, 5193480.0),
    bounds=SiteBounds(0.0, 0.0, 60.0, 40.0),
    rotation_deg=30.0,
)


def ring(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], dtype=float)


ROWS = [
    OutlineRow(ring(0, 0, 20, 10), ShapeType.CLOSED_POLYGON, 9.5, "building,A", "buildings:1"),
    OutlineRow(ring(5, 3, 9, 7), ShapeType.CLOSED_POLYGON, 9.5, "building,A", "buildings:1", courtyard=True),
    OutlineRow(
        ring(30, 0, 40, 10), ShapeType.CLOSED_POLYGON, 4.0, "building,B", "buildings:2", outdoor=False
    ),
    OutlineRow(
        np.array([[0, 20], [10, 20], [10, 25]]),
        ShapeType.OPEN_POLYGON,
        2.0,
        "wall",
        "walls:1",
        base=0.4,
        ext={"h": "est", "a=b,": 'ä"\\;'},
    ),
    OutlineRow(ring(50, 1, 51, 2), ShapeType.CLOSED_CURVE, 3.0, "column,C1", "columns:1"),
    OutlineRow(
        np.array([[20, 30], [16, 30], [20, 29.7], [16, 29.7]]), ShapeType.STAIRS, 0.15, "stairs", "stairs:1"
    ),
    OutlineRow(ring(25, 30, 32, 32), ShapeType.RAMP, 0.0, "ramp", "ramp:1", ext={"n": "0,-0.0995,0.995"}),
]
OBSTACLES = Outlines.from_rows(ROWS)
ROADS = [Centreline(np.array([[0.0, 15.0], [50.0, 15.0], [55.0, 18.0]]), 3.5, "asphalt")]
SURFACES = [Surface((ring(0, 13, 50, 17), ring(20, 14, 22, 15)), "asphalt", "Mall", GENERATED)]
KEEPOUTS = [Area((ring(45, 30, 55, 38),), "Pond")]


@pytest.fixture(scope="module")
def published(tmp_path_factory):
    """A published site, which nobody changes."""
    written = tmp_path_factory.mktemp("published") / "site"
    write_site(written, SETTINGS, OBSTACLES, ROADS, SURFACES, KEEPOUTS)
    return written


@pytest.fixture
def folder(published, tmp_path):
    """A published site of the test's own."""
    return shutil.copytree(published, tmp_path / "site")


def edit(folder, *statements):
    """Damage the GeoPackage by SQL, as no GIS would."""
    with sqlite3.connect(folder / "site.gpkg") as connection:
        for name in [
            row[0] for row in connection.execute("select name from sqlite_master where type = 'trigger'")
        ]:
            connection.execute(f'drop trigger "{name}"')
        for statement in statements:
            connection.execute(statement)
    connection.close()


def refusal(folder):
    with pytest.raises(SiteError) as caught:
        read_site(folder)
    assert str(folder) in str(caught.value)
    return str(caught.value)


def test_obstacles_come_back_as_they_were(folder):
    found = read_site(folder).outlines
    assert np.allclose(found.coordinates, OBSTACLES.coordinates, atol=1e-6)
    for name in ("offsets", "shape_type", "courtyard", "height", "outdoor"):
        assert np.array_equal(getattr(found, name), getattr(OBSTACLES, name)), name
    assert list(found.semantics) == list(OBSTACLES.semantics)
    assert list(found.source) == list(OBSTACLES.source)
    assert found.base.tolist() == [0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0]
    assert found.ext == [dict(row.ext) for row in ROWS]


def test_a_courtyard_says_what_its_building_says(tmp_path):
    walls = [replace(row, base=1.5, ext={"h": "est"}) for row in ROWS[:2]]
    write_site(tmp_path / "site", SETTINGS, Outlines.from_rows(walls))
    found = read_site(tmp_path / "site").outlines
    assert found.base.tolist() == [1.5, 1.5]
    assert found.ext == [{"h": "est"}] * 2


def test_the_maps_of_a_site_carry_what_its_obstacles_have_to_say(folder):
    text = write_text(read_site(folder).map_around(20.0, 20.0, 6400.0))
    assert ";wall;src=walls:1,h=est," in text
    assert ";ramp;src=ramp:1,n=0,-0.0995,0.995;" in text


def test_a_site_of_an_older_version_lacks_bases_and_extras_and_is_read(folder):
    edit(folder, "alter table obstacles drop column base_m", "alter table obstacles drop column ext")
    found = read_site(folder).outlines
    assert list(found.source) == list(OBSTACLES.source)
    assert (found.base, found.ext) == (None, None)


def test_roads_and_areas_come_back_as_they_were(folder):
    site = read_site(folder)
    assert [(road.width_m, road.surface) for road in site.centrelines] == [(3.5, "asphalt")]
    assert np.allclose(site.centrelines[0].points, ROADS[0].points, atol=1e-6)
    for found, wanted in ((site.surfaces, SURFACES), (site.keepouts, KEEPOUTS)):
        assert [area.label for area in found] == [area.label for area in wanted]
        for ours, theirs in zip(found[0].rings, wanted[0].rings, strict=True):
            assert np.allclose(ours, theirs, atol=1e-6)


def test_surfaces_keep_their_names_and_where_they_come_from(folder):
    (surface,) = read_site(folder).surfaces
    assert (surface.name, surface.origin) == ("Mall", "generated")


def test_surfaces_of_a_site_of_an_older_version_were_drawn(folder):
    edit(folder, "alter table road_surfaces drop column name", "alter table road_surfaces drop column origin")
    (surface,) = read_site(folder).surfaces
    assert (surface.label, surface.name, surface.origin) == ("asphalt", "", "drawn")


def test_the_geopackage_holds_crs_coordinates(folder):
    _, _, wkb, _ = pyogrio.raw.read(str(folder / "site.gpkg"), layer="keepouts")

    corner = shapely.get_coordinates(shapely.from_wkb(wkb))[0]
    assert np.allclose(corner, SETTINGS.frame.to_crs([[45.0, 30.0]])[0])


def test_a_site_without_any_obstacle_is_a_site(tmp_path):
    write_site(tmp_path / "empty", SETTINGS, Outlines.from_rows([]))
    site = read_site(tmp_path / "empty")
    assert (len(site.outlines), site.centrelines, site.surfaces, site.keepouts) == (0, (), (), ())
    assert site.whole_map().obstacles == ()
    # Of any geometry and empty, it would have neither geometry nor CRS to QGIS 3.22.
    info = pyogrio.read_info(str(tmp_path / "empty" / "site.gpkg"), layer="obstacles")
    assert (info["geometry_type"], info["crs"]) == ("Polygon", "EPSG:32633")


def test_publishing_again_replaces_both_files_and_leaves_others(folder):
    (folder / "photo.tif").write_text("mine")
    write_site(folder, replace(SETTINGS, version=2), Outlines.from_rows(ROWS[:1]))
    site = read_site(folder)
    assert (site.version, len(site.outlines)) == (2, 1)
    names = ["photo.tif", "site.cache", "site.gpkg", "site.toml"]
    assert sorted(path.name for path in folder.iterdir()) == names


def test_a_refused_publication_leaves_the_one_before_it(folder):
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    bad = Outlines.from_rows([replace(ROWS[0], points=ring(0, 0, np.nan, 5))])
    with pytest.raises(LayerError, match=r"obstacle buildings:1 .* it has a coordinate that is NaN"):
        write_site(folder, replace(SETTINGS, version=2), bad)
    endless = Outlines.from_rows([replace(ROWS[0], height=np.inf)])
    with pytest.raises(LayerError, match=r"obstacles, feature 1: it has no finite number in height_m"):
        write_site(folder, replace(SETTINGS, version=2), endless)
    with pytest.raises(SettingsError, match=r"site\.crs: The CRS EPSG:3857"):
        write_site(folder, replace(SETTINGS, crs="EPSG:3857"), OBSTACLES)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_ring_with_too_few_points_is_refused_by_its_source(tmp_path):
    bad = Outlines.from_rows([replace(ROWS[0], points=np.array([[0.0, 0.0], [1.0, 0.0]]))])
    with pytest.raises(LayerError, match="obstacle buildings:1 cannot be published as closed_polygon"):
        write_site(tmp_path / "site", SETTINGS, bad)


def test_a_missing_folder_says_what_a_site_is(tmp_path):
    assert "is no folder: a published site is a folder with site.toml" in refusal(tmp_path / "nowhere")


def test_a_site_without_settings_is_refused(folder):
    (folder / "site.toml").unlink()
    assert "site.toml is missing" in refusal(folder)


def test_a_site_without_its_layers_is_half_there(folder):
    (folder / "site.gpkg").unlink()
    assert "site.gpkg is missing: the site is half there. Publish the site again." in refusal(folder)


def test_a_publication_cut_off_between_its_files_is_refused(folder, tmp_path):
    write_site(tmp_path / "new", replace(SETTINGS, version=2), OBSTACLES)
    shutil.copy(tmp_path / "new" / "site.gpkg", folder / "site.gpkg")
    message = refusal(folder)
    assert "belongs to yard version 2 and the settings beside it to yard version 1" in message
    assert "publishing was interrupted" in message


def test_a_cut_off_geopackage_is_refused(folder):
    content = (folder / "site.gpkg").read_bytes()
    (folder / "site.gpkg").write_bytes(content[: len(content) // 3])
    assert "site.gpkg" in refusal(folder)


def test_a_file_that_is_no_geopackage_is_refused(folder):
    (folder / "site.gpkg").write_text("hello")
    assert "is not a readable GeoPackage" in refusal(folder)


def test_a_missing_layer_is_named(folder):
    edit(folder, "delete from gpkg_contents where table_name = 'keepouts'", "drop table keepouts")
    assert "has no layer 'keepouts'; it has obstacles, road_centrelines, road_surfaces" in refusal(folder)


def test_a_missing_field_is_named(folder):
    edit(folder, "alter table obstacles drop column height_m")
    assert "layer obstacles: the field 'height_m' is missing" in refusal(folder)


def test_a_layer_in_another_crs_is_named(folder):
    with (folder / "site.toml").open() as file:
        text = file.read().replace("EPSG:32633", "EPSG:32634")
    (folder / "site.toml").write_text(text)
    assert "layer obstacles: its CRS is EPSG:32633, and site.crs is EPSG:32634" in refusal(folder)


@pytest.mark.parametrize(
    ("statement", "says"),
    [
        ("update obstacles set shape_type = 9 where fid = 3", "feature 3: shape_type is 9; write 1 to 6"),
        (
            "update obstacles set height_m = null where fid = 2",
            "feature 2: it has no finite number in height_m",
        ),
        ("update obstacles set base_m = null where fid = 2", "feature 2: it has no finite number in base_m"),
        ("update obstacles set ext = 'h=est' where fid = 2", "feature 2: its ext is 'h=est', and not a JSON"),
        ("update obstacles set ext = '[]' where fid = 2", "feature 2: its ext is '[]', and not a JSON"),
        ("""update obstacles set ext = '{"n": 1}'""", "feature 1: its ext is '{\"n\": 1}', and not a JSON"),
        ("update obstacles set geom = null where fid = 4", "feature 4: it has no geometry"),
        ("update road_centrelines set width_m = 0", "road_centrelines, feature 1: width_m is 0"),
        (
            "update obstacles set geom = (select geom from road_centrelines) where fid = 5",
            "feature 5: a riser of these stairs has more than two points",
        ),
        (
            "update keepouts set geom = (select geom from road_centrelines)",
            "keepouts, feature 1: it is a LineString, not a Polygon",
        ),
    ],
)
def test_a_defective_feature_is_named(folder, statement, says):
    edit(folder, statement)
    message = refusal(folder)
    assert says in message
    assert "site.gpkg, layer" in message


@pytest.mark.parametrize(
    ("place", "says"),
    [
        (slice(-24, -16), "it has a coordinate that is NaN or infinite"),
        (slice(-8, None), "its geometry is broken, such as a ring that is not closed"),
    ],
)
def test_a_nan_in_a_stored_geometry_is_named(folder, place, says):
    with sqlite3.connect(folder / "site.gpkg") as connection:
        (blob,) = connection.execute("select geom from road_surfaces").fetchone()
    damaged = bytearray(blob)
    damaged[place] = struct.pack("<d", float("nan"))
    edit(folder, f"update road_surfaces set geom = x'{damaged.hex()}'")
    assert f"layer road_surfaces, feature 1: {says}" in refusal(folder)


def test_the_site_modules_load_with_numpy_alone(root):
    blocked = ["shapely", "pyproj", "pyogrio", "msgspec", "tomllib", "sqlalchemy", "zstandard", "qgis"]
    code = (
        "import sys\n"
        f"for name in {blocked}: sys.modules[name] = None\n"
        "import robot_bridge.core.sites.site, robot_bridge.core.sites.frame\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=root, check=True, timeout=240)
