"""The desk's knowledge at one moment, as the rules look at it."""

from __future__ import annotations

import numpy as np

from ....robot_bridge.messages import CommandState
from ...errors import PlacementError
from ..desk import Desk
from ..picture import RobotArrays
from .road_ground import RoadGround
from .rules import Bools, Floats, Situation
from .thresholds import AlarmKind, Thresholds


class Situations:
    """Makes one situation after the other; between two it sees how fast those move who do not say it."""

    def __init__(self, desk: Desk, ground: RoadGround):
        self._desk = desk
        self._ground = ground
        self._before: tuple[float, Floats] = (0.0, np.empty((0, 2)))
        self._arrangement = desk.picture.arrangement

    def at(self, moment: float, limits: Thresholds) -> Situation:
        """Return how things are at ``moment`` of the desk's clock; the site has to be known."""
        robots = self._desk.picture.arrays(moment)
        off, on = self._roads(robots.xy, limits)
        only_seen = self._desk.picture.only_seen()
        return Situation(
            names=robots.names,
            xy=robots.xy,
            v=self._speeds(robots, moment),
            battery=self._desk.picture.column("battery"),
            # Nobody drives by the accuracy of what is only seen: a phone's is some metres all day.
            accuracy=np.where(only_seen, np.nan, robots.accuracy),
            state=robots.state,
            stopped=self._desk.picture.column("stopped") == 1.0,
            driving=self._driving(len(robots.names)),
            only_seen=only_seen,
            bounds=self._desk.site.bounds,
            off_road=off,
            on_road=on,
        )

    def _speeds(self, robots: RobotArrays, moment: float) -> Floats:
        then, places = self._before
        if self._arrangement != self._desk.picture.arrangement:
            # Where other robots were.
            self._arrangement, places = self._desk.picture.arrangement, places[:0]
        self._before = moment, robots.xy
        seen = np.full(len(robots.v), np.nan)
        if moment > then and 0 < len(places) <= len(robots.xy):
            seen[: len(places)] = np.hypot(*(robots.xy[: len(places)] - places).T) / (moment - then)
        return np.where(np.isnan(robots.v), seen, np.abs(robots.v))

    def _driving(self, count: int) -> Bools:
        driving = np.zeros(count, dtype=bool)
        if self._desk.emergency is not None and self._desk.emergency.in_force:
            return driving
        waits = {hold.robot for hold in self._desk.roads.conflicts.waiting}
        for task in self._desk.book.under_way():
            row = self._desk.picture.row(task.robot)
            if row is not None and task.state is CommandState.ACKNOWLEDGED and task.robot not in waits:
                driving[row] = True
        return driving

    def _roads(self, xy: Floats, limits: Thresholds) -> tuple[Bools | None, Bools | None]:
        if AlarmKind.OFF_ROAD not in limits.kinds:
            return None, None
        try:
            judged = self._ground.judge(xy, self._desk.placement(), limits.road_margin)
        except PlacementError as error:
            self._ground.why_not = str(error)
            return None, None
        return (None, None) if judged is None else judged
