"""The fleet panel: link, robots, what to do with them, and what was done."""

from __future__ import annotations

from qgis.gui import QgsDockWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import (
    QAction,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ..language import tr
from .actions import Actions
from .colours import DOUBTFUL, for_letters
from .command_log.log_panel import CommandLog
from .conflict_panel import ConflictPanel
from .connection_panel import ConnectionPanel
from .desk import Desk
from .dock_room import LinkAndRobots, ListsWithReserve, SharingSplitter
from .draft_panel import DraftPanel
from .emergency_banner import EmergencyBanner
from .fixed_size import SteadyTabs
from .queues.queue_edits import QueueEdits
from .queues.queue_panel import QueuePanel
from .robots.robot_details import RobotDetails
from .robots.robot_panel import RobotPanel
from .tall_content import TallContent

STOP_STYLE = (
    "QPushButton { background: #C62828; color: white; font-weight: bold; border: 1px solid #8E0000;"
    " border-radius: 4px; padding: 7px; }"
    "QPushButton:hover { background: #D93636; }"
    "QPushButton:pressed { background: #8E0000; }"
)
EMERGENCY_STYLE = (
    "QPushButton { background: #FFC400; color: #7F0000; font-weight: bold; border: 2px solid #C62828;"
    " border-radius: 4px; padding: 6px; }"
    "QPushButton:hover { background: #FFD54A; }"
    "QPushButton:pressed { background: #E0A800; }"
)

LEAST_WIDTH = 404
"""Pixels of its parts, however few their words need."""
GAP = 4
"""Pixels between two parts."""


class FleetDock(QgsDockWidget):
    """As narrow as it can be made, it still shows all of its parts uncut.

    No button in it moves while its window and its splitter are left alone, whatever is reported or shown.
    What comes and goes takes its room from a list: the fields of a gateway from the robot table, the banner
    of an emergency stop from the end of the lists at the bottom.
    """

    def __init__(self, desk: Desk, actions: Actions, edits: QueueEdits, parent: QWidget | None = None):
        super().__init__(tr("Fleet"), parent)
        self.setObjectName("fleet_dock")
        self._desk = desk
        self.connection_panel = ConnectionPanel(actions.connect)
        self.robots = RobotPanel(desk)
        self.table = self.robots.table
        self.details = RobotDetails(desk, self.table.positions, self.table.robots.deviations)
        self.log = CommandLog(desk)
        self.queue_panel = QueuePanel(desk, edits)
        self.draft_panel = DraftPanel(desk, actions)
        self.conflict_panel = ConflictPanel(desk)
        self.banner = EmergencyBanner(desk, actions.clear_emergency)
        self.tabs = SteadyTabs()
        self.tabs.setObjectName("fleet_tabs")
        self._lay_out(actions)
        self.setToggleVisibilityAction(actions.panel)
        self.conflict_panel.counted.connect(self._count_conflicts)
        desk.pulled.connect(self._show_link)
        desk.link_changed.connect(self._show_link)
        self._show_link()

    def _lay_out(self, actions: Actions) -> None:
        lists = ListsWithReserve(self._lists(), self.banner)
        split = SharingSplitter(self._upper(actions), lists)
        body = QWidget()
        rows = QVBoxLayout(body)
        rows.setContentsMargins(6, 6, 6, 6)
        rows.setSpacing(GAP)
        # A least width of the widget would stand in place of what its words need, where that is more.
        rows.addStrut(LEAST_WIDTH)
        # The banner and the buttons that stop robots are outside of it: they are seen on every screen.
        rows.addWidget(TallContent(split), 1)
        rows.addWidget(self.banner)
        stops = QHBoxLayout()
        # First: of a window that is broader than its screen the right end is not seen.
        stops.addWidget(_stop_button(actions.emergency, EMERGENCY_STYLE))
        stops.addWidget(_stop_button(actions.abort_all, STOP_STYLE))
        rows.addLayout(stops)
        self.setWidget(body)

    def _upper(self, actions: Actions) -> QWidget:
        part = QWidget()
        rows = QVBoxLayout(part)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(GAP)
        rows.addWidget(LinkAndRobots(self.connection_panel, self.table), 1)
        rows.addWidget(self.robots)
        rows.addLayout(_tools(actions))
        rows.addWidget(self.draft_panel)
        return part

    def _lists(self) -> QWidget:
        self.tabs.add_page(self.log, tr("Commands"))
        self.tabs.add_page(self.queue_panel, tr("Queue"))
        self.tabs.add_page(self.details, tr("Robot"))
        self.tabs.add_page(self.conflict_panel, tr("Conflicts"))
        return self.tabs

    def _count_conflicts(self, number: int) -> None:
        self.tabs.show_colour(self.conflict_panel, for_letters(DOUBTFUL) if number else None)

    def _show_link(self) -> None:
        self.connection_panel.show_link(self._desk.link, self._desk.site, self._desk.clock())


def _tools(actions: Actions) -> QGridLayout:
    grid = QGridLayout()
    grid.setSpacing(4)
    for column, action in enumerate((actions.select, actions.follow, actions.abort)):
        grid.addWidget(tool_button(action), 0, 2 * column, 1, 2)
    road_route = tool_button(actions.road_route)
    road_route.addAction(actions.way_wishes)
    road_route.setPopupMode(QToolButton.ToolButtonPopupMode.MenuButtonPopup)
    for column, button in enumerate((tool_button(actions.cone), road_route, tool_button(actions.route))):
        grid.addWidget(button, 1, 2 * column, 1, 2)
    for column in range(6):
        grid.setColumnStretch(column, 1)
    return grid


def tool_button(action: QAction) -> QToolButton:
    """Return a button as wide as its column that does what ``action`` does."""
    button = QToolButton()
    button.setObjectName(f"{action.objectName()}_button")
    button.setDefaultAction(action)
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
    return button


def _stop_button(action: QAction, style: str) -> QPushButton:
    button = QPushButton(action.icon(), action.iconText())
    button.setObjectName(f"{action.objectName()}_button")
    button.setToolTip(action.toolTip())
    button.setStyleSheet(style)
    button.clicked.connect(action.trigger)
    return button
