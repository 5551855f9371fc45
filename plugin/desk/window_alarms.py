"""The alarms in the QGIS window: watched, listed in the Fleet panel, counted in the message bar."""

from __future__ import annotations

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject

from ..language import tr
from ..sites.surface_store import SurfaceStore
from .alarms.alarm_bar import AlarmBar
from .alarms.alarm_panel import AlarmPanel
from .alarms.colours import letters
from .alarms.watch import AlarmWatch
from .window import DeskWindow


class WindowAlarms(QObject):
    """Puts the alarms beside the other lists of the Fleet panel. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, window: DeskWindow, surfaces: SurfaceStore):
        super().__init__(window)
        self._window = window
        self.watch = AlarmWatch(window.desk, surfaces, self)
        self.panel = AlarmPanel(self.watch)
        self.bar = AlarmBar(iface.messageBar(), self.watch, self)
        self._tabs = window.dock.tabs
        self._tabs.add_page(self.panel, tr("Alarms"), counts=True)
        window.dock.details.alarms_of = self.watch.board.of
        self.watch.changed.connect(self._changed)
        self.panel.robots_wanted.connect(self._go)
        self.panel.counted.connect(self._count)
        self.bar.wanted.connect(self._show)

    def remove(self) -> None:
        """Watch no more and take panel and message away."""
        self.bar.remove()
        self.watch.remove()
        self.panel.remove()
        self._window.dock.details.alarms_of = lambda robot: []
        self._tabs.removeTab(self._tabs.indexOf(self.panel))
        self.panel.deleteLater()
        self.deleteLater()

    def _changed(self) -> None:
        alarms = self.watch.board.alarms()
        robots = {name for alarm in alarms for name in (alarm.robot, alarm.other) if name}
        self._window.dock.robots.mark_troubled(robots)

    def _count(self, new: int) -> None:
        self._tabs.show_count(self.panel, tr("Alarms"), new)
        self._tabs.show_colour(self.panel, letters(True) if new else None)

    def _go(self, robots: list[str]) -> None:
        self._window.desk.select_all(robots)
        self._window.view.zoom_to(*robots)

    def _show(self) -> None:
        self._window.dock.setUserVisible(True)
        self._tabs.setCurrentWidget(self.panel)
