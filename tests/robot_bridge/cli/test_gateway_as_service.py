"""A real gateway process as whoever runs it sees it: its pages, log and settings, how it begins and ends."""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from dataclasses import replace
from pathlib import Path

import pytest
from prometheus_client.parser import text_string_to_metric_families

from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.sites.site import read_site, write_site
from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY


@pytest.fixture
def bridge(start_bridge, site):
    bridge = start_bridge(site)
    yield bridge
    bridge.end()


def page(bridge, path):
    """Return status and text of a page of the gateway."""
    address = bridge.address.replace("ws://", "http://")
    try:
        with urllib.request.urlopen(f"{address}{path}", timeout=60) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


def health(bridge):
    status, text = page(bridge, "/healthz")
    return status, json.loads(text)


def numbers(bridge):
    status, text = page(bridge, "/metrics")
    assert status == 200
    families = text_string_to_metric_families(text)
    return {(s.name, *s.labels.values()): s.value for family in families for s in family.samples}


def change(folder, old, new):
    file = folder / "site.toml"
    text = file.read_text(encoding="utf-8")
    assert old in text
    partial = folder / "partial"
    partial.write_text(text.replace(old, new), encoding="utf-8")
    partial.replace(file)


def publish(folder, **changes):
    """Publish the site once more, without its keepouts."""
    site = read_site(folder)
    settings = replace(site.settings, version=site.version + 1, **changes)
    write_site(folder, settings, site.outlines, site.centrelines, site.surfaces, site.keepouts[:0])


# --- pages --------------------------------------------------------------------------------------------------


def test_a_gateway_that_is_well_says_so(bridge):
    wait_until(lambda: health(bridge)[1]["save"]["age_s"] is not None)
    status, found = health(bridge)
    assert (status, found["status"], found["site"]) == (200, "ok", {"id": "sample", "version": 1})
    assert found["database"]["ok"] and found["database"]["latency_s"] < 2
    assert found["save"]["age_s"] < 10 and found["sql_link"]["age_s"] < 10
    assert found["routes"] == {"engine": "SciPy", "ok": True, "starts": 0}
    # It has made what finds ways: RoutingKit may end its process, and is loaded in another one.
    assert "scipy" in (loaded := Path(f"/proc/{bridge.gateway.pid}/maps").read_text())
    assert "routingkit" not in loaded


def test_a_gateway_whose_database_is_locked_says_so_and_recovers(bridge):
    import sqlite3

    lock = sqlite3.connect(bridge.file, isolation_level=None)
    lock.execute("begin immediate")
    status, found = health(bridge)
    assert (status, found["status"], found["database"]["ok"]) == (503, "failing", False)
    assert numbers(bridge)["robot_bridge_database_up",] == 0
    lock.execute("rollback")
    lock.close()
    wait_until(lambda: health(bridge)[0] == 200, 20)
    assert bridge.gateway.poll() is None


def test_what_happens_is_counted(bridge):
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    robot.ask("Alive")
    desk.send("target-1", "r1", "SetPosEnd", x=30.0, y=8.0)
    robot.say(robot.wait_for("SetPosEnd")["id"])
    desk.wait_for_step("target-1", "acknowledged")
    found = numbers(bridge)
    assert found["robot_bridge_requests_total", "websocket", "SendPos"] == 1
    assert found["robot_bridge_requests_total", "websocket", "Ready"] == 1
    assert found["robot_bridge_robots", "fresh"] == 1
    assert found["robot_bridge_robot_pose_age_seconds", "r1"] < 10
    assert found["robot_bridge_open_commands", "acknowledged"] == 1
    assert found["robot_bridge_command_steps_total", "queued"] == 1
    assert found["robot_bridge_desk_requests_total", "send"] == 1
    assert found["robot_bridge_desk_sessions",] == 1
    assert found["robot_bridge_database_up",] == 1
    assert found["robot_bridge_database_transaction_seconds_count",] > 5
    (info,) = [name for name in found if name[0] == "robot_bridge_info"]
    assert {"sample", "1"} < set(info)


def test_other_pages_are_not_there(bridge):
    status, text = page(bridge, "/admin")
    assert status == 404 and "/admin is not served here" in text


# --- the site while the gateway runs ------------------------------------------------------------------------


