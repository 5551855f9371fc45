"""What one robot says, message by message, as its state and as what the gateway is told; no I/O."""

from __future__ import annotations

import logging
import time
from dataclasses import replace
from typing import Any

from ...messages import MessageError, SendGPS, SendPos
from ...messages.bounds import SPEED
from ..base.frames import LinkFrame
from . import positions
from .errors import FaultError
from .names import TopicPattern
from .positions import FramePose
from .settings import RobotSettings
from .transforms import Transforms
from .types import FIX, ODOMETRY, POSE, POSE_WITH_COVARIANCE, READ, TF

log = logging.getLogger(__name__)

_POSES = {
    ODOMETRY: positions.odometry,
    POSE: positions.pose_stamped,
    POSE_WITH_COVARIANCE: positions.pose_with_covariance,
}
_SPEED_OVER = 0.3
"""seconds over which a speed is taken from positions that have none."""


class Sensing:
    """A robot's state. ``faults`` says what is wrong, by topic; what is right again is not in it."""

    def __init__(self, robot: str, settings: RobotSettings, frame: LinkFrame) -> None:
        self._robot = robot
        self._settings = settings
        self._frame = frame
        self._transforms = Transforms()
        self._heading: float | None = None
        self._battery: float | None = None
        self._from: tuple[float, float, float] | None = None
        """x, y and time of the position that a speed is taken from."""
        self._speed = 0.0
        self.diagnosis: str | None = None
        self.faults: dict[str, str] = {}
        self.pose: SendPos | None = None
        """Where it is in the site frame, None before that is known and where it tells by GPS."""
        self.fix: SendGPS | None = None
        """Where it is on the earth, None where it does not tell by GPS."""
        self.image: tuple[str, str, Any] | None = None
        """The image that came: topic, type, message."""
        self.wants_image = False
        """Whether an image is waited for; others are passed over."""
        self.own_pose: FramePose | None = None
        """Where it is in its own map frame."""

    def topics(self) -> dict[str, str]:
        """Return the robot's topics that are read, by what they are."""
        patterns = self._settings.patterns
        found = {kind: patterns[kind] for kind in READ if kind in patterns}
        if "tf" in patterns:
            found["tf_static"] = TopicPattern(f"{patterns['tf'].pattern}_static")
        return {kind: pattern.topic_of(self._robot) for kind, pattern in found.items()}

    def check_type(self, kind: str, topic: str, type_name: str | None, told: str) -> str | None:
        """Return a topic's type if it can be read as what it is; else None, and it is a fault.

        ``told`` is the type as the network has it.
        """
        if type_name in READ[kind]:
            return type_name
        self.fault(topic, f"{topic} has type {told[:80]}; {kind} is one of {', '.join(READ[kind])}")
        return None

    def receive(self, kind: str, topic: str, type_name: str, message: Any) -> SendPos | SendGPS | None:
        """Take in a message; return the position that it told, None where it told none that can be used."""
        if kind == "image":
            self.image = (topic, type_name, message) if self.wants_image else None
            return None
        try:
            told = self._read(kind, topic, type_name, message)
        except (FaultError, MessageError) as error:
            self.refuse(topic, error)
            return None
        if kind != "position" or told is not None:
            self.faults.pop(topic, None)
        return told

    def refuse(self, topic: str, error: Exception) -> None:
        """Note that a message of a topic cannot be used."""
        text = str(error)
        self.fault(topic, text if topic in text else f"{topic}: {text}")

    def fault(self, what: str, text: str) -> None:
        """Note what is wrong; it is logged once."""
        if what not in self.faults:
            log.warning("robot %s: %s", self._robot, text)
        self.faults[what] = text

    def _read(self, kind: str, topic: str, type_name: str, message: Any) -> SendPos | SendGPS | None:
        if type_name == TF:
            self._transforms.update(message, topic)
            base = self._settings.base_frame_of(self._robot)
            pose = self._transforms.pose_of(base, self._settings.map_frame) if kind == "position" else None
            return None if pose is None else self._placed(pose)
        if kind == "imu":
            self._heading = positions.imu_heading(message, topic)
        elif kind == "battery":
            self._battery = positions.battery_share(message)
        elif kind == "diagnostics":
            self.diagnosis = positions.diagnosis(message)
        elif type_name == FIX:
            self._clock(positions.stamp(message.header))
            fix = positions.fix(message, topic, self._heading)
            self.fix = replace(fix, battery=self._battery)
            return self.fix
        else:
            pose = _POSES[type_name](message, topic)
            return self._placed(self._transforms.pose_in(self._settings.map_frame, pose))
        return None

    def _placed(self, pose: FramePose) -> SendPos:
        """Return a pose in the robot's map frame as the gateway is told it."""
        self._clock(pose.t)
        try:
            x, y, theta = self._frame.pose_to_site(pose.x, pose.y, pose.theta)
        except ValueError as error:
            raise FaultError(f"its position {error}") from None
        self.own_pose = pose
        self.pose = SendPos(
            x=x,
            y=y,
            theta=theta,
            v=self._speed_at(pose) if pose.v is None else pose.v,
            t=pose.t,
            battery=self._battery,
            accuracy=pose.accuracy,
        )
        return self.pose

    def _speed_at(self, pose: FramePose) -> float:
        """Return the speed over ground, m/s, of a robot whose positions tell none."""
        now = time.monotonic()
        if self._from is None:
            self._from = (pose.x, pose.y, now)
        x, y, since = self._from
        if now - since >= _SPEED_OVER:
            moved = ((pose.x - x) ** 2 + (pose.y - y) ** 2) ** 0.5
            self._speed = min(moved / (now - since), SPEED[1])
            self._from = (pose.x, pose.y, now)
        return self._speed

    def _clock(self, t: float | None) -> None:
        remark = positions.clock_remark(t, time.time())
        if remark is None:
            self.faults.pop("clock", None)
        elif "clock" not in self.faults:
            self.fault("clock", remark)
