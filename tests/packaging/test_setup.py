"""The set-up is quick when nothing is missing and says what to do when it cannot help itself."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from pathlib import Path

import pytest

TOOLS = ("sh", "dirname", "id", "mktemp", "rm", "tail", "sort", "tr", "env", "touch", "cat")
NO_PYQGIS = 'case "$2" in *qgis*) echo no module named qgis >&2; exit 1;; esac'


@pytest.fixture
def machine(tmp_path, root):
    """A machine with a few programs and the given ones (name: shell text); a call runs the set-up there."""
    (tmp_path / "project" / "tools").mkdir(parents=True)
    shutil.copy(root / "tools" / "setup.sh", tmp_path / "project" / "tools")
    programs = tmp_path / "bin"
    programs.mkdir()
    for tool in TOOLS:
        (programs / tool).symlink_to(shutil.which(tool))

    def run(given: dict[str, str], **environment: str) -> subprocess.CompletedProcess[str]:
        for name, text in given.items():
            script(programs / name, text)
        return subprocess.run(
            [tmp_path / "project" / "tools" / "setup.sh"],
            env={"PATH": str(programs), "HOME": str(tmp_path), **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    return run


def script(path: Path, text: str) -> None:
    path.unlink(missing_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


def make_setup(project: Path) -> None:
    subprocess.run(["make", "--silent", "setup"], cwd=project, env=os.environ, check=True)


def test_the_set_up_runs_again_only_when_the_requirements_change(root, tmp_path):
    (tmp_path / "tools").mkdir()
    (tmp_path / ".venv").mkdir()
    shutil.copy(root / "Makefile", tmp_path)
    (tmp_path / "pyproject.toml").touch()
    script(tmp_path / "tools" / "setup.sh", "echo run >> runs; touch .venv/.fleet-setup")

    make_setup(tmp_path)
    make_setup(tmp_path)
    assert (tmp_path / "runs").read_text() == "run\n"

    later = time.time() + 5
    os.utime(tmp_path / "pyproject.toml", (later, later))
    make_setup(tmp_path)
    assert (tmp_path / "runs").read_text() == "run\nrun\n"


def test_without_apt_it_says_what_to_install(machine):
    done = machine({"python3": NO_PYQGIS})
    assert done.returncode == 1
    assert "missing: python3-qgis python3-venv qgis xvfb." in done.stderr
    assert "This machine has no apt" in done.stderr
    assert "make setup PYTHON=/path/to/the/python3/that/imports/qgis.core" in done.stderr


def test_without_root_and_sudo_it_says_what_root_should_run(machine):
    done = machine({"python3": NO_PYQGIS, "apt-get": "echo must not run; exit 3", "id": "echo 1000"})
    assert done.returncode == 1
    assert "sudo is not usable here" in done.stderr
    assert "apt-get install --no-install-recommends python3-qgis python3-venv qgis xvfb" in done.stderr
    assert "must not run" not in done.stdout + done.stderr


def test_only_what_is_missing_is_installed(machine, tmp_path):
    calls = tmp_path / "calls"
    apt = f'echo "$@" >> {calls}; exit 100'
    machine({"python3": "", "qgis.bin": "", "qgis_process.bin": "", "apt-get": apt, "id": "echo 0"})
    assert calls.read_text().splitlines()[0].split()[-2:] == ["--no-install-recommends", "xvfb"]


@pytest.mark.parametrize(
    ("known", "browser"), [("exit 0", "chromium-headless-shell"), ("exit 100", "chromium")]
)
def test_servers_are_installed_for_the_tests_and_nothing_waits_for_them(machine, tmp_path, known, browser):
    calls = tmp_path / "calls"
    there = {"python3": '[ "$1" != -m ] || { echo on to the environment >&2; exit 1; }', "Xvfb": ""}
    there |= {"qgis.bin": "", "qgis_process.bin": "", "id": "echo 0", "ls": "exit 2"}
    there |= {"apt-get": f'echo "$@" >> {calls}; exit 100', "mariadbd": "", "mosquitto": ""}
    there |= {"apt-cache": known}
    done = machine(there)
    asked = [line.split() for line in calls.read_text().splitlines()]
    assert [line[0] for line in asked] == ["install", "update", "install"]
    wanted = ["postgresql", "postgresql-postgis", "qgis-server", browser, "libfaketime"]
    assert asked[0][-5:] == wanted
    assert f"not installed: {' '.join(wanted)}; the tests that need them will be" in done.stdout
    assert "on to the environment" in done.stderr


def test_a_failing_apt_is_shown_and_the_lists_are_renewed_once(machine, tmp_path):
    calls = tmp_path / "calls"
    apt = f'echo "$1" >> {calls}; echo E: no such mirror; exit 100'
    done = machine({"python3": NO_PYQGIS, "apt-get": apt, "id": "echo 0"})
    assert done.returncode == 1
    assert calls.read_text().split() == ["install", "update", "install"]
    assert "E: no such mirror" in done.stderr
    assert "Mend that, then run: make setup" in done.stderr


def test_an_unsuitable_qgis_is_refused_and_nothing_is_made(machine, tmp_path):
    old = '[ "$1" != - ] || { echo QGIS 3.22 or newer is needed, this one is 3.16 >&2; exit 1; }'
    done = machine({"python3": old, "qgis": "", "qgis_process": "", "Xvfb": ""})
    assert done.returncode == 1
    assert "QGIS 3.22 or newer is needed, this one is 3.16" in done.stderr
    assert "Choose another one: make setup PYTHON=/path/to/python3" in done.stderr
    assert not (tmp_path / "project" / ".venv").exists()


def test_a_given_python_without_pyqgis_is_refused(machine, tmp_path):
    done = machine({"python3": "", "other": NO_PYQGIS}, PYTHON=str(tmp_path / "bin" / "other"))
    assert done.returncode == 1
    assert "no module named qgis" in done.stderr
    assert f"PYTHON={tmp_path}/bin/other cannot import qgis.core" in done.stderr


def test_the_python_with_pyqgis_is_found_behind_one_without(machine, tmp_path):
    behind = tmp_path / "behind"
    behind.mkdir()
    script(behind / "python3", '[ "$1" != -m ] || { echo made by the one behind >&2; exit 1; }')
    done = machine(
        {"python3": NO_PYQGIS, "qgis": "", "qgis_process": "", "Xvfb": ""},
        PATH=f"{tmp_path / 'bin'}:{behind}",
    )
    assert "made by the one behind" in done.stderr
