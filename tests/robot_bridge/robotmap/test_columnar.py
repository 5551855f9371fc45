"""Codec 2: nothing that a map in centimetres says is lost, and nothing hostile is believed."""

from __future__ import annotations

import contextlib
import hashlib
import struct
import sys
import tracemalloc

import cbor2
import numpy as np
import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.robotmap.binary import CODEC_COLUMNS, decode, decode_text, encode
from robot_bridge.robotmap.builder import Window, build_map
from robot_bridge.robotmap.columnar import pack_map
from robot_bridge.robotmap.errors import BinaryError, MissingCodecError, RobotMapError
from robot_bridge.robotmap.model import Border, Obstacle, RobotMap, ShapeType
from robot_bridge.robotmap.text import read_text, write_text

from .rows import box, outlines, row

BORDER = Border(-4.0, -4.0, 100.0, 100.0)


def segments(a, b, height=2.0, **more):
    """An obstacle with these segments."""
    n = len(a)
    values = {
        "id": 1,
        "shape_type": ShapeType.OPEN_POLYGON,
        "semantics": "wall",
        "height": np.zeros(n) + height,
        "outdoor": np.ones(n, dtype=bool),
        "segment_semantics": ("",) * n,
        **more,
    }
    return Obstacle(a=np.array(a, float).reshape(-1, 2), b=np.array(b, float).reshape(-1, 2), **values)


def a_map(*obstacles, **meta):
    return RobotMap(BORDER, obstacles, meta)


def returned(robot_map):
    """What comes back of a map, seen to have the same text."""
    content = encode(robot_map, codec=CODEC_COLUMNS)
    assert decode_text(content) == write_text(robot_map)
    return decode(content)


def sealed(body, text, length=None):
    """An envelope around ``body`` that claims to hold ``text``."""
    length = len(text) if length is None else length
    head = struct.pack("<4sBBHQ32s", b"RMAP", 1, 2, 0, length, hashlib.sha256(text).digest())
    return head + zstandard.compress(body)


def test_a_built_map_comes_back_with_all_it_says():
    risers = row([(0, 0), (2, 0), (0, 0.3), (2, 0.3)], ShapeType.STAIRS, semantics="stairs", height=0.17)
    made = build_map(
        outlines(
            box(5, 5, 20, 15), box(8, 8, 12, 12, courtyard=True), row([(-9, 2), (3, 2), (3, 9)]), risers
        ),
        Window(5, 5, 20, 20),
        {"version": "7", "crs": "EPSG:25831", "id": "campus"},
    )
    back = returned(made)
    assert back.meta == made.meta and back.border == made.border
    assert len(back.obstacles) == len(made.obstacles) > 3
    for mine, theirs in zip(back.obstacles, made.obstacles, strict=True):
        assert (mine.id, mine.shape_type, mine.semantics, mine.ext) == (
            theirs.id,
            theirs.shape_type,
            theirs.semantics,
            theirs.ext,
        )
        assert (mine.a == theirs.a).all() and (mine.b == theirs.b).all()
        assert (mine.height == theirs.height).all() and (mine.outdoor == theirs.outdoor).all()


def test_segments_that_differ_from_each_other_keep_what_each_one_says():
    odd = segments(
        [(0, 0), (1, 0), (5, 5)],
        [(1, 0), (1, 1), (6, 5)],
        height=np.array([1.2, 0.0, -3.4]),
        outdoor=np.array([True, False, True]),
        segment_semantics=("wall,brick", "", "a;b%c"),
        segment_ext=({"n": "0,0.08,1"}, {}, {"k": "v"}),
        ext={"src": "walls:12", "h": "est"},
    )
    (back,) = returned(a_map(odd)).obstacles
    assert back.height.tolist() == [1.2, 0, -3.4] and back.outdoor.tolist() == [True, False, True]
    assert back.segment_semantics == odd.segment_semantics and back.segment_ext == odd.segment_ext
    assert back.ext == odd.ext


@pytest.mark.parametrize(
    "obstacle",
    [
        segments([], []),
        segments([(1, 1)], [(1, 1)]),
        segments([(0, 0), (0, 0)], [(1, 0), (1, 0)]),
        segments([(-0.0, 1)], [(1e9, -1e9)]),
        segments([(0, 0)], [(1, 0)], id=-(10**17), semantics="ä\u2028;%#\\", ext={"a=b,": "1,2=;"}),
        segments([(0, 0)], [(1, 0)], ext={"src": "walls:007"}),
        segments([(0, 0)], [(1, 0)], ext={"src": "a:b:12:34", "x": "src=q:1"}),
    ],
)
def test_what_no_builder_makes_comes_back_too(obstacle):
    returned(a_map(obstacle, segments([(3, 3)], [(4, 4)], id=2, ext={"src": "walls:3"})))


