"""The plan proposal: its paths checked for closed roads and near meetings, and the task that computes it."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np
import numpy.typing as npt
from qgis.core import QgsTask
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment.plan import ConePlan, PlanStop, RobotPlan
from ...robot_bridge.core.errors import AssignmentCancelledError, AssignmentError, RoadsError
from ...robot_bridge.core.messages import ClosureReport
from ...robot_bridge.core.roads.centrelines import centrelines
from ...robot_bridge.core.roads.map_matching import NearestEdge, edges_along
from ...robot_bridge.core.roads.network import build_network
from ...robot_bridge.core.roads.routes import stretch
from ..layers.road_layers import DEFAULT_WIDTH_M
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask, Steps, run_to_end
from .plan_settings import ConeFacts
from .travel import PlanTravel

# --- Which ways of a plan lead along roads that are closed at the gateway ---

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ClosedWay:
    """The way of ``robot`` to ``stop`` leads along a road that ``by`` closed."""

    robot: str
    stop: str
    by: str
    reason: str = ""
    at: PlanStop | None = field(default=None, compare=False, repr=False)

    def in_words(self) -> str:
        """Return whose way that is, and who closed the road and why."""
        return tr(
            "the way of {robot} to {stop} leads along a road that {by} closed{why}",
            robot=self.robot,
            stop=self.stop,
            by=self.by,
            why=f" ({self.reason})" if self.reason else "",
        )


def closed_ways(plan: ConePlan, closures: Sequence[ClosureReport]) -> Steps[tuple[ClosedWay, ...]]:
    """Find the ways of ``plan`` that lead along a closed road, one step for each road and each way.

    A way that only crosses one, or turns off where it begins, may be driven. The gateway says of closures no
    width, so that a road counts as wide as one of which none is known.
    """
    if not closures:
        return ()
    ways = [(one.robot.id, stop) for one in plan.robots if not one.lost for stop in one.stops]
    count = len(closures) + len(ways)
    roads = []
    for number, closure in enumerate(closures):
        yield number / count
        roads.append(_Road(closure))
    found = []
    for number, (robot, stop) in enumerate(ways, len(roads)):
        yield number / count
        path = np.array(stop.path, dtype=float)
        road = next((road for road in roads if road.is_along(path)), None)
        if road is not None:
            found.append(ClosedWay(robot, stop.id, road.by, road.reason, stop))
    return tuple(found)


class _Road:
    def __init__(self, closure: ClosureReport) -> None:
        self.by, self.reason = closure.closed_by, closure.reason or ""
        line = _without_ends(np.array(closure.line, dtype=float))
        self._low, self._high = line.min(axis=0) - DEFAULT_WIDTH_M, line.max(axis=0) + DEFAULT_WIDTH_M
        self._nearest = NearestEdge(build_network(centrelines([line], width=[DEFAULT_WIDTH_M])))
        self._all = np.ones(len(self._nearest.network), dtype=bool)

    def is_along(self, path: Floats) -> bool:
        """Tell whether ``path``, (n, 2) in the site frame, runs along the road."""
        low, high = np.minimum(path[:-1], path[1:]), np.maximum(path[:-1], path[1:])
        legs = np.flatnonzero(((low <= self._high) & (high >= self._low)).all(axis=1))
        if len(legs) == 0:
            return False
        # Most of a long way is far from the road, and need not be looked at.
        return len(edges_along(self._nearest, path[legs[0] : legs[-1] + 2], self._all)) > 0


def _without_ends(line: Floats) -> Floats:
    """Return ``line``, (n, 2), without half a road's width at either end, at most nine tenths of it.

    A way is on a road up to half its width beyond the road's end, which is where other roads begin.
    """
    metres = float(np.hypot(*np.diff(line, axis=0).T).sum())
    cut = min(DEFAULT_WIDTH_M / 2, 0.45 * metres)
    return stretch(line, cut, metres - cut)


# --- Where robots come too near to one another if all goes by the plan ---

STEP_S = 0.5
_RUN = 64
"""Points of a way that are in one box."""
_SAMPLED = 0.05
"""Metres by which a way that is led round something may seem nearer, looked at every step."""


@dataclass(frozen=True)
class NearMeeting:
    """``robot`` and ``other`` are ``metres`` apart at (x, y), site frame, ``at_s`` after the plan's begin."""

    robot: str
    other: str
    at_s: float
    metres: float
    x: float
    y: float

    def in_words(self) -> str:
        """Return who meets whom, where and when."""
        minutes, seconds = divmod(round(self.at_s), 60)
        return tr(
            "{robot} and {other} come within {metres:.1f} m at {x:.0f}, {y:.0f} m after "
            "{minutes}:{seconds:02d}",
            robot=self.robot,
            other=self.other,
            metres=self.metres,
            x=self.x,
            y=self.y,
            minutes=minutes,
            seconds=seconds,
        )


