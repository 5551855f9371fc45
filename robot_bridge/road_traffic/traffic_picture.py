"""All robots at one moment, as movements: what conflicts are looked for in; no I/O."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..messages import ConflictReport, HoldReport, SetPath
from ..planning import Floats, Point
from ..sites.settings import RouteSettings
from ..store.closures import HoldRow
from ..traffic.conflicts import Conflict
from ..traffic.movement import Movement, driving, standing
from .ways import Underway


class Seen(NamedTuple):
    """All that movements are made of: ``places`` says where each robot is and how fast it drives.

    Those in ``placed`` are there now; the others were there, and may have driven on unseen.
    """

    now: float
    settings: RouteSettings
    underway: list[Underway]
    places: dict[str, tuple[Point, float]]
    holds: dict[str, HoldRow]
    placed: frozenset[str]

    @property
    def on_the_way(self) -> set[str]:
        """The robots that have a task or wait on the way of one: the others move as they please."""
        return {one.robot for one in self.underway} | set(self.holds)

    def movements(self) -> dict[str, Movement]:
        """Return how every robot moves that has said where it is, if all goes on as it is planned."""
        ways = {one.robot: one.points() for one in self.underway}
        return {name: self._movement(name, ways.get(name)) for name in self.places}

    def _movement(self, robot: str, way: Floats | None) -> Movement:
        place, speed = self.places[robot]
        radius = self.settings.radius_m
        hold = self.holds.get(robot)
        if hold is None:
            if way is None:
                return standing(robot, place, self.now, radius)
            return driving(robot, way, speed, self.now, radius)
        to_hold = np.array([place]) if way is None else way
        rest = np.array(SetPath(**hold.rest).points)
        joined = np.concatenate([to_hold, rest])
        moving = driving(robot, joined, speed, self.now, radius)
        there = float(np.hypot(*np.diff(joined[: len(to_hold) + 1], axis=0).T).sum())
        return moving.waiting(there, max(hold.until - moving.time_at(there), 0.0))


def cut(points: list[Point], station: float) -> tuple[list[Point], list[Point]]:
    """Return a way up to ``station`` metres along it, and the rest of it."""
    line = np.asarray(points, dtype=np.float64)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    x, y = (round(float(np.interp(station, along, line[:, k])), 3) for k in (0, 1))
    before = [point for point, at in zip(points, along.tolist(), strict=True) if at < station - 1e-3]
    after = [point for point, at in zip(points, along.tolist(), strict=True) if at > station + 1e-3]
    return [*before, (x, y)], [(x, y), *after]


def conflict_report(conflict: Conflict, clearance: float) -> ConflictReport:
    """Return a conflict as operators are told it; ``clearance`` is metres between two robots' middles."""
    return ConflictReport(
        robot=conflict.robot,
        other=conflict.other,
        kind=conflict.kind,  # type: ignore[arg-type]
        begins=round(conflict.begins, 1),
        ends=None if math.isinf(conflict.ends) else round(conflict.ends, 1),
        nearest_at=round(conflict.nearest_at, 1),
        metres=round(conflict.metres, 2),
        x=round(conflict.place[0], 2),
        y=round(conflict.place[1], 2),
        clearance=round(clearance, 2),
    )


def hold_report(row: HoldRow) -> HoldReport:
    """Return a robot that waits as operators are told it."""
    x, y = SetPath(**row.rest).points[0]
    return HoldReport(row.robot, row.other, x, y, round(row.until, 1), row.by, row.command)
