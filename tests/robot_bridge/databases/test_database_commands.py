"""``robot-bridge database`` as it is typed, and what ``serve`` says of a database that is not up to date."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from database_client import DatabaseClient
from old_database import make_old
from sqlalchemy import make_url


def robot_bridge(*words, **environment):
    """Run the program; return its status and what it says."""
    command = [sys.executable, "-m", "robot_bridge", *map(str, words)]
    env = {**os.environ, **environment}
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60, env=env)


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
    assert done.stdout.endswith("made the tables, revision 0002\n")
    done = robot_bridge("database", "check", **told)
    assert done.returncode == 0, done
    assert "needed: revision 0002\nthe tables are those that this version works with\n" in done.stdout
    done = robot_bridge("database", "upgrade", **told)
    assert done.stdout.endswith("revision 0002, nothing is to be done\n")
    assert "the tables are there already" in refusal(robot_bridge("database", "create", **told))
    secret = make_url(empty_url).password
    assert secret is None or secret not in f"{done}"


def test_tables_that_somebody_changed_are_named_with_a_status_of_1(told, empty_url):
    robot_bridge("database", "create", **told)
    client = DatabaseClient(empty_url)
    client.sql("alter table commands add column colour varchar(9)")
    client.close()
    done = robot_bridge("database", "check", **told)
    assert "differs: remove column: commands, colour" in done.stdout
    assert "somebody changed the tables: put them back, or restore a backup" in refusal(done)


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
    assert "is at revision 0001, and this version of robot-bridge needs 0002" in line
    assert "back it up, then run: robot-bridge database upgrade" in line
    done = robot_bridge("database", "check", **told)
    assert "revision 0001\nneeded: revision 0002" in done.stdout
    assert "robot-bridge database upgrade" in refusal(done)
    done = robot_bridge("database", "upgrade", **told)
    assert done.stdout.endswith("upgraded from revision 0001 to 0002\n"), done
    bridge = start_bridge(sample_site, empty_url)
    assert bridge.desk().ask("get_positions")["robots"][0]["robot"] == "r1"
    bridge.end()


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"], indirect=True)
def test_serve_names_the_command_that_makes_the_tables_on_a_server(told, sample_site):
    line = refusal(robot_bridge("serve", "--site", sample_site, "--port", "0", **told))
    assert "has no tables of the bridge; make them with: robot-bridge database create" in line
