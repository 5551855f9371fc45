"""Helsinki's centre: thousands of real rings and barriers, with a window cut out of the middle."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pyogrio
import pytest
import shapely

from robot_bridge.core.robotmap.binary import decode_text, encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import Window
from robot_bridge.core.robotmap.text_format import read_text, write_text
from tests.robot_bridge.core.robotmap.rows import outlines, ring, row

ORIGIN = np.array([385944.0, 6672300.0])
WINDOW = Window(0, 0, 400, 300)


@pytest.fixture(scope="module")
def helsinki(data):
    file = data / "osm" / "helsinki_centre_utm35n.gpkg"
    rows = []
    for layer in ("buildings", "barriers"):
        _, ids, wkb, _ = pyogrio.raw.read(file, layer=layer, return_fids=True, columns=[])
        # Five buildings have rings of two points, which shapely has no geometry for.
        geometries = shapely.from_wkb(wkb, on_invalid="ignore")
        for fid, geometry in zip(ids, geometries, strict=True):
            rows += feature_rows(geometry, f"{layer}:{fid}")
    return outlines(*rows)


def feature_rows(geometry, source):
    for part in shapely.get_parts(geometry):
        if part.geom_type == "Polygon":
            rings = [part.exterior, *part.interiors]
            for k, line in enumerate(rings):
                points = shapely.get_coordinates(line) - ORIGIN
                yield ring(points[:-1], source=source, courtyard=k > 0)
        else:
            yield row(shapely.get_coordinates(part) - ORIGIN, source=source)


def lines_of(helsinki):
    ends = pairwise(helsinki.offsets)
    return [shapely.LineString(helsinki.coordinates[a:b]) for a, b in ends if b - a > 1]


def farthest(points, geometry):
    """The greatest distance of one of ``points`` to ``geometry``, metres."""
    return float(shapely.distance(shapely.points(points), geometry).max())


def test_the_segments_are_the_outlines_inside_the_window_within_a_centimetre(helsinki):
    robot_map = build_map(helsinki, WINDOW)
    rectangle, drawn = shapely.box(*WINDOW.border), lines_of(helsinki)
    made = [line for o in robot_map.obstacles for line in shapely.linestrings(np.stack([o.a, o.b], axis=1))]
    inside = [shapely.intersection(line, rectangle) for line in drawn]

    assert shapely.covers(rectangle, shapely.MultiLineString(made))
    assert farthest(shapely.get_coordinates(made), shapely.MultiLineString(drawn)) <= 0.01
    assert farthest(shapely.get_coordinates(inside), shapely.MultiLineString(made)) <= 0.01
    length = shapely.length(inside).sum()
    assert length > 5000 and shapely.length(made).sum() == pytest.approx(length, rel=1e-3)


def test_every_outline_in_the_window_is_in_the_map_or_in_a_warning(helsinki):
    robot_map = build_map(helsinki, WINDOW)
    named = {o.ext["src"] for o in robot_map.obstacles} | {w.split(": ")[0] for w in robot_map.warnings}
    inner = shapely.box(*WINDOW.border).buffer(-0.02)
    for k, source in enumerate(helsinki.source):
        points = helsinki.coordinates[helsinki.offsets[k] : helsinki.offsets[k + 1]]
        if len(points) > 1 and shapely.LineString(points).intersects(inner):
            assert source in named


def test_the_map_comes_back_from_text_and_binary_as_it_was(helsinki):
    text = write_text(build_map(helsinki, WINDOW))
    assert write_text(read_text(text)) == text
    assert decode_text(encode(text)) == text
