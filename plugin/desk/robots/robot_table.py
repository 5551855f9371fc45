"""The table of robots."""

from __future__ import annotations

import heapq

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import (
    QItemSelection,
    QItemSelectionModel,
    QItemSelectionRange,
    QModelIndex,
    Qt,
    pyqtSignal,
)
from qgis.PyQt.QtWidgets import QAbstractItemView, QApplication, QHeaderView, QTableView, QWidget

from ...errors import PlacementError
from ...language import tr
from ..column_heads import fit_heads
from ..desk import Desk
from ..going_there import GoingThere
from ..picture import Gone
from ..small_views import shrink
from .columns import COLUMNS, TASK, TITLES
from .position_crs import PositionCrs
from .robot_model import RobotModel

MANY = 500
"""With more robots the table is renewed half as often, with ten times as many four times as seldom."""
HIDDEN_KEY = "fleet_supervisor/robot_table/hidden"
TASK_WIDTH = 70
NAME = TITLES.index("Robot")
BESIDE_NAME = 32
"""Pixels of the icon beside a name, of what Qt leaves free, and two more: Qt cuts by half a pixel."""
WIDEST_NAME = 300
"""Pixels that names get at most; longer ones are cut in their middle, since they differ at their ends."""
LONGEST_NAMES = 20
"""Names of which the widest is looked for: those of the most characters."""
ROWS_AT_LEAST = 4
"""Robots that are seen at once however low the panel is."""
OF_THEMES = 2
"""Pixels that QGIS's themes draw around heads and rows, and that stand in no size hint."""


