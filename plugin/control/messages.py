"""Messages to the operator: topics that end them, and the QGIS message bar."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Sequence
from enum import Enum
from typing import Any, NamedTuple

from qgis.core import Qgis, QgsMessageLog
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import QAbstractButton, QBoxLayout, QHBoxLayout, QLabel, QSizePolicy, QWidget

from ...robot_bridge.core.messages.administration import Suspension, Suspensions
from ...robot_bridge.core.messages.commands import CommandReport, CommandState
from ...robot_bridge.core.messages.links import LinkReport, Links
from ...robot_bridge.core.messages.queues import QueueReport, TaskState
from ...robot_bridge.core.messages.robots import Abort
from ..gateway_client.fleet_state import FleetState
from ..gateway_client.report_caches import is_pending
from ..ui.language import time_of_day, tr
from .pending_command import PendingCommandModel

# A message is posted with topics. When the condition that a topic names has ended, all messages with it are
# withdrawn, so that outdated messages do not hide current ones.

SHOWN_ROBOTS = 5
"""Robots of a link that is down, named in its message."""


class Level(Enum):
    """Severity of a message."""

    ERROR = "error"
    """Stays until it is closed or no longer true."""
    WARNING = "warning"
    INFO = "info"


class Topic(NamedTuple):
    """A condition that a message is about: its kind, and whom or what it concerns."""

    kind: str
    about: Hashable = ""


EMERGENCY = Topic("emergency")
"""An emergency stop is in force."""
OUTAGE = Topic("outage")
"""The link is down."""
SELECTION = Topic("selection")
"""Another selection of robots is needed."""
NO_DRAFT = Topic("no_draft")
"""There is no draft on the map."""
PLAN_REQUEST = Topic("plan", "asked")
"""A request about cone plans; ends with the next one."""
PLAN_SENT = Topic("plan", "sent")
"""The gateway's answer about a cone plan; ends with the next request about one, or when none is shown."""
UNPLACED = Topic("unplaced")
"""The site cannot be shown on the map."""
REPLAY = Topic("replay")
"""Data loaded for replay; ends when other data is loaded."""


def request_topic(method: str, about: Hashable) -> Topic:
    """Return the topic of a refused request: it ends when the same is requested again."""
    return Topic("request", (method, about))


def draft_topic(draft: Hashable) -> Topic:
    """Return the topic of a draft on the map: it ends when the draft is replaced or removed."""
    return Topic("draft", draft)


def plan_topic(plan: str, what: str) -> Topic:
    """Return the topic of a problem with a cone plan being driven: it ends when the problem is over."""
    return Topic("plan", (plan, what))


def conflict_topic(robot: str, other: str) -> Topic:
    """Return the topic of two robots that will be in each other's way."""
    return Topic("conflict", frozenset((robot, other)))


class QueueCondition(NamedTuple):
    """The state of a queue that a message is about; ``state`` (a QueueState's, empty without a queue) and
    ``task`` where they count."""

    robot: str
    state: str | None = None
    task: str | None = None


def queue_topic(stand: QueueCondition) -> Topic:
    """Return the topic of a queue: it ends when its state changes, or its task is no longer pending."""
    return Topic("queue", stand)


def queue_state_topic(robot: str, queue: QueueReport | None) -> Topic:
    """Return the topic of a robot's queue, None without one: it ends when its state changes."""
    return queue_topic(QueueCondition(robot, state="" if queue is None else queue.state.value))


def observation_topic(number: int) -> Topic:
    """Return the topic of an observation that waits for review."""
    return Topic("observation", number)


def file_topic(what: str) -> Topic:
    """Return the topic of a file that was not written: it ends when ``what`` is written again."""
    return Topic("file", what)


class RobotCondition(NamedTuple):
    """The activity of a robot that a message is about; ``asked`` are the commands requested before it."""

    robot: str
    asked: frozenset[str] = frozenset()


