"""Alarms in QGIS's message bar: one item that counts, with its buttons."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.core import Qgis
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QResizeEvent
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QBoxLayout,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from ...control.messages import MessageLabel
from ...ui.language import first_of, tr, tr_count
from .rules import Alarm, AlarmChange
from .watch import AlarmWatch

BROAD_TEXT = 360
"""Pixels of text beside which its buttons stand; where that leaves less, they stand beneath it."""


class NoticeBody(QWidget):
    """Asks for no more than the width of its buttons, and takes what there is.

    QGIS's bar makes the whole window as wide as what hangs in it wishes to be.
    """

    def __init__(self, text: QLabel, buttons: Sequence[QAbstractButton], parent: QWidget):
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._foot = QWidget()
        row = QHBoxLayout(self._foot)
        row.setContentsMargins(0, 0, 0, 0)
        for button in buttons:
            row.addWidget(button)
        self._parts = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._parts.setContentsMargins(0, 0, 0, 0)
        self._parts.addWidget(text, 1)
        self._parts.addWidget(self._foot, 0, Qt.AlignmentFlag.AlignRight)

    def sizeHint(self) -> QSize:
        return QSize(self._foot.sizeHint().width(), super().sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        is_broad = self.width() >= BROAD_TEXT + self._foot.sizeHint().width()
        direction = QBoxLayout.Direction.LeftToRight if is_broad else QBoxLayout.Direction.TopToBottom
        if direction != self._parts.direction():
            self._parts.setDirection(direction)


NAMED = 2
"""Alarms that are told in words; the others are counted."""


class AlarmBar(QObject):
    """Hangs there while there are alarms that nobody has seen. Closed, it comes back with the next one."""

    requested = pyqtSignal()
    """The operator wants to see the alarms."""

    def __init__(self, bar: QgsMessageBar, watch: AlarmWatch, parent: QObject | None = None):
        super().__init__(parent)
        self._bar = bar
        self._watch = watch
        self._item: QgsMessageBarItem | None = None
        self._label: MessageLabel | None = None
        self._level = Qgis.MessageLevel.Warning
        self._shown = "", ""
        bar.widgetRemoved.connect(self._removed)
        watch.happened.connect(self._happened)
        watch.changed.connect(self._changed)

    def text(self) -> str:
        """Return what hangs there, empty for nothing."""
        return "" if self._label is None else self._label.text()

    def remove(self) -> None:
        """Take it down and listen no more."""
        self._bar.widgetRemoved.disconnect(self._removed)
        self._watch.happened.disconnect(self._happened)
        self._watch.changed.disconnect(self._changed)
        self._take_down()

    def _happened(self, events: list) -> None:
        self._show(has_begun=any(event.change is AlarmChange.BEGAN for event in events))

    def _changed(self) -> None:
        # Alarms also go without an event: with their robots, or with the link to others. And what the gateway
        # does about one is told while it hangs there.
        if self._item is not None:
            self._show(has_begun=False)

    def _show(self, *, has_begun: bool) -> None:
        new = self._new()
        if not new:
            self._take_down()
            return
        pressing = any(alarm.kind.is_urgent and alarm.ended is None for alarm in new)
        level = Qgis.MessageLevel.Critical if pressing else Qgis.MessageLevel.Warning
        if has_begun:
            self._bring_to_front(level)
        self._show_words()

    def _new(self) -> list[Alarm]:
        return [alarm for alarm in self._watch.board.alarms() if alarm.is_new]

    def _show_words(self) -> None:
        """Say what the alarms say now."""
        if self._label is None:
            return
        new = self._new()
        text, tip = in_words(new), "\n".join(alarm.text for alarm in new[:20])
        if new and (text, tip) != self._shown:
            self._shown = text, tip
            self._label.show_text(text)
            self._label.setToolTip(tip)

    def _bring_to_front(self, level: Qgis.MessageLevel) -> None:
        """Let it hang there with this level, in front; it is hung up again only behind another notice, since
        that takes QGIS as long as a frame of the map."""
        if self._item is None:
            self._hang_up(level)
        elif self._bar.currentItem() is not self._item:
            self._take_down()
            self._hang_up(level)
        elif level != self._level:
            self._level = level
            self._item.setLevel(level)

    def _hang_up(self, level: Qgis.MessageLevel) -> None:
        self._level = level
        self._shown = "", ""
        self._label = MessageLabel("", self._bar)
        self._label.setObjectName("fleet_alarm_text")
        show = QToolButton()
        show.setObjectName("fleet_show_alarms")
        show.setText(tr("Show"))
        show.clicked.connect(lambda: self.requested.emit())
        # Nothing else is pressed here: the bar comes and goes, and whoever aimed at what was there before
        # would have acknowledged what nobody has read.
        body = NoticeBody(self._label, [show], self._bar)
        body.setObjectName("fleet_alarm_bar")
        self._item = QgsMessageBarItem(body, level, 0)
        self._bar.pushItem(self._item)

    def _take_down(self) -> None:
        item, self._item, self._label = self._item, None, None
        if item is not None:
            self._bar.popWidget(item)

    def _removed(self, item: QgsMessageBarItem) -> None:
        if item is self._item:
            self._item = self._label = None


def in_words(new: list[Alarm]) -> str:
    """Return how many alarms nobody has seen, and what the most pressing ones are."""
    head = tr_count(len(new), "1 alarm", "%n alarms")
    return f"{head}: {'; '.join(first_of([alarm.text for alarm in new], NAMED))}"