def test_a_map_of_nothing_comes_back():
    assert returned(a_map(crs="EPSG:32633")).meta == {"crs": "EPSG:32633"}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("4.53;", "4.530;"),
        ("4.53;", " 4.53;"),
        ("4.53;", "4.531;"),
        ("4.53;", "+4.53;"),
        ("1;2;1;", "1;2;4;"),
        ("wall;", "wall;%a comment"),
        ("border;", "% a comment\nborder;"),
        ("\n", "\r\n"),
    ],
)
def test_a_text_that_would_come_back_otherwise_is_refused_and_codec_1_named(old, new):
    text = write_text(a_map(segments([(4.53, 0)], [(1, 0)])))
    assert decode_text(encode(text, codec=2)) == text
    with pytest.raises(BinaryError, match=r"codec 2 keeps .* line \d+ .* use codec 1"):
        encode(text.replace(old, new, 1), codec=2)


def test_the_papers_sample_is_refused_and_codec_1_carries_it(fig_2):
    with pytest.raises(BinaryError, match=r"line 6 .* use codec 1"):
        encode(fig_2, codec=2)
    assert decode_text(encode(fig_2)) == fig_2


def test_a_text_without_its_last_line_break_is_refused():
    text = write_text(a_map(segments([(0, 0)], [(1, 0)])))
    with pytest.raises(BinaryError, match=r"would come back as .*use codec 1"):
        encode(text.rstrip("\n"), codec=2)


@pytest.mark.parametrize("far", [1e14, 1e300])
def test_numbers_without_room_are_refused_and_codec_1_named(far):
    with pytest.raises(BinaryError, match="use codec 1"):
        encode(a_map(segments([(0, 0)], [(far, 0)])), codec=2)
    with pytest.raises(BinaryError, match="use codec 1"):
        encode(a_map(segments([(0, 0)], [(1, 0)], id=10**19)), codec=2)


def test_an_unknown_codec_is_refused(fig_2):
    with pytest.raises(BinaryError, match="codec 3 is not known"):
        encode(fig_2, codec=3)


def test_without_cbor2_it_says_what_to_install_and_codec_1_still_works(monkeypatch, fig_2):
    content = encode(a_map(), codec=2)
    monkeypatch.setitem(sys.modules, "cbor2", None)
    for action in (lambda: encode(a_map(), codec=2), lambda: decode(content)):
        with pytest.raises(MissingCodecError, match="pip install cbor2"):
            action()
    assert decode_text(encode(fig_2)) == fig_2


labels = st.text(max_size=8)
centimetres = st.integers(-100_000, 100_000).map(lambda n: n / 100)
points = st.tuples(centimetres, centimetres)


@st.composite
def obstacles(draw):
    """Chains, rings and loose segments, alike or all different."""
    corners = draw(st.lists(points, min_size=0, max_size=6))
    a, b = corners[:-1], corners[1:]
    if draw(st.booleans()) and corners:
        a, b = corners, [*corners[1:], corners[0]]
    n = len(a)
    same = draw(st.booleans())
    heights = st.just(2.5) if same else centimetres
    extras = st.dictionaries(labels.filter(bool), labels, max_size=2)
    return Obstacle(
        id=draw(st.integers(-5, 10**6)),
        shape_type=draw(st.sampled_from(ShapeType)),
        semantics=draw(labels),
        a=np.array(a, float).reshape(-1, 2),
        b=np.array(b, float).reshape(-1, 2),
        height=np.array([draw(heights) for _ in range(n)], float),
        outdoor=np.array([same or draw(st.booleans()) for _ in range(n)], dtype=bool),
        segment_semantics=tuple("" if same else draw(labels) for _ in range(n)),
        ext=draw(st.one_of(extras, st.integers(0, 10**10).map(lambda k: {"src": f"walls:{k}"}))),
        segment_ext=() if same else tuple(draw(extras) for _ in range(n)),
    )


@settings(max_examples=200, deadline=None)
@given(st.lists(obstacles(), max_size=5))
def test_any_map_in_centimetres_comes_back(some):
    robot_map = a_map(*some, version="1")
    back = returned(robot_map)
    assert write_text(read_text(write_text(robot_map))) == write_text(back)


def hostile(**changes):
    """The columns of a small map with some of them replaced, in an envelope."""
    robot_map = a_map(segments([(0, 0), (1, 0)], [(1, 0), (1, 1)]), segments([(3, 3)], [(4, 4)], id=2))
    names = "meta x_min y_min x_max y_max heads tails obstacles segments forms counts ids head numbers varies"
    names = [*names.split(), "tail", "heights", "starts", "steps"]
    items = dict(zip(names, cbor2.loads(pack_map(robot_map)), strict=True)) | changes
    return sealed(cbor2.dumps(list(items.values())), write_text(robot_map).encode())


