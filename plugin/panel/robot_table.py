"""Table of robots with its search, filter and columns."""

from __future__ import annotations

import heapq

from qgis.core import QgsCoordinateReferenceSystem, QgsSettings
from qgis.gui import QgsFilterLineEdit, QgsProjectionSelectionDialog
from qgis.PyQt.QtCore import (
    QEvent,
    QItemSelection,
    QItemSelectionModel,
    QItemSelectionRange,
    QModelIndex,
    Qt,
    QTimer,
    pyqtSignal,
)
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QComboBox,
    QHBoxLayout,
    QHeaderView,
    QMenu,
    QSizePolicy,
    QTableView,
    QToolButton,
    QWidget,
)

from ..control.fleet_controller import FleetController
from ..gateway_client.robot_states import RemovedRobots
from ..gateway_client.state_words import part_in_words
from ..layers.site_transform import PositionCrs
from ..ui.errors import MapTransformError
from ..ui.language import tr
from ..ui.steady_widgets import ElidedText
from ..ui.tables import ZoomMenu, fit_headers, shrink_view, widen_headers
from .robot_model import COLUMNS, TASK, TITLES, RobotChoice, RobotModel

MANY = 500
"""Robots above which the table is updated half as often; with ten times as many a quarter as often."""
HIDDEN_KEY = "fleet_supervisor/robot_table/hidden"
TASK_WIDTH = 70
NAME = TITLES.index("Robot")
BESIDE_NAME = 32
"""Pixels of the icon beside a name and of Qt's margins, and two more: Qt cuts by half a pixel."""
WIDEST_NAME = 300
"""Greatest width of names in pixels; longer ones are cut in the middle, since they differ at their ends."""
LONGEST_NAMES = 20
"""Number of names among which the widest is searched: those with the most characters."""
ROWS_AT_LEAST = 4
"""Robots that are visible at once however low the panel is."""
OF_THEMES = 2
"""Pixels that QGIS's themes draw around heads and rows, and that are in no size hint."""


class RobotSelectionModel(QItemSelectionModel):
    """Signals each command of the operator, also one that changes no row: a hidden robot may be selected."""

    commanded = pyqtSignal(bool)
    """Rows were selected or deselected; whether all others were deselected."""

    def select(self, what: QItemSelection | QModelIndex, command: QItemSelectionModel.SelectionFlag) -> None:
        super().select(what, command)
        flags = QItemSelectionModel.SelectionFlag
        changing = flags.Clear | flags.Select | flags.Deselect | flags.Toggle
        # A single index comes a second time, as a selection.
        if isinstance(what, QItemSelection) and command & changing:
            self.commanded.emit(bool(command & flags.Clear))


