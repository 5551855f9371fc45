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
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import MapBinaryError, MissingCodecError, RobotMapError
from robot_bridge.core.robotmap.binary import CODEC_COLUMNS, by_lzma, decode, decode_text, encode, from_lzma
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.columnar import pack_map
from robot_bridge.core.robotmap.columns import pack_numbers, unpack_numbers
from robot_bridge.core.robotmap.model import Border, Obstacle, RobotMap, ShapeType, Window
from robot_bridge.core.robotmap.text_format import read_text, write_text
from tests.robot_bridge.core.robotmap.rows import box, outlines, row

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
    head = struct.pack("<4sBBBBQ32s", b"RMAP", 1, 2, 2, 0, length, hashlib.sha256(text).digest())
    return head + by_lzma(body)


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
    with pytest.raises(MapBinaryError, match=r"codec 2 keeps .* line \d+ .* use codec 1"):
        encode(text.replace(old, new, 1), codec=2)


def test_the_papers_sample_is_refused_and_codec_1_carries_it(fig_2):
    with pytest.raises(MapBinaryError, match=r"line 6 .* use codec 1"):
        encode(fig_2, codec=2)
    assert decode_text(encode(fig_2)) == fig_2


def test_a_text_without_its_last_line_break_is_refused():
    text = write_text(a_map(segments([(0, 0)], [(1, 0)])))
    with pytest.raises(MapBinaryError, match=r"would come back as .*use codec 1"):
        encode(text.rstrip("\n"), codec=2)


@pytest.mark.parametrize("far", [1e14, 1e300])
def test_numbers_without_room_are_refused_and_codec_1_named(far):
    with pytest.raises(MapBinaryError, match="use codec 1"):
        encode(a_map(segments([(0, 0)], [(far, 0)])), codec=2)
    with pytest.raises(MapBinaryError, match="use codec 1"):
        encode(a_map(segments([(0, 0)], [(1, 0)], id=10**19)), codec=2)


def test_an_unknown_codec_is_refused(fig_2):
    with pytest.raises(MapBinaryError, match="codec 3 is not known"):
        encode(fig_2, codec=3)


def test_without_cbor2_it_says_what_to_install_and_codec_1_still_works(monkeypatch, fig_2):
    content = encode(a_map(), codec=2)
    monkeypatch.setitem(sys.modules, "cbor2", None)
    for action in (lambda: encode(a_map(), codec=2), lambda: decode(content)):
        with pytest.raises(MissingCodecError, match="pip install cbor2"):
            action()
    assert decode_text(encode(fig_2)) == fig_2


def test_what_only_stands_elsewhere_is_there_once():
    def benches(count):
        return [box(3 * k, k % 7, 3 * k + 1.8, k % 7 + 0.6, source=f"benches:{k}") for k in range(count)]

    sizes = [len(encode(build_map(outlines(*benches(count))), codec=2)) for count in (1, 30)]
    assert sizes[1] < sizes[0] + 3 * 30
    assert cbor2.loads(pack_map(build_map(outlines(*benches(30)))))[7:10] == [30, 120, 1]


@pytest.mark.parametrize(
    "sources",
    [
        ["walls:1+3", "walls:5", "walls:6+1", "walls:6+1"],
        ["walls:7+0", "walls:7+03", "walls:7+", "walls:+7", "walls:0+1", "walls:999999999+999999999"],
        ["walls:9999999999+1", "a:1", "b:1+1", "a:0", "b:2", "", "b:2+1+1"],
    ],
)
def test_chains_with_the_number_of_what_they_join_come_back(sources):
    returned(
        a_map(
            *(
                segments([(k, 0)] * (k % 3), [(k, 1)] * (k % 3), id=k, ext={"src": s} if s else {})
                for k, s in enumerate(sources)
            )
        )
    )


@given(st.lists(st.integers(-(2**61), 2**61 - 1)))
def test_any_whole_numbers_of_62_bits_come_back(numbers):
    assert unpack_numbers(column(*numbers), len(numbers), "numbers").tolist() == numbers


def test_numbers_are_packed_in_the_way_that_is_smaller():
    chance = np.random.default_rng(1)
    small, large = chance.integers(-30, 30, 500), chance.integers(-30_000, 30_000, 500)
    assert pack_numbers(small)[0] in (0, 1) and len(pack_numbers(small)) == 501
    assert pack_numbers(large)[0] == 2 and len(pack_numbers(large)) == 1001
    small[::50] = 40_000
    assert pack_numbers(small)[0] == 0 and len(pack_numbers(small)) < 530
    assert pack_numbers(np.zeros(500, dtype=np.int64)) == b""


