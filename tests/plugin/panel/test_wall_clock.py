"""Times in words: what is of another day says so."""

import time

from fleet_supervisor.plugin.panel.emergency import in_words
from fleet_supervisor.plugin.ui.language import date_and_time, short_time, time_of_day
from fleet_supervisor.robot_bridge.core.messages.safety import EmergencyReport

NOON = time.mktime((2026, 11, 22, 12, 0, 0, 0, 0, -1))
HOUR = 3600.0


def test_today_needs_no_date():
    assert time_of_day(NOON - 11 * HOUR, NOON) == "01:00:00"
    assert time_of_day(NOON + 11 * HOUR, NOON) == "23:00:00"


def test_another_day_is_named():
    assert time_of_day(NOON - 13 * HOUR, NOON) == "2026-11-21 23:00:00"
    assert time_of_day(NOON + 13 * HOUR, NOON) == "2026-11-23 01:00:00"
    assert time_of_day(NOON, NOON + 365 * 24 * HOUR) == "2026-11-22 12:00:00"


def test_a_narrow_column_has_the_day_without_the_year():
    assert short_time(NOON, NOON + HOUR) == "12:00:00"
    assert short_time(NOON, NOON + 13 * HOUR) == "11-22 12:00"


def test_what_is_written_down_has_its_date_today_too():
    assert date_and_time(NOON) == "2026-11-22 12:00:00"


def test_no_time_is_no_text():
    assert time_of_day(None) == short_time(None) == date_and_time(None) == ""


def test_an_emergency_stop_of_another_day_says_since_when():
    report = EmergencyReport(in_force=True, stop="s1", at=1_600_000_000.0, by="anna", robots=1, waiting=[])
    assert " since 2020-09-1" in in_words(report, pending=False, silence=None)
