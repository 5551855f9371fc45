"""A real systemd, which is process 1 of a small world of its own: namespaces, on a copy of a system."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

NEEDED = ("unshare", "nsenter", "ip", "systemctl", "systemd-sysusers")
SPACES = ("--pid", "--fork", "--mount", "--uts", "--ipc", "--net", "--cgroup", "--kill-child")
HAS_SYSTEMD = os.getuid() == 0 and Path("/lib/systemd/systemd").exists() and all(map(shutil.which, NEEDED))
"""Whether worlds can be made here; ``NO_SYSTEMD`` says why not."""
NO_SYSTEMD = "needs root, systemd and util-linux"

T = TypeVar("T")


class World:
    """What is inside; ``run`` and ``do`` run a command there."""

    def __init__(self, process: subprocess.Popen[bytes], root: Path) -> None:
        self._process = process
        self._root = root

    def run(self, *words: str) -> subprocess.CompletedProcess[str]:
        pid = self._process.pid
        # --root: a namespace of mounts begins at the machine's own root folder, not at that of a chroot.
        # The namespace of processes is its child's: unshare itself stays outside.
        names = ("--mount", "--net", "--uts", "--root")
        spaces = [f"--target={pid}", *names, f"--pid=/proc/{pid}/ns/pid_for_children"]
        inside = ["nsenter", *spaces, "chroot", str(self._root), *words]
        return subprocess.run(inside, capture_output=True, text=True, check=False, timeout=900)

    def do(self, *words: str) -> str:
        """Return what a command says."""
        return self.run(*words).stdout

    def fact(self, name: str, unit: str = "robot-bridge") -> str:
        """Return a property of a service."""
        return self.do("systemctl", "show", unit, "--value", "-p", name).strip()

    def until(self, condition: Callable[[], T], log: Callable[[], str], seconds: float = 240.0) -> T:
        """Return what ``condition`` finds once it finds something; ``log`` says what came instead."""
        until = time.monotonic() + seconds
        while not (found := condition()):
            assert self._process.poll() is None, "systemd ended"
            assert time.monotonic() < until, log()
            time.sleep(0.1)
        return found


@contextmanager
def world_of(script: Path, folder: Path, *arguments: str | Path) -> Iterator[World]:
    """A world that ``script`` makes in an empty folder, given with ``arguments``; it ends with the block."""
    (place := folder / "world").mkdir()
    command = ["unshare", *SPACES, "sh", str(script), str(place), *map(str, arguments)]
    with (folder / "said").open("wb") as said:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=said, stderr=said)
    try:
        yield World(process, place / "root")
    finally:
        process.kill()
        process.wait(10)
