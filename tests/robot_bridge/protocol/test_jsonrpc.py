"""JSON-RPC 2.0 frames are read as the standard says, and anything else is refused with its own code."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.protocol import jsonrpc
from robot_bridge.protocol.jsonrpc import Call, FrameError, Reply

stored = st.characters(exclude_categories=["Cs"], exclude_characters="\0")
"""Characters that every database stores."""
ids = st.none() | st.integers(-(2**53), 2**53) | st.text(stored, max_size=10)
values = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.text(stored, max_size=8),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(stored, max_size=5), inner, max_size=3)
    ),
    max_leaves=6,
)


@given(
    st.text(stored, min_size=1, max_size=12),
    st.dictionaries(st.text(stored, max_size=5), values, max_size=3),
    ids,
)
def test_a_call_comes_back_as_it_was_sent(method, params, id):
    assert jsonrpc.decode(jsonrpc.call(method, params, id)) == Call(method, params or None, id)


@given(ids, values)
def test_a_result_comes_back_as_it_was_sent(id, value):
    assert jsonrpc.decode(jsonrpc.result(id, value)) == Reply(id, value)


@given(ids, st.integers(-40000, 40000), st.text(stored, max_size=20))
def test_an_error_comes_back_as_it_was_sent(id, code, text):
    assert jsonrpc.decode(jsonrpc.error(id, code, text)) == Reply(id, None, text, code)


@pytest.mark.parametrize(
    ("sent", "answered"),
    [
        (r"a\u0000b", "a\ufffdb"),
        (r"a\ud83db", "a\ufffdb"),
        (r"\ude00", "\ufffd"),
        (r"\ude00\ud83d", "\ufffd\ufffd"),
        (r"\ud83d\ude00", "\U0001f600"),
    ],
)
def test_an_id_is_answered_without_nul_and_halves_of_pairs(sent, answered):
    id = jsonrpc.decode(f'{{"jsonrpc": "2.0", "method": "Alive", "id": "{sent}"}}').id
    for frame in (jsonrpc.result(id, {}), jsonrpc.error(id, -1, "no")):
        assert json.loads(frame)["id"] == answered
    with pytest.raises(FrameError) as caught:
        jsonrpc.decode(f'{{"jsonrpc": "2.0", "id": "{sent}"}}')
    assert caught.value.id == answered


def test_frames_say_their_version_and_a_notification_has_no_id():
    assert json.loads(jsonrpc.call("Alive")) == {"jsonrpc": "2.0", "method": "Alive"}
    assert json.loads(jsonrpc.result(3, {})) == {"jsonrpc": "2.0", "id": 3, "result": {}}
    assert json.loads(jsonrpc.error(3, -1, "no")) == {
        "jsonrpc": "2.0",
        "id": 3,
        "error": {"code": -1, "message": "no"},
    }


@pytest.mark.parametrize("frame", ["", "{", "nonsense", b"\xff\xfe", '{"jsonrpc": NaN}', "[" * 100_000])
def test_what_is_not_json_is_a_parse_error(frame):
    with pytest.raises(FrameError, match="the frame is not JSON") as caught:
        jsonrpc.decode(frame)
    assert caught.value.code == jsonrpc.PARSE_ERROR
    assert caught.value.id is None


@pytest.mark.parametrize(
    "frame",
    [
        "17",
        "null",
        '"Alive"',
        "{}",
        '{"method": "Alive"}',
        '{"jsonrpc": "1.0", "method": "Alive"}',
        '{"jsonrpc": 2.0, "method": "Alive"}',
    ],
)
def test_json_that_is_no_json_rpc_object_is_an_invalid_request(frame):
    with pytest.raises(FrameError, match='must hold "jsonrpc"') as caught:
        jsonrpc.decode(frame)
    assert caught.value.code == jsonrpc.INVALID_REQUEST


@pytest.mark.parametrize("frame", ["[]", '[{"jsonrpc": "2.0", "method": "Alive"}]'])
def test_a_batch_is_an_invalid_request(frame):
    with pytest.raises(
        FrameError, match="the frame is a batch; send each object in a frame of its own"
    ) as caught:
        jsonrpc.decode(frame)
    assert caught.value.code == jsonrpc.INVALID_REQUEST


@pytest.mark.parametrize("id", [True, False, 1.5, [1], {"a": 1}])
def test_an_id_is_a_whole_number_or_a_string(id):
    with pytest.raises(FrameError, match=r"id is .*; give a whole number or a string") as caught:
        jsonrpc.decode(json.dumps({"jsonrpc": "2.0", "method": "Alive", "id": id}))
    assert caught.value.code == jsonrpc.INVALID_REQUEST


@pytest.mark.parametrize("method", [None, 5, ["Alive"], {}])
def test_a_method_is_a_string_and_the_refusal_carries_the_id(method):
    with pytest.raises(FrameError, match=r"method is .*; give a string") as caught:
        jsonrpc.decode(json.dumps({"jsonrpc": "2.0", "method": method, "id": 9}))
    assert caught.value.id == 9


def test_a_frame_with_neither_method_result_nor_error_is_refused():
    with pytest.raises(FrameError, match="neither method, result nor error") as caught:
        jsonrpc.decode('{"jsonrpc": "2.0", "id": 4}')
    assert (caught.value.code, caught.value.id) == (jsonrpc.INVALID_REQUEST, 4)


@pytest.mark.parametrize("error", ["broken", None, {}, {"code": "x"}, {"message": None}])
def test_an_odd_error_reply_is_still_an_error(error):
    reply = jsonrpc.decode(json.dumps({"jsonrpc": "2.0", "id": 4, "error": error}))
    assert isinstance(reply, Reply)
    assert reply.error is not None
    assert reply.code is None