def test_the_hostile_maps_of_these_tests_are_sound_until_they_are_changed():
    assert len(decode(hostile()).obstacles) == 2


@pytest.mark.parametrize(
    ("changes", "check"),
    [
        ({"meta": 3}, "columns check: meta"),
        ({"forms": "text"}, "columns check: forms"),
        ({"obstacles": True}, "CBOR check"),
        ({"x_min": [1]}, "CBOR check"),
        ({"x_min": 1 << 64}, "CBOR check"),
        ({"x_min": -(1 << 60)}, "border is too large"),
        ({"x_min": 99999}, "border has no inside"),
        ({"obstacles": -1}, "count is negative"),
        ({"obstacles": 1 << 40, "counts": b"", "forms": b""}, "size check"),
        ({"segments": 1 << 40}, "size check"),
        ({"segments": 2}, "counts do not add up"),
        ({"counts": b"\x01\x05"}, "counts do not add up"),
        ({"counts": b"\x01\x02\x03"}, "counts has 3 bytes"),
        ({"forms": b"\x04\x7e"}, "form"),
        ({"forms": b"\x10\x10"}, "shape type"),
        ({"head": b"\x00\x08"}, "no table"),
        ({"head": b"\x00\x01"}, "no table"),
        ({"tail": b"\x08\x08"}, "no table"),
        ({"tails": "1;;\x01;;"}, "other fields|check"),
        ({"tails": "1;;nokey;"}, "key=value"),
        ({"heads": "wall;nokey;"}, "key=value"),
        ({"heads": "w" * 5000 + ";"}, "size check"),
        ({"heads": "wand;"}, "SHA-256 check"),
        ({"meta": "\x0b x"}, "check"),
        ({"steps": b"\xfe\xff" * 8}, "steps has 16 bytes"),
        ({"starts": struct.pack("<4Q", *[(1 << 64) - 1] * 4)}, "too large"),
        ({"heights": b"\x08"}, "heights has 1 bytes"),
    ],
)
def test_columns_that_do_not_fit_together_are_refused_and_the_check_named(changes, check):
    with pytest.raises(BinaryError, match=check):
        decode(hostile(**changes))


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"\x93",
        b"\x81" * 4000,
        b"\x9f" + b"\x00" * 19 + b"\xff",
        cbor2.dumps(list(range(18))),
        cbor2.dumps([cbor2.CBORTag(35, "(a+)+$")] * 19),
        cbor2.dumps([1.5] * 19),
        b"\x93" + b"\x5b" + b"\xff" * 8,
        b"\x93" + b"\x60" * 18 + b"\x61\xff",
        cbor2.dumps(["a"] * 19) + b"\x00",
    ],
)
def test_cbor_that_is_more_than_a_flat_array_is_refused_unread(body):
    with pytest.raises(BinaryError, match="CBOR check"):
        decode(sealed(body, b"border;\n" * 20))


def test_a_label_repeated_beyond_the_text_is_refused_before_it_is_written():
    count = 20_000
    wall = segments([], [], semantics="w")
    items = cbor2.loads(pack_map(a_map(*[wall] * count)))
    items[5] = "w" * 400_000 + ";"
    content = sealed(cbor2.dumps(items), b"x", length=600_000)
    tracemalloc.start()
    with pytest.raises(BinaryError, match="labels alone"):
        decode(content)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20_000_000


def test_a_body_that_unpacks_to_more_than_its_text_is_refused():
    with pytest.raises(BinaryError, match="size check: the body"):
        decode(sealed(bytes(50_000_000), b"border;\n"))


SAMPLE = encode(
    build_map(outlines(box(5, 5, 20, 15), row([(-9, 2), (3, 2), (3, 9)])), Window(5, 5, 20, 20)), codec=2
)
SAMPLE_BODY = zstandard.ZstdDecompressor().decompressobj().decompress(SAMPLE[48:])


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_no_altered_byte_of_the_columns_goes_unnoticed(data):
    body = bytearray(SAMPLE_BODY)
    for _ in range(data.draw(st.integers(1, 3))):
        body[data.draw(st.integers(0, len(body) - 1))] ^= data.draw(st.integers(1, 255))
    cut = data.draw(st.sampled_from([len(body), data.draw(st.integers(0, len(body)))]))
    content = SAMPLE[:48] + zstandard.compress(bytes(body[:cut]))
    with contextlib.suppress(RobotMapError):
        assert decode_text(content) == decode_text(SAMPLE)


@settings(max_examples=300, deadline=None)
@given(
    st.lists(st.one_of(st.integers(-(2**64), 2**64 - 1), st.text(), st.binary()), min_size=19, max_size=19)
)
def test_nothing_but_its_own_errors_comes_of_any_columns(items):
    with pytest.raises(RobotMapError):
        decode(sealed(cbor2.dumps(items), b"border;\n" * 50))
