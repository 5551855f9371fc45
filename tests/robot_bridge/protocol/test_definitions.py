"""The schemas say what the messages' own checks say, and nothing is left out of them."""

from __future__ import annotations

import json

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robot_bridge.core.messages.base import DESK_REQUESTS, MessageError
from robot_bridge.core.messages.robots import (
    ANSWERS,
    PAYLOADS,
    REQUESTS,
    SendGPS,
    SetObject,
    SetPath,
    SetPosEnd,
)
from robot_bridge.protocol.asyncapi import documents, link_documents, served
from robot_bridge.protocol.codec import decode_request
from robot_bridge.protocol.schemas import HEADS, NOTIFICATIONS, plain_text, schema_of

OTHERS = {"asyncapi.json", "index.json", "openapi.json"}
"""Documents that are no schemas of messages."""


def accepts(schema, value) -> bool:
    return jsonschema.Draft202012Validator(schema).is_valid(value)


def test_every_document_is_a_json_schema_that_describes_itself():
    # No case for each: whoever only lists the tests would make them all.
    for path in set(documents()) - OTHERS:
        schema = json.loads(documents()[path])
        jsonschema.Draft202012Validator.check_schema(schema)
        assert schema["type"] == "object", path
        assert schema["description"], path
        assert "``" not in documents()[path], path
        assert ":class:" not in documents()[path], path


def test_there_is_one_for_every_message():
    paths = set(documents()) - OTHERS
    assert paths == {
        *(f"robot/{op}.json" for op in REQUESTS),
        *(f"gateway/{op}.json" for op in (*ANSWERS, "gateways")),
        *(f"desk/{method}.json" for method in DESK_REQUESTS),
        *(f"result/{method}.json" for method in DESK_REQUESTS),
        *(f"news/{method}.json" for method in NOTIFICATIONS),
        *(f"head/{method}.json" for method in HEADS),
        *link_documents(),
    }
    assert json.loads(documents()["index.json"])["documents"] == sorted(
        {*paths, "asyncapi.json", "openapi.json"}
    )


def test_what_is_served_is_found_by_its_path():
    assert served("/schemas/") == served("/schemas") == documents()["index.json"]
    assert served("/schemas/robot/SendPos.json") == documents()["robot/SendPos.json"]
    for path in ("/schemas/robot", "/schemas/../README.md", "/schemasrobot/SendPos.json", "/robot"):
        assert served(path) is None


def test_ranges_and_texts_are_in_the_schema():
    schema = schema_of(SendGPS)
    assert accepts(schema, {"lat": 90, "lon": -180, "heading": None})
    assert not accepts(schema, {"lat": 90.1, "lon": 0})
    assert not accepts(schema, {"lat": 0, "lon": 0, "heading": 361})
    assert not accepts(schema, {"lat": 0})
    schema = schema_of(SetObject)
    assert not accepts(schema, {"x": 1, "y": 1, "object": ""})
    assert not accepts(schema, {"x": 1, "y": 1, "object": "a", "label": 129 * "a"})
    assert accepts(schema, {"x": 1, "y": 1, "object": "a", "of_a_newer_robot": 1})


def test_a_path_is_pairs_of_numbers():
    schema = schema_of(SetPath)
    assert accepts(schema, {"points": [[1, 2], [3.5, 4]]})
    assert not accepts(schema, {"points": [[1, 2, 3], [3, 4]]})
    assert not accepts(schema, {"points": "here"})


def test_a_target_of_a_wrong_type_is_not_accepted():
    assert not accepts(schema_of(SetPosEnd), {"x": "1", "y": 2})


def test_what_is_binary_may_be_in_the_payload_instead():
    for op in PAYLOADS:
        schema = json.loads(documents()[f"{'gateway' if op in ANSWERS else 'robot'}/{op}.json"])
        assert PAYLOADS[op] not in schema.get("required", [])
        assert schema["properties"][PAYLOADS[op]]["contentEncoding"] == "base64"


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-10, 500) | st.floats(-1e3, 1e3) | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=2),
    max_leaves=3,
)


@settings(max_examples=2 * settings.default.max_examples, suppress_health_check=[HealthCheck.too_slow])
@given(st.data(), st.sampled_from(sorted(set(REQUESTS) - set(PAYLOADS))))
def test_what_the_schema_refuses_the_gateway_refuses(data, op):
    schema = json.loads(documents()[f"robot/{op}.json"])
    names = st.sampled_from([*schema.get("properties", {}), "other"])
    params = data.draw(st.dictionaries(names, JSON, max_size=6))
    if not accepts(schema, params):
        with pytest.raises(MessageError):
            decode_request(op, params)


def test_docstrings_become_text_for_people():
    text = plain_text("One ``a`` of :class:`~.Ready`,\n    and more.\n\n    Next.")
    assert text == "One `a` of `Ready`, and more.\n\nNext."
