"""The code keeps its own rules: style, types, and who may import whom."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tools.import_rules import check


def run(root: Path, *command: str) -> subprocess.CompletedProcess[str]:
    program = Path(sys.executable).with_name(command[0])
    return subprocess.run([program, *command[1:]], cwd=root, capture_output=True, text=True, check=False)


def test_ruff_finds_nothing(root):
    done = run(root, "ruff", "check", "--quiet", "--output-format=concise", ".")
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    "module", ["plugin/layers/role_editor/role_table.py", "resources/sample_site/make_project.py"]
)
def test_an_argument_without_a_class_is_named(root, tmp_path, module):
    """What has no class cannot be held against QGIS 4 and Qt 6: see test_qgis4.py."""
    shutil.copy(root / "pyproject.toml", tmp_path)
    (tmp_path / module).parent.mkdir(parents=True)
    (tmp_path / module).write_text("def dropEvent(self, event):\n    event.pos()\n", encoding="utf-8")
    done = run(tmp_path, "ruff", "check", "--output-format=concise", ".")
    assert f"{module}:1:21: ANN001" in done.stdout, done.stdout + done.stderr


def test_mypy_finds_nothing_in_the_bridge(root):
    done = run(root, "mypy")
    assert done.returncode == 0, done.stdout + done.stderr


def test_everyone_imports_only_what_they_may(root):
    done = check(root, quiet=True)
    assert done.returncode == 0, done.stdout + done.stderr


FORBIDDEN = [
    ("robot_bridge/core/messages/base.py", "import qgis.core", "The bridge runs without QGIS"),
    ("robot_bridge/core/messages/base.py", "from ...gateway import storage", "The core knows"),
    ("robot_bridge/core/robotmap/model.py", "from ..sites import frame", "No cycles"),
    ("robot_bridge/protocol/codec.py", "from ..gateway import app", "The floors of the bridge"),
    (
        "robot_bridge/gateway/model/robots.py",
        "from ..fleet import robot_outboxes",
        "The floors of the gateway",
    ),
    ("robot_bridge/links/base/client.py", "from ...gateway.storage import database", "Adapters know nothing"),
    (
        "robot_bridge/gateway/fleet/service.py",
        "from robot_bridge import core",
        "Inside a package imports are relative",
    ),
    ("plugin/plugin.py", "from ..robot_bridge.gateway import storage", "The plugin uses of the bridge only"),
    ("plugin/plugin.py", "from PyQt5 import QtCore", "The plugin uses Qt through qgis.PyQt"),
    ("plugin/processing/common/outputs.py", "from ...panel import window", "The floors of the plugin"),
]


@pytest.fixture(scope="module")
def told(root, tmp_path_factory) -> dict[str, str]:
    """What is said of each broken rule, by its name, where all that is forbidden is imported."""
    tree = tmp_path_factory.mktemp("tree")
    for part in ("plugin", "robot_bridge"):
        shutil.copytree(root / part, tree / part, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("__init__.py", "pyproject.toml"):
        shutil.copy(root / name, tree / name)
    for module, line, _ in FORBIDDEN:
        path = tree / module
        path.write_text(f"{path.read_text(encoding='utf-8')}\n{line}\n", encoding="utf-8")
    done = check(tree, quiet=True)
    assert done.returncode == 1
    _, _, broken = done.stdout.partition("Broken contracts\n")
    # A name, underlined.
    parts = re.split(r"^(.+)\n-+\n", broken, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


@pytest.mark.parametrize(("module", "line", "rule"), FORBIDDEN)
def test_a_forbidden_import_is_caught(told, module, line, rule):
    (said,) = (text for name, text in told.items() if name.startswith(rule))
    # A cycle is told by folders.
    importer = f".{Path(module).parent.name} -> " if rule == "No cycles" else module.removesuffix(".py")
    assert importer.replace("/", ".") in said
