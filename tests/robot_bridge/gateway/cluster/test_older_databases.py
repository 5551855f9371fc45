"""Gateways on PostgreSQL alone, whose database is put back to an older state, and on a copy of another's."""

from __future__ import annotations

import contextlib
import itertools
import json
from urllib.request import urlopen

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.gateway_pair import GatewayPair, announced_gateways, clear, desk_at, stop
from tests.support.databases.database_client import DatabaseClient
from tests.support.databases.older_state import OlderState, abort_there
from tests.support.patience import BUSY

NUMBERS = itertools.count(1)


@pytest.fixture
def name():
    return f"robot-{next(NUMBERS)}"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("state")


@pytest.fixture(scope="module")
def pair(start_bridge, sample_site, new_database, folder):
    return GatewayPair(start_bridge, sample_site, new_database.another("postgresql"), folder)


HERE = (
    "(select system_identifier || '/' || oid from pg_control_system(), pg_database "
    "where datname = current_database())"
)


def end_gateway(bridge):
    """Have a gateway end in good order."""
    bridge.gateway.terminate()
    bridge.gateway.wait(10 * BUSY)


def is_on_bus(bridge):
    """Tell whether a gateway says that it is connected to NATS."""
    with urlopen(f"{bridge.address.replace('ws://', 'http://')}/healthz", timeout=10 * BUSY) as page:
        return json.loads(page.read())["cluster"]["buses"]["nats"]


def ids_of(bridge):
    return dict(bridge.sql("select name, value from bridge"))


def test_a_fleet_on_a_copy_of_the_database_is_another_fleet(
    start_bridge, sample_site, new_database, postgresql_server, nats, tmp_path, name
):
    """On the same NATS server; where the copy is not noticed, as of a whole server, its stops cross."""
    url = new_database("postgresql")
    options = ["--gateway-name", "a", "--bus", nats.url]
    first = start_bridge(sample_site, url, [*options, "--state", tmp_path])
    end_gateway(first)
    values = "('on-sql', 1, 'sql', 1.0, 1)"
    first.sql(f"insert into robots (name, magic, link, received_at, ended_in_order) values {values}")
    new_database.close()  # nobody may be connected to what is copied
    copies = [postgresql_server.copied_database(url.rpartition("/")[2]) for _ in range(2)]
    with contextlib.closing(DatabaseClient(copies[1])) as client:
        client.sql(f"update bridge set value = {HERE} where name = 'place'")
    first.start_gateway()
    robot, at_first = first.robot(name), desk_at(first)
    robot.plug_in(1)
    for copy, is_noticed in zip(copies, (True, False), strict=True):
        (state := tmp_path / f"copy-{is_noticed}").mkdir()
        second = start_bridge(sample_site, copy, [*options, "--state", state])
        ids = [ids_of(one) for one in (first, second)]
        assert (ids[0]["id"] != ids[1]["id"]) == (ids[0]["bus_key"] != ids[1]["bus_key"]) == is_noticed
        assert (ids[0]["fleet"] != ids[1]["fleet"]) == is_noticed
        # Robots on SQL do not connect, and would not know that the ids of messages begin again.
        starts = second.sql("select params from sa where robot = 'on-sql' and op = 'Start'")
        assert [json.loads(params)["database"] for (params,) in starts] == [ids[1]["id"]] * is_noticed
        said = (
            "is a copy of another one" if is_noticed else "gateway a serves a copy of this fleet's database"
        )
        # As soon as it is on the bus: a gateway of the same name is not known for a copy's yet.
        wait_until(lambda second=second: is_on_bus(second))
        assert stop(desk_at(second), name)["gateways"] == {"reached": 1, "of": 1, "missing": []}
        if not is_noticed:
            assert robot.wait_for("Abort", 2.0)["params"]["emergency"]
            clear(at_first)
        for one in [second] if is_noticed else [first, second]:
            wait_until(lambda one=one, said=said: said in one.output())
        # What was cleared here stays so, though it is in force there.
        assert not desk_at(first).emergency["in_force"]
        if is_noticed:
            # By its answer what was sent before has come.
            robot.ask("Stopped")
            assert not [call for call in robot.calls if call["method"] == "Abort"]
            assert "copy" not in first.output()
        # What it was told to be it is from then on.
        end_gateway(second)
        second.start_gateway()
        assert ids_of(second) == ids[1]
        second.end()
    first.end()


