"""Stays of robots in keepouts and at obstacles, with their times and hysteresis; no I/O."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.messages.safety import FenceKind, StopAction, StopOutcome
from ...core.sites.fences import FencedAreas, Fences
from ...core.sites.frame import Points
from ...core.sites.settings_tables import GeofenceSettings

MARGIN_M = 0.5
"""Metres beyond the clearance at which a robot has left: positions jitter by some decimetres."""
LEFT_AFTER_S = 2.0
"""Seconds for which it must be that far away before it counts as left."""
Place = tuple[float, float]
"""x, y in metres, site frame."""
DONE: Collection[StopOutcome] = ("paused", "aborted", "stopped")
"""Outcomes of robots that have been stopped."""


class StayKey(NamedTuple):
    """A robot in one area; ``area`` is the id of the area among those of its kind."""

    robot: str
    kind: FenceKind
    area: int


@dataclass
class Stay:
    """One entry of a robot into an area, at ``place`` and time ``since``, until it has left.

    ``action`` is the action to take on it, once; ``outcome`` and ``reason`` are the result of that.
    """

    robot: str
    kind: FenceKind
    name: str
    since: float
    place: Place
    action: StopAction
    outcome: StopOutcome = "none"
    reason: str | None = None


class Clearances(NamedTuple):
    """Metres from the centre of a robot to an area within which it counts as in it, or at it."""

    keepout: float
    obstacle: float

    @classmethod
    def of(cls, settings: GeofenceSettings, radius: float) -> Clearances:
        """Return the clearances that a site sets, for robots with a radius of ``radius`` metres."""
        obstacle = settings.obstacle_clearance_m
        return cls(settings.keepout_clearance_m, radius if obstacle is None else obstacle)


class FoundStays(NamedTuple):
    """Robots that were ``judged``; those ``inside`` an area, with the areas and its number among them;
    the ``places`` of those; and those still ``near`` one."""

    judged: AbstractSet[str]
    places: dict[str, Place]
    inside: dict[StayKey, tuple[FencedAreas, int]]
    near: set[StayKey]


class StayChanges(NamedTuple):
    """Changes by one update of :class:`Stays`."""

    entered: list[Stay]
    ended: list[Stay]


class Stays:
    """The stays of all robots in the areas of one publication.

    A stay begins when a robot comes within the clearance, and ends when it has been :data:`MARGIN_M` further
    away for :data:`LEFT_AFTER_S`. In between it is the same stay, whatever the robot does: it is acted upon
    once, so that an operator can drive a stopped robot out again.
    """

    def __init__(self) -> None:
        self._stays: dict[StayKey, Stay] = {}
        self._outside_since: dict[StayKey, float] = {}
        self._earlier: dict[tuple[str, FenceKind, str], Stay] = {}

    def __iter__(self) -> Iterator[Stay]:
        return iter(self._stays.values())

    def __len__(self) -> int:
        return len(self._stays)

    def begin_publication(self) -> None:
        """Expect other areas from the next update on, in which every robot must be judged.

        A robot that is then in an area of the same kind and name continues its earlier stay.
        """
        self._earlier.update({(stay.robot, stay.kind, stay.name): stay for stay in self})
        self._stays.clear()
        self._outside_since.clear()

    def update(self, found: FoundStays, settings: GeofenceSettings, now: float) -> StayChanges:
        """Apply the findings on some robots; the others are where they were."""
        entered = []
        # All names before any stay: one that began and is not returned would never be acted upon.
        new = sorted(found.inside.keys() - self._stays.keys())
        names = {key: areas.name(area) for key in new for areas, area in [found.inside[key]]}
        for key, name in names.items():
            stay = self._begin(key, name, found.places[key.robot], settings, now)
            if stay is not None:
                entered.append(stay)
        self._record_outside(found, now)
        ended = [*self._end_outside(now), *self._earlier.values()]
        self._earlier.clear()
        return StayChanges(entered, ended)

    def forget(self, robots: Iterable[str]) -> list[Stay]:
        """End the stays of robots that are no longer judged here, and return them."""
        gone = set(robots)
        keys = [key for key in self._stays if key.robot in gone]
        for key in keys:
            self._outside_since.pop(key, None)
        return [self._stays.pop(key) for key in keys]

    def holds(self, stay: Stay) -> bool:
        """Return whether a stay continues."""
        return any(one is stay for one in self)

    def _begin(
        self, key: StayKey, name: str, place: Place, settings: GeofenceSettings, now: float
    ) -> Stay | None:
        """Begin a stay and return it, None where it continues one of the earlier publication."""
        known = self._earlier.pop((key.robot, key.kind, name), None)
        if known is not None:
            self._stays[key] = known
            return None
        action = settings.in_keepout if key.kind == "keepout" else settings.at_obstacle
        stay = Stay(key.robot, key.kind, name, now, place, action)
        self._stays[key] = stay
        return stay

    def _record_outside(self, found: FoundStays, now: float) -> None:
        for key in self._stays:
            if key in found.near:
                self._outside_since.pop(key, None)
            elif key.robot in found.judged:
                self._outside_since.setdefault(key, now)

    def _end_outside(self, now: float) -> list[Stay]:
        # A clock that was set back must not keep an alarm for as long as it was set back.
        over = [key for key, since in self._outside_since.items() if not 0 <= now - since < LEFT_AFTER_S]
        for key in over:
            del self._outside_since[key]
        return [self._stays.pop(key) for key in over]


def find_stays(robots: Sequence[str], places: Points, fences: Fences, clearances: Clearances) -> FoundStays:
    """Find the areas that ``robots`` are in; ``places`` (n, 2), metres in the site frame; in any thread."""
    inside: dict[StayKey, tuple[FencedAreas, int]] = {}
    near: set[StayKey] = set()
    at: dict[str, Place] = {}
    kinds: tuple[tuple[FenceKind, FencedAreas, float], ...] = (
        ("keepout", fences.keepouts, clearances.keepout),
        ("obstacle", fences.obstacles, clearances.obstacle),
        ("obstacle", fences.observed, clearances.obstacle),
    )
    for kind, areas, metres in kinds:
        pairs = areas.near(places, metres + MARGIN_M)
        if not pairs.size:
            continue
        is_inside = areas.are_near(places, pairs, metres).tolist()
        for (row, area), inside_it in zip(pairs.T.tolist(), is_inside, strict=True):
            key = StayKey(robots[row], kind, areas.id(area))
            near.add(key)
            if inside_it:
                inside[key] = areas, area
                x, y = places[row].tolist()
                at[key.robot] = x, y
    return FoundStays(set(robots), at, inside, near)


def finite_places(places: Points) -> NDArray[np.bool_]:
    """Return which of ``places``, (n, 2), are valid: all their numbers finite."""
    rows: NDArray[np.bool_] = np.isfinite(places).all(axis=1)
    return rows
