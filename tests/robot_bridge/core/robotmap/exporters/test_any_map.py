"""Whatever a readable robot map says, exports end well or say what is wrong."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import ExportError
from robot_bridge.core.robotmap.exporters.geometries import obstacle_shapes, segment_shapes
from robot_bridge.core.robotmap.exporters.nav2 import FREE, OCCUPIED, UNKNOWN, occupancy_of, trinary_files
from robot_bridge.core.robotmap.exporters.svg import svg_of
from robot_bridge.core.robotmap.exporters.vector_files import geojson_of
from robot_bridge.core.robotmap.text_format import read_text

# Few different values, so that segments meet, close, and end on the border.
coordinate = st.one_of(st.integers(-2, 12).map(float), st.floats(-1e3, 1e3), st.sampled_from([1e9, -1e15]))
segment = st.tuples(coordinate, coordinate, coordinate, coordinate, st.floats(-1, 50))
obstacle = st.tuples(
    st.integers(0, 3),
    st.integers(1, 6),
    st.sampled_from(["building", "building,A", "wall", "", "stairs", "<&"]),
    st.sampled_from(["", "src=b:1;", "src=b:2,h=est;"]),
    st.lists(segment, max_size=5),
    st.booleans(),
)


def text_of(obstacles) -> str:
    lines = ["border;", "0;10;", "10;0;", "#"]
    for number, shape_type, semantics, ext, segments, chained in obstacles:
        lines += ["obstacle;", f"{number};{shape_type};{len(segments)};{semantics};{ext}", "#"]
        for k, (ax, ay, bx, by, height) in enumerate(segments):
            if chained:
                bx, by = segments[(k + 1) % len(segments)][:2]
            lines += [f"{ax:f};{ay:f};", f"{bx:f};{by:f};", f"{height:f};1;;", "#"]
    return "\n".join(lines) + "\n"


@pytest.mark.filterwarnings("error")
@given(st.lists(obstacle, max_size=6))
def test_any_map_is_exported_whole(obstacles):
    robot_map = read_text(text_of(obstacles))
    made = occupancy_of(robot_map, 0.5)
    assert set(np.unique(made.cells)) <= {FREE, OCCUPIED, UNKNOWN}
    assert len(trinary_files("m", made.grid, made.cells)["m.pgm"]) == 400 + len("P5\n20 20\n255\n")
    assert svg_of(robot_map).endswith(b"</svg>\n")
    segments = segment_shapes(robot_map)
    assert len(segments) == robot_map.segment_count
    for shapes in (segments, obstacle_shapes(robot_map)):
        try:
            content = json.loads(geojson_of(shapes, lambda xy: xy * 1e-3))
        except ExportError as error:
            assert "none on the earth" in str(error)
        else:
            assert len(content["features"]) == len(shapes)
