"""Requests of the operator, from the press of a button to the gateway's answer."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.messages.base import DESK_REQUESTS
from ...robot_bridge.core.messages.commands import AbortAll, CommandReport, Commands, Send
from ...robot_bridge.core.messages.roads import (
    CloseRoad,
    ClosureReport,
    ConflictResolved,
    OpenRoad,
    ResolveConflict,
)
from ...robot_bridge.core.messages.robots import Abort
from ...robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyReport, EmergencyStop
from ..gateway_client.connection import ConnectionThread
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.fleet_state import FleetState, OperatorRequest, RequestResult
from ..gateway_client.request_outbox import REPEAT_WITHIN, moves_robots
from ..ui.errors import NotSentError
from ..ui.language import first_of, tr, tr_count
from .messages import Topic, conflict_topic, request_topic
from .pending_command import TARGETS, PendingCommand, Point, in_brief

SLOW_AFTER = 5.0


class AnswerReceiver(Protocol):
    """A part that sends requests to the gateway and waits for their answers."""

    def accept_answer(self, answer: RequestResult) -> bool:
        """Handle an answer; return false when it belongs to another request."""


class RequestSender(QObject):
    """Hands requests to the connection while there is a link; those that stop robots also before that.

    Each answer is handed to the part that sent the request.
    """

    failed = pyqtSignal(str)
    """A request that stops robots waits for the link: the text, which must be seen by the operator."""
    resolved = pyqtSignal(str)
    """The failure reported with this text is over."""

    def __init__(self, connection: ConnectionThread, state: FleetState, parent: QObject | None = None):
        super().__init__(parent)
        self._connection, self._state = connection, state
        self._receivers: list[AnswerReceiver] = []
        self._not_sent_yet: set[str] = set()
        """Texts shown about stops and Aborts that wait for the link."""
        state.link_changed.connect(self._link_changed)
        state.answered.connect(self._answered)

    def add_receiver(self, receiver: AnswerReceiver) -> None:
        """Offer answers to ``receiver`` that none of the receivers added before it accepts."""
        self._receivers.append(receiver)

    def submit(self, request: OperatorRequest) -> None:
        """Send a request; raises NotSentError when it cannot be sent."""
        if not (request.lasting or _may_wait_for_link(request) or DESK_REQUESTS[request.method].stops):
            # Its places and robots are those that this operator sees: no other gateway may carry it out.
            request = replace(request, ground=self._state.ground)
        if moves_robots(request):
            self.check_standstill()
        phase = self._state.link.phase
        if phase is ConnectionPhase.CONNECTED:
            self._connection.submit(request)
            return
        is_tried = self._connection.is_open and phase is not ConnectionPhase.FAILED
        if not (_may_wait_for_link(request) and is_tried):
            raise NotSentError(
                tr(
                    "the desk is not connected to a gateway. Connect first; to stop a robot now use the "
                    "robot's own emergency stop."
                )
            )
        self._connection.submit(request)
        if request.method == EmergencyStop.method:
            text = tr(
                "EMERGENCY STOP is NOT sent yet: the link is down. It is sent as soon as that is back; use "
                "the robots' own emergency stops now."
            )
        else:
            text = tr(
                "The Abort is NOT sent yet: the link is down. It is sent if that is back within "
                "{seconds:g} s; use the robots' own emergency stops now.",
                seconds=REPEAT_WITHIN,
            )
        self._not_sent_yet.add(text)
        self.failed.emit(text)

    def check_standstill(self) -> None:
        """Raise NotSentError where what is asked for now may have been clicked long ago."""
        if seconds := self._state.standstill:
            raise NotSentError(
                tr(
                    "this window, or the computer, stood still for {seconds:.0f} s, and what was clicked "
                    "meanwhile may be old. Look at the robots, then ask again.",
                    seconds=seconds,
                )
            )

    def _answered(self, answer: RequestResult) -> None:
        for receiver in self._receivers:
            if receiver.accept_answer(answer):
                return

    def _link_changed(self) -> None:
        if self._state.link.phase is ConnectionPhase.CONNECTED:
            for text in self._not_sent_yet:
                self.resolved.emit(text)
            self._not_sent_yet.clear()


def _may_wait_for_link(request: OperatorRequest) -> bool:
    """Return whether a request is an Abort or an emergency stop: these are kept while the link is down."""
    is_abort = request.method == Send.method and request.params.get("op") == Abort.__name__
    return is_abort or request.method in (EmergencyStop.method, AbortAll.method)


MOST_NAMES = 6


@dataclass(eq=False)
class RequestGroup:
    """The requests of one press for several robots: what fails of them is one message.

    ``words`` is a text with a place for ``robot``, their names.
    """

    words: str
    failed: dict[Topic, tuple[str, str]] = field(default_factory=dict)
    """By the topic of its request, the robot and the reason."""
    is_sent: bool = False
    """Whether one of those was sent, and then refused."""
    text: str = ""
    """The message, as it is shown."""
    is_news: bool = False
    """Whether more have failed than it says."""

    def words_for(self, robots: Sequence[str]) -> str:
        """Return what was requested for these robots."""
        return self.words.format(robot=", ".join(first_of(robots, MOST_NAMES)))

    def in_words(self) -> str:
        """Return what has failed so far, and why."""
        words = self.words_for([robot for robot, _ in self.failed.values()])
        why = in_brief(list(dict.fromkeys(why for _, why in self.failed.values())))
        return f"{words}: {why}" if self.is_sent else _not_sent(words, why)


@dataclass(eq=False)
class PendingRequest:
    """A request without an answer yet: its text, and the draft it came from."""

    words: str
    requested_at: float
    robot: str = ""
    draft: PendingCommand | None = None
    stops: bool = False
    is_voidable: bool = False
    """Whether a stop asked for meanwhile makes it void."""
    slow_notice: str = ""
    topics: tuple[Topic, ...] = ()
    """The subjects of a refusal."""
    group: RequestGroup | None = None


class RequestTracker(QObject):
    """Gives each press of a button its own id, hands it to the connection and reports the outcome."""

    answered = pyqtSignal(object)
    """The outcome of a request: the RequestResult."""
    refused = pyqtSignal(str, object, object)
    """A request was not carried out: the text, the draft it came from or None, and the text's topics."""
    retried = pyqtSignal(object)
    """A request is sent that may have been refused before: its Topic."""
    accepted = pyqtSignal(str)
    kept = pyqtSignal(str, str)
    """The gateway has stored a command: its id, and its text. Its steps follow as reports."""
    slow = pyqtSignal(str)
    resolved = pyqtSignal(str)
    """A request that ``slow`` reported with this text has been answered."""

    def __init__(
        self,
        sender: RequestSender,
        clock: Clock,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._sender = sender
        self._clock = clock
        self._pending: dict[str, PendingRequest] = {}
        self._group: RequestGroup | None = None
        """What the requests being made belong to."""
        self._failing: list[RequestGroup] = []
        """Groups of which a request has failed that was not made again."""

    def __len__(self) -> int:
        return len(self._pending)

    @property
    def unanswered(self) -> list[str]:
        """What was asked for and is not answered yet, in words, the oldest first."""
        return [pending.words for pending in self._pending.values()]

    def unanswered_of(self, robot: str) -> frozenset[str]:
        """Return the keys of the requests for ``robot`` that are not answered yet."""
        return frozenset(key for key, pending in self._pending.items() if pending.robot == robot)

    def expects_answer(self, robot: str) -> bool:
        """Return whether the answer to a request for ``robot`` is due, and not late yet."""
        return any(one.robot == robot and not one.slow_notice for one in self._pending.values())

    def forget_drafts(self) -> None:
        """Restore no draft that was sent before: its places are another site's."""
        for pending in self._pending.values():
            pending.draft = None
        self._failing.clear()

    def send(self, draft: PendingCommand) -> str:
        """Send a draft and return the command's id.

        :raises NotSentError: when it must not or cannot be sent; nothing was sent then.
        """
        if draft.fault:
            raise NotSentError(tr("{draft} was not sent: {fault}", draft=draft.in_words(), fault=draft.fault))
        if draft.kind == TARGETS:
            raise NotSentError(
                tr(
                    "{draft} were not sent: several targets are driven to one after the other. Press Add "
                    "to queue.",
                    draft=draft.in_words(),
                )
            )
        op, params = draft.message()
        return self._command(draft.robot, op, params, draft.in_words(), draft, draft.override)

    def check_standstill(self) -> None:
        """Raise NotSentError where what is asked for now may have been clicked long ago."""
        self._sender.check_standstill()

    def abort(self, robot: str) -> str:
        """Request an abort for one robot and return the command's id.

        :raises NotSentError: when it cannot be sent.
        """
        return self._command(robot, Abort.__name__, {}, tr("Abort of {robot}", robot=robot), None)

    def abort_all(self) -> str:
        """Request an abort for every robot and return the request's key.

        :raises NotSentError: when it cannot be sent.
        """
        command = str(uuid.uuid4())
        return self._submit(self._order(AbortAll(command), command), tr("ABORT ALL"))

    @property
    def awaits_stop(self) -> bool:
        """Whether an emergency stop was requested that the gateway has not answered yet."""
        return any(pending.stops for pending in self._pending.values())

    def emergency_stop(self) -> str:
        """Request that every robot stop, and none be sent until that is cleared; return its id.

        :raises NotSentError: when it cannot be sent.
        """
        stop = str(uuid.uuid4())
        key = self._submit(self._order(EmergencyStop(stop), stop, lasting=True), tr("EMERGENCY STOP"))
        self._pending[key].stops = True
        return key

    def clear_emergency(self, stop: str, reason: str) -> str:
        """Request that robots be released again and return the request's key.

        :raises NotSentError: when it cannot be sent.
        """
        request = ClearEmergencyStop(reason or None, stop)
        return self._submit(self._order(request), tr("Clear emergency stop"))

    def ask(self, request: Any, words: str, *topics: Topic, draft: PendingCommand | None = None) -> str:
        """Send ``request`` to the gateway, described to the operator by ``words``, and return its key.

        Its outcome is signalled with :attr:`answered`. A refusal is shown until one of ``topics`` is over;
        the ``draft`` that it was made from is restored then.

        :raises NotSentError: when it cannot be sent.
        """
        return self.submit(self._order(request), words, topics, draft)

    def ask_each(self, robots: Iterable[str], ask: Callable[[str], str], words: str) -> dict[str, str]:
        """Call ``ask``, which sends a request and returns its key, for each robot; return keys and robots.

        For several robots, all that is not sent or is refused is one message: ``words`` with their names in
        place of ``{robot}``, and why. It is over when each of them has been asked for again.
        """
        names, asked = list(robots), {}
        self._group = RequestGroup(words) if len(names) > 1 else None
        try:
            for robot in names:
                try:
                    asked[ask(robot)] = robot
                except NotSentError as error:
                    self._note_failure(self._group, robot, error)
        finally:
            self._group = None
        self._report_groups()
        return asked

    def _note_failure(self, group: RequestGroup | None, robot: str, error: NotSentError) -> None:
        if group is None:
            self.refused.emit(str(error), None, error.topics)
        else:
            self._add_failure(group, error.topics[0], robot, str(error.__cause__))

    def _add_failure(self, group: RequestGroup, topic: Topic, robot: str, why: str) -> None:
        group.failed[topic], group.is_news = (robot, why), True
        if group not in self._failing:
            self._failing.append(group)

    def _report_groups(self) -> None:
        """Show what has failed since the last call, in place of the former message of the same press."""
        for group in [one for one in self._failing if one.is_news]:
            text = group.in_words()
            if group.text:
                self.resolved.emit(group.text)
            group.text, group.is_news = text, False
            self.refused.emit(text, None, ())

    def inquire(self, request: Any, *, lasting: bool = False) -> str:
        """Query the gateway without a message to the operator, and return the request's key.

        A ``lasting`` one is repeated however long the link was lost.

        :raises NotSentError: when it cannot be sent.
        """
        order = self._order(request, lasting=lasting)
        self._sender.submit(order)
        return order.key

    def submit(
        self,
        order: OperatorRequest,
        words: str,
        topics: tuple[Topic, ...] = (),
        draft: PendingCommand | None = None,
    ) -> str:
        """Send a request that already has its key, and return that; otherwise as :meth:`ask`."""
        return self._submit(order, words, draft, topics)

    def _order(self, request: Any, key: str | None = None, *, lasting: bool = False) -> OperatorRequest:
        return OperatorRequest.of(key or str(uuid.uuid4()), request, self._clock.steady(), lasting=lasting)

    def accept_answer(self, answer: RequestResult) -> bool:
        """Handle the outcome of a request, and signal it with :attr:`answered`."""
        self._settle(answer)
        self.answered.emit(answer)
        return True

    def _settle(self, answer: RequestResult) -> None:
        pending = self._pending.pop(answer.order.key, None)
        if pending is None:
            return
        notice = pending.slow_notice
        if notice and not any(one.slow_notice == notice for one in self._pending.values()):
            self.resolved.emit(notice)
        if answer.error is not None and pending.group is not None:
            pending.group.is_sent = True
            self._add_failure(pending.group, pending.topics[0], pending.robot, str(answer.error))
            return
        if answer.error is not None:
            self.refused.emit(f"{pending.words}: {answer.error}", pending.draft, pending.topics)
            return
        result, words = answer.result or {}, pending.words
        declared = DESK_REQUESTS[answer.order.method].result
        if declared is CommandReport:
            self.kept.emit(answer.order.key, words)
        elif declared is Commands:
            count = len(result.get("commands", ()))
            self.accepted.emit(
                tr_count(count, "{words}: sent to 1 robot", "{words}: sent to %n robots", words=words)
            )
        elif declared is ConflictResolved and "text" in result:
            self.accepted.emit(f"{words}: {result['text']}")
        elif declared is not EmergencyReport or not result.get("in_force"):
            # The banner shows a stop for as long as it is in force.
            self.accepted.emit(tr("{words}: done", words=words))

    def watch(self) -> None:
        """Warn once about each request that has waited too long for its answer; report groups that failed.

        To be called when answers have been handled.
        """
        self._report_groups()
        now = self._clock.steady()
        late: dict[RequestGroup | PendingRequest, list[PendingRequest]] = {}
        for pending in self._pending.values():
            if not pending.slow_notice and now - pending.requested_at > SLOW_AFTER:
                late.setdefault(pending.group or pending, []).append(pending)
        for about, requests in late.items():
            words = about.words
            if isinstance(about, RequestGroup):
                words = about.words_for([one.robot for one in requests])
            notice = _slow_notice(requests[0], words)
            for pending in requests:
                pending.slow_notice = notice
            self.slow.emit(notice)

    def _command(
        self,
        robot: str,
        op: str,
        params: dict,
        words: str,
        draft: PendingCommand | None,
        override: str | None = None,
    ) -> str:
        command = str(uuid.uuid4())
        send = Send(command, robot, op, params, override=override)
        return self._submit(self._order(send, command), words, draft)

    def _submit(
        self,
        order: OperatorRequest,
        words: str,
        draft: PendingCommand | None = None,
        more: tuple[Topic, ...] = (),
    ) -> str:
        refusal = None
        # First, so that no fault in what is shown of it keeps back a stop.
        try:
            self._sender.submit(order)
        except NotSentError as error:
            refusal = error
        topics = topics_of(order.method, order.params) + more
        if refusal is None:
            self._pending[order.key] = PendingRequest(
                words,
                order.requested_at,
                order.params.get("robot", ""),
                draft,
                is_voidable=moves_robots(order),
                topics=topics,
                group=self._group,
            )
        self.retried.emit(topics[0])
        self._forget_failure(topics[0])
        if refusal is not None:
            raise NotSentError(_not_sent(words, refusal), topics) from refusal
        return order.key

    def _forget_failure(self, topic: Topic) -> None:
        for group in self._failing:
            group.failed.pop(topic, None)
        for group in [one for one in self._failing if not one.failed]:
            self._failing.remove(group)
            self.resolved.emit(group.text)


def _not_sent(words: str, why: object) -> str:
    return tr("{words} was NOT sent: {error}", words=words, error=why)


def _slow_notice(pending: PendingRequest, words: str) -> str:
    if pending.stops:
        return tr(
            "{words}: the gateway has not answered for {seconds:g} s, so it may not have "
            "arrived. It is repeated when the link is back; it is never done twice.",
            words=words,
            seconds=SLOW_AFTER,
        )
    if pending.is_voidable:
        return tr(
            "{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is "
            "repeated if the link is back within {limit:g} s, unless robots are asked to stop meanwhile; "
            "it is never done twice.",
            words=words,
            seconds=SLOW_AFTER,
            limit=REPEAT_WITHIN,
        )
    return tr(
        "{words}: the gateway has not answered for {seconds:g} s, so it may not have arrived. It is repeated "
        "if the link is back within {limit:g} s; it is never done twice.",
        words=words,
        seconds=SLOW_AFTER,
        limit=REPEAT_WITHIN,
    )


def topics_of(method: str, params: dict[str, Any]) -> tuple[Topic, ...]:
    """Return the topics of a refusal of this request; the first of them is the request itself."""
    robot, other = params.get("robot", ""), params.get("other", "")
    # An Abort does not retry a target that was refused.
    what = params.get("op", "") == Abort.__name__
    about = (robot, other, what, params.get("closure", ""), params.get("observation", ""))
    topics = (request_topic(method, about),)
    return (*topics, conflict_topic(robot, other)) if method == ResolveConflict.method else topics


# --- Closed roads and conflicts: requests about them ---


class RoadStatus(QObject):
    """The gateway's reports of roads, and the operator's requests about them."""

    def __init__(self, state: FleetState, requests: RequestTracker, parent: QObject | None = None):
        super().__init__(parent)
        self._state, self._requests = state, requests
        self.closures_changed = state.closures_changed

    @property
    def closures(self) -> tuple[ClosureReport, ...]:
        """The roads that are closed."""
        return self._state.closures

    def close(self, place: Point, reach: float, reason: str, seconds: float | None) -> str:
        """Request that the road at ``place`` be closed and return the closure's id.

        :raises NotSentError: when that cannot be sent.
        """
        closure = str(uuid.uuid4())
        request = CloseRoad(closure, *place, reason or None, seconds, reach)
        self._requests.submit(
            self._order(closure, request),
            tr(
                "Closing the road at {x:.1f}, {y:.1f} m",
                x=place[0],
                y=place[1],
            ),
        )
        return closure

    def open(self, closure: str) -> None:
        """Request that a closed road be opened; raises NotSentError when that cannot be sent."""
        self._requests.submit(self._order(str(uuid.uuid4()), OpenRoad(closure)), tr("Opening the road"))

    def resolve(self, robot: str, other: str) -> None:
        """Request that ``robot`` give way to ``other``; raises NotSentError when that cannot be sent."""
        request = ResolveConflict(robot, other)
        self._requests.submit(
            self._order(str(uuid.uuid4()), request),
            tr(
                "{robot} gives way to {other}",
                robot=robot,
                other=other,
            ),
        )

    def _order(self, key: str, request: CloseRoad | OpenRoad | ResolveConflict) -> OperatorRequest:
        return OperatorRequest.of(key, request, self._state.clock.steady())
