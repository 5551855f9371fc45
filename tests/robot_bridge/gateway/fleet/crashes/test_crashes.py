"""The gateway dies, a transaction fails or links are cut, and everything comes to its end all the same.

A gateway dies before a commit or after it, another one starts on the same database, and the robots, which
have lived on, come back to it. Of a transaction that fails it does not die.
"""

from __future__ import annotations

import pytest

from tests.support.bridge.crash_play import DRIVE_ON, START_ANEW, STAY_AWAY, Cut
from tests.support.bridge.crash_scenarios import SCENARIOS
from tests.support.bridge.mortal_database import FAILURES, Death

WAYS_TO_DIE = [(done, how) for how in (DRIVE_ON, START_ANEW, STAY_AWAY) for done in (False, True)]
"""Whether the commit was done, and what robots do meanwhile."""
ON_SERVERS = ["cones_over_sql", "stopped", "taken_over", "waited_with_its_queue"]
EVERY_SO_MANY = 17
"""transactions between two at which it dies on a database server, where a play takes longer."""
STILL_ALL = 5
"""For how many turns links are cut in each, after robots were told to go on."""
WAYS_TO_BE_CUT = [(seconds, how) for how in (DRIVE_ON, START_ANEW) for seconds in (2.0, 15.0)]
"""For how many seconds links are cut, shorter than robots are lost in and longer, and what robots do then."""


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_wherever_the_gateway_dies(scenario, play, writing, moments):
    times, while_stopped = await writing(scenario)
    for at, (done, how) in moments(scenario, times, WAYS_TO_DIE, while_stopped):
        death = Death(at, done)
        await play(scenario, death, how)
        assert death.has_come


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_whichever_transaction_fails(scenario, play, writing, moments):
    times, while_stopped = await writing(scenario)
    for at, (done, error) in moments(scenario, times, FAILURES, while_stopped):
        failure = Death(at, done, error)
        await play(scenario, failure, DRIVE_ON)
        assert failure.has_come


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_whenever_links_are_cut(scenario, play, undisturbed, moments):
    alone = await undisturbed(scenario)
    turns = list(range(1, alone.turns + 1))
    while_stopped = range(alone.stopped.turns, alone.resumed.turns + STILL_ALL + 1)
    for turn, (seconds, how) in moments(scenario, turns, WAYS_TO_BE_CUT, while_stopped):
        await play(scenario, Death(), how, Cut(turn, seconds))


@pytest.fixture(params=["postgresql", "mariadb"])
def new_url(request, new_database):
    """Make an empty database on a server: ``new_url()``."""
    new_database(request.param)
    return lambda: new_database(request.param)


@pytest.mark.parametrize("scenario", ON_SERVERS)
async def test_and_so_it_does_on_database_servers(scenario, crash, new_url):
    first = 1 + ON_SERVERS.index(scenario)
    death = Death(first)
    while death.has_come:
        await crash(scenario, new_url(), death, WAYS_TO_DIE[death.at % len(WAYS_TO_DIE)][1])
        death = Death(death.at + EVERY_SO_MANY, not death.done)
