"""The pieces of an AsyncAPI document: channels, JSON-RPC frames as messages, and operations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .definitions import Schema, plain_text


def schema_at(name: str) -> Schema:
    """Return the reference to a schema of the document."""
    return {"$ref": f"#/components/schemas/{name}"}


def channel(
    address: str, text: str, messages: Mapping[str, Schema], query: Mapping[str, str] | None = None
) -> Schema:
    """Return an endpoint with its messages, and what may stand in the ``query`` of its URL."""
    described: Schema = {"address": address, "description": text, "messages": dict(messages)}
    if query:
        properties = {name: {"type": "string", "description": text} for name, text in query.items()}
        described["bindings"] = {"ws": {"query": {"type": "object", "properties": properties}}}
    return described


def calls(table: Mapping[str, type], suffix: str = "") -> dict[str, Schema]:
    """Return the calls of each method in ``table``; params are as the schema of class and ``suffix`` says."""
    return {name: message(name, cls, call(name, cls.__name__ + suffix)) for name, cls in table.items()}


def news(table: Mapping[str, type]) -> dict[str, Schema]:
    """Return the notifications of each method in ``table``."""
    return {name: message(name, cls, call(name, cls.__name__, with_id=False)) for name, cls in table.items()}


def in_columns(table: Mapping[str, type]) -> dict[str, Schema]:
    """Return the binary frames, of which the JSON head is described: a table of numbers follows it."""
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
    """Return a message, told of by the docstring of its class."""
    return {"name": name, "title": name, "summary": plain_text(cls.__doc__ or ""), "payload": payload}


def call(method: str, params: str, *, with_id: bool = True) -> Schema:
    """Return the schema of a frame that calls ``method`` with what the schema ``params`` describes."""
    properties: Schema = {"method": {"type": "string", "const": method}, "params": schema_at(params)}
    if with_id:
        properties["id"] = schema_at("Id")
    return _frame(properties, required=["method"])


def result(cls: type) -> Schema:
    """Return the message of a result."""
    properties = {"id": schema_at("Id"), "result": schema_at(cls.__name__)}
    return message(cls.__name__, cls, _frame(properties, required=["id", "result"]))


def error() -> Schema:
    """Return the message that refuses a call."""
    properties = {"id": {"type": ["integer", "string", "null"]}, "error": schema_at("Error")}
    return {
        "name": "error",
        "title": "error",
        "summary": "Why a call was not done.",
        "payload": _frame(properties, required=["error"]),
    }


def operation(action: str, channel: str, messages: Sequence[str], answers: Sequence[str] = ()) -> Schema:
    """Return what the gateway does with messages: ``send`` or ``receive``, and what answers them."""
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