class RobotTableView(QTableView):
    """Shows the desk's robots; its selection and the desk's are the same.

    A click selects one robot alone. What adds to the selection or takes away from it leaves selected robots
    as they are that the filter hides.
    """

    zoom_requested = pyqtSignal(str)
    refreshed = pyqtSignal()
    """The rows have been updated."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_robot_table")
        self.setAccessibleName(tr("Robots"))
        self._desk = desk
        self._turn = desk.beat.turn()
        self._marking = self._is_reset = False
        self._is_fitting = self._is_fitted_by_hand = self._is_set_up = False
        self._fitted: tuple[int, int] = (0, 0)
        self.positions = PositionCrs(desk.project, self)
        self._model = RobotModel(desk.state.robots, desk.state.commands, desk.state.queues, self, self)
        self.setModel(self._model)
        chosen = RobotSelectionModel(self._model, self)
        chosen.commanded.connect(self._selected_here)
        self.setSelectionModel(chosen)
        self._model.modelReset.connect(self._reset)
        self._set_up()
        ZoomMenu(self).requested.connect(lambda index: self.zoom_requested.emit(self._name(index)))
        self.positions.changed.connect(self.refresh)
        desk.selection.changed.connect(self._selected_elsewhere)
        desk.state.updated.connect(self._pulled)
        # The robots known so far may be gone, or be others with the same names.
        desk.state.site_changed.connect(self.refresh)
        desk.state.robots_removed.connect(self._removed)

    @property
    def robots(self) -> RobotModel:
        """The model: the filter is set there."""
        return self._model

    def refresh(self) -> None:
        """Show the desk's current state."""
        # Rows that a filter hides lose their selection; the desk's stays.
        self._marking = True
        self._model.show(self._desk.clock.steady())
        self._marking = False
        self._fit_names()
        if self._is_reset:
            # Rows that only changed places kept their selection.
            self._is_reset = False
            self._mark()
        self.refreshed.emit()

    def show_column(self, column: int, shown: bool) -> None:
        """Show or hide a column, in later sessions as well."""
        self.setColumnHidden(column, not shown)
        hidden = [COLUMNS[c].title for c in range(len(COLUMNS)) if self.isColumnHidden(c)]
        QgsSettings().setValue(HIDDEN_KEY, ",".join(hidden))

    def _removed(self, gone: RemovedRobots) -> None:
        self._model.deviations.forget(gone.names)
        self.refresh()

    def _fit_names(self) -> None:
        """Fit the width of the names to their texts, as far as columns allow, until it is set by hand."""
        picture = self._desk.state.robots
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
        # A click on the head widens it for the sort indicator, which is no width set by hand.
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
        shrink_view(self)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setMinimumSectionSize(24)
        hidden = QgsSettings().value(HIDDEN_KEY)
        for number, column in enumerate(COLUMNS):
            self.setColumnWidth(number, 0)
            by_choice = column.first if hidden is None else column.title not in str(hidden).split(",")
            self.setColumnHidden(number, not by_choice)
        self._fit_to_font()
        fit_headers(self)
        header.setSectionResizeMode(TASK, QHeaderView.ResizeMode.Stretch)
        header.sectionResized.connect(self._resized)
        self._is_set_up = True

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        is_other_font = event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange)
        if is_other_font and self._is_set_up:
            # The heads get their font after this event.
            QTimer.singleShot(0, self._refit)

    def _refit(self) -> None:
        """Fit to a larger font, such as one chosen in QGIS's options meanwhile."""
        self._is_fitting = True
        self._fit_to_font()
        widen_headers(self)
        self._is_fitting = False
        self._fitted = (0, 0)
        self._fit_names()
        self.updateGeometry()

    def _fit_to_font(self) -> None:
        """Make rows as high as the font needs, and columns wide enough; none becomes narrower."""
        metrics = self.fontMetrics()
        self.verticalHeader().setDefaultSectionSize(metrics.height() + 8)
        for number, column in enumerate(COLUMNS):
            # Qt leaves three pixels free at either side of a text; beside a name there is an icon.
            extra = BESIDE_NAME if number == NAME else 7
            widest = max(map(metrics.horizontalAdvance, (column.head, column.widest))) + extra
            least = max(widest, TASK_WIDTH if number == TASK else 0)
            # For a hidden column this is its width when shown.
            self.setColumnWidth(number, max(self.columnWidth(number), least))
        # The last column, which takes the rest, keeps room for its head.
        self.horizontalHeader().setMinimumSectionSize(
            max(24, metrics.horizontalAdvance(COLUMNS[TASK].head) + 9)
        )

    def least_height(self) -> int:
        """Return the height in pixels of :data:`ROWS_AT_LEAST` rows."""
        rows = ROWS_AT_LEAST * self.verticalHeader().defaultSectionSize()
        beside = self.horizontalScrollBar().sizeHint().height() + 2 * self.frameWidth()
        return self.horizontalHeader().sizeHint().height() + rows + beside + OF_THEMES

    def _pulled(self) -> None:
        count = len(self._desk.state.robots)
        half_seconds = 1 if count <= MANY else 2 if count <= 10 * MANY else 4
        if self._turn.is_due(half_seconds) or count != self._model.count():
            self.refresh()

    def _name(self, index: QModelIndex) -> str:
        return self._model.name_at(index.row())

    def place_in_words(self, x: float, y: float) -> str:
        """Return the text of a position, given in metres in the site frame."""
        try:
            return self.positions.place_in_words(x, y, self._desk.site_to_canvas.transform())
        except MapTransformError:
            return tr("no such place")

    def _selected_here(self, is_alone: bool) -> None:
        if self._marking:
            return
        names = [self._name(index) for index in self.selectionModel().selectedRows()]
        # Drafts are made for the robot clicked last.
        current = self.currentIndex()
        last = self._name(current) if current.isValid() else ""
        names.sort(key=lambda name: name == last)
        others = self._desk.selection.robots
        hidden = [] if is_alone else [name for name in others if not self._model.rows_of([name])]
        self._desk.selection.select_all([*hidden, *names])

    def _selected_elsewhere(self) -> None:
        self._mark()
        rows = self._model.rows_of(self._desk.selection.robots)
        if len(rows) == 1:
            self.scrollTo(self._model.index(rows[0], 0))

    def _reset(self) -> None:
        self._is_reset = True

    def _mark(self) -> None:
        rows = self._model.rows_of(self._desk.selection.robots)
        if set(rows) == {i.row() for i in self.selectionModel().selectedRows()}:
            return
        selection = QItemSelection()
        for row in rows:
            index = self._model.index(row, 0)
            selection.append(QItemSelectionRange(index))
        flags = QItemSelectionModel.SelectionFlag
        self._marking = True
        if rows:
            # Keyboard navigation continues from the robot that drafts are made for.
            self.selectionModel().setCurrentIndex(self._model.index(rows[-1], 0), flags.NoUpdate)
        self.selectionModel().select(selection, flags.ClearAndSelect | flags.Rows)
        self._marking = False


WGS84 = "EPSG:4326"
AROUND_SEARCH = 40
"""Pixels of the magnifying glass and the field's margins."""
ROBOT_CHOICES = {
    RobotChoice.ALL: tr("All robots"),
    RobotChoice.TROUBLED: tr("With alarms, or not fresh"),
    RobotChoice.BUSY: tr("With a task"),
    RobotChoice.IDLE: tr("Without a task"),
}


