"""Places of commands in the site frame: from any CRS, checked against the served site and its keepouts."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Protocol

from ...core.errors import OverridableError, RefusedError
from ...core.geometry import Track
from ...core.messages.administration import SiteReport
from ...core.messages.commands import TargetPosition
from ...core.messages.queues import QueueTask
from ...core.messages.records import ObservationReport
from ...core.messages.roads import GetRoute
from ...core.messages.robots import MOTIONS, Abort, Command, SetPath, SetPosEnd, SetPosIni
from ...core.roads.network import Surface
from ...core.robotmap.model import EncodedMap
from ...core.sites.fences import Fences
from ...core.sites.settings import SiteSettings
from ...core.sites.site import Site

# --- Interface of a site for the fleet ---


class ServedSite(Protocol):
    """A site: its facts, its maps in the binary format, and the objects drawn on them."""

    @property
    def report(self) -> SiteReport:
        """The facts of the site."""

    @property
    def site(self) -> Site:
        """The site as last published."""

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""

    def contains(self, x: float, y: float) -> bool:
        """Return whether (x, y), metres in the site frame, lies on the site."""

    @property
    def has_keepouts(self) -> bool:
        """Return whether the site has any keepout."""

    def keepouts_entered(self, tracks: Sequence[Track]) -> dict[int, str]:
        """Return the indices of ``tracks`` that enter a keepout, each with the keepout's name."""

    def keepouts_crossed(self, ways: Sequence[Track]) -> dict[int, str]:
        """Return the indices of ``ways`` that cross a keepout in which neither end lies."""

    def fences(self) -> Fences:
        """Return the areas forbidden to robots, with accepted objects; may take long.

        The same object while nothing has changed, and the same keepouts if only objects have.
        """

    def fences_at_hand(self) -> Fences | None:
        """Return what :meth:`fences` does if it is made already, else None; does not wait."""

    def whole_map(self) -> bytes | None:
        """Return the map of the whole site, None if it is larger than the site allows; may take long."""

    def small_map_at_hand(self) -> EncodedMap | None:
        """Return the map of the whole site if it is small and built already; does not wait."""

    def map_at_once(self, place: tuple[float, float] | None) -> EncodedMap:
        """Return the map of the whole site if small and at hand, else one around ``place``."""

    def is_quick(self, x: float, y: float, area: float) -> bool:
        """Return whether the map of such a square is built in a few milliseconds."""

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y)."""

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``; raises RefusedError for an unusable CRS."""

    def to_site(self, points: Sequence[tuple[float, float]], crs: str) -> list[tuple[float, float]]:
        """Return ``points`` of ``crs``, x before y, in metres in the site frame.

        Raises RefusedError for an unusable CRS, and for a point that the site's CRS cannot represent.
        """

    def place_on_earth(
        self, lat: float, lon: float, heading: float | None
    ) -> tuple[tuple[float, float], float | None]:
        """Return (x, y) and theta of a GPS position; raises RefusedError if it has none."""

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps from now on."""


# --- Checks of targets and ways: on the site, outside its keepouts ---

Place = tuple[float, float]
_ELSEWHERE = "choose a place or way outside it, or send it with an override"


class Ground(Protocol):
    """The extent of a site."""

    @property
    def report(self) -> SiteReport:
        """The facts of the site."""

    def contains(self, x: float, y: float) -> bool:
        """Return whether (x, y), metres in the site frame, lies on the site."""


class Fenced(Protocol):
    """The keepouts of a site."""

    @property
    def has_keepouts(self) -> bool:
        """Return whether the site has any keepout."""

    def keepouts_entered(self, tracks: Sequence[Track]) -> dict[int, str]:
        """Return the indices of ``tracks`` that enter a keepout, each with the keepout's name."""

    def keepouts_crossed(self, ways: Sequence[Track]) -> dict[int, str]:
        """Return the indices of ``ways`` that cross a keepout in which neither end lies."""


def check_places(site: Ground, points: Iterable[tuple[float, float]]) -> None:
    """Raise RefusedError for the first of ``points`` (metres, site frame) outside the site."""
    for x, y in points:
        if not site.contains(x, y):
            x_min, y_min, x_max, y_max = site.report.bounds
            raise RefusedError(
                f"({x:.2f}, {y:.2f}) lies outside site {site.report.name!r}, which reaches from "
                f"({x_min:.2f}, {y_min:.2f}) to ({x_max:.2f}, {y_max:.2f}); choose a place inside"
            )


def places_of(message: Command) -> list[tuple[float, float]]:
    """Return the places to which a command sends a robot."""
    if isinstance(message, SetPath):
        return message.points
    return [] if isinstance(message, Abort) else [(message.x, message.y)]


async def check_keepouts(site: Fenced, messages: Sequence[Command]) -> None:
    """Raise OverridableError if any of ``messages`` sends a robot into a keepout of the site."""
    refusals = [one for one in await keepout_refusals(site, messages) if one is not None]
    if refusals:
        raise OverridableError((found for one in refusals for found in one.found), _ELSEWHERE)


