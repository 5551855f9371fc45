"""AsyncAPI 3 document of all WebSocket endpoints, and the schema files that the gateway serves."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from ..core.messages import links
from ..core.messages.administration import PROTOCOL_VERSION, Gateways
from ..core.messages.base import DESK_REQUESTS, ROBOT_NAME, Done
from ..core.messages.links import Playback, PlaybackReport
from ..core.messages.robots import ANSWERS, REQUESTS, OpAck, SendGPS, SendPos, Start
from .schemas import HEADS, JSON_SCHEMA, NOTIFICATIONS, Schema, definitions, openapi, plain_text, schema_of

# --- Parts of an AsyncAPI document: channels, JSON-RPC frames as messages, and operations ---


def schema_at(name: str) -> Schema:
    """Return the reference to a schema of the document."""
    return {"$ref": f"#/components/schemas/{name}"}


def channel(
    address: str, text: str, messages: Mapping[str, Schema], query: Mapping[str, str] | None = None
) -> Schema:
    """Return an endpoint with its messages, and the schema of the ``query`` of its URL."""
    described: Schema = {"address": address, "description": text, "messages": dict(messages)}
    if query:
        properties = {name: {"type": "string", "description": text} for name, text in query.items()}
        described["bindings"] = {"ws": {"query": {"type": "object", "properties": properties}}}
    return described


def calls(table: Mapping[str, type], suffix: str = "", more: Schema | None = None) -> dict[str, Schema]:
    """Return the calls of each method in ``table``; class and ``suffix`` name the schema of the params.

    ``more`` are additional properties of their frames.
    """
    described = {name: call(name, cls.__name__ + suffix, more) for name, cls in table.items()}
    return {name: message(name, cls, described[name]) for name, cls in table.items()}


def news(table: Mapping[str, type]) -> dict[str, Schema]:
    """Return the notifications of each method in ``table``."""
    return {name: message(name, cls, call(name, cls.__name__, with_id=False)) for name, cls in table.items()}


def in_columns(table: Mapping[str, type]) -> dict[str, Schema]:
    """Return the binary frames, described by their JSON heads: a table of numbers follows each."""
    return {
        f"{method}InColumns": {
            **message(f"{method}InColumns", cls, call(method, cls.__name__, with_id=False)),
            "contentType": "application/octet-stream",
        }
        for method, cls in table.items()
    }


def results(table: Mapping[str, type]) -> dict[str, Schema]:
    """Return the results under the names in ``table``."""
    return {name: {**result(cls), "name": name} for name, cls in table.items()}


def message(name: str, cls: type, payload: Schema) -> Schema:
    """Return a message, described by the docstring of its class."""
    return {"name": name, "title": name, "summary": plain_text(cls.__doc__ or ""), "payload": payload}


def call(method: str, params: str, more: Schema | None = None, *, with_id: bool = True) -> Schema:
    """Return the schema of a frame that calls ``method``; ``params`` names the schema of its params."""
    properties: Schema = {"method": {"type": "string", "const": method}, "params": schema_at(params)}
    properties.update(more or {})
    if with_id:
        properties["id"] = schema_at("Id")
    return _frame(properties, required=["method"])


def result(cls: type) -> Schema:
    """Return the message of a result."""
    properties = {"id": schema_at("Id"), "result": schema_at(cls.__name__)}
    return message(cls.__name__, cls, _frame(properties, required=["id", "result"]))


def error() -> Schema:
    """Return the message of an error."""
    properties = {"id": {"type": ["integer", "string", "null"]}, "error": schema_at("Error")}
    return {
        "name": "error",
        "title": "error",
        "summary": "Why a call was not done.",
        "payload": _frame(properties, required=["error"]),
    }


def operation(action: str, channel: str, messages: Sequence[str], answers: Sequence[str] = ()) -> Schema:
    """Return an operation of the gateway: ``send`` or ``receive`` messages, and their answers."""
    place = f"#/channels/{channel}"
    described: Schema = {
        "action": action,
        "channel": {"$ref": place},
        "messages": [{"$ref": f"{place}/messages/{name}"} for name in messages],
    }
    if answers:
        replies = [{"$ref": f"{place}/messages/{name}"} for name in answers]
        described["reply"] = {"channel": {"$ref": place}, "messages": replies}
    return described


def _frame(properties: Schema, *, required: list[str]) -> Schema:
    version = {"jsonrpc": {"type": "string", "const": "2.0"}}
    return {"type": "object", "required": ["jsonrpc", *required], "properties": {**version, **properties}}


# --- Messages on ``/link``: those of robots, with ``robot`` among the params, and a link's own

CALLS: dict[str, type] = {cls.method: cls for cls in (links.LinkHello, links.LinkStatus, links.GetAreas)}
"""Calls of a link for itself, by method."""
ROBOT_CALLS: dict[str, type] = {op: cls for op, cls in REQUESTS.items() if op != "OpAck"}
"""Calls of a link for one of its robots, by method."""
ROBOT_ANSWERS: dict[str, type] = {op: cls for op, cls in ANSWERS.items() if op not in ("OpAck", "Start")}
"""Calls to a robot of a link, by method."""
OF_ROBOT = "OfRobot"
"""Suffix of the names of schemas with ``robot``."""
_RESULTS: dict[str, type] = {
    "helloResult": links.LinkWelcome,
    "statusResult": Done,
    "get_areasResult": links.SiteAreas,
}
_GATEWAYS: dict[str, type] = {Gateways.method: Gateways}
"""Sent to links and robots where several gateways serve the fleet."""
_STOP = "AbortOfAll"
_PLAYBACK_RESULT = f"{Playback.method}Result"
_ROBOT: Schema = {
    "type": "string",
    "pattern": f"^{ROBOT_NAME.pattern}$",
    "description": "The robot that this is about.",
}


def link_documents() -> dict[str, Schema]:
    """Return the JSON Schemas by path: ``link`` holds messages of links, ``link-gateway`` those to links."""
    received_documents = {
        f"link/{op}.json": _with_robot(schema_of(cls, closed=True)) for op, cls in ROBOT_CALLS.items()
    }
    received_documents |= {
        f"link/{method}.json": schema_of(cls, closed=True) for method, cls in CALLS.items()
    }
    positions = [_with_robot(schema_of(cls, closed=True)) for cls in (SendPos, SendGPS)]
    received_documents["link/positions.json"] = _with_entries(schema_of(links.LinkPositions), positions)
    received_documents["head/link-positions.json"] = schema_of(links.LinkColumns)
    sent_documents = {
        f"link-gateway/{op}.json": _with_robot(schema_of(cls)) for op, cls in ROBOT_ANSWERS.items()
    }
    sent_documents |= {
        f"link-gateway/{cls.__name__}.json": schema_of(cls)
        for cls in (Start, links.Released, links.AbortOfAll)
    }
    sent_documents |= {f"link-gateway/{cls.method}.json": schema_of(cls) for cls in (Playback, Gateways)}
    received_documents[f"link/{_PLAYBACK_RESULT}.json"] = schema_of(PlaybackReport)
    sent_documents |= {f"link-gateway/{name}.json": schema_of(cls) for name, cls in _RESULTS.items()}
    return {**received_documents, **sent_documents}


def link_schemas(template: str) -> dict[str, Schema]:
    """Return the schemas of the AsyncAPI document; ``template`` is how they refer to each other."""
    own: list[type] = [
        *CALLS.values(),
        links.LinkPositions,
        links.LinkColumns,
        *_RESULTS.values(),
        links.Released,
        links.AbortOfAll,
    ]
    own += [Playback, PlaybackReport]
    robots: list[type] = [*ROBOT_CALLS.values(), *ROBOT_ANSWERS.values()]
    found = definitions(robots, template, list(ROBOT_CALLS.values()))
    with_robot = {f"{cls.__name__}{OF_ROBOT}": _with_robot(found[cls.__name__]) for cls in robots}
    schemas = {**definitions(own, template, list(CALLS.values())), **with_robot}
    entries = [{"$ref": template.format(name=f"{cls.__name__}{OF_ROBOT}")} for cls in (SendPos, SendGPS)]
    schemas["LinkPositions"] = _with_entries(schemas["LinkPositions"], entries)
    return schemas


def link_channel() -> Schema:
    """Return the endpoint with its messages."""
    positions = {links.LinkPositions.method: links.LinkPositions}
    extra = {"Start": Start, "Released": links.Released, **_GATEWAYS}
    messages = {
        **calls(CALLS),
        **calls(ROBOT_CALLS, OF_ROBOT),
        **calls(ROBOT_ANSWERS, OF_ROBOT),
        **results(_RESULTS),
        **news({**positions, **extra}),
        **in_columns({links.LinkPositions.method: links.LinkColumns}),
        **calls({Playback.method: Playback}),
        **results({_PLAYBACK_RESULT: PlaybackReport}),
        _STOP: message(_STOP, links.AbortOfAll, call(links.AbortOfAll.method, _STOP, with_id=False)),
        "OpAck": result(OpAck),
        "error": error(),
    }
    query = {"link": "The link's name, where it has no token."}
    return channel("/link", "A connection that speaks for many robots.", messages, query)


def link_operations() -> Schema:
    """Return the operations of the gateway towards links, each with its answers."""
    acknowledged = ("OpAck", "error")
    positions = [links.LinkPositions.method, f"{links.LinkPositions.method}InColumns"]
    return {
        **{
            f"link.{name}": operation("receive", "link", [name], (f"{name}Result", "error")) for name in CALLS
        },
        **{f"link.robot.{op}": operation("receive", "link", [op], acknowledged) for op in ROBOT_CALLS},
        **{f"link.gateway.{op}": operation("send", "link", [op], acknowledged) for op in ROBOT_ANSWERS},
        "link.positions": operation("receive", "link", positions),
        "link.Start": operation("send", "link", ["Start"]),
        "link.Released": operation("send", "link", ["Released"]),
        f"link.{Playback.method}": operation("send", "link", [Playback.method], (_PLAYBACK_RESULT, "error")),
        f"link.{Gateways.method}": operation("send", "link", [Gateways.method]),
        f"link.{_STOP}": operation("send", "link", [_STOP], acknowledged),
    }


def _with_robot(schema: Mapping[str, Any]) -> Schema:
    """Return the schema of a robot's message on a connection that many robots share."""
    properties = {"robot": _ROBOT, **schema.get("properties", {})}
    return {**schema, "properties": properties, "required": ["robot", *schema.get("required", [])]}


