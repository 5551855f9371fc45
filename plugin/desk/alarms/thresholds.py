"""From where on something is an alarm, and from where on no longer."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import Enum


class AlarmKind(str, Enum):
    """What an alarm is about; the most pressing first."""

    LOST = "lost"
    UNSURE = "unsure of its place"
    IN_KEEPOUT = "in a keepout"
    AT_OBSTACLE = "at an obstacle"
    NEAR_ROBOT = "near a robot"
    COMES_NEAR = "will come near a robot"
    TOO_CLOSE = "too close"
    WILL_PASS = "will pass too near"
    OUTSIDE_SITE = "outside the site"
    OFF_ROAD = "off the road"
    STOPPED = "stopped unasked"
    LOW_BATTERY = "low battery"


@dataclass(frozen=True)
class Thresholds:
    """The operator's settings. Each alarm begins beyond one value and ends only well within another.

    ``low_battery`` and ``battery_margin`` are parts of a full one: an alarm ends at the sum of both.
    ``too_close`` is in metres between the places of two robots; an alarm ends ``close_margin`` further
    apart. ``unsure`` is the standard deviation of a position in metres from which an alarm begins; it ends
    ``unsure_margin`` below. ``outside_margin`` and ``road_margin`` are metres beyond the site's bounds or
    beside the road from which an alarm begins; it ends on the site or road. ``stopped_after`` is seconds for
    which a robot with a task stands; ``pass_within`` is seconds before two robots pass one another too near.
    ``kinds`` are the alarms that are watched for.
    """

    low_battery: float = 0.20
    battery_margin: float = 0.05
    too_close: float = 1.0
    close_margin: float = 0.3
    unsure: float = 2.0
    unsure_margin: float = 0.5
    outside_margin: float = 0.5
    road_margin: float = 0.5
    stopped_after: float = 10.0
    pass_within: float = 30.0
    kinds: frozenset[AlarmKind] = frozenset(AlarmKind)

    def __post_init__(self) -> None:
        for name, (least, most) in RANGES.items():
            value = getattr(self, name)
            if not least <= value <= most:
                raise ValueError(f"{name} is {value:g}; give {least:g} to {most:g}")


RANGES = {
    "low_battery": (0.0, 1.0),
    "battery_margin": (0.0, 0.5),
    "too_close": (0.0, 1000.0),
    "close_margin": (0.0, 1000.0),
    "unsure": (0.1, 1000.0),
    "unsure_margin": (0.0, 1000.0),
    "outside_margin": (0.0, 1000.0),
    "road_margin": (0.0, 100.0),
    "stopped_after": (1.0, 3600.0),
    "pass_within": (1.0, 3600.0),
}
"""What each number may be."""
NUMBERS = tuple(field.name for field in fields(Thresholds) if field.name != "kinds")
