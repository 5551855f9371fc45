"""The panel that leads through the tour: it lies in the window and lets everything else be used."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import QPoint, Qt, pyqtSignal
from qgis.PyQt.QtGui import QKeySequence, QMouseEvent
from qgis.PyQt.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QShortcut, QVBoxLayout, QWidget

from ...language import tr
from ..push_button import push_button
from .steps import STEPS, Step

WIDTH = 400
FROM_LEFT, FROM_TOP = 12, 48
"""Pixels from the upper left corner of what it lies over: beneath one item of the message bar."""


class TourPanel(QFrame):
    """Shows one step at a time; it can be dragged out of the way."""

    changed = pyqtSignal(int)
    """The step that is shown, from 0."""
    wanted = pyqtSignal(str)
    """What the step's button offers was asked for."""
    closed = pyqtSignal()

    def __init__(self, window: QWidget):
        super().__init__(window)
        self.setObjectName("fleet_tour")
        self.setFrameShape(QFrame.Shape.Box)
        # Themes of QGIS make frames transparent, and this one lies over the map.
        self.setStyleSheet(
            "QFrame#fleet_tour { background: palette(window); border: 1px solid palette(mid); }"
        )
        self.setFixedWidth(WIDTH)
        self._at, self._practice = 0, False
        self._grip: QPoint | None = None
        self._title = _label("fleet_tour_title")
        self._text = _label("fleet_tour_text")
        self._said = _label("fleet_tour_said")
        self._count = QLabel()
        self._offer = _button("fleet_tour_offer", "", self._want)
        self._back = _button("fleet_tour_back", tr("&Back"), lambda: self.show_step(self._at - 1))
        self._next = _button("fleet_tour_next", tr("&Next"), self._go_on)
        self._close = _button("fleet_tour_close", tr("C&lose"), self.closed.emit)
        self._lay_out()
        escape = QShortcut(QKeySequence(Qt.Key.Key_Escape), self)
        escape.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        escape.activated.connect(self.closed)
        self.show_step(0)

    @property
    def step(self) -> Step:
        """The step that is shown."""
        return STEPS[self._at]

    def show_step(self, at: int) -> None:
        """Show a step, counted from 0."""
        self._at = min(max(at, 0), len(STEPS) - 1)
        self._said.clear()
        self._count.setText(f"{self._at + 1}/{len(STEPS)}")
        self._back.setEnabled(self._at > 0)
        self._next.setText(tr("&Finish") if self._at == len(STEPS) - 1 else tr("&Next"))
        self._offer.setText(self.step.button)
        self._offer.setVisible(bool(self.step.offer))
        self._offer.setEnabled(True)
        self._show_text()
        self._next.setFocus()
        self.changed.emit(self._at)

    def set_practice(self, on: bool) -> None:
        """Say whether the desk is connected to the practice fleet, so that things may be tried."""
        if on != self._practice:
            self._practice = on
            self._show_text()

    def say(self, text: str, *, busy: bool = False) -> None:
        """Show how it went with what the step's button does."""
        self._said.setText(text)
        self._said.setVisible(bool(text))
        if busy and self._offer.hasFocus():
            # Left to Qt, Close would get the keyboard.
            self._next.setFocus()
        self._offer.setEnabled(not busy)
        self._fit()

    def place(self, over: QWidget) -> None:
        """Lie over a part of the window, at its upper left: the sample site's robots are further down."""
        self._fit()
        self.move(over.mapTo(self.parentWidget(), QPoint(FROM_LEFT, FROM_TOP)))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grip = event.pos()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grip is not None:
            self.move(self.mapToParent(event.pos() - self._grip))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grip = None

    def _show_text(self) -> None:
        self._title.setText(f"<b>{self.step.title}</b>")
        tried = self.step.practice if self._practice else ""
        self._text.setText(f"{self.step.text}<p><b>{tried}</b></p>" if tried else self.step.text)
        self._said.setVisible(bool(self._said.text()))
        self._fit()

    def _fit(self) -> None:
        line = 2 * self.frameWidth()
        wanted = self.layout().heightForWidth(WIDTH - line) + line
        self.setFixedHeight(max(wanted, self.minimumSizeHint().height()))

    def _want(self) -> None:
        self.wanted.emit(self.step.offer)

    def _go_on(self) -> None:
        if self._at == len(STEPS) - 1:
            self.closed.emit()
        else:
            self.show_step(self._at + 1)

    def _lay_out(self) -> None:
        rows = QVBoxLayout(self)
        head = QHBoxLayout()
        head.addWidget(self._title, 1)
        head.addWidget(self._count)
        rows.addLayout(head)
        rows.addWidget(self._text)
        rows.addWidget(self._offer)
        rows.addWidget(self._said)
        foot = QHBoxLayout()
        foot.addWidget(self._close)
        foot.addStretch(1)
        foot.addWidget(self._back)
        foot.addWidget(self._next)
        rows.addLayout(foot)


def _label(name: str) -> QLabel:
    label = QLabel()
    label.setObjectName(name)
    label.setWordWrap(True)
    return label


def _button(name: str, text: str, pressed: Callable[[], object]) -> QPushButton:
    button = push_button(name, text, pressed=pressed)
    button.setAutoDefault(True)
    return button
