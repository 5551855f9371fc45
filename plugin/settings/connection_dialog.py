"""One connection: its name, where the gateway is, and what the operator brings to it."""

from __future__ import annotations

from dataclasses import replace

from qgis.gui import QgsAuthConfigSelect
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from ..errors import FleetError
from ..file_dialogs import file_field
from ..help.help_window import show_help
from ..help.topics import CONNECTIONS
from ..language import tr
from ..wire.addresses import DEFAULT_URL, Credentials
from .connection_trial import ConnectionTrial
from .connections import Connections
from .gateway_connection import BadConnectionError, GatewayConnection
from .token_store import TITLE, TokenStore
from .verdict_label import VerdictLabel


class ConnectionDialog(QDialog):
    """Edits ``connection``; ``kept`` tells it as it was kept. Nothing is kept before OK."""

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
        self._url = _line("fleet_connection_url", connection.url, DEFAULT_URL)
        self._operator = _line(
            "fleet_connection_operator", connection.operator, tr("who you are, in every log")
        )
        self._token = _line("fleet_connection_token", "", tr("kept by QGIS, encrypted; or choose one below"))
        self._token.setEchoMode(QLineEdit.EchoMode.Password)
        self._token.setEnabled(self._store.is_there)
        # Without a parent yet: the keyboard goes from row to row, in the order in which they get one.
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
        self._verdict = VerdictLabel()
        self._trial = ConnectionTrial(self)
        self._trial.told.connect(self._verdict.tell)
        self.finished.connect(self._trial.end)
        self._lay_out()

    def connection(self) -> GatewayConnection:
        """Return what stands in the fields.

        :raises FleetError: when the name or the URL cannot be used.
        """
        return self._written().checked()

    def accept(self) -> None:
        """Keep the connection and close, or say why that cannot be and stay."""
        try:
            made = self.connection()
            if made.name != self._before.name and self._connections.get(made.name) is not None:
                raise BadConnectionError(
                    tr("There is a connection {name} already. Give this one another name.", name=made.name)
                )
            token = self._token.text().strip()
            if token:
                Credentials(token, made.ca_file).check(made.url)
                made = self._with_token(made, token)
        except FleetError as error:
            self._verdict.tell(False, str(error))
            return
        self._connections.put(made, self._before.name)
        self.kept.emit(made)
        super().accept()

    def _with_token(self, made: GatewayConnection, token: str) -> GatewayConnection:
        """Keep a token under the connection's name: several operators may have one for the same gateway."""
        name = f"{TITLE}: {made.name}"
        auth = self._store.write(self._store.id_of(name), name, made.url, token, made.operator)
        return replace(made, auth=auth)

    def try_it(self) -> None:
        """Greet the gateway with what stands in the fields, and say what became of it."""
        self._verdict.wait(tr("Connecting …"))
        try:
            made = self._written()
            # The name is of no matter to the gateway.
            made = replace(made, name=made.name or "-").checked()
            token = self._token.text().strip()
            if not token and made.auth:
                token = self._store.token_in(made.auth)
        except FleetError as error:
            self._verdict.tell(False, str(error))
            return
        self._trial.begin(made.url, made.operator or tr("connection test"), Credentials(token, made.ca_file))

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
