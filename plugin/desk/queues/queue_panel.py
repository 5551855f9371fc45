"""The queue of the selected robot: what it is to do one after the other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qgis.core import QgsPointXY
from qgis.PyQt.QtWidgets import QHBoxLayout, QSizePolicy, QStackedWidget, QToolButton, QVBoxLayout, QWidget

from ....robot_bridge.messages import QueueReport, QueueState, TaskState
from ...errors import FleetError
from ...language import tr
from ..colours import WRONG_STYLE
from ..desk import Desk
from ..fixed_size import ElidedText, SteadyButton
from ..going_there import GoingThere
from .queue_edits import QueueEdits
from .task_list import TaskList
from .task_words import last_ended_in_words, queue_in_words


class QueuePanel(QWidget):
    """Shows one queue and asks for its changes; nothing is moved here before the gateway says so.

    A double click on a task shows its place on the map.
    """

    def __init__(self, desk: Desk, edits: QueueEdits, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_queue")
        self._desk = desk
        self._edits = edits
        self._head = ElidedText("fleet_queue_head")
        self._conflict = ElidedText("fleet_queue_conflict")
        self._conflict.setStyleSheet(WRONG_STYLE)
        self._last = ElidedText("fleet_queue_last")
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
        # At the top: what takes room from the panel takes it from the end of the list.
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
        tasks.tasks.move_wanted.connect(self._move)
        tasks.remove_wanted.connect(lambda task: self._ask(self._edits.remove, task))
        tasks.first_wanted.connect(lambda task: self._ask(self._edits.make_current, task))
        tasks.selectionModel().selectionChanged.connect(self._show_buttons)
        GoingThere(tasks, lambda index: self._go(index.row()))
        self._up.clicked.connect(lambda: self._step(-1))
        self._down.clicked.connect(lambda: self._step(2))
        self._remove.clicked.connect(lambda: self._chosen(self._edits.remove))
        self._first.clicked.connect(lambda: self._chosen(self._edits.make_current))
        self._hold.clicked.connect(self._hold_or_resume)
        self._desk.queues_changed.connect(self._show)
        self._edits.changed.connect(self._show)
        self._desk.selection_changed.connect(self._show)

    def _show(self, *_: object) -> None:
        queue = self._queue()
        self._head.setText(self._in_words(queue))
        conflict = self._edits.conflict(self._desk.selected or "")
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
        self._hold.setText(tr("Resume") if paused else tr("Pause"))
        self._hold.setToolTip(
            tr("Let the robot go on with the task at the head of its queue")
            if paused
            else tr("Send the robot no further task; what it is doing it finishes (Pause robot stops it)")
        )
        # To hold is never in the way of anything: it waits for no answer.
        self._hold.setEnabled(self._desk.selected is not None and (waits or not paused))

    def _queue(self) -> QueueReport | None:
        robot = self._desk.selected
        return self._desk.queues.get(robot) if robot is not None else None

    def _is_free(self) -> bool:
        """Tell whether what is shown is what the gateway has: nothing asked for is without an answer."""
        return not self._edits.is_asked(self._desk.selected or "")

    def _in_words(self, queue: QueueReport | None) -> str:
        if queue is not None:
            return queue_in_words(queue)
        if self._desk.selected is not None:
            return tr(
                "{selected} has no queue. Add a target or a route with Add to queue.",
                selected=self._desk.selected,
            )
        queues = list(self._desk.queues)
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
        robot = self._desk.selected
        if robot is not None and self._is_free():
            edit(robot, *how)

    def _hold_or_resume(self) -> None:
        queue, robot = self._queue(), self._desk.selected
        if robot is not None:
            resumes = queue is not None and queue.state is QueueState.PAUSED
            (self._edits.resume if resumes else self._edits.pause)(robot)

    def _go(self, row: int) -> None:
        task = self.list.tasks.tasks[row]
        try:
            ((x, y),) = self._desk.placement().to_map(np.array([(task.x, task.y)]))
        except FleetError as error:
            self._desk.complained.emit(str(error))
            return
        self._desk.canvas.setCenter(QgsPointXY(x, y))
        self._desk.canvas.refresh()


def _button(name: str, text: str, tip: str, others: tuple[str, ...] = ()) -> QToolButton:
    button = SteadyButton(name, (text, *others))
    button.setText(text)
    button.setToolTip(tip)
    button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
    return button
