"""The links of all robots are cut, and everything comes to its end all the same."""

from __future__ import annotations

import pytest

from tests.support.bridge.crash_play import DRIVE_ON, START_ANEW, Cut
from tests.support.bridge.crash_scenarios import SCENARIOS
from tests.support.bridge.mortal_database import Death

STILL_ALL = 5
"""For how many turns links are cut in each, after robots were told to go on."""

WAYS_TO_BE_CUT = [(seconds, how) for how in (DRIVE_ON, START_ANEW) for seconds in (2.0, 15.0)]
"""For how many seconds links are cut, shorter than robots are lost in and longer, and what robots do then."""


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_whenever_links_are_cut(scenario, play, moments):
    undisturbed = await play(scenario, Death(), DRIVE_ON)
    turns = list(range(1, undisturbed.turns + 1))
    while_stopped = range(undisturbed.stopped.turns, undisturbed.resumed.turns + STILL_ALL + 1)
    for turn, (seconds, how) in moments(scenario, turns, WAYS_TO_BE_CUT, while_stopped):
        await play(scenario, Death(), how, Cut(turn, seconds))