def robot_topic(robot: str, asked: frozenset[str] = frozenset()) -> Topic:
    """Return the topic of a robot's activity: it ends when the robot gets a command other than ``asked``."""
    return Topic("robot", RobotCondition(robot, asked))


class MessageBoard(QObject):
    """Keeps the topics of the messages shown, and reports which are no longer true."""

    posted = pyqtSignal(str, object)
    """A message's text and its Level."""
    withdrawn = pyqtSignal(str)
    """A message with this text is no longer true."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._topics: dict[str, frozenset[Topic]] = {}

    def post(self, text: str, level: Level, *topics: Topic) -> None:
        """Show ``text`` until the first of ``topics`` has ended, or the link changes to another fleet."""
        self._topics.pop(text, None)
        self._topics[text] = frozenset(topics)
        self.posted.emit(text, level)

    def end(self, *topics: Topic) -> None:
        """Withdraw every message with one of these topics."""
        self._withdraw(text for text, its in self._topics.items() if its.intersection(topics))

    def end_others(self, kind: str, holding: Collection[Topic]) -> None:
        """Withdraw every message with a topic of this ``kind`` that is not in ``holding``."""
        self.end_where(kind, lambda about: Topic(kind, about) not in holding)

    def end_where(self, kind: str, is_over: Callable[[Any], bool]) -> None:
        """Withdraw every message with a topic of this ``kind`` whose subject ``is_over``."""
        self._withdraw(
            text
            for text, its in self._topics.items()
            if any(topic.kind == kind and is_over(topic.about) for topic in its)
        )

    def withdraw(self, text: str) -> None:
        """Withdraw the message with this text."""
        self._topics.pop(text, None)
        self.withdrawn.emit(text)

    def clear(self) -> None:
        """Withdraw every message: they are about other robots."""
        self._withdraw(self._topics)

    def forget(self, text: str) -> None:
        """Record that a message is no longer shown: its time is over, or the operator has closed it."""
        self._topics.pop(text, None)

    def _withdraw(self, texts: Iterable[str]) -> None:
        for text in list(texts):
            self.withdraw(text)


class MessageEndings(QObject):
    """Ends topics on the board; the desk reports each change to it."""

    def __init__(
        self, messages: MessageBoard, drafts: PendingCommandModel, state: FleetState, parent: QObject
    ):
        super().__init__(parent)
        self._messages, self._drafts, self._state = messages, drafts, state
        drafts.changed.connect(self._draft_changed)
        state.conflicts_changed.connect(self._conflicts_changed)
        state.commands_changed.connect(self.commands_changed)
        state.queues_changed.connect(self._queues_changed)
        state.observations_changed.connect(self._observations_changed)

    def emergency_cleared(self) -> None:
        """End refusals due to an emergency stop."""
        self._messages.end(EMERGENCY)

    def selection_changed(self) -> None:
        """End messages that asked for another selection."""
        self._messages.end(SELECTION)

    def commands_changed(self, reports: Sequence[CommandReport]) -> None:
        """End messages about robots that have received another command since."""
        queued = [one for one in reports if one.state is CommandState.QUEUED and one.op != Abort.__name__]

        def is_over(about: RobotCondition) -> bool:
            return any(one.robot == about.robot and one.command not in about.asked for one in queued)

        self._messages.end_where("robot", is_over)

    def robots_removed(self, robots: Collection[str]) -> None:
        """End messages about robots that no longer exist."""
        self._messages.end_where("robot", lambda about: about.robot in robots)

    def _queues_changed(self) -> None:
        """End messages about queues that were paused or continued since, or tasks done since."""

        def is_over(stand: QueueCondition) -> bool:
            queue = self._state.queues.get(stand.robot)
            if stand.state is not None:
                return stand.state != ("" if queue is None else queue.state.value)
            tasks = () if queue is None else queue.tasks
            return all(task.task != stand.task or task.state is TaskState.CURRENT for task in tasks)

        self._messages.end_where("queue", is_over)

    def _observations_changed(self) -> None:
        """End messages about observations that have been reviewed since."""

        def is_over(number: int) -> bool:
            report = self._state.observations.get(number)
            return report is None or not is_pending(report)

        self._messages.end_where("observation", is_over)

    def _draft_changed(self) -> None:
        draft = self._drafts.draft
        if draft is not None:
            self._messages.end(NO_DRAFT)
        holding = set() if draft is None else {draft_topic(draft.place)}
        self._messages.end_others("draft", holding)

    def _conflicts_changed(self) -> None:
        conflicts = self._state.conflicts.conflicts
        holding = {conflict_topic(one.robot, one.other) for one in conflicts}
        self._messages.end_others("conflict", holding)


class ReportNotices(QObject):
    """Texts about the gateway's reports: posts new ones and withdraws those that are over."""

    began = pyqtSignal(str)
    over = pyqtSignal(str)

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._texts: list[str] = []

    def renew(self, texts: list[str]) -> None:
        """Post the texts that are new in ``texts``, and withdraw the former ones not in it."""
        before, self._texts = self._texts, texts
        for text in before:
            if text not in texts:
                self.over.emit(text)
        for text in texts:
            if text not in before:
                self.began.emit(text)


