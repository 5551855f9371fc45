"""Codec between JSON and messages: decoding and checks for every wire of gateway and robot."""

from __future__ import annotations

import base64
import binascii
import dataclasses
import logging
from collections.abc import Sequence
from typing import Any, Literal, cast

import msgspec

from ..core.errors import (
    BusyError,
    ForbiddenError,
    NotReadyError,
    OutdatedError,
    OverridableError,
    StoreError,
)
from ..core.json_decoder import DecodingError, decode_json, has_few_brackets
from ..core.messages import robots
from ..core.messages.base import (
    DESK_REQUESTS,
    DeskRequest,
    MessageError,
    refuse_unknown_keys,
    to_json,
    unknown_keys,
)
from ..core.messages.commands import Send
from ..core.messages.robots import Abort, Answer, Command, Request, SendImage, SendPos
from ..core.messages.safety import understood_stop
from . import jsonrpc

log = logging.getLogger(__name__)


_BEGIN = ("hello", "subscribe")
_DESK_REQUESTS = {name: DESK_REQUESTS[name] for name in (*_BEGIN, *sorted(set(DESK_REQUESTS) - set(_BEGIN)))}
"""The first methods of a connection are listed first in the error on an unknown method."""


class UnknownOperationError(MessageError):
    """An operation code or method that is in no table."""


def decode_request(op: str, params: Any, payload: bytes | None = None) -> Request:
    """Return the robot's request ``op`` with its parameters (a dict of JSON values, or None for none).

    Its binary part comes as ``payload``, or as base64 text among the parameters.
    """
    return cast("Request", _convert(robots.REQUESTS, "operation", op, params, payload))


def decode_answer(op: str, params: Any, payload: bytes | None = None) -> Answer:
    """Return the server's answer ``op``; ``params`` and ``payload`` as in :func:`decode_request`.

    Unknown parameters are ignored: a newer gateway may send more.
    """
    return cast("Answer", _convert(robots.ANSWERS, "operation", op, params, payload, strict=False))


def decode_command(op: str, params: Any) -> Command:
    """Return an operator's command for a robot, ``op`` with its parameters."""
    return cast("Command", _convert(robots.COMMANDS, "operation", op, params))


def decode_desk_request(method: str, params: Any) -> DeskRequest[Any]:
    """Return the operator's request ``method`` with its parameters."""
    return cast("DeskRequest[Any]", _convert(_DESK_REQUESTS, "method", method, params))


def _convert(
    table: dict[str, Any],
    kind: str,
    name: str,
    params: Any,
    payload: bytes | None = None,
    *,
    strict: bool = True,
) -> Any:
    cls = table.get(name)
    if cls is None:
        raise UnknownOperationError(f"unknown {kind} {name!r}; known are {', '.join(table)}")
    if _stops(cls, params):
        understood = understood_stop(cls, params)
        if understood != (params or {}):
            log.warning("%s: what cannot be understood of it is passed over: to stop is never refused", name)
        params = understood
    if params is not None and not isinstance(params, dict):
        raise MessageError(f"{name}: params is {type(params).__name__}; give an object with named parameters")
    if name in robots.PAYLOADS:
        params = _with_payload(name, params or {}, payload)
    try:
        message = msgspec.convert(params or {}, cls)
    except msgspec.ValidationError as error:
        raise MessageError(f"{name}: {error}") from None
    if strict and params:
        _check_keys(name, message, params)
    return message


def _check_keys(name: str, message: Any, params: dict[str, Any]) -> None:
    """Refuse unknown parameters, except in requests that stop robots; raises MessageError."""
    cls = type(message)
    if _stops(cls, params):
        for key in unknown_keys(cls, params):
            log.warning("%s: %s is no parameter of it, and passed over: to stop is never refused", name, key)
        return
    try:
        refuse_unknown_keys(cls, params)
    except MessageError as error:
        raise MessageError(f"{name}: {error}") from None


def _stops(cls: type, params: Any) -> bool:
    """Return whether a request stops or holds robots; of ``send`` only one that sends an Abort."""
    is_abort = cls is Send and isinstance(params, dict) and params.get("op") == Abort.__name__
    return is_abort or getattr(cls, "stops", False)


