"""Connection panel: gateway, operator, token and CA file, status, menu of kept connections."""

from __future__ import annotations

import getpass

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import (
    QAction,
    QApplication,
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QMenu,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.administration import SiteReport
from ..gateway_client.connection_status import (
    DEFAULT_URL,
    ConnectionPhase,
    ConnectionStatus,
    OperatorCredentials,
)
from ..settings.connections_widget import ConnectionDialog, ConnectionsDialog
from ..settings.profile import Connections, GatewayConnection, TokenStore
from ..ui.actions import ICONS
from ..ui.dialogs import file_field
from ..ui.language import tr
from ..ui.steady_widgets import ScrollingText, SteadyButton

CA_KEY = "fleet_supervisor/ca_file"
NONE_KEPT = tr("fleet_op_…, as it was printed when the account was made")
KEPT = tr("kept by QGIS; enter another one to replace it")
BY_CONNECTION = tr("of the connection's authentication; enter another one for this time")


class AccessFields(QWidget):
    """Token, whether QGIS stores it, and CA file. The token itself is written to no settings file."""

    entered = pyqtSignal()
    """Enter was pressed in a field."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setVisible(False)
        self._store = TokenStore()
        self._auth = ""
        self._token = QLineEdit()
        self._token.setObjectName("fleet_token")
        self._token.setEchoMode(QLineEdit.EchoMode.Password)
        self._keep = QCheckBox(tr("Keep in QGIS"))
        self._keep.setObjectName("fleet_keep_token")
        self._keep.setToolTip(tr("Encrypted, under the master password of the QGIS authentication manager"))
        self._keep.setEnabled(self._store.is_there)
        self._ca = file_field()
        self._ca.setObjectName("fleet_ca_file")
        self._ca.setFilter(tr("Certificates (*.pem *.crt *.cer);;All files (*)"))
        self._ca.setDialogTitle(tr("The site's ca.pem"))
        self._ca.setFilePath(QgsSettings().value(CA_KEY, "") or "")
        hint = tr("the site's ca.pem; empty for public authorities")
        self._ca.lineEdit().setPlaceholderText(hint)
        self._ca.lineEdit().setToolTip(hint)
        for line in (self._token, self._ca.lineEdit()):
            line.returnPressed.connect(self.entered)
        self._lay_out()

    def show_kept(self, url: str) -> None:
        """Show whether QGIS stores a token for the gateway at ``url``."""
        kept = self._store.has(url)
        hint = BY_CONNECTION if self._auth else KEPT if kept else NONE_KEPT
        self._token.setPlaceholderText(hint)
        self._token.setToolTip(hint)
        self._keep.setChecked(kept or (self._keep.isChecked() and bool(self._token.text())))

    def use(self, auth: str, ca_file: str | None = None) -> None:
        """Use the token in the authentication configuration ``auth``; ``ca_file`` where one is given."""
        self._auth = auth
        self._token.clear()
        if ca_file is not None:
            self._ca.setFilePath(ca_file)

    def ca_file(self) -> str:
        """Return the CA file's name in the field."""
        return self._ca.filePath().strip()

    def credentials(self, url: str) -> OperatorCredentials:
        """Return the credentials in the fields; without a token there, the one that QGIS stores.

        :raises TokenStoreError: when QGIS does not return it.
        """
        token = self._token.text().strip()
        if not token and self._auth:
            token = self._store.token_in(self._auth)
        elif not token and self._keep.isChecked():
            token = self._store.read(url)
        return OperatorCredentials(token, self.ca_file())

    def remember(self, url: str, operator: str = "") -> None:
        """Store the CA file's name, and the token if wanted; otherwise delete it.

        :raises TokenStoreError: when QGIS does not store it.
        """
        settings = QgsSettings()
        if self.ca_file() != (settings.value(CA_KEY) or ""):
            settings.setValue(CA_KEY, self.ca_file())
        token = self._token.text().strip()
        if self._auth:
            # The connection's own token stays; another one typed over it is for this session.
            return
        if not self._keep.isChecked():
            self._store.forget(url)
        elif token:
            self._store.keep(url, token, operator)
            self._token.clear()
        self.show_kept(url)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(4)
        for row, (text, field) in enumerate(((tr("Token"), self._token), (tr("CA file"), self._ca))):
            label = QLabel(text)
            label.setBuddy(field)
            grid.addWidget(label, row, 0)
        grid.addWidget(self._token, 0, 1)
        grid.addWidget(self._keep, 0, 2)
        grid.addWidget(self._ca, 1, 1, 1, 2)


NONE_CHOSEN = tr("Connections that are kept under a name")


class ConnectionMenu(QObject):
    """Owns the button; ``chosen`` signals the connection that the operator picked."""

    chosen = pyqtSignal(object)

    def __init__(self, connections: Connections, panel: ConnectionPanel):
        super().__init__(panel)
        self._connections = connections
        self._panel, self._marked, self._is_held = panel, "", False
        self._more: list[QAction] = []
        self.button = QToolButton()
        self.button.setObjectName("fleet_connections_button")
        self.button.setIcon(QIcon(str(ICONS / "connections.svg")))
        self.button.setAccessibleName(tr("Connections"))
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
        """Disable the choice of another connection, as while one is open."""
        self._is_held = held

    def offer(self, action: QAction) -> None:
        """Add an action of the gateway below the connections."""
        self._more.append(action)

    def withdraw(self, action: QAction) -> None:
        """Remove an action from the list."""
        self._more.remove(action)
        self.menu.removeAction(action)

    def fill(self) -> None:
        """List the stored connections."""
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
        manage.triggered.connect(lambda: ConnectionsDialog(self._panel.window()).open())
        self.menu.addSeparator()
        self.menu.addActions(self._more)

    def _keep(self) -> None:
        dialog = ConnectionDialog(self._panel.connection(), self._connections, self._panel.window())
        dialog.kept.connect(self.chosen)
        dialog.open()


URL_KEY = "fleet_supervisor/url"
OPERATOR_KEY = "fleet_supervisor/operator"
GAP = 4
"""Pixels between two lines."""

MARKS = {
    ConnectionPhase.CLOSED: ("#757575", tr("Not connected")),
    ConnectionPhase.CONNECTING: ("#E69F00", tr("Connecting")),
    ConnectionPhase.CONNECTED: ("#00795C", tr("Connected")),
    ConnectionPhase.RETRYING: ("#E69F00", tr("Retrying")),
    ConnectionPhase.FAILED: ("#C62828", tr("Failed")),
}


class ConnectionPanel(QWidget):
    """A line with the link's state and its reason, and the button; URL and operator beneath it.

    While there is a link the fields are folded away: they cannot be edited, and the robots need the space.
    After a link broke they stay folded, until the operator disconnects or the gateway refuses. The line has
    the same height whatever its text, and the fields are at the panel's end: no button moves.
    """

    def __init__(self, connect: QAction, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_connection_panel")
        self._shown: ConnectionStatus | None = None
        self._connections = Connections()
        self._chosen: GatewayConnection | None = None
        settings = QgsSettings()
        self._url = QLineEdit(settings.value(URL_KEY, DEFAULT_URL) or DEFAULT_URL)
        self._url.setObjectName("fleet_url")
        self._url.setPlaceholderText(DEFAULT_URL)
        self._operator = QLineEdit(settings.value(OPERATOR_KEY, "") or _user())
        self._operator.setObjectName("fleet_operator")
        self._operator.setToolTip(tr("Who you are: it stands beside every command in every log"))
        self.menu = ConnectionMenu(self._connections, self)
        self.menu.chosen.connect(self.use)
        self._access = AccessFields()
        for enter in (self._url.returnPressed, self._operator.returnPressed, self._access.entered):
            enter.connect(lambda: connect.isChecked() or connect.trigger())
        self._more = _more_button()
        self._more.toggled.connect(self._access.setVisible)
        self._state = _state_text()
        self._line, self._fields, self._gateway = QWidget(), QWidget(), QWidget()
        self._lay_out(_connect_button(connect))
        self._url.textChanged.connect(self._url_changed)
        last = self._connections.get(self._connections.last)
        if last is not None and last.url == self.url():
            self.use(last)
        self._show_access()

    def url(self) -> str:
        """Return the URL in the field."""
        return self._url.text().strip()

    def operator(self) -> str:
        """Return the operator's name in the field."""
        return self._operator.text().strip()

    def credentials(self) -> OperatorCredentials:
        """Return token and CA file; QGIS may ask for its master password to return the token it stores.

        :raises FleetError: when it does not return it.
        """
        return self._access.credentials(self.url())

    def use(self, connection: GatewayConnection) -> None:
        """Write a named connection into the fields without opening it."""
        self._url.setText(connection.url)
        if connection.operator:
            self._operator.setText(connection.operator)
        self._chosen = connection
        self._access.use(connection.auth, connection.ca_file)
        self.menu.mark(connection.name)
        self._show_access()

    def remember(self) -> None:
        """Store URL, operator and CA file for the next session, and the token if wanted.

        :raises FleetError: when QGIS does not store the token.
        """
        settings = QgsSettings()
        settings.setValue(URL_KEY, self.url())
        settings.setValue(OPERATOR_KEY, self.operator())
        self._connections.set_last(self._chosen.name if self._chosen is not None else "")
        self._access.remember(self.url(), self.operator())

    def show_link(self, link: ConnectionStatus, site: SiteReport | None, now: float) -> None:
        """Show the state of the link at ``now`` (monotonic clock)."""
        text = _in_words(link, site, now)
        if text != self._state.text():
            self._state.setText(text)
            self._state.setToolTip(self._which(link, site))
        is_open = link.phase not in (ConnectionPhase.CLOSED, ConnectionPhase.FAILED)
        self._fold(link.phase is ConnectionPhase.CONNECTED or (is_open and self._fields.isHidden()))
        for field in (self._url, self._operator):
            if field.isReadOnly() != is_open:
                field.setReadOnly(is_open)
        self._access.setEnabled(not is_open)
        self.menu.hold(is_open)
        if link.wants_token and link != self._shown:
            self._more.setChecked(True)
        self._shown = link

    def height_with_fields(self) -> int:
        """Return the panel's height in pixels with the fields, whether they are folded or not."""
        parts = (self._line.sizeHint(), self._gateway.sizeHint(), self._access.sizeHint())
        return sum(part.height() for part in parts) + (len(parts) - 1) * GAP

    def height_without_fields(self) -> int:
        """Return the panel's height in pixels while there is a link."""
        return self._line.sizeHint().height()

    def _fold(self, folded: bool) -> None:
        if folded == self._fields.isHidden():
            return
        held = QApplication.focusWidget()
        if folded and held is not None and self._fields.isAncestorOf(held):
            # Else the next widget would get the focus, which is the button that ends the link.
            self._state.label.setFocus()
        self._fields.setHidden(folded)

    def _which(self, link: ConnectionStatus, site: SiteReport | None) -> str:
        which = [self.url(), *([] if site is None else [site.name, site.crs])]
        return "\n".join([*which, *filter(None, (link.instead, link.reason))])

    def connection(self) -> GatewayConnection:
        """Return the content of the fields as a connection without a name."""
        return GatewayConnection("", self.url(), self.operator(), self._access.ca_file())

    def _url_changed(self) -> None:
        if self._chosen is not None and self._chosen.url != self.url():
            # Its token is for the other gateway.
            self._chosen = None
            self._access.use("")
            self.menu.mark("")
        self._show_access()

    def _show_access(self) -> None:
        self._access.show_kept(self.url())
        if self.url().startswith("wss:"):
            self._more.setChecked(True)

    def _lay_out(self, connect: QToolButton) -> None:
        grid = QGridLayout(self._gateway)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(GAP)
        # One access key leads into the panel; others would collide with QGIS's menus in some languages.
        for row, (text, field) in enumerate(((tr("&Gateway"), self._url), (tr("Operator"), self._operator))):
            label = QLabel(text)
            label.setBuddy(field)
            grid.addWidget(label, row, 0)
        grid.addWidget(self._url, 0, 1)
        grid.addWidget(self._more, 0, 2)
        grid.addWidget(self._operator, 1, 1, 1, 2)
        fields = QVBoxLayout(self._fields)
        fields.setContentsMargins(0, 0, 0, 0)
        fields.setSpacing(GAP)
        fields.addWidget(self._gateway)
        fields.addWidget(self._access)
        line = QHBoxLayout(self._line)
        line.setContentsMargins(0, 0, 0, 0)
        line.setSpacing(4)
        line.addWidget(self._state, 1)
        for button in (connect, self.menu.button):
            line.addWidget(button, 0, Qt.AlignmentFlag.AlignVCenter)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(GAP)
        # The tab order; the line is first on screen.
        rows.addWidget(self._fields)
        rows.insertWidget(0, self._line)


def _connect_button(connect: QAction) -> QToolButton:
    button = SteadyButton("fleet_connect_button", (tr("Connect"), tr("Disconnect")))
    button.setDefaultAction(connect)
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    button.setSizePolicy(QSizePolicy.Policy.Minimum, QSizePolicy.Policy.Preferred)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


def _more_button() -> QToolButton:
    button = QToolButton()
    button.setObjectName("fleet_access_button")
    button.setText(tr("Access…"))
    button.setToolTip(tr("Token and CA file, for a gateway with accounts and TLS"))
    button.setCheckable(True)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button


def _state_text() -> ScrollingText:
    state = ScrollingText("fleet_link_state", lines=2)
    state.label.setTextFormat(Qt.TextFormat.RichText)
    state.label.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
    return state


def _in_words(link: ConnectionStatus, site: SiteReport | None, now: float) -> str:
    colour, word = MARKS[link.phase]
    detail = _escaped(link.reason)
    if link.phase is ConnectionPhase.CONNECTED and site is not None:
        detail = " · ".join(_escaped(text) for text in (link.instead, site.name, link.who) if text)
    if link.phase is ConnectionPhase.RETRYING and link.next_try is not None:
        word = tr("Retrying in {wait:.0f} s", wait=link.wait(now))
    dot = f'<span style="color:{colour}">⬤</span>'
    return f"{dot} <b>{word}</b>{' · ' if detail else ''}{detail}"


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):
        return ""
