"""The robots as known now: poses, clocks and liveness; no I/O."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .arrival import standing
from .errors import NotReadyError
from .liveness import liveness
from .messages import RobotReport, RobotState, SendPos


@dataclass
class Robot:
    """One robot. ``received_at`` is the gateway's time of its last message, ``pose_at`` that of its pose."""

    name: str
    magic: int
    link: str
    received_at: float
    ended_in_order: bool = False
    pose: SendPos | None = None
    pose_at: float | None = None
    state: RobotState = RobotState.FRESH
    command: str | None = None
    revision: int = 0


class Robots:
    """All robots by name. Every change gets the next revision, so that a reader can ask what is new."""

    def __init__(self, stale_after: float = 3.0, lost_after: float = 10.0) -> None:
        self._stale_after = stale_after
        self._lost_after = lost_after
        self._robots: dict[str, Robot] = {}
        self.revision = 0

    def __contains__(self, name: str) -> bool:
        return name in self._robots

    def names(self) -> list[str]:
        """Return the names of all robots, sorted."""
        return sorted(self._robots)

    def get(self, name: str) -> Robot:
        """Return the robot ``name``; raises NotReadyError if it never said Ready."""
        robot = self._robots.get(name)
        if robot is None:
            raise NotReadyError(f"robot {name!r} has not said Ready to this gateway; send Ready first")
        return robot

    def restore(self, robot: Robot, now: float) -> None:
        """Take in a robot that an earlier gateway knew."""
        self._robots[robot.name] = robot
        robot.state = self._judge(robot, now)
        self._touch(robot)

    def ready(self, name: str, magic: int, link: str, now: float) -> bool:
        """Register a robot; return true unless it repeats the Ready (same magic) it is registered by."""
        robot = self._robots.get(name)
        started = robot is None or robot.magic != magic
        if robot is None:
            robot = self._robots[name] = Robot(name, magic, link, now)
        if started and robot.pose is not None:
            # A robot that started anew may have a clock that did so too.
            robot.pose = replace(robot.pose, t=None)
        robot.magic, robot.link = magic, link
        self.heard(name, link, now)
        return started

    def heard(self, name: str, link: str, now: float, *, stopped: bool = False) -> Robot:
        """Note that a message of the robot came in; ``stopped`` when it said Stopped."""
        robot = self.get(name)
        robot.link, robot.received_at, robot.ended_in_order = link, now, stopped
        robot.state = RobotState.FRESH
        self._touch(robot)
        return robot

    def observe(self, name: str, pose: SendPos, link: str, now: float) -> bool:
        """Take in a pose; return false for one that is older, by the robot's own clock, than the last."""
        robot = self.get(name)
        standing_still = robot.ended_in_order and standing(pose)
        self.heard(name, link, now, stopped=standing_still)
        last = robot.pose
        if last is not None and last.t is not None and pose.t is not None and pose.t < last.t:
            return False
        robot.pose, robot.pose_at = pose, now
        return True

    def closed(self, name: str) -> None:
        """Note that the robot closed its link in good order."""
        robot = self._robots.get(name)
        if robot is not None:
            robot.ended_in_order = True
            self._touch(robot)

    def assign(self, name: str, command: str | None) -> None:
        """Set the command that the robot is busy with."""
        robot = self._robots.get(name)
        if robot is not None and robot.command != command:
            robot.command = command
            self._touch(robot)

    def age(self, now: float) -> None:
        """Bring the state of every robot up to ``now``; what changed gets a new revision."""
        for robot in self._robots.values():
            state = self._judge(robot, now)
            if state is not robot.state:
                robot.state = state
                self._touch(robot)

    def reports(self, now: float, since: int = -1) -> list[RobotReport]:
        """Return the robots that changed after revision ``since``, as operators are told."""
        return [self._report(robot, now) for robot in self._robots.values() if robot.revision > since]

    def _judge(self, robot: Robot, now: float) -> RobotState:
        return liveness(
            now - robot.received_at,
            ended_in_order=robot.ended_in_order,
            stale_after=self._stale_after,
            lost_after=self._lost_after,
        )

    def _touch(self, robot: Robot) -> None:
        self.revision += 1
        robot.revision = self.revision

    def _report(self, robot: Robot, now: float) -> RobotReport:
        pose = robot.pose
        known = RobotReport(
            robot=robot.name,
            state=robot.state,
            age=round(max(0.0, now - robot.received_at), 3),
            link=robot.link,
            stopped=robot.ended_in_order,
            command=robot.command,
        )
        if pose is None:
            return known
        return RobotReport(
            **{
                **known.__dict__,
                "x": pose.x,
                "y": pose.y,
                "theta": pose.theta,
                "v": pose.v,
                "device_time": pose.t,
                "battery": pose.battery,
                "status": pose.status,
            }
        )
