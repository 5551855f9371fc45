"""Queue of the selected robot: tasks in their order, edits, pause and continue."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from qgis.PyQt.QtCore import QMimeData, QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QFont, QKeyEvent
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QSizePolicy,
    QStackedWidget,
    QToolButton,
    QTreeView,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.queues import (
    AddTasks,
    MakeCurrent,
    MoveTask,
    PauseQueue,
    QueueReport,
    QueueState,
    QueueTask,
    RemoveTask,
    ResumeQueue,
    TaskReport,
    TaskState,
)
from ..control.fleet_controller import FleetController
from ..control.messages import Level, QueueCondition, Topic, queue_state_topic, queue_topic
from ..control.pending_command import PendingCommand
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.state_words import (
    last_ended_in_words,
    queue_in_words,
    task_in_words,
    task_state_in_words,
)
from ..ui.actions import Actions
from ..ui.errors import FleetError, NotSentError
from ..ui.glyphs import WRONG, WRONG_STYLE, for_letters
from ..ui.language import plain_tip, tr
from ..ui.steady_widgets import ElidedText, SteadyButton
from ..ui.tables import RowModel, ZoomMenu, shrink_view

QueueRequest = MoveTask | RemoveTask | MakeCurrent | PauseQueue | ResumeQueue

CHANGED_MEANWHILE = tr("Not done: the queue has changed since you saw it. This is how it stands now.")
PERHAPS_DONE = tr(
    "The link was lost before the answer, and the queue has changed, perhaps by this. So it stands now."
)


class QueueEdits(QObject):
    """Requests changes at the revision shown, so that no other operator's change is overwritten unseen.

    Each method that changes one queue, but :meth:`add`, returns the request's key, None when it could not be
    sent: then the desk has reported why.
    """

    changed = pyqtSignal()
    """A request was sent, or the gateway answered."""

    def __init__(self, desk: FleetController, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._pending: dict[str, str] = {}
        self._conflicts: dict[str, str] = {}
        desk.orders.answered.connect(self._answered)
        desk.state.site_changed.connect(self._clear)

    def awaits_answer(self, robot: str) -> bool:
        """Return whether a request about this queue has not been answered yet."""
        return robot in self._pending.values()

    def check_answered(self, robot: str) -> None:
        """Raise NotSentError where a request about this queue has not been answered yet."""
        if self.awaits_answer(robot):
            raise NotSentError(
                tr(
                    "The gateway has not answered yet what was asked of the queue of {robot} before. Try "
                    "again in a moment.",
                    robot=robot,
                )
            )

    def conflict(self, robot: str) -> str:
        """Return the error of a change that came too late; empty after the next one."""
        return self._conflicts.get(robot, "")

    def add(
        self,
        robot: str,
        tasks: Sequence[QueueTask],
        words: str,
        override: str | None = None,
        draft: PendingCommand | None = None,
    ) -> str:
        """Append tasks to a robot's queue; ``words`` describe them, ``override`` as in AddTasks.

        The ``draft`` that they were made from is restored by a refusal. Returns the request's key.

        :raises NotSentError: when it cannot be sent, or an answer about this queue is due.
        """
        self.check_answered(robot)
        request = AddTasks(robot, self._revision(robot), list(tasks), override=override)
        key = self._desk.orders.ask(request, words, draft=draft)
        self._record(key, robot)
        return key

    def move(self, robot: str, task: str, before: str | None) -> str | None:
        """Move a task in front of task ``before``, or to the end."""
        request = MoveTask(robot, self._revision(robot), task, before)
        return self._change(request, tr("Moving a task of {robot}", robot=robot), self._waiting(robot, task))

    def remove(self, robot: str, task: str) -> str | None:
        """Remove a task from a queue."""
        request = RemoveTask(robot, self._revision(robot), task)
        words = tr("Removing a task of {robot}", robot=robot)
        return self._change(request, words, self._waiting(robot, task))

    def make_current(self, robot: str, task: str) -> str | None:
        """Make a task the current one, at once unless the queue is paused."""
        request = MakeCurrent(robot, self._revision(robot), task)
        return self._change(request, tr("A task of {robot} first", robot=robot), self._waiting(robot, task))

    def pause(self, robot: str) -> str | None:
        """Pause a queue: the robot is sent no further task."""
        words = tr("Pausing the queue of {robot}", robot=robot)
        return self._change(PauseQueue(robot), words, self.state_topic(robot))

    def pause_robots(self, robots: Iterable[str]) -> None:
        """Make robots stand, and keep their tasks."""
        for key, robot in self._desk.pause_robots(robots).items():
            self._record(key, robot)

    def go_on(self, queues: Sequence[QueueReport]) -> None:
        """Continue queues, each at its head, which is named in the message."""
        of = {queue.robot: queue for queue in queues}

        def ask(robot: str) -> str:
            queue, words = of[robot], tr("{robot} continues", robot=robot)
            if queue.tasks:
                words = tr("{robot} continues with {task}", robot=robot, task=task_in_words(queue.tasks[0]))
            request = ResumeQueue(robot, queue.revision)
            return self._desk.orders.ask(request, words, self.state_topic(robot))

        asked = self._desk.orders.ask_each(of, ask, tr("Continue for {robot}"))
        for key, robot in asked.items():
            self._record(key, robot)

    def resume(self, robot: str) -> str | None:
        """Continue a paused queue."""
        words = tr("Resuming the queue of {robot}", robot=robot)
        return self._change(ResumeQueue(robot, self._revision(robot)), words, self.state_topic(robot))

    def _revision(self, robot: str) -> int:
        return self._desk.state.queues.revision(robot)

    def state_topic(self, robot: str) -> Topic:
        """Return the topic of a queue: it ends when its state changes."""
        return queue_state_topic(robot, self._desk.state.queues.get(robot))

    def _waiting(self, robot: str, task: str) -> Topic:
        return queue_topic(QueueCondition(robot, task=task))

    def _change(self, request: QueueRequest, words: str, *topics: Topic) -> str | None:
        try:
            key = self._desk.orders.ask(request, words, *topics)
        except FleetError as error:
            self._desk.report_failure(str(error), *error.topics)
            return None
        self._record(key, request.robot)
        return key

    def _record(self, key: str, robot: str) -> None:
        self._pending[key] = robot
        self._conflicts.pop(robot, None)
        self.changed.emit()

    def _answered(self, answer: RequestResult) -> None:
        robot = self._pending.pop(answer.order.key, None)
        if robot is None:
            return
        if answer.outdated:
            self._conflicts[robot] = PERHAPS_DONE if answer.may_be_done else CHANGED_MEANWHILE
        self.changed.emit()

    def _clear(self) -> None:
        self._pending.clear()
        self._conflicts.clear()
        self.changed.emit()


class PauseActions(QObject):
    """Connects both actions to the selected robots.

    *Pause robot* is always enabled, like all that stops robots; *Continue* is disabled where none of them has
    a paused queue.
    """

    def __init__(self, desk: FleetController, edits: QueueEdits, actions: Actions, parent: QObject):
        super().__init__(parent)
        self._desk = desk
        self._edits = edits
        self._go_on = actions.go_on
        actions.pause.triggered.connect(self._pause)
        actions.go_on.triggered.connect(self._continue)
        desk.selection.changed.connect(self._enable)
        desk.state.queues_changed.connect(self._enable)
        desk.state.site_changed.connect(self._enable)
        self._enable()

    def _pause(self) -> None:
        if not self._desk.selection.robots:
            self._desk.warning.emit(
                tr("No robot is selected, so none was paused. Select it in the table or on the map.")
            )
        self._edits.pause_robots(self._desk.selection.robots)

    def _continue(self) -> None:
        self._edits.go_on(self._paused())

    def _paused(self) -> list[QueueReport]:
        queues = (self._desk.state.queues.get(robot) for robot in self._desk.selection.robots)
        return [queue for queue in queues if queue is not None and queue.state is QueueState.PAUSED]

    def _enable(self, *_: object) -> None:
        self._go_on.setEnabled(bool(self._paused()))


COLUMNS = ("", tr("Task"), tr("State"))
MIME = "application/x-fleet-task"
DEAD_TIME = 1.0
"""Seconds for which a click does not resume a queue that another operator has paused: it may mean *Pause*."""
NUMBER, TASK, STATE = range(3)


class TaskModel(RowModel):
    """One row for each task. A drop changes nothing here: it is requested, and reported by the gateway."""

    move_requested = pyqtSignal(str, object)
    """A task, and the one that it must precede or None for the end."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(COLUMNS, parent)

    @property
    def tasks(self) -> list[TaskReport]:
        """The tasks, first to last."""
        return self.rows

    def show_tasks(self, tasks: list[TaskReport]) -> None:
        """Show these tasks."""
        self.show_rows(tasks, lambda task: task.task)

    def data(self, index: QModelIndex, role: int = 0) -> object:
        task, column = self.rows[index.row()], index.column()
        if role == Qt.ItemDataRole.DisplayRole:
            return (str(index.row() + 1), task_in_words(task), task_state_in_words(task))[column]
        if role == Qt.ItemDataRole.ToolTipRole:
            added = tr("added by {by}", by=task.added_by)
            return plain_tip(f"{task_in_words(task)}\n{task_state_in_words(task)}\n{added}")
        if role == Qt.ItemDataRole.FontRole and task.state is TaskState.CURRENT:
            bold = QFont()
            bold.setBold(True)
            return bold
        if role == Qt.ItemDataRole.ForegroundRole and task.state is TaskState.FAILED and column == STATE:
            return for_letters(WRONG)
        return None

    def flags(self, index: QModelIndex) -> Qt.ItemFlag:
        if not index.isValid():
            return Qt.ItemFlag.ItemIsDropEnabled
        flags = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        if self.rows[index.row()].state is not TaskState.CURRENT:
            flags |= Qt.ItemFlag.ItemIsDragEnabled
        return flags

    def supportedDropActions(self) -> Qt.DropAction:
        return Qt.DropAction.MoveAction

    def mimeTypes(self) -> list[str]:
        return [MIME]

    def mimeData(self, indexes: list[QModelIndex]) -> QMimeData:
        mime = QMimeData()
        mime.setData(MIME, self.rows[indexes[0].row()].task.encode())
        return mime

    def dropMimeData(
        self, data: QMimeData, action: Qt.DropAction, row: int, column: int, parent: QModelIndex
    ) -> bool:
        task = bytes(data.data(MIME)).decode()
        if task not in [one.task for one in self.rows]:
            # The drag began when another robot was selected, or the task is done.
            return False
        at = parent.row() if row < 0 and parent.isValid() else row
        self.want_at(task, len(self.rows) if at < 0 else at)
        # Not True: the view would remove the row that it considers moved.
        return False

    def want_at(self, task: str, row: int) -> None:
        """Request that a task precede the one in ``row`` now; nothing if it does already."""
        first = 1 if self.rows and self.rows[0].state is TaskState.CURRENT else 0
        row = max(first, row)
        here = next(k for k, one in enumerate(self.rows) if one.task == task)
        if here < first or row in (here, here + 1):
            return
        before = self.rows[row].task if row < len(self.rows) else None
        self.move_requested.emit(task, before)


