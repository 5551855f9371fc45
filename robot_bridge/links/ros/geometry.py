"""Targets, paths and maps of the site frame as ROS messages in a robot's map frame; no I/O."""

from __future__ import annotations

import math
import time
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...messages import SetPath, SetPosEnd, SetPosIni
from ...robotmap.binary import decode
from ...robotmap.exporters.grid import Grid
from ...robotmap.exporters.occupancy import occupancy_of
from ..base.frames import LinkFrame
from .effects import Action
from .types import FILTER_INFO, GRID, PATH, POSE, POSE_WITH_COVARIANCE

Pose = tuple[float, float, float]
MOST_CELLS = 16_000_000
"""cells of a grid that is published: 16 MB, which DDS carries in some hundred milliseconds."""
_START_COVARIANCE = np.zeros(36)
_START_COVARIANCE[[0, 7, 35]] = 0.25, 0.25, 0.07
"""m², m², rad²: how sure a start is, as RViz says it."""


class Messages(Protocol):
    """Makes messages as the way to the robot carries them."""

    def knows(self, type_name: str) -> bool:
        """Tell whether the robots' distribution has a type."""

    def make(self, type_name: str, **fields: Any) -> Any:
        """Return a message; fields that are left out are zero, empty, or made of such."""


def end_pose(order: SetPosEnd | SetPath, here: Pose | None) -> Pose:
    """Return where an order ends, in the site frame; Nav2 wants a heading, so one that is open is made up.

    That is the direction in which the robot comes: from the point before, or from where it is.
    """
    if isinstance(order, SetPath):
        (x, y), (from_x, from_y) = order.points[-1], order.points[-2]
    else:
        x, y = order.x, order.y
        from_x, from_y = here[:2] if here is not None else (x, y)
    if order.theta is not None:
        return x, y, order.theta
    if math.hypot(x - from_x, y - from_y) < 1e-6:
        return x, y, here[2] if here is not None else 0.0
    return x, y, math.atan2(y - from_y, x - from_x)


def path_poses(order: SetPath) -> list[Pose]:
    """Return the poses of a path, in the site frame: each looks to the next."""
    points = order.points
    ahead = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(points)]
    return [(*point, theta) for point, theta in zip(points[:-1], ahead, strict=True)] + [
        end_pose(order, None)
    ]


class Outgoing:
    """Makes messages in the map frame of a link's robots. Raises ValueError for what has no place there."""

    def __init__(self, types: Messages, frame: LinkFrame, map_frame: str) -> None:
        self._types = types
        self._frame = frame
        self._map_frame = map_frame

    def pose_stamped(self, pose: Pose) -> Any:
        """Return a geometry_msgs/PoseStamped."""
        return self._types.make(POSE, header=self._header(), pose=self._pose(pose))

    def path(self, order: SetPath) -> Any:
        """Return a nav_msgs/Path."""
        poses = [self.pose_stamped(pose) for pose in path_poses(order)]
        return self._types.make(PATH, header=self._header(), poses=poses)

    def goal(self, action: Action, order: SetPosEnd | SetPath, here: Pose | None) -> dict[str, Any]:
        """Return the fields of a goal; ``here`` is where the robot is."""
        if action is Action.TO_POSE:
            return {"pose": self.pose_stamped(end_pose(order, here))}
        assert isinstance(order, SetPath), "a target has no path"
        if action is Action.FOLLOW_PATH:
            return {"path": self.path(order)}
        poses = [self.pose_stamped(pose) for pose in path_poses(order)]
        if action is Action.THROUGH_POSES and self._types.knows("nav_msgs/msg/Goals"):
            return {"poses": self._types.make("nav_msgs/msg/Goals", header=self._header(), goals=poses)}
        return {"poses": poses}

    def start(self, order: SetPosIni, here: Pose | None) -> Any:
        """Return a geometry_msgs/PoseWithCovarianceStamped: where the robot is to take itself to be."""
        theta = order.theta if order.theta is not None else (here[2] if here is not None else 0.0)
        pose = self._types.make(
            "geometry_msgs/msg/PoseWithCovariance",
            pose=self._pose((order.x, order.y, theta)),
            covariance=_START_COVARIANCE,
        )
        return self._types.make(POSE_WITH_COVARIANCE, header=self._header(), pose=pose)

    def grid(self, robot_map: bytes, resolution: float) -> Any:
        """Return a nav_msgs/OccupancyGrid of a robot map; raises RobotMapError and GridError, too."""
        occupancy = occupancy_of(decode(robot_map), resolution, limit=MOST_CELLS)
        return self.cells(occupancy.grid, occupancy.cells)

    def cells(self, grid: Grid, cells: NDArray[Any]) -> Any:
        """Return a nav_msgs/OccupancyGrid of (rows, columns) int8, row 0 the lowest."""
        info = self._types.make(
            "nav_msgs/msg/MapMetaData",
            map_load_time=self._now(),
            resolution=grid.resolution,
            width=grid.columns,
            height=grid.rows,
            origin=self._pose((grid.x_min, grid.y_min, 0.0)),
        )
        data = np.ascontiguousarray(cells, dtype=np.int8).reshape(-1)
        return self._types.make(GRID, header=self._header(), info=info, data=data)

    def filter_info(self, kind: int, topic: str, multiplier: float) -> Any:
        """Return a nav2_msgs/CostmapFilterInfo of the mask on ``topic``."""
        fields = {"type": kind, "filter_mask_topic": topic, "base": 0.0, "multiplier": multiplier}
        return self._types.make(FILTER_INFO, header=self._header(), **fields)

    def _now(self) -> Any:
        sec, nanosec = divmod(time.time_ns(), 1_000_000_000)
        return self._types.make("builtin_interfaces/msg/Time", sec=sec, nanosec=nanosec)

    def _header(self) -> Any:
        return self._types.make("std_msgs/msg/Header", stamp=self._now(), frame_id=self._map_frame)

    def _pose(self, pose: Pose) -> Any:
        x, y, theta = self._frame.pose_from_site(*pose)
        position = self._types.make("geometry_msgs/msg/Point", x=x, y=y)
        turned = self._types.make(
            "geometry_msgs/msg/Quaternion", z=math.sin(theta / 2), w=math.cos(theta / 2)
        )
        return self._types.make("geometry_msgs/msg/Pose", position=position, orientation=turned)
