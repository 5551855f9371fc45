"""What the documents say is there: links, targets of the Makefile, commands."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import time
from pathlib import Path

import pytest

from robot_bridge.core.robotmap.text_format import read_text
from tests.support.operators import ask
from tests.support.patience import START
from tests.support.processes import Processes
from tests.support.qgis import program

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = [
    *(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def commands(document: Path, start: str) -> list[str]:
    """Return the lines of code in ``document`` that begin with ``start``, without their remarks."""
    lines = (line.strip() for line in document.read_text(encoding="utf-8").splitlines() if line[:4].isspace())
    return [line.split("  #")[0].split("   ")[0].strip() for line in lines if line.startswith(start)]


def anchors(document: Path) -> set[str]:
    headings = re.findall(r"^#+ (.+)$", document.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_link_resolves(document):
    for target in LINK.findall(document.read_text(encoding="utf-8")):
        if target.startswith(("http://", "https://")):
            continue
        name, _, anchor = target.partition("#")
        path = document.parent / name if name else document
        assert path.exists(), f"{document.name} links to {target}, which is not there"
        assert not anchor or anchor in anchors(path), f"{document.name} links to {target}: no such heading"


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda document: document.name)
def test_no_conflict_of_a_merge_is_left(document):
    assert not re.search(r"^(<{7}|>{7}) ", document.read_text(encoding="utf-8"), re.MULTILINE)


def test_the_readme_leads_to_every_guide():
    guides = {path.name for path in (ROOT / "docs").glob("*.md")}
    assert {"install.md", "operator.md", "integrator.md", "robot-map.md"} <= guides
    linked = {Path(target).name for target in LINK.findall((ROOT / "README.md").read_text(encoding="utf-8"))}
    assert linked >= guides


def test_the_two_commands_come_first():
    assert commands(ROOT / "README.md", "")[:2] == ["make demo", "make test"]


def test_every_make_target_that_a_document_names_is_there():
    named = set()
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        named |= set(re.findall(r"`make ([a-z-]+)", text))
        named |= {line.split()[1] for line in commands(document, "make ")}
    assert {"demo", "test", "desktop", "install", "package"} <= named
    for target in sorted(named):
        done = subprocess.run(
            ["make", "--dry-run", target], cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"a document names make {target}: {done.stderr}"


def test_every_program_that_a_document_names_is_there_and_knows_its_variables():
    named = set()
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        named |= set(
            re.findall(r"((?:[A-Z_]+=\S+ )*)(?<![\w/])((?:tests|tools)/[\w./-]+\.(?:sh|py))\b", text)
        )
    assert ("ARCH=arm64 ", "tests/packaging/appliance_root.sh") in named
    for variables, path in sorted(named):
        text = (ROOT / path).read_text(encoding="utf-8")
        assert [name for name in re.findall(r"([A-Z_]+)=", variables) if name not in text] == [], path


def test_the_help_lists_every_target():
    shown = subprocess.run(["make"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    phony = re.search(r"^\.PHONY: (.+)$", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    assert set(re.findall(r"^  make ([\w-]+)", shown, re.MULTILINE)) == set(phony.group(1).split())


def test_gateway_and_robot_run_as_the_readme_says(tmp_path):
    serve, robot, *_ = commands(ROOT / "README.md", ".venv/bin/robot-bridge")
    assert "serve" in serve
    assert "--url ws://127.0.0.1:8765/robot" in robot
    with Processes(tmp_path) as processes:
        database = f"sqlite:///{tmp_path / 'fleet.db'}"
        processes.start("gateway", [*words(serve), "--port", "0", "--database", database])
        address = processes.wait_for_line("gateway", r"listening on (ws://\S+)", START).group(1)
        processes.start("robot", words(robot.replace("ws://127.0.0.1:8765", address)))
        until = time.monotonic() + START
        while not (robots := ask(address, ("get_positions", {}))[0]["robots"]) or robots[0].get("x") is None:
            processes.require_running()
            assert time.monotonic() < until, "the robot did not come up"
            time.sleep(0.2)
    assert robots[0]["robot"] == "r1"
    assert robots[0]["x"] == pytest.approx(20, abs=0.2)


def test_each_block_of_the_readme_comes_to_its_end_or_is_one_command_that_runs_on():
    """Who copies a block whole has all of it done: nothing stands behind what does not end."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = [block.strip().splitlines() for block in re.findall(r"(?:^    .+\n?)+", text, re.MULTILINE)]
    running = [
        block for block in blocks if any(re.search(r"robot-bridge (serve|robot) ", one) for one in block)
    ]
    assert len(running) == 3
    assert [len(block) for block in running] == [1, 1, 1]


def test_the_map_is_exported_as_the_readme_says(tmp_path):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    block = re.search(r"^    export QT_QPA_PLATFORM[\s\S]*?OUTPUT=\S+$", text, re.MULTILINE).group()
    script = block.replace("qgis_process.bin", program("qgis_process")).replace("/tmp/", f"{tmp_path}/")
    env = {"PATH": os.environ["PATH"], "HOME": str(tmp_path), "XDG_RUNTIME_DIR": str(tmp_path)}
    done = subprocess.run(
        ["bash", "-euc", script], cwd=ROOT, env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    robot_map = read_text((tmp_path / "site.map").read_text(encoding="utf-8"))
    assert {obstacle.semantics.split(",")[0] for obstacle in robot_map.obstacles} == {"building", "wall"}


def words(command: str) -> list[str]:
    first, *rest = shlex.split(command)
    return [
        str(ROOT / first),
        *(str(ROOT / word) if word.startswith("resources/") else word for word in rest),
    ]
