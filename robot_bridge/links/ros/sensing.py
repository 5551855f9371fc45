"""Sensing: poses, speeds, transforms and states of one robot from ROS messages."""

from __future__ import annotations

import logging
import math
import time
from dataclasses import dataclass, replace
from typing import Any

from ...core.messages.base import ACCURACY, ALTITUDE, COORDINATE, SPEED, MessageError
from ...core.messages.robots import SendGPS, SendPos
from ..base.frames import LinkFrame
from .errors import FaultError
from .messages import FIX, ODOMETRY, POSE, POSE_WITH_COVARIANCE, READ, TF
from .settings import RobotSettings, TopicPattern

# --- Poses, speeds and states from ROS messages, as plain values; no I/O ---
# Messages are those of rosbags' type system: attributes by the names of the ROS fields. All values that a
# node may write are checked: a fault names topic, field and value, and affects that robot alone.

CLOCK_OFF = 5.0
"""seconds that a robot's clock may be off before that is reported."""
_NO_FIX = -1
"""NavSatStatus.STATUS_NO_FIX."""
_NO_ORIENTATION = -1.0
"""sensor_msgs/Imu: orientation_covariance[0] of a sensor that has none (REP 145)."""
_UNIT = 0.1
"""Tolerance of a quaternion's length around 1."""
_STANDS = 1e-3
"""m/s below which a speed is rounding."""


@dataclass(frozen=True)
class FramePose:
    """A pose in a frame of the robot: metres, radians counter-clockwise from x, ``t`` seconds of its clock.

    ``v`` is m/s along its x axis (backwards is below 0), None if the message has no speed; ``accuracy`` is
    the standard deviation of the place in metres, None if the message has none.
    """

    frame: str
    x: float
    y: float
    theta: float
    t: float | None
    v: float | None = None
    accuracy: float | None = None


def odometry(message: Any, topic: str) -> FramePose:
    """Return the pose of a nav_msgs/Odometry; raises FaultError."""
    twist = message.twist.twist.linear
    where = f"{topic} (nav_msgs/Odometry)"
    v = math.hypot(
        _number(twist.x, "twist.linear.x", where, SPEED), _number(twist.y, "twist.linear.y", where, SPEED)
    )
    return _pose(
        message.header,
        message.pose.pose,
        where,
        v=0.0 if v < _STANDS else math.copysign(v, twist.x if abs(twist.x) >= abs(twist.y) else 1.0),
        accuracy=_accuracy(message.pose.covariance),
    )


def pose_stamped(message: Any, topic: str) -> FramePose:
    """Return the pose of a geometry_msgs/PoseStamped; raises FaultError."""
    return _pose(message.header, message.pose, f"{topic} (geometry_msgs/PoseStamped)")


def pose_with_covariance(message: Any, topic: str) -> FramePose:
    """Return the pose of a geometry_msgs/PoseWithCovarianceStamped; raises FaultError."""
    return _pose(
        message.header,
        message.pose.pose,
        f"{topic} (geometry_msgs/PoseWithCovarianceStamped)",
        accuracy=_accuracy(message.pose.covariance),
    )


def gps_fix(message: Any, topic: str, heading: float | None) -> SendGPS:
    """Return a sensor_msgs/NavSatFix with the ``heading`` of an Imu, degrees; raises FaultError."""
    where = f"{topic} (sensor_msgs/NavSatFix)"
    if message.status.status <= _NO_FIX:
        raise FaultError(f"{where}: the receiver has no fix (status {message.status.status})")
    altitude = float(message.altitude)
    known = message.position_covariance_type != 0
    covariance = message.position_covariance
    accuracy = _deviation(float(covariance[0]), float(covariance[4])) if known else None
    return SendGPS(
        lat=_number(message.latitude, "latitude", where, (-90.0, 90.0)),
        lon=_number(message.longitude, "longitude", where, (-180.0, 180.0)),
        altitude=altitude if math.isfinite(altitude) and ALTITUDE[0] <= altitude <= ALTITUDE[1] else None,
        heading=heading,
        accuracy=accuracy,
        fix_t=stamp(message.header),
    )


def imu_heading(message: Any, topic: str) -> float | None:
    """Return degrees clockwise from north of a sensor_msgs/Imu whose world is east-north-up (REP 103).

    None if the sensor has no orientation. Raises FaultError.
    """
    if float(message.orientation_covariance[0]) == _NO_ORIENTATION:
        return None
    theta = yaw(message.orientation, f"{topic} (sensor_msgs/Imu)")
    return math.degrees(math.pi / 2 - theta) % 360.0


