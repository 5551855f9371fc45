"""Tables of the settings of a site, and TOML text with comments."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Literal

# --- The text of a ``site.toml``: written whole, or changed in place with all other lines kept
# Python before 3.11, shipped with some QGIS versions, reads no TOML: tables and keys are found by patterns.

_HEADER = re.compile(r"""^[ \t]*\[{1,2}[ \t]*(["'\w.\- \t]+?)[ \t]*\]{1,2}[ \t]*(?:#.*)?$""")
_KEY = re.compile(r"""^[ \t]*(["']?)([\w-]+)\1[ \t]*=[ \t]*(.*)$""")
# An unclosed string ends with its line: searching for its end from each quote would take n² steps.
_QUOTED = re.compile(r'"(?:[^"\\]|\\.)*"?|\'[^\']*\'|#.*')
_LONGEST_HEADER = 200


def toml_value(value: Any) -> str:
    """Return a string, number, boolean or sequence as TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (tuple, list)):
        return f"[{', '.join(toml_value(item) for item in value)}]"
    return repr(value)


def changed_text(text: str, tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Return ``text`` with the keys of ``tables`` set; comments, other keys and other tables stay."""
    lines = text.splitlines()
    for table, values in tables.items():
        lines = _with_table(lines, table, values)
    return "\n".join(lines) + "\n"


def value_text(text: str, table: str, key: str) -> str | None:
    """Return the text after ``key =`` in ``[table]``, without a comment; None if the key is missing."""
    lines = text.splitlines()
    start, end = _table(lines, table) or (0, 0)
    found = _keys(lines, start, end).get(key)
    if found is None:
        return None
    inner = "\n".join(lines[found[0] : found[1]]).partition("=")[2]
    return re.sub(_QUOTED, lambda m: "" if m[0].startswith("#") else m[0], inner).strip()


def _with_table(lines: list[str], table: str, values: Mapping[str, Any]) -> list[str]:
    place = _table(lines, table)
    if place is None:
        gap = [""] if lines and lines[-1].strip() else []
        return [*lines, *gap, f"[{table}]", *(f"{key} = {toml_value(v)}" for key, v in values.items())]
    start, end = place
    body, missing = lines[start:end], []
    for key, value in values.items():
        found = _keys(body, 0, len(body)).get(key)
        if found is None:
            missing.append(f"{key} = {toml_value(value)}")
        else:
            body[found[0] : found[1]] = [f"{key} = {toml_value(value)}"]
    while missing and body and not body[-1].strip():
        body.pop()
    tail = [""] if missing and end < len(lines) else []
    return [*lines[:start], *body, *missing, *tail, *lines[end:]]


def _table(lines: list[str], table: str) -> tuple[int, int] | None:
    """Return the lines [start, end) between the header of ``table`` and the next header."""
    headers = [
        (number, match[1].strip("\"'"))
        for number, line in enumerate(lines)
        if (match := _HEADER.match(line[:_LONGEST_HEADER]))
    ]
    for position, (number, name) in enumerate(headers):
        if name == table:
            end = headers[position + 1][0] if position + 1 < len(headers) else len(lines)
            return number + 1, end
    return None


def _keys(lines: list[str], start: int, end: int) -> dict[str, tuple[int, int]]:
    """Return the lines [first, last) of each key; an array may span several."""
    found, number = {}, start
    while number < end:
        match = _KEY.match(lines[number])
        first, number = number, number + 1
        if match is None:
            continue
        open_brackets = _open_brackets(match[3])
        while open_brackets > 0 and number < end:
            open_brackets += _open_brackets(lines[number])
            number += 1
        found[match[2]] = (first, number)
    return found


def _open_brackets(text: str) -> int:
    bare = re.sub(_QUOTED, "", text)
    return bare.count("[") - bare.count("]")


# --- The tables of ``site.toml`` besides ``[site]``: meaning, default and range of each key

_LONGEST_DAYS = 36500.0
_LARGEST_IMAGE = 8_000_000
"""bytes; as text of a statement up to twice that; a MariaDB with default settings accepts 16 MiB."""
_LARGEST_MAP = 48_000_000
"""bytes; as base64 in one frame 64 MB, which the reference robot accepts."""


def _number(default: Any, *, least: float = 0.0, above: bool = False, most: float = math.inf) -> Any:
    """Return a field for a number of at least ``least`` (or ``above`` it) and at most ``most``."""
    return field(default=default, metadata={"least": least, "above": above, "most": most})


@dataclass(frozen=True)
class LivenessLimits:
    """Seconds without a message after which a robot counts as stale and as lost."""

    stale_after_s: float = _number(3.0, above=True)
    lost_after_s: float = _number(10.0, above=True)


@dataclass(frozen=True)
class CommandSettings:
    """``expire_after_s``: seconds after which a command that no robot fetched is given up.

    Ended commands and tasks, collected cones and cleared emergency stops are deleted after ``keep_days``.
    ``override_role``: the least role that may override objections of desk or gateway to a command.
    """

    expire_after_s: float = _number(300.0, above=True)
    keep_days: float = _number(365.0, above=True, most=_LONGEST_DAYS)
    override_role: Literal["operator", "supervisor"] = "supervisor"


@dataclass(frozen=True)
class TrajectorySettings:
    """Conditions for storing positions, and how long they are kept.

    A position is stored when the robot has moved ``min_distance_m`` or turned ``min_turn_deg`` since the last
    stored one, at most every ``min_interval_s``; and in any case after ``max_interval_s``. It is deleted
    after ``keep_days``. While the database is away, or too slow, up to ``largest_backlog`` positions wait in
    memory.
    """

    min_distance_m: float = _number(0.1)
    min_turn_deg: float = _number(5.0, most=360.0)
    min_interval_s: float = _number(0.2)
    max_interval_s: float = _number(10.0, above=True)
    keep_days: float = _number(30.0, above=True, most=_LONGEST_DAYS)
    largest_backlog: int = _number(200_000, least=1000, most=100_000_000)


@dataclass(frozen=True)
class ObservationSettings:
    """Limits of observations: the largest image, pending ones of a robot, and the default size of an object.

    ``most_pending`` observations of one robot may wait for review; more are refused. ``object_radius_m`` is
    that of an object whose size the robot did not say. Rejected objects are deleted after ``keep_days``,
    reviewed images after ``keep_images_days``; observations pending review or on the map stay.
    """

    largest_image_bytes: int = _number(4_000_000, least=1024, most=_LARGEST_IMAGE)
    most_pending: int = _number(1000, least=1, most=1_000_000)
    object_radius_m: float = _number(0.25, above=True, most=100.0)
    keep_days: float = _number(365.0, above=True, most=_LONGEST_DAYS)
    keep_images_days: float = _number(90.0, above=True, most=_LONGEST_DAYS)


@dataclass(frozen=True)
class AuditSettings:
    """``keep_days``: days after which entries of the audit log and ended sessions are deleted."""

    keep_days: float = _number(365.0, above=True, most=_LONGEST_DAYS)


@dataclass(frozen=True)
class MapSettings:
    """Maps sent to robots without a request: after Ready, and after a new publication of the site.

    The map of the whole site if it has at most ``largest_whole_bytes`` in the binary format; else that of a
    square of ``window_m`` metres around the robot, or less if there are many obstacles.
    """

    largest_whole_bytes: int = _number(8_000_000, most=_LARGEST_MAP)
    window_m: float = _number(300.0, least=10.0, most=10_000.0)


@dataclass(frozen=True)
class RouteSettings:
    """Parameters of driving along roads, and the margins between robots.

    Paths have points ``spacing_m`` apart at most and arcs of ``turning_radius_m``. A robot is
    ``robot_width_m`` wide and ``robot_length_m`` long, drives at ``speed_ms`` unless it shows another speed,
    and should stay ``margin_m`` away from others. ``no_way`` is the action for a robot whose road was closed
    and that has no other way: ``stop`` it, or only notify operators (``tell``).
    """

    spacing_m: float = _number(0.5, least=0.01, most=100.0)
    turning_radius_m: float = _number(1.0, most=1000.0)
    robot_width_m: float = _number(0.5, above=True, most=100.0)
    robot_length_m: float = _number(0.8, above=True, most=100.0)
    speed_ms: float = _number(1.0, above=True, most=100.0)
    margin_m: float = _number(0.3, most=100.0)
    no_way: Literal["stop", "tell"] = "stop"

    @property
    def radius_m(self) -> float:
        """Radius in metres of the circle about a robot's middle that contains it in any orientation."""
        return math.hypot(self.robot_width_m, self.robot_length_m) / 2


@dataclass(frozen=True)
class QueueSettings:
    """``on_failure``: whether a robot's queue pauses when the robot refuses or gives up a task, or skips that
    task."""

    on_failure: Literal["pause", "skip"] = "pause"


@dataclass(frozen=True)
class ConeSettings:
    """Position of the cone that a robot puts down or picks up: metres ahead of the robot and to its left."""

    offset_ahead_m: float = _number(0.0, least=-20.0, most=20.0)
    offset_left_m: float = _number(0.0, least=-20.0, most=20.0)

    @property
    def offset(self) -> tuple[float, float]:
        """Metres ahead and to the left."""
        return self.offset_ahead_m, self.offset_left_m


FenceAction = Literal["none", "pause", "abort"]


@dataclass(frozen=True)
class GeofenceSettings:
    """The gateway's action when a robot enters a keepout, or comes too near to an obstacle.

    Operators are notified in any case; ``pause`` and ``abort`` stop the robot like an operator's, once per
    entry. Distances are from a robot's middle: ``keepout_clearance_m`` beyond the edge of a keepout,
    ``obstacle_clearance_m`` from an obstacle, None for the robot's radius after ``[routes]``.
    """

    in_keepout: FenceAction = "none"
    at_obstacle: FenceAction = "none"
    keepout_clearance_m: float = _number(0.0, most=100.0)
    obstacle_clearance_m: float | None = _number(None, most=100.0)


@dataclass(frozen=True)
class NearnessSettings:
    """Limits of alarms on people and vehicles, which are only observed, near robots.

    ``metres`` are between the middles of two; 0 switches it off. An alarm is also raised for those that will
    be so near within ``within_s`` seconds if both keep their motion.
    """

    metres: float = _number(5.0, most=1000.0)
    within_s: float = _number(10.0, most=600.0)


@dataclass(frozen=True)
class FieldPageOptions:
    """The field page for phones, at ``/field``, unless it is not ``served``.

    ``tiles`` is the address of its background map in Web Mercator, with {z}, {x} and {y}, such as that of a
    WMTS; none is drawn if it is empty. ``attribution`` names the map's owner.
    """

    served: bool = True
    tiles: str = ""
    attribution: str = ""
    largest_zoom: int = _number(22, most=30)


@dataclass(frozen=True)
class GatewayOptions:
    """Options of ``robot-bridge serve`` that its command line does not set; None for its own default.

    ``certificate`` and ``key`` are files in PEM; a relative one lies in the folder of ``site.toml``. ``bus``
    is that between several gateways of one fleet, and ``when_cut_off`` the action for the robots of one that
    reaches neither the database nor any other gateway for five seconds; ``public_address`` is where robots
    reach this one, ``ws://host:port`` or ``wss://``.
    """

    host: str | None = None
    port: int | None = _number(None, most=65535)
    database: str | None = None
    certificate: str | None = None
    key: str | None = None
    bus: str | None = None
    when_cut_off: Literal["stop", "go on"] = "stop"
    public_address: str | None = None


@dataclass(frozen=True)
class LinkOptions:
    """Links that the gateway starts and keeps running: settings files in the site's folder, by kind."""

    tracker: tuple[str, ...] = ()
    vda5050: tuple[str, ...] = ()
    ros2: tuple[str, ...] = ()
    rosbridge: tuple[str, ...] = ()
    replay: tuple[str, ...] = ()

    def files(self) -> list[tuple[str, str]]:
        """Return the kind and the file of each."""
        return [(kind.name, file) for kind in fields(self) for file in getattr(self, kind.name)]


def out_of_range(table: str, values: object) -> Iterator[str]:
    """Yield a sentence for every number of the dataclass ``values`` outside the range of its field."""
    for f in fields(values):  # type: ignore[arg-type]
        value = getattr(values, f.name)
        if "least" not in f.metadata or value is None:
            continue
        least, above, most = f.metadata["least"], f.metadata["above"], f.metadata["most"]
        name = f"{table}.{f.name} = {value}"
        if not math.isfinite(value):
            yield f"{name}: nan and inf are no numbers for a site; write a finite one."
        elif above and value <= least:
            yield f"{name} is not above {least:.12g}."
        elif value < least:
            yield f"{name} is below {least:.12g}."
        elif value > most:
            yield f"{name} is above {most:.12g}."


# --- Table ``[limits]`` of ``site.toml``: what the gateway accepts from its peers ---


def _limit(default: float, least: float, most: float) -> Any:
    return field(default=default, metadata={"least": least, "above": False, "most": most})


@dataclass(frozen=True)
class LimitSettings:
    """Limits of what the gateway accepts from a peer, before it refuses and then closes.

    ``robot_messages_per_s`` and ``desk_messages_per_s`` are for each connection, with a burst of so many at
    once; each robot of a link has those of a robot, and the link ``link_messages_per_s`` for all its frames.
    ``robots``, ``desks`` and ``links`` are connections in all, ``per_address`` those of one kind from one IP
    address, ``desks_per_account`` those of one operator. ``pending_per_address`` counts those from one
    address that are not admitted yet; they have ``handshake_s`` for that, and the oldest makes room for one
    more. An admitted peer has ``first_message_s`` for its first message; until then a desk makes room for
    another one. A robot may be silent for ``silent_s`` at most. A client that receives nothing for
    ``stuck_s`` is cut off; ``send_buffer_bytes`` may wait for it in the system. ``origins`` are the web
    pages, as ``https://host:port``, whose scripts may connect. ``hosts`` are names of this computer under
    which the gateway's own pages may be requested, besides those of its certificate.

    A reported position more than ``place_within_m`` outside the site's bounds, or more than ``leap_m`` from
    the one a moment ago, is rejected, and the robot keeps its place on the map.
    """

    largest_message_bytes: int = _limit(1_048_576, 1024, 256_000_000)
    robot_messages_per_s: float = _limit(100.0, 1.0, 1e6)
    robot_burst: int = _limit(300, 1, 1_000_000)
    desk_messages_per_s: float = _limit(50.0, 1.0, 1e6)
    desk_burst: int = _limit(200, 1, 1_000_000)
    robots: int = _limit(2000, 1, 100_000)
    link_messages_per_s: float = _limit(20_000.0, 1.0, 1e6)
    link_burst: int = _limit(20_000, 1, 1_000_000)
    desks: int = _limit(200, 1, 100_000)
    links: int = _limit(50, 1, 10_000)
    per_address: int = _limit(1200, 1, 100_000)
    desks_per_account: int = _limit(10, 1, 1000)
    pending_per_address: int = _limit(1000, 1, 100_000)
    handshake_s: float = _limit(5.0, 0.1, 60.0)
    first_message_s: float = _limit(30.0, 0.1, 3600.0)
    silent_s: float = _limit(300.0, 1.0, 86400.0)
    stuck_s: float = _limit(10.0, 0.1, 600.0)
    send_buffer_bytes: int = _limit(262_144, 16_384, 64_000_000)
    failed_logins_per_minute: float = _limit(10.0, 1.0, 1e6)
    place_within_m: float = _limit(10_000.0, 1.0, 1e7)
    leap_m: float = _limit(100.0, 0.1, 1e7)
    origins: tuple[str, ...] = ()
    hosts: tuple[str, ...] = ()
