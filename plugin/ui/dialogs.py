"""Dialogs and their content: confirmations, wrapping labels, scroll areas, file dialogs."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from qgis.gui import QgsFileWidget
from qgis.PyQt.QtCore import QEvent, QObject, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QKeyEvent, QResizeEvent
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QFrame,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QScrollArea,
    QWidget,
)

from .language import tr


def push_button(
    name: str, text: str, tip: str = "", pressed: Callable[[], object] | None = None
) -> QPushButton:
    """Return a button that is found by ``name``, shows ``text`` and ``tip`` and calls ``pressed``."""
    button = QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(tip)
    if pressed is not None:
        # The signal carries whether the button is checked, which is not needed.
        button.clicked.connect(lambda _=False: pressed())
    return button


class WrappingLabel(QLabel):
    """Plain text that wraps; at least ``lines`` lines high, so that what is below it jumps less.

    A layout that has too little room for everything shrinks labels that wrap first, and a dialog does
    not ask for their height.
    """

    def __init__(self, text: str = "", lines: int = 1, parent: QWidget | None = None):
        super().__init__(text, parent)
        self._least = lines * self.fontMetrics().lineSpacing() + 2
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.PlainText)
        # Its height is known only at its width; a dialog would keep an estimated one.
        self.setMinimumHeight(self._least)

    def setText(self, text: str) -> None:
        super().setText(text)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        # Qt includes the minimum height set before in the height of the text.
        self.setMinimumHeight(0)
        self.setMinimumHeight(max(self._least, self.heightForWidth(self.width())))


DIALOG_WIDTH = 460


class QuestionDialog(QDialog):
    """Texts, fields, and two buttons: ``yes`` accepts it, ``no`` changes nothing.

    ``yes`` and ``no`` are the name and the text of a button; without ``no`` that is *Cancel*. With
    ``is_safe`` Enter presses ``no``, otherwise ``yes``; in a reason it moves the focus to the button ``yes``,
    which another Enter presses. Parts are shown in the order added; call :meth:`lay_out` last.
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
        self.setMinimumWidth(DIALOG_WIDTH)
        self.confirm, leave = _button(*yes), _button(*(no or (f"{name}_cancel", tr("Cancel"))))
        self._is_safe = is_safe
        self._foot = QDialogButtonBox()
        self._foot.addButton(self.confirm, QDialogButtonBox.ButtonRole.AcceptRole)
        self._foot.addButton(leave, QDialogButtonBox.ButtonRole.RejectRole)
        (leave if is_safe else self.confirm).setDefault(True)
        self._foot.accepted.connect(self.accept)
        self._foot.rejected.connect(self.reject)
        self._form = QFormLayout(self)

    def add_text(self, text: str, lines: int = 1) -> WrappingLabel:
        """Add a text across the dialog, at least ``lines`` high; an empty one is left out."""
        label = WrappingLabel(text, lines)
        if text:
            self._form.addRow(label)
        return label

    def add_field(self, text: str, field: QWidget, name: str) -> None:
        """Add a field after the label ``text``, which contains its access key."""
        field.setObjectName(name)
        label = QLabel(text)
        label.setBuddy(field)
        self._form.addRow(label, field)

    def add_choice(self, text: str, choices: Iterable[tuple[str, object]], name: str) -> QComboBox:
        """Add a choice after ``text``; ``choices`` are words, and their values for ``currentData``."""
        box = QComboBox()
        for words, meaning in choices:
            box.addItem(words, meaning)
        self.add_field(text, box, name)
        return box

    def add_reason(self, hint: str, longest: int, name: str) -> QLineEdit:
        """Add a line for at most ``longest`` letters across the dialog, with ``hint`` while it is empty."""
        line = ReasonLine()
        line.setObjectName(name)
        line.setPlaceholderText(hint)
        line.setAccessibleName(hint)
        line.setToolTip(hint)
        line.setMaxLength(longest)
        if self._is_safe:
            line.left.connect(self._offer_confirmation)
        self._form.addRow(line)
        return line

    def _offer_confirmation(self) -> None:
        """Move the focus to the button that confirms, if that is enabled."""
        if self.confirm.isEnabled():
            # From here on Enter presses the button with the focus, whichever of the two that is.
            for button in self._foot.findChildren(QPushButton):
                button.setAutoDefault(True)
            self.confirm.setFocus()

    def lay_out(self) -> None:
        """Add the buttons beneath all parts, and fit the height."""
        self._form.addRow(self._foot)
        # By default Qt takes the height for its preferred width, which is less, with more lines.
        width = max(DIALOG_WIDTH, self._form.totalMinimumSize().width())
        self.resize(width, self._form.totalHeightForWidth(width))