def _with_payload(op: str, params: dict[str, Any], payload: bytes | None) -> dict[str, Any]:
    name = robots.PAYLOADS[op]
    if payload is not None:
        return {**params, name: payload}
    if name not in params:
        raise MessageError(f"{op} came without its payload; its {name} is missing")
    try:
        return {**params, name: base64.b64decode(params[name], validate=True)}
    except (TypeError, ValueError, binascii.Error):
        raise MessageError(f"{op}: {name} is not base64 text") from None


class _Position(msgspec.Struct, forbid_unknown_fields=True):
    """A notification of SendPos, by far the most frequent frame of a robot."""

    jsonrpc: Literal["2.0"]
    method: Literal["SendPos"]
    params: SendPos


_POSITIONS = msgspec.json.Decoder(_Position)
# A dataclass ignores unknown keys, a struct refuses them.
_KEYS = msgspec.json.Decoder(
    msgspec.defstruct(
        "_PositionKeys",
        [
            ("jsonrpc", Any),
            ("method", Any),
            (
                "params",
                msgspec.defstruct(
                    "_Keys",
                    [(field.name, Any, None) for field in dataclasses.fields(SendPos)],
                    forbid_unknown_fields=True,
                ),
            ),
        ],
    )
)


def decode_position(frame: str | bytes) -> SendPos | None:
    """Return the pose in a notification of SendPos; None for any other or invalid frame.

    In one step, and so several times faster than :func:`.jsonrpc.decode` and :func:`decode_request`, which
    report errors. Nested values, which no position has, are left to them.
    """
    if not has_few_brackets(frame):
        return None
    try:
        pose = _POSITIONS.decode(frame).params
        _KEYS.decode(frame)
        return pose
    except (msgspec.DecodeError, UnicodeDecodeError):
        return None


class _Head(msgspec.Struct):
    """The keys that identify the message of a frame; the rest is not decoded."""

    id: int | str | None = None
    method: str | None = None


_HEADS = msgspec.json.Decoder(_Head)


def check_size(frame: str | bytes, largest: int, exempt: Sequence[str] = (SendImage.__name__,)) -> None:
    """Raise FrameError for a frame of more than ``largest`` bytes, unless its method is ``exempt``.

    The method is found without decoding the content.
    """
    if len(frame) <= largest:
        return
    try:
        # Nested values are not searched, not even for a name.
        head = _HEADS.decode(frame) if has_few_brackets(frame) else _Head()
    except (msgspec.DecodeError, UnicodeDecodeError):
        head = _Head()
    if head.method in exempt:
        return
    what = f"{head.method:.40}" if head.method else "the frame"
    text = f"{what} has {len(frame)} bytes; at most {largest} are taken, but for {', '.join(exempt)}"
    raise jsonrpc.FrameError(jsonrpc.INVALID_REQUEST, text, head.id)


def error_code(error: Exception) -> int:
    """Return the JSON-RPC code for ``error`` in the reply."""
    codes = {
        UnknownOperationError: jsonrpc.METHOD_NOT_FOUND,
        MessageError: jsonrpc.INVALID_PARAMS,
        NotReadyError: jsonrpc.NOT_READY,
        ForbiddenError: jsonrpc.FORBIDDEN,
        OutdatedError: jsonrpc.OUTDATED,
        OverridableError: jsonrpc.OVERRIDABLE,
        BusyError: jsonrpc.TOO_MANY,
        StoreError: jsonrpc.INTERNAL_ERROR,
    }
    return next((code for kind, code in codes.items() if isinstance(error, kind)), jsonrpc.REFUSED)


def parse_params(op: str, text: str | bytes | None) -> Any:
    """Return the JSON value in a row's ``params`` column; an empty one means no parameters."""
    if not text:
        return None
    try:
        return decode_json(text)
    except DecodingError as error:
        raise MessageError(f"{op}: params is not JSON ({error}): {str(text)[:80]!r}") from None


def payload_of(message: Request | Answer) -> bytes | None:
    """Return the binary part of ``message``: the payload of its row."""
    name = robots.PAYLOADS.get(type(message).__name__)
    return None if name is None else cast("bytes", getattr(message, name))


def with_base64(op: str, params: dict[str, Any], payload: bytes | None) -> dict[str, Any]:
    """Return the parameters of a message with its payload among them, as it travels inside JSON."""
    if payload is None or op not in robots.PAYLOADS:
        return params
    return {**params, robots.PAYLOADS[op]: base64.b64encode(payload).decode("ascii")}


def params_of(message: Request | Answer) -> dict[str, Any]:
    """Return all of a message as JSON values."""
    return with_base64(type(message).__name__, to_json(message), payload_of(message))
