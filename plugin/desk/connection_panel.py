"""Where the operator says which gateway and who, and sees how the link stands."""

from __future__ import annotations

import getpass

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QAction, QGridLayout, QLabel, QLineEdit, QSizePolicy, QToolButton, QWidget

from ...robot_bridge.messages import SiteReport
from ..wire.addresses import DEFAULT_URL
from ..wire.status import LinkStatus, Phase

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
        grid.addWidget(self._url, 0, 1, 1, 2)
        grid.addWidget(QLabel("Operator"), 1, 0)
        grid.addWidget(self._operator, 1, 1)
        grid.addWidget(button, 1, 2)
        grid.addWidget(self._state, 2, 0, 1, 3)

    def url(self) -> str:
        """Return the URL as it stands in the field."""
        return self._url.text().strip()

    def operator(self) -> str:
        """Return the operator's name as it stands in the field."""
        return self._operator.text().strip()

    def remember(self) -> None:
        """Keep URL and operator for the next session."""
        settings = QgsSettings()
        settings.setValue(URL_KEY, self.url())
        settings.setValue(OPERATOR_KEY, self.operator())

    def show_link(self, link: LinkStatus, site: SiteReport | None, now: float) -> None:
        """Show how the link stands at ``now`` (monotonic clock)."""
        text = _in_words(link, site, now)
        if text != self._state.text():
            self._state.setText(text)
        wanted = link.phase not in (Phase.CLOSED, Phase.FAILED)
        for field in (self._url, self._operator):
            if field.isReadOnly() != wanted:
                field.setReadOnly(wanted)


def _in_words(link: LinkStatus, site: SiteReport | None, now: float) -> str:
    colour, word = MARKS[link.phase]
    detail = _escaped(link.reason)
    if link.phase is Phase.CONNECTED and site is not None:
        detail = f"{_escaped(site.name)}, {_escaped(site.crs)}"
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
