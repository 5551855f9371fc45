"""Plays in which the gateway dies, a transaction fails, or links are cut: at each moment in turn.

Moments are the transactions that a scenario takes, or its seconds. One that stops robots is played once for
each of them while they come to a stand, for every third of those in which they stand and nothing happens, and
for each in which they go on again; what is driven before and then, and every other scenario, for every
twentieth, beginning with the next one from scenario to scenario. In a run for a release it is for each of
those in which they stand, and for every fourth. With EVERY_CRASH=1 in the environment all are played at each,
before and after the commit, with all that robots may do meanwhile.
"""

from __future__ import annotations

import itertools
import os
import shutil
import tempfile
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.support.bridge.crash_play import DRIVE_ON, Moment, Play
from tests.support.bridge.crash_scenarios import SCENARIOS
from tests.support.bridge.mortal_database import Death

STOPS = {"paused", "aborted", "aborted_too_late", "halted", "continued_at_once", "stopped"}
"""Scenarios in which operators stop robots."""
EVERY, EVERY_FOR_RELEASE = 20, 4
"""Of how many moments one is played, where no robot is stopped."""
STANDING, STANDING_FOR_RELEASE = 3, 1
"""Of how many moments one is played, while robots stand that were stopped."""
COME_TO_STAND = 12
"""For how many moments each is played after robots were told to stop; all stand by then."""
STILL_ALL = 10
"""For how many transactions each is played after robots were told to go on."""


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


@pytest.fixture
def moments(request):
    """Pair moments with what happens then: ``moments(scenario, all_moments, ways, while_stopped)``."""
    release = request.config.getoption("--release")
    every = EVERY_FOR_RELEASE if release else EVERY
    standing = STANDING_FOR_RELEASE if release else STANDING

    def moments(scenario, times, ways, while_stopped):
        if os.environ.get("EVERY_CRASH"):
            return list(itertools.product(times, ways))
        first = list(SCENARIOS).index(scenario)
        stopped = [at for at in times if scenario in STOPS and at in while_stopped]
        driven = [at for at in times if at not in stopped]
        coming, going = stopped[:COME_TO_STAND], stopped[COME_TO_STAND:][-STILL_ALL:]
        between = stopped[COME_TO_STAND:][:-STILL_ALL][first % standing :: standing]
        some = sorted(coming + between + going + driven[first % every :: every])
        # At the first of these what stops them is not stored yet: an emergency stop is in the journal alone.
        way = {at: number for number, at in enumerate(some, first)} | dict.fromkeys(stopped[:1], 0)
        return [(at, ways[way[at] % len(ways)]) for at in some]

    return moments


class Undisturbed(NamedTuple):
    """How a scenario goes when nothing happens: its transactions that write, and its turns."""

    writing: list[int]
    turns: int
    stopped: Moment
    resumed: Moment


@pytest.fixture(scope="session")
def known() -> dict[str, Undisturbed]:
    """Of each scenario that has been played; each goes the same way each time."""
    return {}


@pytest.fixture
def undisturbed(play, known):
    """Return how a scenario goes when nothing happens: ``await undisturbed(scenario)``."""

    async def undisturbed(scenario):
        if scenario not in known:
            alone = await play(scenario, Death(), DRIVE_ON)
            writing = sorted(alone.death.writing)
            known[scenario] = Undisturbed(writing, alone.turns, alone.stopped, alone.resumed)
        return known[scenario]

    return undisturbed


@pytest.fixture
def writing(undisturbed):
    """Return the numbers of the transactions that a scenario takes when nothing happens.

    Behind them the range of those at which each is worth a play: robots are stopped then.
    """

    async def writing(scenario):
        alone = await undisturbed(scenario)
        assert len(alone.writing) > 10
        assert 0 < alone.stopped.transactions < alone.resumed.transactions or scenario not in STOPS
        until = alone.resumed.transactions + STILL_ALL
        return alone.writing, range(alone.stopped.transactions + 1, until + 1)

    return writing
