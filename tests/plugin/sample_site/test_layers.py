"""What is promised of the sample site, read from its layers."""

import math

import pyogrio.raw
import pytest
import shapely

from robot_bridge.core.sites.site import read_site


@pytest.fixture(scope="module")
def layer(sample_site):
    """Return a function that reads a layer of the operator's GeoPackage as (geometry, fields) pairs."""

    def read(name):
        meta, _, wkb, columns = pyogrio.raw.read(str(sample_site / "sample_site.gpkg"), layer=name)
        assert meta["crs"] == "EPSG:32633"
        rows = zip(*columns, strict=True)
        return [
            (geometry, dict(zip(meta["fields"], row, strict=True)))
            for geometry, row in zip(shapely.from_wkb(wkb), rows, strict=True)
        ]

    return read


def test_roads_have_a_width_and_one_of_three_surfaces(layer):
    roads = layer("road_centrelines")
    assert all(2.0 <= fields["width_m"] <= 16.0 for _, fields in roads)
    assert {fields["surface"] for _, fields in roads} == {"asphalt", "parking pavement", "slippery"}


def test_roads_are_one_network_that_meets_end_to_end(layer):
    ends = {}
    for road, fields in layer("road_centrelines"):
        for place in (road.coords[0], road.coords[-1]):
            ends.setdefault((round(place[0], 3), round(place[1], 3)), []).append(fields["name"])
    names, reached = {n for group in ends.values() for n in group}, {"Campus road 1"}
    for _ in names:
        reached |= {n for group in ends.values() if reached & set(group) for n in group}
    assert reached == names


def test_there_is_a_straight_long_enough_for_a_slalom(layer):
    (straight,) = [road for road, fields in layer("road_centrelines") if fields["name"] == "Straight"]
    assert straight.length >= 100
    assert len(straight.coords) == 2


def test_every_centreline_lies_on_a_surface_of_its_class(layer):
    surfaces = {}
    for geometry, fields in layer("road_surfaces"):
        surfaces.setdefault(fields["surface"], []).append(geometry)
    everything = shapely.union_all([g for group in surfaces.values() for g in group])
    for road, fields in layer("road_centrelines"):
        assert everything.buffer(0.01).contains(road), fields["name"]
        on_its_own = shapely.union_all(surfaces[fields["surface"]]).intersection(road).length
        assert on_its_own > 0.4 * road.length, fields["name"]


def test_surfaces_are_valid_and_do_not_overlap(layer):
    polygons = [geometry for geometry, _ in layer("road_surfaces")]
    assert all(polygon.is_valid and polygon.geom_type == "Polygon" for polygon in polygons)
    total = sum(polygon.area for polygon in polygons)
    assert math.isclose(total, shapely.union_all(polygons).area, abs_tol=0.5)


def test_roads_are_as_wide_as_their_width_says(layer):
    surfaces = shapely.union_all([geometry for geometry, _ in layer("road_surfaces")])
    for name in ("Straight", "Skid section", "Tower road north", "Hall entrance way"):
        ((road, fields),) = [item for item in layer("road_centrelines") if item[1]["name"] == name]
        middle = road.interpolate(0.35, normalized=True)
        ahead = road.interpolate(road.project(middle) + 0.01)
        dx, dy = (ahead.x - middle.x) / 0.01, (ahead.y - middle.y) / 0.01
        across = shapely.LineString(
            [(middle.x - 10 * dy, middle.y + 10 * dx), (middle.x + 10 * dy, middle.y - 10 * dx)]
        )
        widths = [
            part.length
            for part in shapely.get_parts(across.intersection(surfaces))
            if part.distance(middle) < 0.1
        ]
        assert widths == pytest.approx([fields["width_m"]], abs=0.02), name


def test_buildings_have_heights_and_one_has_a_courtyard(layer):
    buildings = layer("buildings")
    assert len(buildings) >= 6
    assert all(2.0 < fields["height_m"] < 20.0 for _, fields in buildings)
    assert [fields["name"] for geometry, fields in buildings if geometry.interiors] == ["Hall A"]


def test_the_hall_is_44_by_31_with_a_closed_loop_of_150_m_around_it(layer):
    (hall,) = [geometry for geometry, fields in layer("buildings") if fields["name"] == "Hall A"]
    x0, y0, x1, y1 = hall.bounds
    assert (round(x1 - x0, 6), round(y1 - y0, 6)) == (44.0, 31.0)
    pieces = [road for road, f in layer("road_centrelines") if f["name"].startswith("Hall loop")]
    (loop,) = shapely.get_parts(shapely.line_merge(shapely.union_all(pieces)))
    assert loop.is_ring
    assert loop.length == pytest.approx(150.0, abs=1.5)
    assert shapely.Polygon(loop).contains(hall)
    assert loop.distance(hall) > 1.5, "a robot half a metre wide passes"


def test_every_kind_of_obstacle_is_there(layer):
    counts = {
        name: len(layer(name)) for name in ("walls", "columns", "litter_bins", "benches", "stairs", "ramp")
    }
    assert counts == {"walls": 6, "columns": 10, "litter_bins": 14, "benches": 7, "stairs": 1, "ramp": 1}
    ((stairs, fields),) = layer("stairs")
    assert len(stairs.geoms) == 8
    assert fields["height_m"] == pytest.approx(0.15)
    ((ramp, fields),) = layer("ramp")
    assert fields["slope_pct"] == pytest.approx(100 * 1.05 / 12.6, abs=0.1)
    assert ramp.area == pytest.approx(12.6 * 2.0)


def test_no_obstacle_and_no_keepout_stands_on_a_road(layer):
    surfaces = shapely.union_all([geometry for geometry, _ in layer("road_surfaces")])
    names = ("buildings", "walls", "columns", "litter_bins", "benches", "stairs", "ramp", "keepouts")
    on_road = [f["name"] for name in names for geometry, f in layer(name) if geometry.intersects(surfaces)]
    assert on_road == []


def test_the_published_site_is_the_operators_layers(layer, sample_site):
    site = read_site(sample_site)
    sources = [
        source.partition(":")[0]
        for source, hole in zip(site.outlines.source, site.outlines.courtyard, strict=True)
        if not hole
    ]
    for name in ("buildings", "walls", "columns", "litter_bins", "benches", "stairs", "ramp"):
        assert sources.count(name) == len(layer(name)), name
    assert [road.width_m for road in site.centrelines] == [f["width_m"] for _, f in layer("road_centrelines")]
    published = sum(shapely.Polygon(area.rings[0], area.rings[1:]).area for area in site.surfaces)
    assert published == pytest.approx(sum(g.area for g, _ in layer("road_surfaces")), abs=0.1)
    assert [area.label for area in site.keepouts] == [f["name"] for _, f in layer("keepouts")]
