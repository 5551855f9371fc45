"""Base of all messages: bounds and checks of their values, and the declarations of operators' requests.

A request is one class, a dataclass and :class:`DeskRequest`, with its fields and their checks in the
module of its subject. Decoder, scheduler, permission check, JSON Schemas and AsyncAPI read what it declares.
"""

from __future__ import annotations

import dataclasses
import functools
import ipaddress
import math
import re
import types
import typing
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import islice
from types import GenericAlias
from typing import Any, ClassVar, Generic, TypeVar, get_args
from urllib.parse import urlsplit

# --- Size limits and ranges of robots' messages, in one place ---
# The guide for integrators and the JSON Schemas say the same. Limits that a site may set are in the table
# ``[limits]`` of its ``site.toml`` (:mod:`..sites.settings_tables`).

LARGEST_MESSAGE = 65_536
"""bytes of a message on WebSocket, characters of ``params`` on SQL; an image may be larger."""
LONGEST_STATUS = 256
"""characters of a status; a longer one is cut, so that its robot is not lost because of it."""
LONGEST_REFUSAL = 500
"""characters of the reason in a robot's OpAck; a longer one is cut."""
LONGEST_OPERATOR = 128
"""characters of an operator's name."""
LONGEST_LABEL = 128
"""characters; of an object's id, its label and a robot's own number for an observation."""
COORDINATE = (-1e8, 1e8)
"""metres in the site frame, whose origin may be that of a CRS with its zone before the easting."""
SPEED = (-100.0, 100.0)
"""m/s; backwards is below 0."""
THETA = (-1e6, 1e6)
"""radians; converted to the same direction in [-π, π]."""
ALTITUDE = (-12_000.0, 100_000.0)
"""metres."""
CLOCK = (-1e12, 1e12)
"""seconds of a robot's own clock, whatever its epoch."""
ACCURACY = (0.0, 1e6)
"""metres."""
AREA = (0.0, 1e14)
"""square metres of a map."""
CUT = "…"
"""The end of a text that was cut."""
LONGEST_ADDRESS = 256
"""characters of the address of a gateway."""
MOST_GATEWAYS = 16
"""gateways whose addresses are sent to a robot."""


def one_line(text: str, longest: int) -> str:
    """Return ``text`` as one line of at most ``longest`` characters, cut with a mark if it is longer.

    Unprintable characters become spaces.
    """
    line = text if len(text) <= longest else text[: longest - len(CUT)] + CUT
    return line if line.isprintable() else "".join(c if c.isprintable() else " " for c in line)


def direction(theta: float) -> float:
    """Return ``theta``, radians, as the same direction in [-π, π]."""
    return theta if -math.pi <= theta <= math.pi else math.remainder(theta, math.tau)


# --- Checks of values, common to all messages ---

Ranges = Mapping[str, tuple[float, float]]
"""The smallest and the largest value of numbers, by the name of the parameter."""
Texts = Mapping[str, int]
"""The most characters of texts, by the name of the parameter."""

GATEWAY_ADDRESS = re.compile(r"wss?://[A-Za-z0-9_.~\[\]:-]+(/[A-Za-z0-9_.~/-]*)?")
CRS_CODE = re.compile(r"EPSG:[0-9]{4,6}")
ROBOT_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,62}")
LARGEST_NUMBER = 2**63 - 1
"""The largest value of an integer column of a database."""


class MessageError(ValueError):
    """A message that cannot be understood; the text names the operation, the parameter and the valid
    values."""


def check_finite(**numbers: float | None) -> None:
    """Refuse NaN and infinity; raises MessageError naming the parameter."""
    for name, value in numbers.items():
        if value is not None and not math.isfinite(value):
            raise MessageError(f"{name} is {value}; give a finite number")


def check_stored_number(**numbers: int | None) -> None:
    """Refuse an integer that a database column cannot hold; raises MessageError naming the parameter."""
    for name, value in numbers.items():
        if value is not None and not 0 <= value <= LARGEST_NUMBER:
            raise MessageError(f"{name} is {value}; give a whole number from 0 to {LARGEST_NUMBER}")


def check_ranges(message: Any) -> None:
    """Refuse a number outside the ``ranges`` of its message, NaN included; raises MessageError."""
    for name, (low, high) in message.ranges.items():
        value = getattr(message, name)
        if value is not None and not low <= value <= high:
            raise MessageError(f"{name} is {value}; give a number from {low:g} to {high:g}")


