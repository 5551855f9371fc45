"""The time that is replayed, by QGIS's temporal controller."""

from __future__ import annotations

from qgis.core import QgsDateTimeRange, QgsInterval, QgsTemporalNavigationObject
from qgis.gui import QgsMapCanvas
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QDateTime, QObject, QTimer, pyqtSignal

FRAMES_A_SECOND = 5.0
LOOK_MS = 200
SPEEDS = (0.5, 1, 2, 5, 10, 30, 60, 300)


class Clockwork(QObject):
    """Steers the temporal controller of ``canvas``, or one of its own where that has none.

    Who works QGIS's own panel works the same controller. Its times are those of this computer's clock, as
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
        # PyQt cannot connect the controller's own signal of this in QGIS 3.22.
        self._was_playing = False
        self._look = QTimer(self)
        self._look.setInterval(LOOK_MS)
        self._look.timeout.connect(self._tell_playing)
        self._look.start()

    @property
    def is_set(self) -> bool:
        """Whether there is a time to be played."""
        return self.until > self.since

    @property
    def is_playing(self) -> bool:
        """Whether time goes on by itself."""
        return self.controller.animationState() != QgsTemporalNavigationObject.AnimationState.Idle

    def show(self, since: float, until: float) -> None:
        """Have the time from ``since`` to ``until`` to be played, from its beginning."""
        self.since, self.until = since, until
        self.controller.pause()
        self.controller.setNavigationMode(QgsTemporalNavigationObject.NavigationMode.Animated)
        self.controller.setTemporalExtents(QgsDateTimeRange(local(since), local(until)))
        self._set_frames(since)

    def set_speed(self, speed: float) -> None:
        """Play ``speed`` times as fast as it was, from the moment that is shown."""
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
        """Let time go on, or hold it; at its end begin anew."""
        if not on:
            self.controller.pause()
        elif self.is_set:
            if self.controller.currentFrameNumber() >= self.controller.totalFrameCount() - 1:
                self.controller.setCurrentFrameNumber(0)
            self.controller.playForward()
        self._tell_playing()

    def remove(self) -> None:
        """Leave QGIS's controller as it was found."""
        self._look.stop()
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
            self._put(self.since)

    def _updated(self, shown: QgsDateTimeRange) -> None:
        if self.is_set and shown.begin().isValid():
            self._put(shown.begin().toMSecsSinceEpoch() / 1000.0)

    def _put(self, moment: float) -> None:
        self.moment = min(max(moment, self.since), self.until)
        self.moved.emit(self.moment)

    def _tell_playing(self) -> None:
        if self.is_playing != self._was_playing:
            self._was_playing = self.is_playing
            self.playing_changed.emit(self._was_playing)


def local(at: float) -> QDateTime:
    """Return seconds since 1970 by this computer's clock."""
    return QDateTime.fromMSecsSinceEpoch(round(at * 1000))
