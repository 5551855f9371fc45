"""How much of the alarms QGIS's message log is given to keep."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.panel.alarms.rules import Alarm, AlarmKind
from fleet_supervisor.plugin.panel.alarms.watch import MOST_LINES, WITHIN, AlarmMessages
from qgis.core import QgsApplication


@pytest.fixture
def lines(qgis_app):
    """What QGIS's message log took in."""
    written = []

    def listen(text, tag, _level):
        written.append((tag, text))

    log = QgsApplication.messageLog()
    log.messageReceived.connect(listen)
    yield written
    log.messageReceived.disconnect(listen)


@pytest.fixture
def clock():
    """A clock that stands until it is set."""
    return [100.0]


@pytest.fixture
def messages(clock):
    return AlarmMessages(SimpleNamespace(steady=lambda: clock[0]))


def alarms(number):
    return [Alarm(AlarmKind.LOST, f"r{k}", f"r{k} is lost", 0.0) for k in range(number)]


def test_a_few_alarms_are_written_as_they_are(lines, messages):
    messages.write(alarms(2))
    assert lines == [("Fleet Supervisor", "r0 is lost"), ("Fleet Supervisor", "r1 is lost")]


def test_of_many_the_first_ones_are_written_and_the_others_counted_at_once(lines, messages):
    messages.write(alarms(MOST_LINES + 7))
    assert len(lines) == MOST_LINES + 1
    assert lines[-1][1].startswith("and 7 more alarms")


def test_what_goes_on_for_hours_is_a_few_lines_and_none_goes_uncounted(lines, messages, clock):
    for _ in range(1000):
        messages.write(alarms(3))
        clock[0] += WITHIN / 100
    clock[0] += WITHIN
    messages.write([])
    stretches = 10
    assert len(lines) <= (stretches + 1) * (MOST_LINES + 2)
    counted = sum(int(text.split()[1]) for _, text in lines if text.startswith("and "))
    assert counted + sum(text.endswith("is lost") for _, text in lines) == 3000
