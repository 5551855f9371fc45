"""The decoder of what comes from outside: right for what is JSON, and bounded for everything else."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core import json_decoder
from robot_bridge.core.json_decoder import MESSAGE, MOST_DIGITS, SHORT, DecodingError, decode_json
from robot_bridge.protocol import jsonrpc
from robot_bridge.protocol.codec import decode_position

stored = st.characters(exclude_categories=["Cs"], exclude_characters="\0")
values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**MOST_DIGITS) + 1, 10**MOST_DIGITS - 1)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(stored, max_size=8)
    | st.sampled_from(['["', '\\"[', "\\", '"', "[[[{"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(stored, max_size=5), inner, max_size=3)
    ),
    max_leaves=60,
)
DEEPEST = "[" * MESSAGE.depth + "]" * MESSAGE.depth


@pytest.fixture(params=["quick", "careful"])
def parser(request, monkeypatch):
    """With msgspec, and without it as in QGIS."""
    if request.param == "careful":
        monkeypatch.setattr(json_decoder, "_quickly", None)


@given(values, st.booleans())
def test_what_is_json_comes_back_as_it_was(value, escaped):
    text = json.dumps(value, ensure_ascii=escaped)
    assert decode_json(text) == decode_json(text.encode()) == value
    assert type(decode_json(text)) is type(value)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 2000, "nested deeper than 32 levels"),
        ("[" * 100_000, "nested deeper than 32 levels"),
        ('{"a":' * 2000 + "1" + "}" * 2000, "nested deeper than 32 levels"),
        (f"[{DEEPEST}]", "nested deeper than 32 levels"),
        ("[}" * 100, "brackets do not close"),
        ('"' + '\\"' * 500_000 + "[" * 40, None),
        ("[" * 40 + '"\\', "nested deeper"),
        (f"[{'[],' * 300_000}[]]", "holds more than 500000 values"),
        (f"[{'1,' * 600_000}1]", "holds more than 500000 values"),
        (" " * (MESSAGE.length + 1), "it has 33554433 characters, and 33554432 are the most"),
        ("1" * (MOST_DIGITS + 1), "more than 40 digits"),
        ("-" + "9" * 5000, "more than 40 digits"),
        ('{"id": 1e400}', None),
        ("[-1e400]", None),
        ("[NaN]", None),
        ("[Infinity]", None),
        ("[-Infinity]", None),
        ("", None),
        ("{", None),
        ('"a\nb"', None),
        ('"a\0b"', None),
        (b'"\xff"', "it is not UTF-8: invalid start byte at byte 1"),
        (b'"\xed\xa0\x80"', "it is not UTF-8"),
        ("\ufeff{}", None),
        ("[1] [2]", None),
    ],
    ids=range(25),
)
def test_all_else_is_one_error_and_quickly(parser, text, reason):
    began = time.thread_time()
    with pytest.raises(DecodingError, match=reason):
        decode_json(text)
    assert time.thread_time() - began < 1.0


def test_a_text_may_be_as_deep_as_the_bounds_and_brackets_in_texts_do_not_count(parser):
    assert json.dumps(decode_json(DEEPEST)) == DEEPEST
    nested = json.dumps({"reason": "[" * 5000 + '\\"' + "{" * 5000, "x": [1]})
    assert decode_json(nested) == json.loads(nested)


@pytest.mark.parametrize("size", [1, 30])
def test_never_is_python_recursed_into_deeper_than_the_bounds(parser, size):
    """Not even with a stack that is nearly full: nobody catches a RecursionError here."""
    frame = sys._getframe()
    used = 0
    while frame is not None:
        used, frame = used + 1, frame.f_back
    limit = sys.getrecursionlimit()
    text = json.dumps({"\0": DEEPEST, "deep": json.loads("[" * size + '"\\u0000"' + "]" * size)})
    try:
        sys.setrecursionlimit(used + 4 * MESSAGE.depth)
        assert decode_json(text)["\ufffd"] == DEEPEST
    finally:
        sys.setrecursionlimit(limit)


def test_what_no_database_stores_is_replaced_and_the_rest_is_kept(parser):
    text = '{"reason": "no\\u0000 \\ud800way", "a\\u0000": ["\\udfff", "\\ud83e\\udd16", "\\\\u0000"]}'
    assert decode_json(text) == {
        "reason": "no\ufffd \ufffdway",
        "a\ufffd": ["\ufffd", "\U0001f916", "\\u0000"],
    }


def test_shorter_bounds_hold_where_they_are_given():
    assert decode_json("[" * 8 + "]" * 8, SHORT)
    for text in ("[" * 9 + "]" * 9, f'"{"x" * SHORT.length}"', f"[{'1,' * 1000}1]"):
        with pytest.raises(DecodingError):
            decode_json(text, SHORT)


POSITION = '{"jsonrpc": "2.0", "method": "SendPos", "params": {"x": 1, "y": 2, "theta": 0, "v": 0%s}}'


@pytest.mark.parametrize("opening", ["[", '{"a":'])
@pytest.mark.parametrize(
    "frame",
    [
        "%s",
        POSITION.replace("%s", ', "status": %s'),
        POSITION.replace("%s", ', "unknown": %s'),
        '{"jsonrpc": %s',
        '{"unknown": %s',
        '{"params": %s',
        '{"params": {"x": %s',
        '{"params": {"unknown": %s',
    ],
)
def test_the_quick_way_of_a_position_is_as_bounded(frame, opening):
    """Nobody catches a RecursionError there: what is unknown in a position is passed over by recursion."""
    for levels in (40, 2000, 100_000):
        deep = frame % (opening * levels)
        assert decode_position(deep) is decode_position(deep.encode()) is None
        with pytest.raises(jsonrpc.FrameError):
            jsonrpc.decode(deep)


def test_a_position_holds_no_character_that_is_not_stored_on_either_way():
    frame = POSITION % ', "status": "a\\u0000b"'
    assert decode_position(frame).status == "a b"
    assert jsonrpc.decode(frame).params["status"] == "a\ufffdb"


@pytest.mark.parametrize("code", [True, 1.5, "1"])
def test_the_code_of_an_error_is_a_whole_number_or_none(code):
    frame = json.dumps({"jsonrpc": "2.0", "id": 1, "error": {"code": code, "message": "no"}})
    assert jsonrpc.decode(frame).code is None


# --- nobody decodes otherwise -----------------------------------------------------------------------------

DECODERS = {"loads", "load", "JSONDecoder", "raw_decode", "decode", "Decoder"}
MODULES = {"json", "msgspec"}
ALLOWED = {
    ("core/json_decoder.py", "json.JSONDecoder"),
    ("protocol/codec.py", "msgspec.json.Decoder"),
    # What other gateways of the fleet say, signed and bounded in size, into classes with bounds of their own.
    ("gateway/cluster/messages.py", "msgspec.msgpack.Decoder"),
}


def dotted(node):
    if isinstance(node, ast.Attribute):
        return f"{dotted(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else "?"


def decoders_in(text):
    if not any(module in text for module in MODULES):
        return
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Attribute) and node.attr in DECODERS:
            name = dotted(node)
            if name.split(".")[0] in MODULES:
                yield name
        elif (
            isinstance(node, ast.ImportFrom)
            and (node.module or "").split(".")[0] in MODULES
            and not node.level
        ):
            yield from (f"{node.module}.{alias.name}" for alias in node.names if alias.name in DECODERS)


ALLOWED_IN_THE_PLUGIN = {("gateway_client/protocol.py", "json.loads")}
"""Behind check_bounds: what reads a number of it names what is none."""


def decoders_of(folder):
    return {
        (str(file.relative_to(folder)), name)
        for file in sorted(folder.rglob("*.py"))
        for name in decoders_in(file.read_text(encoding="utf-8"))
    }


def test_json_from_outside_is_decoded_by_this_decoder_alone(root):
    found = decoders_of(root / "robot_bridge")
    own = ("core/json_decoder.py", "msgspec.json.decode")
    assert found == {*ALLOWED, own}, "use core.json_decoder.decode_json"
    assert decoders_of(root / "plugin") == ALLOWED_IN_THE_PLUGIN, "use core.json_decoder.decode_json"


def test_the_reader_of_sources_sees_every_way_to_decode():
    text = "import json, msgspec\njson.loads(a)\nmsgspec.json.decode(a)\n"
    text += "from json import load as l\njson.dumps(a)\n"
    assert sorted(decoders_in(text)) == ["json.load", "json.loads", "msgspec.json.decode"]


def test_the_decoder_works_without_msgspec(root):
    program = "import sys; sys.modules['msgspec'] = None; "
    program += "from robot_bridge.core.json_decoder import decode_json as d; print(d('{\"a\": [1.5]}'))"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=root, capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == "{'a': [1.5]}", done.stderr