def test_columns_of_another_version_are_refused_by_their_version():
    content = bytearray(encode(a_map(), codec=2))
    assert content[4:8] == b"\x01\x02\x02\x00"
    content[6] = 0
    with pytest.raises(
        MapBinaryError, match=r"version check: version 0 of codec 2 .* export the map once more"
    ):
        decode(bytes(content))


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda body: body + b"\x00", "goes on after its end"),
        (lambda body: body[:-6], "has no end|check"),
        (lambda body: b"", "has no end"),
        (lambda body: b"\xff" * 40, "LZMA"),
    ],
)
def test_lzma_that_is_not_whole_is_refused(change, problem):
    content = encode(a_map(segments([(0, 0)], [(1, 0)])), codec=2)
    with pytest.raises(MapBinaryError, match=problem):
        decode(content[:48] + change(content[48:]))


labels = st.text(max_size=8)
centimetres = st.integers(-100_000, 100_000).map(lambda n: n / 100)
points = st.tuples(centimetres, centimetres)


sources = st.tuples(st.integers(0, 10**10), st.sampled_from(["", "+0", "+1", "+2", "+17"])).map(
    lambda parts: {"src": f"walls:{parts[0]}{parts[1]}"}
)


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
        ext=draw(st.one_of(extras, sources)),
        segment_ext=() if same else tuple(draw(extras) for _ in range(n)),
    )


@settings(max_examples=min(50, settings().max_examples))
@given(st.lists(obstacles(), max_size=5))
def test_any_map_in_centimetres_comes_back(some):
    robot_map = a_map(*some, version="1")
    back = returned(robot_map)
    assert write_text(read_text(write_text(robot_map))) == write_text(back)


def column(*numbers):
    """These numbers as they are packed."""
    return pack_numbers(np.array(numbers, dtype=np.int64))


def hostile(**changes):
    """The columns of a small map with some of them replaced, in an envelope."""
    robot_map = a_map(segments([(0, 0), (1, 0)], [(1, 0), (1, 1)]), segments([(3, 3)], [(4, 4)], id=2))
    names = "meta x_min y_min x_max y_max heads tails obstacles segments bodies starts steps heights varies"
    names = [*names.split(), "tail", "kinds", "counts", "body", "head", "ids", "others", "numbers"]
    items = dict(zip(names, cbor2.loads(pack_map(robot_map)), strict=True)) | changes
    return sealed(cbor2.dumps(list(items.values())), write_text(robot_map).encode())


def test_the_hostile_maps_of_these_tests_are_sound_until_they_are_changed():
    assert len(decode(hostile()).obstacles) == 2


