"""The commands of the operation page on accounts and TLS, run as they are written."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import ssl
import subprocess
from dataclasses import fields
from pathlib import Path

import pytest

from robot_bridge.core.messages.base import Role
from robot_bridge.core.sites.settings_tables import LimitSettings
from tests.support.bridge.bridge_accounts import bearing
from tests.support.forked_programs import write_shell_command
from tests.support.operators import Desk
from tests.support.patience import START
from tests.support.processes import Processes

ROOT = Path(__file__).resolve().parents[4]
PAGE = (ROOT / "docs" / "operation.md").read_text(encoding="utf-8")
SECURITY = (ROOT / "docs" / "security.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```sh (access(?:-serve)?)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


@pytest.fixture(scope="module")
def shell(tmp_path_factory, sample_site):
    """Run commands in one folder, where /srv/fleet is and robot-bridge can be called."""
    folder = tmp_path_factory.mktemp("fleet")
    (folder / "bin").mkdir()
    write_shell_command(folder / "bin" / "robot-bridge")
    shutil.copytree(sample_site, folder / "site")
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}

    def run(text):
        script = f"set -e\nexport ROBOT_BRIDGE_DATABASE=sqlite:///{folder}/fleet.db\numask 077\n"
        script += text.replace("/srv/fleet", str(folder))
        return subprocess.run(
            ["bash", "-c", script], cwd=folder, env=environment, capture_output=True, text=True, check=False
        )

    run.folder = folder
    return run


def test_the_page_is_run_from_top_to_bottom_and_does_what_it_says(shell, tmp_path):
    folder, renewed = shell.folder, None
    with Processes(tmp_path / "logs") as processes:
        for kind, text in BLOCKS:
            if kind == "access":
                done = shell(text)
                assert done.returncode == 0, f"{text}\n{done.stderr}"
                continue
            words = shlex.split(text.replace("/srv/fleet", str(folder)))[1:]
            database = ["--database", f"sqlite:///{folder}/fleet.db", "--port", "0"]
            processes.start_bridge("gateway", [*words, *database])
            found = processes.wait_for_line("gateway", r"listening on wss://0\.0\.0\.0:(\d+)", START)
            renewed = (folder / "tls" / "server.pem").read_bytes()
            context = ssl.create_default_context(cafile=folder / "tls" / "ca.pem")
            context.check_hostname = False
            token = (folder / "ada.token").read_text().strip()
            desk = Desk(f"wss://127.0.0.1:{found.group(1)}/desk", "x", ssl=context, **bearing(token))
            assert desk.ask("hello", {"operator": "x"})["role"] == "supervisor"
            desk.connection.close()
    assert (folder / "ada.token").stat().st_mode & 0o77 == 0
    assert renewed != (folder / "tls" / "server.pem").read_bytes()
    listed = shell("robot-bridge operators list").stdout
    assert re.search(r"^Ada\tsupervisor\tvalid", listed, re.MULTILINE)
    assert re.search(r"^Ben\toperator\trevoked", listed, re.MULTILINE)


def test_every_limit_stands_on_the_page_with_its_default():
    table = PAGE.split("## Limits")[1].split("\n## ")[0]
    rows = re.findall(r"^\| (`.*?`) \| (.*?) \|", table, re.MULTILINE)
    told = {}
    for names, defaults in rows:
        keys = re.findall(r"`(\w+)`", names)
        told |= dict(zip(keys, re.split(r", (?!\])", defaults), strict=True))
    limits = LimitSettings()
    wanted = {field.name: getattr(limits, field.name) for field in fields(limits)}
    lists = {"origins", "hosts"}
    assert {name: float(text) for name, text in told.items() if name not in lists} == {
        name: value for name, value in wanted.items() if name not in lists
    }
    assert {told[name] for name in lists} == {"[]"}


def test_every_role_stands_on_the_page():
    assert re.findall(r"^\| (viewer|operator|supervisor) \| ", PAGE, re.MULTILINE) == [r.value for r in Role]


def test_every_test_that_the_threat_model_names_is_there():
    named = set(re.findall(r"`((?:tests/robot_bridge/)?[\w/]+)(?:\.py)?`", SECURITY))
    files = {name for name in named if name.startswith(("test_", "tests/"))}
    assert len(files) > 8
    for name in files:
        assert (ROOT / name).is_dir() or list((ROOT / "tests").rglob(f"{Path(name).name}.py")), name