def meetings(
    plan: ConePlan,
    least: float,
    standing: Mapping[str, tuple[float, float]] | None = None,
    off_standing: float = 0.0,
) -> list[NearMeeting]:
    """Return for each two robots when they come nearer than ``least`` metres first, soonest first.

    ``standing`` are the places of robots that do not drive by the plan, a lost one among them: who drives
    comes nearer than ``off_standing`` metres to one of them where that stands at his cone.
    """
    driving = [one for one in plan.robots if not one.lost]
    if not driving:
        return []
    begin = min(one.robot.ready_s for one in driving)
    times = np.arange(begin, max(one.end_s for one in driving) + STEP_S, STEP_S)
    places = {one.robot.id: robot_positions(one, times) for one in driving}
    found = [
        *(
            meeting
            for (robot, here), (other, there) in combinations(places.items(), 2)
            for meeting in _first(robot, other, here, there, times, least)
        ),
        *_with_standing(places, standing or {}, times, off_standing - _SAMPLED),
    ]
    return sorted(found, key=lambda one: one.at_s)


def robot_positions(one: RobotPlan, times: Floats) -> Floats:
    """Return where the robot is at ``times``, (n,) seconds from the plan's begin, as (n, 2) metres."""
    clock, places = [one.robot.ready_s], [np.array([[one.robot.x, one.robot.y]])]
    knots = [np.array([one.robot.ready_s])]
    for stop in one.stops:
        path = np.array(stop.path)
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        length = max(along[-1], 1e-9)
        knots += [clock[-1] + (stop.arrival_s - clock[-1]) * along / length, np.array([stop.end_s])]
        places += [path, path[-1:]]
        clock.append(stop.end_s)
    at, where = np.concatenate(knots), np.concatenate(places)
    return np.column_stack([np.interp(times, at, where[:, axis]) for axis in (0, 1)])


def _with_standing(
    driving: Mapping[str, Floats], standing: Mapping[str, tuple[float, float]], times: Floats, least: float
) -> Iterator[NearMeeting]:
    names, places = list(standing), np.array(list(standing.values()), dtype=float).reshape(-1, 2)
    for robot, here in driving.items():
        for k in _beside(here, places, least):
            yield from _first(robot, names[k], here, places[k : k + 1], times, least)


def _beside(way: Floats, places: Floats, reach: float) -> list[int]:
    """Return which of (m, 2) ``places`` may be within ``reach`` of the (n, 2) points of a way.

    Most of a thousand robots stand far from it; to measure from every point to each would take seconds.
    """
    begins = np.arange(0, len(way), _RUN)
    low, high = (reduce.reduceat(way, begins, axis=0) for reduce in (np.minimum, np.maximum))
    is_in = (places[:, None] >= low - reach) & (places[:, None] <= high + reach)
    return np.flatnonzero(is_in.all(axis=2).any(axis=1)).tolist()


def _first(
    robot: str, other: str, here: Floats, there: Floats, times: Floats, least: float
) -> Iterator[NearMeeting]:
    """Yield the first meeting of two, if there is one; ``there`` is (n, 2) as ``here``, or one place."""
    apart = np.hypot(*(here - there).T)
    near = np.flatnonzero(apart < least)
    if len(near) == 0:
        return
    # The nearest point of the first time that they meet says more than the moment it begins.
    breaks = np.flatnonzero(np.diff(near) > 1)
    run = near[: breaks[0] + 1] if len(breaks) else near
    k = int(run[apart[run].argmin()])
    x, y = ((here + there) / 2)[k]
    yield NearMeeting(robot, other, float(times[k]), float(apart[k]), float(x), float(y))


