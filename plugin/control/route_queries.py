"""Routes along the roads asked of the gateway: to the mouse, and to the pending command's target."""

from __future__ import annotations

import itertools
import math
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.messages.base import to_json
from ...robot_bridge.core.messages.positions import RobotReport
from ...robot_bridge.core.messages.roads import GetRoute, RouteReport, route_report
from ..gateway_client.fleet_state import FleetState, OperatorRequest, RequestResult
from ..ui.errors import FleetError, NotSentError
from ..ui.language import tr
from .pending_command import CONE, ROUTE, Approach, ApproachKind, PendingCommand, PendingCommandModel, Point
from .request_tracker import SLOW_AFTER, RequestSender
from .validation import ValidationRunner

UNANSWERED_AFTER = 3.0
"""Seconds after which a question that follows the mouse is taken to be lost, so that the next is asked."""


@dataclass(frozen=True)
class RoutePreferences:
    """The shortest way along all roads, unless something else is wanted.

    ``surfaces`` names those that may be used, none of them: all. ``least_width`` is what a road must have,
    in metres, beside the width of the site's robots. ``avoid_reserved`` leaves out the roads on which other
    robots' tasks lead.
    """

    fastest: bool = False
    surfaces: tuple[str, ...] = ()
    least_width: float = 0.0
    avoid_reserved: bool = False

    def in_words(self) -> list[str]:
        """Return what is wanted beyond the shortest way, a text for each."""
        words = []
        if self.fastest:
            words.append(tr("the fastest way"))
        if self.avoid_reserved:
            words.append(tr("off the roads of other robots"))
        if self.surfaces:
            words.append(tr("only on {surfaces}", surfaces=", ".join(self.surfaces)))
        if self.least_width:
            words.append(tr("roads at least {metres:g} m wide", metres=self.least_width))
        return words


SHORTEST = RoutePreferences()


@dataclass(frozen=True)
class RouteQuestion:
    """A robot's way from where it is, or from ``start``, to ``goal``; ``taken`` when that was clicked."""

    robot: str
    start: Point | None
    goal: Point
    taken: bool = False
    wishes: RoutePreferences = SHORTEST


