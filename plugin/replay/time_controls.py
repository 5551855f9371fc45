"""Time of the replay: QGIS's temporal controller, the form of a time range, the time line."""

from __future__ import annotations

import time

import numpy as np
import numpy.typing as npt
from qgis.core import QgsDateTimeRange, QgsInterval, QgsTemporalNavigationObject
from qgis.gui import QgsMapCanvas
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QDateTime, QEvent, QObject, QPointF, QRectF, QSize, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from qgis.PyQt.QtWidgets import QCheckBox, QComboBox, QDateTimeEdit, QGridLayout, QLabel, QToolTip, QWidget

from ...robot_bridge.core.messages.commands import CommandState
from ..ui.glyphs import flat, lines, painting
from ..ui.language import date_and_time, tr
from ..ui.steady_widgets import SteadyPushButton
from .history import NO_MARKS, TimelineMark, TimelineMarks

FRAMES_A_SECOND = 5.0
LOOK_MS = 200
SPEEDS = (0.5, 1, 2, 5, 10, 30, 60, 300)


class ReplayClock(QObject):
    """Controls the temporal controller of ``canvas``, or its own where that has none.

    QGIS's own panel controls the same controller. Its times are those of this computer's clock, as
    QGIS compares them with the times of layers.
    """

    moved = pyqtSignal(float)
    """The moment that is shown now, in seconds since 1970."""
    playing_changed = pyqtSignal(bool)

    def __init__(self, canvas: QgsMapCanvas, parent: QObject | None = None):
        super().__init__(parent)
        known = canvas.temporalController()
        self._own = not isinstance(known, QgsTemporalNavigationObject)
        self.controller: QgsTemporalNavigationObject = (
            QgsTemporalNavigationObject(self) if self._own else known
        )
        self._mode = self.controller.navigationMode()
        self._speed = 1.0
        self.since = self.until = self.moment = 0.0
        self.controller.updateTemporalRange.connect(self._updated)
        # PyQt cannot connect the controller's own signal for this in QGIS 3.22.
        self._was_playing = False
        self._poll = QTimer(self)
        self._poll.setInterval(LOOK_MS)
        self._poll.timeout.connect(self._announce_playing)
        self._poll.start()

    @property
    def is_set(self) -> bool:
        """Whether there is a time range to play."""
        return self.until > self.since

    @property
    def is_playing(self) -> bool:
        """Whether time is running."""
        return self.controller.animationState() != QgsTemporalNavigationObject.AnimationState.Idle

    def show(self, since: float, until: float) -> None:
        """Set the time range from ``since`` to ``until``, at its beginning."""
        self.since, self.until = since, until
        self.controller.pause()
        self.controller.setNavigationMode(QgsTemporalNavigationObject.NavigationMode.Animated)
        self.controller.setTemporalExtents(QgsDateTimeRange(local_time(since), local_time(until)))
        self._set_frames(since)

    def set_speed(self, speed: float) -> None:
        """Play at ``speed`` times real time, from the current moment."""
        self._speed = speed
        if self.is_set:
            self._set_frames(self.moment)

    def seek(self, moment: float) -> None:
        """Show ``moment``."""
        if self.is_set:
            frame = round((moment - self.since) / self._step)
            last = max(0, self.controller.totalFrameCount() - 1)
            self.controller.setCurrentFrameNumber(min(max(0, frame), last))

    def play(self, on: bool) -> None:
        """Start or pause playing; at the end start again from the beginning."""
        if not on:
            self.controller.pause()
        elif self.is_set:
            if self.controller.currentFrameNumber() >= self.controller.totalFrameCount() - 1:
                self.controller.setCurrentFrameNumber(0)
            self.controller.playForward()
        self._announce_playing()

    def remove(self) -> None:
        """Restore QGIS's controller."""
        self._poll.stop()
        if sip.isdeleted(self.controller):
            return
        self.controller.pause()
        self.controller.updateTemporalRange.disconnect(self._updated)
        if self.is_set and not self._own:
            self.controller.setNavigationMode(self._mode)

    @property
    def _step(self) -> float:
        return self._speed / FRAMES_A_SECOND

    def _set_frames(self, moment: float) -> None:
        self.controller.setFramesPerSecond(FRAMES_A_SECOND)
        self.controller.setFrameDuration(QgsInterval(self._step))
        self.seek(moment)
        if self.controller.currentFrameNumber() == 0:
            self._show_moment(self.since)

    def _updated(self, shown: QgsDateTimeRange) -> None:
        if self.is_set and shown.begin().isValid():
            self._show_moment(shown.begin().toMSecsSinceEpoch() / 1000.0)

    def _show_moment(self, moment: float) -> None:
        self.moment = min(max(moment, self.since), self.until)
        self.moved.emit(self.moment)

    def _announce_playing(self) -> None:
        if self.is_playing != self._was_playing:
            self._was_playing = self.is_playing
            self.playing_changed.emit(self._was_playing)


def local_time(at: float) -> QDateTime:
    """Return seconds since 1970 in this computer's local time."""
    return QDateTime.fromMSecsSinceEpoch(round(at * 1000))


LAST = {
    tr("the last 5 minutes"): 300,
    tr("the last 15 minutes"): 900,
    tr("the last hour"): 3600,
    tr("the last 8 hours"): 28800,
}
FORMAT = "yyyy-MM-dd HH:mm:ss"


