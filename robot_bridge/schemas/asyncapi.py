"""The AsyncAPI 3 document of all endpoints: which frame goes which way, and what answers it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..messages import ANSWERS, DESK_REQUESTS, PROTOCOL_VERSION, REQUESTS, OpAck
from .definitions import Schema, definitions
from .frames import calls, channel, error, in_columns, news, operation, result, results
from .links import link_channel, link_operations, link_schemas
from .tables import HEADS, NOTIFICATIONS, RESULTS

VERSION = "3.0.0"
_REFERENCE = "#/components/schemas/{name}"
_ACKNOWLEDGED = ("OpAck", "error")


def asyncapi() -> dict[str, Any]:
    """Return the document as JSON values."""
    answers = {op: cls for op, cls in ANSWERS.items() if op != "OpAck"}
    requests = {op: cls for op, cls in REQUESTS.items() if op != "OpAck"}
    return {
        "asyncapi": VERSION,
        "info": {
            "title": "Robot bridge of Fleet Supervisor",
            "version": str(PROTOCOL_VERSION),
            "description": (
                "JSON-RPC 2.0 on WebSocket: robots connect to /robot, operators to /desk, and adapters that "
                "speak for many robots to /link."
            ),
        },
        "servers": _servers(),
        "defaultContentType": "application/json",
        "channels": {
            "robot": _robot_channel(requests, answers),
            "desk": _desk_channel(),
            "link": link_channel(),
        },
        "operations": {
            **_robot_operations(requests, answers),
            **_desk_operations(),
            **link_operations(),
        },
        "components": {"schemas": _schemas(), "securitySchemes": {"token": _TOKEN}},
    }


def _robot_channel(requests: Mapping[str, type], answers: Mapping[str, type]) -> Schema:
    messages = {**calls(requests), **calls(answers), "OpAck": result(OpAck), "error": error()}
    query = {"robot": "The robot's name; without one it is given one."}
    return channel("/robot", "A robot's connection.", messages, query)


def _desk_channel() -> Schema:
    answered = {f"{request.method}Result": cls for request, cls in RESULTS.items()}
    messages = {**calls(DESK_REQUESTS), **results(answered), **news(NOTIFICATIONS), **in_columns(HEADS)}
    return channel("/desk", "An operator's connection.", {**messages, "error": error()})


def _schemas() -> dict[str, Schema]:
    tables = (REQUESTS, ANSWERS, DESK_REQUESTS, RESULTS, NOTIFICATIONS, HEADS)
    # Some are in two tables, and each is to be described once.
    classes = {cls: None for table in tables for cls in table.values()}
    asked = [cls for op, cls in REQUESTS.items() if op not in ANSWERS] + list(DESK_REQUESTS.values())
    own = definitions(list(classes), _REFERENCE, asked)
    return {**own, **link_schemas(_REFERENCE), "Id": _ID, "Error": _ERROR}


_TOKEN: Schema = {
    "type": "http",
    "scheme": "bearer",
    "description": (
        "Authorization: Bearer TOKEN, or from web pages Sec-WebSocket-Protocol: robot-bridge, token.TOKEN; "
        "not asked for where there are no accounts."
    ),
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
        "data": {
            "type": "object",
            "description": "What the refusal is about; on /link `robot`, the one robot that it concerns.",
        },
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


def _robot_operations(requests: Mapping[str, type], answers: Mapping[str, type]) -> Schema:
    """Return what the gateway receives of a robot and sends it, each with what answers it."""
    return {
        **{f"robot.{op}": operation("receive", "robot", [op], _ACKNOWLEDGED) for op in requests},
        **{f"gateway.{op}": operation("send", "robot", [op], _ACKNOWLEDGED) for op in answers},
    }


def _desk_operations() -> Schema:
    """Return what the gateway receives of operators, with its result, and what it tells them unasked."""
    asked = {
        f"desk.{method}": operation("receive", "desk", [method], (f"{method}Result", "error"))
        for method in (request.method for request in RESULTS)
    }
    told = {
        f"news.{name}": operation("send", "desk", [name, *([f"{name}InColumns"] if name in HEADS else [])])
        for name in NOTIFICATIONS
    }
    return {**asked, **told}
