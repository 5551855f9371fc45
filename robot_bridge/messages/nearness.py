"""What operators are told of people and vehicles, that are only seen, near robots."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .known_fields import known_fields


@dataclass(frozen=True)
class NearnessAlarm:
    """``seen``, a phone or a tracker, is near ``robot``, or will be in ``seconds``: it is near now at 0.

    ``metres`` are between the two, now or when it will be near; it is about (``x``, ``y``), metres, site
    frame. ``since`` is when that was found, seconds since 1970.
    """

    seen: str
    robot: str
    metres: float
    seconds: float
    x: float
    y: float
    since: float


@dataclass(frozen=True)
class Nearness:
    """All that are near robots, or will be, at the gateway's time ``t``, the soonest first.

    ``more`` counts alarms that are not listed; ``metres`` and ``within_s`` are the site's limits. ``fault``
    says why nothing is watched.
    """

    t: float
    metres: float
    within_s: float
    alarms: list[NearnessAlarm] = field(default_factory=list)
    more: int = 0
    fault: str | None = None


def nearness_report(values: dict[str, Any]) -> Nearness:
    """Return what a gateway sent as JSON; unknown fields of newer gateways are passed over."""
    alarms = [NearnessAlarm(**known_fields(NearnessAlarm, one)) for one in values.get("alarms", [])]
    return Nearness(**{**known_fields(Nearness, values), "alarms": alarms})
