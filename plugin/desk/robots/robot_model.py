"""The robots as a table model that sorts and filters by itself, on columns.

Qt's own proxy asks for every cell of ten thousand robots whenever one has changed; this one asks numpy.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from qgis.PyQt.QtCore import QAbstractTableModel, QModelIndex, QObject, Qt

from ....robot_bridge.messages import RobotState
from ...language import tr
from ...wire.sightings import STATES
from ..colours import STATE_COLOURS, for_letters
from ..command_book import CommandBook, in_words
from ..glyphs import state_icon
from ..item_values import TO_THE_RIGHT
from ..last_heard import heard_in_words
from ..picture import RobotPicture
from ..queue_book import QueueBook
from ..state_words import COMMAND_STATES, ROBOT_STATES
from .columns import COLUMNS, POSITION, TITLES, number_in_words, short_link
from .deviations import Deviations
from .fleet_rows import FleetRows, Rows, Which, fleet_rows

ANSWERED_ROLES = frozenset(
    {
        Qt.ItemDataRole.DisplayRole,
        Qt.ItemDataRole.DecorationRole,
        Qt.ItemDataRole.ForegroundRole,
        Qt.ItemDataRole.ToolTipRole,
        Qt.ItemDataRole.TextAlignmentRole,
    }
)
"""The item roles that this model answers; a view asks for as many others of each cell that it paints."""


class RobotModel(QAbstractTableModel):
    """One row for each robot that is listed. ``rows`` are looked at afresh by :meth:`show`."""

    def __init__(
        self, picture: RobotPicture, book: CommandBook, queues: QueueBook, parent: QObject | None = None
    ):
        super().__init__(parent)
        self.deviations = Deviations(book)
        self._queues = queues
        self._fleet: FleetRows = fleet_rows(picture, book, queues, self.deviations, 0.0)
        self._arrangement = picture.arrangement
        self._order: Rows = np.empty(0, dtype=np.intp)
        self._row_at: Rows = np.empty(0, dtype=np.intp)
        self._sorted_by = (TITLES.index("Robot"), Qt.SortOrder.AscendingOrder)
        self.which = Which.ALL
        self.text = ""
        self.troubled: set[str] = set()
        self.place_in_words = lambda x, y: f"{x:.2f}, {y:.2f}" if np.isfinite(x) else ""
        """Takes metres in the site frame and returns the text of a position."""
        self._icons = {state: state_icon(state) for state in STATES}

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._order)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if orientation != Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return COLUMNS[section].head
        return COLUMNS[section].tip if role == Qt.ItemDataRole.ToolTipRole else None

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if role not in ANSWERED_ROLES:
            return None
        row = int(self._order[index.row()])
        column = COLUMNS[index.column()]
        if role == Qt.ItemDataRole.DisplayRole:
            return self._text(row, column.title)
        if role == Qt.ItemDataRole.DecorationRole and column.title == "Robot":
            return self._icons[self._state(row)]
        if role == Qt.ItemDataRole.ForegroundRole and column.title == "State":
            return for_letters(STATE_COLOURS[self._state(row)])
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._tip(row)
        if role == Qt.ItemDataRole.TextAlignmentRole and column.is_number:
            return TO_THE_RIGHT
        return None

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        self._sorted_by = (column, order)
        self._put(self._wanted())

    def show(self, moment: float) -> None:
        """Show what is known at ``moment`` of the desk's clock."""
        picture = self._fleet.picture
        fleet = fleet_rows(picture, self._fleet.book, self._queues, self.deviations, moment)
        if picture.arrangement != self._arrangement:
            # Rows of another arrangement are other robots.
            self._arrangement = picture.arrangement
            self.beginResetModel()
            self._fleet = fleet
            self._take(self._wanted())
            self.endResetModel()
            return
        self._fleet = fleet
        self._put(self._wanted())

    def count(self) -> int:
        """Return how many robots there are, listed or not."""
        return len(self._fleet)

    def names(self) -> list[str]:
        """Return the names of all robots, listed or not."""
        return self._fleet.names

    def name_at(self, row: int) -> str:
        """Return the name of the robot in ``row``."""
        return self._fleet.names[self._order[row]]

    def rows_of(self, names: Iterable[str]) -> list[int]:
        """Return the rows of the robots that are listed."""
        known = (self._fleet.picture.row(name) for name in names)
        found = (int(self._row_at[row]) for row in known if row is not None and row < len(self._row_at))
        return [row for row in found if row >= 0]

    def _wanted(self) -> Rows:
        rows = self._fleet.shown(self.which, self.text, self.troubled)
        column, order = self._sorted_by
        return self._fleet.sorted(rows, TITLES[max(0, column)], order == Qt.SortOrder.DescendingOrder)

    def _put(self, order: Rows) -> None:
        if np.array_equal(order, self._order):
            self._row_at = _inverse(order, len(self._fleet))
            if len(order):
                self.dataChanged.emit(self.index(0, 0), self.index(len(order) - 1, len(COLUMNS) - 1))
        elif len(order) == len(self._order) and np.array_equal(np.sort(order), np.sort(self._order)):
            self._reorder(order)
        else:
            self.beginResetModel()
            self._take(order)
            self.endResetModel()

    def _reorder(self, order: Rows) -> None:
        self.layoutAboutToBeChanged.emit()
        before = self.persistentIndexList()
        robots = [int(self._order[index.row()]) for index in before]
        self._take(order)
        after = [
            self.index(int(self._row_at[robot]), index.column())
            for robot, index in zip(robots, before, strict=True)
        ]
        self.changePersistentIndexList(before, after)
        self.layoutChanged.emit()

    def _take(self, order: Rows) -> None:
        self._order = order
        self._row_at = _inverse(order, len(self._fleet))

    def _state(self, row: int) -> RobotState:
        return STATES[int(self._fleet.state[row])]

    def _text(self, row: int, title: str) -> str:
        fleet = self._fleet
        if title == "Robot":
            return fleet.names[row]
        if title == "State":
            return ROBOT_STATES[self._state(row)]
        if title == "Task":
            return fleet.task(row)
        if title == "Link":
            return short_link(fleet.told(row))
        if title == TITLES[POSITION]:
            return self.place_in_words(*fleet.xy[row].tolist())
        value = fleet.off(row) if title == "Off" else float(fleet.numbers[title][row])
        return number_in_words(title, value)

    def _tip(self, row: int) -> str:
        fleet, told = self._fleet, self._fleet.told(row)
        name, age = fleet.names[row], fleet.numbers["Age"][row]
        heard = heard_in_words(ROBOT_STATES[self._state(row)], age, told.get("link"))
        lines = [f"{name}: {heard}"]
        ping = fleet.numbers["Ping"][row]
        if np.isfinite(ping):
            lines.append(tr("its link takes {ms:.1f} ms there and back", ms=ping * 1000))
        x, y = fleet.xy[row].tolist()
        if np.isfinite(x) and np.isfinite(y):
            lines.append(tr("at {x:.2f}, {y:.2f} m in the site frame", x=x, y=y))
        task = fleet.book.task_of(name)
        if task is not None:
            lines.append(f"{in_words(task)}: {COMMAND_STATES[task.state]}")
        elif fleet.task(row) and not told.get("status"):
            lines.append(fleet.task(row))
        if told.get("status"):
            lines.append(tr("it says: {text}", text=told["status"]))
        return "\n".join(lines)


def _inverse(order: Rows, count: int) -> Rows:
    """Return the row in the table of each robot, -1 for those that are not listed."""
    rows = np.full(count, -1, dtype=np.intp)
    rows[order] = np.arange(len(order))
    return rows
