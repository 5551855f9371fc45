"""A real gateway in trouble: it goes on by itself, or ends with a clear word; and it keeps secrets."""

from __future__ import annotations

import json
import secrets
import signal
import socket
import ssl
import time
import urllib.error
import urllib.request

import pytest
from prometheus_client.parser import text_string_to_metric_families

from robot_bridge.gateway.storage.backup import back_up
from robot_bridge.gateway.storage.database import read_address, run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.command_line import run_command
from tests.support.patience import BUSY, START

DAY = 86400.0


def numbers(bridge):
    address = bridge.address.replace("ws://", "http://")
    with urllib.request.urlopen(f"{address}/metrics", timeout=60) as answer:
        families = text_string_to_metric_families(answer.read().decode())
    return {(s.name, *s.labels.values()): s.value for family in families for s in family.samples}


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


def test_a_task_that_fails_is_logged_counted_and_goes_on_when_it_can(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.ask("Alive")
    bridge.sql("alter table trajectories rename to away")
    robot.tell("SendPos", {"x": 7.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    wait_until(lambda: numbers(bridge).get(("robot_bridge_task_failures_total", "save"), 0) >= 2)
    assert bridge.gateway.poll() is None
    bridge.sql("alter table away rename to trajectories")
    wait_until(lambda: bridge.sql("select x from trajectories") == [(7.0,)])
    said = [line for line in bridge.output().splitlines() if "save: database" in line]
    assert len(said) == 1 and "no such table: trajectories" in said[0]


def test_a_clock_that_goes_against_what_is_stored_is_told_when_the_gateway_starts(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 7.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    wait_until(lambda: bridge.sql("select x from trajectories") == [(7.0,)])
    bridge.kill_gateway()
    for shift, said in (
        (86400.0, "the clock is behind now, or was ahead then"),
        (-30 * 86400.0, "For a day"),
    ):
        assert said not in bridge.output()
        shift_times(bridge, shift)
        bridge.start_gateway()
        wait_until(lambda said=said: said in bridge.output())
        bridge.kill_gateway()
        shift_times(bridge, -shift)
    assert bridge.sql("select x from trajectories") == [(7.0,)]


def shift_times(bridge, seconds):
    """Move all times that a gateway looks at when it starts."""
    for table, column in (("trajectories", "received_at"), ("robots", "received_at"), ("audit", "at")):
        bridge.sql(f'update {table} set "{column}" = "{column}" + ?', seconds)


def test_accounts_that_cannot_be_read_are_told_of_once(bridge):
    failures = ("robot_bridge_task_failures_total", "accounts")
    bridge.sql("alter table tokens rename to away")
    wait_until(lambda: numbers(bridge).get(failures, 0) >= 3)
    bridge.sql("alter table away rename to tokens")
    said = [line for line in bridge.output().splitlines() if "accounts stay as they were last read" in line]
    assert len(said) == 1 and "no such table: tokens" in said[0]


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
def test_a_gateway_that_another_replaced_ends_with_a_clear_word(
    kind, request, new_database, start_bridge, sample_site
):
    server, url = request.getfixturevalue(f"{kind}_server"), new_database.another(kind)
    bridge = start_bridge(sample_site, url)
    name = url.rsplit("/", 1)[1]
    other = json.dumps({"run": "other", "host": "elsewhere", "process": 7, "since": 0})
    server.sql(f"update bridge set value = '{other}' where name = 'gateway'", name)
    if kind == "postgresql":
        server.sql(
            "select pg_terminate_backend(pid) from pg_locks where mode = 'ShareUpdateExclusiveLock' "
            "and relation = 'bridge'::regclass",
            name,
        )
    else:
        for id in server.sql(f"select id from information_schema.processlist where db = '{name}'").split():
            server.sql(f"kill connection {id}")
    assert bridge.gateway.wait(20) == 1
    last = bridge.output().strip().splitlines()[-1]
    assert last.startswith("robot-bridge: database ")
    assert "another gateway: process 7 on elsewhere" in last and "took it over" in last


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
def test_the_gateways_own_account_runs_it_and_backs_it_up_and_no_secret_is_logged(
    kind, request, new_database, start_bridge, sample_site, tmp_path
):
    server, url = request.getfixturevalue(f"{kind}_server"), new_database.another(kind)
    name, password = f"gw{secrets.token_hex(4)}", f"pass-{secrets.token_hex(12)}"
    run_once(read_address(server.admin_url(url)), lambda c: role_manager_on(c).add_gateway(name, password))
    own = server.url(url.rsplit("/", 1)[1], name, password)
    bridge = start_bridge(sample_site, own, ["--log-level", "debug", "--log-format", "json"])
    robot = bridge.robot("r1")
    robot.plug_in(1)
    robot.ask("Alive")
    assert back_up(read_address(own), tmp_path / "backup") > 100
    token = f"fleet_op_{secrets.token_urlsafe(32)}"
    request_ = urllib.request.Request(
        bridge.address.replace("ws://", "http://") + "/metrics", headers={"Authorization": f"Bearer {token}"}
    )
    urllib.request.urlopen(request_, timeout=60).read()
    server.kill()
    wait_until(lambda: "trying again" in bridge.output(), 20)
    server.start()
    wait_until(lambda: healthy(bridge), 30)
    bridge.gateway.send_signal(signal.SIGTERM)
    assert bridge.gateway.wait(START) == 0
    output = bridge.output()
    for secret in (password, token):
        assert secret not in output
    for line in output.splitlines():
        assert line.startswith("listening on ") or json.loads(line)["level"]


def healthy(bridge):
    try:
        urllib.request.urlopen(bridge.address.replace("ws://", "http://") + "/healthz", timeout=60).read()
    except (urllib.error.URLError, OSError):
        return False
    return True


def test_what_comes_over_http_and_is_no_request_does_no_harm(bridge):
    for text in (
        b"GARBAGE\r\n\r\n",
        b"GET /healthz HTTP/1.1\r\n" + b"X: y\r\n" * 5000,
        b"POST /metrics HTTP/1.1\r\n\r\n",
    ):
        with socket.create_connection(("127.0.0.1", bridge.port), timeout=5 * BUSY) as link:
            link.sendall(text)
            link.shutdown(socket.SHUT_WR)
            until = time.monotonic() + 5 * BUSY
            while link.recv(4096):
                assert time.monotonic() < until
    assert healthy(bridge)


@pytest.fixture
def own_address():
    """An address of this computer that is not loopback."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        try:
            link.connect(("192.0.2.1", 9))  # sends nothing
            address = link.getsockname()[0]
        except OSError:
            address = "127.0.0.1"
    if address.startswith("127."):
        pytest.skip("this computer has no address but loopback")
    return address


def test_numbers_are_for_those_who_have_a_token_and_tokens_are_not_logged(
    start_bridge, sample_site, tmp_path, own_address
):
    def run(*words):
        done = run_command(*words)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    database = f"sqlite:///{tmp_path}/fleet.db"
    run("tls", "create", tmp_path / "tls", "--name", "gateway", "--ip", own_address)
    token = run("operators", "add", "Ada", "--role", "viewer", "--database", database)
    files = {path.name: path for path in (tmp_path / "tls").iterdir()}
    options = ["--host", "0.0.0.0", "--log-level", "debug", "--log-format", "json"]
    options += ["--certificate", files["server.pem"], "--key", files["server-key.pem"]]
    bridge = start_bridge(sample_site, database, options)
    trust = ssl.create_default_context(cafile=files["ca.pem"])
    wrong = "fleet_op_" + secrets.token_urlsafe(32)

    def ask(path, token=None):
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        request = urllib.request.Request(f"https://{own_address}:{bridge.port}{path}", headers=headers)
        try:
            return urllib.request.urlopen(request, timeout=60, context=trust).status
        except urllib.error.HTTPError as error:
            return error.code

    assert ask("/healthz") == 200
    assert (ask("/metrics"), ask("/metrics", wrong), ask("/metrics", token)) == (401, 401, 200)
    bridge.gateway.send_signal(signal.SIGTERM)
    assert bridge.gateway.wait(START) == 0
    for secret in (token, wrong):
        assert secret not in bridge.output() and secret[-16:] not in bridge.output()
