"""The gateway dies at each of its transactions in turn, and everything comes to its end all the same.

Each scenario is played once for every transaction that it takes: there the gateway dies, before its commit or
after it, another one starts on the same database, and the robots, which have lived on, come back to it.
With EVERY_CRASH=1 in the environment each of them is played before and after, with all that robots may do
meanwhile: six times as many plays.
"""

from __future__ import annotations

import itertools
import os
import shutil
import tempfile
from pathlib import Path

import pytest
from crash_play import DRIVE_ON, START_ANEW, STAY_AWAY, Play
from crash_scenarios import SCENARIOS
from mortal_database import Death

WAYS_TO_DIE = [(done, how) for how in (DRIVE_ON, START_ANEW, STAY_AWAY) for done in (False, True)]
"""Whether the commit was done, and what robots do meanwhile."""
ON_SERVERS = ["cones_over_sql", "stopped", "taken_over", "waited_with_its_queue"]
EVERY_SO_MANY = 17
"""transactions between two at which it dies on a database server, where a play takes longer."""


@pytest.fixture
def quick_folder():
    """A folder in memory where there is one: what a gateway leaves there need not outlive a power cut."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if os.access(memory, os.W_OK) else None) as folder:
        yield Path(folder)


@pytest.fixture
def crash(own_site, quick_folder):
    """Play a scenario with one death of its gateway: ``await crash(scenario, url, death, how)``."""
    journals = itertools.count()

    async def crash(scenario, url, death, how):
        journal = quick_folder / f"{next(journals)}.stop"
        play = Play(own_site, url, journal, death, how, roads=scenario.startswith(("led", "waited")))
        try:
            await SCENARIOS[scenario](play)
        except AssertionError as error:
            when = f"{'after' if death.done else 'before'} commit {death.at}, robots {how}"
            raise AssertionError(f"the gateway died {when}: {error}") from error
        finally:
            await play.end()

    return crash


def ways_to_die(number):
    """Return how the gateway is to die: in one way, each in its turn as ``number`` rises, or in all."""
    return WAYS_TO_DIE if os.environ.get("EVERY_CRASH") else [WAYS_TO_DIE[number % len(WAYS_TO_DIE)]]


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_wherever_the_gateway_dies(
    scenario, crash, sqlite_url, quick_folder
):
    file = quick_folder / "play.db"

    async def play(death, how):
        for old in quick_folder.glob("play.db*"):
            old.unlink()
        shutil.copy(sqlite_url.removeprefix("sqlite:///"), file)
        await crash(scenario, f"sqlite:///{file}", death, how)

    undisturbed = Death()
    await play(undisturbed, DRIVE_ON)
    assert len(undisturbed.writing) > 10
    for number, at in enumerate(sorted(undisturbed.writing)):
        for done, how in ways_to_die(number):
            death = Death(at, done)
            await play(death, how)
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
