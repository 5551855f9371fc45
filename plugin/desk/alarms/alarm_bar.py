"""Alarms in QGIS's message bar: one item that counts, however many there are."""

from __future__ import annotations

from qgis.core import Qgis
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject, pyqtSignal
from qgis.PyQt.QtWidgets import QToolButton

from ...language import first_of, tr, tr_count
from ..notices import NoticeLabel
from .alarm import Alarm, AlarmChange
from .colours import PRESSING
from .notice_body import NoticeBody
from .watch import AlarmWatch

NAMED = 2
"""Alarms that are told in words; the others are counted."""


class AlarmBar(QObject):
    """Hangs there while there are alarms that nobody has seen. Closed, it comes back with the next one."""

    wanted = pyqtSignal()
    """The operator wants to see the alarms."""

    def __init__(self, bar: QgsMessageBar, watch: AlarmWatch, parent: QObject | None = None):
        super().__init__(parent)
        self._bar = bar
        self._watch = watch
        self._item: QgsMessageBarItem | None = None
        self._label: NoticeLabel | None = None
        self._level = Qgis.MessageLevel.Warning
        bar.widgetRemoved.connect(self._removed)
        watch.happened.connect(self._happened)

    def text(self) -> str:
        """Return what hangs there, empty for nothing."""
        return "" if self._label is None else self._label.text()

    def remove(self) -> None:
        """Take it down and listen no more."""
        self._bar.widgetRemoved.disconnect(self._removed)
        self._watch.happened.disconnect(self._happened)
        self._take_down()

    def _happened(self, events: list) -> None:
        new = [alarm for alarm in self._watch.board.alarms() if alarm.is_new]
        if not new:
            self._take_down()
            return
        pressing = any(alarm.kind in PRESSING and alarm.ended is None for alarm in new)
        level = Qgis.MessageLevel.Critical if pressing else Qgis.MessageLevel.Warning
        has_begun = any(event.change is AlarmChange.BEGAN for event in events)
        if has_begun:
            self._bring_to_front(level)
        if self._label is not None:
            self._label.show_text(in_words(new))
            self._label.setToolTip("\n".join(alarm.text for alarm in new[:20]))

    def _bring_to_front(self, level: Qgis.MessageLevel) -> None:
        """Let it hang there with this level; it is hung up anew only behind another notice, since that takes
        QGIS as long as a frame of the map."""
        if self._item is None:
            self._hang_up(level)
        elif level != self._level and self._bar.currentItem() is self._item:
            self._level = level
            self._item.setLevel(level)
        elif level != self._level:
            self._take_down()
            self._hang_up(level)

    def _hang_up(self, level: Qgis.MessageLevel) -> None:
        self._level = level
        self._label = NoticeLabel("", self._bar)
        self._label.setObjectName("fleet_alarm_text")
        buttons = (
            _button("fleet_show_alarms", tr("Show"), self.wanted.emit),
            _button("fleet_bar_acknowledge", tr("Acknowledge all"), self._watch.acknowledge_all),
        )
        body = NoticeBody(self._label, buttons, self._bar)
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


def _button(name: str, text: str, pressed: object) -> QToolButton:
    button = QToolButton()
    button.setObjectName(name)
    button.setText(text)
    button.clicked.connect(lambda: pressed())
    return button
