"""The Fleet dock, and the division of its height among its parts."""

from __future__ import annotations

from qgis.gui import QgsDockWidget
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import (
    QAction,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QSizePolicy,
    QSplitter,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ..control.fleet_controller import FleetController
from ..ui.actions import Actions
from ..ui.dialogs import ShrinkableScrollArea
from ..ui.glyphs import DOUBTFUL, for_letters
from ..ui.language import tr
from ..ui.steady_widgets import SteadyTabs
from .command_log import CommandLog
from .conflict_panel import ConflictPanel
from .connection_panel import ConnectionPanel
from .emergency import EmergencyBanner
from .pending_command_panel import PendingCommandPanel
from .queue import QueueEdits, QueuePanel
from .robot_details import RobotDetails
from .robot_table import RobotPanel, RobotTableView

GAP = 4
"""Pixels between two parts."""
SHARE = 0.45
"""The upper part's share of the surplus height, until the operator moves the splitter."""


class LinkAndRobots(QWidget):
    """The link, and the robots beneath it; its height is the same with the link's fields folded or not."""

    def __init__(self, link: ConnectionPanel, table: RobotTableView):
        super().__init__()
        self._link, self._table = link, table
        # It shrinks for the fields down to the last pixel.
        table.setMinimumHeight(0)
        table.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(GAP)
        rows.addWidget(link)
        rows.addWidget(table, 1)

    def minimumSizeHint(self) -> QSize:
        folded = self._link.height_without_fields() + GAP + self._table.least_height()
        least = max(folded, self._link.height_with_fields())
        return QSize(super().minimumSizeHint().width(), least)

    def sizeHint(self) -> QSize:
        return QSize(super().sizeHint().width(), self.minimumSizeHint().height())


class ListsWithReserve(QWidget):
    """The lists at the bottom, with space reserved for the ``banner`` beneath them while that is hidden.

    The banner lies outside the scrolled area: it takes its space from here.
    """

    def __init__(self, lists: QWidget, banner: EmergencyBanner):
        super().__init__()
        self._banner = banner
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(lists)
        banner.toggled.connect(self.updateGeometry)

    def minimumSizeHint(self) -> QSize:
        needs = super().minimumSizeHint()
        return QSize(needs.width(), needs.height() + self.reserve)

    def sizeHint(self) -> QSize:
        return self.minimumSizeHint()

    @property
    def reserve(self) -> int:
        """Height in pixels reserved for the banner; none while it is shown."""
        return self._banner.sizeHint().height() + GAP if self._banner.isHidden() else 0


class SharingSplitter(QSplitter):
    """A splitter of two parts that share additional height of the window; only the lower one shrinks."""

    def __init__(self, upper: QWidget, lists: ListsWithReserve):
        super().__init__(Qt.Orientation.Vertical)
        self._lists, self._share = lists, SHARE
        self.setChildrenCollapsible(False)
        self.addWidget(upper)
        self.addWidget(lists)
        self.setStretchFactor(0, 0)
        self.setStretchFactor(1, 1)
        self.splitterMoved.connect(self._moved)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        least, free = self._least(), self._free()
        upper = least + round(self._share * free)
        if upper != self.sizes()[0]:
            self.setSizes([upper, self.height() - self.handleWidth() - upper])

    def _least(self) -> int:
        return self.widget(0).minimumSizeHint().height()

    def _free(self) -> int:
        """Surplus height in pixels; the same while the banner is shown."""
        needs = self._least() + self._lists.minimumSizeHint().height() + self.handleWidth()
        return max(0, self.height() - needs)

    def _moved(self) -> None:
        self._share = (self.sizes()[0] - self._least()) / max(1, self._free())


# The focus frame is two lines wide: the style's own faint line is hardly visible on these colours.
STOP_STYLE = (
    "QPushButton { background: #C62828; color: white; font-weight: bold; border: 1px solid #8E0000;"
    " border-radius: 4px; padding: 7px; }"
    "QPushButton:hover { background: #D93636; }"
    "QPushButton:pressed { background: #8E0000; }"
    "QPushButton:focus { border: 4px double white; padding: 4px; }"
)
EMERGENCY_STYLE = (
    "QPushButton { background: #FFC400; color: #7F0000; font-weight: bold; border: 2px solid #C62828;"
    " border-radius: 4px; padding: 6px; }"
    "QPushButton:hover { background: #FFD54A; }"
    "QPushButton:pressed { background: #E0A800; }"
    "QPushButton:focus { border: 4px double #7F0000; padding: 4px; }"
)

LEAST_WIDTH = 404
"""Width in pixels of its parts at least, however short their texts."""


class FleetDock(QgsDockWidget):
    """The dock, which shows all of its parts uncut even at its least width.

    No button in it moves while its window and its splitter are left alone, whatever is reported or shown.
    Widgets that come and go take their space from a list: the fields of a gateway from the robot table, the
    banner of an emergency stop from the end of the lists at the bottom.
    """

    def __init__(
        self, desk: FleetController, actions: Actions, edits: QueueEdits, parent: QWidget | None = None
    ):
        super().__init__(tr("Fleet"), parent)
        self.setObjectName("fleet_dock")
        self._desk = desk
        self.connection_panel = ConnectionPanel(actions.connect)
        self.robots = RobotPanel(desk)
        self.table = self.robots.table
        self.details = RobotDetails(desk, self.table.positions, self.table.robots.deviations)
        self.log = CommandLog(desk)
        self.queue_panel = QueuePanel(desk, edits)
        self.draft_panel = PendingCommandPanel(desk, actions)
        self.conflict_panel = ConflictPanel(desk)
        self.banner = EmergencyBanner(desk, actions.clear_emergency)
        self.tabs = SteadyTabs()
        self.tabs.setObjectName("fleet_tabs")
        self._lay_out(actions)
        self.setToggleVisibilityAction(actions.panel)
        self.setFocusProxy(self.table)
        self.conflict_panel.counted.connect(self._count_conflicts)
        desk.state.updated.connect(self._show_link)
        desk.state.link_changed.connect(self._show_link)
        self._show_link()

    def _lay_out(self, actions: Actions) -> None:
        lists = ListsWithReserve(self._lists(), self.banner)
        split = SharingSplitter(self._upper(actions), lists)
        body = QWidget()
        rows = QVBoxLayout(body)
        rows.setContentsMargins(6, 6, 6, 6)
        rows.setSpacing(GAP)
        # A minimum width of the widget would override that of its texts, where that is more.
        rows.addStrut(LEAST_WIDTH)
        # The banner and the buttons that stop robots are outside of it: they are visible on every screen.
        rows.addWidget(ShrinkableScrollArea(split), 1)
        rows.addWidget(self.banner)
        stops = QHBoxLayout()
        # First: of a window wider than its screen the right end is not visible.
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
        self.connection_panel.show_link(
            self._desk.state.link, self._desk.state.site, self._desk.clock.steady()
        )


def _tools(actions: Actions) -> QGridLayout:
    grid = QGridLayout()
    grid.setSpacing(4)
    for column, action in enumerate((actions.select, actions.follow, actions.abort)):
        grid.addWidget(tool_button(action), 0, 2 * column, 1, 2)
    road_route = tool_button(actions.road_route)
    road_route.addAction(actions.route_preferences)
    road_route.setPopupMode(QToolButton.ToolButtonPopupMode.MenuButtonPopup)
    for column, button in enumerate((tool_button(actions.cone), road_route, tool_button(actions.route))):
        grid.addWidget(button, 1, 2 * column, 1, 2)
    for column in range(6):
        grid.setColumnStretch(column, 1)
    return grid


def tool_button(action: QAction) -> QToolButton:
    """Return a button for ``action``, as wide as its column."""
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
