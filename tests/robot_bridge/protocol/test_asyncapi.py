"""The AsyncAPI document is accepted by the specification's own parser, and tells of every message."""

from __future__ import annotations

import json
import subprocess

import pytest

from robot_bridge.core.messages.base import DESK_REQUESTS
from robot_bridge.core.messages.robots import ANSWERS, REQUESTS
from robot_bridge.protocol.asyncapi import asyncapi, documents
from robot_bridge.protocol.schemas import NOTIFICATIONS

NO_PARSER = 3


@pytest.fixture(scope="module")
def parsed(root, tmp_path_factory):
    """Of each document whether it is accepted, and what is said of it: the parser takes seconds to load."""
    folder = tmp_path_factory.mktemp("asyncapi")
    documents = {"sound": each_schema_once(asyncapi())}
    documents |= {"no schema": with_a_schema_that_is_none(), "no message": with_a_message_missing()}
    for name, document in documents.items():
        (folder / name).write_text(json.dumps(document), encoding="utf-8")
    command = [root / "tools" / "asyncapi_parser.sh", *documents]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600)
    if done.returncode == NO_PARSER:
        pytest.skip(done.stderr.strip().splitlines()[-1])
    assert done.returncode in (0, 1), done.stderr
    said = {name: [] for name in documents}
    for line in done.stdout.splitlines():
        name, _, what = line.partition(": ")
        said[name] += [] if what.startswith("information:") else [what]
    return {name: ("refused" not in lines, lines) for name, lines in said.items()}


def references(value):
    """Yield what is referred to anywhere in a document."""
    if isinstance(value, dict):
        yield from [value["$ref"]] if "$ref" in value else []
    for inner in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from references(inner)


def without_references(value):
    """Return a schema in which anything may be where another schema is referred to."""
    if isinstance(value, dict):
        return {} if "$ref" in value else {key: without_references(inner) for key, inner in value.items()}
    return [without_references(inner) for inner in value] if isinstance(value, list) else value


def each_schema_once(document):
    """Return the document with its messages' payloads among the schemas, none of which has another inside.

    The parser unfolds what is referred to at every place, each channel with all its messages in each
    operation, which takes it three times as long.
    """
    schemas = document["components"]["schemas"]
    for name, channel in document["channels"].items():
        for of, message in channel["messages"].items():
            schemas[f"{name}.{of}"], message["payload"] = message["payload"], {}
    document["components"]["schemas"] = {name: without_references(one) for name, one in schemas.items()}
    return document


def of_ready_alone(document):
    """Return the document with one operation: with all of them the parser takes seconds."""
    for part, name in (("channels", "robot"), ("operations", "robot.Ready")):
        document[part] = {name: document[part][name]}
    return document


def with_a_schema_that_is_none():
    broken = of_ready_alone(each_schema_once(asyncapi()))
    broken["components"]["schemas"]["robot.Ready"]["properties"]["jsonrpc"] = {"type": "nonsense"}
    return broken


def with_a_message_missing():
    broken = of_ready_alone(asyncapi())
    del broken["channels"]["robot"]["messages"]["Ready"]
    return broken


def test_the_parser_accepts_it_without_a_warning(parsed):
    assert parsed["sound"] == (True, [])


def test_every_reference_leads_to_something():
    document = asyncapi()
    found = set(references(document))
    assert len(found) > 200
    for reference in found:
        at = document
        for step in reference.removeprefix("#/").split("/"):
            at = at[step]
        assert isinstance(at, dict)


def test_the_parser_refuses_it_where_a_schema_is_none(parsed):
    accepted, said = parsed["no schema"]
    assert not accepted
    assert any("robot.Ready/properties/jsonrpc" in line for line in said)


def test_the_parser_refuses_it_where_a_message_is_missing(parsed):
    accepted, said = parsed["no message"]
    assert not accepted
    assert any("/messages/Ready' does not exist" in line for line in said)


def test_it_has_an_operation_for_every_message_of_all_endpoints():
    assert set(asyncapi()["operations"]) == {
        *(f"robot.{op}" for op in REQUESTS if op != "OpAck"),
        *(f"gateway.{op}" for op in (*ANSWERS, "gateways") if op != "OpAck"),
        *(f"desk.{method}" for method in DESK_REQUESTS),
        *(f"news.{method}" for method in NOTIFICATIONS),
        *(f"link.robot.{op}" for op in REQUESTS if op != "OpAck"),
        *(f"link.gateway.{op}" for op in ANSWERS if op not in ("OpAck", "Start")),
        *(f"link.{name}" for name in ("hello", "status", "get_areas", "positions")),
        *(f"link.{name}" for name in ("Start", "gateways", "Released", "AbortOfAll", "playback")),
    }


def test_it_says_who_speaks():
    operations = asyncapi()["operations"]
    assert operations["robot.SendPos"]["action"] == "receive"
    assert operations["gateway.SetPosEnd"]["action"] == "send"
    assert operations["desk.send"]["reply"]["messages"][0]["$ref"].endswith("/messages/sendResult")
    assert "reply" not in operations["news.positions"]
    assert operations["link.robot.SendPos"]["action"] == "receive"
    assert operations["link.gateway.SetPosEnd"]["action"] == "send"


def test_it_is_among_the_documents():
    assert json.loads(documents()["asyncapi.json"]) == asyncapi()
