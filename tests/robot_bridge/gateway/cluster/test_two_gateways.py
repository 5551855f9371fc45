"""Two gateways serve one fleet: real processes on PostgreSQL and NATS, a robot here and a desk there."""

from __future__ import annotations

import contextlib
import itertools
import json
import signal
import time
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.gateway_pair import GatewayPair, announced_gateways, clear, desk_at, stop
from tests.support.databases.database_client import DatabaseClient, tables_locked
from tests.support.errors import StageError
from tests.support.patience import BUSY
from tests.support.processes import free_port, freeze
from tests.support.wire import RefusedError

NUMBERS = itertools.count(1)


@pytest.fixture(scope="module")
def site(limited_site):
    return limited_site("")


@pytest.fixture(scope="module")
def started_pair(start_bridge, site, fleet_url, nats, tmp_path_factory):
    return GatewayPair(start_bridge, site, fleet_url, tmp_path_factory.mktemp("state"), "--bus", nats.url)


@pytest.fixture
def pair(started_pair):
    """Both run, also after a test that has failed while one of them had ended."""
    for bridge in (started_pair.a, started_pair.b):
        if bridge.gateway.poll() is not None:
            bridge.start_gateway()
    return started_pair


@pytest.fixture
def name():
    return f"robot-{next(NUMBERS)}"


def close_code(wire):
    """Take in what still comes, until the connection is closed; return the code."""
    try:
        wire.until(lambda: False)
    except ConnectionClosed as closed:
        return closed.rcvd.code


@contextlib.contextmanager
def standing_still(bridge):
    """Have a gateway do nothing until the block ends, however it ends.

    Not in the middle of a transaction: the server holds what that has locked for some seconds, and ends it.
    """
    stop_between_transactions(bridge)
    try:
        yield
    finally:
        bridge.gateway.send_signal(signal.SIGCONT)


OPEN = (
    "select pid, xact_start from pg_stat_activity where datname = current_database() "
    "and backend_type = 'client backend' and xact_start is not null and pid <> pg_backend_pid()"
)
"""The transactions of both gateways."""
LONGEST_TRANSACTION_S = 1.0
"""of a gateway that runs."""


def stop_between_transactions(bridge):
    with contextlib.closing(DatabaseClient(bridge.database)) as client:
        for _ in range(20):
            freeze(bridge.gateway.pid)
            wait_until(lambda: not is_unread(client.url.port))
            left, until = set(client.sql(OPEN)), time.monotonic() + LONGEST_TRANSACTION_S
            # What begins later is the other gateway's.
            while left and time.monotonic() < until:
                left.intersection_update(client.sql(OPEN))
            if not left:
                return
            bridge.gateway.send_signal(signal.SIGCONT)
            time.sleep(0.1)
    raise AssertionError("the gateway is in the middle of a transaction all the time")


def is_unread(port):
    """Whether a program that serves a port has not read all that was sent to it."""
    sockets = map(str.split, Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()[1:])
    here = [queues for _, local, _, _, queues, *_ in sockets if local.endswith(f":{port:04X}")]
    return any(int(queues.partition(":")[2], 16) for queues in here)


def end_lease(pair):
    """Let the lease of gateway a, which was killed, run out: robots have to be taken over in time to answer.

    An operator is answered after 12 s, whatever else the computer has to do.
    """
    pair.b.sql("update gateways set lease_until = extract(epoch from clock_timestamp()) where gw = 'a'")


