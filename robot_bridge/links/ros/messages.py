"""ROS messages: types, targets, paths and maps in a robot's map frame; images decoded."""

from __future__ import annotations

import math
import time
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.images import encode_png, media_type_of
from ...core.messages.base import MessageError
from ...core.messages.robots import SetPath, SetPosEnd, SetPosIni
from ...core.robotmap.binary import decode
from ...core.robotmap.exporters.nav2 import RasterGrid, occupancy_of
from ..base.frames import LinkFrame
from .effects import RosAction
from .errors import FaultError

# --- ROS types read and written, by the settings of their topics ---

ODOMETRY = "nav_msgs/msg/Odometry"
POSE = "geometry_msgs/msg/PoseStamped"
POSE_WITH_COVARIANCE = "geometry_msgs/msg/PoseWithCovarianceStamped"
FIX = "sensor_msgs/msg/NavSatFix"
TF = "tf2_msgs/msg/TFMessage"
IMU = "sensor_msgs/msg/Imu"
BATTERY = "sensor_msgs/msg/BatteryState"
DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
GRID = "nav_msgs/msg/OccupancyGrid"
FILTER_INFO = "nav2_msgs/msg/CostmapFilterInfo"
GET_MAP = "nav_msgs/srv/GetMap"
PATH = "nav_msgs/msg/Path"
TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
GOAL_STATUSES = "action_msgs/msg/GoalStatusArray"
CANCEL_GOAL = "action_msgs/srv/CancelGoal"
TRIGGER = "std_srvs/srv/Trigger"

READ: dict[str, tuple[str, ...]] = {
    "position": (ODOMETRY, POSE, POSE_WITH_COVARIANCE, FIX, TF),
    "imu": (IMU,),
    "tf": (TF,),
    "tf_static": (TF,),
    "battery": (BATTERY,),
    "diagnostics": (DIAGNOSTICS,),
    "image": (COMPRESSED_IMAGE, IMAGE),
}
WRITTEN: dict[str, tuple[str, ...]] = {
    "goal_pose": (POSE,),
    "path": (PATH,),
    "initial_pose": (POSE_WITH_COVARIANCE,),
    "cmd_vel": (TWIST, TWIST_STAMPED),
}
LATCHED = {
    "map": GRID,
    "keepout_mask": GRID,
    "keepout_info": FILTER_INFO,
    "speed_mask": GRID,
    "speed_info": FILTER_INFO,
}
"""Topics published once, latched for later subscribers."""
ACTIONS = {
    RosAction.TO_POSE: "navigate_to_pose",
    RosAction.THROUGH_POSES: "navigate_through_poses",
    RosAction.FOLLOW_PATH: "follow_path",
    RosAction.WAYPOINTS: "follow_waypoints",
}
SERVICES = ("stop", "place_cone")
"""of type Trigger."""


def action_type(action: RosAction) -> str:
    """Return the full name of an action's type."""
    return f"nav2_msgs/action/{action.value}"


# --- Targets, paths and maps of the site frame as ROS messages in a robot's map frame; no I/O ---

Pose = tuple[float, float, float]
MOST_CELLS = 16_000_000
"""cells of a published grid: 16 MB, which DDS carries in some hundred milliseconds."""
_START_COVARIANCE = np.zeros(36)
_START_COVARIANCE[[0, 7, 35]] = 0.25, 0.25, 0.07
"""m², m², rad²: covariance of an initial pose, as sent by RViz."""


class Messages(Protocol):
    """Builds messages in the form of the robot's transport."""

    def knows(self, type_name: str) -> bool:
        """Return whether the robots' distribution has a type."""

    def make(self, type_name: str, **fields: Any) -> Any:
        """Return a message; omitted fields are zero, empty, or built of such."""


