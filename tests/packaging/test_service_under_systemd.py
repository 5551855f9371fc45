"""The service under a real systemd, which is process 1 of a small world of its own."""

from __future__ import annotations

import json
import shutil
import sys
import sysconfig
from pathlib import Path

import pytest

from tests.support.systemd_world import HAS_SYSTEMD, NO_SYSTEMD, world_of

PYTHON = "/opt/robot-bridge/bin/python"
ACCOUNT = ("setpriv", "--reuid=robot-bridge", "--regid=robot-bridge", "--clear-groups")
MAPS, CAPABILITIES = "robot-bridge-maps", "SERVICE=WMS&REQUEST=GetCapabilities"
SCRIPT = Path(__file__).with_name("service_in_systemd.sh")

pytestmark = pytest.mark.skipif(not HAS_SYSTEMD, reason=NO_SYSTEMD)


@pytest.fixture(scope="module")
def world(tmp_path_factory, root):
    # The environment may lie in /tmp, of which the service sees nothing: its packages are shown elsewhere.
    python, packages = sys._base_executable, sysconfig.get_path("purelib")
    with world_of(SCRIPT, tmp_path_factory.mktemp("service"), root, python, packages) as world:
        world.until(lambda: world.fact("ActiveState") == "active", lambda: log(world))
        yield world


def log(world):
    return world.do("cat", "/var/log/robot-bridge.log")


def health(world):
    """What the gateway says of itself and its links."""
    code = "import urllib.request as u; print(u.urlopen('http://127.0.0.1:8765/healthz').read().decode())"
    return world.do(PYTHON, "-c", code)


@pytest.mark.skipif(
    shutil.which("qgis_mapserver") is None, reason="qgis-server is not installed; run: make setup"
)
def test_the_maps_are_served_beside_it_with_the_fleet(world):
    fleet, database = "/var/lib/robot-bridge/fleet.vrt", "sqlite:////var/lib/robot-bridge/fleet.db"
    views = (
        "database",
        "views",
        "--site",
        "/var/lib/robot-bridge/site",
        "--vrt",
        fleet,
        "--database",
        database,
    )
    made = world.run(*ACCOUNT, PYTHON, "-m", "robot_bridge", *views)
    assert made.returncode == 0, made.stderr
    world.do("sed", "-i", f"s|^MAPS_OPTIONS=.*|& --fleet {fleet}|", "/etc/robot-bridge/maps.env")
    world.do("systemctl", "start", MAPS)
    ask = f"import urllib.request as u; print(u.urlopen('http://127.0.0.1:8790/?{CAPABILITIES}').read().decode())"
    text = world.until(lambda: world.do(PYTHON, "-c", ask), lambda: log(world))
    assert "<Name>Robots</Name>" in text and "<Name>Orthophoto</Name>" in text
    assert world.do("ps", "-o", "user=", "-p", world.fact("MainPID", MAPS)).startswith("robot-b")
    world.do("systemctl", "stop", MAPS)
    assert (world.fact("ActiveState", MAPS), world.fact("Result", MAPS)) == ("inactive", "success")


ARCHIVE = "robot-bridge-archive"
YESTERDAY = """
import sqlite3, time
with sqlite3.connect("/var/lib/robot-bridge/fleet.db", timeout=30) as fleet:
    columns = "robot, received_at, x, y, theta, v"
    fleet.execute(f"insert into trajectories ({columns}) values ('r1', ?, 1, 2, 0, 0)", [time.time() - 86400])
"""


def test_the_days_that_are_over_are_archived_beside_the_gateway(world):
    done = world.run(*ACCOUNT, PYTHON, "-c", YESTERDAY)
    assert done.returncode == 0, done.stderr
    world.do("systemctl", "start", ARCHIVE)
    assert world.fact("Result", ARCHIVE) == "success", log(world)
    (file,) = world.do("ls", "-l", "/var/lib/robot-bridge-archive").splitlines()[1:]
    assert " robot-bridge robot-bridge " in file and file.endswith(".parquet")


LINK = "robot-bridge-link@phones"


def test_the_service_starts_comes_back_when_killed_and_ends_in_good_order(world):
    def until(condition):
        world.until(condition, lambda: log(world))

    assert world.fact("StatusText").startswith("listening on ws://127.0.0.1:8765")
    first = world.fact("MainPID")
    assert world.do("ps", "-o", "user=", "-p", first).strip().startswith("robot-b")
    # What keeps it shut in leaves it its own folder: its database is there.
    assert "fleet.db" in world.do("ls", "/var/lib/robot-bridge").split()
    world.do("kill", "-KILL", first)
    until(lambda: world.fact("ActiveState") == "active" and world.fact("MainPID") not in ("0", first))
    assert world.fact("NRestarts") == "1"
    world.do("systemctl", "reload", "robot-bridge")
    assert world.fact("ActiveState") == "active"
    world.do("systemctl", "start", LINK)
    until(lambda: '"phones"' in health(world))
    link = world.fact("MainPID", LINK)
    assert world.do("ps", "-o", "user=", "-p", link).strip().startswith("robot-b")
    world.do("kill", "-KILL", link)
    until(lambda: world.fact("MainPID", LINK) not in ("0", link))
    until(lambda: json.loads(health(world))["links"].get("phones", {}).get("ok"))
    world.do("systemctl", "stop", LINK)
    assert (world.fact("ActiveState", LINK), world.fact("Result", LINK)) == ("inactive", "success")
    world.do("systemctl", "stop", "robot-bridge")
    assert (world.fact("ActiveState"), world.fact("Result")) == ("inactive", "success")
    assert "Traceback" not in log(world)
