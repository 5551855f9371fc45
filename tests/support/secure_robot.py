"""A robot on Cyclone DDS with typed messages, without ROS: it tells where it is, and goes where it is sent.

Runs in the environment of stage.secure_dds. With an enclave it is a member of DDS Security, as
rmw_cyclonedds_cpp makes a node one; without, it believes everybody. Cyclone DDS reads the annotations, so
they are no texts.
"""

import argparse
import json
import time
from dataclasses import dataclass, field
from pathlib import Path

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float64, int32, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

EVERY = 0.1


def _message(package: str, name: str) -> str:
    return f"{package}::msg::dds_::{name}_"


@dataclass
class Time(IdlStruct, typename=_message("builtin_interfaces", "Time")):
    """Seconds and nanoseconds."""

    sec: int32 = 0
    nanosec: uint32 = 0


@dataclass
class Header(IdlStruct, typename=_message("std_msgs", "Header")):
    """Time and frame."""

    stamp: Time = field(default_factory=Time)
    frame_id: str = "map"


@dataclass
class Point(IdlStruct, typename=_message("geometry_msgs", "Point")):
    """Metres."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Quaternion(IdlStruct, typename=_message("geometry_msgs", "Quaternion")):
    """A turn."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


@dataclass
class Pose(IdlStruct, typename=_message("geometry_msgs", "Pose")):
    """Place and turn."""

    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass
class PoseStamped(IdlStruct, typename=_message("geometry_msgs", "PoseStamped")):
    """A pose in a frame."""

    header: Header = field(default_factory=Header)
    pose: Pose = field(default_factory=Pose)


@dataclass
class PoseWithCovariance(IdlStruct, typename=_message("geometry_msgs", "PoseWithCovariance")):
    """A pose, and how sure it is."""

    pose: Pose = field(default_factory=Pose)
    covariance: array[float64, 36] = field(default_factory=lambda: [0.0] * 36)


@dataclass
class Vector3(IdlStruct, typename=_message("geometry_msgs", "Vector3")):
    """Three numbers."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Twist(IdlStruct, typename=_message("geometry_msgs", "Twist")):
    """Speeds."""

    linear: Vector3 = field(default_factory=Vector3)
    angular: Vector3 = field(default_factory=Vector3)


@dataclass
class TwistWithCovariance(IdlStruct, typename=_message("geometry_msgs", "TwistWithCovariance")):
    """Speeds, and how sure they are."""

    twist: Twist = field(default_factory=Twist)
    covariance: array[float64, 36] = field(default_factory=lambda: [0.0] * 36)


@dataclass
class Odometry(IdlStruct, typename=_message("nav_msgs", "Odometry")):
    """Where it is, and how fast."""

    header: Header = field(default_factory=Header)
    child_frame_id: str = "base_link"
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)
    twist: TwistWithCovariance = field(default_factory=TwistWithCovariance)


def _xml(enclave: Path | None) -> str:
    security = "" if enclave is None else _security(enclave)
    return (
        '<CycloneDDS><Domain Id="any"><General>'
        '<Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>'
        "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
        '<MaxAutoParticipantIndex>120</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers>'
        f"</Discovery>{security}</Domain></CycloneDDS>"
    )


def _security(enclave: Path) -> str:
    def files(**named: str) -> str:
        return "".join(f"<{key}>file:{enclave / name}</{key}>" for key, name in named.items())

    known = files(IdentityCertificate="cert.pem", IdentityCA="identity_ca.cert.pem", PrivateKey="key.pem")
    allowed = files(
        PermissionsCA="permissions_ca.cert.pem", Governance="governance.p7s", Permissions="permissions.p7s"
    )
    parts = (
        ("Authentication", "auth", "authentication", known),
        ("Cryptographic", "crypto", "crypto", ""),
        ("AccessControl", "ac", "access_control", allowed),
    )
    return "".join(
        f'<Security><{part}><Library path="dds_security_{library}" initFunction="init_{function}" '
        f'finalizeFunction="finalize_{function}"/>{inside}</{part}></Security>'
        for part, library, function, inside in parts
    ).replace("</Security><Security>", "")


def main() -> None:
    """Drive until ended; each target and each speed 0 is a line of JSON."""
    parser = argparse.ArgumentParser()
    parser.add_argument("name")
    parser.add_argument("--domain", type=int, required=True)
    parser.add_argument("--enclave", type=Path)
    parser.add_argument("--at", type=float, nargs=2, default=[20.0, 8.0])
    parser.add_argument("--speed", type=float, default=4.0)
    options = parser.parse_args()
    domain = Domain(options.domain, _xml(options.enclave))
    participant = DomainParticipant(options.domain)
    quality = Qos(Policy.Reliability.Reliable(0), Policy.History.KeepLast(10))

    def topic(name: str, kind: type) -> Topic:
        return Topic(participant, f"rt/{options.name}/{name}", kind)

    places = DataWriter(participant, topic("odom", Odometry), qos=quality)
    targets = DataReader(participant, topic("goal_pose", PoseStamped), qos=quality)
    speeds = DataReader(participant, topic("cmd_vel", Twist), qos=quality)
    drive(options, places, targets, speeds)
    del domain


def drive(options: argparse.Namespace, places: DataWriter, targets: DataReader, speeds: DataReader) -> None:
    """Go towards the newest target; speed 0 ends that."""
    x, y = options.at
    goal: tuple[float, float] | None = None
    print(json.dumps({"event": "up"}), flush=True)
    while True:
        for sample in targets.take(10):
            if sample.sample_info.valid_data:
                goal = (sample.pose.position.x, sample.pose.position.y)
                print(json.dumps({"event": "target", "x": goal[0], "y": goal[1]}), flush=True)
        for sample in speeds.take(100):
            if sample.sample_info.valid_data and goal is not None:
                goal = None
                print(json.dumps({"event": "speed 0"}), flush=True)
        v = 0.0
        if goal is not None:
            dx, dy = goal[0] - x, goal[1] - y
            far = (dx * dx + dy * dy) ** 0.5
            step = min(far, options.speed * EVERY)
            if far > 0:
                x, y, v = x + dx / far * step, y + dy / far * step, step / EVERY
        told = Odometry()
        now = time.time()
        told.header.stamp = Time(int(now), int(now % 1 * 1e9))
        told.pose.pose.position = Point(x, y, 0.0)
        told.twist.twist.linear.x = v
        places.write(told)
        time.sleep(EVERY)


if __name__ == "__main__":
    main()
