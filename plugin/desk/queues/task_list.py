"""The tasks of one queue in their order, to be dragged into another."""

from __future__ import annotations

from qgis.PyQt.QtCore import QMimeData, QModelIndex, Qt, pyqtSignal
from qgis.PyQt.QtGui import QFont, QKeyEvent
from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView, QTreeView, QWidget

from ....robot_bridge.messages import TaskReport, TaskState
from ...language import tr
from ..colours import WRONG, for_letters
from ..row_model import RowModel
from ..small_views import shrink
from .task_words import state_in_words, task_in_words

COLUMNS = ("", tr("Task"), tr("State"))
MIME = "application/x-fleet-task"
NUMBER, TASK, STATE = range(3)


class TaskModel(RowModel):
    """One row for each task. A drop changes nothing here: it is asked for, and told by the gateway."""

    move_wanted = pyqtSignal(str, object)
    """A task, and the one that it shall stand before or None for the end."""

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
            return (str(index.row() + 1), task_in_words(task), state_in_words(task))[column]
        if role == Qt.ItemDataRole.ToolTipRole:
            added = tr("added by {by}", by=task.added_by)
            return f"{task_in_words(task)}\n{state_in_words(task)}\n{added}"
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
            # Dragged from before the robot was another, or the task was done.
            return False
        at = parent.row() if row < 0 and parent.isValid() else row
        self.want_at(task, len(self.rows) if at < 0 else at)
        # Not True: the view would take out the row that it takes for moved.
        return False

    def want_at(self, task: str, row: int) -> None:
        """Ask for a task to stand in front of what is in ``row`` now; nothing where it stands there."""
        first = 1 if self.rows and self.rows[0].state is TaskState.CURRENT else 0
        row = max(first, row)
        here = next(k for k, one in enumerate(self.rows) if one.task == task)
        if here < first or row in (here, here + 1):
            return
        before = self.rows[row].task if row < len(self.rows) else None
        self.move_wanted.emit(task, before)


class TaskList(QTreeView):
    """The list: drag a task to where it shall come, or move the selected one with Alt and the arrow keys."""

    remove_wanted = pyqtSignal(str)
    first_wanted = pyqtSignal(str)

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_queue_tasks")
        self.tasks = TaskModel(self)
        self.setModel(self.tasks)
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setAlternatingRowColors(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setDragDropMode(QAbstractItemView.DragDropMode.DragDrop)
        self.setDefaultDropAction(Qt.DropAction.MoveAction)
        self.setDropIndicatorShown(True)
        shrink(self)
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(TASK, QHeaderView.ResizeMode.Stretch)
        for column, widest in ((NUMBER, "000"), (STATE, tr("waiting: robot"))):
            self.setColumnWidth(column, self.fontMetrics().horizontalAdvance(widest) + 14)

    def show_tasks(self, tasks: list[TaskReport]) -> None:
        """Show these tasks; the one that is selected stays so."""
        chosen = self.chosen
        self.tasks.show_tasks(tasks)
        row = next((k for k, task in enumerate(tasks) if task.task == chosen), None)
        if row is not None:
            self.setCurrentIndex(self.tasks.index(row, 0))

    @property
    def chosen(self) -> str | None:
        """The task that is selected."""
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
            self.remove_wanted.emit(task)
        elif event.key() in (keys.Key_Return, keys.Key_Enter):
            # Alone it goes to the place: it must not let a robot drive off by a slip of the hand.
            if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
                self.first_wanted.emit(task)
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
