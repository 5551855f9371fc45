"""The gateway dies at each of its transactions in turn, and everything comes to its end all the same.

Each scenario is played once for every transaction that it takes: there the gateway dies, before its commit or
after it, another one starts on the same database, and the robots, which have lived on, come back to it.
With EVERY_CRASH=1 in the environment each of them is played before and after, with all that robots may do
meanwhile: six times as many plays. And so it is played with each transaction that fails, of which the gateway
does not die, and with the links of all robots cut at each moment.
"""

from __future__ import annotations

import itertools
import os
import shutil
import tempfile
from pathlib import Path

import pytest
from crash_play import DRIVE_ON, START_ANEW, STAY_AWAY, Cut, Play
from crash_scenarios import SCENARIOS
from mortal_database import FAILURES, Death

WAYS_TO_DIE = [(done, how) for how in (DRIVE_ON, START_ANEW, STAY_AWAY) for done in (False, True)]
"""Whether the commit was done, and what robots do meanwhile."""
WAYS_TO_BE_CUT = [(seconds, how) for how in (DRIVE_ON, START_ANEW) for seconds in (2.0, 15.0)]
"""For how many seconds links are cut, shorter than robots are lost in and longer, and what robots do then."""
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

    async def crash(scenario, url, death, how, cut=None):
        journal = quick_folder / f"{next(journals)}.stop"
        roads = scenario.startswith(("led", "waited"))
        play = Play(own_site, url, journal, death, how, cut=cut, roads=roads)
        try:
            await SCENARIOS[scenario](play)
        except AssertionError as error:
            raise AssertionError(f"{_told(death, cut)}, robots {how}: {error}") from error
        finally:
            await play.end()
        return play

    return crash


def _told(death, cut):
    if cut is not None:
        return f"links were cut in turn {cut.turn} for {cut.seconds:g} s"
    what = "the gateway died" if death.fails is None else f"{death.fails.__name__} came"
    return f"{what} {'after' if death.done else 'before'} commit {death.at}"


def some_of(ways, number):
    """Return one of ``ways``, each in its turn as ``number`` rises, or all."""
    return ways if os.environ.get("EVERY_CRASH") else [ways[number % len(ways)]]


@pytest.fixture
def play(crash, sqlite_url, quick_folder):
    """Play a scenario on a new SQLite database: ``await play(scenario, death, how, cut)``; return it."""
    file = quick_folder / "play.db"

    async def play(scenario, death, how, cut=None):
        for old in quick_folder.glob("play.db*"):
            old.unlink()
        shutil.copy(sqlite_url.removeprefix("sqlite:///"), file)
        return await crash(scenario, f"sqlite:///{file}", death, how, cut)

    return play


async def writing(play, scenario):
    """Return the numbers of the transactions that a scenario takes when nothing happens."""
    undisturbed = Death()
    await play(scenario, undisturbed, DRIVE_ON)
    assert len(undisturbed.writing) > 10
    return sorted(undisturbed.writing)


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_everything_comes_to_its_end_wherever_the_gateway_dies(scenario, play):
    for number, at in enumerate(await writing(play, scenario)):
        for done, how in some_of(WAYS_TO_DIE, number):
            death = Death(at, done)
            await play(scenario, death, how)
            assert death.has_come


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_and_so_it_does_whichever_transaction_fails(scenario, play):
    for number, at in enumerate(await writing(play, scenario)):
        for done, error in some_of(FAILURES, number):
            failure = Death(at, done, error)
            await play(scenario, failure, DRIVE_ON)
            assert failure.has_come


@pytest.mark.parametrize("scenario", SCENARIOS)
async def test_and_so_it_does_whenever_links_are_cut(scenario, play):
    turns = (await play(scenario, Death(), DRIVE_ON)).turns
    for turn in range(1, turns + 1):
        for seconds, how in some_of(WAYS_TO_BE_CUT, turn):
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
