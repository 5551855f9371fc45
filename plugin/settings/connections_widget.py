"""The list of stored connections, and the dialog of one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from qgis.core import QgsFileUtils
from qgis.gui import QgsAuthConfigSelect
from qgis.PyQt.QtCore import QModelIndex, QObject, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.files import replacement
from ..gateway_client import connection_status
from ..gateway_client.connection import ConnectionThread
from ..gateway_client.connection_status import ConnectionPhase, ConnectionStatus, OperatorCredentials
from ..help import CONNECTIONS, show_help
from ..ui.dialogs import file_field, file_to_read, file_to_write
from ..ui.errors import FleetError
from ..ui.language import tr, tr_count
from . import profile
from .profile import BadConnectionError, Connections, GatewayConnection, TokenStore

GOOD, BAD = "✔", "✘"


class ResultLabel(QLabel):
    """Empty until there is a result; its mark distinguishes success from failure without colour."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_verdict")
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)

    def show_verdict(self, good: bool, text: str) -> None:
        """Show the result."""
        self.setText(f"{GOOD if good else BAD} {text}")

    def wait(self, text: str) -> None:
        """Show that the test is under way."""
        self.setText(text)


LOOK_EVERY_MS = 50


class ConnectionTest(QObject):
    """One test at a time. A thread waits for the network; :meth:`end` waits for that thread."""

    tested = pyqtSignal(bool, str)
    """Whether the gateway accepted the operator, and the text about it."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._connection = ConnectionThread(self)
        self._site = None
        self._timer = QTimer(self)
        self._timer.setInterval(LOOK_EVERY_MS)
        self._timer.timeout.connect(self._poll)

    def begin(self, url: str, operator: str, credentials: OperatorCredentials) -> None:
        """Try to connect; a test under way is given up."""
        self._site = None
        try:
            self._connection.open(url, operator, credentials)
        except FleetError as error:
            self.tested.emit(False, str(error))
            return
        self._timer.start()

    def end(self) -> None:
        """Cancel the test under way."""
        self._timer.stop()
        self._connection.shut_down()

    def _poll(self) -> None:
        news = self._connection.collect_updates()
        self._site = news.site or self._site
        if not self._connection.is_open:
            # The thread of a finished test ends within a moment: it is kept until then.
            if not self._connection.is_ending:
                self._timer.stop()
            return
        verdict = self._verdict(news.link)
        if verdict is not None:
            self._connection.close()
            self.tested.emit(*verdict)

    def _verdict(self, link: ConnectionStatus) -> tuple[bool, str] | None:
        if link.phase in (ConnectionPhase.RETRYING, ConnectionPhase.FAILED):
            return False, link.reason
        if link.phase is ConnectionPhase.CONNECTED and self._site is not None:
            site = {"site": self._site.name, "crs": self._site.crs}
            if link.who:
                return True, tr("{site} ({crs}) answers, as {who}.", who=link.who, **site)
            return True, tr("{site} ({crs}) answers.", **site)
        return None


class ConnectionDialog(QDialog):
    """Edits ``connection``; ``kept`` signals it once it is stored. Nothing is stored before OK."""

    kept = pyqtSignal(object)

    def __init__(
        self, connection: GatewayConnection, connections: Connections, parent: QWidget | None = None
    ):
        super().__init__(parent)
        self._before, self._connections, self._store = connection, connections, TokenStore()
        self.setObjectName("fleet_connection_dialog")
        self.setWindowTitle(tr("Edit connection") if connection.name else tr("New connection"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._name = _line("fleet_connection_name", connection.name, tr("such as the site's name"))
        self._url = _line("fleet_connection_url", connection.url, connection_status.DEFAULT_URL)
        self._operator = _line(
            "fleet_connection_operator", connection.operator, tr("who you are, in every log")
        )
        self._token = _line("fleet_connection_token", "", tr("kept by QGIS, encrypted; or choose one below"))
        self._token.setEchoMode(QLineEdit.EchoMode.Password)
        self._token.setEnabled(self._store.is_there)
        # Without a parent yet: the tab order of the rows is the order in which they get one.
        self._auth = QgsAuthConfigSelect()
        self._auth.setObjectName("fleet_connection_auth")
        self._auth.setConfigId(connection.auth)
        self._ca = file_field()
        self._ca.setObjectName("fleet_connection_ca")
        self._ca.setFilter(tr("Certificates (*.pem *.crt *.cer);;All files (*)"))
        self._ca.setFilePath(connection.ca_file)
        hint = tr("the site's ca.pem; empty for public authorities")
        self._ca.lineEdit().setPlaceholderText(hint)
        self._ca.lineEdit().setToolTip(hint)
        self._verdict = ResultLabel()
        self._trial = ConnectionTest(self)
        self._trial.tested.connect(self._verdict.show_verdict)
        self.finished.connect(self._trial.end)
        self._lay_out()

    def connection(self) -> GatewayConnection:
        """Return the connection in the fields.

        :raises FleetError: when the name or the URL cannot be used.
        """
        return self._written().checked()

    def accept(self) -> None:
        """Store the connection and close, or show the error and stay."""
        try:
            made = self.connection()
            if made.name != self._before.name and self._connections.get(made.name) is not None:
                raise BadConnectionError(
                    tr("There is a connection {name} already. Give this one another name.", name=made.name)
                )
            token = self._token.text().strip()
            if token:
                OperatorCredentials(token, made.ca_file).check(made.url)
                made = self._with_token(made, token)
        except FleetError as error:
            self._verdict.show_verdict(False, str(error))
            return
        self._connections.store(made, self._before.name)
        self.kept.emit(made)
        super().accept()

    def _with_token(self, made: GatewayConnection, token: str) -> GatewayConnection:
        """Store a token under the connection's name: several operators may have one for the same gateway."""
        name = f"{profile.TITLE}: {made.name}"
        auth = self._store.write(self._store.id_of(name), name, made.url, token, made.operator)
        return replace(made, auth=auth)

    def try_it(self) -> None:
        """Test the connection in the fields, and show the result."""
        self._verdict.wait(tr("Connecting …"))
        try:
            made = self._written()
            # The name does not matter to the gateway.
            made = replace(made, name=made.name or "-").checked()
            token = self._token.text().strip()
            if not token and made.auth:
                token = self._store.token_in(made.auth)
        except FleetError as error:
            self._verdict.show_verdict(False, str(error))
            return
        self._trial.begin(
            made.url, made.operator or tr("connection test"), OperatorCredentials(token, made.ca_file)
        )

    def _written(self) -> GatewayConnection:
        texts = (field.text() for field in (self._name, self._url, self._operator))
        return GatewayConnection(*texts, self._ca.filePath(), self._auth.configId())

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.ExpandingFieldsGrow)
        rows = (
            (tr("&Name"), self._name),
            (tr("&Gateway"), self._url),
            (tr("&Operator"), self._operator),
            (tr("&Token"), self._token),
            (tr("&Authentication"), self._auth),
            (tr("CA &file"), self._ca),
        )
        for text, field in rows:
            label = QLabel(text)
            label.setBuddy(field)
            form.addRow(label, field)
        standard = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(standard.Ok | standard.Cancel | standard.Help)
        trial = buttons.addButton(tr("T&est"), QDialogButtonBox.ButtonRole.ActionRole)
        trial.setObjectName("fleet_connection_test")
        trial.clicked.connect(self.try_it)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        buttons.helpRequested.connect(lambda: show_help(CONNECTIONS, self))
        rows_of_it = QVBoxLayout(self)
        rows_of_it.addLayout(form)
        rows_of_it.addWidget(self._verdict)
        rows_of_it.addWidget(buttons)
        self.setMinimumWidth(520)


