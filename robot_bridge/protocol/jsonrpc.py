"""JSON-RPC 2.0 frames, as text in and text out; no socket."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import msgspec

from ..core.json_decoder import DecodingError, decode_json

PARSE_ERROR = -32700
INVALID_REQUEST = -32600
METHOD_NOT_FOUND = -32601
INVALID_PARAMS = -32602
INTERNAL_ERROR = -32603
REFUSED = -32000
NOT_READY = -32001
FORBIDDEN = -32003
TOO_MANY = -32005
OUTDATED = -32006
OVERRIDABLE = -32007


class FrameError(ValueError):
    """A frame that is not JSON-RPC 2.0; ``code`` and ``id`` are those of the error to send back."""

    def __init__(self, code: int, text: str, id: int | str | None = None) -> None:
        super().__init__(text)
        self.code = code
        self.id = id


@dataclass(frozen=True)
class Call:
    """A request, or a notification where ``id`` is None.

    ``deadline`` is unchecked: if it is a number, it is the time by which the request must be begun.
    """

    method: str
    params: Any
    id: int | str | None = None
    deadline: Any = None


@dataclass(frozen=True)
class Reply:
    """The answer to a call: ``error`` is None, or the text for ``code``."""

    id: int | str | None
    result: Any = None
    error: str | None = None
    code: int | None = None


def decode(frame: str | bytes) -> Call | Reply:
    """Return the call or reply in one WebSocket frame; raises FrameError."""
    try:
        value = decode_json(frame)
    except DecodingError as error:
        raise FrameError(PARSE_ERROR, f"the frame is not JSON: {error}") from None
    if isinstance(value, list):
        raise FrameError(INVALID_REQUEST, "the frame is a batch; send each object in a frame of its own")
    if not isinstance(value, dict) or value.get("jsonrpc") != "2.0":
        raise FrameError(
            INVALID_REQUEST, 'the frame is not a JSON-RPC 2.0 object; it must hold "jsonrpc": "2.0"'
        )
    id = value.get("id")
    if not (id is None or (isinstance(id, (int, str)) and not isinstance(id, bool))):
        raise FrameError(INVALID_REQUEST, f"id is {id!r}; give a whole number or a string")
    if "method" in value:
        if not isinstance(value["method"], str):
            raise FrameError(INVALID_REQUEST, f"method is {value['method']!r}; give a string", id)
        return Call(value["method"], value.get("params"), id, value.get("deadline"))
    return _reply(value, id)


def _reply(value: dict[str, Any], id: int | str | None) -> Reply:
    if "error" in value:
        error = value["error"] if isinstance(value["error"], dict) else {}
        code = error.get("code")
        text = str(error.get("message", "no reason given"))
        return Reply(id, None, text, code if type(code) is int else None)
    if "result" in value:
        return Reply(id, value["result"])
    raise FrameError(INVALID_REQUEST, "the frame has neither method, result nor error", id)


def call(method: str, params: Any = None, id: int | str | None = None) -> str:
    """Return the frame of a request, or of a notification where ``id`` is None."""
    frame: dict[str, Any] = {"jsonrpc": "2.0", "method": method}
    if id is not None:
        frame["id"] = id
    if params:
        frame["params"] = params
    return _encode(frame)


def result(id: int | str | None, value: Any) -> str:
    """Return the frame that answers call ``id``."""
    return _encode({"jsonrpc": "2.0", "id": id, "result": value})


def error(id: int | str | None, code: int, text: str, data: Any = None) -> str:
    """Return the error frame that answers call ``id``, with ``data`` for its caller."""
    more = {} if data is None else {"data": data}
    return _encode({"jsonrpc": "2.0", "id": id, "error": {"code": code, "message": text, **more}})


def _encode(frame: dict[str, Any]) -> str:
    return msgspec.json.encode(frame).decode()
