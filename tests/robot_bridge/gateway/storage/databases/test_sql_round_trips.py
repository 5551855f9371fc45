"""Robots with plain drivers that ask and are answered, as docs/benchmarks.md measures them."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict

import pytest
from sqlalchemy import func, select

from benchmarks.sql_robots import Plan, Seen
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.schema import rr, sa
from tests.robot_bridge.gateway.storage.databases.accounts import Accounts
from tests.support.bridge.bridge_programs import wait_until
from tools.plugin_files import ROOT


@pytest.fixture
def accounts(kind, request, url, tmp_path):
    if kind == "mariadb":
        pytest.importorskip("MySQLdb", reason="apt-get install python3-mysqldb")
    server = None if kind == "sqlite" else request.getfixturevalue(f"{kind}_server")
    accounts = Accounts(kind, server.admin_url(url) if server else url, tmp_path)
    yield accounts
    accounts.remove()


def asked(plan: Plan) -> Seen:
    """Let robots ask in a process of their own, as the benchmark does; return what they saw."""
    command = [sys.executable, "-m", "benchmarks.sql_robots"]
    done = subprocess.run(
        command,
        cwd=ROOT,
        input=json.dumps(asdict(plan)),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return Seen(**json.loads(done.stdout))


def left(connection) -> list[int]:
    return [connection.scalar(select(func.count()).select_from(table)) for table in (rr, sa)]


MEASURED = pytest.param(10.0, True, marks=pytest.mark.again("as fast as they can, in the same test"))


@pytest.mark.parametrize(("rate", "durable"), [(0.0, False), MEASURED])
def test_every_request_is_answered_once_and_nothing_stays(
    start_bridge, sample_site, url, accounts, rate, durable
):
    bridge = start_bridge(sample_site, url)
    robots = dict(accounts.add(bridge.database) for _ in range(2))
    seen = asked(Plan(robots, 1.0, rate, 0.004, durable))
    assert seen.failed == []
    assert len(seen.times) >= 10
    wait_until(lambda: run_once(url, left) == [0, 0])
    bridge.end()