class RobotTable(QTableView):
    """Shows the desk's robots; its selection and the desk's are one."""

    zoom_wanted = pyqtSignal(str)
    refreshed = pyqtSignal()
    """The rows are those of this moment."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_robot_table")
        self._desk = desk
        self._turn = desk.beat.turn()
        self._marking = self._is_reset = False
        self._is_fitting = self._is_fitted_by_hand = False
        self._fitted: tuple[int, int] = (0, 0)
        self.positions = PositionCrs(desk.project, self)
        self._model = RobotModel(desk.picture, desk.book, desk.queues, self)
        self._model.place_in_words = self._place
        self.setModel(self._model)
        self._model.modelReset.connect(self._reset)
        self._set_up()
        self.selectionModel().selectionChanged.connect(self._selected_here)
        GoingThere(self, lambda index: self.zoom_wanted.emit(self._name(index)))
        self.positions.changed.connect(self.refresh)
        desk.selection_changed.connect(self._selected_elsewhere)
        desk.pulled.connect(self._pulled)
        # The robots known so far may be gone, or be others by the same names.
        desk.site_changed.connect(self.refresh)
        desk.robots_removed.connect(self._removed)

    @property
    def robots(self) -> RobotModel:
        """What it shows: which robots are listed is set there."""
        return self._model

    def refresh(self) -> None:
        """Show what the desk knows at this moment."""
        # Rows that come and go with a filter take their selection with them; the desk's stays.
        self._marking = True
        self._model.show(self._desk.clock())
        self._marking = False
        self._fit_names()
        if self._is_reset:
            # Rows that only changed places took their selection along.
            self._is_reset = False
            self._mark()
        self.refreshed.emit()

    def show_column(self, column: int, shown: bool) -> None:
        """Show or hide a column, in later sessions as well."""
        self.setColumnHidden(column, not shown)
        hidden = [COLUMNS[c].title for c in range(len(COLUMNS)) if self.isColumnHidden(c)]
        QgsSettings().setValue(HIDDEN_KEY, ",".join(hidden))

    def _removed(self, gone: Gone) -> None:
        self._model.deviations.forget(gone.names)
        self.refresh()

    def _fit_names(self) -> None:
        """Give the names the room that they take, whatever the other columns have left, until a hand does."""
        picture = self._desk.picture
        known = picture.arrangement, len(picture)
        if self._is_fitted_by_hand or known == self._fitted:
            return
        self._fitted = known
        longest = heapq.nlargest(LONGEST_NAMES, self._model.names(), key=len)
        widest = max(map(self.fontMetrics().horizontalAdvance, longest), default=0) + BESIDE_NAME
        self._is_fitting = True
        # Wider only: a column that becomes narrower moves those beside it under the mouse.
        self.setColumnWidth(NAME, max(self.columnWidth(NAME), min(widest, WIDEST_NAME)))
        self._is_fitting = False

    def _resized(self, column: int, _before: int, _now: int) -> None:
        # A click on the head makes room for the mark of sorting, which is nobody's wish for a width.
        is_dragged = bool(QApplication.mouseButtons() & Qt.MouseButton.LeftButton)
        self._is_fitted_by_hand |= column == NAME and is_dragged and not self._is_fitting

    def _set_up(self) -> None:
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.setSortingEnabled(True)
        self.sortByColumn(0, Qt.SortOrder.AscendingOrder)
        self.verticalHeader().hide()
        shrink(self)
        metrics = self.fontMetrics()
        self.verticalHeader().setDefaultSectionSize(metrics.height() + 8)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setMinimumSectionSize(24)
        hidden = QgsSettings().value(HIDDEN_KEY)
        for number, column in enumerate(COLUMNS):
            # Qt leaves three pixels free at either side of a text; beside a name there is an icon.
            extra = BESIDE_NAME if number == NAME else 7
            widest = max(map(metrics.horizontalAdvance, (column.head, column.widest)))
            self.setColumnWidth(number, max(widest + extra, TASK_WIDTH if number == TASK else 0))
            by_choice = column.first if hidden is None else column.title not in str(hidden).split(",")
            self.setColumnHidden(number, not by_choice)
        fit_heads(self)
        # The column that takes what is left keeps room for its head.
        header.setMinimumSectionSize(max(24, metrics.horizontalAdvance(COLUMNS[TASK].head) + 9))
        header.setSectionResizeMode(TASK, QHeaderView.ResizeMode.Stretch)
        header.sectionResized.connect(self._resized)

    def least_height(self) -> int:
        """Return the pixels of height that :data:`ROWS_AT_LEAST` rows take."""
        rows = ROWS_AT_LEAST * self.verticalHeader().defaultSectionSize()
        beside = self.horizontalScrollBar().sizeHint().height() + 2 * self.frameWidth()
        return self.horizontalHeader().sizeHint().height() + rows + beside + OF_THEMES

    def _pulled(self) -> None:
        count = len(self._desk.picture)
        half_seconds = 1 if count <= MANY else 2 if count <= 10 * MANY else 4
        if self._turn.has_come(half_seconds) or count != self._model.count():
            self.refresh()

    def _name(self, index: QModelIndex) -> str:
        return self._model.name_at(index.row())

    def _place(self, x: float, y: float) -> str:
        try:
            return self.positions.place_in_words(x, y, self._desk.placement())
        except PlacementError:
            return tr("no such place")

    def _selected_here(self) -> None:
        rows = self.selectionModel().selectedRows()
        if self._marking or not rows:
            return
        names = [self._name(index) for index in rows]
        # Drafts are made for the one that was clicked last.
        current = self.currentIndex()
        last = self._name(current) if current.isValid() else ""
        names.sort(key=lambda name: name == last)
        self._desk.select_all(names)

    def _selected_elsewhere(self) -> None:
        self._mark()
        rows = self._model.rows_of(self._desk.selection)
        if len(rows) == 1:
            self.scrollTo(self._model.index(rows[0], 0))

    def _reset(self) -> None:
        self._is_reset = True

    def _mark(self) -> None:
        rows = self._model.rows_of(self._desk.selection)
        if set(rows) == {i.row() for i in self.selectionModel().selectedRows()}:
            return
        wanted = QItemSelection()
        for row in rows:
            index = self._model.index(row, 0)
            wanted.append(QItemSelectionRange(index))
        flags = QItemSelectionModel.SelectionFlag
        self._marking = True
        if rows:
            # Keys go on from the robot that drafts are made for.
            self.selectionModel().setCurrentIndex(self._model.index(rows[-1], 0), flags.NoUpdate)
        self.selectionModel().select(wanted, flags.ClearAndSelect | flags.Rows)
        self._marking = False