class ReasonLine(QLineEdit):
    """A line whose Enter, once ``left`` is connected, does not reach the default button of the dialog.

    That button may close the dialog, and the text would be lost. An empty line passes Enter on.
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
    # Otherwise Enter presses the button used last.
    button.setAutoDefault(False)
    return button


def confirm(
    parent: QWidget, name: str, text: str, yes: tuple[str, str], no: str, then: Callable[[], object]
) -> QMessageBox:
    """Return a question, the object ``name``, not open yet; the caller sets its title.

    ``yes`` is the name and the text of the button that calls ``then()``, ``no`` the text of the one that does
    nothing, which Enter and Escape press.
    """
    box = QMessageBox(QMessageBox.Icon.Question, "", text, parent=parent)
    box.setObjectName(name)
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    confirm = box.addButton(yes[1], QMessageBox.ButtonRole.AcceptRole)
    confirm.setObjectName(yes[0])
    keep = box.addButton(no, QMessageBox.ButtonRole.RejectRole)
    box.setDefaultButton(keep)
    box.setEscapeButton(keep)
    confirm.clicked.connect(lambda: then())
    return box


class ShrinkableScrollArea(QScrollArea):
    """Scrolls ``content`` where it is too tall; always as wide as ``content`` needs."""

    def __init__(self, content: QWidget, parent: QWidget | None = None):
        super().__init__(parent)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setWidget(content)
        self.verticalScrollBar().installEventFilter(self)
        content.installEventFilter(self)

    def minimumSizeHint(self) -> QSize:
        bar = self.verticalScrollBar()
        beside = bar.sizeHint().width() if bar.isVisibleTo(self) else 0
        # Themes of QGIS draw a frame here nevertheless.
        beside += 2 * self.frameWidth()
        return QSize(self.widget().minimumSizeHint().width() + beside, super().minimumSizeHint().height())

    def sizeHint(self) -> QSize:
        return self.widget().sizeHint()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.Show, QEvent.Type.Hide, QEvent.Type.LayoutRequest):
            self.updateGeometry()
        return super().eventFilter(watched, event)


# The emergency stop is one of those keys. Dialogs that QGIS opens itself may still be the operating
# system's.

FILE_DIALOG_OPTIONS = QFileDialog.Option.DontUseNativeDialog


def file_to_write(parent: QWidget, title: str, proposal: str, kinds: str) -> str:
    """Return the path chosen for writing, empty if cancelled; asks before an existing file is replaced.

    ``proposal`` is the initial path, ``kinds`` a filter of Qt's such as ``CSV (*.csv)``.
    """
    path, _ = QFileDialog.getSaveFileName(parent, title, proposal, kinds, options=FILE_DIALOG_OPTIONS)
    return path


def file_to_read(parent: QWidget, title: str, folder: str, kinds: str) -> str:
    """Return the existing file chosen, empty if cancelled; begins in ``folder``."""
    path, _ = QFileDialog.getOpenFileName(parent, title, folder, kinds, options=FILE_DIALOG_OPTIONS)
    return path


def file_field() -> QgsFileWidget:
    """Return a field for a path whose button opens such a dialog."""
    field = QgsFileWidget()
    field.setOptions(FILE_DIALOG_OPTIONS)
    return field