def battery_share(message: Any) -> float | None:
    """Return the charge of a sensor_msgs/BatteryState from 0 to 1, None if unknown.

    ``percentage`` is from 0 to 1; values above 1 are read as per cent, as written by some drivers.
    """
    share = float(message.percentage)
    if not math.isfinite(share) or not 0.0 <= share <= 100.0:
        return None
    return share if share <= 1.0 else share / 100.0


def diagnosis(message: Any) -> str | None:
    """Return the worst status of a diagnostic_msgs/DiagnosticArray as one text, None if all is well."""
    words = {1: "warning", 2: "error", 3: "stale"}
    worst = max(message.status, key=_severity, default=None)
    if worst is None or _severity(worst) == 0:
        return None
    remark = f": {worst.message}" if worst.message else ""
    return f"{words.get(_level(worst), 'unknown level')}: {worst.name}{remark}"


def yaw(q: Any, where: str) -> float:
    """Return the rotation of a quaternion about z, radians; raises FaultError for an invalid rotation."""
    parts = [_number(getattr(q, name), f"orientation.{name}", where, (-2.0, 2.0)) for name in "xyzw"]
    if abs(math.hypot(*parts) - 1.0) > _UNIT:
        raise FaultError(f"{where}: orientation {tuple(parts)} is no rotation: its length is not 1")
    x, y, z, w = parts
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def stamp(header: Any) -> float | None:
    """Return a header's time in seconds, None if it is 0."""
    at: float = header.stamp.sec + header.stamp.nanosec * 1e-9
    return at if at != 0 else None


def clock_remark(t: float | None, now: float) -> str | None:
    """Return a remark on a robot's wrong clock, or None; ``t`` and ``now`` are seconds since 1970."""
    if t is None or abs(now - t) <= CLOCK_OFF:
        return None
    way = "behind" if t < now else "ahead"
    simulated = ", which may be simulated time" if t < 1e9 else ""
    return f"its clock is {abs(now - t):.0f} s {way}{simulated}: its time stamps are passed on as they come"


def _pose(
    header: Any, pose: Any, where: str, v: float | None = None, accuracy: float | None = None
) -> FramePose:
    return FramePose(
        header.frame_id.lstrip("/"),
        _number(pose.position.x, "position.x", where, COORDINATE),
        _number(pose.position.y, "position.y", where, COORDINATE),
        yaw(pose.orientation, where),
        stamp(header),
        v,
        accuracy,
    )


def _number(value: Any, name: str, where: str, bounds: tuple[float, float]) -> float:
    number = float(value)
    if not bounds[0] <= number <= bounds[1]:
        raise FaultError(
            f"{where}: {name} is {number}; a number from {bounds[0]:g} to {bounds[1]:g} is taken"
        )
    return number


def _accuracy(covariance: Any) -> float | None:
    """Return the standard deviation of the place of a 6x6 covariance; all 0 means unknown."""
    return _deviation(float(covariance[0]), float(covariance[7]))


def _deviation(x: float, y: float) -> float | None:
    largest = max(x, y)
    if not (math.isfinite(largest) and largest > 0.0 and math.sqrt(largest) <= ACCURACY[1]):
        return None
    return math.sqrt(largest)


def _level(status: Any) -> int:
    """Return a status's level, which is a byte: a number, or bytes of length 1."""
    level = status.level
    return level[0] if isinstance(level, (bytes, bytearray)) else int(level)


def _severity(status: Any) -> int:
    """Return how bad a status is: errors before stale ones, as in rqt."""
    return {0: 0, 1: 1, 3: 2, 2: 3}.get(_level(status), 1)


# --- Transforms between a robot's frames, of tf2, in the plane; no I/O ---
# The newest transform counts: positions are reported as they come, and none is looked up in the past.

MOST_FRAMES = 1000
"""frames of one robot that are remembered; a humanoid has a hundred."""
DEEPEST = 50
"""transforms between a frame and the requested one."""