class SuspensionNotices(ReportNotices):
    """Texts about robots whose accounts of the database are locked."""

    def show(self, suspensions: Suspensions) -> None:
        """Show the newest report."""
        self.renew([_suspended(one) for one in suspensions.robots])


class LinkNotices(ReportNotices):
    """Texts about links to robots of another kind that are down, or whose robots have problems."""

    def show(self, links: Links) -> None:
        """Show the newest report."""
        self.renew([_not_in_order(one) for one in links.links if one.text or not one.up])


def _not_in_order(link: LinkReport) -> str:
    return tr("Link {link}: {reason}.", link=link.link, reason=link.text) if link.up else _down(link)


def _down(link: LinkReport) -> str:
    placeholders = {"link": link.link, "reason": link.text or "?"}
    if not link.count:
        return tr("Link {link} is down: {reason}.", **placeholders)
    names = ", ".join(link.robots[:SHOWN_ROBOTS])
    if link.count > SHOWN_ROBOTS:
        names = tr("{names} and {count} more", names=names, count=link.count - SHOWN_ROBOTS)
    return tr("Link {link} is down: {reason}. Nothing reaches {robots}.", robots=names, **placeholders)


def _suspended(suspension: Suspension) -> str:
    if suspension.until is None:
        return tr(
            "The program of robot {robot} keeps all others waiting at the database, and its account cannot "
            "be locked. Have an administrator run: robot-bridge database upgrade",
            robot=suspension.robot,
        )
    return tr(
        "The database account of robot {robot} is locked until {time}: its program kept all others waiting. "
        "Nothing but a stop reaches it: Abort unlocks the account. Have the program mended.",
        robot=suspension.robot,
        time=time_of_day(suspension.until),
    )


TITLE = "Fleet Supervisor"
LEVELS = {
    Level.ERROR: Qgis.MessageLevel.Critical,
    Level.WARNING: Qgis.MessageLevel.Warning,
    Level.INFO: Qgis.MessageLevel.Info,
}
SECONDS = {Qgis.MessageLevel.Info: 6, Qgis.MessageLevel.Success: 5, Qgis.MessageLevel.Warning: 12}
"""Seconds for which a text stays; critical ones stay until closed."""
BESIDE_TEXT = 190
"""Width in pixels of the bar's icons, counter and buttons."""