class RobotPanel(QWidget):
    """The line of filters: typing filters the table at once; it shows how many of how many are listed.

    The table itself is placed above it: as the part of the panel that shrinks for others it must move no
    button.
    """

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self.table = RobotTableView(desk)
        self._search = _search_field()
        self._which = _choice_of_robots()
        self._count = _counter()
        self._columns = self._columns_button()
        self._lay_out()
        self._search.textChanged.connect(self._narrow)
        self._which.currentIndexChanged.connect(self._narrow)
        self.table.refreshed.connect(self._show_count)

    def mark_troubled(self, robots: set[str]) -> None:
        """Set which robots have alarms."""
        self.table.robots.set_troubled(robots)

    def _columns_button(self) -> QToolButton:
        button = QToolButton()
        button.setObjectName("fleet_robot_columns")
        button.setText(tr("Columns"))
        button.setToolTip(tr("Which columns are shown, and in which CRS positions are"))
        button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        button.setMenu(QMenu(button))
        button.menu().aboutToShow.connect(self._fill_menu)
        return button

    def _lay_out(self) -> None:
        head = QHBoxLayout(self)
        head.setContentsMargins(0, 0, 0, 0)
        head.setSpacing(4)
        head.addWidget(self._search, 1)
        head.addWidget(self._which)
        head.addWidget(self._count)
        head.addWidget(self._columns)

    def _narrow(self, *_what: object) -> None:
        which = list(RobotChoice)[self._which.currentIndex()]
        self.table.robots.set_filter(self._search.text(), which)
        self._desk.view.search(self._search.text())
        self.table.refresh()

    def _show_count(self) -> None:
        listed, all_ = self.table.robots.rowCount(), self._desk.state.robots.count
        part = tr("{listed} of {all}", listed=listed, all=all_)
        self._count.setText(f"{listed}" if listed == all_ else part)
        if note := part_in_words(self._desk.state.robots):
            self._count.setToolTip(f"{note} {tr('The search finds others by name.')}")

    def _fill_menu(self) -> None:
        menu = self._columns.menu()
        menu.clear()
        for number, column in enumerate(COLUMNS):
            if number == 0:
                continue
            action = menu.addAction(f"{column.head}: {column.tip[0].lower()}{column.tip[1:]}")
            action.setCheckable(True)
            action.setChecked(not self.table.isColumnHidden(number))
            action.toggled.connect(lambda on, number=number: self.table.show_column(number, on))
        menu.addSeparator()
        positions = self.table.positions
        inside = menu.addSection(tr("Positions in: {crs}", crs=positions.name))
        inside.setObjectName("fleet_position_crs")
        self._add_crs(menu, tr("Site frame (metres)"), QgsCoordinateReferenceSystem())
        project = self._desk.project.crs()
        if project.isValid():
            self._add_crs(menu, tr("CRS of the project ({crs})", crs=project.authid()), project)
        self._add_crs(menu, tr("Latitude, longitude (WGS 84)"), QgsCoordinateReferenceSystem(WGS84))
        menu.addAction(tr("Another CRS…")).triggered.connect(self._ask_for_crs)

    def _add_crs(self, menu: QMenu, text: str, crs: QgsCoordinateReferenceSystem) -> None:
        chosen = self.table.positions.crs
        action = menu.addAction(text)
        action.setCheckable(True)
        action.setChecked(crs == chosen if crs.isValid() else not chosen.isValid())
        action.triggered.connect(lambda: self._choose(crs))

    def _choose(self, crs: QgsCoordinateReferenceSystem) -> None:
        self.table.positions.choose(crs)
        self.table.show_column(len(COLUMNS) - 1, True)

    def _ask_for_crs(self) -> None:
        dialog = QgsProjectionSelectionDialog(self)
        dialog.setCrs(self.table.positions.crs)
        if dialog.exec():
            self._choose(dialog.crs())


def _search_field() -> QgsFilterLineEdit:
    field = QgsFilterLineEdit()
    field.setObjectName("fleet_robot_search")
    field.setShowSearchIcon(True)
    field.setPlaceholderText(tr("Search"))
    field.setAccessibleName(tr("Search robots"))
    field.setToolTip(tr("Name, state, task or link; several words have to be there all"))
    # In a narrow panel it is the first to shrink.
    field.setMinimumWidth(field.fontMetrics().horizontalAdvance(field.placeholderText()) + AROUND_SEARCH)
    return field


def _choice_of_robots() -> QComboBox:
    box = QComboBox()
    box.setObjectName("fleet_robot_filter")
    box.setAccessibleName(tr("Filter"))
    box.addItems([ROBOT_CHOICES[which] for which in RobotChoice])
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(11)
    return box


def _counter() -> ElidedText:
    label = ElidedText("fleet_robot_count")
    # If it grew with each digit it would move its neighbours.
    widest = tr("{listed} of {all}", listed=100, all=1000)
    label.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
    label.setFixedWidth(label.fontMetrics().horizontalAdvance(widest))
    label.setAlignment(Qt.AlignmentFlag.AlignCenter)
    return label