def test_a_robot_at_one_is_seen_commanded_and_stopped_at_the_other(pair, name):
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    assert desk.robots[name]["link"] == "gateway a"
    assert (desk.robots[name]["x"], desk.robots[name]["y"]) == (20.0, 8.0)
    # A target, and every step of it.
    report = desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    assert report["state"] == "queued"
    target = robot.hear("SetPosEnd")
    assert (target["x"], target["y"]) == (22.0, 8.0)
    desk.wait_for_step(f"c-{name}", "acknowledged")
    robot.tell("SendPos", {"x": 22.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    desk.wait_for_step(f"c-{name}", "reached")
    # What the other gateway refuses is refused here in the same words.
    with pytest.raises(RefusedError, match=r"outside|off the site|bounds"):
        desk.send(f"far-{name}", name, "SetPosEnd", x=9e5, y=0.0)
    # An Abort.
    desk.send(f"d-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    robot.hear("SetPosEnd")
    desk.ask("abort", {"command": f"abort-{name}", "robot": name})
    assert not robot.hear("Abort")["emergency"]
    # An emergency stop, with the answer of the other gateway.
    report = stop(desk, name)
    assert report["in_force"]
    assert robot.wait_for("Abort")["params"]["emergency"]
    desk.until(lambda: desk.emergency.get("gateways", {}).get("reached") == 2)
    assert desk.emergency["gateways"] == {"reached": 2, "of": 2, "missing": []}
    desk.until(lambda: desk.emergency["stored"])
    with pytest.raises(RefusedError, match="an emergency stop is in force"):
        desk.send(f"e-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    # Cleared at the one it is cleared at the other.
    clear(desk, pair.a)


def test_accounts_that_are_suspended_are_named_at_both(pair, name):
    desks = [desk_at(pair.a), desk_at(pair.b)]
    until = time.time() + 60.0
    suspended = json.dumps({name: [until, "blocks"]})
    pair.a.sql("insert into bridge (name, value) values ('suspended', ?)", suspended)
    for desk in desks:
        desk.until(lambda desk=desk: desk.suspended)
        assert desk.suspended == [{"robot": name, "reason": "blocks", "until": pytest.approx(until)}]
    over = json.dumps({name: [time.time(), "blocks"]})
    pair.a.sql("update bridge set value = ? where name = 'suspended'", over)
    # By the one that leads.
    for desk in desks:
        desk.until(lambda desk=desk: not desk.suspended)
    assert pair.a.sql("select count(*) from bridge where name = 'suspended'") == [(0,)]


def test_what_a_robot_declares_and_says_of_itself_is_seen_at_the_other_gateway(pair, name):
    robot, desk = pair.a.robot(name), desk_at(pair.b)
    robot.plug_in(1, asks_path=True, abilities=["targets", "map"])
    said = {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0, "battery": 0.824, "status": "brush is worn"}
    robot.tell("SendPos", said)
    desk.until(lambda: (desk.robots.get(name) or {}).get("battery") == 0.82)
    seen = desk.robots[name]
    assert (seen["status"], seen["paths"], seen["abilities"]) == ("brush is worn", "asks", "map targets")
    # It stays while newer positions come without, until it says something else.
    robot.tell("SendPos", {**said, "x": 20.5})
    desk.until(lambda: desk.robots[name]["x"] == 20.5)
    assert desk.robots[name]["battery"] == 0.82
    robot.tell("SendPos", {**said, "x": 21.0, "battery": 0.5, "status": None})
    desk.until(lambda: desk.robots[name]["battery"] == 0.5)
    assert desk.robots[name].get("status") is None
    # A place that cannot be is doubted there, too.
    robot.tell("SendPos", {**said, "x": 1e7})
    desk.until(lambda: "km" in (desk.robots[name].get("doubt") or ""))
    assert desk.robots[name]["status"] == desk.robots[name]["doubt"]
    # Until it is where it can be.
    robot.tell("SendPos", {**said, "x": 21.5})
    desk.until(lambda: desk.robots[name]["x"] == 21.5 and "doubt" not in desk.robots[name])


def test_the_newest_connection_counts(pair, name):
    """A robot that connects to the other gateway is commanded there, and the old connection is closed."""
    old = pair.robot(pair.a, name)
    desk = desk_at(pair.a)
    desk.wait_for_robots(name)
    desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    old.hear("SetPosEnd")
    new = pair.robot(pair.b, name)
    desk.until(lambda: desk.robots[name]["link"] == "gateway b")
    # What it was sent before goes on, and is known there.
    new.tell("SendPos", {"x": 22.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    desk.wait_for_step(f"c-{name}", "reached")
    assert close_code(old) == 1012
    desk.send(f"d-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    new.hear("SetPosEnd")


def test_a_second_robot_of_one_name_is_refused_at_the_other_gateway(pair, name):
    first, desk = pair.robot(pair.a, name, magic=1), desk_at(pair.b)
    desk.wait_for_robots(name)
    second = pair.b.robot(name)
    for _ in range(3):
        with pytest.raises(RefusedError, match=rf"at gateway a another robot runs as '{name}' \(magic 1"):
            second.ask("Ready", {"magic": 2})
    # The first one has kept its connection and is commanded on it.
    desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    first.hear("SetPosEnd")
    assert pair.b.sql("select gw, fence from robot_owners where robot = ?", name) == [("a", 1)]
    # One that was started again is let in: its old connection is gone.
    first.hang_up()
    pair.robot(pair.b, name, magic=2)
    desk.until(lambda: desk.robots[name]["link"] == "websocket")


def test_a_robot_that_moves_to_another_gateway_is_known_there(pair, name):
    """Its gateway stands still, and is not waited for."""
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    robot.plug_in(7, asks_path=True)
    desk.until(lambda: desk.robots.get(name, {}).get("paths") == "asks")
    with standing_still(pair.a):
        pair.robot(pair.b, name, magic=7)
    assert "does not say whether another robot" not in pair.b.output()


def test_a_gateway_that_dies_is_replaced(pair, name):
    """Its robot is commanded at the other: what was queued meanwhile is delivered once, by that one alone."""
    pair.robot(pair.a, name)
    desk = desk_at(pair.b)
    desk.wait_for_robots(name)
    pair.a.kill_gateway()
    # Nobody has it for as long as its lease lasts; the request waits for who takes it over.
    target = {"command": f"c-{name}", "robot": name, "op": "SetPosEnd", "params": {"x": 22.0, "y": 8.0}}
    id = desk.begin("send", target)
    wait_until(lambda: pair.b.sql("select 1 from relayed_requests where robot = ?", name))
    end_lease(pair)
    try:
        answer = desk.answer(id, 20.0)
    except RefusedError as refused:
        # A gateway that stood still for seconds takes no robots over before others could renew their leases.
        assert "has not answered within" in str(refused) and "was not done" in str(refused)
        answer = desk.ask("send", target, 20.0)
    assert answer["state"] == "queued"
    robot = pair.robot(pair.b, name)
    assert robot.hear("SetPosEnd")["x"] == 22.0
    desk.wait_for_step(f"c-{name}", "acknowledged")
    assert pair.b.sql("select gw from robot_owners where robot = ?", name) == [("b",)]
    pair.a.start_gateway()
    wait_until(lambda: "gateway a serves this fleet, too" in pair.b.output())
    # The one that is back takes nothing away.
    assert pair.b.sql("select gw from robot_owners where robot = ?", name) == [("b",)]


def test_robots_and_adapters_go_on_at_another_gateway_by_themselves(pair, name, tmp_path):
    """They were given the address of one, and that says when another one comes."""
    both = [bridge.address for bridge in (pair.a, pair.b)]
    pair.b.end()
    wait_until(lambda: announced_gateways(pair.a, f"{name}-probe") == [f"{both[0]}/robot"])
    phones = tmp_path / f"{name}.toml"
    tracker = f'[tracker]\nhttp = "127.0.0.1:{free_port()}"\n[tracker.names]\n845213 = "phone"'
    phones.write_text(f'[gateway]\nurl = "{both[0]}/link"\n{tracker}\n', encoding="utf-8")
    started = [pair.a.start_robot(name, (20.0, 8.0, 0.0)), pair.a.start_link("tracker", phones)]
    at_a = desk_at(pair.a)
    at_a.wait_for_robots(name)
    at_a.until(lambda: phones.stem in str(at_a.links))
    pair.b.start_gateway()
    at_a.until(lambda: len(at_a.gateways) == 2)
    desk = desk_at(pair.b)
    desk.wait_for_robots(name)
    assert desk.robots[name]["link"] == "gateway a"
    pair.a.kill_gateway()
    began = time.monotonic()
    desk.until(lambda: desk.robots[name]["link"] == "websocket" and desk.robots[name]["state"] == "fresh")
    assert time.monotonic() - began < 4 * BUSY
    desk.until(lambda: phones.stem in str(desk.links))
    # The one that was killed may be back soon, and comes behind those that live.
    assert announced_gateways(pair.b, f"{name}-probe") == [f"{one}/robot" for one in both[::-1]]
    for process in started:
        process.kill()
    # A stop is not said to have missed a gateway any longer than that may be there.
    stop(desk, name)
    desk.until(lambda: desk.emergency.get("gateways") == {"reached": 1, "of": 1, "missing": []})
    clear(desk)
    pair.a.start_gateway()


def test_desks_learn_of_all_gateways_and_of_their_changes(pair, name):
    urls = [f"{bridge.address}/desk" for bridge in (pair.a, pair.b)]
    wait_until(lambda: pair.a.desk().hello["gateways"] == urls)
    at_b = pair.b.desk()
    assert (at_b.hello["gateway"], at_b.hello["gateways"]) == ("b", urls[::-1])
    assert at_b.hello["database"] == pair.a.desk().hello["database"]
    # One that ends in good order is gone, and one that comes is there.
    pair.a.end()
    at_b.until(lambda: at_b.gateways == urls[1:])
    pair.a.start_gateway()
    at_b.until(lambda: at_b.gateways == urls[::-1])


def test_what_was_asked_at_one_gateway_is_known_at_the_other(pair, name):
    """A desk asks again there when its gateway dies before it has answered."""
    robot, other = pair.robot(pair.a, name), pair.robot(pair.b, f"{name}-b", at=(30.0, 8.0))
    desks = [desk_at(bridge) for bridge in (pair.a, pair.b)]
    for desk in desks:
        desk.wait_for_robots(name, f"{name}-b")
    for one, wire in ((name, robot), (f"{name}-b", other)):
        first, again = (desk.send(f"c-{one}", one, "SetPosEnd", x=22.0, y=8.0) for desk in desks)
        assert (first["command"], first["op"]) == (again["command"], again["op"])
        wire.hear("SetPosEnd")
    robots = {name, f"{name}-b"}
    aborts = [desk.ask("abort_all", {"command": f"all-{name}"})["commands"] for desk in desks]
    first, again = ({c["command"] for c in found if c["robot"] in robots} for found in aborts)
    assert first == again and len(first) == 2
    for desk in desks:
        stop(desk, name)
    clear(desks[1], pair.a)
    # Asked for again once it was cleared, it is another stop, and that one is known at both.
    again = [stop(desk, name) for desk in desks]
    assert again[0]["in_force"] and again[0]["stop"] == again[1]["stop"]
    clear(desks[1], pair.a)
    for wire in (robot, other):
        wire.wait_for("Abort")
        # Beside the one that it has heard.
        assert not [call for call in wire.calls if call["method"] == "SetPosEnd"]


def test_a_stop_goes_out_with_the_bus_dead(pair, nats, name):
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    nats.kill()
    try:
        stop(desk, name)
        assert robot.wait_for("Abort")["params"]["emergency"]
        desk.until(lambda: desk.emergency["stored"])
    finally:
        nats.start()
    clear(desk, pair.a)


def test_a_stop_goes_out_with_the_database_dead(pair, postgresql_server, name):
    robot, here, desk = pair.robot(pair.a, name), pair.robot(pair.b, f"{name}-b"), desk_at(pair.b)
    desk.wait_for_robots(name, f"{name}-b")
    wait_until(lambda: pair.a.sql("select 1 from robots where name = ?", name))
    postgresql_server.kill()
    try:
        report = stop(desk, name)
        assert report["in_force"] and not report["stored"]
        for one in (robot, here):
            assert one.wait_for("Abort")["params"]["emergency"]
        desk.until(lambda: desk.emergency.get("gateways", {}).get("reached") == 2)
    finally:
        postgresql_server.start()
    desk.until(lambda: desk.emergency["stored"], 30.0)
    clear(desk, pair.a)
    # One that could not renew its lease in time joins again, and lets go of robots before.
    alive = "select gw from gateways where lease_until > extract(epoch from clock_timestamp()) + 3"
    wait_until(lambda: {gw for (gw,) in pair.b.sql(alive)} == {"a", "b"})


def test_a_gateway_that_stood_still_commands_nobody(pair, name):
    """Its robot went to the other one. What it is asked as it wakes, before it knows, is done there."""
    old, at_a, desk = pair.robot(pair.a, name), desk_at(pair.a), desk_at(pair.b)
    desk.wait_for_robots(name)
    at_a.wait_for_robots(name)
    with standing_still(pair.a):
        robot = pair.robot(pair.b, name)
        desk.until(lambda: desk.robots[name]["link"] == "websocket")
        desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
        robot.hear("SetPosEnd")
        target = {"x": 24.0, "y": 8.0}
        id = at_a.begin("send", {"command": f"d-{name}", "robot": name, "op": "SetPosEnd", "params": target})
    assert at_a.answer(id)["state"] == "queued"
    assert robot.hear("SetPosEnd")["x"] == 24.0
    assert close_code(old) == 1012
    assert not [call for call in old.calls if call["method"] == "SetPosEnd"]
    wait_until(lambda: f"robot {name} has connected to gateway b" in pair.a.output())


def test_a_gateway_that_stands_still_is_named_and_stops_its_robots_when_it_wakes(pair, name):
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    with standing_still(pair.a):
        stop(desk, name)
        assert desk.emergency["gateways"] == {"reached": 1, "of": 2, "missing": ["a"]}
    assert robot.wait_for("Abort")["params"]["emergency"]
    desk.until(lambda: desk.emergency["gateways"]["reached"] == 2 and desk.emergency["stored"])
    clear(desk, pair.a)


def test_robots_of_a_gateway_that_stands_still_do_not_count_as_standing(pair, name):
    """What it said of them last is not what they do now: they may drive on."""
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    stop(desk, name)
    robot.say(robot.wait_for("Abort")["id"])
    robot.say(robot.wait_for("Abort")["id"])

    def keep_standing():
        robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
        return desk.emergency["standing"] == 1 and name not in desk.emergency["unheard"]

    desk.until(keep_standing)
    robots = desk.emergency["robots"]
    with standing_still(pair.a):
        desk.until(lambda: desk.emergency["gateways"]["missing"] == ["a"])
        assert (desk.emergency["standing"], desk.emergency["robots"]) == (0, robots)
    desk.until(keep_standing)
    clear(desk, pair.a)


def test_a_stop_ends_the_tasks_of_a_gateway_that_dies_over_it(pair, name):
    """The stop is stored and over before anybody has stored the Abort of its robot."""
    old, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    old.hear("SetPosEnd")
    desk.wait_for_step(f"c-{name}", "acknowledged")
    stop_between_transactions(pair.a)
    stop(desk, name)
    desk.until(lambda: desk.emergency["stored"])
    clear(desk)
    pair.a.kill_gateway()
    robot = pair.robot(pair.b, name)
    assert robot.hear("Abort")["emergency"]
    # Of one that was not seen for some seconds the task ends with its next position.
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    desk.wait_for_step(f"c-{name}", "aborted")
    # It takes on its next target.
    desk.send(f"d-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    assert robot.hear("SetPosEnd")["x"] == 24.0
    pair.a.start_gateway()


def abort_in_vain(pair, name):
    """Have gateway a, which is killed then, send its robot an Abort that cannot be stored."""
    robot, desk = pair.robot(pair.a, name), desk_at(pair.a)
    desk.wait_for_robots(name)
    desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    robot.wait_for("SetPosEnd")
    desk.wait_for_step(f"c-{name}", "delivered")
    with tables_locked(pair.b.database, "commands"):
        with pytest.raises(RefusedError, match=f"The Abort is not stored; it was sent to {name}"):
            desk.ask("abort", {"command": f"abort-{name}", "robot": name}, 30.0)
        robot.wait_for("Abort")
        pair.a.kill_gateway()
    robot.hang_up()


def check_aborted_first(pair, name):
    """Let the robot connect to gateway b: what it did ends before it is sent anything else."""
    robot, desk = pair.robot(pair.b, name), desk_at(pair.b)
    abort = robot.wait_for("Abort", 30.0)
    assert [call for call in robot.calls if call["method"] == "SetPosEnd"] == []
    robot.say(abort["id"])
    # Of one that was not seen for some seconds the task ends with its next position.
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    desk.wait_for_step(f"c-{name}", "aborted")
    assert desk.wait_for_step(f"abort-{name}", "acknowledged")["operator"] == "Ada"
    # It takes on its next target.
    desk.send(f"d-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    assert robot.hear("SetPosEnd")["x"] == 24.0


def test_an_abort_that_could_not_be_stored_outlives_its_gateway(pair, name):
    """The one to which its robot goes then stores it."""
    abort_in_vain(pair, name)
    check_aborted_first(pair, name)
    pair.a.start_gateway()
    file = next(pair.state("a").glob("aborts-*-a.json"))
    wait_until(lambda: not file.exists())


def test_an_abort_of_which_no_other_gateway_heard_is_in_the_file_of_its_own(pair, name):
    pair.b.end()
    abort_in_vain(pair, name)
    pair.b.start_gateway()
    pair.a.start_gateway()
    # By whichever of the two has the robot by then.
    stored = "select 1 from commands where id = ?"
    wait_until(lambda: pair.b.sql(stored, f"abort-{name}"))
    check_aborted_first(pair, name)


def test_a_pause_that_cannot_be_asked_of_a_robots_gateway_is_an_abort_over_the_bus(pair, name):
    """And one that is stored there, where what is locked keeps only the request from it."""
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    robot.hear("SetPosEnd")
    desk.wait_for_step(f"c-{name}", "acknowledged")
    with tables_locked(pair.b.database, "relayed_requests"):
        text = (
            f"The pause is not stored; an Abort was sent over the bus to the gateways of {name}; it is stored"
        )
        with pytest.raises(RefusedError, match=text):
            desk.ask("pause_robot", {"robot": name, "reason": "dog"}, 30.0)
        abort = robot.wait_for("Abort")
        assert str(abort["id"]).startswith("abort-")
        # Which came over each bus.
        while str(abort["id"]).startswith("abort-"):
            abort = robot.wait_for("Abort")
        robot.say(abort["id"])
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    desk.wait_for_step(f"c-{name}", "aborted")
    stored = [c for c in desk.commands.values() if (c["robot"], c["op"]) == (name, "Abort")]
    assert [(c["operator"], c["steps"][0]["reason"]) for c in stored] == [("Ada", "paused: dog")]


def test_robots_of_two_gateways_are_aborted_together(pair, name):
    there, here = pair.robot(pair.a, name), pair.robot(pair.b, f"{name}-b", at=(30.0, 8.0))
    desk = desk_at(pair.b)
    desk.wait_for_robots(name, f"{name}-b")
    found = desk.ask("abort_all", {"command": f"all-{name}"})["commands"]
    assert {name, f"{name}-b"} <= {command["robot"] for command in found}
    for one in (there, here):
        one.wait_for("Abort")
    # As are they by two stops at the same time, which both operators see reach both gateways.
    desks = desk_at(pair.a), desk
    asked = [one.begin("emergency_stop", {"command": f"{k}-{name}"}) for k, one in enumerate(desks)]
    for one, id in zip(desks, asked, strict=True):
        one.answer(id)
        one.until(lambda one=one: one.emergency["gateways"]["reached"] == 2 and one.emergency["stored"])
    clear(desks[0], pair.b)
    assert pair.a.sql("select 1 from emergency_stops where cleared_at is null") == []


def targets(*robots):
    return {"positions": [{"robot": robot, "x": 22.0 + n, "y": 8.0} for n, robot in enumerate(robots)]}


def test_targets_of_robots_of_two_gateways_are_sent_together(pair, name):
    there, here = pair.robot(pair.a, name), pair.robot(pair.b, f"{name}-b", at=(30.0, 8.0))
    desk = desk_at(pair.b)
    desk.wait_for_robots(name, f"{name}-b")
    result = desk.ask("set_positions", targets(name, f"{name}-b"))
    assert [(one["robot"], one["params"]["x"]) for one in result["commands"]] == [
        (name, 22.0),
        (f"{name}-b", 23.0),
    ]
    assert "refused" not in result
    assert (there.hear("SetPosEnd")["x"], here.hear("SetPosEnd")["x"]) == (22.0, 23.0)
    # What is wrong with all of it is sent to nobody.
    with pytest.raises(RefusedError, match=r"nobody.*is not known"):
        desk.ask("set_positions", targets(name, f"{name}-b", "nobody"))
    with pytest.raises(RefusedError, match="named more than once"):
        desk.ask("set_positions", targets(name, f"{name}-b", name))
    # What one gateway refuses is refused of its robots, by name.
    there.tell("Stopped")
    wrong = targets(f"{name}-b", name)
    wrong["positions"][1]["x"] = 9e5
    result = desk.ask("set_positions", wrong)
    assert [one["robot"] for one in result["commands"]] == [f"{name}-b"]
    ((robot, reason),) = [(one["robot"], one["reason"]) for one in result["refused"]]
    assert robot == name and "site" in reason


@contextlib.contextmanager
def storing_no_command_of(robot, bridge):
    """Within, whoever stores a command of the robot is kept waiting; other robots' are stored.

    The context is a function: whether somebody waits.
    """
    with contextlib.closing(DatabaseClient(bridge.database)) as client:
        client.sql(
            "create function hold_back() returns trigger language plpgsql set lock_timeout = 0 as "
            "'begin perform pg_advisory_xact_lock(42); return new; end'"
        )
        client.sql(
            "create trigger hold_back before insert on commands for each row "
            f"when (new.robot = '{robot}') execute function hold_back()"
        )
        client.sql("select pg_advisory_lock(42)")
        try:
            yield lambda: client.sql("select 1 from pg_locks where locktype = 'advisory' and not granted")
        finally:
            client.sql("select pg_advisory_unlock(42)")
            client.sql("drop trigger hold_back on commands")
            client.sql("drop function hold_back")


def test_targets_are_not_sent_again_when_a_gateway_dies_over_them(pair, name):
    """The one that takes its robots over sends none that the other one may have sent."""
    pair.robot(pair.a, name)
    here, desk = pair.robot(pair.b, f"{name}-b", at=(30.0, 8.0)), desk_at(pair.b)
    desk.wait_for_robots(name, f"{name}-b")
    with storing_no_command_of(name, pair.b) as waits:
        id = desk.begin("set_positions", targets(name, f"{name}-b"))
        wait_until(waits)
        pair.a.kill_gateway()
        end_lease(pair)
    result = desk.answer(id, 20.0)
    assert here.hear("SetPosEnd")["x"] == 23.0
    ((robot, reason),) = [(one["robot"], one["reason"]) for one in result["refused"]]
    assert robot == name and "ended while it did this" in reason
    sent = pair.b.sql("select robot from commands where robot in (?, ?)", name, f"{name}-b")
    assert sent == [(f"{name}-b",)]
    pair.a.start_gateway()


def test_a_second_gateway_of_one_name_is_refused(pair, start_bridge, site, fleet_url, nats):
    with pytest.raises(StageError, match="another gateway named 'a' serves this fleet: process"):
        start_bridge(site, fleet_url, ["--gateway-name", "a", "--bus", nats.url])


def test_a_gateway_that_wants_the_database_alone_is_refused(pair, start_bridge, site, fleet_url):
    with pytest.raises(StageError, match=r"gateways a, b serve it together.*--gateway-name NAME"):
        start_bridge(site, fleet_url)


@pytest.mark.parametrize(
    ("options", "database", "why"),
    [
        (["--gateway-name", "a"], "sqlite", "on PostgreSQL only"),
        (["--gateway-name", "a b"], "postgresql", "gateway name 'a b' cannot be"),
        (["--gateway-name", "c", "--bus", "kafka://x"], "postgresql", "bus 'kafka://x' is none of these"),
        (["--bus", "none"], "sqlite", "--bus is for gateways with names"),
        (["--public-address", "ws://a:1"], "sqlite", "--public-address is for gateways with names"),
        (
            ["--gateway-name", "c", "--public-address", "a.example.org:8765"],
            "postgresql",
            "public address 'a.example.org:8765' cannot be sent to robots",
        ),
    ],
)
def test_what_cannot_be_is_named(start_bridge, site, fleet_url, new_database, options, database, why):
    url = fleet_url if database == "postgresql" else new_database("sqlite")
    with pytest.raises(StageError, match=why):
        start_bridge(site, url, options)
