"""The index: the same maps as without it, whatever lies where, and a window's time that does not grow."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import Border, ShapeType, Window
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.core.robotmap.text_format import write_text
from robot_bridge.core.robotmap.window_index import OutlineIndex
from tests.robot_bridge.core.robotmap.rows import outlines, ring, row

coordinate = st.one_of(
    st.integers(-20_000, 20_000).map(lambda n: n / 100),
    st.sampled_from([20.0, -20.0, 40.0, 39.995, 1e9, -1e12, float("nan")]),
)
point = st.tuples(coordinate, coordinate)
a_row = st.one_of(
    st.builds(row, st.lists(point, max_size=6)),
    st.builds(
        row, st.lists(point, max_size=6), st.sampled_from(ShapeType), height=st.sampled_from([1.0, np.inf])
    ),
    st.builds(ring, st.lists(point, min_size=3, max_size=6), courtyard=st.booleans()),
)


@given(
    st.lists(a_row, max_size=12), st.lists(st.tuples(point, st.integers(2, 60_000)), min_size=1, max_size=3)
)
def test_a_window_of_the_index_is_the_window_without_it(rows, windows):
    some = outlines(*(replace(row, source=f"layer:{k}") for k, row in enumerate(rows)))
    index = OutlineIndex.of(some)
    for (x, y), side in windows:
        if not np.isfinite([x, y]).all() or abs(x) > 1e8 or abs(y) > 1e8:
            continue
        window = Window(x, y, side / 100, side / 50)
        wanted, found = build_map(some, window, {"id": "1"}), index.map_of(window, {"id": "1"})
        assert write_text(found) == write_text(wanted)
        assert found.warnings == wanted.warnings


@pytest.mark.parametrize("touch", [(20, 20, 30, 30), (10, 10, 20, 20), (5, 5, 100, 7)])
def test_a_window_that_only_touches_an_outline_still_finds_what_lies_on_its_border(touch):
    index = OutlineIndex.of(outlines(row([(10, 20), (20, 20)]), row([(20, 20), (30, 20)])))
    assert len(index.segments_in(Border(*touch)).a) == (touch != (5, 5, 100, 7))


def squares(count):
    """A city of ``count`` square buildings 20 m apart."""
    side = int(np.ceil(np.sqrt(count)))
    place = np.arange(count)
    corners = np.array([(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)], dtype=float)
    points = corners + 20.0 * np.column_stack([place % side, place // side])[:, None]
    return Outlines(
        coordinates=points.reshape(-1, 2),
        offsets=np.arange(count + 1) * 5,
        shape_type=np.full(count, int(ShapeType.CLOSED_POLYGON), dtype=np.int8),
        courtyard=np.zeros(count, dtype=bool),
        height=np.full(count, 3.0),
        outdoor=np.ones(count, dtype=bool),
        semantics=["building"] * count,
        source=["b:1"] * count,
    )


def test_a_window_takes_as_long_in_a_city_as_in_a_village():
    village, city = OutlineIndex.of(squares(400)), OutlineIndex.of(squares(160_000))
    border = Window(200, 200, 100, 100).border
    assert len(village.segments_in(border).a) == len(city.segments_in(border).a) >= 100

    def quickest(index):
        times = []
        for _ in range(30):
            start = time.perf_counter()
            index.segments_in(border)
            times.append(time.perf_counter() - start)
        return min(times)

    assert quickest(city) < 3 * quickest(village)


def test_an_index_of_nothing_has_empty_maps():
    assert OutlineIndex.of(outlines()).map_of(Window(0, 0, 10, 10)).obstacles == ()
