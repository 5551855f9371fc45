"""The plan proposal: its paths, its checks for closed roads and near meetings, and its task."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeedback,
    QgsProject,
    QgsTask,
)
from qgis.PyQt.QtCore import QObject

from ...robot_bridge.core.assignment.clearance import ClearTravel, Floats, NearMeeting, NearOrByRoad, meetings
from ...robot_bridge.core.assignment.job import (
    AssignmentJob,
    CancellableTravel,
    RoadTravel,
    StraightTravel,
    Travel,
)
from ...robot_bridge.core.assignment.plan import ConePlan
from ...robot_bridge.core.assignment.progress import ClosedWay, ConeFacts
from ...robot_bridge.core.errors import AssignmentCancelledError, AssignmentError, RoadsError
from ...robot_bridge.core.messages.roads import ClosureReport
from ...robot_bridge.core.roads.map_matching import NearestEdge, edges_along, edges_of_closure
from ...robot_bridge.core.roads.network import build_network, centrelines
from ...robot_bridge.core.roads.routes import Router, stretch
from ...robot_bridge.core.sites.frame import SiteFrame
from ...robot_bridge.core.sites.geopackage import road_lines
from ..layers.crs import stated_crs
from ..layers.layer_source import obstacle_sources
from ..layers.road_layers import DEFAULT_WIDTH_M, edges_through, read_areas, read_centrelines
from ..layers.roles import KEEPOUT, ROAD_CENTRELINE, LayerExpressions, layers_with_role
from ..layers.site_transform import SiteGeoreference
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask, SignallingTask, Steps, run_to_end
from .plan_settings import PlanSettings

# --- The robots' paths from place to place: straight nearby, by road farther off, around cones and robots ---


class PlanTravel:
    """The ground of one plan; made in the window's thread, used by one task after the other.

    ``cones`` (n, 2) are those standing before, besides the plan's own; ``standing`` are positions of robots
    that do not take part. ``closures`` are the roads that are closed at the gateway. All apply to the next
    plan that is made.
    """

    def __init__(self, project: QgsProject, frame: SiteFrame, settings: PlanSettings) -> None:
        self.settings = settings
        self.cones: Floats = np.empty((0, 2))
        self.standing: Mapping[str, tuple[float, float]] = {}
        self.closures: Sequence[ClosureReport] = ()
        self._router: Router | None = None
        self._shut: set[int] = set()
        self._read = not settings.on_roads
        crs = stated_crs(QgsCoordinateReferenceSystem(frame.crs))
        self._site = SiteGeoreference(crs, frame, project.transformContext())
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(None))

        def sources(role: str):
            layers = layers_with_role(project, role) if settings.on_roads else []
            return obstacle_sources(layers, LayerExpressions(), context)

        self._roads, self._keepouts = sources(ROAD_CENTRELINE), sources(KEEPOUT)

    def travel_of(self, job: AssignmentJob, goes_on: Callable[[], bool]) -> Travel:
        """Return the ways between the places of ``job``, clear of its cones and of standing cones and robots.

        :raises AssignmentCancelledError: here and by the ways once ``goes_on()`` is false; RoadsError when a
            place is too far from every road; LayerReadingError for a layer of roads that cannot be read.
        """
        router = self._opened(goes_on)
        travel: Travel = StraightTravel(job)
        if router is not None:
            roads = RoadTravel(job, router, progress=lambda share: _ask(goes_on))
            nearby = self.settings.direct_m
            name = tr("{name}, straight within {nearby:g} m", name=roads.name, nearby=nearby)
            travel = NearOrByRoad(travel, roads, nearby, name)
        cones = np.concatenate([job.places[job.first_target :], self.cones])
        robots = np.array(list(self.standing.values()), dtype=float).reshape(-1, 2)
        clear = ClearTravel(
            travel,
            job.places,
            np.concatenate([cones, robots]),
            np.repeat([self.settings.clearance_m, self.settings.off_standing_m], [len(cones), len(robots)]),
        )
        return CancellableTravel(clear, goes_on)

    def _opened(self, goes_on: Callable[[], bool]) -> Router | None:
        if not self._read:
            self._router = self._network(goes_on)
            # Only now: a cancelled or failed task has no roads, and must not continue without them.
            self._read = True
        if self._router is not None:
            self._close(self._router)
        return self._router

    def _close(self, router: Router) -> None:
        """Close the roads closed at the gateway, and open those that no longer are."""
        lines = [(np.array(one.line, dtype=float), one.level) for one in self.closures]
        edges = {edge for line in lines for edge in edges_of_closure(router.nearest, *line).tolist()}
        always = set(np.flatnonzero(router.closed).tolist()) - self._shut
        router.open(sorted(self._shut - edges))
        router.close(sorted(edges - self._shut - always))
        self._shut = edges - always

    def _network(self, goes_on: Callable[[], bool]) -> Router | None:
        feedback = _Asking(goes_on)
        roads = read_centrelines(self._roads, self._site, DEFAULT_WIDTH_M, feedback).items
        _ask(goes_on)
        if not roads:
            return None
        network = build_network(road_lines(roads), lambda: _ask(goes_on))
        _ask(goes_on)
        router = Router(network)
        areas = read_areas(self._keepouts, self._site, KEEPOUT, feedback).items
        _ask(goes_on)
        router.close(edges_through(network, [area.rings for area in areas]))
        return router


def _ask(goes_on: Callable[[], bool]) -> None:
    if not goes_on():
        raise AssignmentCancelledError(tr("The assignment was cancelled."))


class _Asking(QgsFeedback):
    """Checks ``goes_on`` for cancellation, for readers of layers that check a feedback."""

    def __init__(self, goes_on: Callable[[], bool]) -> None:
        super().__init__()
        self._goes_on = goes_on

    def isCanceled(self) -> bool:
        return not self._goes_on()


# --- The proposal, its checks, and the task that computes it ---


def closed_in_words(way: ClosedWay) -> str:
    """Return the robot of the way, and who closed the road and why."""
    return tr(
        "the way of {robot} to {stop} leads along a road that {by} closed{why}",
        robot=way.robot,
        stop=way.stop,
        by=way.by,
        why=f" ({way.reason})" if way.reason else "",
    )


def closed_ways(plan: ConePlan, closures: Sequence[ClosureReport]) -> Steps[tuple[ClosedWay, ...]]:
    """Find the ways of ``plan`` that lead along a closed road, one step for each road and each way.

    A way that only crosses one, or turns off where it begins, may be driven. The gateway reports closures
    without a width, so that a road counts as wide as one of unknown width.
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
        """Return whether ``path``, (n, 2) in the site frame, runs along the road."""
        low, high = np.minimum(path[:-1], path[1:]), np.maximum(path[:-1], path[1:])
        legs = np.flatnonzero(((low <= self._high) & (high >= self._low)).all(axis=1))
        if len(legs) == 0:
            return False
        # Most of a long way is far from the road, and need not be checked.
        return len(edges_along(self._nearest, path[legs[0] : legs[-1] + 2], self._all)) > 0