class TaskList(QTreeView):
    """The list: drag a task to its new place, or move the selected one with Alt and the arrow keys."""

    remove_requested = pyqtSignal(str)
    first_requested = pyqtSignal(str)

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_queue_tasks")
        self.setAccessibleName(tr("Queue"))
        self.tasks = TaskModel(self)
        self.setModel(self.tasks)
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setAlternatingRowColors(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setDragDropMode(QAbstractItemView.DragDropMode.DragDrop)
        self.setDefaultDropAction(Qt.DropAction.MoveAction)
        self.setDropIndicatorShown(True)
        shrink_view(self)
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(TASK, QHeaderView.ResizeMode.Stretch)
        for column, widest in ((NUMBER, "000"), (STATE, tr("waiting: robot"))):
            self.setColumnWidth(column, self.fontMetrics().horizontalAdvance(widest) + 14)

    def show_tasks(self, tasks: list[TaskReport]) -> None:
        """Show these tasks; the selected one stays selected."""
        chosen = self.chosen
        self.tasks.show_tasks(tasks)
        row = next((k for k, task in enumerate(tasks) if task.task == chosen), None)
        if row is not None:
            self.setCurrentIndex(self.tasks.index(row, 0))

    @property
    def chosen(self) -> str | None:
        """The selected task."""
        rows = self.selectionModel().selectedRows()
        return self.tasks.tasks[rows[0].row()].task if rows else None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        task = self.chosen
        keys = Qt.Key
        if task is None:
            super().keyPressEvent(event)
        elif event.modifiers() & Qt.KeyboardModifier.AltModifier and event.key() in (
            keys.Key_Up,
            keys.Key_Down,
            keys.Key_Home,
            keys.Key_End,
        ):
            self._move(task, event.key())
        elif event.key() == keys.Key_Delete:
            self.remove_requested.emit(task)
        elif event.key() in (keys.Key_Return, keys.Key_Enter):
            # Without Ctrl, Enter shows the place: a slip must not make a robot drive off.
            if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
                self.first_requested.emit(task)
        else:
            super().keyPressEvent(event)

    def _move(self, task: str, key: int) -> None:
        count = len(self.tasks.tasks)
        here = next(k for k, one in enumerate(self.tasks.tasks) if one.task == task)
        rows = {
            Qt.Key.Key_Up: here - 1,
            Qt.Key.Key_Down: here + 2,
            Qt.Key.Key_Home: 0,
            Qt.Key.Key_End: count,
        }
        self.tasks.want_at(task, min(max(0, rows[key]), count))


class QueuePanel(QWidget):
    """Shows one queue and requests changes; nothing is moved here before the gateway has reported it.

    A double click on a task requests its place on the map.
    """

    place_requested = pyqtSignal(float, float)
    """The goal of a task, metres in the site frame."""

    def __init__(self, desk: FleetController, edits: QueueEdits, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_queue")
        self._desk = desk
        self._edits = edits
        self._head = ElidedText("fleet_queue_head")
        self._conflict = ElidedText("fleet_queue_conflict")
        self._conflict.setStyleSheet(WRONG_STYLE)
        self._last = ElidedText("fleet_queue_last")
        self._shown_hold: tuple[str | None, bool] = (None, False)
        """The robot that the button pauses or resumes, and whether it resumes it."""
        self._pressed_hold = self._shown_hold
        self._resumes_from = 0.0
        """The time on the desk's clock from which a click may resume it."""
        self._foot = QStackedWidget()
        """The conflict while there is one; else the task that ended last."""
        self.list = TaskList()
        self._buttons(
            tr("Move the selected task one up (Alt+Up)"),
            tr("Move the selected task one down (Alt+Down)"),
        )
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 2, 0, 0)
        rows.setSpacing(3)
        # Aligned at the top: when the panel shrinks, the end of the list is cut.
        rows.addLayout(self._row)
        rows.addWidget(self._head)
        rows.addWidget(self.list, 1)
        for line in (self._last, self._conflict):
            self._foot.addWidget(line)
        self._foot.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        rows.addWidget(self._foot)
        self._listen()
        self._show()

    def _buttons(self, up: str, down: str) -> None:
        self._up = _button("fleet_queue_up", "▲", up)
        self._down = _button("fleet_queue_down", "▼", down)
        self._remove = _button("fleet_queue_remove", tr("Remove"), tr("Take the selected task out (Delete)"))
        self._first = _button(
            "fleet_queue_first",
            tr("Do now"),
            tr("Let the robot do the selected task at once; what it is doing comes next (Ctrl+Enter)"),
        )
        self._hold = _button("fleet_queue_hold", tr("Pause"), "", (tr("Resume"),))
        self._row = QHBoxLayout()
        self._row.setSpacing(4)
        for button in (self._up, self._down, self._remove, self._first, self._hold):
            self._row.addWidget(button, 1)

    def _listen(self) -> None:
        tasks = self.list
        tasks.tasks.move_requested.connect(self._move)
        tasks.remove_requested.connect(lambda task: self._ask(self._edits.remove, task))
        tasks.first_requested.connect(lambda task: self._ask(self._edits.make_current, task))
        tasks.selectionModel().selectionChanged.connect(self._show_buttons)
        ZoomMenu(tasks).requested.connect(lambda index: self._go(index.row()))
        self._up.clicked.connect(lambda: self._step(-1))
        self._down.clicked.connect(lambda: self._step(2))
        self._remove.clicked.connect(lambda: self._chosen(self._edits.remove))
        self._first.clicked.connect(lambda: self._chosen(self._edits.make_current))
        self._hold.pressed.connect(self._note_pressed)
        self._hold.clicked.connect(self._hold_or_resume)
        self._desk.state.queues_changed.connect(self._show)
        self._edits.changed.connect(self._show)
        self._desk.selection.changed.connect(self._show)

    def _show(self, *_: object) -> None:
        queue = self._queue()
        self._head.setText(self._in_words(queue))
        conflict = self._edits.conflict(self._desk.selection.last or "")
        self._conflict.setText(conflict)
        self._foot.setCurrentWidget(self._conflict if conflict else self._last)
        self._last.setText(last_ended_in_words(queue) if queue else "")
        self.list.show_tasks(list(queue.tasks) if queue else [])
        self._show_buttons()

    def _show_buttons(self, *_: object) -> None:
        queue, waits = self._queue(), self._is_free()
        chosen = self.list.chosen
        task = next((one for one in queue.tasks if one.task == chosen), None) if queue else None
        movable = waits and task is not None and task.state is not TaskState.CURRENT
        for button in (self._up, self._down, self._remove, self._first):
            button.setEnabled(movable)
        paused = queue is not None and queue.state is QueueState.PAUSED
        self._note_hold(self._desk.selection.last, paused)
        self._hold.setText(tr("Resume") if paused else tr("Pause"))
        self._hold.setToolTip(
            tr("Let the robot go on with the task at the head of its queue")
            if paused
            else tr("Send the robot no further task; what it is doing it finishes (Pause robot stops it)")
        )
        # Pausing is always allowed: it waits for no answer.
        self._hold.setEnabled(self._desk.selection.last is not None and (waits or not paused))

    def _queue(self) -> QueueReport | None:
        robot = self._desk.selection.last
        return self._desk.state.queues.get(robot) if robot is not None else None

    def _is_free(self) -> bool:
        """Return whether the queue shown is up to date: no request is unanswered."""
        return not self._edits.awaits_answer(self._desk.selection.last or "")

    def _in_words(self, queue: QueueReport | None) -> str:
        if queue is not None:
            return queue_in_words(queue)
        if self._desk.selection.last is not None:
            return tr(
                "{selected} has no queue. Add a target or a route with Add to queue.",
                selected=self._desk.selection.last,
            )
        queues = list(self._desk.state.queues)
        paused = sum(one.state is QueueState.PAUSED for one in queues)
        if not queues:
            return tr("Select a robot to see its queue. None has one yet.")
        return tr(
            "Select a robot to see its queue. {queues} have one, {paused} of them paused.",
            queues=len(queues),
            paused=paused,
        )

    def _chosen(self, edit: Callable[..., object]) -> None:
        task = self.list.chosen
        if task is not None:
            self._ask(edit, task)

    def _step(self, by: int) -> None:
        task = self.list.chosen
        if task is not None:
            tasks = self.list.tasks
            here = next(k for k, one in enumerate(tasks.tasks) if one.task == task)
            tasks.want_at(task, min(max(0, here + by), len(tasks.tasks)))

    def _move(self, task: str, before: str | None) -> None:
        self._ask(self._edits.move, task, before)

    def _ask(self, edit: Callable[..., object], *how: str | None) -> None:
        robot = self._desk.selection.last
        if robot is None:
            return
        try:
            self._edits.check_answered(robot)
        except NotSentError as error:
            self._desk.warning.emit(str(error))
        else:
            edit(robot, *how)

    def _note_hold(self, robot: str | None, resumes: bool) -> None:
        """Note what the button does now, and whether the operator could expect that."""
        before, self._shown_hold = self._shown_hold, (robot, resumes)
        if self._shown_hold != before:
            is_unexpected = resumes and robot == before[0] and not self._edits.awaits_answer(robot or "")
            self._resumes_from = self._desk.clock.steady() + DEAD_TIME if is_unexpected else 0.0

    def _note_pressed(self) -> None:
        """Note what the button says: another operator's change may come before the mouse is released."""
        self._pressed_hold = self._shown_hold

    def _hold_or_resume(self) -> None:
        robot, resumes = self._pressed_hold
        if robot is None:
            return
        if not resumes:
            self._edits.pause(robot)
        elif self._desk.clock.steady() < self._resumes_from:
            text = tr(
                "The queue of {robot} was paused just before the click, so it was not resumed. Press Resume "
                "again to let it continue.",
                robot=robot,
            )
            self._desk.messages.post(text, Level.WARNING, self._edits.state_topic(robot))
        else:
            self._edits.resume(robot)

    def _go(self, row: int) -> None:
        task = self.list.tasks.tasks[row]
        self.place_requested.emit(task.x, task.y)


def _button(name: str, text: str, tip: str, others: tuple[str, ...] = ()) -> QToolButton:
    button = SteadyButton(name, (text, *others))
    button.setText(text)
    button.setToolTip(tip)
    button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
    return button