def test_a_new_publication_is_taken_over_and_robots_and_desks_are_told(bridge, site):
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    told = []
    desk._hear = told.append
    publish(site)
    desk.until(lambda: any(frame["method"] == "site" for frame in told))
    (news,) = [frame["params"] for frame in told if frame["method"] == "site"]
    assert (news["id"], news["version"]) == ("sample", 2)
    from tests.support.robots.robot_wires import map_bytes

    sent = robot.wait_for("SetMap")
    assert decode(map_bytes(sent)).meta["version"] == "2"
    robot.say(sent["id"])
    assert health(bridge)[1]["site"]["version"] == 2


def news_of(frame):
    """Return what a frame tells of the site, nothing where it tells of something else."""
    return frame["params"] if frame["method"] == "site" else {}


def test_settings_are_taken_over_without_a_new_publication(bridge, site):
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    told = []
    desk._hear = told.append
    change(site, "lost_after_s = 10.0", "lost_after_s = 900.0")
    for old, new in ((3.0, 0.2), (0.2, 600.0)):
        change(site, f"stale_after_s = {old}", f"stale_after_s = {new}")
        desk.until(lambda now=new: [f for f in told if news_of(f).get("stale_after") == now])
        # A robot that says nothing more is stale, and then it is not.
        wanted = "stale" if new < old else "fresh"
        wait_until(lambda now=wanted: desk.ask("get_positions")["robots"][0]["state"] == now)
    robot.listen(0.3)
    assert [call["method"] for call in robot.calls if call["method"] != "Start"] == []


def test_a_publication_that_is_wrong_is_not_taken_over(bridge, site):
    change(site, "stale_after_s = 3.0", "stale_after_s = -3.0")
    wait_until(lambda: "stale_after_s = -3.0 is not above 0" in bridge.output())
    wait_until(lambda: "version 1 is served on" in bridge.output())
    change(site, "stale_after_s = -3.0", "stale_after_s = 2.0")
    desk = bridge.desk()
    wait_until(lambda: desk.ask("hello", {"operator": "Ada"})["site"]["stale_after"] == 2.0)


def test_another_frame_takes_a_new_start(bridge, site):
    change(site, "rotation_deg = 0.0", "rotation_deg = 10.0")
    wait_until(lambda: "end the gateway and start it anew" in bridge.output())
    assert bridge.desk().site["rotation"] == 0.0


def test_sighup_reads_the_site_at_once(bridge, site):
    before = (site / "site.toml").stat()
    text = (site / "site.toml").read_text().replace("lost_after_s = 10.0", "lost_after_s = 12.0")
    with (site / "site.toml").open("r+") as file:
        file.write(text)
    os.utime(site / "site.toml", ns=(before.st_atime_ns, before.st_mtime_ns))
    bridge.gateway.send_signal(signal.SIGHUP)
    desk = bridge.desk()
    wait_until(lambda: desk.ask("hello", {"operator": "Ada"})["site"]["lost_after"] == 12.0)
    assert bridge.gateway.poll() is None


# --- how it begins ----------------------------------------------------------------------------------------


def test_gateway_and_robot_end_with_whoever_started_them_where_that_is_asked_for(
    site, tmp_path, forking_command
):
    def start(*words):
        command = [forking_command, *map(str, words), "--until-stdin-closes"]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    gateway = start("serve", "--site", site, "--port", 0, "--database", f"sqlite:///{tmp_path}/fleet.db")
    address = gateway.stdout.readline().removeprefix("listening on ").strip()
    robot = start("robot", "--url", f"{address}/robot", "--name", "r1", "--pose=20,8,0")
    assert select.select([robot.stdout], [], [], BUSY * 10)[0], "the robot printed nothing"
    assert robot.stdout.readline() == "r1 is connected; Ctrl+C ends it\n"
    for process in (robot, gateway):
        assert process.poll() is None
        # As the system does it when that one is killed.
        process.stdin.close()
        assert process.wait(BUSY * 10) == 0
        process.stdout.close()