def _without_ends(line: Floats) -> Floats:
    """Return ``line``, (n, 2), without half a road's width at either end, at most nine tenths of it.

    A way is on a road up to half its width beyond the road's end, where other roads begin.
    """
    metres = float(np.hypot(*np.diff(line, axis=0).T).sum())
    cut = min(DEFAULT_WIDTH_M / 2, 0.45 * metres)
    return stretch(line, cut, metres - cut)


def meeting_in_words(meeting: NearMeeting) -> str:
    """Return which robots meet, where and when."""
    minutes, seconds = divmod(round(meeting.at_s), 60)
    return tr(
        "{robot} and {other} come within {metres:.1f} m at {x:.0f}, {y:.0f} m after {minutes}:{seconds:02d}",
        robot=meeting.robot,
        other=meeting.other,
        metres=meeting.metres,
        x=meeting.x,
        y=meeting.y,
        minutes=minutes,
        seconds=seconds,
    )


# --- A plan together with its ground, and the findings against it ---


@dataclass(frozen=True)
class PlanProposal:
    """A plan with the ground that it is planned on. Its tasks and cones are recorded with ``name``."""

    plan: ConePlan
    ways: PlanTravel
    facts: Mapping[str, ConeFacts]
    name: str
    meetings: tuple[NearMeeting, ...] = field(default=())
    closed: tuple[ClosedWay, ...] = field(default=())
    """Ways along roads that are closed at the gateway, which would refuse them."""

    def with_plan(self, plan: ConePlan, apart_m: float, closures: Sequence[ClosureReport]) -> PlanProposal:
        """Return ``plan`` on the same ground, checked: where robots come nearer than ``apart_m`` metres to
        each other, and which of its ways lead along ``closures``.

        That takes seconds for a plan of an hour among a thousand robots: not in the window's thread.
        """
        ways = self.ways
        near = tuple(meetings(plan, apart_m, ways.standing, ways.settings.off_standing_m))
        return replace(self, plan=plan, meetings=near, closed=run_to_end(closed_ways(plan, closures)))

    def with_closures(self, closures: Sequence[ClosureReport]) -> Steps[PlanProposal]:
        """Return the proposal with other roads closed; itself if that changes nothing."""
        closed = yield from closed_ways(self.plan, closures)
        return self if closed == self.closed else replace(self, closed=closed)