def check_texts(message: Any) -> None:
    """Refuse one of the ``texts`` of a message if empty, too long or with a line break; raises
    MessageError."""
    for name, longest in message.texts.items():
        value = getattr(message, name)
        if value is not None and not (0 < len(value) <= longest and value.isprintable()):
            raise MessageError(f"{name} is {value[:40]!r}; give 1 to {longest} printable characters")


def is_robot_name(name: str) -> bool:
    """Return whether ``name`` can name a robot."""
    return ROBOT_NAME.fullmatch(name) is not None


def check_robot_name(name: str) -> str:
    """Return ``name`` if it can name a robot, else raise MessageError."""
    if not is_robot_name(name):
        raise MessageError(
            f"robot name {name!r} cannot be used; take 1 to 63 letters, digits, '_', '.' or '-', "
            "beginning with a letter or digit"
        )
    return name


def is_gateway_address(address: str) -> bool:
    """Return whether ``address`` is one of a gateway: ``ws://host:port`` or ``wss://``, and a path."""
    if len(address) > LONGEST_ADDRESS or not GATEWAY_ADDRESS.fullmatch(address):
        return False
    try:
        parts = urlsplit(address)
        return bool(parts.hostname) and parts.port != 0
    except ValueError:
        return False


def is_loopback(host: str) -> bool:
    """Return whether a host name or address is a loopback one, by which other computers cannot reach this
    one."""
    try:
        return ipaddress.ip_address("127.0.0.1" if host == "localhost" else host).is_loopback
    except ValueError:
        return False


def usable_addresses(addresses: Sequence[str] | None) -> list[str] | None:
    """Return the first :data:`MOST_GATEWAYS` usable ones of ``addresses``, None if there is none.

    Unusable ones raise no error: an address for later failover is no reason to lose a robot now.
    """
    usable = filter(is_gateway_address, dict.fromkeys(addresses or ()))
    return list(islice(usable, MOST_GATEWAYS)) or None


def check_crs(crs: str | None) -> None:
    """Refuse a text that is no code of a CRS; raises MessageError. None is the site frame."""
    if crs is not None and CRS_CODE.fullmatch(crs) is None:
        raise MessageError(f"crs is {crs[:40]!r}; give a code such as 'EPSG:4326', or none: the site frame")


def check_command_id(command: str) -> None:
    """Refuse an id that cannot identify a command; raises MessageError."""
    if not (8 <= len(command) <= 64 and command.isprintable()):
        raise MessageError(f"command is {command!r}; give an id of 8 to 64 characters, say a UUID")


def check_expires_in(seconds: float | None, longest: float) -> None:
    """Refuse an invalid time until expiry; None means never. Raises MessageError."""
    if seconds is not None and not 0 < seconds <= longest:
        raise MessageError(
            f"expires_in is {seconds}; give seconds, above 0 and up to {longest:g}, or leave it out"
        )


# --- Known and unknown keys of a JSON object, by the fields of its message ---

_SHOWN = 40
"""characters shown of a refused key."""


def known_fields(kind: type, values: dict[str, Any]) -> dict[str, Any]:
    """Return those of ``values`` that ``kind`` has fields for: a newer gateway may send more."""
    names = _names(kind)
    return {name: value for name, value in values.items() if name in names}


def unknown_keys(kind: type, values: dict[str, Any]) -> Iterator[str]:
    """Yield keys for which the dataclass ``kind``, or one nested in it, has no field, as ``tasks[2].colour``.

    Values of a wrong type are skipped.
    """
    for path, _holder in _unknown(kind, values, ""):
        yield path


def refuse_unknown_keys(kind: type, values: dict[str, Any]) -> None:
    """Raise MessageError for the first key in ``values`` that ``kind`` has no field for.

    An ignored key could have been essential, such as the CRS of a place.
    """
    for path, holder in _unknown(kind, values, ""):
        names = ", ".join(field.name for field in dataclasses.fields(holder)) or "none"
        raise MessageError(
            f"{path} is no parameter here; known are: {names}. Leave it out or correct its name"
        )


def _unknown(kind: type, values: Any, path: str) -> Iterator[tuple[str, type]]:
    if not isinstance(values, dict):
        return
    if not values.keys() <= _names(kind):
        for name in values.keys() - _names(kind):
            yield f"{path}{_shown(name)}", kind
    for name, (inner, many) in _inner(kind).items():
        value = values.get(name)
        if many and isinstance(value, (list, tuple)):
            for number, one in enumerate(value):
                yield from _unknown(inner, one, f"{path}{name}[{number}].")
        elif not many:
            yield from _unknown(inner, value, f"{path}{name}.")


