"""The network between a link and its gateway is gone for 10 s: nothing is lost, and nothing done twice."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from types import SimpleNamespace

import pytest

from robot_bridge.core.messages.robots import SendPos, SetObject
from tests.support.bridge.adapter_on_the_line import LinkOnTheLine
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.cut_line import CutLine
from tests.support.patience import START

CUT = 10.0
"""seconds; a robot of this site is lost after 1.6 s."""
DRIVING, SENT, ORDERED, STOPPED, SEEING = ROBOTS = ("driving", "sent", "ordered", "stopped", "seeing")


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture
def line(bridge):
    line = CutLine(int(bridge.address.rpartition(":")[2]))
    yield line
    line.close()


@pytest.fixture
def link(line, tmp_path):
    link = LinkOnTheLine(SimpleNamespace(address=line.address), tmp_path)
    yield link
    link.end()


@pytest.mark.parametrize("reset", [False, True], ids=["bytes come late", "bytes are lost"])
def test_a_network_that_was_cut_loses_nothing_and_does_nothing_twice(bridge, line, link, reset):
    kind = "lost" if reset else "late"
    names = {robot: f"{robot}-{kind}" for robot in ROBOTS}
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    began, goes_on = threading.Event(), threading.Event()

    async def during(command):
        if command.robot == names[SENT]:
            began.set()
            await asyncio.to_thread(goes_on.wait, 30)

    link.adapter.during = during
    for n, name in enumerate(names.values()):
        link.do("add", name, ["targets", "paths"])
        link.do("position", name, SendPos(20.0 + 5 * n, 8.0, 0.0, 0.0))
    desk.wait_for_robots(*names.values())

    def go(robot):
        desk.send(f"go-{names[robot]}", names[robot], "SetPosEnd", x=60.0, y=8.0)

    for robot in (DRIVING, STOPPED):
        go(robot)
        desk.wait_for_step(f"go-{names[robot]}", "acknowledged")
    go(SENT)
    wait_until(began.is_set)

    line.cut()
    mended_at = time.monotonic() + CUT
    # On the robots' side: one takes on what it was sent, one arrives, one sees something.
    goes_on.set()
    link.do("position", names[DRIVING], SendPos(60.0, 8.0, 0.0, 0.0))
    link.do("stopped", names[DRIVING])
    asked = begin(link, link.client.ask(names[SEEING], SetObject(30.0, 9.0, "crate", source="crate 1")))
    areas = begin(link, link.client.areas((0.0, 0.0, 200.0, 160.0)))
    # At the desk: one is ordered, one is stopped.
    for name in names.values():
        desk.until(lambda name=name: desk.robots[name]["state"] == "lost")
    go(ORDERED)
    desk.send(f"stop-{names[STOPPED]}", names[STOPPED], "Abort")
    while (left := mended_at - time.monotonic()) > 0:
        time.sleep(left)
    assert [c.robot for c in link.adapter.commands] == [names[DRIVING], names[STOPPED], names[SENT]]
    assert link.adapter.stops == [] and not asked.done() and not areas.done()
    line.mend(reset=reset)

    assert asked.result(60).ok and areas.result(60).keepouts
    desk.wait_for_step(f"stop-{names[STOPPED]}", "acknowledged")
    link.do("position", names[STOPPED], SendPos(36.0, 8.0, 0.0, 0.0))
    link.do("stopped", names[STOPPED])
    desk.wait_for_step(f"go-{names[STOPPED]}", "aborted")
    desk.wait_for_step(f"go-{names[ORDERED]}", "acknowledged")
    desk.wait_for_step(f"go-{names[SENT]}", "acknowledged")
    link.do("position", names[DRIVING], SendPos(60.0, 8.0, 0.0, 0.0))
    desk.wait_for_step(f"go-{names[DRIVING]}", "reached")
    # Each was sent once what it was to do, and stopped because it was asked to.
    commanded = sorted(command.robot for command in link.adapter.commands)
    assert commanded == sorted(names[robot] for robot in (DRIVING, STOPPED, SENT, ORDERED))
    assert {robot for robot, _ in link.adapter.stops} == {names[STOPPED]}
    observed = desk.ask("get_observations", {"robot": names[SEEING]})["observations"]
    assert [one["object"] for one in observed] == ["crate"]
    for robot in (DRIVING, SENT, ORDERED):
        states = [step["state"] for step in steps(desk, f"go-{names[robot]}")]
        assert len(states) == len(set(states)), states


PAUSE = 0.5
"""seconds after which a link counts as having stood still, in the standstill of a test."""


@pytest.fixture
def hasty_link(line, tmp_path):
    link = LinkOnTheLine(SimpleNamespace(address=line.address), tmp_path, "hasty", longest_pause_s=START)
    yield link
    link.end()


@contextlib.contextmanager
def standing_still(link):
    """Have a link stand still; for how long a busy machine holds it up otherwise does not count."""
    with link.standing_still(2 * PAUSE):
        link.client._connection._standstill._longest_s = PAUSE
        yield


def say_where_it_stands(desk, link, name, is_heard):
    """Have a robot say where it is until that is heard, as robots do."""

    def say():
        link.do("position", name, SendPos(20.0, 8.0, 0.0, 0.0))
        return is_heard()

    desk.until(say)


def stand_still(desk, link, line, name, *, abort):
    """Have a link stand still, and its connection die, with a target in its buffer; with an Abort behind."""
    with standing_still(link):
        desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
        wait_until(lambda: b'"SetPosEnd"' in line.passed_back)
        line.cut()
        if abort:
            desk.send(f"stop-{name}", name, "Abort")
            desk.listen(0.2)


def test_a_link_that_stood_still_begins_no_target_that_was_aborted_meanwhile(bridge, line, hasty_link):
    link, name, desk = hasty_link, "held-robot", bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    link.do("add", name, ["targets"])
    say_where_it_stands(desk, link, name, lambda: (desk.robots.get(name) or {}).get("x") is not None)
    stand_still(desk, link, line, name, abort=True)
    wait_until(lambda: not link.client.is_connected)
    line.mend(reset=True)
    wait_until(lambda: link.adapter.stops == [(name, False)])
    say_where_it_stands(desk, link, name, lambda: desk.commands[f"stop-{name}"]["state"] == "reached")
    assert link.adapter.commands == []
    # Both come again: what became of the target depends on which of its ends is stored first.
    desk.until(lambda: desk.commands[f"go-{name}"]["state"] in ("aborted", "failed"))


def test_a_link_that_stood_still_is_asked_again_for_what_is_still_wanted(bridge, line, hasty_link):
    link, name, desk = hasty_link, "asked-again", bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    link.do("add", name, ["targets"])
    say_where_it_stands(desk, link, name, lambda: (desk.robots.get(name) or {}).get("x") is not None)
    stand_still(desk, link, line, name, abort=False)
    wait_until(lambda: not link.client.is_connected)
    assert link.adapter.commands == []
    line.mend(reset=True)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    assert [command.robot for command in link.adapter.commands] == [name]


def test_an_abort_that_lay_on_the_connection_of_a_link_that_stood_still_is_done(bridge, line, hasty_link):
    link, name, desk = hasty_link, "stopped-asleep", bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    link.do("add", name, ["targets"])
    say_where_it_stands(desk, link, name, lambda: (desk.robots.get(name) or {}).get("x") is not None)
    with standing_still(link):
        desk.send(f"stop-{name}", name, "Abort")
        wait_until(lambda: b'"Abort"' in line.passed_back)
        line.cut()
    # Nothing comes through the line, which is cut: it was there already.
    wait_until(lambda: link.adapter.stops == [(name, False)])
    line.mend(reset=True)
    stop = f"stop-{name}"
    desk.until(lambda: "acknowledged" in [step["state"] for step in desk.commands[stop]["steps"]])


def begin(link, work):
    """Have the link's own loop do ``work``; return its future."""
    return asyncio.run_coroutine_threadsafe(work, link._loop)


def steps(desk, command):
    (report,) = [one for one in desk.ask("get_commands", {})["commands"] if one["command"] == command]
    return report["steps"]
