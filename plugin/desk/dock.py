"""The fleet panel: link, robots, what to do with them, and what was done."""

from __future__ import annotations

from qgis.gui import QgsDockWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import (
    QAction,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QSizePolicy,
    QSplitter,
    QTabWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ..language import tr
from .actions import Actions
from .command_log.log_panel import CommandLog
from .conflict_panel import ConflictPanel
from .connection_panel import ConnectionPanel
from .desk import Desk
from .draft_panel import DraftPanel
from .emergency_banner import EmergencyBanner
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


class FleetDock(QgsDockWidget):
    """As narrow as it can be made, it still shows all of its parts uncut."""

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
        body = QWidget()
        rows = QVBoxLayout(body)
        rows.setContentsMargins(8, 6, 8, 8)
        rows.setSpacing(6)
        # A least width of the widget would stand in place of what its words need, where that is more.
        rows.addStrut(LEAST_WIDTH)
        self.banner = EmergencyBanner(desk, actions.clear_emergency)
        rows.addWidget(self.connection_panel)
        rows.addWidget(_line())
        rows.addWidget(self.banner)
        split = QSplitter(Qt.Orientation.Vertical)
        split.setChildrenCollapsible(False)
        split.addWidget(self._upper(actions))
        split.addWidget(self._lower())
        split.setStretchFactor(0, 1)
        split.setStretchFactor(1, 1)
        # The banner and the buttons that stop robots are outside of it: they are seen on every screen.
        rows.addWidget(TallContent(split), 1)
        stops = QHBoxLayout()
        # First: of a window that is broader than its screen the right end is not seen.
        stops.addWidget(_stop_button(actions.emergency, EMERGENCY_STYLE))
        stops.addWidget(_stop_button(actions.abort_all, STOP_STYLE))
        rows.addLayout(stops)
        self.setWidget(body)
        self.setToggleVisibilityAction(actions.panel)
        desk.pulled.connect(self._show_link)
        desk.link_changed.connect(self._show_link)
        self._show_link()

    def _upper(self, actions: Actions) -> QWidget:
        part = QWidget()
        rows = QVBoxLayout(part)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(6)
        rows.addWidget(self.robots, 1)
        rows.addLayout(_tools(actions))
        rows.addWidget(self.draft_panel)
        rows.addWidget(self.conflict_panel)
        return part

    def _lower(self) -> QWidget:
        self.tabs = QTabWidget()
        self.tabs.setObjectName("fleet_tabs")
        self.tabs.setDocumentMode(True)
        self.tabs.addTab(self.log, tr("Commands"))
        self.tabs.addTab(self.queue_panel, tr("Queue"))
        self.tabs.addTab(self.details, tr("Robot"))
        return self.tabs

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


def _line() -> QFrame:
    line = QFrame()
    line.setFrameShape(QFrame.Shape.HLine)
    line.setFrameShadow(QFrame.Shadow.Sunken)
    return line