@pytest.mark.parametrize(
    ("changes", "check"),
    [
        ({"meta": 3}, "columns check: meta"),
        ({"kinds": "text"}, "columns check: kinds"),
        ({"obstacles": True}, "CBOR check"),
        ({"x_min": [1]}, "CBOR check"),
        ({"x_min": 1 << 64}, "CBOR check"),
        ({"x_min": -(1 << 60)}, "border is too large"),
        ({"x_min": 99999}, "border has no inside"),
        ({"obstacles": -1}, "count is negative"),
        ({"bodies": -1}, "count is negative"),
        ({"obstacles": 1 << 40, "body": b""}, "size check"),
        ({"segments": 1 << 40}, "size check"),
        ({"bodies": 1 << 40}, "bodies do not add up"),
        ({"bodies": 1}, "bodies do not add up"),
        ({"body": column(0, 1)}, "bodies do not add up"),
        ({"body": column(0, -1)}, "bodies do not add up"),
        ({"bodies": 1, "body": column(0, 5)}, "no table"),
        ({"segments": 2}, "counts do not add up"),
        ({"counts": column(1, 5)}, "counts do not add up"),
        ({"segments": 4}, "counts do not add up"),
        ({"counts": column(1, 1)}, "steps has"),
        ({"counts": column(4, -1)}, "counts do not add up"),
        ({"counts": column(3, 0)}, "no points"),
        ({"counts": b"\x01\x02\x03\x04"}, "counts has 4 bytes"),
        ({"counts": b"\x03\x02\x03"}, "counts has 3 bytes"),
        ({"counts": b"\x00\x04"}, "counts has 2 bytes"),
        ({"counts": b"\x00\x04\x82"}, "counts has 3 bytes"),
        ({"counts": b"\x00\x04" + b"\x80" * 9 + b"\x01"}, "counts has 12 bytes"),
        ({"kinds": column(10, 58)}, "form"),
        ({"kinds": column(8, 8)}, "shape type"),
        ({"head": column(0, 4)}, "no table"),
        ({"head": column(0, -1)}, "no table"),
        ({"tail": column(4, 4)}, "no table"),
        ({"numbers": column(1)}, "numbers has 2 bytes for 0"),
        ({"others": column(1)}, "others has 2 bytes for 0"),
        ({"heads": "wall;src=w:\x01;"}, "SHA-256 check|length check"),
        ({"heads": "wall;src=w:\x02;"}, "SHA-256 check|length check"),
        ({"tails": "1;;\x01;;"}, "other fields|check"),
        ({"tails": "1;;nokey;"}, "key=value"),
        ({"heads": "wall;nokey;"}, "key=value"),
        ({"heads": "w" * 5000 + ";"}, "size check"),
        ({"heads": "wand;"}, "SHA-256 check"),
        ({"meta": "\x0b x"}, "check"),
        ({"steps": b"\x02" + b"\xfe\xff" * 9}, "steps has 19 bytes"),
        ({"starts": column(*[1 << 60] * 4)}, "too large"),
        ({"steps": column(*[1 << 60] * 6)}, "too large"),
        ({"heights": b"\x01\x08"}, "heights has 2 bytes"),
    ],
)
def test_columns_that_do_not_fit_together_are_refused_and_the_check_named(changes, check):
    with pytest.raises(MapBinaryError, match=check):
        decode(hostile(**changes))


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"\x96",
        b"\x81" * 4000,
        b"\x9f" + b"\x00" * 22 + b"\xff",
        cbor2.dumps(list(range(21))),
        cbor2.dumps([cbor2.CBORTag(35, "(a+)+$")] * 22),
        cbor2.dumps([1.5] * 22),
        b"\x96" + b"\x5b" + b"\xff" * 8,
        b"\x96" + b"\x60" * 21 + b"\x61\xff",
        cbor2.dumps(["a"] * 22) + b"\x00",
    ],
)
def test_cbor_that_is_more_than_a_flat_array_is_refused_unread(body):
    with pytest.raises(MapBinaryError, match="CBOR check"):
        decode(sealed(body, b"border;\n" * 20))


def test_a_label_repeated_beyond_the_text_is_refused_before_it_is_written():
    count = 20_000
    wall = segments([], [], semantics="w")
    items = cbor2.loads(pack_map(a_map(*[wall] * count)))
    items[5] = "w" * 400_000 + ";"
    content = sealed(cbor2.dumps(items), b"x", length=600_000)
    tracemalloc.start()
    with pytest.raises(MapBinaryError, match="labels alone"):
        decode(content)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20_000_000


def test_a_body_that_unpacks_to_more_than_its_text_is_refused():
    with pytest.raises(MapBinaryError, match="size check: the body"):
        decode(sealed(bytes(10_000_000), b"border;\n"))


SAMPLE = encode(
    build_map(outlines(box(5, 5, 20, 15), row([(-9, 2), (3, 2), (3, 9)])), Window(5, 5, 20, 20)), codec=2
)
SAMPLE_BODY = from_lzma(SAMPLE[48:], 100_000)


@given(st.data())
def test_no_altered_byte_of_the_columns_goes_unnoticed(data):
    body = bytearray(SAMPLE_BODY)
    for _ in range(data.draw(st.integers(1, 3))):
        body[data.draw(st.integers(0, len(body) - 1))] ^= data.draw(st.integers(1, 255))
    cut = data.draw(st.sampled_from([len(body), data.draw(st.integers(0, len(body)))]))
    content = SAMPLE[:48] + by_lzma(bytes(body[:cut]))
    with contextlib.suppress(RobotMapError):
        assert decode_text(content) == decode_text(SAMPLE)


@given(
    st.lists(st.one_of(st.integers(-(2**64), 2**64 - 1), st.text(), st.binary()), min_size=22, max_size=22)
)
def test_nothing_but_its_own_errors_comes_of_any_columns(items):
    with pytest.raises(RobotMapError):
        decode(sealed(cbor2.dumps(items), b"border;\n" * 50))
