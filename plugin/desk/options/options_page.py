"""The page: connections, what the map shows, alarms."""

from __future__ import annotations

from collections.abc import Callable

from qgis.gui import QgsOptionsPageWidget
from qgis.PyQt.QtWidgets import QHBoxLayout, QPushButton, QTabWidget, QVBoxLayout, QWidget

from ...help.help_window import show_help
from ...help.topics import OPTIONS
from ...language import tr
from ...settings.connections_widget import ConnectionsWidget
from ...settings.preferences import Preferences, read_preferences, write_preferences
from ..alarms.stored_limits import read_limits
from ..alarms.thresholds import Thresholds
from ..alarms.thresholds_form import ThresholdsForm
from .preferences_form import PreferencesForm


class OptionsPage(QgsOptionsPageWidget):
    """Shows what is kept; OK and Apply of the options keep what stands in the fields.

    Connections are kept at once, as elsewhere in QGIS. ``changed`` is called with what was kept.
    """

    def __init__(self, changed: Callable[[Preferences, Thresholds], None], parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_options")
        self._changed = changed
        self.connections = ConnectionsWidget()
        self.preferences = PreferencesForm()
        self.alarms = ThresholdsForm()
        self.preferences.show_preferences(read_preferences())
        self.alarms.show_limits(read_limits())
        tabs = QTabWidget()
        tabs.setObjectName("fleet_options_tabs")
        tabs.addTab(_page(self.connections, stretch=False), tr("Connections"))
        tabs.addTab(_page(self.preferences), tr("Map and files"))
        tabs.addTab(_page(self.alarms), tr("Alarms"))
        self._help = QPushButton(tr("Fleet Supervisor &help"))
        self._help.setObjectName("fleet_options_help")
        self._help.setAutoDefault(False)
        self._help.clicked.connect(lambda: show_help(OPTIONS, self))
        foot = QHBoxLayout()
        foot.addStretch()
        foot.addWidget(self._help)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(tabs)
        rows.addLayout(foot)
        self.destroyed.connect(self.connections.end)

    def apply(self) -> None:
        """Keep what stands in the fields; QGIS calls this on OK and on Apply."""
        preferences, limits = self.preferences.preferences(), self.alarms.limits()
        write_preferences(preferences)
        self._changed(preferences, limits)

    def isValid(self) -> bool:
        return True


def _page(widget: QWidget, *, stretch: bool = True) -> QWidget:
    page = QWidget()
    rows = QVBoxLayout(page)
    rows.addWidget(widget)
    if stretch:
        rows.addStretch()
    return page
