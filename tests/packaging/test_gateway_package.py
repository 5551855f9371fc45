"""Wheel and sdist of the gateway: they hold all of it, and it runs where there is no repository."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import sysconfig
import tarfile
import urllib.request
import zipfile
from pathlib import Path
from typing import NamedTuple

import pytest
import tomllib

from tests.support.operators import open_desk
from tests.support.patience import START
from tests.support.processes import Processes
from tools.gateway_package import build, gateway_files
from tools.plugin_files import PackageError, version

ALONE = {"PYTHONPATH": "", "PYTHONHOME": ""}
"""Nothing of what the tests' own Python finds by its environment."""


class Installed(NamedTuple):
    """A virtual environment that has the wheel, and packages of other projects from the tests' own."""

    python: Path
    program: Path


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    return build(tmp_path_factory.mktemp("package"))


@pytest.fixture(scope="module")
def kept(root) -> set[str]:
    """What git keeps of the gateway."""
    listed = subprocess.run(
        ["git", "ls-files", "robot_bridge"], cwd=root, stdout=subprocess.PIPE, text=True, check=False
    )
    if listed.returncode != 0:
        pytest.skip("this is not a git checkout")
    return {name for name in listed.stdout.splitlines() if (root / name).is_file()}


@pytest.fixture(scope="module")
def installed(package, stock_python, tmp_path_factory) -> Installed:
    folder = tmp_path_factory.mktemp("installed") / "venv"
    venv = [stock_python, "-m", "venv", "--without-pip", "--system-site-packages"]
    subprocess.run([*venv, folder], check=True)
    made = Installed(folder / "bin" / "python", folder / "bin" / "robot-bridge")
    pip = [sys.executable, "-m", "pip", "--python", made.python, "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, "install", "--no-deps", "--no-index", "--no-compile", package.wheel], check=True)
    (packages,) = folder.glob("lib/python*/site-packages")
    # As a plain folder: the links to the repository in it are not followed.
    (packages / "others.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    return made


def test_the_wheel_holds_all_of_the_gateway_and_nothing_else(package, kept):
    with zipfile.ZipFile(package.wheel) as archive:
        names = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert names == kept


def test_the_sdist_holds_what_the_wheel_is_made_of(package, kept):
    with tarfile.open(package.sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames() if name.count("/")}
    assert kept | {"pyproject.toml", "README.md", "LICENSE"} <= names


def test_names_and_metadata_carry_version_and_licence(package, root):
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    stem = f"{project['name'].replace('-', '_')}-{version()}"
    assert package.wheel.name == f"{stem}-py3-none-any.whl"
    assert package.sdist.name == f"{stem}.tar.gz"
    with zipfile.ZipFile(package.wheel) as archive:
        names = archive.namelist()
        metadata = archive.read(f"{stem}.dist-info/METADATA").decode()
    assert "\nLicense-Expression: GPL-2.0-or-later\n" in metadata
    assert f"{stem}.dist-info/licenses/LICENSE" in names


def test_what_lies_about_stays_out(root, tmp_path):
    shutil.copytree(root / "robot_bridge" / "protocol", tmp_path / "robot_bridge" / "protocol")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(root / name, tmp_path)
    before = gateway_files(tmp_path)
    for stray in ("robot_bridge/fleet.db", "robot_bridge/.secret.py", "build/lib/robot_bridge/old.py"):
        (tmp_path / stray).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / stray).touch()
    assert gateway_files(tmp_path) == before
    assert tmp_path / "robot_bridge" / "protocol" / "codec.py" in before


def test_a_missing_part_is_named(tmp_path):
    with pytest.raises(PackageError, match=r"pyproject\.toml is missing .* restore it from git"):
        build(tmp_path / "out", tmp_path)


def test_it_says_its_version_and_is_not_the_repository(installed, root, tmp_path):
    done = subprocess.run(
        [installed.program, "--version"], cwd=tmp_path, env=ALONE, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == version()
    code = "import robot_bridge; print(robot_bridge.__file__)"
    done = subprocess.run(
        [installed.python, "-c", code], cwd=tmp_path, env=ALONE, capture_output=True, text=True, check=True
    )
    assert root not in Path(done.stdout).parents
    assert installed.python.parents[1] in Path(done.stdout).parents


def test_it_serves_a_site_without_the_repository(installed, root, tmp_path):
    site = tmp_path / "site"
    site.mkdir()
    for name in ("site.toml", "site.gpkg"):
        shutil.copy(root / "resources" / "sample_site" / name, site)
    database = f"sqlite:///{tmp_path / 'fleet.db'}"
    with Processes(tmp_path) as processes:
        command = [installed.program, "serve", "--site", site, "--port", "0", "--database", database]
        gateway = processes.start("gateway", command, env=ALONE)
        address = processes.wait_for_line("gateway", r"listening on (ws://\S+)", START).group(1)
        with open_desk(address) as desk:
            assert desk.ask("get_positions")["robots"] == []
        assert b"leaflet" in page(address, "/field")
        assert page(address, "/field/leaflet.js")
        assert b"# TYPE " in page(address, "/metrics")
        gateway.send_signal(signal.SIGTERM)
        assert processes.wait("gateway", START) == 0


def page(address: str, path: str) -> bytes:
    with urllib.request.urlopen(f"{address.replace('ws://', 'http://')}{path}", timeout=START) as answer:
        return answer.read()
