"""May a robot be sent there: is the place on the site, and the way outside its keepouts?"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from typing import Protocol

from .errors import OverridableError, RefusedError
from .messages import Abort, Command, SetPath, SetPosEnd, SiteReport
from .polyline import Track

_ELSEWHERE = "choose a place or way outside it, or send it with an override"


class Ground(Protocol):
    """What is known of where a site reaches."""

    @property
    def report(self) -> SiteReport:
        """The facts of the site."""

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies on the site."""


class Fenced(Protocol):
    """What is known of where nobody may drive."""

    @property
    def has_keepouts(self) -> bool:
        """Tell whether there is any place where nobody may drive."""

    def keepouts_entered(self, tracks: Sequence[Track]) -> dict[int, str]:
        """Return the numbers of those of ``tracks`` that come into a keepout, each with that one's name."""


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


async def check_keepouts(site: Fenced, messages: Sequence[Command]) -> None:
    """Raise OverridableError for those of ``messages`` that send a robot into a keepout of the site."""
    refusals = [one for one in await keepout_refusals(site, messages) if one is not None]
    if refusals:
        raise OverridableError((found for one in refusals for found in one.found), _ELSEWHERE)


async def keepout_refusals(site: Fenced, messages: Sequence[Command]) -> list[OverridableError | None]:
    """Return for each of ``messages`` why it must not be sent: it sends a robot into a keepout of the site.

    Where a robot is told that it stands is not looked at, nor the way that it finds to a target by itself.
    """
    moving = [number for number, one in enumerate(messages) if isinstance(one, (SetPosEnd, SetPath))]
    refusals: list[OverridableError | None] = [None] * len(messages)
    if not moving or not site.has_keepouts:
        return refusals
    tracks: list[Track] = [places_of(messages[number]) for number in moving]
    # All of them in one thread: a hop for each would take a thousand targets a thousand hops.
    for track, name in (await asyncio.to_thread(site.keepouts_entered, tracks)).items():
        refusals[moving[track]] = _refusal(tracks[track], name)
    return refusals


def _refusal(track: Track, keepout: str) -> OverridableError:
    x, y = track[-1]
    what = f"({x:.2f}, {y:.2f}) lies in" if len(track) == 1 else f"the path to ({x:.2f}, {y:.2f}) enters"
    return OverridableError([f"{what} the keepout {keepout!r}"], _ELSEWHERE)
