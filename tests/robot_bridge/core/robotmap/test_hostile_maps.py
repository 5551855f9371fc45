"""Robot maps from strangers: 1 MB costs whoever reads it at most 1 s and 200 MB, whatever is in it."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import MapBinaryError
from robot_bridge.core.robotmap.binary import decode, decode_text, encode
from robot_bridge.core.robotmap.text_format import read_ext, read_text
from tests.robot_bridge.core.robotmap import hostile_maps
from tests.robot_bridge.core.robotmap.hostile_maps import (
    EMPTY,
    HEAD,
    ONE,
    cost,
    many_obstacles,
    obstacle,
    sealed,
)

SLOW = 3
"""times as slow as a common computer may be that runs the tests beside others."""
MEMORY = 200
"""MB of the whole process, of which Python, numpy and the files take 50."""


def test_no_map_of_one_megabyte_costs_more_than_a_second_or_200_mb(tmp_path):
    hostile_maps.store(tmp_path / "maps")
    root = Path(__file__).parents[4]
    done = subprocess.run(
        [sys.executable, hostile_maps.__file__, str(tmp_path / "maps")],
        env={"PYTHONPATH": str(root)},
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    rows = [line.split(maxsplit=3) for line in done.stdout.splitlines()]
    assert len(rows) > 50 and all(int(size) < 1_100_000 for _, _, size, _ in rows)
    too_dear = [
        (name, seconds, memory)
        for seconds, memory, _, name in rows
        if float(seconds) > SLOW or int(memory) > MEMORY
    ]
    assert too_dear == []


LINES = ["obstacle;\n", "#\n", "1;1;0;;\n", "1;1;1;w;a=1;\n", "0;0;\n", "2;1;;\n", "2;1;;k=v,1;\n", "%c\n"]
pieces = st.sampled_from([*LINES, *" \t\r\n%;,=a09.e-\x00\U0001f600", "\\2c", "\\u2028", "border;\n"])


@settings(max_examples=60, deadline=None)
@given(st.lists(pieces, max_size=6), st.lists(pieces, min_size=1, max_size=4), st.lists(pieces, max_size=3))
def test_what_is_repeated_costs_in_proportion(begin, repeated, end):
    again = "".join(repeated)
    text = HEAD + "".join(begin) + again * math.ceil(100_000 / len(again)) + "".join(end)
    # A tenth of 1 MB: what grows with the square takes many seconds here too.
    assert cost(lambda: read_text(text)) < SLOW * 0.1 + 0.2


@pytest.mark.parametrize("count", [0, 1])
def test_a_file_of_a_few_bytes_does_not_unpack_to_more_obstacles_than_one_of_a_megabyte(count):
    text = (HEAD + (ONE if count else EMPTY) * 60_000).encode()
    content = sealed(1, zstandard.compress(text), text)
    with pytest.raises(
        MapBinaryError, match=r"size check: the map has more .* export it as text, or in tiles"
    ):
        decode(content)
    assert len(decode(content, len(text)).obstacles) == 60_000
    with pytest.raises(MapBinaryError, match="size check"):
        decode(many_obstacles(60_000))


def test_a_text_of_more_than_eight_megabytes_is_refused_unpacked_unless_it_is_asked_for():
    text = HEAD + obstacle("x" * 8_000_000)
    content = encode(text)
    assert len(content) < 2_000
    with pytest.raises(
        MapBinaryError, match=r"size check: 8000\d+ bytes of text .* limit for these \d+ bytes"
    ):
        decode_text(content)
    assert decode_text(content, 9_000_000) == text


def test_extras_are_read_as_before_however_many_commas_they_have():
    assert read_ext("n=0,0.08,1,src=a:1") == {"n": "0,0.08,1", "src": "a:1"}
    assert read_ext("a=,,") == {"a": ",,"} and read_ext("a==") == {"a": "="} and read_ext("") == {}
    assert read_ext("a=1,a=2,") == {"a": "2,"}
    for wrong in ("a", ",a=1", ","):
        with pytest.raises(ValueError):
            read_ext(wrong)
