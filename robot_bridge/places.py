"""May a robot be sent there: is the place on the site, and the way outside its keepouts?"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from typing import Protocol

from .errors import OverridableError, RefusedError
from .messages import Abort, Command, SetPath, SetPosEnd, SiteReport
from .polyline import Track

Place = tuple[float, float]
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

    def keepouts_crossed(self, ways: Sequence[Track]) -> dict[int, str]:
        """Return the numbers of those of ``ways`` that lead through a keepout in which neither end lies."""


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


async def keepout_refusals(
    site: Fenced, messages: Sequence[Command], straight_from: Sequence[Place | None] | None = None
) -> list[OverridableError | None]:
    """Return for each of ``messages`` why it must not be sent: it sends a robot into a keepout of the site.

    Where a robot is told that it stands is not looked at. ``straight_from`` is for each of ``messages`` the
    place that a robot drives straight to its target from, or to the first point of its path; None where it
    does not do so or its place is not known: whoever stands in a keepout may come out of it, and nobody may
    cross one.
    """
    moving = [number for number, one in enumerate(messages) if isinstance(one, (SetPosEnd, SetPath))]
    refusals: list[OverridableError | None] = [None] * len(messages)
    if not moving or not site.has_keepouts:
        return refusals
    tracks: list[Track] = [places_of(messages[number]) for number in moving]
    # All of them in one thread: a hop for each would take a thousand targets a thousand hops.
    for track, name in (await asyncio.to_thread(site.keepouts_entered, tracks)).items():
        refusals[moving[track]] = _refusal(tracks[track], name)
    straight = {
        number: [start, places_of(messages[number])[0]]
        for number, start in enumerate(straight_from or ())
        if start is not None and refusals[number] is None
    }
    if straight:
        crossed = await asyncio.to_thread(site.keepouts_crossed, list(straight.values()))
        for way, name in crossed.items():
            number = list(straight)[way]
            found = crossing(straight[number], name, to_path=isinstance(messages[number], SetPath))
            refusals[number] = OverridableError([found], _ELSEWHERE)
    return refusals


def crossing(way: Track, keepout: str, *, to_path: bool = False) -> str:
    """Return that the straight way of a robot, to its target or ``to_path``, leads through a keepout."""
    (x, y), (to_x, to_y) = way
    if to_path:
        return (
            f"the straight way from where the robot is, ({x:.2f}, {y:.2f}), to the first point of its path, "
            f"({to_x:.2f}, {to_y:.2f}), leads through the keepout {keepout!r}"
        )
    return (
        f"the robot does not ask for its path, and the straight way that it drives from ({x:.2f}, {y:.2f}) "
        f"to ({to_x:.2f}, {to_y:.2f}) leads through the keepout {keepout!r}"
    )


def _refusal(track: Track, keepout: str) -> OverridableError:
    x, y = track[-1]
    what = f"({x:.2f}, {y:.2f}) lies in" if len(track) == 1 else f"the path to ({x:.2f}, {y:.2f}) enters"
    return OverridableError([f"{what} the keepout {keepout!r}"], _ELSEWHERE)
