"""``robot-bridge database`` as it is typed, and what ``serve`` says of a database that is not up to date."""

from __future__ import annotations

import os
import pwd
from pathlib import Path

import pytest
from sqlalchemy import make_url

from robot_bridge.gateway.storage.revisions import NEEDED
from tests.robot_bridge.gateway.storage.databases.old_database import make_old
from tests.support.bridge.command_line import run_command
from tests.support.databases.database_client import DatabaseClient


def robot_bridge(*words, **environment):
    """Run the program; return its status and what it says."""
    return run_command(*words, env=environment)


def refusal(done) -> str:
    assert done.returncode == 1, done
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("robot-bridge: ")
    return line


@pytest.fixture
def told(empty_url, tmp_path):
    """The address in the environment, and the password in a file."""
    url = make_url(empty_url)
    environment = {"ROBOT_BRIDGE_DATABASE": url.set(password=None).render_as_string()}
    if url.password is not None:
        file = tmp_path / "password"
        file.write_text(f"{url.password}\n", encoding="utf-8")
        file.chmod(0o600)
        environment["ROBOT_BRIDGE_DATABASE_PASSWORD_FILE"] = str(file)
    return environment


def test_the_tables_are_made_and_found_in_order(told, empty_url):
    done = robot_bridge("database", "create", **told)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith(f"made the tables, revision {NEEDED}\n")
    done = robot_bridge("database", "check", **told)
    assert done.returncode == 0, done
    assert f"needed: revision {NEEDED}\nthe tables are those that this version works with\n" in done.stdout
    done = robot_bridge("database", "upgrade", **told)
    assert done.stdout.endswith(f"revision {NEEDED}, nothing is to be done\n")
    assert "the tables are there already" in refusal(robot_bridge("database", "create", **told))
    secret = make_url(empty_url).password
    assert secret is None or secret not in f"{done}"


def test_tables_that_somebody_changed_are_named_with_a_status_of_1(url):
    client = DatabaseClient(url)
    client.sql("alter table commands add column colour varchar(9)")
    done = robot_bridge("database", "check", "--database", url)
    assert "differs: remove column: commands, colour" in done.stdout
    assert "somebody changed the tables: put them back, or restore a backup" in refusal(done)
    # The next test may have the same database.
    client.sql("alter table commands drop column colour")
    client.close()


def test_an_empty_database_is_named_with_a_status_of_1(told, kind):
    line = refusal(robot_bridge("database", "check", **told))
    assert "robot-bridge database create" in line
    if kind == "sqlite":
        assert not Path(make_url(told["ROBOT_BRIDGE_DATABASE"]).database).exists()


@pytest.mark.parametrize("kind", ["sqlite"], indirect=True)
def test_serve_refuses_tables_of_an_older_version_and_runs_once_they_are_upgraded(
    told, empty_url, sample_site, start_bridge
):
    make_old(Path(make_url(empty_url).database))
    line = refusal(robot_bridge("serve", "--site", sample_site, "--port", "0", **told))
    assert f"is at revision 0001, and this version of robot-bridge needs {NEEDED}" in line
    assert "back it up, then run: robot-bridge database upgrade" in line
    done = robot_bridge("database", "check", **told)
    assert f"revision 0001\nneeded: revision {NEEDED}" in done.stdout
    assert "robot-bridge database upgrade" in refusal(done)
    done = robot_bridge("database", "upgrade", **told)
    assert done.stdout.endswith(f"upgraded from revision 0001 to {NEEDED}\n"), done
    bridge = start_bridge(sample_site, empty_url)
    assert bridge.desk().ask("get_positions")["robots"][0]["robot"] == "r1"
    bridge.end()


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"], indirect=True)
def test_serve_names_the_command_that_makes_the_tables_on_a_server(told, sample_site):
    line = refusal(robot_bridge("serve", "--site", sample_site, "--port", "0", **told))
    assert "has no tables of the bridge; make the tables with: robot-bridge database create" in line


def log_of(url):
    """Return who, action, subject, done and detail of every entry of the audit log."""
    client = DatabaseClient(url)
    rows = client.sql("select who, action, subject, done, detail from audit order by id")
    client.close()
    return [(who, action, subject, bool(done), detail) for who, action, subject, done, detail in rows]


def test_whatever_is_done_to_the_database_is_in_its_audit_log(told, empty_url, tmp_path):
    me = pwd.getpwuid(os.getuid()).pw_name
    where = told["ROBOT_BRIDGE_DATABASE"]
    file = tmp_path / "fleet.backup"
    # A name out of the environment is anybody's.
    told = {**told, "LOGNAME": "somebody", "USER": "somebody"}
    for words in (["create"], ["upgrade"], ["backup", file]):
        done = robot_bridge("database", *words, **told)
        assert (done.returncode, done.stderr) == (0, "")
    refusal(robot_bridge("database", "create", **told))
    robot_bridge("operators", "add", "Ada", "--role", "viewer", **told)
    said = refusal(robot_bridge("database", "restore", file, **told))
    assert "is not empty: it has 1 row in operators" in said
    entries = log_of(empty_url)
    assert [entry[:4] for entry in entries] == [
        (me, "database create", where, True),
        (me, "database upgrade", where, True),
        (me, "database backup", where, True),
        (me, "database create", where, False),
        (me, "operators add", "Ada", True),
        (me, "database restore", where, False),
    ]
    assert entries[2][4] == str(file)
    assert "it has 1 row in operators" in entries[5][4]
    done = robot_bridge("database", "restore", file, "--replace", **told)
    assert (done.returncode, done.stderr) == (0, "")
    # The log is that of the backup now, and says where it comes from.
    assert [entry[1:] for entry in log_of(empty_url)][-1] == ("database restore", where, True, str(file))
    assert len(log_of(empty_url)) == 3


@pytest.mark.parametrize("kind", ["sqlite"], indirect=True)
def test_a_backup_of_an_older_version_is_restored_and_that_it_is_not_noted_is_said(told, tmp_path):
    make_old(tmp_path / "old.db")
    done = robot_bridge("database", "restore", tmp_path / "old.db", **told)
    assert done.returncode == 0, done.stderr
    (line,) = done.stderr.strip().splitlines()
    assert "this is done, and not in the audit log: its tables are at revision 000" in line


def test_no_upgrade_under_a_running_gateway(url, sample_site, start_bridge):
    bridge = start_bridge(sample_site, url)
    client = DatabaseClient(url)
    ((now,),) = client.sql("select version_num from alembic_version")
    client.sql("update alembic_version set version_num = '0002'")
    line = refusal(robot_bridge("database", "upgrade", "--database", url))
    assert f": a gateway runs on it: process {bridge.gateway.pid} on {os.uname().nodename}, since " in line
    assert "end it there, as a service with 'systemctl stop robot-bridge', then run 'robot-bridge" in line
    assert client.sql("select version_num from alembic_version") == [("0002",)]
    client.sql("update alembic_version set version_num = ?", now)
    client.close()
    bridge.end()
    done = robot_bridge("database", "upgrade", "--database", url)
    assert done.stdout.endswith("nothing is to be done\n"), done.stderr
