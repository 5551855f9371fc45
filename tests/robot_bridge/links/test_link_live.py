"""Many robots over one connection, with a real gateway and the adapters' own client."""

from __future__ import annotations

import asyncio
import itertools
import json
import math

import numpy as np
import pytest

from robot_bridge.core.messages.robots import SendPos, SetObject, SetPosEnd
from robot_bridge.links.base.linked_robots import frame_of
from robot_bridge.protocol import jsonrpc
from tests.support.bridge.adapter_on_the_line import LinkOnTheLine
from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.wire import RefusedError, Wire

DRIVES = ("targets", "paths")
NUMBERS = itertools.count(1)


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture
def desk(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    return desk


@pytest.fixture
def link(bridge, tmp_path):
    link = LinkOnTheLine(bridge, tmp_path)
    yield link
    link.end()


@pytest.fixture
def names():
    """Three names that no other test has."""
    number = next(NUMBERS)
    return [f"agv-{number}-{letter}" for letter in "abc"]


def place(link, desk, names, *, abilities=DRIVES):
    """Let robots stand side by side, from (20, 8) on, and wait until a desk sees them."""
    for name in names:
        link.do("add", name, abilities)
    # On a busy machine the link may connect later than it keeps a position.
    desk.until(lambda: desk.robots.keys() >= {*names}, 15.0)
    for n, name in enumerate(names):
        link.do("position", name, SendPos(20.0 + 5 * n, 8.0, 0.0, 0.0))
    desk.wait_for_robots(*names)


def drive(link, name, x, y):
    link.do("position", name, SendPos(x, y, 0.0, 0.0))
    link.do("stopped", name)


def test_robots_of_a_link_are_seen_sent_and_reach(bridge, link, desk, names):
    place(link, desk, names)
    assert [desk.robots[name]["x"] for name in names] == [20.0, 25.0, 30.0]
    assert {desk.robots[name]["link"] for name in names} == {"test"}
    desk.send(f"go-{names[1]}", names[1], "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step(f"go-{names[1]}", "acknowledged")
    (told,) = link.adapter.commands
    assert (told.robot, told.message, told.again) == (names[1], SetPosEnd(40.0, 8.0), False)
    drive(link, names[1], 40.05, 8.0)
    desk.wait_for_step(f"go-{names[1]}", "reached")


def test_a_refusal_and_its_reason_concern_one_robot(bridge, link, desk, names):
    from robot_bridge.links.base.errors import CommandRefusedError

    async def refuse(command):
        if command.robot == names[0]:
            raise CommandRefusedError("the bumper is pressed")

    link.adapter.during = refuse
    place(link, desk, names)
    for name in names[:2]:
        desk.send(f"go-{name}", name, "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step(f"go-{names[0]}", "failed")
    desk.wait_for_step(f"go-{names[1]}", "acknowledged")
    assert "the bumper is pressed" in str(desk.ask("get_commands", {"robot": names[0]}))


def test_an_abort_overtakes_a_command_that_its_robot_is_being_told(bridge, link, desk, names):
    async def hang(command):
        await asyncio.sleep(60)

    link.adapter.during = hang
    place(link, desk, names)
    desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
    wait_until(lambda: link.adapter.commands)
    desk.send(f"stop-{names[0]}", names[0], "Abort")
    desk.wait_for_step(f"stop-{names[0]}", "acknowledged")
    assert link.adapter.stops == [(names[0], False)]


def test_an_emergency_stop_is_one_frame_for_all_and_each_robot_answers(bridge, link, desk, names):
    place(link, desk, names)
    # A link that is connected and speaks for nobody yet is told, too: by the one frame and by nothing else.
    other, heard = Wire(f"{bridge.address}/link"), []
    other._hear = heard.append
    other.ask("hello", {"protocol": 1, "kind": "test"})
    desk.ask("emergency_stop", {"command": f"stop-of-{names[0]}"})
    try:
        other.until(lambda: any(frame["method"] == "Abort" for frame in heard))
        assert "robot" not in heard[-1]["params"] and heard[-1]["params"]["emergency"]
        other.connection.close()
        wait_until(lambda: {robot for robot, emergency in link.adapter.stops if emergency} >= set(names))
        desk.until(lambda: desk.emergency["in_force"] and not set(names) & set(desk.emergency["waiting"]))
        with pytest.raises(RefusedError, match="emergency stop is in force"):
            desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
        # A link that comes now is told before any robot of it has said Ready.
        newcomer, told = Wire(f"{bridge.address}/link"), []
        newcomer._hear = told.append
        newcomer.until(lambda: "Abort" in [frame["method"] for frame in told])
        assert "robot" not in told[-1]["params"] and told[-1]["params"]["emergency"]
        newcomer.connection.close()
        late = f"{names[0]}-late"
        link.do("add", late, DRIVES)
        wait_until(lambda: (late, True) in link.adapter.stops)
    finally:
        desk.ask("clear_emergency_stop", {})


def test_a_link_that_was_killed_comes_back_and_nothing_is_lost_or_done_twice(bridge, link, desk, names):
    place(link, desk, names)
    desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step(f"go-{names[0]}", "acknowledged")
    link.kill()
    desk.until(lambda: all(desk.robots[name]["state"] == "lost" for name in names), 10)
    desk.send(f"go-{names[1]}", names[1], "SetPosEnd", x=45.0, y=8.0)
    link.start()
    place(link, desk, names)
    desk.wait_for_step(f"go-{names[1]}", "acknowledged")
    assert [command.robot for command in link.adapter.commands] == names[:2]
    drive(link, names[0], 40.0, 8.0)
    drive(link, names[1], 45.0, 8.0)
    desk.wait_for_step(f"go-{names[0]}", "reached")
    desk.wait_for_step(f"go-{names[1]}", "reached")


def test_a_gateway_that_was_killed_finds_the_robots_again(bridge, link, desk, names):
    place(link, desk, names)
    desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step(f"go-{names[0]}", "acknowledged")
    bridge.kill_gateway()
    link.do("position", names[0], SendPos(39.0, 8.0, 0.0, 1.0))
    seen = asyncio.run_coroutine_threadsafe(
        _kept(link, names[0], SetObject(30.0, 9.0, "cone-1", source="1")), link._loop
    )
    bridge.start_gateway()
    assert seen.result(30).ok
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    drive(link, names[0], 40.0, 8.0)
    desk.wait_for_step(f"go-{names[0]}", "reached")
    assert len(link.adapter.commands) == 1


async def _kept(link, robot, request):
    return await link.client.ask(robot, request)


def test_a_robot_of_a_link_and_one_of_its_own_are_told_apart(bridge, link, desk, names):
    place(link, desk, names[:1])
    with bridge_robot(bridge, names[0]) as own:
        with pytest.raises(RefusedError) as refused:
            ready = own.ask("Ready", {"magic": 1})
            assert ready.get("ok") is False
            raise RefusedError({"message": ready["reason"], "code": 0})
        assert "another robot runs as" in str(refused.value)
    with bridge_robot(bridge, names[1]) as own:
        own.ask("Ready", {"magic": 1})
        link.do("add", names[1], DRIVES)
        wait_until(lambda: link.adapter.refusals)
        assert "another robot runs as" in link.adapter.refusals[0][1]
        desk.until(lambda: "another robot runs as" in str(link_of(desk, "test").get("text")), 20)
    desk.until(lambda: link_of(desk, "test").get("text") is None, 40)


def link_of(desk, name):
    return next((one for one in desk.links if one["link"] == name), {})


def test_of_two_links_with_one_robot_one_commands_it_and_operators_are_told(
    bridge, link, desk, names, tmp_path
):
    place(link, desk, names[:1])
    second = LinkOnTheLine(bridge, tmp_path, name="second")
    try:
        second.do("add", names[0], DRIVES)
        desk.until(
            lambda: f"{names[0]}: another robot runs as" in str(link_of(desk, "second").get("text")), 20
        )
        desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
        desk.wait_for_step(f"go-{names[0]}", "acknowledged")
        desk.send(f"stop-{names[0]}", names[0], "Abort")
        desk.wait_for_step(f"stop-{names[0]}", "acknowledged")
        assert (second.adapter.commands, second.adapter.stops) == ([], [])
        assert link.adapter.stops == [(names[0], False)]
        # An emergency stop goes to both: who drives a robot may not be who is let in.
        desk.ask("emergency_stop", {"command": f"all-{names[0]}"})
        wait_until(
            lambda: (names[0], True) in link.adapter.stops and (names[0], True) in second.adapter.stops
        )
        desk.ask("clear_emergency_stop", {})
    finally:
        second.end()


class bridge_robot:  # noqa: N801 - reads as a function
    def __init__(self, bridge, name):
        self._wire = bridge.robot(name)

    def __enter__(self):
        return self._wire

    def __exit__(self, *_):
        self._wire.connection.close()


def test_a_robot_that_is_only_seen_is_sent_nowhere_and_told_why(bridge, link, desk, names):
    place(link, desk, names[:1], abilities=())
    with pytest.raises(RefusedError, match="is only seen"):
        desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
    place(link, desk, names[1:2], abilities=("paths",))
    with pytest.raises(RefusedError, match="does not take SetPosEnd"):
        desk.send(f"go-{names[1]}", names[1], "SetPosEnd", x=40.0, y=8.0)


def test_what_one_robot_says_wrong_concerns_that_robot(bridge, link, desk, names):
    place(link, desk, names)
    link.do("position", names[0], SendPos(9e7, 8.0, 0.0, 0.0))
    link.do("position", names[1], SendPos(26.0, 8.0, 0.0, 0.0))
    desk.until(lambda: desk.robots[names[1]]["x"] == 26.0, 5)
    desk.until(lambda: "km" in str(desk.robots[names[0]].get("status")), 5)
    assert desk.robots[names[0]]["x"] == 20.0


def test_what_is_wrong_with_a_row_of_a_batch_concerns_its_robot(bridge, desk, names):
    wire = Wire(f"{bridge.address}/link")
    wire._hear = lambda _frame: None
    wire.ask("hello", {"protocol": 1, "kind": "test"})
    for name in names:
        wire.ask("Ready", {"robot": name, "magic": 1})
    right, nowhere, far = names
    rows = [(name, SendPos(20.0, 8.0, 0.0, 0.0)) for name in names]
    wire.connection.send(frame_of(rows))
    desk.wait_for_robots(*names)
    # In every row of the table behind the head: x, y, theta and v.
    ghost = f"{right}-ghost"
    told = frame_of([(name, SendPos(21.0, 8.0, 0.0, 0.0)) for name in (*names, ghost)])
    table = np.frombuffer(told[-4 * 4 * 8 :], "<f8").reshape(4, 4).copy()
    table[0, 1], table[0, 2] = math.nan, 9e7
    wire.connection.send(told[: -4 * 4 * 8] + table.tobytes())
    refused = {}
    while len(refused) < 3:
        frame = json.loads(wire.connection.recv(10 * BUSY))
        if "error" in frame:
            refused[frame["error"]["data"]["robot"]] = frame["error"]["message"]
    assert "x is nan" in refused[nowhere] and "cannot be where it says" in refused[far]
    assert "has not said Ready" in refused[ghost]
    desk.until(lambda: desk.robots[right]["x"] == 21.0)
    assert [desk.robots[name]["x"] for name in (nowhere, far)] == [20.0, 20.0]
    wire.connection.close()


WRONG = [
    ("Ready", {"robot": "a b", "magic": 1}, "robot name 'a b' cannot be used"),
    ("Ready", {"magic": 1}, "give the name of the robot"),
    ("SendPos", {"robot": "ghost", "x": 1.0, "y": 1.0, "theta": 0.0, "v": 0.0}, "has not said Ready"),
    ("Ready", {"robot": "ok-1", "magic": 1, "abilities": ["fly"]}, "abilities"),
    ("positions", {"positions": 5}, "an object for each robot"),
    ("nonsense", {"robot": "ghost"}, "has not said Ready"),
    ("hello", {"protocol": 9, "kind": "test"}, "protocol 9 is not spoken here"),
    ("status", {"ok": 7}, "status"),
]


@pytest.mark.parametrize(("method", "params", "reason"), WRONG)
def test_what_is_wrong_is_refused_and_the_link_goes_on(bridge, method, params, reason):
    wire = Wire(f"{bridge.address}/link")
    wire._hear = lambda _frame: None
    assert wire.ask("hello", {"protocol": 1, "kind": "test"})["robots"] == ["*"]
    with pytest.raises(RefusedError, match=reason):
        wire.ask(method, params)
    assert wire.ask("hello", {"protocol": 1, "kind": "test"})["link"] == "link"
    wire.connection.close()


@pytest.mark.parametrize("frame", [b"", b"\xff\xff\xff\xff", b"\x02\0\0\0{}", bytes(64)])
def test_a_frame_of_positions_that_is_none_is_refused(bridge, frame):
    wire = Wire(f"{bridge.address}/link")
    wire._hear = lambda _frame: None
    wire.ask("hello", {"protocol": 1, "kind": "test"})
    wire.connection.send(frame)
    with pytest.raises(RefusedError):
        wire.answer(None)
    assert wire.ask("hello", {"protocol": 1, "kind": "test"})["link"] == "link"
    wire.connection.close()


FIRST = [
    '{"jsonrpc": "2.0", "id": null, "method": "Ready", "params": {"robot": "r", "magic": 1}}',
    '{"jsonrpc": "2.0", "id": null, "method": "status", "params": {"ok": true}}',
    '{"jsonrpc": "2.0", "method": "positions", "params": {"positions": [{"robot": "r", "x": 1.0}]}}',
    frame_of([("r", SendPos(20.0, 8.0, 0.0, 0.0))]),
]
THEN = [
    (jsonrpc.result("ghost/7", {"ok": True}), "ghost/7", "no robot of this link was asked"),
    (jsonrpc.result("7", {"ok": True}), "7", "no robot of this link was asked"),
    (jsonrpc.call("status", {"ok": False, "text": "x" * 70_000}), None, "status has 70067 bytes"),
]


def test_who_has_not_said_hello_and_what_nobody_asked_for_is_refused(bridge):
    """A link that a stranger wrote, and does the second thing first."""
    wire = Wire(f"{bridge.address}/link")
    wire._hear = lambda _frame: None
    for frame in FIRST:
        wire.connection.send(frame)
        with pytest.raises(RefusedError, match="has not said hello"):
            wire.answer(None)
    wire.ask("hello", {"protocol": 1, "kind": "test"})
    for frame, id, words in THEN:
        wire.connection.send(frame)
        with pytest.raises(RefusedError, match=words):
            wire.answer(id)
    assert wire.ask("hello", {"protocol": 1, "kind": "test"})["link"] == "link"
    wire.connection.close()


def acknowledge(wire, id):
    wire.connection.send(jsonrpc.result(id, {"ok": True}))


@pytest.mark.parametrize("flooded", ["positions", "replies"])
def test_a_robot_that_says_too_much_still_acknowledges_what_it_is_told(start_bridge, limited_site, flooded):
    bridge = start_bridge(limited_site("[limits]\nrobots = 1\nrobot_messages_per_s = 1\nrobot_burst = 20\n"))
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    wire, told = Wire(f"{bridge.address}/link"), []
    wire._hear = told.append
    wire.ask("hello", {"protocol": 1, "kind": "test"})
    wire.ask("Ready", {"robot": "agv", "magic": 1, "abilities": list(DRIVES)})
    here = {"robot": "agv", "x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0}
    wire.tell("positions", {"positions": [here]})
    desk.wait_for_robots("agv")
    desk.send("go-agv-1", "agv", "SetPosEnd", x=40.0, y=8.0)
    asked = wire.until(lambda: [call["id"] for call in told if call.get("method") == "SetPosEnd"])[0]
    if flooded == "positions":
        wire.tell("positions", {"positions": [here] * 100})
        wire.until(lambda: "robot 'agv' says too much" in str(told))
        wire.tell("nonsense", {"robot": "nobody"})
        wire.until(lambda: "'nobody' has not said Ready" in str(told))
        before = str(told).count("says too much")
        for _ in range(20):
            wire.connection.send(frame_of([("agv", SendPos(21.0, 8.0, 0.0, 0.0))]))
        wire.until(lambda: str(told).count("says too much") > before)
    else:
        for _ in range(100):
            acknowledge(wire, "agv/7000000")
        wire.until(lambda: "robot 'agv' answers too much" in str(told))
    with pytest.raises(RefusedError, match="speaks for 1 robots; there is room for no more"):
        wire.ask("Ready", {"robot": "another", "magic": 1})
    acknowledge(wire, asked)
    if flooded == "replies":
        again = wire.until(lambda: [call["id"] for call in told if call.get("method") == "SetPosEnd"][1:])
        assert again == [asked]
        acknowledge(wire, asked)
    desk.wait_for_step("go-agv-1", "acknowledged")


def test_a_full_disk_keeps_no_stop_from_a_robot(bridge, link, desk, names, caplog):
    place(link, desk, names[:1])
    memory = link.client.settings.memory_file
    new = memory.with_name(f".{memory.name}.new")
    link.kill()
    new.symlink_to("/dev/full")
    link.start()
    place(link, desk, names[:1])
    desk.send(f"go-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step(f"go-{names[0]}", "failed")
    assert "No space left on device" in str(desk.ask("get_commands", {"robot": names[0]}))
    assert link.adapter.commands == []
    desk.ask("emergency_stop", {"command": f"stop-of-{names[0]}"})
    try:
        wait_until(lambda: (names[0], True) in link.adapter.stops)
    finally:
        desk.ask("clear_emergency_stop", {})
    new.unlink()
    wait_until(lambda: "can be written again" in caplog.text)
    desk.send(f"on-{names[0]}", names[0], "SetPosEnd", x=40.0, y=8.0)
    desk.wait_for_step(f"on-{names[0]}", "acknowledged")


def watching(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    return desk


def serve_another_database(bridge, database):
    bridge.kill_gateway()
    bridge.database = database
    bridge.start_gateway()
    return watching(bridge)


def test_with_another_database_nothing_is_done_that_was_asked_before(
    start_bridge, impatient_site, new_database, tmp_path
):
    bridge = start_bridge(impatient_site)
    link = LinkOnTheLine(bridge, tmp_path)
    link.adapter.during = lambda command: asyncio.sleep(4)
    try:
        desk = watching(bridge)
        place(link, desk, ["agv"])
        desk.send("go-before", "agv", "SetPosEnd", x=40.0, y=8.0)
        wait_until(lambda: link.adapter.commands)
        desk = serve_another_database(bridge, new_database("sqlite"))
        # It has the id that the one before had in the other database.
        place(link, desk, ["agv"])
        desk.send("go-by-now", "agv", "SetPosEnd", x=30.0, y=8.0)
        desk.wait_for_step("go-by-now", "acknowledged")
        assert [command.message.x for command in link.adapter.commands] == [40.0, 30.0]
        assert {command.id for command in link.adapter.commands} == {link.adapter.commands[0].id}
        # Nobody at the gateway of now could have seen what it drives to.
        assert link.adapter.stops == [("agv", False)]
    finally:
        link.end()
