"""What operators are told of robots in keepouts and at obstacles."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from .known_fields import known_fields

FenceKind = Literal["keepout", "obstacle"]
StopAction = Literal["none", "pause", "abort"]
StopOutcome = Literal["none", "asked", "paused", "aborted", "stopped", "failed"]


@dataclass(frozen=True)
class FenceAlarm:
    """A robot that is in a keepout, or too near to an obstacle, since the time ``since``.

    ``name`` is the keepout's or the obstacle's; the robot came in at (``x``, ``y``), metres, site frame.
    ``action`` is what the site's settings have the gateway do, and ``outcome`` what came of it: ``asked``
    until it is stored, ``stopped`` where an emergency stop held the robot already, ``failed`` with a
    ``reason`` as long as it could not be done; it is tried again. ``current`` is false where the robot is not
    heard now: it was there when it was heard last.
    """

    robot: str
    kind: FenceKind
    name: str
    since: float
    x: float
    y: float
    action: StopAction = "none"
    outcome: StopOutcome = "none"
    reason: str | None = None
    current: bool = True


@dataclass(frozen=True)
class Geofence:
    """All robots in keepouts and at obstacles at the gateway's time ``t``, those that came in last first.

    ``more`` counts alarms that are not listed. ``keepouts`` and ``obstacles`` count what the published site
    has, with the objects that operators accepted: where there are none, nothing can be told of them.
    ``unjudged`` names robots, at most 20, that may be anywhere: they have not said where they are since they
    connected, or are not heard; ``unjudged_more`` counts others. ``fault`` says why nothing is watched.
    """

    t: float
    alarms: list[FenceAlarm] = field(default_factory=list)
    more: int = 0
    keepouts: int = 0
    obstacles: int = 0
    unjudged: list[str] = field(default_factory=list)
    unjudged_more: int = 0
    fault: str | None = None


def geofence_report(values: dict[str, Any]) -> Geofence:
    """Return what a gateway sent as JSON; unknown fields of newer gateways are passed over."""
    alarms = [FenceAlarm(**known_fields(FenceAlarm, one)) for one in values.get("alarms", [])]
    names = [str(name) for name in values.get("unjudged", [])]
    return Geofence(**{**known_fields(Geofence, values), "alarms": alarms, "unjudged": names})
