"""Shows a token that was just made, this one time."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QFontDatabase
from qgis.PyQt.QtWidgets import (
    QApplication,
    QDialog,
    QDialogButtonBox,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.messages import NewToken
from ...language import tr
from ...wire.role_words import ROLES
from ..whole_text import WholeText
from .account_model import until_in_words

EDGES = 24
"""Pixels beside the token in its field."""


class TokenDialog(QDialog):
    """The token is in its field and nowhere else here, and gone when this closes."""

    def __init__(self, made: NewToken, *, ends_link: bool, parent: QWidget):
        super().__init__(parent)
        self.setObjectName("fleet_token_dialog")
        self.setWindowTitle(tr("Token of {operator}", operator=made.operator))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._field = _field(made.token)
        self._copied = WholeText(lines=2)
        self._copied.setObjectName("fleet_token_copied")
        rows = QVBoxLayout(self)
        rows.addWidget(WholeText(_words(made)))
        if ends_link:
            rows.addWidget(WholeText(ENDS_LINK))
        rows.addWidget(self._field)
        rows.addWidget(self._copied)
        self._add_foot(rows)
        self.finished.connect(self._forget)

    def _add_foot(self, rows: QVBoxLayout) -> None:
        copy = QPushButton(tr("&Copy"))
        copy.setObjectName("fleet_token_copy")
        copy.clicked.connect(self._copy)
        foot = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        foot.addButton(copy, QDialogButtonBox.ButtonRole.ActionRole)
        # Enter takes the token along; it must not make it vanish.
        foot.button(QDialogButtonBox.StandardButton.Close).setAutoDefault(False)
        foot.rejected.connect(self.reject)
        rows.addWidget(foot)
        # Only within the dialog: Enter would mean nothing once another button had the keyboard.
        copy.setDefault(True)

    def _copy(self) -> None:
        QApplication.clipboard().setText(self._field.text())
        self._copied.setText(tr("Copied. It stays in the clipboard until something else is copied."))

    def _forget(self) -> None:
        # setText, other than clear, also empties what could be undone.
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
