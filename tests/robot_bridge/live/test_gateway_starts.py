"""A gateway that cannot start says why in one line; one that runs ends in good order."""

from __future__ import annotations

import shutil
import signal
import socket
import sqlite3
import subprocess
import sys

import pytest

from tests.support.bridge.command_line import run_command


def run_program(*options):
    """Run a process of its own, as the other tests do not: what it says is the same."""
    return subprocess.run(
        [sys.executable, "-m", "robot_bridge", *map(str, options)],
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )


def refusal(done) -> str:
    """Return the one line that a program ends with when it cannot do what it was asked."""
    assert done.returncode == 1, done
    assert "Traceback" not in done.stderr
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("robot-bridge: ")
    return lines[0]


@pytest.fixture
def free_database(tmp_path):
    return f"sqlite:///{tmp_path}/fleet.db"


@pytest.fixture
def site_with(sample_site, tmp_path):
    """Make a copy of the sample site whose site.toml differs."""

    def make(old, new):
        folder = tmp_path / "site"
        folder.mkdir()
        shutil.copy(sample_site / "site.gpkg", folder)
        text = (sample_site / "site.toml").read_text(encoding="utf-8")
        assert old in text
        (folder / "site.toml").write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return make


def test_a_wrong_database_is_named_before_the_site_is_read(site_with, tmp_path):
    """A city takes minutes to read, and nobody waits that long for a spelling mistake."""
    site = site_with('id = "sample"', 'id = "sample"')
    (site / "site.gpkg").write_bytes(b"no GeoPackage")
    said = refusal(
        run_command("serve", "--site", site, "--database", f"sqlite:///{tmp_path}/nowhere/fleet.db")
    )
    assert "nowhere" in said and "site.gpkg" not in said


def test_a_site_that_is_not_there_leaves_no_database(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    said = refusal(run_command("serve", "--site", "nowhere", "--database", "sqlite:///fleet.db"))
    assert "nowhere is no folder" in said
    assert list(tmp_path.iterdir()) == []


def test_a_port_that_is_taken_is_named(sample_site, free_database):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        line = refusal(
            run_program("serve", "--site", sample_site, "--database", free_database, "--port", port)
        )
    assert f"cannot listen on 127.0.0.1:{port}" in line
    assert "choose another --port, or 0 for any" in line


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.10", "::"])
def test_without_tls_it_listens_on_loopback_only(sample_site, free_database, host):
    line = refusal(run_command("serve", "--site", sample_site, "--database", free_database, "--host", host))
    assert f"host {host} can be reached from other computers" in line
    assert "use 127.0.0.1" in line


def test_a_host_is_an_address(sample_site, free_database):
    line = refusal(
        run_command("serve", "--site", sample_site, "--database", free_database, "--host", "my-pi")
    )
    assert "host 'my-pi' is not an IP address; use 127.0.0.1, or 0.0.0.0 for" in line


def test_a_site_that_is_not_there_is_named(tmp_path, free_database):
    line = refusal(run_command("serve", "--site", tmp_path / "none", "--database", free_database))
    assert f"{tmp_path}/none is no folder: a published site is a folder with site.toml and site.gpkg" in line


def test_web_mercator_is_no_frame_for_a_site(site_with, free_database):
    folder = site_with("EPSG:32633", "EPSG:3857")
    line = refusal(run_command("serve", "--site", folder, "--database", free_database))
    assert f"{folder}/site.toml: site.crs:" in line
    assert "3857" in line


def test_a_setting_that_is_wrong_is_named(site_with, free_database):
    folder = site_with("reached_tolerance_m = 0.2", "reached_tolerance_m = -1.0")
    line = refusal(run_command("serve", "--site", folder, "--database", free_database))
    assert "site.reached_tolerance_m = -1.0" in line


def test_a_database_in_a_folder_that_is_not_there_is_named(sample_site, tmp_path):
    url = f"sqlite:///{tmp_path}/none/fleet.db"
    line = refusal(run_command("serve", "--site", sample_site, "--port", "0", "--database", url))
    assert f"database {url}: unable to open database file; check that it exists" in line


def test_a_database_that_may_not_be_written_is_named(sample_site, tmp_path):
    sqlite3.connect(tmp_path / "fleet.db").close()
    url = f"sqlite:///file:{tmp_path}/fleet.db?mode=ro&uri=true"
    line = refusal(run_command("serve", "--site", sample_site, "--port", "0", "--database", url))
    assert "readonly database" in line


def test_a_robot_has_one_link(free_database):
    both = ["--url", "ws://127.0.0.1:1/robot", "--database", free_database]
    for ways in ([], both):
        line = refusal(run_command("robot", "--name", "r1", *ways))
        assert "give either --url or --database" in line


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--name", "r 1", "--url", "ws://127.0.0.1:1/robot"], "robot name 'r 1' cannot be used"),
        (["--name", "r1", "--url", "http://127.0.0.1:1/"], "write the URL as ws://127.0.0.1:8765/robot"),
        (["--name", "r1", "--url", "ws://127.0.0.1:1/robot", "--pose", "1,2"], "write X,Y,THETA such as"),
        (["--name", "r1", "--database", "mysql://h/d"], "mysql is not supported"),
    ],
)
def test_what_a_robot_is_started_with_is_checked(options, text):
    assert text in refusal(run_command("robot", *options))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_in_good_order_while_everybody_is_connected(start_bridge, sample_site, number):
    bridge = start_bridge(sample_site)
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 12.0, "y": 34.0, "theta": 0.0, "v": 0.0})
    desk.ask("subscribe", {"rate": 50})
    desk.wait_for_robots("r1")
    bridge.gateway.send_signal(number)
    assert bridge.gateway.wait(15) == 0
    assert bridge.sql("select x, y from trajectories") == [(12.0, 34.0)]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_a_robot_in_good_order(start_bridge, sample_site, number):
    bridge = start_bridge(sample_site)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    robots = [
        bridge.start_robot("ws", (20.0, 20.0, 0.0)),
        bridge.start_robot("sql", (9.0, 9.0, 0.0), sql=True),
    ]
    desk.wait_for_robots("ws", "sql")
    for robot in robots:
        robot.send_signal(number)
    assert [robot.wait(5) for robot in robots] == [0, 0]
    desk.until(lambda: desk.robots["ws"]["stopped"] and desk.robots["sql"]["stopped"])
