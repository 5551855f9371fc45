"""Reducing outlines tells how far it is, and ends midway when it is told to."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from robot_bridge.core.errors import MapCancelledError
from robot_bridge.core.robotmap.shaping import Shaping, shaped
from tests.robot_bridge.core.robotmap.rows import box, outlines, row

EVERYTHING = Shaping((0.1, 9.0), 0.5, dissolve=True, chain=True, tolerance=0.05, shortest=0.1)


@pytest.fixture
def street():
    """Houses wall to wall, each with a line beside it."""
    houses = [box(4 * k, 0, 4 * k + 4, 4, source=f"h:{k}") for k in range(200)]
    fences = [row([(4 * k, -9 - k % 7), (4 * k + 3, -9 - k % 7)], source=f"f:{k}") for k in range(200)]
    return outlines(*houses, *fences)


def test_it_tells_how_far_it_is_and_never_less_than_before(street):
    told = []
    shaped(street, EVERYTHING, progress=told.append)
    assert len(told) > 20
    assert all(before <= after for before, after in pairwise(told))
    assert told[0] == 0.0 and told[-1] == 1.0
    assert max(after - before for before, after in pairwise(told)) < 0.15


def test_to_be_watched_changes_nothing(street):
    plain, watched = shaped(street, EVERYTHING), shaped(street, EVERYTHING, lambda _: None, lambda: False)
    assert np.array_equal(plain.coordinates, watched.coordinates)
    assert list(plain.source) == list(watched.source)


def test_a_cancel_at_any_moment_ends_it_at_once(street):
    asked = []
    shaped(street, EVERYTHING, cancelled=lambda: bool(asked.append(1)))
    assert len(asked) > 20
    for moment in range(1, len(asked) + 1):
        again = []

        def cancelled(again=again, moment=moment):
            again.append(1)
            return len(again) >= moment

        with pytest.raises(MapCancelledError):
            shaped(street, EVERYTHING, cancelled=cancelled)
        assert len(again) == moment
