"""The operation page: its commands are run as they are written, and its tables name what there is."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import fields

import pytest

from robot_bridge.core.clock import SYSTEM_CLOCK
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.sites.settings import TABLES
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.repositories import records, trajectories
from robot_bridge.gateway.storage.repositories.records import NewPlacement
from robot_bridge.gateway.storage.repositories.trajectories import DAY, Fix, pack
from tests.support.databases.archive_reader import duckdb_with_spatial
from tests.support.forked_programs import write_shell_command

SHELL = ["sh", "-eu"]


@pytest.fixture(scope="module")
def page(root) -> str:
    return (root / "docs" / "operation.md").read_text(encoding="utf-8")


def test_the_commands_for_sqlite_do_what_they_say(page, root, sample_site, tmp_path, monkeypatch):
    shutil.copytree(sample_site, tmp_path / "site", ignore=shutil.ignore_patterns("*.tif", "*.py", "drawing"))
    program = tmp_path / "bin" / "robot-bridge"
    program.parent.mkdir()
    write_shell_command(program)
    blocks = re.findall(r"^```sh sqlite\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    assert len(blocks) == 5
    # The track of a robot that was never there is refused, and a layout without a cone.
    database = f"sqlite:///{tmp_path}/robot-bridge.db"
    run_once(database, revisions.create)
    yesterday = (SYSTEM_CLOCK.time() // DAY - 1) * DAY
    fixes = [Fix("r1", yesterday + n, SendPos(1.0 + n, 2.0, 0.0, 0.0)) for n in range(3)]
    run_once(database, trajectories.add, list(map(pack, fixes)))
    place = {"planned_x": 1.0, "planned_y": 2.0, "x": 1.0, "y": 2.0, "theta": 0.0, "deviation": 0.0}
    cone = NewPlacement("task-1", "r1", "command-1", placed_at=1_790_000_000.0, layout="slalom-1", **place)
    run_once(database, records.add_placed_cones, cone)
    done = subprocess.run(
        SHELL,
        input="".join(blocks),
        cwd=tmp_path,
        text=True,
        capture_output=True,
        check=False,
        timeout=240,
        env={**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "PYTHONPATH": str(root)},
    )
    assert done.returncode == 0, done.stderr
    assert "the tables are those that this version works with" in done.stdout
    for name in ("fleet-backup.db", "drives.gpkg", "r1.gpkg", "cones.csv", "slalom.gpkg"):
        assert (tmp_path / name).is_file()
    (query,) = re.findall(r"^```sql archive\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    assert duckdb_with_spatial().execute(query).fetchall() == [("r1", 2.0)]


def test_every_setting_is_explained(page):
    section = page.split("## The settings of a site")[1].split("\n## ")[0]
    for table, kind in TABLES.items():
        if table == "limits":
            continue  # in the part on limits
        for field in fields(kind):
            assert f"`{field.name}`" in section, f"{table}.{field.name}"


def test_every_metric_is_one_that_there_is(page, root):
    source = "".join(
        (root / "robot_bridge" / "gateway" / name).read_text(encoding="utf-8")
        for name in ("api/metrics_and_queries.py", "monitoring.py")
    )
    named = set(re.findall(r"`robot_bridge_(\w+?)(?:_total)?[`{ ]", page))
    assert len(named) > 12
    for name in named:
        assert f'"{name}"' in source or f'"robot_bridge_{name}"' in source, name


def test_every_option_of_serve_is_explained(page):
    from robot_bridge.cli.serve import serve

    # Whoever runs a gateway has no use for what programs that start one give it.
    for name in serve.__annotations__:
        if name not in ("return", "until_stdin_closes"):
            assert f"`--{name.replace('_', '-')}`" in page, name
