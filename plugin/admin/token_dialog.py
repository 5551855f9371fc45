"""Dialog that hands over a new token: as text, and as a code that a phone reads."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from urllib.parse import urlsplit

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor, QFontDatabase, QImage, QPixmap
from qgis.PyQt.QtWidgets import (
    QApplication,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.administration import NewToken
from ...robot_bridge.core.messages.base import is_loopback
from ..gateway_client.connection_status import ROLES
from ..ui.dialogs import WrappingLabel
from ..ui.language import tr
from ..ui.vendored import vendored_package


def until_in_words(expires_at: float | None) -> str:
    """Return until when a token is valid."""
    if expires_at is None:
        return tr("holds")
    return tr("holds until {time}", time=day_and_time(expires_at))


def day_and_time(at: float | None) -> str:
    """Return a time since 1970 in the computer's time zone, to the minute; a dash for None."""
    return "–" if at is None else datetime.fromtimestamp(at).strftime("%Y-%m-%d %H:%M")


EDGES = 24
"""Pixels beside the token in its field."""


class TokenDialog(QDialog):
    """The token is in its field and its code and nowhere else, and gone when this closes.

    ``gateway`` is the address of the desk that it was made at, as ``wss://gateway.example.org:8765/desk``.
    """

    def __init__(self, made: NewToken, gateway: str, *, ends_link: bool, parent: QWidget):
        super().__init__(parent)
        self.setObjectName("fleet_token_dialog")
        self.setWindowTitle(tr("Token of {operator}", operator=made.operator))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._field = _field(made.token)
        self._copied = WrappingLabel(lines=2)
        self._copied.setObjectName("fleet_token_copied")
        rows = QVBoxLayout(self)
        rows.addWidget(WrappingLabel(_words(made)))
        if ends_link:
            rows.addWidget(WrappingLabel(ENDS_LINK))
        rows.addWidget(self._field)
        rows.addWidget(self._copied)
        self._code = QLabel()
        self._code.setObjectName("fleet_token_code")
        self._code.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        self._code.setAccessibleName(tr("Code for a phone"))
        rows.addWidget(WrappingLabel(self._show_code(made.token, gateway)))
        rows.addWidget(self._code)
        self._add_foot(rows)
        self.finished.connect(self._forget)

    def _add_foot(self, rows: QVBoxLayout) -> None:
        copy = QPushButton(tr("&Copy"))
        copy.setObjectName("fleet_token_copy")
        copy.clicked.connect(self._copy)
        foot = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        foot.addButton(copy, QDialogButtonBox.ButtonRole.ActionRole)
        # Enter copies the token; it must not make it vanish.
        foot.button(QDialogButtonBox.StandardButton.Close).setAutoDefault(False)
        foot.rejected.connect(self.reject)
        rows.addWidget(foot)
        # Only within the dialog: otherwise Enter would do nothing once another button had the focus.
        copy.setDefault(True)

    def _copy(self) -> None:
        QApplication.clipboard().setText(self._field.text())
        self._copied.setText(tr("Copied. It stays in the clipboard until something else is copied."))

    def _show_code(self, token: str, gateway: str) -> str:
        """Show the code if a phone can reach the gateway by it; return the text about it."""
        host = urlsplit(gateway).hostname or ""
        self._code.setVisible(False)
        if is_loopback(host):
            return tr(
                "For a phone: connect this desk by the address that phones reach the gateway by, not by "
                "{host}, and a new token has a code here that opens the field page.",
                host=host,
            )
        library = vendored_package("segno")
        if library is None:
            return tr(
                "The Python package segno is missing, which draws the code for phones. Install the plugin "
                "from its release zip, which contains it."
            )
        code = library.make(field_address(gateway, token), error="m", micro=False)
        self._code.setPixmap(code_pixmap(code.matrix_iter(border=QUIET_MODULES), self.devicePixelRatioF()))
        # A code that a small screen cuts off cannot be read by a camera.
        self._code.setMinimumSize(self._code.sizeHint())
        self._code.setVisible(True)
        return tr("A phone whose camera reads this code opens the field page, signed in with the token:")

    def _forget(self) -> None:
        self._code.clear()
        # setText, unlike clear, also empties the undo history.
        self._field.setText("")


ENDS_LINK = tr(
    "This desk was connected with what the token takes the place of, and is cut off. Enter the token in the "
    "Fleet panel under Access, then press Connect."
)


def _words(made: NewToken) -> str:
    return tr(
        "{operator}, {role}: the token {until}. It is shown now and never again, and kept nowhere: hand it "
        "over on a way that others do not read. If it gets lost, make a new one.",
        operator=made.operator,
        role=ROLES[made.role],
        until=until_in_words(made.expires_at),
    )


def _field(token: str) -> QLineEdit:
    field = QLineEdit(token)
    field.setObjectName("fleet_new_token")
    field.setReadOnly(True)
    field.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
    field.setMinimumWidth(field.fontMetrics().horizontalAdvance(token) + EDGES)
    field.setAccessibleName(tr("Token"))
    return field


QUIET_MODULES = 4
"""Light modules around a code, needed by cameras to find it."""
MODULE_PIXELS = 4


def field_address(gateway: str, token: str) -> str:
    """Return the URL that opens the field page of the gateway at ``gateway``, signed in.

    The part after ``#`` stays on the phone: no server and no proxy sees it.
    """
    parts = urlsplit(gateway)
    scheme = "https" if parts.scheme == "wss" else "http"
    return f"{scheme}://{parts.netloc}{parts.path.rpartition('/')[0]}/field#token={token}"


def code_pixmap(modules: Iterable[Iterable[int]], pixel_ratio: float) -> QPixmap:
    """Return a QR code, dark on light in every theme; ``modules`` are its rows, 1 for dark."""
    rows = [list(row) for row in modules]
    image = QImage(len(rows), len(rows), QImage.Format.Format_RGB32)
    for y, row in enumerate(rows):
        for x, module in enumerate(row):
            image.setPixelColor(x, y, QColor("black" if module else "white"))
    side = round(len(rows) * MODULE_PIXELS * pixel_ratio)
    pixmap = QPixmap.fromImage(image.scaled(side, side))
    pixmap.setDevicePixelRatio(pixel_ratio)
    return pixmap
