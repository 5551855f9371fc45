"""From JSON to messages: decoding and checking for every wire that the gateway and the robot listen on."""

from __future__ import annotations

import base64
import binascii
from typing import Any, cast

import msgspec

from . import jsonrpc
from .errors import ForbiddenError, NotReadyError, StoreError
from .messages import ANSWERS, DESK_REQUESTS, REQUESTS, Answer, DeskRequest, MessageError, Request, SetMap


class UnknownOperationError(MessageError):
    """An operation code or method that is in no table."""


def decode_request(op: str, params: Any) -> Request:
    """Return the robot's request ``op`` with its parameters (a dict of JSON values, or None for none)."""
    return cast("Request", _convert(REQUESTS, "operation", op, params))


def decode_answer(op: str, params: Any, payload: bytes | None = None) -> Answer:
    """Return the server's answer ``op``; ``payload`` carries the map of a SetMap."""
    if op == "SetMap":
        if payload is None:
            raise MessageError("SetMap came without its payload; the robot map is missing")
        return SetMap(payload)
    return cast("Answer", _convert(ANSWERS, "operation", op, params))


def decode_desk_request(method: str, params: Any) -> DeskRequest:
    """Return the operator's request ``method`` with its parameters."""
    return cast("DeskRequest", _convert(DESK_REQUESTS, "method", method, params))


def _convert(table: dict[str, Any], kind: str, name: str, params: Any) -> Any:
    cls = table.get(name)
    if cls is None:
        raise UnknownOperationError(f"unknown {kind} {name!r}; known are {', '.join(table)}")
    if params is not None and not isinstance(params, dict):
        raise MessageError(f"{name}: params is {type(params).__name__}; give an object with named parameters")
    try:
        return msgspec.convert(params or {}, cls)
    except msgspec.ValidationError as error:
        raise MessageError(f"{name}: {error}") from None


def error_code(error: Exception) -> int:
    """Return the JSON-RPC code under which ``error`` is told to whoever asked."""
    codes = {
        UnknownOperationError: jsonrpc.METHOD_NOT_FOUND,
        MessageError: jsonrpc.INVALID_PARAMS,
        NotReadyError: jsonrpc.NOT_READY,
        ForbiddenError: jsonrpc.FORBIDDEN,
        StoreError: jsonrpc.INTERNAL_ERROR,
    }
    return next((code for kind, code in codes.items() if isinstance(error, kind)), jsonrpc.REFUSED)


def parse_params(op: str, text: str | bytes | None) -> Any:
    """Return the JSON value in a row's ``params`` column; an empty one means no parameters."""
    if not text:
        return None
    try:
        return msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise MessageError(f"{op}: params is not JSON ({error}): {str(text)[:80]!r}") from None


def encode_map(content: bytes) -> str:
    """Return a robot map as base64 text, as it travels inside JSON."""
    return base64.b64encode(content).decode("ascii")


def decode_map(text: Any) -> bytes:
    """Return the bytes of a robot map that travelled inside JSON."""
    try:
        return base64.b64decode(text, validate=True)
    except (TypeError, ValueError, binascii.Error):
        raise MessageError("SetMap: map is not base64 text") from None