class TimeRangeForm(QWidget):
    """``requested`` asks for the time range in the form, ``stop_requested`` cancels that."""

    requested = pyqtSignal()
    stop_requested = pyqtSignal()

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.last = QComboBox()
        self.last.setObjectName("fleet_replay_last")
        self.last.addItems([*LAST, tr("from … to …")])
        self.since = _time("fleet_replay_since")
        self.until = _time("fleet_replay_until")
        self.selected = QCheckBox(tr("Selected only"))
        self.selected.setObjectName("fleet_replay_selected")
        self.selected.setToolTip(tr("Load what the selected robots did, not what all did"))
        self.since.setToolTip(tr("From when on"))
        self.until.setToolTip(tr("Until when"))
        self.load = SteadyPushButton("fleet_replay_load", (tr("Load"), tr("Stop")))
        self._is_busy = False
        self._lay_out()
        self.last.currentIndexChanged.connect(self._last_changed)
        self.since.dateTimeChanged.connect(self._by_hand)
        self.until.dateTimeChanged.connect(self._by_hand)
        self.load.clicked.connect(lambda: (self.stop_requested if self._is_busy else self.requested).emit())
        self._last_changed()

    def stretch(self) -> tuple[float, float]:
        """Return the time range to replay, in seconds since 1970; "the last" ones end now."""
        self._last_changed()
        return tuple(box.dateTime().toMSecsSinceEpoch() / 1000.0 for box in (self.since, self.until))

    def show_busy(self, busy: bool) -> None:
        """Offer to stop while positions are being fetched."""
        self._is_busy = busy
        self.load.setText(tr("Stop") if busy else tr("Load"))

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(4)
        grid.addWidget(self.last, 0, 0, 1, 2)
        grid.addWidget(self.load, 0, 2)
        for row, (name, box) in enumerate(((tr("From"), self.since), (tr("To"), self.until)), start=1):
            label = QLabel(name)
            label.setBuddy(box)
            grid.addWidget(label, row, 0)
            grid.addWidget(box, row, 1)
        grid.addWidget(self.selected, 3, 0, 1, 3, Qt.AlignmentFlag.AlignLeft)
        grid.setColumnStretch(1, 1)

    def _last_changed(self, *_: object) -> None:
        seconds = LAST.get(self.last.currentText())
        if seconds is None:
            return
        now = time.time()
        for box, at in ((self.since, now - seconds), (self.until, now)):
            box.blockSignals(True)
            box.setDateTime(local_time(at))
            box.blockSignals(False)

    def _by_hand(self, _at: QDateTime) -> None:
        self.last.setCurrentIndex(len(LAST))


def _time(name: str) -> QDateTimeEdit:
    box = QDateTimeEdit()
    box.setObjectName(name)
    box.setDisplayFormat(FORMAT)
    box.setCalendarPopup(True)
    return box


EDGE = 9.0
"""Pixels left and right of the line."""
NEAR = 6.0
"""Distance in pixels within which the mouse selects a mark."""
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
"""Colours of marks, in the order of painting: failures are on top."""
LENGTH = 13
"""Length in pixels of a mark, from the line."""
STEP, LONG_STEP = 1.0, 10.0
"""Seconds per press of an arrow key, alone and with Shift."""


class TimeLine(QWidget):
    """``requested`` has the moment that was clicked or selected by keys.

    A command sent is a mark upwards, its outcome one downwards.
    """

    requested = pyqtSignal(float)
    play_requested = pyqtSignal()
    """Space was pressed: play or pause."""

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
        """Set the time range of the line from ``since`` to ``until``."""
        self.since, self.until = since, until
        self.update()

    def show_marks(self, marks: TimelineMarks) -> None:
        """Show the marks of these commands."""
        self.marks = marks
        self.update()

    def show_moment(self, moment: float) -> None:
        """Mark the current moment."""
        self.moment = moment
        self.update()

    def pixel(self, moment: float | npt.NDArray[np.float64]) -> float | npt.NDArray[np.float64]:
        """Return the position of a moment on the line, or of many."""
        span = max(self.until - self.since, 1e-9)
        return EDGE + (self.width() - 2 * EDGE) * (moment - self.since) / span

    def mark_at(self, x: float) -> TimelineMark | None:
        """Return the mark nearest to pixel ``x``, None when there is none nearby."""
        if not len(self.marks):
            return None
        away = np.abs(self.pixel(self.marks.at) - x)
        nearest = int(away.argmin())
        return self.marks[nearest] if away[nearest] <= NEAR else None

    def columns(self, state: CommandState) -> npt.NDArray[np.float64]:
        """Return the pixels from left to right where commands reached ``state``, without duplicates."""
        return np.unique(np.rint(self.pixel(self.marks.of(state))))

    def paintEvent(self, event: QPaintEvent) -> None:
        with painting(self) as painter:
            self._paint(painter)

    def _paint(self, painter: QPainter) -> None:
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
            self.play_requested.emit()
        else:
            super().keyPressEvent(event)

    def _moment_at(self, x: float) -> float:
        span = max(self.width() - 2 * EDGE, 1.0)
        return self.since + (self.until - self.since) * (x - EDGE) / span

    def _want(self, moment: float) -> None:
        if self.until > self.since:
            self.requested.emit(min(max(moment, self.since), self.until))
