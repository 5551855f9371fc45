"""The binary format: byte-exact, and each damage is named by the check that found it."""

from __future__ import annotations

import hashlib
import struct
import sys

import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.errors import MapBinaryError, MapTextError, MissingCodecError, RobotMapError
from robot_bridge.core.robotmap.binary import decode, decode_text, encode
from robot_bridge.core.robotmap.text_format import read_text


def test_the_text_comes_back_byte_for_byte(fig_2):
    assert decode_text(encode(fig_2)) == fig_2
    assert decode_text(encode(read_text(fig_2))) == fig_2
    assert [o.id for o in decode(encode(fig_2)).obstacles] == [1, 110]


@given(st.text(max_size=300))
def test_any_text_comes_back(text):
    assert decode_text(encode(text)) == text


def test_the_envelope_is_laid_out_as_documented(fig_2):
    content = encode(fig_2)
    assert content[:8] == b"RMAP\x01\x01\x00\x00"
    assert struct.unpack_from("<Q", content, 8)[0] == len(fig_2.encode())
    assert zstandard.ZstdDecompressor().decompress(content[48:]) == fig_2.encode()


@pytest.mark.parametrize(
    ("damage", "check"),
    [
        (lambda c: b"GMAP" + c[4:], "magic check"),
        (lambda c: b"", "magic check"),
        (lambda c: c[:20], "envelope check"),
        (lambda c: c[:4] + b"\x09" + c[5:], "version check"),
        (lambda c: c[:5] + b"\x07" + c[6:], "codec check"),
        (lambda c: c[:8] + struct.pack("<Q", 1 << 40) + c[16:], "size check"),
        (lambda c: c[:8] + struct.pack("<Q", 3) + c[16:], "length check"),
        (lambda c: c[:8] + struct.pack("<Q", 100_000) + c[16:], "length check"),
        (lambda c: c[:16] + bytes(32) + c[48:], "SHA-256 check"),
        (lambda c: c[:48] + b"not zstd at all", "body check"),
        (lambda c: c[: len(c) // 2 + 30], "check"),
    ],
)
def test_damage_is_named_by_the_check_that_found_it(fig_2, damage, check):
    with pytest.raises(MapBinaryError, match=check):
        decode(damage(encode(fig_2)))


@given(st.data())
def test_no_altered_byte_goes_unnoticed(data):
    content = bytearray(encode("border;\n-4;100;\n100;-4;\n#\n" * 3))
    position = data.draw(st.integers(0, len(content) - 1))
    content[position] ^= data.draw(st.integers(1, 255))
    try:
        text = decode_text(bytes(content))
    except RobotMapError:
        return
    assert text == "border;\n-4;100;\n100;-4;\n#\n" * 3


def test_a_small_body_that_unpacks_to_too_much_is_refused_unread():
    bomb = zstandard.ZstdCompressor().compress(bytes(50_000_000))
    envelope = struct.pack("<4sBBHQ32s", b"RMAP", 1, 1, 0, 1000, bytes(32))
    with pytest.raises(MapBinaryError, match=r"length check.*more"):
        decode_text(envelope + bomb)


def test_without_zstandard_it_says_what_to_install(monkeypatch, fig_2):
    monkeypatch.setitem(sys.modules, "zstandard", None)
    with pytest.raises(MissingCodecError, match="pip install zstandard"):
        encode(fig_2)


def test_a_reader_can_set_a_lower_limit(fig_2):
    with pytest.raises(MapBinaryError, match=r"^size check"):
        decode(encode(fig_2), limit=20)


def test_a_text_that_is_no_map_is_an_error_of_the_text():
    with pytest.raises(MapTextError, match="border;"):
        decode(encode("hello\n"))


def test_a_text_that_is_no_utf_8_is_refused():
    raw = b"border;\xff"
    head = struct.pack("<4sBBHQ32s", b"RMAP", 1, 1, 0, len(raw), hashlib.sha256(raw).digest())
    with pytest.raises(MapBinaryError, match="UTF-8"):
        decode(head + zstandard.compress(raw))
