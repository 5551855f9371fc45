"""The pending command kept ready to send: its way as its robot moves, and the findings of its checks."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.core.messages.positions import RobotReport
from ...robot_bridge.core.messages.roads import GetRoute
from ..gateway_client.fleet_state import FleetState, OperatorRequest, RequestResult
from ..ui.errors import FleetError, NotSentError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask, Steps
from .pending_command import (
    CONE,
    ROUTE,
    Approach,
    ApproachKind,
    Findings,
    PendingCommand,
    PendingCommandModel,
    Point,
)
from .request_tracker import SLOW_AFTER, RequestSender
from .route_queries import SHORTEST, route_in, route_in_words

# --- Its checks: run when it is put on the map, and again whenever something changes ---

Work = Callable[[PendingCommand, bool], Steps[PendingCommand]]
"""Takes a draft, and whether to check all of it afresh; returns the draft with the findings."""


class ValidationRunner(QObject):
    """Checks the draft on ``board``, and no other.

    Findings are for the one draft that was checked: a draft is never changed, only replaced, and with
    another one on the board the check under way is dropped. The action that was to follow it is passed on
    with ``displaced`` where another draft was begun.
    """

    progressed = pyqtSignal()
    """A check has begun, progressed or ended."""
    overtaken = pyqtSignal(object)
    """The draft was changed before the action on it: the PendingCommand as it was."""
    displaced = pyqtSignal(object, object)
    """Another draft was begun before the action on this one: the PendingCommand, and the action."""
    found = pyqtSignal(object)
    """The draft that was put on the map has been checked: the PendingCommand, with its findings."""

    def __init__(self, board: PendingCommandModel, work: Work, parent: QObject | None = None):
        super().__init__(parent)
        self._board = board
        self.work = work
        self._slices = CooperativeTask(self)
        self._draft: PendingCommand | None = None
        self._afresh = self._is_put = False
        self._then: Callable[[PendingCommand], None] | None = None
        self._restart_timer = QTimer(self)
        self._restart_timer.setSingleShot(True)
        self._restart_timer.setInterval(0)
        self._restart_timer.timeout.connect(self._restart)
        board.changed.connect(self._changed)

    @property
    def is_under_way(self) -> bool:
        """Whether the draft on the board is being checked."""
        return self._draft is not None

    @property
    def has_order(self) -> bool:
        """Whether an action on the draft is due after its check."""
        return self._then is not None

    @property
    def share(self) -> float:
        """The part of the check that is done, 0 to 1."""
        return self._slices.share

    def set_command(self, draft: PendingCommand) -> None:
        """Set ``draft`` as the one on the board; a small one has been checked when this returns.

        :raises FleetError: when it cannot be checked; what was on the board stays then.
        """
        self._check_on_board(draft, self._board.set_command)

    def amend(self, draft: PendingCommand) -> None:
        """Replace the draft on the board by ``draft``, whose way has changed; check it as ``set_command``.

        :raises FleetError: as :meth:`set_command`.
        """
        self._check_on_board(draft, self._board.renew)

    def _check_on_board(self, draft: PendingCommand, place: Callable[[PendingCommand], None]) -> None:
        before, ordered = (self._draft, self._afresh, self._is_put, self._then), self._ordered
        self._draft, self._afresh, self._is_put, self._then = draft, False, True, None
        try:
            checked = self._begin()
        except FleetError:
            self._draft, self._afresh, self._is_put, self._then = before
            self._restart_timer.start()
            raise
        self._draft = draft if checked is None else checked
        place(self._draft)
        if checked is not None:
            self._end(checked)
        if ordered is not None:
            # Undo must not return to a draft that is being sent.
            self._board.forget_changes()
            self.displaced.emit(ordered, before[3])
        self.progressed.emit()

    def again(self, then: Callable[[PendingCommand], None]) -> None:
        """Check the draft on the board afresh, then call ``then`` with it unless it was replaced by then.

        :raises FleetError: when it cannot be checked; nothing is done then.
        """
        self._draft, self._afresh, self._is_put, self._then = self._board.draft, True, False, then
        try:
            checked = self._begin()
        except FleetError:
            self._give_up()
            raise
        if checked is not None:
            self._apply(checked)
        self.progressed.emit()

    def withdraw(self) -> bool:
        """Drop the action due after the check; false where none was due."""
        had_order, self._then = self.has_order, None
        if had_order:
            self.progressed.emit()
        return had_order

    def restart_checks(self) -> None:
        """Discard the findings so far: a layer has changed under the check."""
        if self._draft is not None:
            self._slices.stop()
            # A layer that is changed feature by feature signals each change.
            self._restart_timer.start()

    def stop(self) -> None:
        """Stop checking."""
        self._give_up()

    def _changed(self) -> None:
        draft = self._board.draft
        if draft is self._draft:
            return
        # A caller that removes a draft need not be notified that it is not sent.
        ordered = self._ordered if draft is not None else None
        self._give_up()
        self._report_overtaken(ordered)
        if draft is not None and not draft.is_checked and not self._board.is_dragged:
            # Undo led to a draft whose check was not finished.
            self._draft = draft
            self._restart_timer.start()
        self.progressed.emit()

    @property
    def _ordered(self) -> PendingCommand | None:
        return self._draft if self.has_order else None

    def _report_overtaken(self, ordered: PendingCommand | None) -> None:
        if ordered is not None:
            self.overtaken.emit(ordered)

    def _begin(self) -> PendingCommand | None:
        self._restart_timer.stop()
        work = self.work(self._draft, self._afresh)
        return self._slices.begin(work, self.progressed.emit, self._apply, self._failed)

    def _restart(self) -> None:
        if self._draft is None:
            return
        try:
            checked = self._begin()
        except FleetError as error:
            self._failed(error)
            return
        if checked is not None:
            self._apply(checked)

    def _failed(self, error: FleetError) -> None:
        self._apply(replace(self._draft, findings=Findings(refused=(str(error),)), is_checked=True))

    def _apply(self, checked: PendingCommand) -> None:
        """Put the findings into the draft on the board."""
        if checked != self._draft:
            # From here on this draft is the one being checked.
            self._draft = checked
            self._board.renew(checked)
        self._end(checked)
        self.progressed.emit()

    def _end(self, checked: PendingCommand) -> None:
        then, is_put = self._then, self._is_put
        self._give_up()
        if is_put:
            self.found.emit(checked)
        if then is not None:
            then(checked)

    def _give_up(self) -> None:
        self._restart_timer.stop()
        self._slices.stop()
        self._draft, self._then = None, None
        self._afresh = self._is_put = False


# --- The way of the draft from its robot ---

MOVED_M = 0.5
"""Metres that a robot moves before the way from its position is found again."""
OUTDATED_M = 2.0
"""Distance in metres from its robot above which a way is not sent."""
ASK_EVERY = 0.25
"""Seconds between two queries for the way of a robot that moves."""
DRIVEN_TO = (CONE, ROUTE)
"""Kinds of drafts that are driven to from the robot's position."""
ASKS = ("asks", "asks and cones")
TAKES_CONES = ("cones", "asks and cones")


