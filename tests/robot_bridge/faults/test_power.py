"""A small computer's worst day: its disk is full, and its power is cut, which loses what was not written.

The disk is a real ext4 on a block device. One that says that it has written what it has not, or that writes
in another order than it was asked to, is not shown.
"""

from __future__ import annotations

import contextlib
import random
from collections import Counter

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.errors import StageError
from tests.support.faults import breaking
from tests.support.faults.audit import audit
from tests.support.faults.disk import DiskWithPower
from tests.support.faults.yard import Yard, sqlite_place
from tests.support.operators import open_desk
from tests.support.wire import RefusedError

ROBOTS = 6
STOP = "stop-on-a-full-disk"


@pytest.fixture
def seed():
    """What is random follows from it; pytest shows it when a test fails."""
    seed = random.randrange(10**6)
    print(f"seed {seed}")
    return seed


def test_what_was_confirmed_outlives_a_power_cut_and_a_stop_one_on_a_full_disk(tmp_path, seed):
    try:
        with DiskWithPower(tmp_path / "disk") as disk:
            place = sqlite_place(disk.folder, ROBOTS)
            with Yard(tmp_path, place, seed) as yard:
                live_through(yard, disk)
                findings = audit(yard)
    except StageError as error:
        if "the right to mount" not in str(error):
            raise
        pytest.skip(str(error))
    print(findings.lines())
    assert findings.wrong == []
    assert findings.counts[breaking.POWER_CUT] == 2
    assert findings.counts["... reached"] >= 10
    assert findings.counts["... stored"] >= 50


def live_through(yard, disk):
    yard.work(1.0, 2.0)
    breaking.cut_power(yard, disk)
    yard.work(1.0, 2.0)
    yard.settle()
    disk.fill()
    stop_on_a_full_disk(yard)
    breaking.cut_power(yard, disk)
    with open_desk(yard.address) as desk:
        assert (desk.emergency["in_force"], desk.emergency["stop"]) == (True, STOP)
        disk.free()
        desk.until(lambda: desk.emergency["acknowledged"] == ROBOTS and desk.emergency["stored"], 30)
        desk.ask("clear_emergency_stop", {"reason": "there is room again", "stop": STOP})
    yard.go_on()
    yard.work(1.0, 2.0)
    yard.finish()


def stop_on_a_full_disk(yard):
    """Abort one robot and then stop all, once nothing can be stored; those on WebSocket hear of it."""
    wait_until(lambda: yard.said("disk is full"), what="nobody said that the disk is full")
    on_websocket = {name for name, url in yard.place.robot_urls.items() if not url}
    one, before = min(on_websocket), aborts_of(yard)
    with open_desk(yard.address) as desk:
        with contextlib.suppress(RefusedError):
            desk.ask("abort", {"command": "abort-on-a-full-disk", "robot": one})
        wait_until(lambda: aborts_of(yard)[one] > before[one])
        before = aborts_of(yard)
        report = desk.ask("emergency_stop", {"command": STOP, "reason": "smoke"})
        assert report["in_force"]
        wait_until(lambda: all(aborts_of(yard)[name] > before[name] for name in on_websocket))
        assert report["stored"] or yard.said("the emergency stop is in force and not stored yet")


def aborts_of(yard):
    """Return how many times each robot stopped for having been told to."""
    return Counter(
        line["robot"] for line in yard.journals() if line["what"] == "acted" and line["op"] == "Abort"
    )