class MessageBar(QObject):
    """Shows texts in the message bar, without duplicates, and writes all of them to the QGIS message log.

    The newest one is on top, even if it was already shown beneath others.
    """

    closed = pyqtSignal(str)
    """A text is no longer shown."""

    def __init__(self, bar: QgsMessageBar, parent: QObject | None = None):
        super().__init__(parent)
        self._bar = bar
        self._shown: dict[str, QgsMessageBarItem] = {}
        bar.widgetRemoved.connect(self._removed)

    def show_message(self, text: str, level: Level) -> None:
        """Show a message of the desk."""
        self._show(text, LEVELS[level])

    def error(self, error: Exception | str) -> None:
        """Show an error; it stays until it is closed."""
        self._show(str(error), Qgis.MessageLevel.Critical)

    def warning(self, text: Exception | str) -> None:
        """Show a warning that the operator should act on."""
        self._show(str(text), Qgis.MessageLevel.Warning)

    def info(self, text: str) -> None:
        """Show information about what happened."""
        self._show(text, Qgis.MessageLevel.Info)

    def texts(self) -> list[str]:
        """Return the texts shown now."""
        return list(self._shown)

    def remove_text(self, text: str) -> None:
        """Remove a text that is over; one that is not shown is ignored."""
        item = self._shown.pop(text, None)
        if item is not None:
            self._bar.popWidget(item)

    def remove(self) -> None:
        """Remove all texts still shown."""
        self._bar.widgetRemoved.disconnect(self._removed)
        for item in list(self._shown.values()):
            self._bar.popWidget(item)
        self._shown.clear()

    def _show(self, text: str, level: Qgis.MessageLevel) -> None:
        hanging = self._shown.get(text)
        if hanging is not None and self._bar.currentItem() is hanging:
            return
        if hanging is None:
            QgsMessageLog.logMessage(text, TITLE, level, False)
        else:
            self.remove_text(text)
        item = QgsMessageBarItem(MessageLabel(text, self._bar), level, SECONDS.get(level, 0))
        self._shown[text] = item
        self._bar.pushItem(item)

    def _removed(self, item: QgsMessageBarItem) -> None:
        for text in [text for text, shown in self._shown.items() if shown is item]:
            del self._shown[text]
            self.closed.emit(text)


class MessageLabel(QLabel):
    """A text on as many lines as it needs; QGIS's own item cuts it after one and a half.

    It requests the width of its longest word and uses the width available: QGIS's bar makes the whole
    window as wide as the size hint of its content.
    """

    def __init__(self, text: str, bar: QgsMessageBar):
        super().__init__(f"{TITLE}: {text}", bar)
        self.setObjectName("fleet_notice")
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.setWordWrap(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._fit(max(200, bar.width() - BESIDE_TEXT))

    def show_text(self, text: str) -> None:
        """Show ``text`` in place of the other one; laying out QGIS's bar again takes time."""
        if self.text() == f"{TITLE}: {text}":
            return
        self.setText(f"{TITLE}: {text}")
        self._fit(self.width())

    def sizeHint(self) -> QSize:
        return QSize(self.minimumSizeHint().width(), super().sizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit(self.width())

    def _fit(self, width: int) -> None:
        # Qt includes the minimum height set before in the height of the text.
        self.setMinimumHeight(0)
        self.setFixedHeight(self.heightForWidth(width))


BROAD_TEXT = 360
"""Pixels of text beside which its buttons stand; with less room they stand beneath it."""


class NoticeBody(QWidget):
    """Requests only the width of its buttons, and uses the width available.

    QGIS's bar makes the whole window as wide as the size hint of its content.
    """

    def __init__(self, text: QLabel, buttons: Sequence[QAbstractButton], parent: QWidget):
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._foot = QWidget()
        row = QHBoxLayout(self._foot)
        row.setContentsMargins(0, 0, 0, 0)
        for button in buttons:
            row.addWidget(button)
        self._parts = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._parts.setContentsMargins(0, 0, 0, 0)
        self._parts.addWidget(text, 1)
        self._parts.addWidget(self._foot, 0, Qt.AlignmentFlag.AlignRight)

    def sizeHint(self) -> QSize:
        return QSize(self._foot.sizeHint().width(), super().sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        is_broad = self.width() >= BROAD_TEXT + self._foot.sizeHint().width()
        direction = QBoxLayout.Direction.LeftToRight if is_broad else QBoxLayout.Direction.TopToBottom
        if direction != self._parts.direction():
            self._parts.setDirection(direction)
