"""The table of robots, and what narrows it: a search, which robots are listed, and which columns."""

from __future__ import annotations

from qgis.core import QgsCoordinateReferenceSystem
from qgis.gui import QgsFilterLineEdit, QgsProjectionSelectionDialog
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QMenu,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from ...language import tr
from ..desk import Desk
from ..fixed_size import ElidedText
from .columns import COLUMNS
from .fleet_rows import Which
from .robot_table import RobotTable

WGS84 = "EPSG:4326"
AROUND_SEARCH = 40
"""Pixels of the magnifying glass and of the field's margins."""
WHICH = {
    Which.ALL: tr("All robots"),
    Which.TROUBLED: tr("With alarms, or not fresh"),
    Which.BUSY: tr("With a task"),
    Which.IDLE: tr("Without a task"),
}


class RobotPanel(QWidget):
    """The line of filters: what is typed narrows the table at once; it says how many of how many are listed.

    The table itself stands apart, above it: as the part of the panel that gives way to others it must move no
    button.
    """

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self.table = RobotTable(desk)
        self._search = _search_field()
        self._which = _choice_of_robots()
        self._count = _counter()
        self._columns = self._columns_button()
        self._lay_out()
        self._search.textChanged.connect(self._narrow)
        self._which.currentIndexChanged.connect(self._narrow)
        self.table.refreshed.connect(self._show_count)

    def mark_troubled(self, robots: set[str]) -> None:
        """Say which robots have alarms."""
        self.table.robots.troubled = robots

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
        self.table.robots.text = self._search.text()
        self.table.robots.which = list(Which)[self._which.currentIndex()]
        self.table.refresh()

    def _show_count(self) -> None:
        listed, all_ = self.table.robots.rowCount(), self.table.robots.count()
        part = tr("{listed} of {all}", listed=listed, all=all_)
        self._count.setText(f"{listed}" if listed == all_ else part)

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
    # In a narrow panel it is the first to give way.
    field.setMinimumWidth(field.fontMetrics().horizontalAdvance(field.placeholderText()) + AROUND_SEARCH)
    return field


def _choice_of_robots() -> QComboBox:
    box = QComboBox()
    box.setObjectName("fleet_robot_filter")
    box.addItems([WHICH[which] for which in Which])
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(11)
    return box


def _counter() -> ElidedText:
    label = ElidedText("fleet_robot_count")
    # One that grew with each digit would move what is beside it.
    widest = tr("{listed} of {all}", listed=100, all=1000)
    label.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
    label.setFixedWidth(label.fontMetrics().horizontalAdvance(widest))
    label.setAlignment(Qt.AlignmentFlag.AlignCenter)
    return label
