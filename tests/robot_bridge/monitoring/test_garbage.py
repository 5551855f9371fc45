"""What Python looks at when it looks for garbage: what has lasted only now and then, and yet not never."""

from __future__ import annotations

import gc
import weakref

import pytest

from robot_bridge.monitoring.garbage import LOOK_AT_ALL_AFTER_S, Sparing


class Ring:
    """An object that holds itself, as connections do: only a look finds it when nobody else does."""

    def __init__(self):
        self.itself = self


@pytest.fixture
def clock():
    """A clock that stands; ``clock[0]`` is its time."""
    return [1000.0]


@pytest.fixture
def sparing(clock):
    """Python's collector with what spares what lasts, and without after the test."""
    spares = Sparing(lambda: clock[0])
    gc.callbacks.append(spares)
    yield spares
    gc.callbacks.remove(spares)
    gc.unfreeze()


def test_what_a_look_at_all_found_in_use_is_set_apart(sparing):
    assert gc.get_freeze_count() == 0
    gc.collect()
    assert gc.get_freeze_count() > 1000


def test_a_look_at_young_objects_sets_nothing_apart(sparing):
    gc.collect(1)
    assert gc.get_freeze_count() == 0


def test_what_was_in_use_and_is_garbage_now_is_found_after_a_time_and_not_before(sparing, clock):
    ring = Ring()
    seen = weakref.ref(ring)
    gc.collect()
    del ring
    gc.collect()
    clock[0] += LOOK_AT_ALL_AFTER_S - 1
    gc.collect()
    assert seen() is not None
    clock[0] += 1
    gc.collect()
    assert seen() is None


def test_what_came_since_is_found_at_once(sparing):
    gc.collect()
    seen = weakref.ref(Ring())
    gc.collect()
    assert seen() is None
