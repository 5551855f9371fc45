"""Puts the page into QGIS's options, and what is set there to work."""

from __future__ import annotations

from collections.abc import Callable

from qgis.gui import QgisInterface, QgsOptionsWidgetFactory
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QWidget

from ...settings.preferences import Preferences, read_preferences
from ..actions import ICONS
from ..alarms.stored_limits import write_limits
from ..alarms.thresholds import Thresholds
from ..beat import PULL_EVERY_MS
from ..window import DeskWindow
from .options_page import OptionsPage

TITLE = "Fleet Supervisor"


class OptionsFactory(QgsOptionsWidgetFactory):
    """Makes the page when the options are opened. :meth:`remove` undoes the constructor.

    ``judge`` is called with limits of alarms that were set, where somebody watches by them.
    """

    def __init__(
        self, iface: QgisInterface, window: DeskWindow, judge: Callable[[Thresholds], None] = write_limits
    ):
        super().__init__()
        self.setTitle(TITLE)
        self.setIcon(QIcon(str(ICONS / "fleet.svg")))
        self._iface, self._window, self._judge = iface, window, judge
        iface.registerOptionsWidgetFactory(self)
        self._put_to_work(read_preferences())

    def createWidget(self, parent: QWidget | None = None) -> OptionsPage:
        return OptionsPage(self._changed, parent)

    def remove(self) -> None:
        """Take the page out of the options."""
        self._iface.unregisterOptionsWidgetFactory(self)

    def _changed(self, preferences: Preferences, limits: Thresholds) -> None:
        self._judge(limits)
        self._put_to_work(preferences)

    def _put_to_work(self, preferences: Preferences) -> None:
        view = self._window.view
        self._window.desk.connection.rate = preferences.positions_rate
        view.layer_every = max(1, round(preferences.layer_seconds * 1000 / PULL_EVERY_MS))
        view.overlay.magnify(preferences.robot_size)
        view.draw_by_layer(preferences.drawn_by_layer)
