"""Who looks at the robots in which pull."""

from __future__ import annotations

from itertools import pairwise

from fleet_supervisor.plugin.ui.scheduling import PULLS_IN_HALF_A_SECOND, UpdateScheduler


def pulls_of(beat, turn, pulls, half_seconds=1):
    """Return the pulls, of so many from now on, in which ``turn`` comes."""
    came = []
    for _ in range(pulls):
        beat.pulls += 1
        if turn.is_due(half_seconds):
            came.append(beat.pulls)
    return came


def test_a_turn_comes_once_in_each_half_second():
    beat = UpdateScheduler()
    came = pulls_of(beat, beat.turn(), 5 * PULLS_IN_HALF_A_SECOND)
    assert len(came) == 5
    assert {later - before for before, later in pairwise(came)} == {PULLS_IN_HALF_A_SECOND}


def test_a_turn_comes_as_seldom_as_it_is_asked_to():
    beat = UpdateScheduler()
    assert len(pulls_of(beat, beat.turn(), 8 * PULLS_IN_HALF_A_SECOND, half_seconds=4)) == 2


def test_each_has_a_pull_of_its_own_as_long_as_there_are_enough():
    beat = UpdateScheduler()
    turns = [beat.turn() for _ in range(PULLS_IN_HALF_A_SECOND)]
    for _ in range(PULLS_IN_HALF_A_SECOND):
        beat.pulls += 1
        assert sum(turn.is_due() for turn in turns) == 1