def _line(name: str, text: str, hint: str) -> QLineEdit:
    line = QLineEdit(text)
    line.setObjectName(name)
    line.setPlaceholderText(hint)
    line.setToolTip(hint)
    return line


FILTER = tr("Connections (*.json)")
TITLES = (tr("Name"), tr("Gateway"), tr("Operator"))


class ConnectionsWidget(QWidget):
    """A list with its buttons. Changes are stored at once, as for QGIS's other connections."""

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
        self._hint = QLabel(
            tr("Press New… for a gateway, or Import… for those that another computer has exported.")
        )
        self._hint.setObjectName("fleet_connections_hint")
        self._hint.setWordWrap(True)
        self._hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._hint.setEnabled(False)
        QHBoxLayout(self._list.viewport()).addWidget(self._hint)
        self._verdict = ResultLabel()
        self._trial = ConnectionTest(self)
        self._trial.tested.connect(self._verdict.show_verdict)
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
        """List the stored connections, with ``selected`` selected."""
        self._list.clear()
        for one in self._connections.all():
            item = QTreeWidgetItem([one.name, one.url, one.operator])
            self._list.addTopLevelItem(item)
            if one.name == selected:
                self._list.setCurrentItem(item)
        self._hint.setHidden(self._list.topLevelItemCount() > 0)
        self._selection_changed()

    def selected(self) -> list[str]:
        """Return the names of the selected connections, in their order."""
        return sorted((item.text(0) for item in self._list.selectedItems()), key=str.casefold)

    def new(self) -> None:
        """Ask for a new connection."""
        self._ask(GatewayConnection("", connection_status.DEFAULT_URL))

    def edit(self) -> None:
        """Edit the selected connection."""
        for name in self.selected()[:1]:
            connection = self._connections.get(name)
            if connection is not None:
                self._ask(connection)

    def remove_selected(self) -> None:
        """Delete the selected connections."""
        names = self.selected()
        for name in names:
            self._connections.remove(name)
        self.show_all()
        if names:
            self._verdict.wait(
                tr("Removed: {names}. Tokens stay in QGIS's authentication.", names=", ".join(names))
            )

    def try_selected(self) -> None:
        """Test the selected connection."""
        connection = self._connections.get(next(iter(self.selected()), ""))
        if connection is None:
            return
        self._verdict.wait(tr("Connecting to {name} …", name=connection.name))
        try:
            token = (
                self._store.token_in(connection.auth) if connection.auth else self._store.read(connection.url)
            )
        except FleetError as error:
            self._verdict.show_verdict(False, str(error))
            return
        credentials = OperatorCredentials(token, connection.ca_file)
        self._trial.begin(connection.url, connection.operator or tr("connection test"), credentials)

    def read_file(self, file: str) -> None:
        """Add the connections in ``file``; of equal names those in the file win."""
        try:
            found = profile.connections_in(Path(file).read_text(encoding="utf-8"), file)
        except (OSError, UnicodeDecodeError) as error:
            self._verdict.show_verdict(False, tr("{file} cannot be read: {error}", file=file, error=error))
            return
        except FleetError as error:
            self._verdict.show_verdict(False, str(error))
            return
        replaced = 0
        for connection in found:
            known = self._connections.get(connection.name)
            replaced += known is not None
            # A file contains no tokens: the stored one stays, unless it is for another gateway.
            auth = known.auth if known is not None and known.url == connection.url else ""
            values = (connection.name, connection.url, connection.operator, connection.ca_file)
            self._connections.store(GatewayConnection(*values, auth))
        self.show_all()
        text = tr_count(len(found), "1 connection from {file}.", "%n connections from {file}.", file=file)
        if replaced:
            text += " " + tr("Replaced: {replaced}.", replaced=replaced)
        self._verdict.show_verdict(True, text)

    def write_file(self, file: str) -> None:
        """Write the selected connections, or all when none is selected, without their tokens."""
        names = self.selected() or self._connections.names()
        chosen = [one for one in self._connections.all() if one.name in names]
        try:
            with replacement(Path(file)) as made:
                made.write_text(profile.connections_text(chosen), encoding="utf-8")
        except OSError as error:
            self._verdict.show_verdict(False, tr("{file} cannot be written: {error}", file=file, error=error))
            return
        text = tr_count(
            len(chosen),
            "1 connection in {file}, without its token.",
            "%n connections in {file}, without tokens.",
            file=file,
        )
        self._verdict.show_verdict(True, text)

    def end(self) -> None:
        """Cancel a test under way."""
        self._trial.end()

    def _ask(self, connection: GatewayConnection) -> None:
        dialog = ConnectionDialog(connection, self._connections, self)
        dialog.kept.connect(lambda kept: self.show_all(kept.name))
        dialog.open()

    def _choose_import(self) -> None:
        file = file_to_read(self, tr("Import connections"), profile.exports_folder(), FILTER)
        if file:
            self.read_file(file)

    def _choose_export(self) -> None:
        file = file_to_write(self, tr("Export connections"), profile.export_path("connections.json"), FILTER)
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
