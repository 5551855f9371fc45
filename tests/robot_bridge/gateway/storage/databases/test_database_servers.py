"""The database servers that the tests start: their own, empty, able to die and come back, gone afterwards."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.database_server import children_of
from tests.support.processes import is_running

ROOT = Path(__file__).resolve().parents[5]
BOTH = pytest.mark.parametrize("kind", ["postgresql", "mariadb"])

COUNT_TABLES = {
    "postgresql": "select count(*) from information_schema.tables where table_schema = 'public'",
    "mariadb": "select count(*) from information_schema.tables where table_schema = database()",
}
LEFT_ALONE = """
import sys
from tests.support.databases.mariadb import MariaDb
from tests.support.databases.postgresql import PostgreSql
server = {"mariadb": MariaDb, "postgresql": PostgreSql}[sys.argv[1]]().__enter__()
print(server.pid, server.folder, flush=True)
sys.stdin.read()
"""


@pytest.fixture
def server(kind, request):
    return request.getfixturevalue(f"{kind}_server")


def name_of(url: str) -> str:
    return url.rsplit("/", 1)[1]


@BOTH
def test_every_database_is_new_and_empty(kind, server):
    first, second = server.new_database(), server.new_database()
    assert first != second
    server.sql("create table t (i int)", name_of(first))
    assert server.sql(COUNT_TABLES[kind], name_of(first)) == "1"
    assert server.sql(COUNT_TABLES[kind], name_of(second)) == "0"


@BOTH
def test_a_killed_server_comes_back_on_its_port_with_what_was_committed(kind, server):
    port, name = server.port, name_of(server.new_database())
    server.sql("create table t (i int); insert into t values (7)", name)
    workers = children_of(server.pid)
    server.kill()
    assert [worker for worker in workers if is_running(worker)] == []
    server.start()
    assert server.port == port
    assert server.sql("select i from t", name) == "7"


@BOTH
def test_nothing_is_left_of_a_server_whose_program_was_killed(kind, server):
    program = subprocess.Popen(
        [sys.executable, "-c", LEFT_ALONE, kind],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    pid, folder = program.stdout.readline().split()
    assert Path(f"/proc/{pid}").exists()
    assert Path(folder).is_dir()
    program.send_signal(signal.SIGKILL)
    program.communicate()
    wait_until(lambda: not Path(f"/proc/{pid}").exists(), 5, "the server lives on")
    wait_until(lambda: not Path(folder).exists(), 10, "its folder is still there")
