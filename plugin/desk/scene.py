"""What is to be seen on the canvas, in the site frame, and the same placed in the map's CRS."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from .drafts import Draft, Point
from .picture import RobotArrays
from .placement import Placement

Points = npt.NDArray[np.float64]
AHEAD = 1.0
"""Metres to the second point that shows a heading in whatever CRS the map has."""


@dataclass(frozen=True)
class Target:
    """Where a robot is going; ``cone`` when it places one there."""

    robot: str
    point: Point
    cone: bool


@dataclass(frozen=True)
class Scene:
    """Everything live, in the site frame."""

    robots: RobotArrays
    ages: list[float]
    selected: str | None = None
    trails: list[Points] = field(default_factory=list)
    targets: list[Target] = field(default_factory=list)
    paths: list[Points] = field(default_factory=list)
    draft: Draft | None = None
    cursor: Point | None = None


@dataclass(frozen=True)
class PlacedScene:
    """The same in the map's CRS: (n, 2) coordinates for each part; ``ahead`` is 1 m before each robot."""

    scene: Scene
    robots: Points
    ahead: Points
    trails: list[Points]
    targets: Points
    paths: list[Points]
    draft: Points
    cursor: Points


def placed(scene: Scene, placement: Placement) -> PlacedScene:
    """Place everything in one transformation.

    :raises PlacementError: when a position has no place in the map's CRS.
    """
    theta = scene.robots.theta
    step = np.column_stack([np.cos(theta), np.sin(theta)]) * AHEAD
    parts = [
        scene.robots.xy,
        scene.robots.xy + np.nan_to_num(step),
        _points([target.point for target in scene.targets]),
        _points(scene.draft.points if scene.draft else ()),
        _points([scene.cursor] if scene.cursor else ()),
        *[trail[:, :2] for trail in scene.trails],
        *scene.paths,
    ]
    ends = np.cumsum([len(part) for part in parts])[:-1]
    out = np.split(placement.to_map(np.concatenate(parts)), ends)
    robots, ahead, targets, draft, cursor = out[:5]
    trails = out[5 : 5 + len(scene.trails)]
    paths = out[5 + len(scene.trails) :]
    return PlacedScene(scene, robots, ahead, trails, targets, paths, draft, cursor)


def _points(points: object) -> Points:
    return np.array(points, dtype=np.float64).reshape(-1, 2)
