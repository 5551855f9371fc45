"""The time that is replayed as a line: what was commanded when, and which moment is shown."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QEvent, QPointF, QRectF, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from qgis.PyQt.QtWidgets import QToolTip, QWidget

from ....robot_bridge.messages import CommandState
from ..live.strokes import flat, lines
from ..wall_clock import date_and_time
from .past_commands import NO_MARKS, Mark, Marks

EDGE = 9.0
"""Pixels left and right of the line."""
NEAR = 6.0
"""Pixels within which the mouse means a mark."""
PLAYHEAD = QColor(123, 31, 162)
ENDED_OTHERWISE = QColor(239, 108, 0)
COLOURS = {
    CommandState.QUEUED: QColor(33, 102, 172),
    CommandState.REACHED: QColor(46, 125, 50),
    CommandState.SUPERSEDED: ENDED_OTHERWISE,
    CommandState.EXPIRED: ENDED_OTHERWISE,
    CommandState.ABORTED: ENDED_OTHERWISE,
    CommandState.FAILED: QColor(198, 40, 40),
}
"""Of marks, in the order in which they are painted: what failed lies on top."""
LENGTH = 13
"""Pixels of a mark, from the line on."""
STEP, LONG_STEP = 1.0, 10.0
"""Seconds that an arrow key goes, alone and with Shift."""


class TimeLine(QWidget):
    """``wanted`` has the moment that was clicked or gone to by keys.

    What was sent is a mark upwards, what became of it one downwards.
    """

    wanted = pyqtSignal(float)
    play_wanted = pyqtSignal()
    """Space was pressed: that time goes on, or is held."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_replay_line")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setMinimumHeight(40)
        self.since = self.until = self.moment = 0.0
        self.marks = NO_MARKS

    def sizeHint(self) -> QSize:
        return QSize(400, 40)

    def show_time(self, since: float, until: float) -> None:
        """Be the line from ``since`` to ``until``."""
        self.since, self.until = since, until
        self.update()

    def show_marks(self, marks: Marks) -> None:
        """Show these commands."""
        self.marks = marks
        self.update()

    def show_moment(self, moment: float) -> None:
        """Show which moment is shown."""
        self.moment = moment
        self.update()

    def pixel(self, moment: float | npt.NDArray[np.float64]) -> float | npt.NDArray[np.float64]:
        """Return where on the line a moment is, or each of many."""
        span = max(self.until - self.since, 1e-9)
        return EDGE + (self.width() - 2 * EDGE) * (moment - self.since) / span

    def mark_at(self, x: float) -> Mark | None:
        """Return the mark nearest to pixel ``x``, None when there is none nearby."""
        if not len(self.marks):
            return None
        away = np.abs(self.pixel(self.marks.at) - x)
        nearest = int(away.argmin())
        return self.marks[nearest] if away[nearest] <= NEAR else None

    def columns(self, state: CommandState) -> npt.NDArray[np.float64]:
        """Return the pixels from left to right where commands came to ``state``: however many, each once."""
        return np.unique(np.rint(self.pixel(self.marks.of(state))))

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        middle = self.height() / 2
        painter.setPen(QPen(self.palette().mid().color(), 3.0))
        painter.drawLine(QPointF(EDGE, middle), QPointF(self.width() - EDGE, middle))
        if self.until <= self.since:
            return
        self._paint_marks(painter, middle)
        x = float(float(self.pixel(self.moment)))
        painter.setPen(QPen(PLAYHEAD, 2.0))
        painter.drawLine(QPointF(x, 6), QPointF(x, self.height() - 6))
        painter.setBrush(PLAYHEAD)
        painter.drawPolygon(QPolygonF([QPointF(x - 5, 1), QPointF(x + 5, 1), QPointF(x, 9)]))
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(self.palette().highlight().color(), 1.0))
            painter.drawRect(QRectF(0.5, 0.5, self.width() - 1, self.height() - 1))

    def _paint_marks(self, painter: QPainter, middle: float) -> None:
        for state, colour in COLOURS.items():
            x = self.columns(state)
            end = middle + (-LENGTH if state is CommandState.QUEUED else LENGTH)
            start_and_end = [np.column_stack([x, np.full(len(x), y)]) for y in (middle, end)]
            painter.setPen(flat(QPen(colour, 2.0)))
            painter.drawLines(lines(*start_and_end))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._want(self._moment_at(event.pos().x()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._want(self._moment_at(event.pos().x()))

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip and self.until > self.since:
            mark = self.mark_at(event.pos().x())
            at = self._moment_at(event.pos().x()) if mark is None else mark.at
            QToolTip.showText(
                self.mapToGlobal(event.pos()),
                date_and_time(at) + ("" if mark is None else f"\n{mark.text}"),
                self,
            )
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = LONG_STEP if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else STEP
        places = {
            Qt.Key.Key_Left: self.moment - step,
            Qt.Key.Key_Right: self.moment + step,
            Qt.Key.Key_Home: self.since,
            Qt.Key.Key_End: self.until,
        }
        if event.key() in places:
            self._want(places[event.key()])
        elif event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.play_wanted.emit()
        else:
            super().keyPressEvent(event)

    def _moment_at(self, x: float) -> float:
        span = max(self.width() - 2 * EDGE, 1.0)
        return self.since + (self.until - self.since) * (x - EDGE) / span

    def _want(self, moment: float) -> None:
        if self.until > self.since:
            self.wanted.emit(min(max(moment, self.since), self.until))