@dataclass(frozen=True)
class Transform:
    """The pose of a frame in its ``parent``: metres, radians; ``t`` is seconds of the robot's clock."""

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
        """Apply a tf2_msgs/TFMessage; return whether anything was new. Raises FaultError."""
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
        """Return ``pose`` in ``frame``; raises FaultError if they are not connected."""
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
        """Return the pose of frame ``child`` in ``frame``, None while unknown."""
        step = self._of.get(child)
        if step is None:
            return None
        try:
            return self.pose_in(frame, FramePose(child, 0.0, 0.0, 0.0, step.t))
        except FaultError:
            return None


# --- One robot's state from its messages, and its reports to the gateway; no I/O ---

log = logging.getLogger(__name__)

_POSES = {
    ODOMETRY: odometry,
    POSE: pose_stamped,
    POSE_WITH_COVARIANCE: pose_with_covariance,
}
_SPEED_OVER = 0.3
"""seconds over which a speed is computed from positions without one."""


class Sensing:
    """A robot's state. ``faults`` are the present faults by topic."""

    def __init__(self, robot: str, settings: RobotSettings, frame: LinkFrame) -> None:
        self._robot = robot
        self._settings = settings
        self._frame = frame
        self._transforms = Transforms()
        self._heading: float | None = None
        self._battery: float | None = None
        self._from: tuple[float, float, float] | None = None
        """x, y and time of the position from which a speed is computed."""
        self._speed = 0.0
        self.diagnosis: str | None = None
        self.faults: dict[str, str] = {}
        self.pose: SendPos | None = None
        """Its pose in the site frame, None while unknown and for a robot with GPS."""
        self.fix: SendGPS | None = None
        """Its GPS position, None for a robot without GPS."""
        self.image: tuple[str, str, Any] | None = None
        """The received image: topic, type, message."""
        self.wants_image = False
        """Whether an image is awaited; others are ignored."""

    def topics(self) -> dict[str, str]:
        """Return the robot's subscribed topics, by kind."""
        patterns = self._settings.patterns
        found = {kind: patterns[kind] for kind in READ if kind in patterns}
        if "tf" in patterns:
            found["tf_static"] = TopicPattern(f"{patterns['tf'].pattern}_static")
        return {kind: pattern.topic_of(self._robot) for kind, pattern in found.items()}

    def check_type(self, kind: str, topic: str, type_name: str | None, declared: str) -> str | None:
        """Return a topic's type if readable as its kind; else None, which is recorded as a fault.

        ``declared`` is the type on the network.
        """
        if type_name in READ[kind]:
            return type_name
        self.fault(topic, f"{topic} has type {declared[:80]}; {kind} is one of {', '.join(READ[kind])}")
        return None

    def receive(self, kind: str, topic: str, type_name: str, message: Any) -> SendPos | SendGPS | None:
        """Process a message; return its position, None without a usable one."""
        if kind == "image":
            self.image = (topic, type_name, message) if self.wants_image else None
            return None
        try:
            reading = self._read(kind, topic, type_name, message)
        except (FaultError, MessageError) as error:
            self.refuse(topic, error)
            return None
        if kind != "position" or reading is not None:
            self.faults.pop(topic, None)
        return reading

    def refuse(self, topic: str, error: Exception) -> None:
        """Record that a message of a topic cannot be used."""
        text = str(error)
        self.fault(topic, text if topic in text else f"{topic}: {text}")

    def fault(self, what: str, text: str) -> None:
        """Record a fault; it is logged once."""
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
            self._heading = imu_heading(message, topic)
        elif kind == "battery":
            self._battery = battery_share(message)
        elif kind == "diagnostics":
            self.diagnosis = diagnosis(message)
        elif type_name == FIX:
            self._clock(stamp(message.header))
            fix = gps_fix(message, topic, self._heading)
            self.fix = replace(fix, battery=self._battery)
            return self.fix
        else:
            pose = _POSES[type_name](message, topic)
            return self._placed(self._transforms.pose_in(self._settings.map_frame, pose))
        return None

    def _placed(self, pose: FramePose) -> SendPos:
        """Return a pose in the robot's map frame as reported to the gateway."""
        self._clock(pose.t)
        try:
            x, y, theta = self._frame.pose_to_site(pose.x, pose.y, pose.theta)
        except ValueError as error:
            raise FaultError(f"its position {error}") from None
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
        """Return the speed over ground, m/s, of a robot whose positions have none."""
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
        remark = clock_remark(t, time.time())
        if remark is None:
            self.faults.pop("clock", None)
        elif "clock" not in self.faults:
            self.fault("clock", remark)