# --- Checks which ways of plans lead along closed roads, without blocking the window ---


class ClosureCheck(QObject):
    """One check at a time: ten roads and four hundred ways take a tenth of a second, in slices."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._slices = CooperativeTask(self)

    def begin(
        self,
        drafts: Sequence[PlanProposal],
        closures: Sequence[ClosureReport],
        done: Callable[[list[PlanProposal]], None],
    ) -> None:
        """Call ``done`` with ``drafts`` checked against these roads, at once where that is quick.

        A check that is under way is given up.
        """
        found = self._slices.begin(_checked(drafts, closures), done=done)
        if found is not None:
            done(found)

    def stop(self) -> None:
        """Stop checking; the result of the check under way is dropped."""
        self._slices.stop()


def _checked(drafts: Sequence[PlanProposal], closures: Sequence[ClosureReport]) -> Steps[list[PlanProposal]]:
    found = []
    for draft in drafts:
        found.append((yield from draft.with_closures(closures)))
    return found


# --- Makes a plan in the background, with progress and cancel ---


class PlanTask(SignallingTask):
    """Runs ``work``, which is given the task: afterwards ``draft`` is set, or ``why`` is the error."""

    def __init__(self, title: str, work: Callable[[PlanTask], PlanProposal]):
        super().__init__(title, QgsTask.Flag.CanCancel)
        self._work = work
        self.draft: PlanProposal | None = None
        self.why = ""
        self.share = 0.0
        """The part that is done, 0 to 1; known even when QGIS has deleted the task."""
        self.is_under_way = False
        """Whether a thread is in :meth:`run`."""

    def run(self) -> bool:
        self.is_under_way = True
        try:
            self.draft = self._work(self)
        except AssignmentCancelledError:
            pass
        except (AssignmentError, RoadsError, FleetError) as error:
            self.why = str(error)
        except Exception:
            self.why = tr(
                "The plan could not be made. Please report this:\n{traceback}",
                traceback=traceback.format_exc(),
            )
        finally:
            self.is_under_way = False
        return self.draft is not None

    def report_progress(self, share: float) -> bool:
        """Show that ``share`` of the work, 0 to 1, is done; return whether to continue."""
        self.share = share
        self.setProgress(100.0 * share)
        return self.goes_on()

    def goes_on(self) -> bool:
        """Whether it has not been cancelled."""
        return not self.isCanceled()
