"""What the desk knows of the robots, and how far it can be trusted as time goes on without news."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...robot_bridge.liveness import liveness
from ...robot_bridge.messages import RobotReport, RobotState
from ..wire.mailbox import Sighting

STATES = (RobotState.FRESH, RobotState.STALE, RobotState.LOST, RobotState.OFFLINE)


@dataclass(frozen=True)
class RobotView:
    """One robot at one moment: the newest report, its state now and its age in seconds now."""

    report: RobotReport
    state: RobotState
    age: float

    @property
    def name(self) -> str:
        """The robot's name."""
        return self.report.robot

    @property
    def has_pose(self) -> bool:
        """Whether the robot ever said where it is."""
        return self.report.x is not None and self.report.y is not None


@dataclass(frozen=True)
class RobotArrays:
    """The robots that have a pose, as arrays of one row each.

    ``xy`` (n, 2) metres in the site frame, ``theta`` (n,) radians in the site frame, NaN where not known,
    ``state`` (n,) index into :data:`STATES`.
    """

    names: list[str]
    xy: npt.NDArray[np.float64]
    theta: npt.NDArray[np.float64]
    state: npt.NDArray[np.intp]


class RobotPicture:
    """The newest sighting of every robot, aged by this computer's own clock.

    A gateway that falls silent says nothing about its robots any more: they turn stale and lost here all
    the same, and stay on the map.
    """

    def __init__(self, stale_after: float = 3.0, lost_after: float = 10.0):
        self.stale_after = stale_after
        self.lost_after = lost_after
        self._seen: dict[str, Sighting] = {}

    def __len__(self) -> int:
        return len(self._seen)

    def merge(self, sightings: Mapping[str, Sighting]) -> None:
        """Take in newer sightings; one that arrived before what is known is passed over."""
        for name, sighting in sightings.items():
            known = self._seen.get(name)
            if known is None or sighting.received >= known.received:
                self._seen[name] = sighting

    def clear(self) -> None:
        """Forget every robot."""
        self._seen.clear()

    def view(self, name: str, now: float) -> RobotView | None:
        """Return robot ``name`` as it is to be shown at ``now`` (monotonic clock), None if not known."""
        sighting = self._seen.get(name)
        return self._aged(sighting, now) if sighting is not None else None

    def views(self, now: float) -> list[RobotView]:
        """Return every robot as it is to be shown at ``now``, by name."""
        return [self._aged(self._seen[name], now) for name in sorted(self._seen)]

    def arrays(self, now: float) -> RobotArrays:
        """Return every robot with a pose at ``now``, by name."""
        shown = [view for view in self.views(now) if view.has_pose]
        poses = [(v.report.x, v.report.y, _number(v.report.theta)) for v in shown]
        table = np.array(poses, dtype=np.float64).reshape(-1, 3)
        state = np.array([STATES.index(v.state) for v in shown], dtype=np.intp)
        return RobotArrays([v.name for v in shown], table[:, :2], table[:, 2], state)

    def _aged(self, sighting: Sighting, now: float) -> RobotView:
        report = sighting.report
        age = report.age + max(0.0, now - sighting.received)
        return RobotView(report, self._state(report, age), age)

    def _state(self, report: RobotReport, age: float) -> RobotState:
        if report.state in (RobotState.LOST, RobotState.OFFLINE):
            # The gateway may know more than the age tells, such as a link closed in good order.
            return report.state
        here = liveness(
            age, ended_in_order=report.stopped, stale_after=self.stale_after, lost_after=self.lost_after
        )
        return report.state if here is RobotState.FRESH else here


def _number(value: float | None) -> float:
    return math.nan if value is None else value
