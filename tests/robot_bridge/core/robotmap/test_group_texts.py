"""The text of a large map in parts is the text of the map, and its size is known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from robot_bridge.core.robotmap import window_index as module
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.model import RobotMap, ShapeType, Window
from robot_bridge.core.robotmap.text_format import write_text
from robot_bridge.core.robotmap.window_index import (
    GroupText,
    OutlineIndex,
    group_texts,
    merged,
    size_in_binary,
)
from tests.robot_bridge.core.robotmap.rows import box, outlines, row

GROUPS = ("wall", "building", "bench", "hedge")


def town(count):
    """A town with obstacles of four groups and of all kinds that a border cuts, in no order."""
    chance = np.random.default_rng(7)
    rows = []
    for k, (x, y) in enumerate(chance.uniform(0, 300, (count, 2)).round(2).tolist()):
        group = GROUPS[chance.integers(len(GROUPS))]
        about = {"semantics": f"{group},no {k % 5}", "source": f"{group}:{k}"}
        if k % 3:
            rows.append(box(x, y, x + 5 + k % 7, y + 4, **about))
        else:
            shape_type = ShapeType.STAIRS if k % 2 else ShapeType.OPEN_POLYGON
            rows.append(row([(x, y), (x + 9, y), (x + 9, y + 3), (x, y + 3)], shape_type, **about))
    return OutlineIndex.of(outlines(*rows))


@pytest.mark.parametrize("side", [1000.0, 150.0, 0.5])
def test_the_parts_are_the_text_of_the_map(monkeypatch, side):
    monkeypatch.setattr(module, "_AT_ONCE", 7)
    index, window = town(200), Window(150.0, 150.0, side, side)
    parts = list(group_texts(index.outlines, window.border))
    head = write_text(RobotMap(window.border, ()))
    assert head + "".join(part.text for part in parts) == write_text(index.map_of(window))
    assert side < 1 or len(parts) > 8


def test_what_is_merged_comes_behind_its_group():
    own = [GroupText("a", "1"), GroupText("a", "2"), GroupText("c", "3")]
    more = [GroupText("a", "4"), GroupText("b", "5"), GroupText("d", "6")]
    assert "".join(part.text for part in merged(own, more)) == "124536"


def test_the_size_is_known_by_some_of_the_windows():
    index, window = town(3000), Window(150.0, 150.0, 400.0, 400.0)
    size = len(encode(index.map_of(window)))
    assert 0.5 * size < size_in_binary(index, window.border) < 2 * size
    assert size_in_binary(index, Window(1e6, 1e6, 10.0, 10.0).border) == 0
