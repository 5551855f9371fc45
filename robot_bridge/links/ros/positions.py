"""Poses, speeds and states out of ROS messages, as plain values; no I/O.

Messages are those of rosbags' type system: attributes by the names of the ROS fields. Whatever a node may
write is looked at: a fault names topic, field and value, and concerns that robot alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...messages import SendGPS
from ...messages.bounds import ACCURACY, ALTITUDE, COORDINATE, SPEED
from .errors import FaultError

CLOCK_OFF = 5.0
"""seconds that a robot's clock may be off before that is said."""
_NO_FIX = -1
"""NavSatStatus.STATUS_NO_FIX."""
_NO_ORIENTATION = -1.0
"""sensor_msgs/Imu: orientation_covariance[0] of a sensor that has none (REP 145)."""
_UNIT = 0.1
"""How far a rotation's quaternion may be from length 1."""
_STANDS = 1e-3
"""m/s below which a speed is rounding."""


@dataclass(frozen=True)
class FramePose:
    """A pose in a frame of the robot: metres, radians counter-clockwise from x, ``t`` seconds of its clock.

    ``v`` is m/s along its x axis (backwards is below 0), None where the message has no speed; ``accuracy`` is
    the standard deviation of the place in metres, None where the message says none.
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


def fix(message: Any, topic: str, heading: float | None) -> SendGPS:
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

    None where the sensor has no orientation. Raises FaultError.
    """
    if float(message.orientation_covariance[0]) == _NO_ORIENTATION:
        return None
    theta = yaw(message.orientation, f"{topic} (sensor_msgs/Imu)")
    return math.degrees(math.pi / 2 - theta) % 360.0


def battery_share(message: Any) -> float | None:
    """Return the charge of a sensor_msgs/BatteryState from 0 to 1, None where it does not say.

    ``percentage`` is from 0 to 1; drivers that write 0 to 100 are taken at their word above 1.
    """
    share = float(message.percentage)
    if not math.isfinite(share) or not 0.0 <= share <= 100.0:
        return None
    return share if share <= 1.0 else share / 100.0


def diagnosis(message: Any) -> str | None:
    """Return the worst of a diagnostic_msgs/DiagnosticArray as one text, None where all is well."""
    words = {1: "warning", 2: "error", 3: "stale"}
    worst = max(message.status, key=_severity, default=None)
    if worst is None or _severity(worst) == 0:
        return None
    said = f": {worst.message}" if worst.message else ""
    return f"{words.get(_level(worst), 'unknown level')}: {worst.name}{said}"


def yaw(q: Any, where: str) -> float:
    """Return the rotation of a quaternion about z, radians; raises FaultError for what is no rotation."""
    parts = [_number(getattr(q, name), f"orientation.{name}", where, (-2.0, 2.0)) for name in "xyzw"]
    if abs(math.hypot(*parts) - 1.0) > _UNIT:
        raise FaultError(f"{where}: orientation {tuple(parts)} is no rotation: its length is not 1")
    x, y, z, w = parts
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def stamp(header: Any) -> float | None:
    """Return a header's time in seconds, None where it was left 0."""
    at: float = header.stamp.sec + header.stamp.nanosec * 1e-9
    return at if at != 0 else None


def clock_remark(t: float | None, now: float) -> str | None:
    """Return what is to be said of a robot's clock; ``t`` and ``now`` are seconds since 1970."""
    if t is None or abs(now - t) <= CLOCK_OFF:
        return None
    way = "behind" if t < now else "ahead"
    simulated = ", which may be simulated time" if t < 1e9 else ""
    return f"its clock is {abs(now - t):.0f} s {way}{simulated}: its time stamps are told as they come"


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
    """Return the standard deviation of the place of a 6x6 covariance; all 0 means that nobody knows."""
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
    """Return how bad a status is: errors before what is stale, as rqt shows them."""
    return {0: 0, 1: 1, 3: 2, 2: 3}.get(_level(status), 1)
