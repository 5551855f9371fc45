"""The service under a real systemd, which is process 1 of a small world of its own."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest

NEEDED = ("unshare", "nsenter", "ip", "systemctl", "systemd-sysusers")
SCRIPT = Path(__file__).with_name("service_in_systemd.sh")
SPACES = ("--pid", "--fork", "--mount", "--uts", "--ipc", "--net", "--cgroup", "--kill-child")

pytestmark = pytest.mark.skipif(
    os.getuid() != 0 or not Path("/lib/systemd/systemd").exists() or not all(map(shutil.which, NEEDED)),
    reason="needs root, systemd and util-linux",
)


class World:
    """What is inside; ``do`` runs a command there."""

    def __init__(self, process: subprocess.Popen[bytes], root: Path) -> None:
        self._process = process
        self._root = root

    def do(self, *words: str) -> str:
        pid = self._process.pid
        # --root: a namespace of mounts begins at the machine's own root folder, not at that of a chroot.
        # The namespace of processes is its child's: unshare itself stays outside.
        spaces = [f"--target={pid}", "--mount", "--net", "--root", f"--pid=/proc/{pid}/ns/pid_for_children"]
        inside = ["nsenter", *spaces, "chroot", str(self._root), *words]
        return subprocess.run(inside, capture_output=True, text=True, check=False, timeout=240).stdout

    def fact(self, name: str, unit: str = "robot-bridge") -> str:
        """Return a property of a service."""
        return self.do("systemctl", "show", unit, "--value", "-p", name).strip()

    def health(self) -> str:
        """Return what the gateway says of itself and its links."""
        code = "import urllib.request as u; print(u.urlopen('http://127.0.0.1:8765/healthz').read().decode())"
        return self.do("/opt/robot-bridge/bin/python", "-c", code)

    def until(self, condition, seconds: float = 60.0):
        until = time.monotonic() + seconds
        while not (found := condition()):
            assert self._process.poll() is None, "systemd ended"
            assert time.monotonic() < until, self.do("cat", "/var/log/robot-bridge.log")
            time.sleep(0.1)
        return found

    def log(self) -> str:
        return self.do("cat", "/var/log/robot-bridge.log")


@pytest.fixture
def world(tmp_path, root):
    folder = tmp_path / "world"
    folder.mkdir()
    # The environment may lie in /tmp, of which the service sees nothing: its packages are shown elsewhere.
    python, packages = sys._base_executable, sysconfig.get_path("purelib")
    command = ["unshare", *SPACES, "sh", str(SCRIPT), str(folder), str(root), python, packages]
    with (tmp_path / "said").open("wb") as said:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=said, stderr=said)
    try:
        world = World(process, folder / "root")
        world.until(lambda: world.fact("ActiveState") == "active")
        yield world
    finally:
        process.kill()
        process.wait(10)


LINK = "robot-bridge-link@phones"


def test_the_service_starts_comes_back_when_killed_and_ends_in_good_order(world):
    assert world.fact("StatusText").startswith("listening on ws://127.0.0.1:8765")
    first = world.fact("MainPID")
    assert world.do("ps", "-o", "user=", "-p", first).strip().startswith("robot-b")
    # What keeps it shut in leaves it its own folder: its database is there.
    assert "fleet.db" in world.do("ls", "/var/lib/robot-bridge").split()
    world.do("kill", "-KILL", first)
    world.until(lambda: world.fact("ActiveState") == "active" and world.fact("MainPID") not in ("0", first))
    assert world.fact("NRestarts") == "1"
    world.do("systemctl", "reload", "robot-bridge")
    assert world.fact("ActiveState") == "active"
    world.do("systemctl", "start", LINK)
    world.until(lambda: '"phones"' in world.health())
    link = world.fact("MainPID", LINK)
    assert world.do("ps", "-o", "user=", "-p", link).strip().startswith("robot-b")
    world.do("kill", "-KILL", link)
    world.until(lambda: world.fact("MainPID", LINK) not in ("0", link))
    world.until(lambda: json.loads(world.health())["links"].get("phones", {}).get("ok"))
    world.do("systemctl", "stop", LINK)
    assert (world.fact("ActiveState", LINK), world.fact("Result", LINK)) == ("inactive", "success")
    world.do("systemctl", "stop", "robot-bridge")
    assert (world.fact("ActiveState"), world.fact("Result")) == ("inactive", "success")
    assert "Traceback" not in world.log()
