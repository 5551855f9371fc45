"""The gateway dies at one of its transactions, and everything comes to its end all the same.

It dies before the commit or after it, another one starts on the same database, and the robots, which have
lived on, come back to it.
"""

from __future__ import annotations

import pytest

from tests.support.bridge.crash_play import DRIVE_ON, START_ANEW, STAY_AWAY
from tests.support.bridge.crash_scenarios import SCENARIOS
from tests.support.bridge.mortal_database import Death

WAYS_TO_DIE = [(done, how) for how in (DRIVE_ON, START_ANEW, STAY_AWAY) for done in (False, True)]
"""Whether the commit was done, and what robots do meanwhile."""
ON_SERVERS = ["cones_over_sql", "stopped", "taken_over", "waited_with_its_queue"]
EVERY_SO_MANY = 17
"""transactions between two at which it dies on a database server, where a play takes longer."""


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_wherever_the_gateway_dies(scenario, play, writing, moments):
    times, while_stopped = await writing(scenario)
    for at, (done, how) in moments(scenario, times, WAYS_TO_DIE, while_stopped):
        death = Death(at, done)
        await play(scenario, death, how)
        assert death.has_come


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
