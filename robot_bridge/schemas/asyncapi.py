"""The AsyncAPI 3 document of ``/robot`` and ``/desk``: which frame goes which way, and what answers it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..messages import ANSWERS, DESK_REQUESTS, PROTOCOL_VERSION, REQUESTS, OpAck
from .definitions import Schema, definitions, plain_text
from .tables import HEADS, NOTIFICATIONS, RESULTS

VERSION = "3.0.0"
_REFERENCE = "#/components/schemas/{name}"


def asyncapi() -> dict[str, Any]:
    """Return the document as JSON values."""
    answers = {op: cls for op, cls in ANSWERS.items() if op != "OpAck"}
    requests = {op: cls for op, cls in REQUESTS.items() if op != "OpAck"}
    return {
        "asyncapi": VERSION,
        "info": {
            "title": "Robot bridge of Fleet Supervisor",
            "version": str(PROTOCOL_VERSION),
            "description": "JSON-RPC 2.0 on WebSocket: robots connect to /robot, operators to /desk.",
        },
        "servers": _servers(),
        "defaultContentType": "application/json",
        "channels": {"robot": _robot_channel(requests, answers), "desk": _desk_channel()},
        "operations": _operations(requests, answers),
        "components": {"schemas": _schemas(), "securitySchemes": {"token": _TOKEN}},
    }


def _robot_channel(requests: Mapping[str, type], answers: Mapping[str, type]) -> Schema:
    messages = {**_calls(requests), **_calls(answers), "OpAck": _result(OpAck), "error": _error()}
    query = {"robot": "The robot's name; without one it is given one."}
    return _channel("/robot", "A robot's connection.", messages, query)


def _desk_channel() -> Schema:
    results = {f"{request.method}Result": cls for request, cls in RESULTS.items()}
    messages = {**_calls(DESK_REQUESTS), **_results(results), **_news(NOTIFICATIONS), **_heads()}
    messages["error"] = _error()
    return _channel("/desk", "An operator's connection.", messages, {})


def _schemas() -> dict[str, Schema]:
    tables = (REQUESTS, ANSWERS, DESK_REQUESTS, RESULTS, NOTIFICATIONS, HEADS)
    # Some are in two tables, and each is to be described once.
    classes = {cls: None for table in tables for cls in table.values()}
    return {**definitions(list(classes), _REFERENCE), "Id": _ID, "Error": _ERROR}


_TOKEN: Schema = {
    "type": "http",
    "scheme": "bearer",
    "description": "Authorization: Bearer TOKEN; not asked for where there are no accounts.",
}
_ID: Schema = {
    "description": "The id of the call, which its answer carries back.",
    "type": ["integer", "string"],
}
_ERROR: Schema = {
    "type": "object",
    "required": ["code", "message"],
    "properties": {
        "code": {"type": "integer", "description": "As JSON-RPC 2.0 says, or -32000 and below for refusals."},
        "message": {"type": "string", "description": "What was wrong, where, and what to do."},
    },
}


def _servers() -> Schema:
    security = [{"$ref": "#/components/securitySchemes/token"}]
    return {
        "loopback": {"host": "127.0.0.1:8765", "protocol": "ws", "security": security},
        "network": {
            "host": "{host}:8765",
            "protocol": "wss",
            "variables": {"host": {"description": "Where the gateway listens."}},
            "security": security,
        },
    }


def _channel(address: str, text: str, messages: Mapping[str, Schema], query: Mapping[str, str]) -> Schema:
    channel: Schema = {"address": address, "description": text, "messages": dict(messages)}
    if query:
        properties = {name: {"type": "string", "description": text} for name, text in query.items()}
        channel["bindings"] = {"ws": {"query": {"type": "object", "properties": properties}}}
    return channel


def _calls(table: Mapping[str, type]) -> dict[str, Schema]:
    return {name: _message(name, cls, _frame(name, cls, with_id=True)) for name, cls in table.items()}


def _news(table: Mapping[str, type]) -> dict[str, Schema]:
    return {name: _message(name, cls, _frame(name, cls, with_id=False)) for name, cls in table.items()}


def _heads() -> dict[str, Schema]:
    """Return the binary frames, of which the JSON head is described: a table of numbers follows it."""
    return {
        f"{method}InColumns": {
            **_message(f"{method}InColumns", cls, _frame(method, cls, with_id=False)),
            "contentType": "application/octet-stream",
        }
        for method, cls in HEADS.items()
    }


def _results(table: Mapping[str, type]) -> dict[str, Schema]:
    return {name: {**_result(cls), "name": name} for name, cls in table.items()}


def _message(name: str, cls: type, payload: Schema) -> Schema:
    return {"name": name, "title": name, "summary": plain_text(cls.__doc__ or ""), "payload": payload}


def _frame(method: str, cls: type, *, with_id: bool) -> Schema:
    return _object(
        {
            "method": {"type": "string", "const": method},
            "params": {"$ref": _REFERENCE.format(name=cls.__name__)},
            **({"id": {"$ref": _REFERENCE.format(name="Id")}} if with_id else {}),
        },
        required=["method"],
    )


def _result(cls: type) -> Schema:
    properties = {
        "id": {"$ref": _REFERENCE.format(name="Id")},
        "result": {"$ref": _REFERENCE.format(name=cls.__name__)},
    }
    return _message(cls.__name__, cls, _object(properties, required=["id", "result"]))


def _error() -> Schema:
    properties = {
        "id": {"type": ["integer", "string", "null"]},
        "error": {"$ref": "#/components/schemas/Error"},
    }
    return {
        "name": "error",
        "title": "error",
        "summary": "Why a call was not done.",
        "payload": _object(properties, required=["error"]),
    }


def _object(properties: Schema, *, required: list[str]) -> Schema:
    version = {"jsonrpc": {"type": "string", "const": "2.0"}}
    return {"type": "object", "required": ["jsonrpc", *required], "properties": {**version, **properties}}


def _operations(requests: Iterable[str], answers: Iterable[str]) -> Schema:
    """Return what the gateway takes in (``receive``) and sends, each with what answers it."""
    operations = {}
    for op in requests:
        operations[f"robot.{op}"] = _operation("receive", "robot", op, ["OpAck", "error"])
    for op in answers:
        operations[f"gateway.{op}"] = _operation("send", "robot", op, ["OpAck", "error"])
    for request in RESULTS:
        answered = [f"{request.method}Result", "error"]
        operations[f"desk.{request.method}"] = _operation("receive", "desk", request.method, answered)
    for name in NOTIFICATIONS:
        operations[f"news.{name}"] = _operation("send", "desk", name, [])
    for name in HEADS:
        frame = {"$ref": f"#/channels/desk/messages/{name}InColumns"}
        operations[f"news.{name}"]["messages"].append(frame)
    return operations


def _operation(action: str, channel: str, message: str, answered: list[str]) -> Schema:
    place = f"#/channels/{channel}"
    operation: Schema = {
        "action": action,
        "channel": {"$ref": place},
        "messages": [{"$ref": f"{place}/messages/{message}"}],
    }
    if answered:
        replies = [{"$ref": f"{place}/messages/{name}"} for name in answered]
        operation["reply"] = {"channel": {"$ref": place}, "messages": replies}
    return operation
