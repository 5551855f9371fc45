"""What operators ask about where robots have been."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

from .checks import MessageError, check_finite

MOST_PLACES = 5000
_MARK = re.compile(r"(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?):(\d{1,18})")


class TrajectoryPlace(NamedTuple):
    """Where a robot was at the gateway's time ``received_at``; the other two times are by its own clock."""

    robot: str
    received_at: float
    x: float
    y: float
    theta: float
    v: float
    device_time: float | None
    fix_time: float | None


@dataclass(frozen=True)
class Trajectory:
    """Stored positions, oldest first; ``next`` is the ``after`` of the next page, None at the end."""

    places: list[TrajectoryPlace]
    next: str | None = None


@dataclass(frozen=True)
class GetTrajectory:
    """Ask where robots (none named: all) have been, from ``since`` up to ``until``, inside ``bounds``.

    ``bounds`` is x_min, y_min, x_max, y_max in the site frame. ``after`` is ``next`` of the page before.
    """

    method: ClassVar[str] = "get_trajectory"
    robots: list[str] = field(default_factory=list)
    since: float | None = None
    until: float | None = None
    bounds: tuple[float, float, float, float] | None = None
    after: str | None = None
    limit: int = 1000

    def __post_init__(self) -> None:
        check_finite(since=self.since, until=self.until)
        if self.bounds is not None:
            x_min, y_min, x_max, y_max = self.bounds
            check_finite(x_min=x_min, y_min=y_min, x_max=x_max, y_max=y_max)
            if x_min > x_max or y_min > y_max:
                raise MessageError(
                    f"bounds {list(self.bounds)} hold nothing; give x_min, y_min, x_max, y_max"
                )
        if not 1 <= self.limit <= MOST_PLACES:
            raise MessageError(f"limit is {self.limit}; give a number from 1 to {MOST_PLACES}")
        if self.after is not None and _MARK.fullmatch(self.after) is None:
            raise MessageError(f"after is {self.after[:80]!r}; give 'next' of the page before")

    def mark(self) -> tuple[float, int] | None:
        """Return the time and id that ``after`` stands for."""
        found = _MARK.fullmatch(self.after or "")
        return (float(found[1]), int(found[2])) if found else None


def mark_text(received_at: float, id: int) -> str:
    """Return the ``next`` of a page whose last position has this time and id."""
    return f"{received_at!r}:{id}"
