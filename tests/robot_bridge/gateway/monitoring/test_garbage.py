"""When Python looks for objects that hold each other: not while a fleet sends positions, and yet in time."""

from __future__ import annotations

import gc
import weakref

import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.monitoring import (
    AFTER_STOP_S,
    MOST_GONE,
    MOST_POSTPONED_S,
    REST,
    YOUNG,
    GarbageCollection,
    freeze_permanent_objects,
)
from robot_bridge.gateway.storage.repositories.trajectories import Fix
from tests.support.bridge.command_line import run_command


class Ring:
    """An object that holds itself, as connections do: only a look finds it when nobody else does."""

    def __init__(self):
        self.itself = self


@pytest.fixture(scope="module")
def frozen():
    """What has been loaded is frozen, as in a gateway that has started: that takes more than a second."""
    thresholds = gc.get_threshold()
    gc.unfreeze()  # what tests/conftest.py has spared
    freeze_permanent_objects()
    yield
    gc.set_threshold(*thresholds)


@pytest.fixture
def looks(frozen):
    """The looks that begin in a gateway that has started."""
    begun = []
    gc.collect()

    def note(phase, info):
        if phase == "start":
            begun.append(info["generation"])

    gc.callbacks.append(note)
    yield begun
    gc.callbacks.remove(note)


def test_ten_thousand_positions_that_wait_to_be_stored_bring_no_look(looks):
    for second in range(20):
        waiting = [Fix("r1", float(second), SendPos(1.0, 2.0, 0.0, 1.0)) for _ in range(10_000)]
        waiting.clear()
    assert looks == []


def test_what_holds_itself_is_found(looks):
    first = weakref.ref(Ring())
    for _ in range(YOUNG + 1000):
        Ring()
    assert looks == [0]
    assert first() is None


def test_what_was_loaded_is_not_looked_at(looks):
    assert gc.get_freeze_count() > 10_000


def test_a_gateway_that_has_loaded_its_modules_goes_on_to_look(tmp_path):
    assert run_command("serve", "--site", tmp_path / "none").returncode == 1
    assert gc.isenabled()


def test_what_many_connections_left_is_looked_for_at_once_and_only_once(looks):
    leavings, old = GarbageCollection(ManualClock()), weakref.ref(Ring())
    leavings.clear_away(MOST_GONE - 1)
    assert looks == [] and old() is not None
    leavings.clear_away(MOST_GONE)
    assert looks == [2] and old() is None
    leavings.clear_away(2 * MOST_GONE - 1)
    assert looks == [2]
    leavings.clear_away(2 * MOST_GONE)
    assert looks == [2, 2]


def test_a_look_that_took_long_is_not_followed_by_another_for_much_longer(looks):
    """However many connections go: everybody waits while Python looks."""
    clock = ManualClock(uptime=10.0)

    def last_two_seconds(phase, _info):
        if phase == "stop":
            clock.advance(2.0)

    leavings = GarbageCollection(clock)
    gc.callbacks.append(last_two_seconds)
    try:
        leavings.clear_away(MOST_GONE)
        clock.advance(2.0 * REST - 0.1)
        leavings.clear_away(9 * MOST_GONE)
        assert looks == [2]
        clock.advance(0.2)
        leavings.clear_away(9 * MOST_GONE)
    finally:
        gc.callbacks.remove(last_two_seconds)
    assert looks == [2, 2]


@pytest.fixture
def enabled():
    yield
    gc.enable()


def test_nothing_is_looked_at_for_a_while_after_a_stop_has_begun(looks, enabled):
    clock = ManualClock(uptime=10.0)
    leavings = GarbageCollection(clock)
    leavings.postpone()
    for _ in range(2 * YOUNG):
        Ring()
    leavings.clear_away(MOST_GONE)
    assert looks == []
    clock.advance(AFTER_STOP_S - 1.0)
    leavings.postpone()
    clock.advance(AFTER_STOP_S - 1.0)
    leavings.clear_away(MOST_GONE)
    assert looks == [], "a second stop had begun"
    clock.advance(1.0)
    leavings.clear_away(MOST_GONE)
    assert gc.isenabled() and 2 in looks


def test_stops_without_end_do_not_keep_what_is_left_behind_for_ever(looks, enabled):
    clock = ManualClock(uptime=10.0)
    leavings = GarbageCollection(clock)
    for _ in range(int(MOST_POSTPONED_S)):
        leavings.postpone()
        clock.advance(1.0)
    leavings.clear_away(0)
    assert gc.isenabled()
