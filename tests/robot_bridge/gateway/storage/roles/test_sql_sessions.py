"""The sessions of the integrator's guide, and the set-up of the operation page, run as they are written."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from robot_bridge.core.robotmap.binary import decode
from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.database_server import DatabaseServer
from tests.support.forked_programs import write_shell_command
from tests.support.operators import Desk
from tests.support.patience import START
from tests.support.processes import Processes

ROOT = Path(__file__).resolve().parents[5]
GUIDE = (ROOT / "docs" / "robots-sql.md").read_text(encoding="utf-8")
OPERATION = (ROOT / "docs" / "operation.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+) ([\w -]+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
DATABASE_ID = re.compile(r'"database": "[^"]+"')


class Shell:
    """One shell, as somebody sits at it; HOME is a folder of its own."""

    def __init__(self, folder: Path, **environment: str):
        self.folder = folder
        (folder / "bin").mkdir()
        # Who sits here may become anybody.
        script(folder / "bin" / "sudo", 'case "$1" in -u) shift 2;; esac; exec "$@"')
        write_shell_command(folder / "bin" / "robot-bridge")
        self._shell = subprocess.Popen(
            ["bash"],
            cwd=folder,
            env={
                "PATH": f"{folder / 'bin'}:{os.environ['PATH']}",
                "HOME": str(folder),
                "PYTHONPATH": str(ROOT),
                **environment,
            },
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    def run(self, text: str) -> str:
        """Return what the commands print, on both channels."""
        self._shell.stdin.write(f"{text}\necho '--- done' $?\n")
        self._shell.stdin.flush()
        lines = []
        for line in self._shell.stdout:
            if line.startswith("--- done"):
                return "".join(lines)
            lines.append(line)
        raise AssertionError(f"the shell ended: {''.join(lines)}")

    def close(self) -> None:
        self._shell.communicate()


def script(path: Path, text: str) -> None:
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


@dataclass
class Place:
    """A server that was set up as the operation page says, and who did it at a shell; what that printed."""

    kind: str
    client: str
    server: DatabaseServer
    shell: Shell
    printed: str


@pytest.fixture(scope="module", params=[("postgresql", "psql"), ("mariadb", "mariadb")], ids=lambda p: p[0])
def place(request, tmp_path_factory):
    kind, client = request.param
    server = request.getfixturevalue(f"{kind}_server")
    environment = {
        "postgresql": {"PGHOST": "127.0.0.1", "PGPORT": str(server.port), "PGUSER": "postgres"}
        | {"PGPASSWORD": server.admin_password},
        "mariadb": {"MYSQL_HOST": "127.0.0.1", "MYSQL_TCP_PORT": str(server.port)}
        | {"MYSQL_PWD": server.admin_password},
    }[kind]
    shell = Shell(tmp_path_factory.mktemp("administrator"), **environment)
    if kind == "mariadb":
        # Debian lets root in by its socket; this server asks for a password.
        script(shell.folder / "bin" / "mariadb", f'exec {shutil.which("mariadb")} -u root "$@"')
    text = written(OPERATION, kind).replace("127.0.0.1/fleet", f"127.0.0.1:{server.port}/fleet")
    try:
        yield Place(kind, client, server, shell, shell.run(text))
        shell.run("robot-bridge robots remove r1")
    finally:
        shell.close()
        drop(kind, server)


def written(page: str, info: str) -> str:
    """Return the one block of commands of a page that is marked ``info``."""
    (text,) = [text for language, mark, text in BLOCK.findall(page) if (language, mark) == ("sh", info)]
    return text


def drop(kind, server):
    """Take away what the operation page has made."""
    if kind == "postgresql":
        server.sql("drop database fleet with (force)")
        server.sql("drop role fleet_gateway; drop role fleet_sa_reader; drop role fleet_admin")
    else:
        server.sql("drop database fleet; drop database fleet_robots; drop user fleet_admin@'127.0.0.1'")
        server.sql("drop user fleet_gateway; drop user fleet_keeper@localhost")


@pytest.fixture
def gateway(place, sample_site, tmp_path):
    """A gateway that runs as the operation page says, and an operator at its desk."""
    (line,) = re.findall(r"^    (robot-bridge serve .*--database postgresql.*)$", OPERATION, re.MULTILINE)
    line = line.replace("/srv/fleet/site", str(sample_site)).replace("postgresql:", f"{place.kind}:")
    line = line.replace("127.0.0.1/", f"127.0.0.1:{place.server.port}/")
    words = shlex.split(line)[1:]
    words[words.index("gateway.password")] = str(place.shell.folder / "gateway.password")
    with Processes(tmp_path / "logs") as processes:
        processes.start_bridge("gateway", [*words, "--port", "0"])
        address = processes.wait_for_line("gateway", r"listening on (ws://\S+)", START).group(1)
        yield Desk(f"{address}/desk", "Ada")
        assert "Traceback" not in processes.log("gateway").read_text(encoding="utf-8")


def test_a_server_is_set_up_as_the_page_says(place):
    password = place.shell.folder / "r1.password"
    before = password.read_text()
    printed = place.shell.run(written(OPERATION, "both"))
    assert place.printed.splitlines()[-1] == printed.splitlines()[-1] == "r1\tdatabase account"
    assert "robot r2 is removed" in printed
    assert "rror" not in place.printed + printed
    assert len(password.read_text().strip()) >= 32
    assert password.read_text() != before
    audited = place.shell.run("robot-bridge audit")
    for action in ("database account", "robots add", "robots rotate", "robots remove"):
        assert action in audited
    assert password.read_text().strip() not in audited


def test_a_robot_with_an_ordinary_sql_client_does_what_the_guide_says(place, gateway, tmp_path):
    (tmp_path / "robot").mkdir()
    port = str(place.server.port)
    password = (place.shell.folder / "r1.password").read_text().strip()
    robot = Shell(tmp_path / "robot", PGPORT=port, MYSQL_TCP_PORT=port, PASSWORD=password)
    printed, compared = "", 0
    for _, info, text in BLOCK.findall(GUIDE):
        if info == f"{place.client}-prints":
            assert DATABASE_ID.sub("", printed) == DATABASE_ID.sub("", text)
            compared += 1
        if info.split()[0] != place.client:
            continue
        if info.endswith("after-send"):
            gateway.send("target-r1", "r1", "SetPosEnd", x=20.1, y=8.0, cone=False)
        printed = robot.run(text)
        wait_until(lambda: place.server.sql("select count(*) from rr", "fleet") == "0", what=text)
    robot.close()
    assert compared == 4
    command = gateway.wait_for_step("target-r1", "reached")
    assert [step["state"] for step in command["steps"]] == ["queued", "delivered", "acknowledged", "reached"]
    assert decode((tmp_path / "robot" / "site.rmap").read_bytes()).obstacles
