"""`make test-core`, which needs neither QGIS nor servers, and which files are dealt out early."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest

REACHES_QGIS = """
import importlib

def test_it():
    importlib.import_module("qgis.core")
"""


@pytest.fixture
def core(root):
    """Run pytest as `make test-core` does, without workers: ``core(*arguments)``."""
    recipe = (root / "Makefile").read_text(encoding="utf-8").partition("\ntest-core:")[2].splitlines()[1]
    options = re.search(r"-m pytest (.+) -n 2 ", recipe).group(1).split()
    assert "--core" in options
    without = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM", "XDG_RUNTIME_DIR")
    environment = {name: value for name, value in os.environ.items() if name not in without}

    def run(*arguments):
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *options, *map(str, arguments)]
        return subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=False)

    return run


def test_what_it_selects_imports_no_qgis_and_starts_no_server(core):
    done = core("--collect-only")
    assert done.returncode == 0, done.stdout + done.stderr
    selected = [line for line in done.stdout.splitlines() if "::" in line]
    assert len(selected) > 2500
    assert not [name for name in selected if re.search(r"\[(postgresql|mariadb)[\]-]|tests/p", name)]
    assert any("test_emergency_stop.py" in name for name in selected)


def test_a_test_of_it_that_reaches_for_qgis_fails(core, root, tmp_path):
    (tmp_path / "test_reaching.py").write_text(REACHES_QGIS, encoding="utf-8")
    done = core(root / "tests" / "robot_bridge" / "core" / "test_counting.py", tmp_path / "test_reaching.py")
    assert done.returncode == 1
    assert "ModuleNotFoundError: No module named 'qgis.core'" in done.stdout, done.stdout
    assert "1 failed, 3 passed" in done.stdout


def test_each_file_that_is_dealt_out_early_is_there(root, request):
    conftest = request.config.pluginmanager.get_plugin(str(root / "tests" / "conftest.py"))
    assert [name for name in conftest.LONG if not (root / "tests" / name).is_file()] == []


def test_no_test_is_given_a_folder_that_it_does_not_ask_for(request):
    assert "tmp_path" not in request.fixturenames