def end_pose(order: SetPosEnd | SetPath, here: Pose | None) -> Pose:
    """Return the end pose of an order, in the site frame; Nav2 needs a heading, so an open one is chosen.

    It is the direction of approach: from the previous point, or from the robot's position.
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
    """Return the poses of a path, in the site frame: each faces the next."""
    points = order.points
    ahead = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(points)]
    return [(*point, theta) for point, theta in zip(points[:-1], ahead, strict=True)] + [
        end_pose(order, None)
    ]


class Outgoing:
    """Builds messages in the map frame of a link's robots. Raises ValueError for unconvertible places."""

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

    def goal(self, action: RosAction, order: SetPosEnd | SetPath, here: Pose | None) -> dict[str, Any]:
        """Return the fields of a goal; ``here`` is the robot's pose."""
        if action is RosAction.TO_POSE:
            return {"pose": self.pose_stamped(end_pose(order, here))}
        assert isinstance(order, SetPath), "a target has no path"
        if action is RosAction.FOLLOW_PATH:
            return {"path": self.path(order)}
        poses = [self.pose_stamped(pose) for pose in path_poses(order)]
        if action is RosAction.THROUGH_POSES and self._types.knows("nav_msgs/msg/Goals"):
            return {"poses": self._types.make("nav_msgs/msg/Goals", header=self._header(), goals=poses)}
        return {"poses": poses}

    def start(self, order: SetPosIni, here: Pose | None) -> Any:
        """Return a geometry_msgs/PoseWithCovarianceStamped: the robot's initial pose."""
        theta = order.theta if order.theta is not None else (here[2] if here is not None else 0.0)
        pose = self._types.make(
            "geometry_msgs/msg/PoseWithCovariance",
            pose=self._pose((order.x, order.y, theta)),
            covariance=_START_COVARIANCE,
        )
        return self._types.make(POSE_WITH_COVARIANCE, header=self._header(), pose=pose)

    def grid(self, robot_map: bytes, resolution: float) -> Any:
        """Return a nav_msgs/OccupancyGrid of a robot map; raises RobotMapError and ExportGridError, too."""
        occupancy = occupancy_of(decode(robot_map), resolution, limit=MOST_CELLS)
        return self.cells(occupancy.grid, occupancy.cells)

    def cells(self, grid: RasterGrid, cells: NDArray[Any]) -> Any:
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


# --- Images from ROS messages for the gateway: JPEG, PNG or WebP of a bounded size; no I/O

MOST_PIXELS = 640 * 480
"""pixels of an uncompressed image: of a larger one every second, third ... pixel is used."""
COARSEST = 16
"""largest step in pixels per side."""
_ENCODINGS: dict[str, tuple[int, list[int]]] = {
    "rgb8": (3, [0, 1, 2]),
    "bgr8": (3, [2, 1, 0]),
    "8UC3": (3, [2, 1, 0]),
    "rgba8": (4, [0, 1, 2]),
    "bgra8": (4, [2, 1, 0]),
    "8UC4": (4, [2, 1, 0]),
    "mono8": (1, [0]),
    "8UC1": (1, [0]),
}
"""Bytes per pixel, and the indices of red, green and blue, or grey."""


def image_of(type_name: str, message: Any, largest: int) -> bytes:
    """Return the image in a sensor_msgs/Image or CompressedImage, at most ``largest`` bytes.

    :raises FaultError: for an invalid image, another encoding, or one that cannot be made small enough.
    """
    if type_name == COMPRESSED_IMAGE:
        return _compressed(message, largest)
    pixels = _pixels(message)
    rows, columns = pixels.shape[:2]
    step = max(1, math.ceil(math.sqrt(rows * columns / MOST_PIXELS)))
    while step <= COARSEST:
        image = encode_png(np.ascontiguousarray(pixels[::step, ::step]))
        if len(image) <= largest:
            return image
        step += 1
    raise FaultError(f"its image of {columns} x {rows} pixels does not become smaller than {largest} bytes")


def _compressed(message: Any, largest: int) -> bytes:
    image = bytes(message.data)
    if len(image) > largest:
        raise FaultError(
            f"its image has {len(image)} bytes, and {largest} are taken; have it compressed more, or give "
            "more with largest_image_bytes"
        )
    try:
        media_type_of(image)
    except MessageError:
        raise FaultError(
            f"its image is {str(message.format)[:40]!r}, which is neither JPEG, PNG nor WebP"
        ) from None
    return image


def _pixels(message: Any) -> np.ndarray[Any, Any]:
    """Return the pixels of a sensor_msgs/Image, (rows, columns) or (rows, columns, 3)."""
    encoding = str(message.encoding)
    if encoding not in _ENCODINGS:
        known = ", ".join(_ENCODINGS)
        raise FaultError(f"its image is encoded as {encoding[:40]!r}; known are {known}")
    size, order = _ENCODINGS[encoding]
    rows, columns, line = int(message.height), int(message.width), int(message.step)
    if rows < 1 or columns < 1 or line < columns * size or len(message.data) < rows * line:
        raise FaultError(
            f"its image says {columns} x {rows} pixels in lines of {line} bytes, and has "
            f"{len(message.data)} bytes"
        )
    data = np.asarray(message.data, dtype=np.uint8)[: rows * line].reshape(rows, line)
    pixels = data[:, : columns * size].reshape(rows, columns, size)[..., order]
    return pixels[..., 0] if len(order) == 1 else pixels
