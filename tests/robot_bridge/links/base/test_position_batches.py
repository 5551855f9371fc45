"""Positions of many robots in one frame: as they were told, and what is wrong with one is its own."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from robot_bridge.core.json_decoder import DecodingError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.position_frame import entries_in, packed_frame, poses_in_frame
from robot_bridge.links.base.linked_robots import frame_of

FULL = SendPos(1.0, 2.0, 0.5, 0.1, 1e9, 0.5, "driving", 1e9, 0.2, 100.0, "course")
BARE = SendPos(3.0, 4.0, -0.5, 0.0)


def made(robots, columns, words=()):
    params = {"robots": robots, "columns": list(columns), "words": list(words)}
    head = msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": params})
    return packed_frame(head, [np.array(column, dtype=float) for column in columns.values()])


def test_what_a_link_tells_comes_as_it_was():
    assert list(poses_in_frame(frame_of([("a", FULL), ("b", BARE)]))) == [("a", FULL), ("b", BARE)]
    assert list(poses_in_frame(frame_of([("b", BARE)]))) == [("b", BARE)]


def test_what_is_wrong_with_one_robot_leaves_the_others():
    place = {"x": [1, math.nan, 1, 1, 1], "y": [2] * 5, "theta": [0] * 5, "v": [0, 0, 1e9, 0, 0]}
    texts = {"status": [0, 0, 0, 7, 0], "theta_from": [math.nan, math.nan, math.nan, math.nan, 0]}
    found = dict(poses_in_frame(made(list("abcde"), {**place, **texts}, ["go"])))
    assert found["a"] == SendPos(1.0, 2.0, 0.0, 0.0, status="go")
    reasons = {name: str(one) for name, one in found.items() if isinstance(one, MessageError)}
    assert list(reasons) == ["b", "c", "d", "e"]
    assert "x is nan" in reasons["b"] and "v is" in reasons["c"]
    assert "no word" in reasons["d"] and "theta_from is 'go'" in reasons["e"]


@pytest.mark.parametrize(
    ("columns", "reason"),
    [({"x": [1], "y": [1], "theta": [1]}, "column 'v' is missing"), ({"colour": [1]}, "'colour' is not")],
)
def test_columns_that_are_no_positions_are_refused(columns, reason):
    with pytest.raises(MessageError, match=reason):
        list(poses_in_frame(made(["a"], columns)))


def test_a_frame_that_is_cut_or_names_one_twice_is_refused():
    whole = frame_of([("a", FULL)])
    for wrong in (whole[:-8], whole + bytes(8), made(["a", "a"], {"x": [1, 1]})):
        with pytest.raises(DecodingError):
            list(poses_in_frame(wrong))


def test_json_that_holds_no_positions_is_refused():
    assert entries_in({"positions": [{"robot": "a"}]}) == [{"robot": "a"}]
    for wrong in (None, [], {"positions": {}}, {"positions": [1]}):
        with pytest.raises(MessageError):
            entries_in(wrong)
