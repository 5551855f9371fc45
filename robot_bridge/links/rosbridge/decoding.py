"""Decoder of all data from a rosbridge server: size limits are checked before decoding.

A frame, JSON or CBOR, is one of the operations of the protocol; the fields of a ROS message become a type of
:mod:`.messages`, with the requested fields and nothing else.
"""

from __future__ import annotations

import re
from typing import Any, TypeVar

import msgspec
import numpy as np

from ...core.json_decoder import DecodingError, JsonBounds, decode_json
from ..ros.errors import FaultError

LARGEST_FRAME = 32 << 20
"""bytes beyond which the connection is closed."""
LARGEST_DECODED = 4 << 20
"""bytes: no requested message is as large."""
BOUNDS = JsonBounds(depth=32, length=LARGEST_DECODED, values=200_000)

_TOPIC_IN_FRAME = re.compile(rb"topic[^/]{1,6}(/[A-Za-z0-9_/]{1,254})")
_ARRAYS = {
    64: "u1", 65: ">u2", 66: ">u4", 67: ">u8", 68: "u1", 69: "<u2", 70: "<u4", 71: "<u8",
    72: "i1", 73: ">i2", 74: ">i4", 75: ">i8", 77: "<i2", 78: "<i4", 79: "<i8",
    81: ">f4", 82: ">f8", 85: "<f4", 86: "<f8",
}  # fmt: skip
"""numpy's types of the arrays of RFC 8746, by their CBOR tags."""
_MEANINGS = (
    0,
    1,
    2,
    3,
    4,
    5,
    25,
    28,
    29,
    30,
    35,
    36,
    37,
    52,
    54,
    100,
    256,
    258,
    260,
    261,
    1004,
    43000,
    55799,
)
"""CBOR tags that cbor2 decodes to objects; no rosbridge server sends any of them."""

T = TypeVar("T")


class Publication(msgspec.Struct, tag_field="op", tag="publish"):
    """A message of a topic."""

    topic: str
    msg: dict[str, Any]


class ServiceResponse(msgspec.Struct, tag_field="op", tag="service_response"):
    """A service's response; ``values`` is a text if ``result`` is false."""

    id: str = ""
    values: Any = None
    result: bool = True


class ServiceCall(msgspec.Struct, tag_field="op", tag="call_service"):
    """A call of a service served here."""

    service: str
    id: str = ""


class ActionFeedback(msgspec.Struct, tag_field="op", tag="action_feedback"):
    """The progress of a goal."""

    id: str = ""
    values: Any = None


class ActionResult(msgspec.Struct, tag_field="op", tag="action_result"):
    """The result of a goal; ``status`` is of action_msgs/GoalStatus, 0 for a refused one."""

    id: str = ""
    values: Any = None
    status: int = 0
    result: bool = True


class StatusText(msgspec.Struct, tag_field="op", tag="status"):
    """The server's message on a failed operation."""

    msg: str = ""
    level: str = ""
    id: str | None = None


Operation = Publication | ServiceCall | ServiceResponse | ActionFeedback | ActionResult | StatusText


def decode_frame(frame: str | bytes) -> Operation:
    """Return the operation in a frame: text is JSON, bytes are CBOR. Raises FaultError."""
    if len(frame) > LARGEST_DECODED:
        raise FaultError(f"{_named(frame)} has {len(frame)} bytes, and {LARGEST_DECODED} are the most")
    try:
        content = decode_json(frame, BOUNDS) if isinstance(frame, str) else _decode_cbor(frame)
        return msgspec.convert(content, Operation)  # type: ignore[no-any-return]
    except (DecodingError, msgspec.ValidationError) as error:
        raise FaultError(f"{_named(frame)} cannot be used: {error}") from None


def check_cbor() -> None:
    """Raise FaultError if CBOR cannot be decoded within bounds here."""
    try:
        _decode_cbor(b"\xa0")
    except (DecodingError, TypeError):
        raise FaultError(
            "CBOR needs cbor2 6.3 or newer; pip install 'fleet-supervisor-robot-bridge[rosbridge]', or set "
            "compression to none"
        ) from None


def convert(content: Any, kind: type[T], what: str) -> T:
    """Return the fields of a decoded ROS message as ``kind``; raises FaultError, naming ``what`` it is."""
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        raise FaultError(f"{what}: {error}") from None


def _named(frame: str | bytes) -> str:
    """Return a description of a frame without decoding it."""
    head = frame[:400]
    found = _TOPIC_IN_FRAME.search(head.encode("utf-8", "replace") if isinstance(head, str) else head)
    return f"a message of {found[1].decode()}" if found else "a message"


def _decode_cbor(data: bytes) -> Any:
    try:
        import cbor2
    except ModuleNotFoundError as error:
        raise DecodingError(f"it is CBOR, and {error.name} is not installed") from None
    try:
        return cbor2.loads(
            data,
            tag_hook=_array,
            semantic_decoders=dict.fromkeys(_MEANINGS, _refuse),
            max_depth=BOUNDS.depth,
            allow_indefinite=False,
            allow_duplicate_keys=False,
            strict_hashable_types=True,
        )
    except (cbor2.CBORError, ValueError, OverflowError, MemoryError, RecursionError) as error:
        raise DecodingError(f"it is no CBOR that is taken: {_root(error)}") from None


def _array(tag: Any, *_more: Any) -> list[float] | bytes:
    """Return the numbers of a typed array, those of bytes as they are; ``tag`` is cbor2's CBORTag."""
    kind = _ARRAYS.get(tag.tag)
    if kind is None or not isinstance(tag.value, bytes):
        raise ValueError(f"tag {tag.tag} is no array of numbers")
    if kind == "u1":
        return tag.value
    numbers: list[float] = np.frombuffer(tag.value, dtype=kind).tolist()
    return numbers


def _refuse(*_: Any) -> Any:
    raise ValueError("it holds a tag that is no array of numbers")


def _root(error: BaseException) -> str:
    """Return the text of an error's root cause: cbor2 wraps errors of its hooks."""
    while error.__cause__ is not None:
        error = error.__cause__
    return str(error)
