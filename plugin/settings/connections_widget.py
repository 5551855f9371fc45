"""The connections that are kept: new, edit, remove, test, import, export."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from qgis.core import QgsFileUtils
from qgis.PyQt.QtCore import QModelIndex
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from ..errors import FleetError
from ..file_dialogs import file_to_read, file_to_write
from ..language import tr, tr_count
from ..wire.addresses import DEFAULT_URL, Credentials
from .connection_dialog import ConnectionDialog
from .connection_trial import ConnectionTrial
from .connections import Connections
from .gateway_connection import GatewayConnection, connections_in, connections_text
from .preferences import export_path, exports_folder
from .token_store import TokenStore
from .verdict_label import VerdictLabel

FILTER = tr("Connections (*.json)")
TITLES = (tr("Name"), tr("Gateway"), tr("Operator"))


class ConnectionsWidget(QWidget):
    """A list with its buttons. What is changed is kept at once, as with QGIS's other connections."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self._connections, self._store = Connections(), TokenStore()
        self._list = QTreeWidget()
        self._list.setObjectName("fleet_connections")
        self._list.setHeaderLabels(TITLES)
        self._list.setRootIsDecorated(False)
        self._list.setAlternatingRowColors(True)
        self._list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self._list.setColumnWidth(0, 150)
        self._list.setColumnWidth(1, 260)
        self._verdict = VerdictLabel()
        self._trial = ConnectionTrial(self)
        self._trial.told.connect(self._verdict.tell)
        self._buttons = {
            name: self._button(name, text, action)
            for name, text, action in (
                ("new", tr("&New…"), self.new),
                ("edit", tr("&Edit…"), self.edit),
                ("remove", tr("&Remove"), self.remove_selected),
                ("test", tr("&Test"), self.try_selected),
                ("import", tr("&Import…"), self._choose_import),
                ("export", tr("E&xport…"), self._choose_export),
            )
        }
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(self._list)
        line = QHBoxLayout()
        for button in self._buttons.values():
            line.addWidget(button)
        line.addStretch()
        rows.addLayout(line)
        rows.addWidget(self._verdict)
        self._list.itemSelectionChanged.connect(self._selection_changed)
        self._list.activated.connect(self._activated)
        self.show_all()

    def show_all(self, selected: str = "") -> None:
        """List what is kept, with ``selected`` in hand."""
        self._list.clear()
        for one in self._connections.all():
            item = QTreeWidgetItem([one.name, one.url, one.operator])
            self._list.addTopLevelItem(item)
            if one.name == selected:
                self._list.setCurrentItem(item)
        self._selection_changed()

    def selected(self) -> list[str]:
        """Return the names of the selected connections, in their order."""
        return sorted((item.text(0) for item in self._list.selectedItems()), key=str.casefold)

    def new(self) -> None:
        """Ask for a new connection."""
        self._ask(GatewayConnection("", DEFAULT_URL))

    def edit(self) -> None:
        """Ask how the selected connection is to be."""
        for name in self.selected()[:1]:
            connection = self._connections.get(name)
            if connection is not None:
                self._ask(connection)

    def remove_selected(self) -> None:
        """Keep the selected connections no longer."""
        names = self.selected()
        for name in names:
            self._connections.remove(name)
        self.show_all()
        if names:
            self._verdict.wait(
                tr("Removed: {names}. Tokens stay in QGIS's authentication.", names=", ".join(names))
            )

    def try_selected(self) -> None:
        """Greet the gateway of the selected connection."""
        connection = self._connections.get(next(iter(self.selected()), ""))
        if connection is None:
            return
        self._verdict.wait(tr("Connecting to {name} …", name=connection.name))
        try:
            token = (
                self._store.token_in(connection.auth) if connection.auth else self._store.read(connection.url)
            )
        except FleetError as error:
            self._verdict.tell(False, str(error))
            return
        credentials = Credentials(token, connection.ca_file)
        self._trial.begin(connection.url, connection.operator or tr("connection test"), credentials)

    def read_file(self, file: str) -> None:
        """Keep the connections in ``file`` as well; of one name those in the file count."""
        try:
            found = connections_in(Path(file).read_text(encoding="utf-8"), file)
        except (OSError, UnicodeDecodeError) as error:
            self._verdict.tell(False, tr("{file} cannot be read: {error}", file=file, error=error))
            return
        except FleetError as error:
            self._verdict.tell(False, str(error))
            return
        replaced = 0
        for connection in found:
            known = self._connections.get(connection.name)
            replaced += known is not None
            # A file carries no tokens: the one that is here stays, unless it is for another gateway.
            auth = known.auth if known is not None and known.url == connection.url else ""
            values = (connection.name, connection.url, connection.operator, connection.ca_file)
            self._connections.put(GatewayConnection(*values, auth))
        self.show_all()
        text = tr_count(len(found), "1 connection from {file}.", "%n connections from {file}.", file=file)
        if replaced:
            text += " " + tr("Replaced: {replaced}.", replaced=replaced)
        self._verdict.tell(True, text)

    def write_file(self, file: str) -> None:
        """Write the selected connections, or all when none is selected, without their tokens."""
        names = self.selected() or self._connections.names()
        chosen = [one for one in self._connections.all() if one.name in names]
        try:
            Path(file).write_text(connections_text(chosen), encoding="utf-8")
        except OSError as error:
            self._verdict.tell(False, tr("{file} cannot be written: {error}", file=file, error=error))
            return
        text = tr_count(
            len(chosen),
            "1 connection in {file}, without its token.",
            "%n connections in {file}, without tokens.",
            file=file,
        )
        self._verdict.tell(True, text)

    def end(self) -> None:
        """Give up a test that is under way."""
        self._trial.end()

    def _ask(self, connection: GatewayConnection) -> None:
        dialog = ConnectionDialog(connection, self._connections, self)
        dialog.kept.connect(lambda kept: self.show_all(kept.name))
        dialog.open()

    def _choose_import(self) -> None:
        file = file_to_read(self, tr("Import connections"), exports_folder(), FILTER)
        if file:
            self.read_file(file)

    def _choose_export(self) -> None:
        file = file_to_write(self, tr("Export connections"), export_path("connections.json"), FILTER)
        if file:
            self.write_file(QgsFileUtils.ensureFileNameHasExtension(file, ["json"]))

    def _activated(self, index: QModelIndex) -> None:
        if index.isValid():
            self.edit()

    def _selection_changed(self) -> None:
        count = len(self._list.selectedItems())
        for name in ("edit", "test"):
            self._buttons[name].setEnabled(count == 1)
        self._buttons["remove"].setEnabled(count > 0)

    def _button(self, name: str, text: str, action: Callable[[], object]) -> QPushButton:
        button = QPushButton(text)
        button.setObjectName(f"fleet_connections_{name}")
        button.setAutoDefault(False)
        button.clicked.connect(lambda _=False: action())
        return button
