"""The tables of ``site.toml`` beside ``[site]``: what each key means, its default and what it may be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any, Literal

_LONGEST_DAYS = 36500.0
_LARGEST_IMAGE = 8_000_000
"""bytes; as text of a statement up to twice that, and a MariaDB as it is installed takes 16 MiB."""
_LARGEST_MAP = 48_000_000
"""bytes; as base64 in one frame 64 MB, which the reference robot takes."""


def _number(default: Any, *, least: float = 0.0, above: bool = False, most: float = math.inf) -> Any:
    """Return a field for a number of at least ``least`` (or ``above`` it) and at most ``most``."""
    return field(default=default, metadata={"least": least, "above": above, "most": most})


@dataclass(frozen=True)
class LivenessLimits:
    """Seconds without a message after which a robot counts as stale and as lost (design, section 4)."""

    stale_after_s: float = _number(3.0, above=True)
    lost_after_s: float = _number(10.0, above=True)


@dataclass(frozen=True)
class CommandSettings:
    """``expire_after_s``: seconds after which a command that no robot fetched is given up.

    Ended commands and tasks, collected cones and cleared emergency stops are deleted after ``keep_days``.
    ``override_role``: the least role that may send a robot where desk or gateway say that it should not go.
    """

    expire_after_s: float = _number(300.0, above=True)
    keep_days: float = _number(365.0, above=True, most=_LONGEST_DAYS)
    override_role: Literal["operator", "supervisor"] = "supervisor"


@dataclass(frozen=True)
class TrajectorySettings:
    """Which positions are stored, and for how long.

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
    """What robots may tell: the largest image, how much of one robot waits, and the size of an object.

    ``most_pending`` observations of one robot may wait for review; more are refused. ``object_radius_m`` is
    that of an object whose size the robot did not say. Rejected objects are deleted after ``keep_days``,
    reviewed images after ``keep_images_days``; what waits for review, and what is on the map, stays.
    """

    largest_image_bytes: int = _number(4_000_000, least=1024, most=_LARGEST_IMAGE)
    most_pending: int = _number(1000, least=1, most=1_000_000)
    object_radius_m: float = _number(0.25, above=True, most=100.0)
    keep_days: float = _number(365.0, above=True, most=_LONGEST_DAYS)
    keep_images_days: float = _number(90.0, above=True, most=_LONGEST_DAYS)


@dataclass(frozen=True)
class AuditSettings:
    """``keep_days``: after how many days an entry of the audit log, and an ended session, is deleted."""

    keep_days: float = _number(365.0, above=True, most=_LONGEST_DAYS)


@dataclass(frozen=True)
class MapSettings:
    """What maps robots are sent without asking: after Ready, and when the site was published anew.

    The map of the whole site where it has at most ``largest_whole_bytes`` in the binary format; else that of
    a square of ``window_m`` metres around the robot, or less where much stands there.
    """

    largest_whole_bytes: int = _number(8_000_000, most=_LARGEST_MAP)
    window_m: float = _number(300.0, least=10.0, most=10_000.0)


@dataclass(frozen=True)
class RouteSettings:
    """How robots drive along roads, and what is reckoned with where several do.

    Paths have points ``spacing_m`` apart at most and arcs of ``turning_radius_m``. A robot is
    ``robot_width_m`` wide and ``robot_length_m`` long, drives at ``speed_ms`` where it does not show another
    speed, and is to be ``margin_m`` away from others. ``no_way`` says what becomes of a robot whose road was
    closed and that has no other way: it is told to ``stop``, or operators are only told (``tell``).
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
        """Metres: of the circle about a robot's middle that it is within however it stands."""
        return math.hypot(self.robot_width_m, self.robot_length_m) / 2


@dataclass(frozen=True)
class QueueSettings:
    """``on_failure``: whether a robot's queue pauses when it refuses a task or gives it up, or skips that."""

    on_failure: Literal["pause", "skip"] = "pause"


@dataclass(frozen=True)
class ConeSettings:
    """Where the cone that a robot puts down or picks up stands: metres ahead of the robot and to its left."""

    offset_ahead_m: float = _number(0.0, least=-20.0, most=20.0)
    offset_left_m: float = _number(0.0, least=-20.0, most=20.0)

    @property
    def offset(self) -> tuple[float, float]:
        """Metres ahead and to the left."""
        return self.offset_ahead_m, self.offset_left_m


FenceAction = Literal["none", "pause", "abort"]


@dataclass(frozen=True)
class GeofenceSettings:
    """What the gateway does by itself when a robot comes into a keepout, or too near to an obstacle.

    Operators are told of it in any case; ``pause`` and ``abort`` stop the robot as an operator's do, once
    each time that it comes in. Distances are from a robot's middle: ``keepout_clearance_m`` beyond the edge
    of a keepout, ``obstacle_clearance_m`` from an obstacle, None for the robot's radius after ``[routes]``.
    """

    in_keepout: FenceAction = "none"
    at_obstacle: FenceAction = "none"
    keepout_clearance_m: float = _number(0.0, most=100.0)
    obstacle_clearance_m: float | None = _number(None, most=100.0)


@dataclass(frozen=True)
class NearnessSettings:
    """From where on operators are told of people and vehicles, that are only seen, near robots.

    ``metres`` are between the middles of two; 0 switches it off. They are told, too, of who will be so near
    within ``within_s`` seconds if both go on as they do.
    """

    metres: float = _number(5.0, most=1000.0)
    within_s: float = _number(10.0, most=600.0)


@dataclass(frozen=True)
class GatewayOptions:
    """What ``robot-bridge serve`` takes where its command line does not say it; None for its own default.

    ``certificate`` and ``key`` are files in PEM; a relative one lies in the folder of ``site.toml``.
    """

    host: str | None = None
    port: int | None = _number(None, most=65535)
    database: str | None = None
    certificate: str | None = None
    key: str | None = None


@dataclass(frozen=True)
class LinkOptions:
    """Links that the gateway starts and keeps going: files of settings in the site's folder, by kind."""

    tracker: tuple[str, ...] = ()
    vda5050: tuple[str, ...] = ()
    ros2: tuple[str, ...] = ()
    rosbridge: tuple[str, ...] = ()
    replay: tuple[str, ...] = ()

    def files(self) -> list[tuple[str, str]]:
        """Return the kind and the file of each."""
        return [(kind.name, file) for kind in fields(self) for file in getattr(self, kind.name)]


def out_of_range(table: str, values: object) -> Iterator[str]:
    """Yield a sentence for every number of the dataclass ``values`` that its field does not allow."""
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
