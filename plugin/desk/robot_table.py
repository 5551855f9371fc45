"""The table of robots."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import QAbstractTableModel, QModelIndex, QSortFilterProxyModel, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView, QTableView, QWidget

from ...robot_bridge.messages import CommandReport, CommandState, SetPath, SetPosEnd
from .colours import STATE_COLOURS
from .command_book import in_words
from .desk import PULL_EVERY_MS, Desk
from .glyphs import state_icon
from .picture import STATES, RobotView

COLUMNS = ("Robot", "State", "Task", "Speed", "Batt.", "Age", "Link", "Ping")
WIDEST = ("robot-0", "offline", "", "0.0 m/s", "100%", "00.0 s", "ws", "000 ms")
TASK = COLUMNS.index("Task")
_FLAGS = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
# A number on Qt 5, an enum on Qt 6; a model has to hand out the number.
TO_THE_RIGHT = int(getattr(_FLAGS, "value", _FLAGS))
SHORT = {"websocket": "ws"}
"""Links whose names do not fit into a column."""
TO_THE_RIGHT_COLUMNS = ("Speed", "Batt.", "Age", "Ping")
SORT_ROLE = Qt.ItemDataRole.UserRole
REFRESH_EVERY = 500 // PULL_EVERY_MS


class RobotTableModel(QAbstractTableModel):
    """One row for each robot, in the order of their names."""

    def __init__(self, task_of: Callable[[str], CommandReport | None], parent: QWidget | None = None):
        super().__init__(parent)
        self._task_of = task_of
        self._views: list[RobotView] = []
        self._icons = {state: state_icon(state) for state in STATES}

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._views)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return COLUMNS[section]
        return None

    def data(self, index: QModelIndex, role: int = 0) -> object:
        view = self._views[index.row()]
        column = COLUMNS[index.column()]
        if role == Qt.ItemDataRole.DisplayRole:
            return self._text(view, column)
        if role == SORT_ROLE:
            return self._sort_value(view, column)
        if role == Qt.ItemDataRole.DecorationRole and column == "Robot":
            return self._icons[view.state]
        if role == Qt.ItemDataRole.ForegroundRole and column == "State":
            return STATE_COLOURS[view.state]
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._tip(view)
        if role == Qt.ItemDataRole.TextAlignmentRole and column in TO_THE_RIGHT_COLUMNS:
            return TO_THE_RIGHT
        return None

    def show_views(self, views: list[RobotView]) -> None:
        """Show these robots, which come in the order of their names."""
        names = [view.name for view in views]
        known = [view.name for view in self._views]
        if not set(known) <= set(names):
            self.beginResetModel()
            self._views = views
            self.endResetModel()
            return
        for row, view in enumerate(views):
            if row >= len(self._views) or self._views[row].name != view.name:
                self.beginInsertRows(QModelIndex(), row, row)
                self._views.insert(row, view)
                self.endInsertRows()
        self._views = views
        if views:
            self.dataChanged.emit(self.index(0, 0), self.index(len(views) - 1, len(COLUMNS) - 1))

    def name_at(self, row: int) -> str:
        """Return the name of the robot in ``row``."""
        return self._views[row].name

    def row_of(self, name: str | None) -> int:
        """Return the row of robot ``name``, -1 if it is not there."""
        return next((row for row, view in enumerate(self._views) if view.name == name), -1)

    def _text(self, view: RobotView, column: str) -> str:
        report = view.report
        if column == "Robot":
            return view.name
        if column == "State":
            return view.state.value
        if column == "Task":
            return _task_in_words(self._task_of(view.name), view)
        if column == "Speed":
            return "" if report.v is None else f"{report.v:.1f} m/s"
        if column == "Batt.":
            return "" if report.battery is None else f"{report.battery:.0%}"
        if column == "Ping":
            return "" if report.latency is None else f"{report.latency * 1000:.0f} ms"
        return f"{view.age:.1f} s" if column == "Age" else SHORT.get(report.link, report.link)

    def _sort_value(self, view: RobotView, column: str) -> object:
        numbers = {
            "State": STATES.index(view.state),
            "Speed": view.report.v,
            "Batt.": view.report.battery,
            "Age": view.age,
            "Ping": view.report.latency,
        }
        if column in numbers:
            return -1.0 if numbers[column] is None else float(numbers[column])
        return self._text(view, column)

    def _tip(self, view: RobotView) -> str:
        lines = [f"{view.name}: {view.state.value}, last heard {view.age:.1f} s ago over {view.report.link}"]
        if view.report.latency is not None:
            lines.append(f"its link takes {view.report.latency * 1000:.1f} ms there and back")
        if view.has_pose:
            lines.append(f"at {view.report.x:.2f}, {view.report.y:.2f} m in the site frame")
        task = self._task_of(view.name)
        if task is not None:
            lines.append(f"{in_words(task)}: {task.state.value}")
        if view.report.status:
            lines.append(f"it says: {view.report.status}")
        return "\n".join(lines)


class RobotTable(QTableView):
    """Shows the desk's robots; its selection and the desk's are one."""

    zoom_wanted = pyqtSignal(str)

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_robot_table")
        self._desk = desk
        self._pulls = 0
        self._model = RobotTableModel(desk.book.task_of, self)
        self._sorted = QSortFilterProxyModel(self)
        self._sorted.setSourceModel(self._model)
        self._sorted.setSortRole(SORT_ROLE)
        self.setModel(self._sorted)
        self._set_up()
        self.selectionModel().selectionChanged.connect(self._selected_here)
        self.doubleClicked.connect(lambda index: self.zoom_wanted.emit(self._name(index)))
        desk.selection_changed.connect(self._selected_elsewhere)
        desk.pulled.connect(self._pulled)

    def refresh(self) -> None:
        """Show what the desk knows at this moment."""
        self._model.show_views(self._desk.picture.views(self._desk.clock()))
        self._selected_elsewhere()

    def _set_up(self) -> None:
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setSortingEnabled(True)
        self.sortByColumn(0, Qt.SortOrder.AscendingOrder)
        self.verticalHeader().hide()
        shrink(self)
        metrics = self.fontMetrics()
        self.verticalHeader().setDefaultSectionSize(metrics.height() + 8)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setMinimumSectionSize(24)
        for column, texts in enumerate(zip(COLUMNS, WIDEST, strict=True)):
            extra = 28 if column == 0 else 9
            self.setColumnWidth(column, max(map(metrics.horizontalAdvance, texts)) + extra)
        header.setSectionResizeMode(TASK, QHeaderView.ResizeMode.Stretch)

    def _pulled(self) -> None:
        self._pulls += 1
        if self._pulls % REFRESH_EVERY == 0 or len(self._desk.picture) != self._model.rowCount():
            self.refresh()

    def _name(self, index: QModelIndex) -> str:
        return self._model.name_at(self._sorted.mapToSource(index).row())

    def _selected_here(self) -> None:
        rows = self.selectionModel().selectedRows()
        if rows:
            self._desk.select(self._name(rows[0]))

    def _selected_elsewhere(self) -> None:
        row = self._model.row_of(self._desk.selected)
        if row < 0:
            self.clearSelection()
            return
        index = self._sorted.mapFromSource(self._model.index(row, 0))
        if not self.selectionModel().isRowSelected(index.row(), QModelIndex()):
            self.selectRow(index.row())


def shrink(view: QAbstractItemView) -> None:
    """Take a size less for the cells and headers of a table in a narrow panel."""
    font = view.font()
    font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
    view.setFont(font)
    for header in view.findChildren(QHeaderView):
        header.setFont(font)


def _task_in_words(task: CommandReport | None, view: RobotView) -> str:
    if task is None:
        return view.report.status or ("stopped" if view.report.stopped else "")
    what = {SetPosEnd.__name__: "cone" if task.params.get("cone") else "target", SetPath.__name__: "route"}
    if task.state is CommandState.ACKNOWLEDGED:
        return "on its route" if task.op == SetPath.__name__ else f"to its {what.get(task.op, task.op)}"
    return f"{what.get(task.op, task.op)} {task.state.value}"