class RouteQuery(QObject):
    """Asks as often as the gateway answers, and never twice at once: what is shown is never long outdated."""

    shown = pyqtSignal()
    """There is another way to show, or none."""
    answered = pyqtSignal(object, object)
    """A question that was taken: the :class:`RouteQuestion` and its RouteReport."""
    refused = pyqtSignal(str)
    """There is no way to where the operator clicked: why."""

    def __init__(
        self,
        sender: RequestSender,
        clock: Clock,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._sender = sender
        self._clock = clock
        self._numbers = itertools.count(1)
        self._pending: tuple[str, RouteQuestion, float] | None = None
        self._next: RouteQuestion | None = None
        self.route: RouteReport | None = None
        self.wishes = SHORTEST
        """What was wanted of that way."""
        self.why_not = ""
        """Why there is no way to where the mouse is."""

    @property
    def awaits_click(self) -> bool:
        """Whether a way to where the operator clicked is still to be answered."""
        if not self._waits():
            return False
        return self._pending[1].taken or (self._next is not None and self._next.taken)

    def want(self, question: RouteQuestion) -> None:
        """Ask for a way, now or when the question before is answered; raises NotSentError."""
        if self._waits():
            if self._next is None or not self._next.taken or question.taken:
                self._next = question
            return
        self._ask(question)

    def forget(self) -> None:
        """Show no way, and take no answer any more."""
        self._pending = self._next = self.route = None
        self.why_not = ""
        self.shown.emit()

    def accept_answer(self, answer: RequestResult) -> bool:
        """Take in the answer to a question; false when it is one to something else."""
        if answer.order.method != GetRoute.method:
            return False
        if self._pending is None or answer.order.key != self._pending[0]:
            return True
        question, self._pending = self._pending[1], None
        self._show(question, *route_in(answer))
        self._ask_next()
        return True

    def watch(self) -> None:
        """Give up a question that waits for its answer too long, and say so of one that was taken.

        One that only follows the mouse is given up when another waits behind it.
        """
        if self._pending is None or self._waits():
            return
        question = self._pending[1]
        if not question.taken and self._next is None:
            return
        self._pending = None
        if question.taken:
            self._show(question, None, _click_unanswered())
        self._ask_next()

    def _waits(self) -> bool:
        """Whether a question is asked whose answer may still come in time."""
        if self._pending is None:
            return False
        _, question, requested_at = self._pending
        return self._clock.steady() - requested_at < (SLOW_AFTER if question.taken else UNANSWERED_AFTER)

    def _ask_next(self) -> None:
        following, self._next = self._next, None
        if following is None:
            return
        try:
            self._ask(following)
        except NotSentError:
            self.forget()

    def _show(self, question: RouteQuestion, route: RouteReport | None, why_not: str) -> None:
        self.route, self.wishes, self.why_not = route, question.wishes, why_not
        self.shown.emit()
        if question.taken and self.route is not None:
            self.answered.emit(question, self.route)
        elif question.taken:
            self.refused.emit(self.why_not)

    def _ask(self, question: RouteQuestion) -> None:
        from_robot = question.start is None
        request = GetRoute(
            *question.goal,
            robot=question.robot if from_robot else None,
            start=question.start,
            **_restrictions(question.wishes),
        )
        key = f"route-{id(self)}-{next(self._numbers)}"
        self._sender.submit(OperatorRequest(key, request.method, to_json(request), self._clock.steady()))
        self._pending = key, question, self._clock.steady()


def route_in(answer: RequestResult) -> tuple[RouteReport | None, str]:
    """Return the way that the answer to a GetRoute holds, and why it holds none."""
    if answer.error is not None:
        return None, answer.error
    try:
        return route_report(answer.result or {}), ""
    except (KeyError, TypeError, ValueError):
        return None, tr("the gateway's answer holds no way; it may be older than this plugin")


def _click_unanswered() -> str:
    return tr(
        "The gateway has not answered for {seconds:g} s which way leads to where you clicked, so the route "
        "does not go there. Click there again.",
        seconds=SLOW_AFTER,
    )


def _restrictions(wishes: RoutePreferences) -> dict[str, Any]:
    """Return wishes as the question's parameters."""
    return {**asdict(wishes), "surfaces": list(wishes.surfaces) or None}


def route_in_words(route: RouteReport, wishes: RoutePreferences, apart: str = "; ") -> str:
    """Return a way's length, time and surfaces, what was wanted of it, and what is not as it should be.

    ``apart`` stands between these.
    """
    minutes, seconds = divmod(round(route.seconds), 60)
    time = (
        tr(
            "{minutes} min {seconds} s",
            minutes=minutes,
            seconds=seconds,
        )
        if minutes
        else tr("{seconds} s", seconds=seconds)
    )
    surfaces = [(one.metres, one.surface or tr("surface not known")) for one in route.surfaces]
    # Of one surface the metres are those of the way, which cuts corners that the roads' have.
    parts = (
        [tr("{metres:.0f} m {surface}", metres=metres, surface=surface) for metres, surface in surfaces]
        if len(surfaces) > 1
        else [surface for _, surface in surfaces]
    )
    text = ", ".join([tr("{metres:.1f} m", metres=route.metres), time, *parts])
    if wishes.in_words():
        text += apart + ", ".join(wishes.in_words())
    if route.tight:
        text += apart + tr("corners tighter than the robot turns: {tight}", tight=len(route.tight))
    return text + apart + route.note if route.note else text


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


class _TargetQuery(NamedTuple):
    key: str
    robot: str
    goal: Point
    at: float


class TargetRoutes(QObject):
    """Keeps the way to the cone target or route on ``board`` as it is driven from where its robot is now.

    To a target along the roads where the site has some, by the gateway's router; straight where there are
    none, where no way leads there, where the robot can be told none, and where the operator chose that. To
    the beginning of a route it is straight.
    """

    found = pyqtSignal(object)
    """The way of a target that is not on the map any more, but was sent before it was known: the Draft."""

    def __init__(
        self,
        board: PendingCommandModel,
        checks: ValidationRunner,
        state: FleetState,
        sender: RequestSender,
        parent: QObject,
    ):
        super().__init__(parent)
        self._board, self._checks = board, checks
        self._state, self._sender, self._clock = state, sender, state.clock
        self._prefix, self._numbers = f"target-way-{id(self)}-", itertools.count(1)
        self._pending: _TargetQuery | None = None
        self._beside: dict[_TargetQuery, PendingCommand] = {}
        """Questions for the ways of targets that go out when they are known."""
        self._requested_at = -math.inf
        self._is_amending = False
        board.changed.connect(self.watch)

    def set_command(self, draft: PendingCommand) -> None:
        """Make ``draft`` the one on the map, with its way as far as that is known, and have it checked.

        :raises FleetError: when there is no site or a layer cannot be read; what was on the map stays then.
        """
        self._checks.set_command(self._begun(draft))

    def is_outdated(self, draft: PendingCommand) -> bool:
        """Tell whether a draft's robot is not where its way begins any more."""
        place = _robot_position(self._state.report_of(draft.robot))
        line = draft.way.line
        return bool(line) and place is not None and math.dist(place, line[0]) > OUTDATED_M

    def seek_beside(self, draft: PendingCommand) -> None:
        """Find the way of a target that is no more on the map; ``found`` tells of it."""
        query = self._ask(draft)
        if query is None:
            refused = Approach(ApproachKind.UNKNOWN, refusal=_target_unanswered())
            self.found.emit(replace(draft, way=refused, is_checked=False))
        else:
            self._beside[query] = draft

    def withdraw(self) -> list[PendingCommand]:
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
            # Begun again for each half metre, a long check would never end.
            return
        if draft.way.kind is ApproachKind.SOUGHT:
            self._seek(draft)
        elif self._has_changed(draft):
            fresh = self._begun(draft)
            if fresh.way.kind is ApproachKind.SOUGHT and draft.way.kind in (
                ApproachKind.PATH,
                ApproachKind.ON_REQUEST,
            ):
                # The one before stays on the map until the other is known.
                self._seek(draft)
            else:
                self._amend(fresh)

    def accept_answer(self, answer: RequestResult) -> bool:
        """Take in the answer to a question for a target's way; false when it is one to something else."""
        if not answer.order.key.startswith(self._prefix):
            return False
        beside = next((query for query in self._beside if query.key == answer.order.key), None)
        if beside is not None:
            self.found.emit(replace(self._answered(self._beside.pop(beside), answer), is_checked=False))
            return True
        if self._pending is None or answer.order.key != self._pending.key:
            return True
        query, self._pending = self._pending, None
        draft = self._board.draft
        if draft is None or draft.kind != CONE or self._checks.has_order:
            return True
        if (draft.robot, draft.points[0]) == (query.robot, query.goal):
            self._amend(self._answered(draft, answer))
        return True

    def _begun(self, draft: PendingCommand) -> PendingCommand:
        """Return a draft with its way as far as it is known at once; another kind of draft as it is."""
        if draft.kind not in DRIVEN_TO:
            return draft
        report = self._state.report_of(draft.robot)
        place = _robot_position(report)
        if place is None:
            return replace(draft, way=Approach(ApproachKind.UNKNOWN, note=_position_unknown(draft.robot)))
        if draft.kind == ROUTE or draft.is_direct or self._state.site is None or not self._state.site.roads:
            return self._straight(draft, place, "")
        if report is not None and report.paths is None:
            return self._straight(draft, place, _not_declared(draft.robot))
        return replace(draft, way=Approach(ApproachKind.SOUGHT))

    def _has_changed(self, draft: PendingCommand) -> bool:
        report, way = self._state.report_of(draft.robot), draft.way
        place = _robot_position(report)
        if place is None:
            return False
        if not way.line:
            # What was refused is asked for again when the operator sets the target again.
            return way.kind is ApproachKind.UNKNOWN and not way.refusal
        return math.dist(place, way.line[0]) > MOVED_M or way.declared != (report and report.paths)

    def _seek(self, draft: PendingCommand) -> None:
        now, goal = self._clock.steady(), draft.points[0]
        query = self._pending
        if query is not None and (query.robot, query.goal) == (draft.robot, goal):
            if now - query.at > SLOW_AFTER:
                self._pending = None
                self._amend(replace(draft, way=Approach(ApproachKind.UNKNOWN, refusal=_target_unanswered())))
            return
        if draft.way.kind is not ApproachKind.SOUGHT and now - self._requested_at < ASK_EVERY:
            return
        query = self._ask(draft)
        if query is not None:
            self._pending, self._requested_at = query, now
        elif draft.way.kind is ApproachKind.SOUGHT:
            self._amend(replace(draft, way=Approach(ApproachKind.UNKNOWN, refusal=_target_unanswered())))

    def _ask(self, draft: PendingCommand) -> _TargetQuery | None:
        """Ask for the way of a target; return None where that cannot be asked."""
        goal, now = draft.points[0], self._clock.steady()
        place = _robot_position(self._state.report_of(draft.robot))
        if place is None:
            return None
        # By its place and not by the robot: of that a newer question, for the way to the mouse, would have
        # the gateway refuse this one.
        request = GetRoute(*goal, start=place)
        key = f"{self._prefix}{next(self._numbers)}"
        try:
            self._sender.submit(OperatorRequest(key, request.method, to_json(request), now))
        except NotSentError:
            return None
        return _TargetQuery(key, draft.robot, goal, now)

    def _give_up_beside(self) -> None:
        now = self._clock.steady()
        for query, draft in list(self._beside.items()):
            if now - query.at > SLOW_AFTER:
                del self._beside[query]
                refused = Approach(ApproachKind.UNKNOWN, refusal=_target_unanswered())
                self.found.emit(replace(draft, way=refused, is_checked=False))

    def _answered(self, draft: PendingCommand, answer: RequestResult) -> PendingCommand:
        report = self._state.report_of(draft.robot)
        place = _robot_position(report)
        declared = None if report is None else report.paths
        route, why = route_in(answer)
        if route is None and declared == "asks":
            # It asks the same router, and is told the same.
            return replace(draft, way=Approach(ApproachKind.UNKNOWN, refusal=_no_route(why)))
        if route is None or route.note or len(route.points) < 2:
            if place is None:
                return replace(draft, way=Approach(ApproachKind.UNKNOWN, note=_position_unknown(draft.robot)))
            return self._straight(draft, place, _no_route(why if route is None else route.note))
        kind = ApproachKind.PATH if declared in TAKES_CONES else ApproachKind.ON_REQUEST
        way = Approach(kind, tuple(route.points), route_in_words(route, SHORTEST), declared=declared)
        return replace(draft, way=way)

    def _straight(self, draft: PendingCommand, place: Point, note: str) -> PendingCommand:
        report = self._state.report_of(draft.robot)
        declared = None if report is None else report.paths
        way = Approach(ApproachKind.STRAIGHT, (place, draft.points[0]), note, declared=declared)
        return replace(draft, way=way)

    def _amend(self, draft: PendingCommand) -> None:
        """Put a draft with another way in place of the present one, and have it checked."""
        self._is_amending = True
        try:
            self._checks.amend(replace(draft, is_checked=False))
        except FleetError as error:
            refused = replace(draft.findings, refused=(str(error),))
            self._board.renew(replace(draft, findings=refused, is_checked=True))
        finally:
            self._is_amending = False


def _robot_position(report: RobotReport | None) -> Point | None:
    if report is None or report.x is None or report.y is None:
        return None
    return report.x, report.y


def _no_route(why: str) -> str:
    return tr("No way along the roads leads there: {why}.", why=why.rstrip("."))


def _not_declared(robot: str) -> str:
    return tr(
        "{robot} has not declared that it asks for its path or takes cones with one: sent now it drives "
        "straight. Add to queue, with a route around what is in its way, where that is not wanted.",
        robot=robot,
    )


def _position_unknown(robot: str) -> str:
    return tr(
        "It is not known where {robot} is, so nobody has looked at the way that it drives.", robot=robot
    )


def _target_unanswered() -> str:
    return tr(
        "The gateway does not answer which way leads there. Set the target again when the link is there."
    )
