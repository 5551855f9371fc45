"""The service: what is installed is what systemd understands, and what is taken away again."""

from __future__ import annotations

import configparser
import shutil
import subprocess
from pathlib import Path

import pytest


@pytest.fixture
def make(root, tmp_path):
    def make(target, **variables):
        given = [
            f"{name}={value}" for name, value in {"DESTDIR": tmp_path, "PROGRAM": "no", **variables}.items()
        ]
        return subprocess.run(["make", target, *given], cwd=root, capture_output=True, text=True, check=False)

    return make


def files(folder: Path) -> list[str]:
    return sorted(str(entry.relative_to(folder)) for entry in folder.rglob("*") if entry.is_file())


def test_what_is_installed_lies_below_destdir_and_is_taken_away_again(make, tmp_path):
    done = make("install-service")
    assert done.returncode == 0, done.stderr
    assert files(tmp_path) == [
        "etc/robot-bridge/robot-bridge.env",
        "etc/systemd/system/robot-bridge-archive.service",
        "etc/systemd/system/robot-bridge-archive.timer",
        "etc/systemd/system/robot-bridge-link@.service",
        "etc/systemd/system/robot-bridge.service",
        "usr/lib/sysusers.d/robot-bridge.conf",
    ]
    assert make("install-maps-service").returncode == 0
    maps = {"etc/robot-bridge/maps.env", "etc/systemd/system/robot-bridge-maps.service"}
    assert {*files(tmp_path)} >= {*maps, "opt/robot-bridge/share/robot-bridge/serve_maps.py"}
    settings = tmp_path / "etc" / "robot-bridge" / "robot-bridge.env"
    settings.write_text("ROBOT_BRIDGE_LOG_FORMAT=json\n")
    assert make("install-service").returncode == 0
    assert settings.read_text() == "ROBOT_BRIDGE_LOG_FORMAT=json\n"
    assert make("uninstall-service").returncode == 0
    assert files(tmp_path) == ["etc/robot-bridge/maps.env", "etc/robot-bridge/robot-bridge.env"]


def test_a_folder_that_is_no_place_for_a_program_is_refused(make):
    done = make("install-service", PREFIX="opt/bridge")
    assert done.returncode != 0 and "PREFIX=opt/bridge is no absolute path" in done.stderr


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not installed")
def test_systemd_finds_nothing_wrong_with_the_unit(make, tmp_path):
    program = tmp_path / "opt" / "bin" / "python"
    program.parent.mkdir(parents=True)
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    make("install-service", PREFIX=program.parents[1])
    unit = tmp_path / "etc" / "systemd" / "system" / "robot-bridge.service"
    archive = [unit.with_name(f"robot-bridge-archive.{kind}") for kind in ("service", "timer")]
    verify = ["systemd-analyze", "verify", unit, *archive]
    done = subprocess.run(verify, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, "")
    unit.write_text(unit.read_text().replace("Restart=on-failure", "Restart=perhaps"))
    done = subprocess.run(["systemd-analyze", "verify", unit], capture_output=True, text=True, check=False)
    assert "perhaps" in done.stderr


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not installed")
@pytest.mark.parametrize("service", ["robot-bridge", "robot-bridge-archive", "robot-bridge-maps"])
def test_systemd_counts_the_service_among_those_that_are_shut_in(make, tmp_path, service):
    make(
        "install-maps-service" if service == "robot-bridge-maps" else "install-service",
        PREFIX="/opt/robot-bridge",
    )
    unit = tmp_path / "etc" / "systemd" / "system" / f"{service}.service"

    def judged(text):
        unit.write_text(text)
        command = ["systemd-analyze", "security", "--offline=true", "--no-pager", "--threshold=20", unit]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=240)
        return done.returncode, done.stdout

    installed = unit.read_text()
    # Of 100, 0 is shut in whole; a service as most are has 96.
    assert judged(installed)[0] == 0, judged(installed)[1]
    assert judged(installed.replace("ProtectSystem=strict", "").replace("CapabilityBoundingSet=", ""))[0] == 1


def test_the_unit_starts_what_there_is(root):
    unit = configparser.RawConfigParser(strict=False)
    unit.optionxform = str
    unit.read(root / "resources" / "service" / "robot-bridge.service")
    service = unit["Service"]
    assert service["ExecStart"] == "@PREFIX@/bin/python -m robot_bridge serve"
    assert service["Type"] == "notify"
    assert (service["User"], service["StateDirectory"]) == ("robot-bridge", "robot-bridge")
    text = (root / "resources" / "service" / "robot-bridge.service").read_text(encoding="utf-8")
    for fact in ("MALLOC_MMAP_THRESHOLD_=4194304", "MALLOC_TRIM_THRESHOLD_=67108864", "ProtectSystem=strict"):
        assert fact in text
