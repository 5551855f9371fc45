"""The menu beside the button that connects: the connections that are kept, and what can be done with them."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QMenu, QToolButton, QWidget

from ..language import tr
from ..settings.connection_dialog import ConnectionDialog
from ..settings.connections import Connections
from ..settings.connections_dialog import ConnectionsDialog
from ..settings.gateway_connection import GatewayConnection
from .actions import ICONS

NONE_CHOSEN = tr("Connections that are kept under a name")


class ConnectionMenu(QObject):
    """Owns the button; ``chosen`` tells the connection that the operator picked."""

    chosen = pyqtSignal(object)

    def __init__(
        self, connections: Connections, as_it_stands: Callable[[], GatewayConnection], parent: QWidget
    ):
        super().__init__(parent)
        self._connections, self._as_it_stands = connections, as_it_stands
        self._window, self._marked, self._is_held = parent, "", False
        self._more: list[QAction] = []
        self.button = QToolButton()
        self.button.setObjectName("fleet_connections_button")
        self.button.setIcon(QIcon(str(ICONS / "connections.svg")))
        self.button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.menu = QMenu(self.button)
        self.menu.setObjectName("fleet_connections_menu")
        self.menu.aboutToShow.connect(self.fill)
        self.button.setMenu(self.menu)
        self.mark("")

    def mark(self, name: str) -> None:
        """Show which connection the fields are filled with, empty for none."""
        self._marked = name
        self.button.setToolTip(tr("Connection: {name}", name=name) if name else NONE_CHOSEN)

    def hold(self, held: bool) -> None:
        """Let no other connection be picked, as while one is open."""
        self._is_held = held

    def offer(self, action: QAction) -> None:
        """List an action of the gateway's beneath the connections."""
        self._more.append(action)

    def withdraw(self, action: QAction) -> None:
        """List an action no longer."""
        self._more.remove(action)
        self.menu.removeAction(action)

    def fill(self) -> None:
        """List the connections as they are kept now."""
        self.menu.clear()
        for one in self._connections.all():
            entry = self.menu.addAction(one.name.replace("&", "&&"))
            entry.setObjectName(f"fleet_connection_{one.name}")
            entry.setCheckable(True)
            entry.setChecked(one.name == self._marked)
            entry.setToolTip(one.url)
            entry.setEnabled(not self._is_held)
            entry.triggered.connect(lambda _=False, one=one: self.chosen.emit(one))
        self.menu.addSeparator()
        keep = self.menu.addAction(tr("&Keep under a name…"))
        keep.setObjectName("fleet_keep_connection")
        keep.setEnabled(not self._is_held)
        keep.triggered.connect(self._keep)
        manage = self.menu.addAction(tr("&Manage connections…"))
        manage.setObjectName("fleet_manage_connections")
        manage.triggered.connect(lambda: ConnectionsDialog(self._window.window()).open())
        self.menu.addSeparator()
        self.menu.addActions(self._more)

    def _keep(self) -> None:
        dialog = ConnectionDialog(self._as_it_stands(), self._connections, self._window.window())
        dialog.kept.connect(self.chosen)
        dialog.open()
