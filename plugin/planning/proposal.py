"""The plan proposal: its paths checked for closed roads and near meetings, and the task that computes it."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt
from qgis.core import QgsTask
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment.meetings import NearMeeting, meetings
from ...robot_bridge.core.assignment.plan import ConePlan
from ...robot_bridge.core.assignment.progress import ClosedWay, ConeFacts
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
from .travel import PlanTravel

# --- Which ways of a plan lead along roads that are closed at the gateway ---

Floats = npt.NDArray[np.float64]


def closed_in_words(way: ClosedWay) -> str:
    """Return whose way that is, and who closed the road and why."""
    return tr(
        "the way of {robot} to {stop} leads along a road that {by} closed{why}",
        robot=way.robot,
        stop=way.stop,
        by=way.by,
        why=f" ({way.reason})" if way.reason else "",
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


def meeting_in_words(meeting: NearMeeting) -> str:
    """Return who meets whom, where and when."""
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
