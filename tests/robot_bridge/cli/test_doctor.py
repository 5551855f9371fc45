"""``robot-bridge doctor``: well where all is well, and a fault is named with what to do."""

from __future__ import annotations

import shutil
import socket
import threading
from types import SimpleNamespace

import pytest

from robot_bridge.cli import doctor
from robot_bridge.gateway.auth import certificates
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import read_address, run_once
from tests.support.bridge.command_line import run_command
from tests.support.processes import free_port


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture
def check(sample_site, tmp_path):
    """Run it, where no gateway listens: return its status, and level and text by subject."""

    def run(*options, site=sample_site, database=f"sqlite:///{tmp_path}/fleet.db", env=None):
        where = () if "--port" in options else ("--port", free_port())
        done = run_command("doctor", "--site", site, "--database", database, *where, *options, env=env)
        lines = [line.split(maxsplit=1) for line in done.stdout.splitlines()]
        assert not done.stderr
        return done.returncode, {rest[:12].strip(): (level, rest[13:]) for level, rest in lines}

    return run


def test_a_gateway_that_runs_is_well(bridge, check):
    port = bridge.address.rpartition(":")[2]
    status, found = check("--port", port, database=f"sqlite:///{bridge.file}")
    assert status == 0, found
    assert found["gateway"] == ("ok", f"127.0.0.1:{port}: version 0.1.0, site sample")
    assert {found[name][0] for name in ("site", "open files", "database", "certificate", "disk")} == {"ok"}


def test_what_is_not_there_yet_is_no_fault(check):
    status, found = check()
    assert status == 0
    assert found["database"][0] == "warning" and "the gateway makes it" in found["database"][1]
    assert found["gateway"][0] == "warning" and "start it with 'robot-bridge serve'" in found["gateway"][1]


def test_one_fault_keeps_no_other_check_from_its_turn(check, tmp_path):
    status, found = check(site=tmp_path / "away", database="postgresql://x@127.0.0.1:1/y")
    assert status == 1
    assert [name for name, (level, _) in found.items() if level == "FAULT"] == ["site", "database"]
    assert "is no folder" in found["site"][1] and "check that the server runs" in found["database"][1]
    assert "gateway" in found


@pytest.mark.parametrize(
    ("options", "subject", "why"),
    [
        (("--gateway-name", "a", "--bus", "kafka://x"), "bus", "bus 'kafka://x' is none of these"),
        (("--gateway-name", "a b"), "gateways", "gateway name 'a b' cannot be"),
    ],
)
def test_what_is_wrong_of_several_gateways_is_named_where_it_is(check, options, subject, why):
    status, found = check(*options, database="postgresql://x@127.0.0.1:1/y")
    assert status == 1 and found[subject][0] == "FAULT" and why in found[subject][1]
    assert [name for name, (level, _) in found.items() if level == "FAULT"] == ["database", subject]


def test_tables_of_another_revision_are_a_fault(check, tmp_path):
    database = f"sqlite:///{tmp_path}/old.db"
    run_once(read_address(database), revisions.create, revisions.FIRST)
    status, found = check(database=database)
    assert status == 1 and "robot-bridge database upgrade" in found["database"][1]


def test_beyond_this_computer_it_takes_tls_and_an_account(check, tmp_path):
    status, found = check("--host", "0.0.0.0")
    assert status == 1 and "robot-bridge tls create" in found["reach"][1]
    files = certificates.create(tmp_path / "tls", ["gateway.example.org"], [])
    secure = ("--host", "0.0.0.0", "--certificate", files.certificate, "--key", files.key)
    status, found = check(*secure)
    assert status == 1 and "robot-bridge operators add" in found["reach"][1]
    assert found["certificate"][0] == "ok" and "gateway.example.org" in found["certificate"][1]
    database = f"sqlite:///{tmp_path}/fleet.db"
    done = run_command("operators", "add", "Ada", "--role", "supervisor", "--database", database)
    assert done.returncode == 0, done.stderr
    assert check(*secure)[1]["reach"][0] == "ok"


