"""Where the operator says which gateway and who, and sees how the link stands."""

from __future__ import annotations

import getpass

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import (
    QAction,
    QApplication,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.messages import SiteReport
from ..language import tr
from ..settings.connections import Connections
from ..settings.gateway_connection import GatewayConnection
from ..wire.addresses import DEFAULT_URL, Credentials
from ..wire.status import LinkStatus, Phase
from .access_fields import AccessFields
from .connection_menu import ConnectionMenu
from .fixed_size import ScrollingText, SteadyButton

URL_KEY = "fleet_supervisor/url"
OPERATOR_KEY = "fleet_supervisor/operator"
GAP = 4
"""Pixels between two lines."""

MARKS = {
    Phase.CLOSED: ("#757575", tr("Not connected")),
    Phase.CONNECTING: ("#E69F00", tr("Connecting")),
    Phase.CONNECTED: ("#00795C", tr("Connected")),
    Phase.RETRYING: ("#E69F00", tr("Retrying")),
    Phase.FAILED: ("#C62828", tr("Failed")),
}


class ConnectionPanel(QWidget):
    """A line that tells the link's state with its reason, with the button; URL and operator beneath it.

    While there is a link the fields are folded away: nothing can be changed in them, and the robots need the
    room. A link that broke leaves them so, until the operator disconnects or the gateway refuses. The line is
    as high whatever it says, and the fields are at the panel's end: no button moves.
    """

    def __init__(self, connect: QAction, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_connection_panel")
        self._shown: LinkStatus | None = None
        self._connections = Connections()
        self._chosen: GatewayConnection | None = None
        settings = QgsSettings()
        self._url = QLineEdit(settings.value(URL_KEY, DEFAULT_URL) or DEFAULT_URL)
        self._url.setObjectName("fleet_url")
        self._url.setPlaceholderText(DEFAULT_URL)
        self._url.returnPressed.connect(lambda: connect.isChecked() or connect.trigger())
        self._operator = QLineEdit(settings.value(OPERATOR_KEY, "") or _user())
        self._operator.setObjectName("fleet_operator")
        self._operator.setToolTip(tr("Who you are: it stands beside every command in every log"))
        self.menu = ConnectionMenu(self._connections, self._as_it_stands, self)
        self.menu.chosen.connect(self.use)
        self._access = AccessFields()
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
        """Return the URL as it stands in the field."""
        return self._url.text().strip()

    def operator(self) -> str:
        """Return the operator's name as it stands in the field."""
        return self._operator.text().strip()

    def credentials(self) -> Credentials:
        """Return token and CA file; QGIS may ask for its master password to give the token that it keeps.

        :raises FleetError: when it does not give it.
        """
        return self._access.credentials(self.url())

    def use(self, connection: GatewayConnection) -> None:
        """Write a named connection into the fields; nothing is opened."""
        self._url.setText(connection.url)
        if connection.operator:
            self._operator.setText(connection.operator)
        self._chosen = connection
        self._access.use(connection.auth, connection.ca_file)
        self.menu.mark(connection.name)
        self._show_access()

    def remember(self) -> None:
        """Keep URL, operator and CA file for the next session, and the token where that is wanted.

        :raises FleetError: when QGIS does not keep the token.
        """
        settings = QgsSettings()
        settings.setValue(URL_KEY, self.url())
        settings.setValue(OPERATOR_KEY, self.operator())
        self._connections.last = self._chosen.name if self._chosen is not None else ""
        self._access.remember(self.url(), self.operator())

    def show_link(self, link: LinkStatus, site: SiteReport | None, now: float) -> None:
        """Show how the link stands at ``now`` (monotonic clock)."""
        text = _in_words(link, site, now)
        if text != self._state.text():
            self._state.setText(text)
            self._state.setToolTip(self._which(link, site))
        wanted = link.phase not in (Phase.CLOSED, Phase.FAILED)
        self._fold(link.phase is Phase.CONNECTED or (wanted and self._fields.isHidden()))
        for field in (self._url, self._operator):
            if field.isReadOnly() != wanted:
                field.setReadOnly(wanted)
        self._access.setEnabled(not wanted)
        self.menu.hold(wanted)
        if link.wants_token and link != self._shown:
            self._more.setChecked(True)
        self._shown = link

    def height_with_fields(self) -> int:
        """Return the pixels of height that all of it takes, folded or not."""
        parts = (self._line.sizeHint(), self._gateway.sizeHint(), self._access.sizeHint())
        return sum(part.height() for part in parts) + (len(parts) - 1) * GAP

    def height_without_fields(self) -> int:
        """Return the pixels of height that it takes while there is a link."""
        return self._line.sizeHint().height()

    def _fold(self, folded: bool) -> None:
        if folded == self._fields.isHidden():
            return
        held = QApplication.focusWidget()
        if folded and held is not None and self._fields.isAncestorOf(held):
            # Else the next in line would have the keyboard, which is the button that ends the link.
            self._state.label.setFocus()
        self._fields.setHidden(folded)

    def _which(self, link: LinkStatus, site: SiteReport | None) -> str:
        which = [self.url(), *([] if site is None else [site.name, site.crs])]
        return "\n".join([*which, *([link.reason] if link.reason else [])])

    def _as_it_stands(self) -> GatewayConnection:
        """What the fields say, as a connection that has no name yet."""
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
        # The one letter leads into the panel; the others would be those of QGIS's menus in some language.
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
        # In this order the keyboard goes through them; the line comes first on screen.
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


def _in_words(link: LinkStatus, site: SiteReport | None, now: float) -> str:
    colour, word = MARKS[link.phase]
    detail = _escaped(link.reason)
    if link.phase is Phase.CONNECTED and site is not None:
        detail = " · ".join(_escaped(text) for text in (site.name, link.who) if text)
    if link.phase is Phase.RETRYING:
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