def _shown(name: object) -> str:
    text = str(name)
    text = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
    return text if text.isidentifier() else repr(text)


@functools.cache
def _names(kind: type) -> frozenset[str]:
    return frozenset(field.name for field in dataclasses.fields(kind))


@functools.cache
def _inner(kind: type) -> dict[str, tuple[type, bool]]:
    """Return the fields of ``kind`` that hold a dataclass, or (``True``) a list of them."""
    hints = typing.get_type_hints(kind)
    found = {}
    for field in dataclasses.fields(kind):
        hint = hints[field.name]
        for one in typing.get_args(hint) if isinstance(hint, types.UnionType) else (hint,):
            many = typing.get_origin(one) in (list, tuple)
            holds = typing.get_args(one)[0] if many else one
            if dataclasses.is_dataclass(holds) and isinstance(holds, type):
                found[field.name] = (holds, many)
    return found


# --- Messages as plain JSON values ---


def to_json(message: Any) -> dict[str, Any]:
    """Return a message as JSON values; None values are left out, and bytes fields go into the payload."""
    return {
        name: value if type(value) in _PLAIN_ALREADY else _plain(value)
        for name in _in_order(message.__class__)
        if (value := getattr(message, name)) is not None and not isinstance(value, bytes)
    }


_PLAIN_ALREADY = frozenset({str, int, float, bool})


@functools.cache
def _in_order(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind))


def _plain(value: Any) -> Any:
    # The check for a dataclass comes last: on an Enum it takes longer than all the rest.
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if dataclasses.is_dataclass(value):
        return to_json(value)
    return value


# --- Declarations of every operator's request: its method, least role, priority and type of result ---


class Role(str, Enum):
    """The rights of an operator's account; each role includes those of the one before it."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    SUPERVISOR = "supervisor"

    def includes(self, other: Role) -> bool:
        """Return whether this role includes the rights of ``other``."""
        order = list(Role)
        return order.index(self) >= order.index(other)


class Priority(Enum):
    """How a request is scheduled among others of the same connection."""

    STOP = "stop"
    """at once, before earlier requests; waiting ones that would move its robot are then refused."""
    MOVE = "move"
    """in turn; it sets its ``robot`` in motion, or every robot if it names none."""
    MOVE_SEVERAL = "move several"
    """in turn; it sets other robots than its ``robot`` in motion, too."""
    SLOW = "slow"
    """concurrently with the others: it changes nothing, and takes long or returns much."""
    FIFO = "fifo"
    """in turn; it sets no robot in motion."""


Result = TypeVar("Result")

DESK_REQUESTS: dict[str, type[DeskRequest[Any]]] = {}
"""Every request of operators, by its method."""


class DeskRequest(Generic[Result]):
    """A request of an operator, answered with a ``Result``; defining a subclass registers it.

    :raises TypeError: when a class lacks its method, least role or result, or its method is already
        registered.
    """

    method: ClassVar[str]
    least_role: ClassVar[Role]
    priority: ClassVar[Priority] = Priority.FIFO
    stops: ClassVar[bool] = False
    """Unknown parameters are ignored: requests that stop or hold robots are never refused for them."""
    result: ClassVar[type]

    def __class_getitem__(cls, result: Any) -> GenericAlias:
        """Return the alias that a subclass names as its base.

        Not by typing, whose cache would keep older classes alive after a reload of the plugin.
        """
        return GenericAlias(cls, result)

    def __init_subclass__(cls) -> None:
        """Check the declarations of the class, and register it under its method."""
        super().__init_subclass__()
        for name in ("method", "least_role"):
            if not hasattr(cls, name):
                raise TypeError(f"{cls.__name__} does not say its {name}")
        # Python keeps the base as the class names it, DeskRequest[Result]; mypy does not know that.
        (cls.result,) = get_args(cls.__orig_bases__[0])  # type: ignore[attr-defined]
        if DESK_REQUESTS.setdefault(cls.method, cls) is not cls:
            taken = DESK_REQUESTS[cls.method].__name__
            raise TypeError(f"{cls.__name__}: method {cls.method!r} is {taken}'s")


@dataclass(frozen=True)
class Done:
    """The answer to a request that returns no data."""
