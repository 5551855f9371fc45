"""The one item of alarms in QGIS's message bar: when it is hung up anew, and when it changes in place."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.panel.alarms.rules import Alarm, AlarmChange, AlarmEvent, AlarmKind
from fleet_supervisor.plugin.panel.alarms.watch import AlarmBar
from qgis.core import Qgis
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import QObject, pyqtSignal

LOW = Alarm(AlarmKind.LOW_BATTERY, "r1", "r1 has 12% of its battery left", 1.0)
LOST = Alarm(AlarmKind.LOST, "r2", "r2 is lost", 2.0)
WARNING, CRITICAL = Qgis.MessageLevel.Warning, Qgis.MessageLevel.Critical


class Watch(QObject):
    """Tells of the alarms that it is given."""

    happened = pyqtSignal(list)
    changed = pyqtSignal()

    def __init__(self):
        super().__init__()
        self.alarms: list[Alarm] = []
        self.board = SimpleNamespace(alarms=lambda: list(self.alarms))

    def begin(self, *alarms: Alarm) -> None:
        self.alarms = [*alarms, *self.alarms]
        self.happened.emit([AlarmEvent(alarm.began, AlarmChange.BEGAN, alarm) for alarm in alarms])

    def drop_all(self) -> None:
        """As when the link leads to other robots: no event is told."""
        self.alarms = []
        self.changed.emit()

    def acknowledge_all(self) -> None:
        seen, self.alarms = self.alarms, []
        self.happened.emit([AlarmEvent(9.0, AlarmChange.ACKNOWLEDGED, alarm) for alarm in seen])


@pytest.fixture
def bar(qgis_app):
    made = QgsMessageBar()
    yield made
    made.deleteLater()


@pytest.fixture
def watch():
    return Watch()


@pytest.fixture
def alarm_bar(bar, watch):
    made = AlarmBar(bar, watch)
    yield made
    made.remove()


def test_in_front_it_becomes_more_pressing_and_less_so_in_place(bar, watch, alarm_bar):
    watch.begin(LOW)
    item = bar.currentItem()
    assert item.level() == WARNING
    watch.begin(LOST)
    assert bar.currentItem() is item and item.level() == CRITICAL
    assert "2 alarms: r2 is lost; r1 has 12%" in alarm_bar.text()
    watch.alarms = []
    watch.begin(LOW._replace(robot="r3"))
    assert bar.currentItem() is item and item.level() == WARNING


def test_behind_another_notice_it_comes_to_the_front_with_each_new_alarm(bar, watch, alarm_bar):
    watch.begin(LOW)
    behind = bar.currentItem()
    bar.pushItem(QgsMessageBarItem("somebody else's", WARNING, 0))
    watch.begin(LOW._replace(robot="r3"))
    assert bar.currentItem() is not behind and bar.currentItem().level() == WARNING
    assert "2 alarms" in alarm_bar.text()
    bar.pushItem(QgsMessageBarItem("somebody else's", WARNING, 0))
    watch.begin(LOST)
    assert bar.currentItem().level() == CRITICAL and "r2 is lost" in alarm_bar.text()
    assert len(bar.items()) == 3


def test_it_goes_when_everything_was_seen_and_comes_back_with_the_next_alarm(bar, watch, alarm_bar):
    watch.begin(LOST)
    watch.acknowledge_all()
    assert bar.currentItem() is None and alarm_bar.text() == ""
    watch.begin(LOW)
    assert bar.currentItem().level() == WARNING and "1 alarm: r1 has 12%" in alarm_bar.text()


def test_it_goes_with_robots_that_are_there_no_more(bar, watch, alarm_bar):
    watch.begin(LOST)
    watch.drop_all()
    assert bar.currentItem() is None and alarm_bar.text() == ""