def test_the_environment_says_how_the_gateway_is_reached_where_no_option_does(check, tmp_path):
    files = certificates.create(tmp_path / "tls", ["gateway.example.org"], [])
    env = {
        "ROBOT_BRIDGE_HOST": "0.0.0.0",
        "ROBOT_BRIDGE_CERTIFICATE": str(files.certificate),
        "ROBOT_BRIDGE_KEY": str(files.key),
    }
    status, found = check(env=env)
    assert status == 1 and "robot-bridge operators add" in found["reach"][1]
    assert found["certificate"][0] == "ok" and "gateway.example.org" in found["certificate"][1]
    status, found = check("--host", "127.0.0.1", env=env)
    assert status == 0 and found["reach"] == ("ok", "127.0.0.1: nobody beyond this computer")
    status, found = check(env={"ROBOT_BRIDGE_HOST": "0.0.0.0"})
    assert status == 1 and "robot-bridge tls create" in found["reach"][1]


@pytest.mark.parametrize("given", ["ROBOT_BRIDGE_CERTIFICATE", "ROBOT_BRIDGE_KEY"])
def test_a_certificate_and_its_key_come_together(sample_site, tmp_path, given):
    files = certificates.create(tmp_path / "tls", ["gateway"], [])
    file = files.key if given == "ROBOT_BRIDGE_KEY" else files.certificate
    done = run_command("doctor", "--site", sample_site, env={given: str(file)})
    assert done.returncode == 1 and "--certificate and --key" in done.stderr


@pytest.mark.parametrize(("days", "level"), [(29, "warning"), (40, "ok")])
def test_a_certificate_that_ends_soon_is_named(check, tmp_path, days, level):
    files = certificates.create(tmp_path / "tls", ["gateway"], [], days + 1)
    found = check("--certificate", files.certificate, "--key", files.key)[1]
    assert found["certificate"][0] == level
    assert ("robot-bridge tls renew" in found["certificate"][1]) == (level == "warning")


def test_a_link_whose_settings_are_wrong_is_a_fault(check, sample_site, tmp_path):
    site = tmp_path / "site"
    shutil.copytree(sample_site, site, ignore=shutil.ignore_patterns("*.py", "drawing", "__pycache__"))
    with (site / "site.toml").open("a") as file:
        file.write('\n[links]\ntracker = ["phones.toml"]\n')
    status, found = check(site=site)
    assert status == 1 and "phones.toml" in found["link"][1]


@pytest.mark.parametrize(
    ("free", "level", "status"), [(5e7, "FAULT", 1), (5e8, "warning", 0), (5e9, "ok", 0)]
)
def test_a_disk_that_is_nearly_full_is_named(check, monkeypatch, free, level, status):
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda _: SimpleNamespace(free=free))
    ended, found = check()
    assert (ended, found["disk"][0]) == (status, level)


def test_what_is_no_gateway_at_its_port_is_a_fault(check):
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer():
            connection, _ = server.accept()
            with connection:
                connection.recv(1000)
                connection.sendall(b"SSH-2.0-OpenSSH\r\n")

        other = threading.Thread(target=answer)
        other.start()
        status, found = check("--port", server.getsockname()[1])
        other.join()
    assert status == 1 and "does not answer as a gateway" in found["gateway"][1]


def test_what_fails_in_a_gateway_that_runs_is_named(start_bridge, sample_site, check):
    bridge = start_bridge(sample_site)
    bridge.sql("alter table rr rename to away")
    port = bridge.address.rpartition(":")[2]
    try:
        while (found := check("--port", port)[1])["gateway"][0] == "ok":
            pass
        assert found["gateway"][0] == "FAULT" and "journalctl -u robot-bridge" in found["gateway"][1]
    finally:
        bridge.end()
