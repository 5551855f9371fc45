"""Where the operator says which gateway and who, and sees how the link stands."""

from __future__ import annotations

import getpass

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QAction, QGridLayout, QLabel, QLineEdit, QSizePolicy, QToolButton, QWidget

from ...robot_bridge.messages import SiteReport
from ..wire.addresses import DEFAULT_URL, Credentials
from ..wire.status import LinkStatus, Phase
from .access_fields import AccessFields

URL_KEY = "fleet_supervisor/url"
OPERATOR_KEY = "fleet_supervisor/operator"

MARKS = {
    Phase.CLOSED: ("#757575", "Not connected"),
    Phase.CONNECTING: ("#E69F00", "Connecting"),
    Phase.CONNECTED: ("#00795C", "Connected"),
    Phase.RETRYING: ("#E69F00", "Retrying"),
    Phase.FAILED: ("#C62828", "Failed"),
}


class ConnectionPanel(QWidget):
    """URL, operator, the button, and a line that tells the link's state with its reason."""

    def __init__(self, connect: QAction, parent: QWidget | None = None):
        super().__init__(parent)
        self._shown: LinkStatus | None = None
        settings = QgsSettings()
        self._url = QLineEdit(settings.value(URL_KEY, DEFAULT_URL) or DEFAULT_URL)
        self._url.setObjectName("fleet_url")
        self._url.setPlaceholderText(DEFAULT_URL)
        self._operator = QLineEdit(settings.value(OPERATOR_KEY, "") or _user())
        self._operator.setObjectName("fleet_operator")
        self._operator.setToolTip("Who you are: it stands beside every command in every log")
        button = QToolButton()
        button.setObjectName("fleet_connect_button")
        button.setDefaultAction(connect)
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        button.setSizePolicy(QSizePolicy.Policy.Minimum, QSizePolicy.Policy.Preferred)
        self._url.returnPressed.connect(lambda: connect.isChecked() or connect.trigger())
        self._access = AccessFields()
        self._more = QToolButton()
        self._more.setObjectName("fleet_access_button")
        self._more.setText("Access…")
        self._more.setToolTip("Token and CA file, for a gateway with accounts and TLS")
        self._more.setCheckable(True)
        self._more.toggled.connect(self._access.setVisible)
        self._state = QLabel()
        self._state.setObjectName("fleet_link_state")
        self._state.setWordWrap(True)
        self._state.setTextFormat(Qt.TextFormat.RichText)
        self._state.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(4)
        grid.addWidget(QLabel("Gateway"), 0, 0)
        grid.addWidget(self._url, 0, 1)
        grid.addWidget(self._more, 0, 2)
        grid.addWidget(QLabel("Operator"), 1, 0)
        grid.addWidget(self._operator, 1, 1)
        grid.addWidget(button, 1, 2)
        grid.addWidget(self._access, 2, 0, 1, 3)
        grid.addWidget(self._state, 3, 0, 1, 3)
        self._url.textChanged.connect(self._show_access)
        self._show_access()

    def url(self) -> str:
        """Return the URL as it stands in the field."""
        return self._url.text().strip()

    def operator(self) -> str:
        """Return the operator's name as it stands in the field."""
        return self._operator.text().strip()

    def credentials(self) -> Credentials:
        """Return token and CA file; QGIS may ask for its master password to give the token that it keeps."""
        return self._access.credentials(self.url())

    def remember(self) -> None:
        """Keep URL, operator and CA file for the next session, and the token where that is wanted.

        :raises FleetError: when QGIS does not keep the token.
        """
        settings = QgsSettings()
        settings.setValue(URL_KEY, self.url())
        settings.setValue(OPERATOR_KEY, self.operator())
        self._access.remember(self.url())

    def show_link(self, link: LinkStatus, site: SiteReport | None, now: float) -> None:
        """Show how the link stands at ``now`` (monotonic clock)."""
        text = _in_words(link, site, now)
        if text != self._state.text():
            self._state.setText(text)
        wanted = link.phase not in (Phase.CLOSED, Phase.FAILED)
        for field in (self._url, self._operator):
            if field.isReadOnly() != wanted:
                field.setReadOnly(wanted)
        self._access.setEnabled(not wanted)
        if link.wants_token and link != self._shown:
            self._more.setChecked(True)
        self._shown = link

    def _show_access(self) -> None:
        self._access.show_kept(self.url())
        if self.url().startswith("wss:"):
            self._more.setChecked(True)


def _in_words(link: LinkStatus, site: SiteReport | None, now: float) -> str:
    colour, word = MARKS[link.phase]
    detail = _escaped(link.reason)
    if link.phase is Phase.CONNECTED and site is not None:
        who = f" · {_escaped(link.reason)}" if link.reason else ""
        detail = f"{_escaped(site.name)}, {_escaped(site.crs)}{who}"
    if link.phase is Phase.RETRYING:
        word = f"Retrying in {link.wait(now):.0f} s"
    dot = f'<span style="color:{colour}">⬤</span>'
    return f"{dot} <b>{word}</b>{' · ' if detail else ''}{detail}"


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):
        return ""