def _with_entries(schema: Schema, entries: list[Schema]) -> Schema:
    """Return the schema of LinkPositions with the schemas of its entries."""
    inner = [{name: value for name, value in entry.items() if name != JSON_SCHEMA} for entry in entries]
    return {**schema, "properties": {"positions": {"type": "array", "items": {"anyOf": inner}}}}


# --- The AsyncAPI 3 document of all endpoints: direction and answers of each frame ---

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
    messages = {
        **calls(requests),
        **calls(answers),
        "OpAck": result(OpAck),
        "error": error(),
        **news(_GATEWAYS),
    }
    query = {"robot": "The robot's name; without one it is given one."}
    return channel("/robot", "A robot's connection.", messages, query)


def _desk_channel() -> Schema:
    answered = {f"{method}Result": cls.result for method, cls in DESK_REQUESTS.items()}
    asked = {**calls(DESK_REQUESTS, more=_DEADLINE), **results(answered)}
    messages = {**asked, **news(NOTIFICATIONS), **in_columns(HEADS), "error": error()}
    return channel("/desk", "An operator's connection.", messages)


def _schemas() -> dict[str, Schema]:
    results_of = {method: cls.result for method, cls in DESK_REQUESTS.items()}
    tables = (REQUESTS, ANSWERS, DESK_REQUESTS, results_of, NOTIFICATIONS, HEADS)
    # Some are in two tables, but each must be described once.
    classes = {cls: None for table in tables for cls in table.values()}
    requests = [cls for op, cls in REQUESTS.items() if op not in ANSWERS] + list(DESK_REQUESTS.values())
    own = definitions(list(classes), _REFERENCE, requests)
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
_DEADLINE: Schema = {
    "deadline": {
        "description": (
            "The time, by hello's `now`, after which the call is refused instead of carried out; one that "
            "stops or holds robots is carried out at any time."
        ),
        "type": "number",
    }
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
    """Return the operations of the gateway towards a robot, each with its answers."""
    return {
        **{f"robot.{op}": operation("receive", "robot", [op], _ACKNOWLEDGED) for op in requests},
        **{f"gateway.{op}": operation("send", "robot", [op], _ACKNOWLEDGED) for op in answers},
        f"gateway.{Gateways.method}": operation("send", "robot", [Gateways.method]),
    }


def _desk_operations() -> Schema:
    """Return the operations of the gateway towards operators: requests with results, and notifications."""
    requests = {
        f"desk.{method}": operation("receive", "desk", [method], (f"{method}Result", "error"))
        for method in DESK_REQUESTS
    }
    notifications = {
        f"news.{name}": operation("send", "desk", [name, *([f"{name}InColumns"] if name in HEADS else [])])
        for name in NOTIFICATIONS
    }
    return {**requests, **notifications}


# --- Every schema as a file: written by ``robot-bridge schemas``, served under ``/schemas/``


@cache
def documents() -> dict[str, str]:
    """Return the text of each JSON document by its path, such as ``robot/SendPos.json``.

    ``robot`` holds messages of robots, ``gateway`` those to robots, ``link`` messages of links,
    ``link-gateway`` those to links, ``desk`` requests of operators, ``result`` the results, ``news``
    notifications to operators, and ``head`` the heads of binary frames; ``index.json`` lists them.
    ``asyncapi.json`` describes the WebSockets, ``openapi.json`` the queries over HTTP.
    """
    files = {f"robot/{op}.json": schema_of(cls, closed=True) for op, cls in REQUESTS.items()}
    files |= {f"gateway/{op}.json": schema_of(cls) for op, cls in ANSWERS.items()}
    files[f"gateway/{Gateways.method}.json"] = schema_of(Gateways)
    files |= {f"desk/{method}.json": schema_of(cls, closed=True) for method, cls in DESK_REQUESTS.items()}
    files |= {f"result/{method}.json": schema_of(cls.result) for method, cls in DESK_REQUESTS.items()}
    files |= {f"news/{method}.json": schema_of(cls) for method, cls in NOTIFICATIONS.items()}
    files |= {f"head/{method}.json": schema_of(cls) for method, cls in HEADS.items()}
    files |= link_documents()
    files["asyncapi.json"] = asyncapi()
    files["openapi.json"] = openapi()
    files["index.json"] = {"documents": sorted(files)}
    return {path: json.dumps(content, indent=2) + "\n" for path, content in files.items()}


def served(path: str) -> str | None:
    """Return the document at ``path`` of a URL, such as ``/schemas/asyncapi.json``; the index at its root."""
    if path in ("/schemas", "/schemas/"):
        return documents()["index.json"]
    return documents().get(path.removeprefix("/schemas/")) if path.startswith("/schemas/") else None
