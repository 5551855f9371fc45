"""Places that operators give in another CRS than the site's, brought into the site frame."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from .errors import RefusedError
from .messages import Command, GetRoute, QueueTask, SetPath, SetPosEnd, SetPosIni, SiteReport, TargetPosition
from .places import places_of

Place = tuple[float, float]
BESIDE = 1000.0
"""metres outside a site within which a way may be asked for."""


class Georeferenced(Protocol):
    """A site of which it is known where it lies."""

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
    """Return the places of each group in the site frame; all of one CRS in one go."""
    found: dict[str, list[Place]] = {}
    for crs in {crs for crs, _ in groups if crs is not None}:
        found[crs] = await _moved(
            site, [place for of, places in groups if of == crs for place in places], crs
        )
    waiting = {crs: iter(places) for crs, places in found.items()}
    return [places if crs is None else [next(waiting[crs]) for _ in places] for crs, places in groups]


async def _moved(site: Georeferenced, places: Sequence[Place], crs: str, beside: float = 0.0) -> list[Place]:
    # The first way from a CRS takes some hundredths of a second to find.
    moved = await asyncio.to_thread(site.to_site, places, crs)
    for place, there in zip(places, moved, strict=True):
        if not _is_within(site, there, beside):
            raise RefusedError(await asyncio.to_thread(_refusal, site, place, there, crs, beside))
    return moved


def _is_within(site: Georeferenced, place: Place, beside: float) -> bool:
    x_min, y_min, x_max, y_max = site.report.bounds
    x, y = place
    return x_min - beside <= x <= x_max + beside and y_min - beside <= y <= y_max + beside


def _refusal(site: Georeferenced, place: Place, there: Place, crs: str, beside: float) -> str:
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
