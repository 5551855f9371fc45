"""A dialog that asks before something is done; it does nothing by itself."""

from __future__ import annotations

from collections.abc import Iterable

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QWidget,
)

from ..language import tr
from .push_button import push_button
from .whole_text import WholeText

WIDTH = 460


class QuestionDialog(QDialog):
    """Texts, fields, and two buttons: ``yes`` accepts it, ``no`` leaves everything as it is.

    ``yes`` and ``no`` are the name and the text of a button; without ``no`` that is *Cancel*. With
    ``is_safe`` Enter presses ``no``, otherwise ``yes``; after a reason has been written it goes on to the
    button ``yes``, which another Enter presses. What was added comes in that order; :meth:`lay_out` ends it.
    """

    def __init__(
        self,
        name: str,
        title: str,
        yes: tuple[str, str],
        no: tuple[str, str] | None = None,
        *,
        is_safe: bool,
        parent: QWidget,
    ):
        super().__init__(parent)
        self.setObjectName(name)
        self.setWindowTitle(title)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setMinimumWidth(WIDTH)
        self.confirm, leave = _button(*yes), _button(*(no or (f"{name}_cancel", tr("Cancel"))))
        self._is_safe = is_safe
        self._foot = QDialogButtonBox()
        self._foot.addButton(self.confirm, QDialogButtonBox.ButtonRole.AcceptRole)
        self._foot.addButton(leave, QDialogButtonBox.ButtonRole.RejectRole)
        (leave if is_safe else self.confirm).setDefault(True)
        self._foot.accepted.connect(self.accept)
        self._foot.rejected.connect(self.reject)
        self._form = QFormLayout(self)

    def add_text(self, text: str, lines: int = 1) -> WholeText:
        """Put a text across the dialog, ``lines`` high at least; an empty one is left out."""
        label = WholeText(text, lines)
        if text:
            self._form.addRow(label)
        return label

    def add_field(self, text: str, field: QWidget, name: str) -> None:
        """Put a field after ``text``, which has its letter."""
        field.setObjectName(name)
        label = QLabel(text)
        label.setBuddy(field)
        self._form.addRow(label, field)

    def add_choice(self, text: str, choices: Iterable[tuple[str, object]], name: str) -> QComboBox:
        """Put a choice after ``text``; ``choices`` are words, and what ``currentData`` is for them."""
        box = QComboBox()
        for words, meaning in choices:
            box.addItem(words, meaning)
        self.add_field(text, box, name)
        return box

    def add_reason(self, hint: str, longest: int, name: str) -> QLineEdit:
        """Put a line for at most ``longest`` letters across the dialog, with ``hint`` while it is empty."""
        line = ReasonLine()
        line.setObjectName(name)
        line.setPlaceholderText(hint)
        line.setToolTip(hint)
        line.setMaxLength(longest)
        if self._is_safe:
            line.left.connect(self._offer_confirmation)
        self._form.addRow(line)
        return line

    def _offer_confirmation(self) -> None:
        """Move the keyboard to the button that confirms, if that can be pressed."""
        if self.confirm.isEnabled():
            # From here on Enter presses the button that has the keyboard, whichever of the two that is.
            for button in self._foot.findChildren(QPushButton):
                button.setAutoDefault(True)
            self.confirm.setFocus()

    def lay_out(self) -> None:
        """Put the buttons beneath all that was added, and be as high as that is."""
        self._form.addRow(self._foot)
        # Left to itself Qt takes the height for the width that it would like, which is less, with more lines.
        width = max(WIDTH, self._form.totalMinimumSize().width())
        self.resize(width, self._form.totalHeightForWidth(width))


class ReasonLine(QLineEdit):
    """A line whose Enter, once ``left`` is connected, does not reach the default button of the dialog.

    That button may close the dialog, and what was written would be lost. An empty line passes Enter on.
    """

    left = pyqtSignal()
    """Enter was pressed after a reason."""

    def keyPressEvent(self, event: QKeyEvent) -> None:
        is_enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if is_enter and self.text().strip() and self.receivers(self.left):
            event.accept()
            self.left.emit()
            return
        super().keyPressEvent(event)


def _button(name: str, text: str) -> QPushButton:
    button = push_button(name, text)
    # Otherwise Enter presses whichever was used last.
    button.setAutoDefault(False)
    return button
