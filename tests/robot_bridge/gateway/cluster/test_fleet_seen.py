"""What whoever watches over one of several gateways sees: ``doctor``, ``/healthz`` and ``/metrics``."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
import urllib.request

import pytest

from robot_bridge.gateway.cluster.cluster import lease_database
from robot_bridge.gateway.cluster.membership import Membership
from robot_bridge.gateway.monitoring import gateway_version
from robot_bridge.gateway.storage.database import read_address
from robot_bridge.gateway.storage.repositories import gateways
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.command_line import run_command
from tests.support.databases.database_client import DatabaseClient


@pytest.fixture(scope="module")
def bridge(start_bridge, limited_site, fleet_url, nats, tmp_path_factory):
    options = ["--gateway-name", "north", "--state", tmp_path_factory.mktemp("state"), "--bus", nats.url]
    return start_bridge(limited_site(""), fleet_url, options)


@pytest.fixture
def enter(fleet_url):
    """Enter another gateway, with so many seconds left to live, and strike it off at the end."""
    entered = []

    def run(work, *arguments):
        async def once():
            lease = lease_database(read_address(fleet_url))
            await lease.open()
            try:
                return await lease.run(work, *arguments)
            finally:
                await lease.close()

        return asyncio.run(once())

    def enter(name, version, left):
        me = Membership(name, None).me._replace(version=version, host="far.example.org", process=4711)
        entered.append(me)
        assert run(gateways.join, me, left)

    yield enter
    for me in entered:
        run(gateways.leave, me)


@pytest.fixture
def check(bridge, sample_site, fleet_url, nats):
    """Run doctor beside the gateway: return its status, and its lines."""
    port = bridge.address.rpartition(":")[2]

    def run(*options):
        cluster = ("--gateway-name", "north", "--bus", nats.url)
        done = run_command(
            "doctor", "--site", sample_site, "--database", fleet_url, "--port", port, *cluster, *options
        )
        assert not done.stderr
        return done.returncode, [" ".join(line.split()) for line in done.stdout.splitlines()]

    return run


def page(bridge, path):
    with urllib.request.urlopen(bridge.address.replace("ws://", "http://") + path, timeout=30) as answer:
        return answer.read().decode()


def numbers(bridge):
    lines = page(bridge, "/metrics").splitlines()
    return dict(line.rsplit(" ", 1) for line in lines if not line.startswith("#"))


def health(bridge):
    return json.loads(page(bridge, "/healthz"))


@contextlib.contextmanager
def away(nats):
    """The NATS server is gone until the block ends."""
    nats.kill()
    try:
        yield
    finally:
        nats.start()


def test_doctor_takes_the_options_of_serve_and_finds_all_well(check, fleet_url):
    status, lines = check("--public-address", "ws://127.0.0.1:1")
    assert status == 0, lines
    (said,) = DatabaseClient(fleet_url).sql("select value from bridge where name = 'id'")
    assert f"ok bus NATS takes and hands over what is said on fleet.{said[0]}.>" in lines
    assert any(line.startswith("ok gateways north: process ") for line in lines)


def test_doctor_names_gateways_that_are_silent_or_of_another_version(check, enter):
    enter("newer", "99.0", 600.0)
    enter("silent", gateway_version(), -30.0)
    status, lines = check()
    assert status == 0, lines
    said = f"newer: process 4711 on far.example.org is version 99.0, and this is {gateway_version()}"
    assert any(line.startswith(f"warning gateways {said}") for line in lines)
    (silent,) = [line for line in lines if "silent" in line]
    assert silent.startswith(
        "warning gateways silent: process 4711 on far.example.org has not renewed its lease"
    )


def test_doctor_names_a_clock_that_is_off_the_database(check, monkeypatch):
    now = time.time
    monkeypatch.setattr("robot_bridge.cli.doctor.time.time", lambda: now() + 300.0)
    assert any("off the database's: let NTP set both" in line for line in check()[1])
    monkeypatch.undo()
    assert not any("off the database's" in line for line in check()[1])


def test_a_bus_that_is_away_is_seen_on_both_pages_and_by_doctor(bridge, check, nats):
    wait_until(lambda: health(bridge)["cluster"]["buses"] == {"nats": True, "postgresql": True})
    with away(nats):
        wait_until(lambda: not health(bridge)["cluster"]["buses"]["nats"])
        # It serves its robots all the same.
        assert health(bridge)["status"] == "ok"
        assert numbers(bridge)['robot_bridge_bus_connected{bus="nats"}'] == "0.0"
        status, lines = check()
        assert status == 1
        assert any(
            line.startswith("FAULT bus bus 127.0.0.1:") and "check that NATS runs" in line for line in lines
        )
        assert any("not connected to the bus nats: its log says why" in line for line in lines)
    wait_until(lambda: numbers(bridge)['robot_bridge_bus_connected{bus="nats"}'] == "1.0")


def test_other_gateways_are_told_by_name_and_counted(bridge, enter):
    found = numbers(bridge)
    assert found['robot_bridge_gateway_info{gateway="north"}'] == "1.0"
    assert (found["robot_bridge_lease_held"], found["robot_bridge_leads"]) == ("1.0", "1.0")
    assert abs(float(found["robot_bridge_clock_offset_seconds"])) < 10
    enter("far", "99.0", 600.0)
    # Those entered before are known until the next renewal.
    wait_until(lambda: list(health(bridge)["cluster"]["others"]) == ["far"])
    found = numbers(bridge)
    assert found['robot_bridge_other_gateways{state="alive"}'] == "1.0"
    assert found['robot_bridge_other_gateways{state="heard"}'] == "0.0"
    report = health(bridge)["cluster"]
    assert report["gateway"] == "north" and report["lease"]
    far = {"lease": True, "heard": False, "version": "99.0", "host": "far.example.org", "process": 4711}
    assert report["others"] == {"far": far}
