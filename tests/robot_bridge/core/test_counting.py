"""One thing is told as one, and any other number as many."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import counted


@pytest.mark.parametrize(("number", "words"), [(0, "0 cones"), (1, "1 cone"), (2, "2 cones")])
def test_one_thing_is_no_many(number, words):
    assert counted(number, "cone") == words