async def keepout_refusals(
    site: Fenced, messages: Sequence[Command], straight_from: Sequence[Place | None] | None = None
) -> list[OverridableError | None]:
    """Return for each of ``messages`` a refusal if it sends a robot into a keepout of the site, else None.

    Messages that set a robot's own position are not checked. ``straight_from`` has for each of ``messages``
    the place from which the robot drives straight to its target or to the first point of its path; None if it
    does not, or its place is unknown: a robot may leave a keepout, and none may cross one.
    """
    moving = [number for number, one in enumerate(messages) if isinstance(one, MOTIONS)]
    refusals: list[OverridableError | None] = [None] * len(messages)
    if not moving or not site.has_keepouts:
        return refusals
    tracks: list[Track] = [places_of(messages[number]) for number in moving]
    # All in one thread call: a thousand targets would otherwise need a thousand calls.
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
    """Return the text that a robot's straight way, to its target or ``to_path``, crosses a keepout."""
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


# --- Conversion of places in another CRS to the site frame ---

BESIDE = 1000.0
"""metres outside a site within which a route may be requested."""


class Georeferenced(Protocol):
    """A site with a known location."""

    @property
    def report(self) -> SiteReport:
        """The facts of the site."""

    def to_site(self, points: Sequence[Place], crs: str) -> list[Place]:
        """Return ``points`` of ``crs``, x before y, in metres in the site frame; raises RefusedError."""


async def command_in_site_frame(site: Georeferenced, message: Command, crs: str | None) -> Command:
    """Return ``message``, whose places are in ``crs``, with places in the site frame; raises RefusedError."""
    places = places_of(message)
    if crs is None or not places:
        return message
    moved = await _moved(site, places, crs)
    if isinstance(message, SetPath):
        return replace(message, points=moved)
    assert isinstance(message, (SetPosEnd, SetPosIni))
    return replace(message, x=moved[0][0], y=moved[0][1])


async def targets_in_site_frame(
    site: Georeferenced, targets: Sequence[TargetPosition]
) -> list[TargetPosition]:
    """Return ``targets`` with their places in the site frame; raises RefusedError."""
    moved = await _all_moved(site, [(target.crs, [(target.x, target.y)]) for target in targets])
    return [replace(target, x=x, y=y, crs=None) for target, ((x, y),) in zip(targets, moved, strict=True)]


async def tasks_in_site_frame(site: Georeferenced, tasks: Sequence[QueueTask]) -> list[QueueTask]:
    """Return ``tasks`` with their places and paths in the site frame; raises RefusedError, MessageError."""
    moved = await _all_moved(site, [(task.crs, [(task.x, task.y), *(task.path or ())]) for task in tasks])
    return [
        task if task.crs is None else _task_at(task, places)
        for task, places in zip(tasks, moved, strict=True)
    ]


async def route_in_site_frame(site: Georeferenced, request: GetRoute) -> GetRoute:
    """Return ``request`` with its places in the site frame; raises RefusedError."""
    if request.crs is None:
        return request
    places = [(request.x, request.y), *([] if request.start is None else [request.start])]
    end, *start = await _moved(site, places, request.crs, BESIDE)
    return replace(request, x=end[0], y=end[1], start=start[0] if start else None, crs=None)


def _task_at(task: QueueTask, places: list[Place]) -> QueueTask:
    (x, y), *path = places
    return replace(task, x=x, y=y, path=path if task.path else task.path, crs=None)


async def _all_moved(
    site: Georeferenced, groups: Sequence[tuple[str | None, list[Place]]]
) -> list[list[Place]]:
    """Return the places of each group in the site frame; all of one CRS in one call."""
    found: dict[str, list[Place]] = {}
    for crs in {crs for crs, _ in groups if crs is not None}:
        found[crs] = await _moved(
            site, [place for of, places in groups if of == crs for place in places], crs
        )
    waiting = {crs: iter(places) for crs, places in found.items()}
    return [places if crs is None else [next(waiting[crs]) for _ in places] for crs, places in groups]


async def _moved(site: Georeferenced, places: Sequence[Place], crs: str, beside: float = 0.0) -> list[Place]:
    # The first transformation from a CRS takes some hundredths of a second to find.
    moved = await asyncio.to_thread(site.to_site, places, crs)
    for place, there in zip(places, moved, strict=True):
        if not _is_within(site, there, beside):
            raise RefusedError(await asyncio.to_thread(_crs_refusal, site, place, there, crs, beside))
    return moved


def _is_within(site: Georeferenced, place: Place, beside: float) -> bool:
    x_min, y_min, x_max, y_max = site.report.bounds
    x, y = place
    return x_min - beside <= x <= x_max + beside and y_min - beside <= y <= y_max + beside


def _crs_refusal(site: Georeferenced, place: Place, there: Place, crs: str, beside: float) -> str:
    x_min, y_min, x_max, y_max = site.report.bounds
    given = f"({place[0]:.10g}, {place[1]:.10g}) in {crs}"
    lies = (
        f"{given} is ({there[0]:.2f}, {there[1]:.2f}) in the site frame and lies outside site "
        f"{site.report.name!r}, which reaches from ({x_min:.2f}, {y_min:.2f}) to ({x_max:.2f}, {y_max:.2f})"
    )
    try:
        swapped = _is_within(site, site.to_site([(place[1], place[0])], crs)[0], beside)
    except RefusedError:
        swapped = False
    if swapped:
        return f"{lies}; the other way round it lies on it: give x (longitude, easting) before y"
    return f"{lies}; check crs and the order, x (longitude, easting) before y, and choose a place inside"
