"""What of a recording is told when, and its clock; no I/O."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from robot_bridge.core.messages.robots import SetPosEnd
from robot_bridge.links.base.adapter import Command
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.replay.adapter import PlayClock, Player, ReplayAdapter, ReplayPresence, ReplaySettings
from robot_bridge.recordings.tracks import Remarks, Sample, Source, gather


def recording(*samples):
    rows = [Sample(n, robot, t, x, 0.0, 0.0, 1.0) for n, (robot, t, x) in enumerate(samples, 1)]
    return gather(Path("drive.csv"), Source(None, iter(rows)), Remarks())


def test_the_clock_does_not_drift_however_often_it_is_asked_and_changed():
    clock, now = PlayClock(100.0, 1.0, 5.0), 5.0
    generator = random.Random(3)
    expected = 100.0
    for _ in range(20_000):
        step, speed = generator.uniform(0, 0.3), generator.choice([0.1, 1.0, 10.0, 1000.0])
        now, expected = now + step, expected + step * clock.speed
        clock.place(now)
        clock.change(now, speed=speed, paused=False)
    assert clock.place(now) == pytest.approx(expected, rel=1e-9)
    assert clock.when(clock.place(now) + clock.speed) == pytest.approx(now + 1.0)


def test_a_clock_that_stands_reaches_nothing_and_goes_on_from_there():
    clock = PlayClock(0.0, 10.0, 0.0)
    clock.change(2.0, speed=10.0, paused=True)
    assert (clock.place(60.0), clock.when(21.0)) == (20.0, math.inf)
    clock.change(60.0, speed=1.0, paused=False)
    assert (clock.place(61.0), clock.when(25.0)) == (21.0, 65.0)


def test_the_newest_position_up_to_a_place_is_told_once():
    player = Player(recording(("a", 0, 0), ("a", 1, 1), ("a", 2, 2), ("b", 1.5, 9)), 5.0)
    assert [(t.at, t.is_new, t.presence) for t in player.advance(0.5)] == [
        (0, True, ReplayPresence.HERE),
        (-1, False, ReplayPresence.BEFORE),
    ]
    assert player.next_place() == 1.0
    assert [(t.at, t.is_new) for t in player.advance(1.9)] == [(1, True), (0, True)]
    assert [(t.at, t.is_new) for t in player.advance(1.95)] == [(1, False), (0, False)]
    assert [(t.at, t.is_new) for t in player.advance(0.1)] == [(0, True), (-1, True)]


def test_a_robot_is_silent_in_a_gap_and_over_behind_its_end():
    player = Player(recording(("a", 0, 0), ("a", 60, 1)), 5.0)
    presences = [next(player.advance(place)).presence for place in (4.9, 5.1, 60.0, 65.1)]
    assert presences == [ReplayPresence.HERE, ReplayPresence.SILENT, ReplayPresence.HERE, ReplayPresence.OVER]
    assert player.next_place() == math.inf


async def test_a_recording_refuses_what_a_gateway_would_have_it_do(tmp_path):
    file = tmp_path / "drive.toml"
    file.write_text("[replay]", encoding="utf-8")
    adapter = ReplayAdapter(
        recording(("car", 0.0, 0.0), ("car", 1.0, 1.0)), ReplaySettings("drive.csv"), file
    )
    with pytest.raises(CommandRefusedError, match="it can be seen and not commanded"):
        await adapter.command(Command("replay-car", 7, SetPosEnd(1.0, 2.0), False))
