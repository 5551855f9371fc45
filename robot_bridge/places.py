"""Is a place on the site?"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from .errors import RefusedError
from .messages import Abort, Command, SetPath, SiteReport


class Ground(Protocol):
    """What is known of where a site reaches."""

    @property
    def report(self) -> SiteReport:
        """The facts of the site."""

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies on the site."""


def check_places(site: Ground, points: Iterable[tuple[float, float]]) -> None:
    """Raise RefusedError for the first of ``points``, metres in the site frame, that is not on the site."""
    for x, y in points:
        if not site.contains(x, y):
            x_min, y_min, x_max, y_max = site.report.bounds
            raise RefusedError(
                f"({x:.2f}, {y:.2f}) lies outside site {site.report.name!r}, which reaches from "
                f"({x_min:.2f}, {y_min:.2f}) to ({x_max:.2f}, {y_max:.2f}); choose a place inside"
            )


def places_of(message: Command) -> list[tuple[float, float]]:
    """Return the places that a command sends a robot to."""
    if isinstance(message, SetPath):
        return message.points
    return [] if isinstance(message, Abort) else [(message.x, message.y)]
