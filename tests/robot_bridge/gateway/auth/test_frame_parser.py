"""Frames are found in whatever pieces a client's bytes come, and only short whole texts are taken out."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.frames import Frame, Opcode

from robot_bridge.gateway.auth.client_connection import LONGEST, FrameParser, short_text

payloads = st.one_of(st.binary(max_size=200), st.integers(0, 70_000).map(lambda size: b"a" * size))
frames = st.builds(
    lambda opcode, payload, fin, masked: Frame(opcode, payload, fin).serialize(mask=masked),
    st.sampled_from([Opcode.TEXT, Opcode.BINARY, Opcode.CONT]),
    payloads,
    st.booleans(),
    st.booleans(),
)


@given(st.lists(frames, max_size=6), st.data())
def test_the_edge_after_every_frame_is_found_however_the_stream_is_cut(sent, data):
    stream = b"".join(sent)
    ends = {0, *itertools.accumulate(len(frame) for frame in sent)}
    cuts = data.draw(st.lists(st.integers(0, len(stream)), max_size=20))
    edges, at = FrameParser(), 0
    for cut in [*sorted(cuts), *range(max(0, len(stream) - 20), len(stream) + 1)]:
        if cut >= at:
            edges.pass_over(stream[at:cut])
            at = cut
            assert edges.between == (at in ends)


@given(st.text(max_size=LONGEST), st.binary(max_size=30), st.binary(max_size=30))
def test_a_short_text_of_ascii_is_taken_as_it_was_sent(text, before, after):
    frame = Frame(Opcode.TEXT, text.encode()).serialize(mask=True)
    found = short_text(before + frame + after, len(before))
    if text.isascii() and text:
        assert found == (text.encode(), len(before) + len(frame))
    else:
        assert found is None


@pytest.mark.parametrize("size", [1, 125, 126, 127, LONGEST])
def test_every_way_of_stating_the_length_is_read(size):
    frame = Frame(Opcode.TEXT, b"x" * size).serialize(mask=True)
    assert short_text(frame, 0) == (b"x" * size, len(frame))
    assert all(short_text(frame[:cut], 0) is None for cut in range(len(frame)))


def test_a_long_text_is_left_to_them_whatever_its_mask_makes_of_it():
    header = b"\x81\xff" + (70_000).to_bytes(8, "big") + b"mask"
    assert short_text(header + b"x" * 70_000, 0) is None


@pytest.mark.parametrize(
    ("frame", "masked"),
    [
        (Frame(Opcode.TEXT, b"x" * (LONGEST + 1)), True),
        (Frame(Opcode.TEXT, b"x" * 70_000), True),
        (Frame(Opcode.TEXT, b"x"), False),
        (Frame(Opcode.TEXT, b"x", fin=False), True),
        (Frame(Opcode.CONT, b"x"), True),
        (Frame(Opcode.BINARY, b"x"), True),
        (Frame(Opcode.PING, b"x"), True),
        (Frame(Opcode.CLOSE, b"\x03\xe8"), True),
        (Frame(Opcode.TEXT, "ö".encode()), True),
        (Frame(Opcode.TEXT, b"\xff"), True),
        (Frame(Opcode.TEXT, b""), True),
    ],
    ids=lambda part: str(part)[:40],
)
def test_anything_else_is_left_to_those_who_know_all_of_the_protocol(frame, masked):
    assert short_text(frame.serialize(mask=masked), 0) is None


def test_a_text_with_a_reserved_bit_is_left_to_them_too():
    frame = Frame(Opcode.TEXT, b"x").serialize(mask=True)
    assert short_text(bytes([frame[0] | 0x40]) + frame[1:], 0) is None


@given(st.binary(max_size=300), st.integers(0, 300))
def test_whatever_is_sent_a_text_lies_within_it(data, start):
    found = short_text(data, min(start, len(data)))
    assert found is None or (found[0].isascii() and start < found[1] <= len(data))