def test_a_second_gateway_on_the_same_database_is_refused(bridge, site, forking_command):
    command = [forking_command, "serve", "--site", site, "--database", bridge.database, "--port", "0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=BUSY * 20, check=False)
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert (
        f"another gateway runs on it: process {bridge.gateway.pid} on {socket.gethostname()}" in done.stderr
    )
    assert health(bridge)[0] == 200


def test_site_toml_says_where_to_listen_and_what_to_use(site, tmp_path, start_program):
    with (site / "site.toml").open("a") as file:
        file.write(f'[gateway]\nhost = "::1"\nport = 0\ndatabase = "sqlite:///{tmp_path}/named.db"\n')
    said = start_program(["serve", "--site", site], r"listening on (ws://\S+)")
    assert said.startswith("ws://[::1]:")
    assert (tmp_path / "named.db").is_file()


def test_the_environment_says_it_before_site_toml(site, tmp_path, start_program):
    from robot_bridge.gateway.auth import certificates

    with (site / "site.toml").open("a") as file:
        file.write(f'[gateway]\nhost = "::1"\nport = 0\ndatabase = "sqlite:///{tmp_path}/named.db"\n')
    files = certificates.create(tmp_path / "tls", ["gateway"], ["127.0.0.2"])
    env = {
        "ROBOT_BRIDGE_HOST": "127.0.0.2",
        "ROBOT_BRIDGE_CERTIFICATE": str(files.certificate),
        "ROBOT_BRIDGE_KEY": str(files.key),
    }
    said = start_program(["serve", "--site", site], r"listening on (wss?://\S+)", env)
    assert said.startswith("wss://127.0.0.2:")


@pytest.fixture
def start_program(tmp_path):
    """Start the program and return what it says first."""
    from tests.support.patience import START
    from tests.support.processes import Processes

    with Processes(tmp_path / "logs") as processes:

        def start(options, pattern, env=None):
            processes.start_bridge("program", options, env=env)
            return processes.wait_for_line("program", pattern, START).group(1)

        start.processes = processes
        yield start


@pytest.mark.parametrize(("loop", "says"), [("uvloop", "event loop: uvloop"), ("asyncio", None)])
def test_the_log_is_json_on_request_and_the_event_loop_can_be_chosen(
    site, tmp_path, start_program, loop, says
):
    options = ["--log-format", "json", "--log-level", "info", "--loop", loop]
    where = ["--site", site, "--port", "0", "--database", f"sqlite:///{tmp_path}/fleet.db"]
    start_program(["serve", *where, *options], r"listening on (ws://\S+)")
    # All of its log is written when it has ended.
    start_program.processes.end("program")
    text = start_program.processes.log("program").read_text()
    entries = [json.loads(line) for line in text.splitlines() if not line.startswith("listening")]
    assert all({"time", "level", "logger", "message"} <= entry.keys() for entry in entries)
    messages = [entry["message"] for entry in entries]
    assert (says in messages) if says else not any("event loop" in message for message in messages)


def test_systemd_is_told_when_it_is_ready_and_when_it_ends(site, tmp_path, start_program):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(20)
        env = {"NOTIFY_SOCKET": str(tmp_path / "notify"), "WATCHDOG_USEC": "400000"}
        where = ["--site", site, "--port", "0", "--database", f"sqlite:///{tmp_path}/fleet.db"]
        start_program(["serve", *where], r"listening on (ws://\S+)", env)
        while not (said := manager.recv(1000)).startswith(b"READY=1"):
            assert said == b"WATCHDOG=1"
        assert said.startswith(b"READY=1\nSTATUS=listening on ws://127.0.0.1:")
        assert [manager.recv(1000) for _ in range(3)] == [b"WATCHDOG=1"] * 3
        start_program.processes.end("program")
        while manager.recv(1000) != b"STOPPING=1":
            pass


def test_a_log_that_is_full_ends_no_gateway(site, tmp_path, start_program):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(60)
        where = ["--site", str(site), "--port", "0", "--database", f"sqlite:///{tmp_path}/fleet.db"]
        full = ["sh", "-c", 'exec "$@" > /dev/full', "sh", sys.executable, "-m", "robot_bridge", "serve"]
        env = {"NOTIFY_SOCKET": str(tmp_path / "notify")}
        gateway = start_program.processes.start("full", [*full, *where], env=env)
        assert manager.recv(1000).startswith(b"READY=1")
        gateway.send_signal(signal.SIGTERM)
        assert gateway.wait(60) == 0
    said = start_program.processes.log("full").read_text()
    assert "standard output cannot be written: No space left on device" in said
    assert "Traceback" not in said and "Exception" not in said


# --- how it ends ------------------------------------------------------------------------------------------


def stuck(bridge, path):
    """A client that says hello on WebSocket and never reads again."""
    link = socket.create_connection(("127.0.0.1", bridge.port))
    link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    key = "dGhlIHNhbXBsZSBub25jZQ=="
    link.sendall(
        f"GET {path} HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    assert link.recv(12) == b"HTTP/1.1 101"
    return link


def since_saved(bridge):
    """Seconds since what is known of robots was last stored; None before the first time."""
    return health(bridge)[1]["save"]["age_s"]


def told_places(desk):
    return sum(robot.get("x") is not None for robot in desk.ask("get_positions")["robots"])


def test_it_ends_within_five_seconds_and_tells_a_hundred_clients_some_of_them_stuck(bridge):
    from websockets.exceptions import ConnectionClosed

    robots = [bridge.robot(f"r{n}") for n in range(40)]
    desks = [bridge.desk(f"Ada {n}") for n in range(8)]
    dead = [stuck(bridge, "/robot" if n % 2 else "/desk") for n in range(52)]
    for robot in robots:
        robot.tell("Ready", {"magic": 1})
    for desk in desks:
        desk.ask("subscribe", {"rate": 20})
    for number, robot in enumerate(robots):
        robot.tell("SendPos", {"x": 1.0 * number, "y": 8.0, "theta": 0.0, "v": 0.0})
    wait_until(lambda: told_places(desks[0]) == 40, 20)
    began = time.monotonic()
    bridge.gateway.send_signal(signal.SIGTERM)
    assert bridge.gateway.wait(30) == 0
    took = time.monotonic() - began
    assert took < 10, took  # 5 and what a busy computer adds
    print(f"ended within {took:.2f} s with {len(robots) + len(desks) + len(dead)} clients")
    stopping = 0
    for wire in [*robots, *desks]:
        with pytest.raises(ConnectionClosed):
            while True:
                stopping += '"stopping"' in str(wire.connection.recv(1))
        assert (wire.connection.close_code, wire.connection.close_reason) == (
            1012,
            "the gateway ends; connect again after a while",
        )
    assert stopping == len(desks)
    assert bridge.sql("select count(*) from trajectories") == [(40,)]
    for link in dead:
        link.close()
    bridge.start_gateway()
    wait_until(lambda: health(bridge)[0] == 200)
    known = bridge.desk().ask("get_positions")["robots"]
    assert {robot["robot"]: robot["x"] for robot in known} == {f"r{n}": 1.0 * n for n in range(40)}


def test_a_database_that_does_not_answer_does_not_keep_it_from_ending(bridge):
    import sqlite3

    robot = bridge.robot("r1")
    robot.plug_in(1)
    wait_until(lambda: since_saved(bridge) is not None)
    lock = sqlite3.connect(bridge.file, isolation_level=None)
    lock.execute("begin immediate")
    robot.tell("SendPos", {"x": 1.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    wait_until(lambda: since_saved(bridge) > 1.5, what="a save that does not come to its end")
    began = time.monotonic()
    bridge.gateway.send_signal(signal.SIGTERM)
    assert bridge.gateway.wait(30) in (0, 1)
    assert time.monotonic() - began < 10  # 5 and what a busy computer adds
    lock.close()


def test_positions_wait_while_the_database_is_away_and_are_stored_later(bridge):
    import sqlite3

    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.ask("Alive")  # behind the acknowledgement of the map, which has to be stored
    lock = sqlite3.connect(bridge.file, isolation_level=None)
    lock.execute("begin immediate")
    for n in range(12):
        robot.tell("SendPos", {"x": 1.0 + n, "y": 8.0, "theta": 0.0, "v": 1.0})
        # Of positions closer than min_interval_s (0.2 s) not each is stored.
        time.sleep(0.3)
    # Asked within the lock: as soon as it is gone, the gateway stores what waited.
    assert lock.execute("select count(*) from trajectories").fetchone() == (0,)
    lock.execute("rollback")
    lock.close()
    # On a busy machine some are read at one moment, and of those not each is stored.
    wait_until(lambda: bridge.sql("select count(*) from trajectories") >= [(6,)], 20)
    assert bridge.sql("select x from trajectories order by received_at") == [(1.0 + n,) for n in range(12)]