# --- A plan together with the ground that it is planned on, and what speaks against it there ---


@dataclass(frozen=True)
class PlanProposal:
    """A plan with the ground that it is planned on. Its tasks and cones are written down with ``name``."""

    plan: ConePlan
    ways: PlanTravel
    facts: Mapping[str, ConeFacts]
    name: str
    meetings: tuple[NearMeeting, ...] = field(default=())
    closed: tuple[ClosedWay, ...] = field(default=())
    """Ways along roads that are closed at the gateway, which would not take them."""

    def with_plan(self, plan: ConePlan, apart_m: float, closures: Sequence[ClosureReport]) -> PlanProposal:
        """Return ``plan`` on the same ground, judged: where robots come nearer to each other than ``apart_m``
        metres, and what of it leads along ``closures``.

        That takes seconds for a plan of an hour among a thousand robots: not in the window's thread.
        """
        ways = self.ways
        near = tuple(meetings(plan, apart_m, ways.standing, ways.settings.off_standing_m))
        return replace(self, plan=plan, meetings=near, closed=run_to_end(closed_ways(plan, closures)))

    def with_closures(self, closures: Sequence[ClosureReport]) -> Steps[PlanProposal]:
        """Return the same with other roads closed; itself if that changes nothing."""
        closed = yield from closed_ways(self.plan, closures)
        return self if closed == self.closed else replace(self, closed=closed)


# --- Looks which ways of plans lead along closed roads, without holding the window up ---


class ClosureCheck(QObject):
    """One look at a time: ten roads and four hundred ways take a tenth of a second, in slices."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._slices = CooperativeTask(self)

    def begin(
        self,
        drafts: Sequence[PlanProposal],
        closures: Sequence[ClosureReport],
        done: Callable[[list[PlanProposal]], None],
    ) -> None:
        """Call ``done`` with ``drafts`` as these roads leave them, at once where that is soon found.

        A look that is under way is given up.
        """
        found = self._slices.begin(_looked_at(drafts, closures), done=done)
        if found is not None:
            done(found)

    def stop(self) -> None:
        """Look no more; what was asked for is not told."""
        self._slices.stop()


def _looked_at(
    drafts: Sequence[PlanProposal], closures: Sequence[ClosureReport]
) -> Steps[list[PlanProposal]]:
    found = []
    for draft in drafts:
        found.append((yield from draft.with_closures(closures)))
    return found


# --- Makes a plan beside the window's thread, with progress and cancel ---


class PlanTask(QgsTask):
    """Does ``work``, which is given the task.

    Unless cancelled, ``made`` or ``refused`` is emitted in the window's thread.
    """

    made = pyqtSignal(object)
    refused = pyqtSignal(str)

    def __init__(self, title: str, work: Callable[[PlanTask], PlanProposal]):
        super().__init__(title, QgsTask.Flag.CanCancel)
        self._work = work
        self._draft: PlanProposal | None = None
        self._why = ""
        self.share = 0.0
        """How much is done, 0 to 1; known when QGIS has deleted the task, too."""
        self.left = threading.Event()
        """Set once the worker has left :meth:`run`."""

    def run(self) -> bool:
        try:
            self._draft = self._work(self)
        except AssignmentCancelledError:
            pass
        except (AssignmentError, RoadsError, FleetError) as error:
            self._why = str(error)
        except Exception:
            self._why = tr(
                "The plan could not be made. Please report this:\n{traceback}",
                traceback=traceback.format_exc(),
            )
        finally:
            self.left.set()
        return self._draft is not None

    def finished(self, done: bool) -> None:
        if self.isCanceled():
            return
        if self._draft is not None:
            self.made.emit(self._draft)
        else:
            self.refused.emit(self._why)

    def told(self, share: float) -> bool:
        """Show that ``share`` of the work, 0 to 1, is done; return whether to go on."""
        self.share = share
        self.setProgress(100.0 * share)
        return self.goes_on()

    def goes_on(self) -> bool:
        """Whether nobody has cancelled it."""
        return not self.isCanceled()
