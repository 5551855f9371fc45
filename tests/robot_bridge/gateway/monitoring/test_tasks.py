"""The gateway's own tasks: what fails is logged, counted and tried again; what cannot go on says so."""

import asyncio
import os
import socket

import pytest

from robot_bridge.core.errors import FatalError, StoreError
from robot_bridge.core.systemd import notify, watchdog_interval
from robot_bridge.gateway import monitoring as tasks
from robot_bridge.gateway.monitoring import Counters
from tests.support.patience import BUSY


@pytest.fixture(autouse=True)
def short_pauses(monkeypatch):
    monkeypatch.setattr(tasks, "FIRST_PAUSE", 0.001)
    monkeypatch.setattr(tasks, "LONGEST_PAUSE", 0.002)
    monkeypatch.setattr(tasks, "LONGEST_PAUSE_UNFORESEEN", 0.002)


def failing(times, error):
    """Return work that fails so many times and then is done, and the list of its attempts."""
    attempts = []

    async def work():
        attempts.append(len(attempts))
        if len(attempts) <= times:
            raise error

    return work, attempts


async def test_what_fails_is_logged_counted_and_tried_again(caplog):
    counters = Counters()
    work, attempts = failing(3, ZeroDivisionError("3 / 0"))
    await tasks.keep_going("sql link", work, counters)
    assert len(attempts) == 4 and counters.failures == {"sql link": 3}
    assert [record.exc_info is not None for record in caplog.records] == [True] * 3
    assert "sql link: unexpected ZeroDivisionError; trying again in 0.001 s" in caplog.text


async def test_what_the_bridge_foresaw_is_one_line_and_may_last_as_long_as_it_likes(caplog):
    counters = Counters()
    work, attempts = failing(3 * tasks.LAST_ATTEMPT, StoreError("database away"))
    await tasks.keep_going("save", work, counters)
    assert len(attempts) == 3 * tasks.LAST_ATTEMPT + 1
    (record,) = caplog.records  # and not one for each attempt
    assert record.getMessage() == "save: database away; trying again until it works"
    assert record.exc_info is None


async def test_what_fails_again_and_again_for_a_reason_nobody_foresaw_ends_the_gateway():
    work, attempts = failing(1000, KeyError("x"))
    with pytest.raises(FatalError, match=r"age failed 20 times, last with KeyError: 'x'"):
        await tasks.keep_going("age", work, Counters())
    assert len(attempts) == tasks.LAST_ATTEMPT


async def test_what_cannot_go_on_is_not_tried_again():
    work, attempts = failing(1, FatalError("another gateway took over"))
    with pytest.raises(FatalError, match="another gateway took over"):
        await tasks.keep_going("lock", work, Counters())
    assert len(attempts) == 1


async def test_one_that_cannot_go_on_ends_them_all():
    ended = []

    async def others():
        try:
            await asyncio.sleep(60)
        finally:
            ended.append(True)

    lost, _ = failing(1, FatalError("another gateway took over"))
    with pytest.raises(FatalError, match=r"^another gateway took over$"):
        await tasks.keep_all_going({"save": others, "lock": lost}, Counters())
    assert ended == [True]


async def test_failures_long_before_do_not_count(monkeypatch):
    monkeypatch.setattr(tasks, "SOUND", -1.0)
    work, attempts = failing(2 * tasks.LAST_ATTEMPT, KeyError("x"))
    await tasks.keep_going("age", work, Counters())
    assert len(attempts) == 2 * tasks.LAST_ATTEMPT + 1


async def test_a_task_that_works_has_a_beat():
    counters = Counters()

    async def work():
        if counters.age("save") is not None:
            raise FatalError("enough")

    with pytest.raises(FatalError):
        await tasks.every(0.001, work, "save", counters)
    assert 0 <= counters.age("save") < 5 and counters.age("other") is None


async def test_a_task_that_is_cancelled_ends():
    async def work():
        await asyncio.sleep(60)

    task = asyncio.create_task(tasks.keep_going("age", work, Counters()))
    await asyncio.sleep(0.01)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task


@pytest.mark.parametrize("abstract", [False, True])
def test_systemd_is_told(tmp_path, monkeypatch, abstract):
    name = f"@robot-bridge-test-{os.getpid()}" if abstract else str(tmp_path / "notify")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind("\0" + name[1:] if abstract else name)
        manager.settimeout(BUSY * 2)
        monkeypatch.setenv("NOTIFY_SOCKET", name)
        notify("READY=1", "STATUS=listening")
        assert manager.recv(1000) == b"READY=1\nSTATUS=listening"


def test_nobody_is_told_where_nobody_asks(monkeypatch):
    monkeypatch.delenv("NOTIFY_SOCKET", raising=False)
    notify("READY=1")
    monkeypatch.setenv("NOTIFY_SOCKET", "/nowhere/notify")
    notify("READY=1")


@pytest.mark.parametrize(
    ("limit", "process", "interval"),
    [("10000000", None, 5.0), ("10000000", "self", 5.0), ("10000000", "1", None), ("", None, None)],
)
def test_the_watchdog_is_fed_twice_as_often_as_it_asks(monkeypatch, limit, process, interval):
    monkeypatch.setenv("WATCHDOG_USEC", limit)
    monkeypatch.setenv(
        "WATCHDOG_PID", "" if process is None else str(os.getpid()) if process == "self" else process
    )
    assert watchdog_interval() == interval


@pytest.fixture
def at(monkeypatch):
    """Set the seconds since the first tick."""
    return lambda now: monkeypatch.setattr(tasks.time, "monotonic", lambda: tasks._TICKS_SINCE + now)


@pytest.mark.parametrize("seconds", [0.25, 0.3, 0.49, 0.5, 1.0, 2.0, 60.0])
def test_what_is_done_at_intervals_is_never_done_later_and_rests_for_half_of_them(seconds, at):
    for hundredths in range(50):
        at(7 + hundredths / 100)
        assert seconds / 2 <= tasks.until_tick(seconds) <= seconds
        at(7.2499 + hundredths / 100)
        assert seconds / 2 <= tasks.until_tick(seconds) <= seconds


@pytest.mark.parametrize("seconds", [0.25, 0.3, 0.49, 0.5, 1.0, 2.0, 60.0])
def test_what_is_done_at_intervals_is_done_at_common_moments_after_one_wait_or_two(seconds, at):
    for now in (0.0, 0.01, 0.13, 0.2, 0.2489, 0.26, 7.4999):
        waited = 0.0
        # What an event loop rounds off is not done twice.
        for _ in range(1 if seconds >= 2 * tasks.TICK_S else 2):
            at(now + waited)
            waited += tasks.until_tick(seconds)
        ticks = (now + waited) / tasks.TICK_S
        assert ticks == pytest.approx(round(ticks), abs=2 * tasks._ROUNDING_S / tasks.TICK_S)


def test_work_that_takes_long_rests_for_half_its_interval(at):
    at(0.24)
    assert tasks.until_tick(0.25) == pytest.approx(0.125)
    at(0.1)
    assert tasks.until_tick(0.25) == pytest.approx(0.15)
    assert tasks.until_tick(0.01) == 0.01
