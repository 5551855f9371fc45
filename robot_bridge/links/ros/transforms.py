"""Where a robot's frames are in each other: the transforms of tf2, on the plane; no I/O.

The newest transform counts: positions are told as they come, and none is looked up in the past.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...messages.bounds import COORDINATE
from .errors import FaultError
from .positions import FramePose, stamp, yaw

MOST_FRAMES = 1000
"""frames of one robot that are remembered; a humanoid has a hundred."""
DEEPEST = 50
"""transforms between a frame and the one that is asked for."""


@dataclass(frozen=True)
class Transform:
    """Where a frame is in its ``parent``: metres, radians; ``t`` is seconds of the robot's clock."""

    parent: str
    x: float
    y: float
    theta: float
    t: float | None


class Transforms:
    """The tree of one robot's frames."""

    def __init__(self) -> None:
        self._of: dict[str, Transform] = {}

    def update(self, message: Any, topic: str) -> bool:
        """Take in a tf2_msgs/TFMessage; tell whether anything was new. Raises FaultError."""
        for one in message.transforms:
            child, parent = one.child_frame_id.lstrip("/"), one.header.frame_id.lstrip("/")
            where = f"{topic} (tf2_msgs/TFMessage), {parent[:60]!r} to {child[:60]!r}"
            if child not in self._of and len(self._of) >= MOST_FRAMES:
                raise FaultError(f"{where}: more than {MOST_FRAMES} frames")
            place = one.transform.translation
            if not all(COORDINATE[0] <= float(value) <= COORDINATE[1] for value in (place.x, place.y)):
                raise FaultError(f"{where}: translation {place.x}, {place.y} is no place")
            self._of[child] = Transform(
                parent, float(place.x), float(place.y), yaw(one.transform.rotation, where), stamp(one.header)
            )
        return bool(message.transforms)

    def pose_in(self, frame: str, pose: FramePose) -> FramePose:
        """Return ``pose`` in ``frame``; raises FaultError where nothing connects the two."""
        x, y, theta, at = pose.x, pose.y, pose.theta, pose.frame
        for _ in range(DEEPEST):
            if at == frame:
                return FramePose(frame, x, y, math.remainder(theta, math.tau), pose.t, pose.v, pose.accuracy)
            step = self._of.get(at)
            if step is None:
                break
            c, s = math.cos(step.theta), math.sin(step.theta)
            x, y, theta = step.x + c * x - s * y, step.y + s * x + c * y, theta + step.theta
            at = step.parent
        why = "its transforms run in a circle" if at in self._of else f"nothing is known of {at[:60]!r}"
        raise FaultError(
            f"frame {pose.frame[:60]!r} is not connected with {frame[:60]!r}: {why}; have the robot publish "
            "the transform on its tf topic, or name its frame in map_frame"
        )

    def pose_of(self, child: str, frame: str) -> FramePose | None:
        """Return where frame ``child`` is in ``frame``, None before that is known."""
        step = self._of.get(child)
        if step is None:
            return None
        try:
            return self.pose_in(frame, FramePose(child, 0.0, 0.0, 0.0, step.t))
        except FaultError:
            return None