class _TargetQuery(NamedTuple):
    key: str
    robot: str
    goal: Point
    at: float


class TargetRoutes(QObject):
    """Keeps the way to the cone target or route on ``board`` up to date with the position of its robot.

    To a target the way is along the roads where the site has some, by the gateway's router; straight where
    there are none, where no way leads there, where the robot accepts no path, and where the operator chose
    that. To the beginning of a route it is straight.
    """

    found = pyqtSignal(object)
    """The way of a target whose draft is no longer on the map, but was sent before its way was known: the
    PendingCommand."""

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
        """Queries for the ways of targets that are sent when they are known."""
        self._requested_at = -math.inf
        self._is_amending = False
        board.changed.connect(self.watch)

    def set_command(self, draft: PendingCommand) -> None:
        """Set ``draft`` as the one on the map, with its way as far as that is known, and have it checked.

        :raises FleetError: when there is no site or a layer cannot be read; what was on the map stays then.
        """
        self._checks.set_command(self._begun(draft))

    def is_outdated(self, draft: PendingCommand) -> bool:
        """Return whether the draft's robot has left the beginning of its way."""
        place = _robot_position(self._state.report_of(draft.robot))
        line = draft.way.line
        return bool(line) and place is not None and math.dist(place, line[0]) > OUTDATED_M

    def seek_beside(self, draft: PendingCommand) -> None:
        """Find the way of a target whose draft is no longer on the map; :attr:`found` signals it."""
        query = self._ask(draft)
        if query is None:
            refused = Approach(ApproachKind.UNKNOWN, refusal=_target_unanswered())
            self.found.emit(replace(draft, way=refused, is_checked=False))
        else:
            self._beside[query] = draft

    def withdraw(self) -> list[PendingCommand]:
        """Stop seeking ways of targets that are not on the map; return them."""
        drafts, self._beside = list(self._beside.values()), {}
        return drafts

    def watch(self) -> None:
        """Find the way of the target on the map where it is not known, or has changed."""
        self._give_up_beside()
        draft = self._board.draft
        if self._is_amending or draft is None or draft.kind not in DRIVEN_TO or self._board.is_dragged:
            return
        if self._checks.has_order:
            # The draft that was checked is the one that is sent.
            return
        if draft.kind == ROUTE and self._checks.is_under_way:
            # Restarted at each half metre, a long check would never end.
            return
        if draft.way.kind is ApproachKind.SOUGHT:
            self._seek(draft)
        elif self._has_changed(draft):
            fresh = self._begun(draft)
            if fresh.way.kind is ApproachKind.SOUGHT and draft.way.kind in (
                ApproachKind.PATH,
                ApproachKind.ON_REQUEST,
            ):
                # The previous way stays on the map until the new one is known.
                self._seek(draft)
            else:
                self._amend(fresh)

    def accept_answer(self, answer: RequestResult) -> bool:
        """Handle the answer to a query for a target's way; false when it belongs to another request."""
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
        """Return a draft with the way known at once; another kind of draft unchanged."""
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
            # A refused query is sent again when the operator sets the target again.
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
        """Query the way of a target; return None where that is impossible."""
        goal, now = draft.points[0], self._clock.steady()
        place = _robot_position(self._state.report_of(draft.robot))
        if place is None:
            return None
        # By place and not by robot: a newer query of the same robot, for the way to the mouse, would make
        # the gateway refuse this one.
        request = GetRoute(*goal, start=place)
        key = f"{self._prefix}{next(self._numbers)}"
        try:
            self._sender.submit(OperatorRequest.of(key, request, now))
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
            # The robot queries the same router, and gets the same way.
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
        """Replace the present draft by one with another way, and have it checked."""
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
