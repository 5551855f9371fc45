"""F1 in the fleet panel, and the entry *Help* of the menus."""

from __future__ import annotations

from pathlib import Path

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QEvent, QObject, Qt
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QApplication, QWidget

from ..language import tr
from .help_window import HelpWindow, show_help
from .topics import START, topic_of

ICON = Path(__file__).parents[2] / "resources" / "icons" / "fleet.svg"


class HelpDesk(QObject):
    """Answers F1 within ``panel`` by what has the keyboard there. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, menu: str, panel: QWidget):
        super().__init__(iface.mainWindow())
        self._iface, self._menu, self._panel = iface, menu, panel
        self.action = QAction(QIcon(str(ICON)), tr("Fleet Supervisor help"), self)
        self.action.setObjectName("fleet_help_action")
        self.action.triggered.connect(lambda: show_help(START, iface.mainWindow()))
        iface.addPluginToMenu(menu, self.action)
        iface.pluginHelpMenu().addAction(self.action)
        panel.installEventFilter(self)

    def remove(self) -> None:
        """Close what is open and take the entries out of the menus."""
        for window in self._iface.mainWindow().findChildren(HelpWindow):
            window.close()
        self._panel.removeEventFilter(self)
        self._iface.pluginHelpMenu().removeAction(self.action)
        self._iface.removePluginMenu(self._menu, self.action)
        self.deleteLater()

    def eventFilter(self, panel: QObject, event: QEvent) -> bool:
        kinds = (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress)
        if event.type() not in kinds or event.key() != Qt.Key.Key_F1:
            return False
        # QGIS has F1 for its own help: taken here first, it comes back as a key.
        event.accept()
        if event.type() == QEvent.Type.KeyPress:
            show_help(topic_of(QApplication.focusWidget()), self._panel)
        return True
