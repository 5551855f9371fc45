"""Work in slices: the first at once or soon, others when the window has time, none after it was given up."""

from itertools import groupby
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.ui import scheduling
from fleet_supervisor.plugin.ui.errors import FleetError
from fleet_supervisor.plugin.ui.scheduling import ONE_STEP, CooperativeTask, scaled_progress
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from qgis.core import Qgis, QgsApplication
from qgis.PyQt.QtCore import QTimer


class Diary:
    """What was called, and a clock that goes on by a millisecond whenever it is looked at."""

    def __init__(self):
        self.calls = []
        self.now = 0.0
        self.slices = CooperativeTask(clock=SimpleNamespace(steady=self.tick))

    def tick(self):
        self.now += 0.001
        return self.now

    def begin(self, work):
        return self.slices.begin(
            work,
            lambda: self.calls.append(round(self.slices.share, 2)),
            lambda result: self.calls.append(("done", result)),
            lambda error: self.calls.append(("failed", str(error))),
        )


@pytest.fixture
def diary(qgis_app):
    return Diary()


def steps(count, end="result"):
    for number in range(count):
        yield number / count
    if isinstance(end, Exception):
        raise end
    return end


def test_what_the_first_slice_is_enough_for_is_returned_and_nothing_called(diary):
    assert diary.begin(steps(5)) == "result"
    assert diary.calls == []


def test_more_goes_on_by_itself_a_slice_at_a_time(diary, wait):
    assert diary.begin(steps(20)) is None
    wait(lambda: ("done", "result") in diary.calls)
    *shares, last = diary.calls
    assert shares == sorted(shares) and len(shares) >= 1
    assert last == ("done", "result")
    # Nine looks at a clock of milliseconds are a slice of eight.
    assert len(shares) == 20 // 8 - 1


def test_one_step_is_done_however_late_it_is(diary, wait, monkeypatch):
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", 0.0)
    diary.begin(steps(4))
    wait(lambda: ("done", "result") in diary.calls)
    assert diary.calls == [0.25, 0.5, 0.75, ("done", "result")]


def test_what_the_first_slice_raises_is_raised_and_later_ones_are_told(diary, wait):
    with pytest.raises(FleetError, match="no"):
        diary.begin(steps(2, FleetError("no")))
    diary.begin(steps(20, FleetError("too late")))
    wait(lambda: ("failed", "too late") in diary.calls)


def test_what_was_given_up_is_never_done(diary, wait):
    closed = []

    def work():
        try:
            yield from steps(50, "first")
        finally:
            closed.append(True)

    diary.begin(work())
    diary.begin(steps(20, "second"))
    assert closed == [True]
    wait(lambda: ("done", "second") in diary.calls)
    assert ("done", "first") not in diary.calls


def test_work_that_has_itself_stopped_is_not_gone_on_with(diary, wait):
    def work():
        yield 0.0
        diary.slices.stop()
        yield 0.5
        raise AssertionError("it went on")

    assert diary.begin(work()) is None
    diary.begin(steps(20, "next"))
    wait(lambda: ("done", "next") in diary.calls)


def test_what_is_begun_soon_waits_for_the_window(diary, wait):
    begun = []

    def work():
        begun.append(True)
        yield 0.0
        return "result"

    diary.slices.begin_soon(work(), lambda result: diary.calls.append(("done", result)))
    assert begun == [] and diary.slices.is_busy
    wait(lambda: diary.calls == [("done", "result")])
    assert not diary.slices.is_busy


def test_what_somebody_needs_now_is_finished_at_once(diary):
    diary.slices.begin_soon(steps(50), lambda result: diary.calls.append(result))
    diary.slices.finish()
    assert diary.calls == ["result"] and not diary.slices.is_busy
    diary.slices.finish()
    assert diary.calls == ["result"]
    diary.begin(steps(50, FleetError("no")))
    diary.slices.finish()
    assert diary.calls[-1] == ("failed", "no")


def test_a_fault_that_nobody_expects_is_seen(diary):
    diary.slices.begin_soon(steps(1, FleetError("no")))
    with pytest.raises(FleetError, match="no"):
        diary.slices.finish()


def test_a_fault_of_the_program_is_told_like_any_error_and_where_it_is_is_logged(diary):
    logged = []
    log = QgsApplication.messageLog().messageReceived[str, str, Qgis.MessageLevel]
    log.connect(note := lambda text, *_: logged.append(text))
    with pytest.raises(FleetError, match="a fault of the plugin: KeyError 'x'"):
        diary.begin(steps(1, KeyError("x")))
    diary.begin(steps(50, KeyError("y")))
    diary.slices.finish()
    log.disconnect(note)
    assert diary.calls[-1][0] == "failed" and "a fault of the plugin: KeyError 'y'" in diary.calls[-1][1]
    assert not diary.slices.is_busy
    assert len(logged) == 2 and "in steps" in logged[0]


@pytest.mark.parametrize("steps_after", [0, 1])
def test_work_that_begins_other_work_in_its_place_is_not_gone_on_with(diary, wait, steps_after):
    def work():
        yield 0.0
        diary.slices.begin_soon(steps(20, "next"), lambda result: diary.calls.append(("done", result)))
        for _ in range(steps_after):
            yield 0.5
            raise AssertionError("it went on")

    diary.slices.begin_soon(work(), lambda result: diary.calls.append("the first one"))
    wait(lambda: ("done", "next") in diary.calls)
    assert diary.calls == [("done", "next")]


def test_slices_of_one_step_each_leave_the_window_its_time_after_every_step(qgis_app, wait):
    told = []

    def work():
        for number in range(3):
            told.append(number)
            yield number / 3

    events = QTimer()
    events.timeout.connect(lambda: told.append("events"))
    events.start(0)
    slices = CooperativeTask(seconds=ONE_STEP, clock=ManualClock())
    slices.begin_soon(work())
    wait(lambda: not slices.is_busy)
    events.stop()
    assert [what for what, _ in groupby(told)][:6] == ["events", 0, "events", 1, "events", 2]


def test_parts_make_up_a_whole():
    def whole():
        first = yield from scaled_progress(steps(2, 1), 0, 2)
        second = yield from scaled_progress(steps(2, 2), 1, 2)
        return first + second

    work, shares = whole(), []
    with pytest.raises(StopIteration) as end:
        while True:
            shares.append(next(work))
    assert shares == [0.0, 0.25, 0.5, 0.75]
    assert end.value.value == 3
