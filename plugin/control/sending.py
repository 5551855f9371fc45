"""Sending of a pending command once it has been validated, and of drafts displaced meanwhile."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from qgis.PyQt.QtCore import QObject, pyqtSignal
from qgis.PyQt.QtWidgets import QApplication

from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask
from .messages import Topic, draft_topic, robot_topic
from .pending_command import ApproachKind, PendingCommand, PendingCommandModel, in_brief
from .request_tracker import RequestTracker
from .validation import TargetRoutes, ValidationRunner, Work

Then = Callable[[PendingCommand], None]


class OutgoingCommand(NamedTuple):
    """A draft, and the action to perform once it has been checked."""

    draft: PendingCommand
    then: Then


class OutgoingCommands(QObject):
    """Checks drafts afresh one after the other, in the order of the presses, beside the draft on the map.

    The next one is checked when the one before has been sent: its target counts for the others. It also waits
    while the gateway's answer about its robot is due: a queue has another revision by then.
    """

    changed = pyqtSignal()
    """A draft was added or removed, or its check progressed."""
    failed = pyqtSignal(object, str)
    """A draft cannot be checked: the PendingCommand, and why."""

    def __init__(self, work: Work, orders: RequestTracker, parent: QObject | None = None):
        super().__init__(parent)
        self._work, self._orders = work, orders
        self._waiting: deque[OutgoingCommand] = deque()
        self._slices = CooperativeTask(self)
        for signal in (orders.answered, orders.slow):
            signal.connect(self._stop_waiting)

    def __len__(self) -> int:
        return len(self._waiting)

    @property
    def first(self) -> PendingCommand | None:
        """The draft being checked; None for none."""
        return self._waiting[0].draft if self._waiting else None

    @property
    def share(self) -> float:
        """The part of its check that is done, 0 to 1."""
        return self._slices.share

    def add(self, draft: PendingCommand, then: Then) -> None:
        """Check ``draft`` after those already waiting, then call ``then`` with it."""
        self._waiting.append(OutgoingCommand(draft, then))
        if len(self._waiting) == 1:
            self._check_first()
        self.changed.emit()

    def restart_checks(self) -> None:
        """Discard the findings so far: a layer has changed under the check."""
        if self._waiting:
            self._check_first()

    def withdraw(self) -> list[PendingCommand]:
        """Drop all of them, and return them."""
        self._slices.stop()
        drafts = [one.draft for one in self._waiting]
        self._waiting.clear()
        if drafts:
            self.changed.emit()
        return drafts

    def _stop_waiting(self, *_: object) -> None:
        if self._waiting and not self._slices.is_busy:
            self._check_first()

    def _check_first(self) -> None:
        self._slices.stop()
        if self._orders.expects_answer(self._waiting[0].draft.robot):
            return
        # Never within the press that added it: the draft on the map is not settled yet.
        work = self._work(self._waiting[0].draft, True)
        self._slices.begin_soon(work, self._checked, self._cannot_be_checked)

    def _checked(self, draft: PendingCommand) -> None:
        try:
            self._waiting.popleft().then(draft)
        finally:
            self._continue()

    def _cannot_be_checked(self, error: FleetError) -> None:
        self.failed.emit(self._waiting.popleft().draft, str(error))
        self._continue()

    def _continue(self) -> None:
        if self._waiting:
            self._check_first()
        self.changed.emit()


class CommandSender(QObject):
    """Sends no draft that has changed meanwhile, nor one with warnings that the operator has not seen.

    A draft that is sent before its check has ended is sent when it has, even if another one has been
    begun meanwhile. A double click sends once.
    """

    failed = pyqtSignal(str, object)
    """A draft was not sent: the text, which must be seen by the operator, and its topics."""
    warning = pyqtSignal(str)
    """There is no draft to send."""
    waiting_changed = pyqtSignal()
    """A target whose way is sought will be sent as soon as that is known, or no longer."""

    def __init__(
        self,
        drafts: PendingCommandModel,
        checks: ValidationRunner,
        ways: TargetRoutes,
        orders: RequestTracker,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._drafts, self._checks, self._ways, self._orders = drafts, checks, ways, orders
        self._awaits_way: PendingCommand | None = None
        self.outgoing = OutgoingCommands(checks.work, orders, self)
        self._pressed: tuple[PendingCommand, float] | None = None
        """The draft sent by the last press, and when."""
        self.outgoing.failed.connect(self._not_checked)
        checks.displaced.connect(self.outgoing.add)
        checks.found.connect(self._way_found)
        drafts.changed.connect(self._changed)
        ways.found.connect(self._found_later)
        checks.overtaken.connect(self._overtaken)
        orders.refused.connect(self._refused)

    def send(self) -> None:
        """Send the draft after a fresh check; warn without one, or when it cannot be sent."""
        draft = self._drafts.draft
        if self.is_second_press():
            return
        if draft is None:
            self.warning.emit(
                tr(
                    "There is nothing to send. Select a robot, then set a cone target or draw a route on "
                    "the map."
                )
            )
            return
        try:
            self._send_when_known(draft)
        except FleetError as error:
            self._fail(tr("{in_words} was not sent: {error}", in_words=draft.in_words(), error=error), draft)

    def _send_when_known(self, draft: PendingCommand) -> None:
        """Send the draft, or a target whose way is still sought as soon as that is known."""
        self._orders.check_standstill()
        if draft.way.kind is ApproachKind.SOUGHT:
            self._set_waiting(draft)
            return
        if self._ways.is_outdated(draft):
            text = tr(
                "{in_words} was not sent: {robot} has moved since its way was found. It is found again from "
                "where the robot is now; send it when it is drawn.",
                in_words=draft.in_words(),
                robot=draft.robot,
            )
            self._fail(text, draft)
            return
        self.order(self._send)

    @property
    def awaits_way(self) -> bool:
        """Whether the target on the map is sent as soon as its way is known."""
        return self._awaits_way is not None

    def _set_waiting(self, draft: PendingCommand | None) -> None:
        self._awaits_way = draft
        self.waiting_changed.emit()

    def _way_found(self, draft: PendingCommand) -> None:
        """Send the target whose way is known by now, if that was requested."""
        waiting = self._awaits_way
        if waiting is None or draft.way.kind is ApproachKind.SOUGHT:
            return
        self._set_waiting(None)
        if (draft.robot, draft.points) == (waiting.robot, waiting.points):
            self.send()

    def _changed(self) -> None:
        """Send a target whose way is sought beside another draft that was begun meanwhile."""
        waiting, draft = self._awaits_way, self._drafts.draft
        if waiting is None:
            return
        if draft is None or (draft.robot, draft.points) != (waiting.robot, waiting.points):
            self._set_waiting(None)
            if draft is not None:
                # Undo must not return to a draft that is being sent.
                self._drafts.forget_changes()
                self._ways.seek_beside(waiting)

    def _found_later(self, draft: PendingCommand) -> None:
        known = draft.findings.warnings
        self.outgoing.add(draft, lambda checked: self._order(checked, known, self._send))

    def order(self, order: Callable[[PendingCommand], None]) -> None:
        """Check the draft on the map afresh, then call ``order`` with it.

        Not if it was changed by then, nor if the operator has not seen its present warnings. When ``order``
        raises a FleetError, that is reported, and the draft is on the map again.

        :raises FleetError: when it cannot be checked, or was not asked for now.
        """
        draft = self._drafts.draft
        assert draft is not None
        self._orders.check_standstill()
        self._pressed = draft, time.monotonic()
        known = draft.findings.warnings

        def then(checked: PendingCommand) -> None:
            self._order(checked, known, order)

        if len(self.outgoing):
            # Drafts sent before go first.
            self._drafts.done()
            self.outgoing.add(draft, then)
        else:
            self._checks.again(then)

    def is_second_press(self) -> bool:
        """Return whether this is the second press of a double click: the first has sent the draft.

        A draft that comes back refused between the two is not sent again either.
        """
        if self._pressed is None:
            return False
        pressed, at = self._pressed
        is_quick = time.monotonic() - at < QApplication.doubleClickInterval() / 1000.0
        draft = self._drafts.draft
        return is_quick and (draft is None or draft.place == pressed.place)

    def clear(self, draft: PendingCommand) -> None:
        """Take ``draft`` off the map, if it is still there: it was sent."""
        if self._drafts.draft is not None and self._drafts.draft.place == draft.place:
            self._drafts.done()

    def withdraw(self) -> None:
        """Send no draft that is still being checked: the operator wants robots to stand."""
        draft, waiting = self._drafts.draft, self._awaits_way
        self._set_waiting(None)
        withdrawn = [*self._ways.withdraw(), *self.outgoing.withdraw()]
        if (self._checks.withdraw() or waiting is not None) and draft is not None:
            withdrawn.append(draft)
        for draft in withdrawn:
            text = tr(
                "{in_words} was not sent: robots were told to stop before it had been checked.",
                in_words=draft.in_words(),
            )
            self._fail(text, draft)

    def _order(
        self, draft: PendingCommand, known: tuple[str, ...], order: Callable[[PendingCommand], None]
    ) -> None:
        unseen = [text for text in draft.findings.warnings if text not in known]
        if unseen and not draft.fault:
            text = tr(
                "{in_words} was not sent, since only now this is known: {warnings} Ask for it again to send "
                "it all the same.",
                in_words=draft.in_words(),
                warnings=in_brief(unseen),
            )
            self._refused(text, draft)
            return
        try:
            order(draft)
        except FleetError as error:
            self._refused(str(error), draft, error.topics)

    def _send(self, draft: PendingCommand) -> None:
        self._orders.send(draft)
        self.clear(draft)

    def _not_checked(self, draft: PendingCommand, why: str) -> None:
        self._refused(tr("{in_words} was not sent: {error}", in_words=draft.in_words(), error=why), draft)

    def _overtaken(self, draft: PendingCommand) -> None:
        text = tr(
            "{in_words} was not sent: the draft was changed before it had been checked. Send it anew.",
            in_words=draft.in_words(),
        )
        self.failed.emit(text, (self._robot_topic(draft),))

    def _refused(self, text: str, draft: PendingCommand | None, topics: tuple[Topic, ...] = ()) -> None:
        if draft is not None and self._drafts.draft is None:
            # A draft must not be lost because it was not sent.
            self._drafts.set_command(draft)
        self._fail(text, draft, topics)

    def _fail(self, text: str, draft: PendingCommand | None, topics: tuple[Topic, ...] = ()) -> None:
        """Report why ``draft`` was not sent, as long as it is the one on the map."""
        on_map = self._drafts.draft
        if draft is not None and on_map is not None and on_map.place == draft.place:
            topics = (*topics, draft_topic(draft.place))
        elif draft is not None:
            topics = (*topics, self._robot_topic(draft))
        self.failed.emit(text, topics)

    def _robot_topic(self, draft: PendingCommand) -> Topic:
        return robot_topic(draft.robot, self._orders.unanswered_of(draft.robot))
