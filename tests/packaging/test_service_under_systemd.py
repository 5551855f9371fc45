"""The service under a real systemd, which is process 1 of a small world of its own."""

from __future__ import annotations

import json
import sys
import sysconfig
from pathlib import Path

import pytest

from tests.support.systemd_world import HAS_SYSTEMD, NO_SYSTEMD, world_of

SCRIPT = Path(__file__).with_name("service_in_systemd.sh")

pytestmark = pytest.mark.skipif(not HAS_SYSTEMD, reason=NO_SYSTEMD)


@pytest.fixture
def world(tmp_path, root):
    # The environment may lie in /tmp, of which the service sees nothing: its packages are shown elsewhere.
    python, packages = sys._base_executable, sysconfig.get_path("purelib")
    with world_of(SCRIPT, tmp_path, root, python, packages) as world:
        world.until(lambda: world.fact("ActiveState") == "active", lambda: log(world))
        yield world


def log(world):
    return world.do("cat", "/var/log/robot-bridge.log")


def health(world):
    """What the gateway says of itself and its links."""
    code = "import urllib.request as u; print(u.urlopen('http://127.0.0.1:8765/healthz').read().decode())"
    return world.do("/opt/robot-bridge/bin/python", "-c", code)


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
