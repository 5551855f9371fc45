"""The window that the connections are managed in, where QGIS's options are not open."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QDialog, QDialogButtonBox, QVBoxLayout, QWidget

from ..help.help_window import show_help
from ..help.topics import CONNECTIONS
from ..language import tr
from .connections_widget import ConnectionsWidget


class ConnectionsDialog(QDialog):
    """:class:`ConnectionsWidget` in a window of its own."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_connections_dialog")
        self.setWindowTitle(tr("Connections to gateways"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        widget = ConnectionsWidget()
        standard = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(standard.Close | standard.Help)
        buttons.rejected.connect(self.reject)
        buttons.helpRequested.connect(lambda: show_help(CONNECTIONS, self))
        self.finished.connect(widget.end)
        rows = QVBoxLayout(self)
        rows.addWidget(widget)
        rows.addWidget(buttons)
        self.resize(620, 360)
