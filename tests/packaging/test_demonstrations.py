"""`make demo` and `make desktop`, as real programs: what they show really happened, and nothing is left."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from robot_bridge.core.robotmap.binary import decode_text
from tests.support.fleet import STARTS
from tests.support.patience import BUSY
from tests.support.processes import left_running


@pytest.fixture
def environment(tmp_path) -> dict[str, str]:
    """The environment of a user without a display, with a folder of its own for what is left behind."""
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return {
        **kept,
        "FLEET_CLUSTER_FOLDER": str(tmp_path / "cluster"),
        "FLEET_DEMO_FOLDER": str(tmp_path / "demo"),
        "FLEET_DESKTOP_FOLDER": str(tmp_path / "desktop"),
    }


def test_the_demo_does_what_it_says(root, tmp_path, environment):
    done = subprocess.run(
        [sys.executable, "-m", "tools.demo"],
        cwd=root,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert len(done.stdout.splitlines()) <= 20
    folder = tmp_path / "demo"
    report = (folder / "report.md").read_text(encoding="utf-8")
    for robot, how in (("r1", "reached"), ("r2", "reached"), ("r3", "aborted")):
        assert any(line.startswith(f"| {robot} |") and f"| {how} |" in line for line in report.splitlines())
    text = (folder / "site.map").read_text(encoding="utf-8")
    assert decode_text((folder / "site.bin").read_bytes()) == text
    assert f"| {len(text.encode())} |" in report
    assert (folder / "canvas.png").stat().st_size > 100_000, "an empty canvas is a small file"
    assert not left_running(tmp_path)


@pytest.mark.again("tests/robot_bridge/gateway/cluster/test_two_gateways.py shows what dies, step by step")
def test_the_demo_of_several_gateways_does_what_it_says(root, tmp_path, environment):
    pytest.importorskip("nats", reason="nats-py is not installed; run make setup")
    done = subprocess.run(
        [sys.executable, "-m", "tools.demo", "cluster"],
        cwd=root,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    for claim in (
        "4 gateways serve",
        "gateway south is killed",
        "the desk has its robots again: r5",
        "in force at 3 of 3 gateways, 8 of 8 robots acknowledged and seen to stand",
        "each gateway says the same",
    ):
        assert claim in done.stdout
    folder = tmp_path / "cluster"
    assert (folder / "steps.txt").read_text(encoding="utf-8") in done.stdout
    pictures = sorted(file.stem for file in folder.glob("*.png") if file.stat().st_size > 100_000)
    assert pictures == ["driving", "emergency-stop", "gateway-killed"]
    assert not left_running(tmp_path)


def test_the_demo_fails_when_a_program_is_missing_and_leaves_nothing_running(root, tmp_path, environment):
    done = subprocess.run(
        [sys.executable, "-m", "tools.demo"],
        cwd=root,
        env={**environment, "PATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "demo: error: qgis_process is not on the path; run: make setup" in done.stderr
    assert not (tmp_path / "demo" / "report.md").exists()
    assert not left_running(tmp_path)


def test_the_desktop_opens_connected_and_takes_everything_with_it_when_it_is_ended(
    root, tmp_path, environment
):
    with subprocess.Popen(
        [sys.executable, "-m", "tools.desktop"],
        cwd=root,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as desktop:
        try:
            told = [desktop.stdout.readline() for _ in range(3)]
            assert told[0].startswith("There is no display here: QGIS opens on the virtual screen :")
            assert told[2].startswith("QGIS is open and connected to ws://127.0.0.1:"), desktop.stderr.read()
            assert len(left_running(tmp_path)) >= 7, "the script, Xvfb, the gateway, three robots, QGIS"
            logs = {file.stem for file in (tmp_path / "desktop" / "logs").iterdir()}
            assert logs == {"gateway", "qgis", "xvfb", *(start.name for start in STARTS)}
        finally:
            desktop.send_signal(signal.SIGINT)
        assert desktop.wait(30) == 130
    until = time.monotonic() + 5 * BUSY
    while left_running(tmp_path) and time.monotonic() < until:
        time.sleep(0.1)
    assert not left_running(tmp_path)
