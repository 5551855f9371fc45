"""The whole bridge with real processes on each kind of database, whatever dies on the way."""

from __future__ import annotations

import time

import pytest

from tests.robot_bridge.gateway.storage.databases.accounts import Accounts
from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import START
from tests.support.wire import RefusedError

FULL_LIFE = ["queued", "delivered", "acknowledged", "reached"]
SERVERS = pytest.mark.parametrize("kind", ["postgresql", "mariadb"], indirect=True)


@pytest.fixture
def server(kind, request):
    return None if kind == "sqlite" else request.getfixturevalue(f"{kind}_server")


@pytest.fixture
def bridge(start_bridge, sample_site, url):
    bridge = start_bridge(sample_site, url)
    yield bridge
    bridge.end()


@pytest.fixture
def accounts(kind, server, url, tmp_path):
    accounts = Accounts(kind, server.admin_url(url) if server else url, tmp_path)
    yield accounts
    accounts.remove()


def steps(command):
    return [step["state"] for step in command["steps"]]


def watch(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    return desk


def test_a_robot_with_the_rights_of_its_account_takes_the_map_and_drives_to_its_target(bridge, accounts):
    name, address = accounts.add(bridge.database)
    bridge.start_robot(name, (20.0, 20.0, 0.0), sql=address)
    desk = watch(bridge)
    desk.wait_for_robots(name)
    desk.send("target-1", name, "SetPosEnd", x=26.0, y=22.0)
    command = desk.wait_for_step("target-1", "reached")
    assert steps(command) == FULL_LIFE
    assert command["deviation"] <= 0.2
    (stored,) = bridge.sql("select state, deviation from commands where id = 'target-1'")
    assert stored == ("reached", command["deviation"])
    wait_until(lambda: bridge.sql("select count(*) from sa") == [(0,)])
    assert desk.robots[name]["link"] == "sql"


@SERVERS
def test_a_gateway_killed_while_robots_drive_goes_on_where_it_stopped(bridge, accounts):
    name, address = accounts.add(bridge.database)
    bridge.start_robot(name, (20.0, 20.0, 0.0), sql=address)
    bridge.start_robot("ws", (20.0, 40.0, 0.0))
    desk = watch(bridge)
    desk.wait_for_robots(name, "ws")
    for robot, y in ((name, 20.0), ("ws", 40.0)):
        desk.send(f"target-{robot}", robot, "SetPosEnd", x=36.0, y=y)
        desk.wait_for_step(f"target-{robot}", "acknowledged")
    desk.until(lambda: desk.robots[name]["v"] > 1 and desk.robots["ws"]["v"] > 1)
    bridge.kill_gateway()
    bridge.start_gateway()
    desk = watch(bridge)
    desk.commands = {c["command"]: c for c in desk.ask("get_commands")["commands"]}
    for robot in (name, "ws"):
        assert steps(desk.wait_for_step(f"target-{robot}", "reached")) == FULL_LIFE


@SERVERS
def test_a_database_server_that_is_killed_and_comes_back_is_missed_and_found_again(
    bridge, accounts, server, kind
):
    name, address = accounts.add(bridge.database)
    bridge.start_robot(name, (20.0, 20.0, 0.0), sql=address)
    bridge.start_robot("ws", (20.0, 40.0, 0.0))
    desk = watch(bridge)
    desk.wait_for_robots(name, "ws")
    desk.send("target-1", name, "SetPosEnd", x=40.0, y=20.0)
    desk.wait_for_step("target-1", "acknowledged")

    server.kill()
    with pytest.raises(RefusedError, match=rf"database {kind}://fleet:\*\*\*@") as refused:
        desk.ask(
            "send", {"command": "target-2", "robot": "ws", "op": "SetPosEnd", "params": {"x": 30, "y": 40}}
        )
    assert server.owner_password not in str(refused.value)
    seen = len(desk.snapshots)
    # Positions over WebSocket do not need the database.
    desk.until(lambda: len(desk.snapshots) > seen + 5)
    server.start()

    assert steps(desk.wait_for_step("target-1", "reached")) == FULL_LIFE
    desk.send("target-2", "ws", "SetPosEnd", x=30.0, y=40.0)
    assert steps(desk.wait_for_step("target-2", "reached")) == FULL_LIFE
    desk.send("target-3", name, "SetPosEnd", x=34.0, y=20.0)
    assert steps(desk.wait_for_step("target-3", "reached")) == FULL_LIFE
    assert bridge.gateway.poll() is None
    for secret in (server.owner_password, f"Secret-{name}"):
        assert secret not in bridge.output()


@SERVERS
def test_an_acknowledgement_that_could_not_be_stored_is_asked_for_again(bridge, server):
    robot = bridge.robot("ws")
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 20.0, "y": 20.0, "theta": 0.0, "v": 0.0})
    desk = watch(bridge)
    desk.wait_for_robots("ws")
    desk.send("target-1", "ws", "SetPosEnd", x=40.0, y=20.0)
    first = robot.wait_for("SetPosEnd")
    desk.wait_for_step("target-1", "delivered")
    server.kill()
    robot.say(first["id"])
    wait_until(lambda: "it will be asked again" in bridge.output())
    server.start()
    again = robot.wait_for("SetPosEnd", 20)
    assert again == first
    robot.say(again["id"])
    assert steps(desk.wait_for_step("target-1", "acknowledged")) == FULL_LIFE[:3]


@pytest.mark.parametrize("kind", ["postgresql"], indirect=True)
def test_requests_and_answers_on_postgresql_do_not_wait_for_a_poll(bridge, accounts):
    import psycopg

    name, address = accounts.add(bridge.database)
    times = []
    with psycopg.connect(address, autocommit=True) as robot:
        robot.execute(f'listen "sa_{name}"')
        insert = "insert into rr (robot, op, params) values (%s, %s, %s)"
        robot.execute(insert, (name, "Ready", '{"magic": 1}'))
        wait_until(lambda: robot.execute("select count(*) from sa").fetchone() == (2,))
        for _ in range(20):
            robot.execute("delete from sa")
            time.sleep(0.05)
            list(robot.notifies(timeout=0))
            began = time.perf_counter()
            robot.execute(insert, (name, "Stopped", None))
            (notice,) = robot.notifies(timeout=START, stop_after=1)
            times.append(time.perf_counter() - began)
            assert notice.payload == ""
            assert robot.execute("select op from sa").fetchall() == [("OpAck",)]
    # A fallback poll comes once a second; this machine may be busy.
    assert sorted(times)[10] < 0.7, times
