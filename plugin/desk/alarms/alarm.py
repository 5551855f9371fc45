"""One alarm, and what happened to it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from .thresholds import AlarmKind

Key = tuple[AlarmKind, str, str]
"""Kind, robot, and the other robot or the area where there is one."""


class Alarm(NamedTuple):
    """Something that holds since ``began``, or held until ``ended``; times are seconds since 1970.

    It stays until it is over and somebody has seen it. ``times`` counts how often it began since it was
    last acknowledged. ``area`` is the keepout or obstacle that it is about. ``xy`` is where the robot was
    when it began, metres in the site frame.
    """

    kind: AlarmKind
    robot: str
    text: str
    began: float
    other: str = ""
    xy: tuple[float, float] | None = None
    ended: float | None = None
    acknowledged: float | None = None
    by: str = ""
    times: int = 1
    area: str = ""

    @property
    def key(self) -> Key:
        """What makes it the same alarm when it comes again."""
        return self.kind, self.robot, self.other or self.area

    @property
    def is_new(self) -> bool:
        """Whether nobody has acknowledged it."""
        return self.acknowledged is None


class AlarmChange(str, Enum):
    """What happened to an alarm."""

    BEGAN = "began"
    ENDED = "ended"
    ACKNOWLEDGED = "acknowledged"


@dataclass(frozen=True)
class AlarmEvent:
    """A line of the log: at ``at`` an alarm changed; ``by`` is who acknowledged it."""

    at: float
    change: AlarmChange
    alarm: Alarm
    by: str = ""
