"""What is to be seen on the canvas, in the site frame, and the same placed in the map's CRS."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, chain

import numpy as np
import numpy.typing as npt

from ..drafts import Draft, Point
from ..picture import RobotArrays
from ..placement import Placement
from .plans import Plan

Points = npt.NDArray[np.float64]
_NOWHERE: Points = np.empty((0, 2))


@dataclass(frozen=True)
class Scene:
    """Everything live, in the site frame, at ``now`` of the desk's clock.

    ``chosen`` are the selected robots, the one that commands go to last. ``remaining`` has for commands
    the metres still to go.
    """

    robots: RobotArrays
    now: float = 0.0
    chosen: tuple[str, ...] = ()
    plans: list[Plan] = field(default_factory=list)
    remaining: dict[str, float] = field(default_factory=dict)
    draft: Draft | None = None
    cursor: Point | None = None
    rows: dict[str, int] = field(default_factory=dict)
    """The rows of the robots that draft and selection name, and of those with a distance in ``remaining``."""


@dataclass(frozen=True)
class PlacedScene:
    """The same in the map's CRS: (n, 2) coordinates for each part; ``metre`` is the way to 1 m before each
    robot, or along the site's x of one whose heading is not known.

    Robots without a place have NaN. ``to_map`` places more.
    """

    scene: Scene
    robots: Points
    metre: Points
    plans: list[Points]
    draft: Points
    cursor: Points
    to_map: Callable[[Points], Points]


class Placer:
    """Places scenes, each plan and each draft once for as long as the map keeps its CRS."""

    def __init__(self) -> None:
        self._placement: Placement | None = None
        self._plans: dict[Plan, Points] = {}
        self._of: list[Plan] | None = None
        self._ways: list[Points] = []
        """Where the plans lead, of those in the list of the scene before."""
        self._outline: object = None
        self._draft = _NOWHERE

    def placed(self, scene: Scene, placement: Placement) -> PlacedScene:
        """Place everything.

        :raises PlacementError: when a position has no place in the map's CRS.
        """
        if placement is not self._placement:
            self._placement, self._plans, self._of, self._outline = placement, {}, None, None
        known = self._plans
        new = [] if scene.plans is self._of else [plan for plan in scene.plans if plan not in known]
        outline = scene.draft.outline if scene.draft else ()
        is_known = outline is self._outline
        robots = scene.robots
        there = np.flatnonzero(np.isfinite(robots.xy[:, 0]) & np.isfinite(robots.xy[:, 1]))
        # To take rows with [] instead takes numpy ten times as long.
        known_places, metre = robots.xy.take(there, axis=0), _forward(robots.theta.take(there))
        axes = placement.axes
        parts = [
            known_places,
            known_places + metre if axes is None else metre[:0],
            _points(() if is_known else outline),
            _points([scene.cursor] if scene.cursor else ()),
            *[plan.points for plan in new],
        ]
        at, before, draft, cursor, *ways = _parted(placement.to_map(np.concatenate(parts)), parts)
        if scene.plans is not self._of:
            known.update(zip(new, ways, strict=True))
            self._plans = {plan: known[plan] for plan in scene.plans}
            self._of, self._ways = scene.plans, list(self._plans.values())
        if not is_known:
            self._outline, self._draft = outline, draft
        return PlacedScene(
            scene,
            _spread(at, there, len(robots.xy)),
            _spread(before - at if axes is None else metre @ axes, there, len(robots.xy)),
            self._ways,
            self._draft,
            cursor,
            placement.to_map,
        )


def _forward(theta: npt.NDArray[np.float64]) -> Points:
    """Return the way of 1 m in each heading, along x where it is not known."""
    # Floats of half the size are exact enough for a heading; numpy is ten times as fast with them.
    turn = theta.astype(np.float32)
    turn[np.isnan(turn)] = 0.0
    way = np.empty((len(turn), 2))
    way[:, 0], way[:, 1] = np.cos(turn), np.sin(turn)
    return way


def _parted(whole: Points, parts: list[Points]) -> list[Points]:
    """Return ``whole`` in pieces that are as long as ``parts``."""
    ends = accumulate(len(part) for part in parts)
    return [whole[end - len(part) : end] for end, part in zip(ends, parts, strict=True)]


def _spread(values: Points, rows: npt.NDArray[np.intp], count: int) -> Points:
    if len(rows) == count:
        return values
    out = np.full((count, 2), np.nan)
    out[rows] = values
    return out


def _points(points: Sequence[Point]) -> Points:
    return np.fromiter(chain.from_iterable(points), np.float64).reshape(-1, 2) if points else _NOWHERE
