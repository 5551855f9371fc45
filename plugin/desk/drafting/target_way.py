"""The way by which a robot comes to a target or route on the map: what is drawn, checked, and sent."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import GetRoute, RobotReport, SiteReport, to_json
from ...errors import FleetError, NotSentError
from ...language import tr
from ...wire.outbox import Answer, Order
from ..drafts import CONE, ROUTE, Draft, DraftBoard, Point, Way, WayKind
from ..orders import SLOW_AFTER
from ..route_preview import in_words, way_in
from ..way_wishes import SHORTEST
from .draft_checker import DraftChecker

MOVED_M = 0.5
"""Metres that a robot moves before the way from where it is is found again."""
OUTDATED_M = 2.0
"""Metres beside its robot above which a way is not sent."""
ASK_EVERY = 0.25
"""Seconds between two questions for the way of a robot that moves."""
DRIVEN_TO = (CONE, ROUTE)
"""Kinds of drafts that are driven to from where the robot is."""
ASKS = ("asks", "asks and cones")
TAKES_CONES = ("cones", "asks and cones")


class _Asked(NamedTuple):
    key: str
    robot: str
    goal: Point
    at: float


class TargetWays(QObject):
    """Keeps the way to the cone target or route on ``board`` as it is driven from where its robot is now.

    To a target along the roads where the site has some, by the gateway's router; straight where there are
    none, where no way leads there, where the robot can be told none, and where the operator chose that. To
    the beginning of a route it is straight.
    """

    found = pyqtSignal(object)
    """The way of a target that is not on the map any more, but was sent before it was known: the Draft."""

    def __init__(
        self,
        board: DraftBoard,
        checks: DraftChecker,
        report_of: Callable[[str], RobotReport | None],
        submit: Callable[[Order], None],
        clock: Callable[[], float],
        parent: QObject,
    ):
        super().__init__(parent)
        self._board, self._checks = board, checks
        self._report_of = report_of
        self._submit = submit
        self._clock = clock
        self._prefix, self._numbers = f"target-way-{id(self)}-", itertools.count(1)
        self._asked: _Asked | None = None
        self._beside: dict[_Asked, Draft] = {}
        """Questions for the ways of targets that go out when they are known."""
        self._asked_at = -math.inf
        self._is_amending = False
        self.site: SiteReport | None = None
        """The site that is served; None before it is known."""
        board.changed.connect(self.watch)

    def begun(self, draft: Draft) -> Draft:
        """Return a draft with its way as far as it is known at once; another kind of draft as it is."""
        if draft.kind not in DRIVEN_TO:
            return draft
        report = self._report_of(draft.robot)
        place = _place(report)
        if place is None:
            return replace(draft, way=Way(WayKind.UNKNOWN, note=_nowhere(draft.robot)))
        if draft.kind == ROUTE or draft.is_direct or self.site is None or not self.site.roads:
            return self._straight(draft, place, "")
        if report is not None and report.paths is None:
            return self._straight(draft, place, _not_declared(draft.robot))
        return replace(draft, way=Way(WayKind.SOUGHT))

    def is_outdated(self, draft: Draft) -> bool:
        """Tell whether a draft's robot is not where its way begins any more."""
        place = _place(self._report_of(draft.robot))
        line = draft.way.line
        return bool(line) and place is not None and math.dist(place, line[0]) > OUTDATED_M

    def seek_beside(self, draft: Draft) -> None:
        """Find the way of a target that is no more on the map; ``found`` tells of it."""
        asked = self._ask(draft)
        if asked is None:
            refused = Way(WayKind.UNKNOWN, refusal=_unanswered())
            self.found.emit(replace(draft, way=refused, is_checked=False))
        else:
            self._beside[asked] = draft

    def withdraw(self) -> list[Draft]:
        """Seek no way any more of targets that are not on the map; return them."""
        drafts, self._beside = list(self._beside.values()), {}
        return drafts

    def watch(self) -> None:
        """Find the way of the target on the map where it is not known, or no longer as it was."""
        self._give_up_beside()
        draft = self._board.draft
        if self._is_amending or draft is None or draft.kind not in DRIVEN_TO or self._board.is_dragged:
            return
        if self._checks.has_order:
            # What was looked at is what is sent.
            return
        if draft.kind == ROUTE and self._checks.is_under_way:
            # Begun anew for each half metre, a long check would never end.
            return
        if draft.way.kind is WayKind.SOUGHT:
            self._seek(draft)
        elif self._has_changed(draft):
            fresh = self.begun(draft)
            if fresh.way.kind is WayKind.SOUGHT and draft.way.kind in (WayKind.PATH, WayKind.ASKED):
                # The one before stays on the map until the other is known.
                self._seek(draft)
            else:
                self._amend(fresh)

    def accept_answer(self, answer: Answer) -> bool:
        """Take in the answer to a question for a target's way; false when it is one to something else."""
        if not answer.order.key.startswith(self._prefix):
            return False
        beside = next((asked for asked in self._beside if asked.key == answer.order.key), None)
        if beside is not None:
            self.found.emit(replace(self._answered(self._beside.pop(beside), answer), is_checked=False))
            return True
        if self._asked is None or answer.order.key != self._asked.key:
            return True
        asked, self._asked = self._asked, None
        draft = self._board.draft
        if draft is None or draft.kind != CONE or self._checks.has_order:
            return True
        if (draft.robot, draft.points[0]) == (asked.robot, asked.goal):
            self._amend(self._answered(draft, answer))
        return True

    def _has_changed(self, draft: Draft) -> bool:
        report, way = self._report_of(draft.robot), draft.way
        place = _place(report)
        if place is None:
            return False
        if not way.line:
            # What was refused is asked for again when the operator sets the target again.
            return way.kind is WayKind.UNKNOWN and not way.refusal
        return math.dist(place, way.line[0]) > MOVED_M or way.declared != (report and report.paths)

    def _seek(self, draft: Draft) -> None:
        now, goal = self._clock(), draft.points[0]
        asked = self._asked
        if asked is not None and (asked.robot, asked.goal) == (draft.robot, goal):
            if now - asked.at > SLOW_AFTER:
                self._asked = None
                self._amend(replace(draft, way=Way(WayKind.UNKNOWN, refusal=_unanswered())))
            return
        if draft.way.kind is not WayKind.SOUGHT and now - self._asked_at < ASK_EVERY:
            return
        asked = self._ask(draft)
        if asked is not None:
            self._asked, self._asked_at = asked, now
        elif draft.way.kind is WayKind.SOUGHT:
            self._amend(replace(draft, way=Way(WayKind.UNKNOWN, refusal=_unanswered())))

    def _ask(self, draft: Draft) -> _Asked | None:
        """Ask for the way of a target; return None where that cannot be asked."""
        goal, now = draft.points[0], self._clock()
        place = _place(self._report_of(draft.robot))
        if place is None:
            return None
        # By its place and not by the robot: of that a newer question, for the way to the mouse, would have
        # the gateway refuse this one.
        request = GetRoute(*goal, start=place)
        key = f"{self._prefix}{next(self._numbers)}"
        try:
            self._submit(Order(key, request.method, to_json(request), now))
        except NotSentError:
            return None
        return _Asked(key, draft.robot, goal, now)

    def _give_up_beside(self) -> None:
        now = self._clock()
        for asked, draft in list(self._beside.items()):
            if now - asked.at > SLOW_AFTER:
                del self._beside[asked]
                refused = Way(WayKind.UNKNOWN, refusal=_unanswered())
                self.found.emit(replace(draft, way=refused, is_checked=False))

    def _answered(self, draft: Draft, answer: Answer) -> Draft:
        report = self._report_of(draft.robot)
        place = _place(report)
        declared = None if report is None else report.paths
        route, why = way_in(answer)
        if route is None and declared == "asks":
            # It asks the same router, and is told the same.
            return replace(draft, way=Way(WayKind.UNKNOWN, refusal=_no_way(why)))
        if route is None or route.note or len(route.points) < 2:
            if place is None:
                return replace(draft, way=Way(WayKind.UNKNOWN, note=_nowhere(draft.robot)))
            return self._straight(draft, place, _no_way(why if route is None else route.note))
        kind = WayKind.PATH if declared in TAKES_CONES else WayKind.ASKED
        way = Way(kind, tuple(route.points), in_words(route, SHORTEST), declared=declared)
        return replace(draft, way=way)

    def _straight(self, draft: Draft, place: Point, note: str) -> Draft:
        report = self._report_of(draft.robot)
        declared = None if report is None else report.paths
        way = Way(WayKind.STRAIGHT, (place, draft.points[0]), note, declared=declared)
        return replace(draft, way=way)

    def _amend(self, draft: Draft) -> None:
        """Put a draft with another way in place of the present one, and have it checked."""
        self._is_amending = True
        try:
            self._checks.amend(replace(draft, is_checked=False))
        except FleetError as error:
            refused = replace(draft.findings, refused=(str(error),))
            self._board.renew(replace(draft, findings=refused, is_checked=True))
        finally:
            self._is_amending = False


def _place(report: RobotReport | None) -> Point | None:
    if report is None or report.x is None or report.y is None:
        return None
    return report.x, report.y


def _no_way(why: str) -> str:
    return tr("No way along the roads leads there: {why}.", why=why.rstrip("."))


def _not_declared(robot: str) -> str:
    return tr(
        "{robot} has not declared that it asks for its path or takes cones with one: sent now it drives "
        "straight. Add to queue, with a route around what is in its way, where that is not wanted.",
        robot=robot,
    )


def _nowhere(robot: str) -> str:
    return tr(
        "It is not known where {robot} is, so nobody has looked at the way that it drives.", robot=robot
    )


def _unanswered() -> str:
    return tr(
        "The gateway does not answer which way leads there. Set the target again when the link is there."
    )
