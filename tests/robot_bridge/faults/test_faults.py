"""Real processes and databases that die at random moments: nothing is lost or done twice, all by itself.

`make bench PARTS=faults` does the same many times over.
"""

from __future__ import annotations

import random
import time

import pytest

from tests.support.errors import StageError
from tests.support.faults import breaking
from tests.support.faults.runs import ROBOTS, broken_on_server, broken_on_small_disk
from tests.support.faults.yard import GATEWAY_KILLED, ROBOTS_KILLED

CUT_S = 3.0
FEW = ROBOTS // 2
"""robots of a run that is not for a release; each drives, tells and is audited as often."""
LONGEST_S = 120.0
"""seconds for what should have been done beside the faults, or soon after them."""


@pytest.fixture
def seed():
    """What is random follows from it; pytest shows it when a test fails."""
    seed = random.randrange(10**6)
    print(f"seed {seed}")
    return seed


@pytest.fixture
def robots(request):
    """How many robots there are."""
    return ROBOTS if request.config.getoption("--release") else FEW


def go_on_until_reached(yard, commands):
    """Let robots work on until they have reached so many; on a machine with other work that takes longer."""
    until = time.monotonic() + LONGEST_S
    while list(yard.ledger.ended.values()).count("reached") < commands and time.monotonic() < until:
        time.sleep(0.1)


def kept_all(findings, reached, **faults):
    """Tell that these faults were there, that enough went on beside them, and that nothing is wrong."""
    print(findings.lines())
    assert findings.wrong == []
    counts = findings.counts
    assert {what: counts[what] for what in faults} == faults
    assert counts["... reached"] >= reached
    assert counts["acted on"] >= reached
    assert counts["objects accepted"] >= 20
    assert counts["images accepted"] >= 5
    assert counts["... stored"] >= 100


def test_on_sqlite_a_gateway_and_robots_are_killed_and_the_disk_is_full(tmp_path, seed, robots):
    def break_it(yard, disk):
        for kills in (3, 2):
            breaking.kill_robots(yard, 1, rest=0.0)
            breaking.kill_gateway(yard, kills, longest=1.2)
        breaking.fill_disk(yard, disk, CUT_S)
        go_on_until_reached(yard, 100)

    try:
        findings = broken_on_small_disk(tmp_path, seed, break_it, robots)
    except StageError as error:
        if "the right to mount" not in str(error):
            raise
        pytest.skip(str(error))
    kept_all(findings, 100, **{GATEWAY_KILLED: 5, ROBOTS_KILLED: 2, breaking.DISK_FULL: 1})


@pytest.mark.parametrize(
    ("kind", "cut"),
    [
        pytest.param("postgresql", breaking.stall_network, id="postgresql-stalled"),
        pytest.param(
            "mariadb",
            breaking.reset_network,
            id="mariadb-reset",
            marks=pytest.mark.again("postgresql-stalled; test_servers_that_fail.py on both"),
        ),
    ],
)
def test_a_server_is_killed_and_the_network_to_it_is_cut(kind, cut, tmp_path, seed, robots):
    def break_it(yard):
        breaking.kill_server(yard, 2, longest=2.0)
        cut(yard, CUT_S)
        go_on_until_reached(yard, 50)

    try:
        findings = broken_on_server(kind, tmp_path, seed, break_it, robots)
    except StageError as error:
        if "not on this machine" not in str(error):
            raise
        pytest.skip(str(error))
    what = breaking.STALLED if cut is breaking.stall_network else breaking.REFUSED
    kept_all(findings, 50, **{breaking.SERVER_KILLED: 2, what: 1})