def test_two_gateways_need_no_further_server(pair, name):
    """On PostgreSQL's notifications alone."""
    robot, desk = pair.robot(pair.a, name), desk_at(pair.b)
    desk.wait_for_robots(name)
    desk.send(f"c-{name}", name, "SetPosEnd", x=22.0, y=8.0)
    robot.hear("SetPosEnd")
    stop(desk, name)
    assert robot.wait_for("Abort")["params"]["emergency"]
    desk.until(lambda: desk.emergency.get("gateways", {}).get("reached") == 2)
    gateways = [f"{pair.b.address}/robot", f"{pair.a.address}/robot"]
    wait_until(lambda: announced_gateways(pair.b, f"{name}-probe") == gateways)
    here = pair.robot(pair.b, f"{name}-b")
    # The desk of the gateway that takes its leave goes on at the other: its robots are free at once.
    end_gateway(pair.a)
    alone = {"gateway": "b", "gateways": gateways[:1]}
    here.until(lambda: alone in [call.get("params") for call in here.calls])
    # Who passes over what it does not know finds it in acknowledgements.
    pair.a.start_gateway()
    wait_until(lambda: here.ask("Stopped").get("gateways") == gateways)
    assert "gateways" not in here.ask("Stopped")
    wait_until(lambda: pair.b.sql("select gw from robot_owners where robot = ?", name) == [("b",)])
    clear(desk_at(pair.b), pair.a)


OLDER = "It counts as another one from now on"


def driven(pair, folder, name):
    """Have a robot at b drive that was sent on since the state of the database that is returned."""
    for bridge in (pair.a, pair.b):
        if bridge.gateway.poll() is not None:
            bridge.start_gateway()
    # It learns where a is as it connects.
    wait_until(lambda: len(pair.b.desk().hello["gateways"]) == 2)
    # Of ids that the database had before it was put back; those of today's are written with each message.
    for note in notes(folder, "ab"):
        note.unlink()
    pair.b.start_robot(name, (20.0, 20.0, 0.0), options=["--speed", "0.5"])
    desk = desk_at(pair.b)
    desk.wait_for_robots(name)
    older = OlderState(pair.b.database, folder)
    for y in (20.0, 21.0, 22.0):
        desk.send(f"{name}-{y:g}", name, "SetPosEnd", x=180.0, y=y)
        desk.wait_for_step(f"{name}-{y:g}", "acknowledged")
    ((newest,),) = pair.b.sql("select max(sa_id) from commands")
    for gateway in "ab":
        wait_until(lambda gateway=gateway: noted(folder, gateway) >= newest)
    return older


def notes(folder, gateways):
    return [note for gateway in gateways for note in (folder / gateway).glob("newest-message-*.json")]


def noted(folder, gateway):
    return max((json.loads(note.read_text())["newest_message"] for note in notes(folder, gateway)), default=0)


def test_an_abort_stops_a_robot_though_the_database_was_put_back_while_no_gateway_ran(pair, folder, name):
    older = driven(pair, folder, name)
    for bridge in (pair.a, pair.b):
        bridge.kill_gateway()
    older.put_back()
    pair.b.start_gateway()
    pair.a.start_gateway()
    wait_until(lambda: OLDER in pair.b.gateway_output())
    abort_there(desk_at(pair.b), name)
    for bridge in (pair.a, pair.b):
        # All of its log is written then.
        end_gateway(bridge)
    assert (pair.b.gateway_output() + pair.a.gateway_output()).count(OLDER) == 1


def test_gateways_end_whose_database_is_put_back_to_an_older_state_meanwhile(pair, folder, name):
    older = driven(pair, folder, name)
    older.put_back()
    for bridge in (pair.a, pair.b):
        assert bridge.gateway.wait(BUSY * 20) == 1
        assert "was put back to an older state while this gateway served it" in bridge.gateway_output()
    pair.b.start_gateway()
    wait_until(lambda: OLDER in pair.b.gateway_output())
    abort_there(desk_at(pair.b), name)


def test_a_gateway_that_serves_an_older_database_and_knows_nothing_of_that_ends(pair, folder, name):
    """Its robots can connect to the one that knows it."""
    older = driven(pair, folder, name)
    for bridge in (pair.a, pair.b):
        bridge.kill_gateway()
    for note in notes(folder, "b"):
        note.unlink()
    older.put_back()
    pair.b.start_gateway()
    pair.a.start_gateway()
    for text in (OLDER, "Served by b, too: see that each ends and starts again"):
        wait_until(lambda text=text: text in pair.a.gateway_output())
    assert pair.b.gateway.wait(BUSY * 20) == 1
    assert OLDER not in pair.b.gateway_output()
    abort_there(desk_at(pair.a), name)
