"""An adapter as a process of its own, which a test kills and starts again."""

from __future__ import annotations

import itertools
import resource
from pathlib import Path
from subprocess import Popen

from tests.support.patience import BUSY
from tests.support.processes import Processes

RUNS = itertools.count(1)


class LinkProcess:
    """``robot-bridge link KIND`` with a file of settings.

    ``memory`` is how many bytes it may use, where a hostile peer would soon use up this computer's.
    """

    def __init__(self, processes: Processes, kind: str, file: Path, memory: int = 0) -> None:
        self._processes, self._kind, self._file, self._memory = processes, kind, file, memory
        self.name = ""
        self.process: Popen[bytes]

    def start(self) -> None:
        """Start it, with a log of its own."""
        self.name = f"{self._kind}-{next(RUNS)}"
        words = ["link", self._kind, "--config", self._file]
        self.process = self._processes.start_bridge(self.name, words)
        if self._memory:
            resource.prlimit(self.process.pid, resource.RLIMIT_AS, (self._memory, self._memory))

    def kill(self) -> None:
        """End it the way a power cut does."""
        self.process.kill()
        self.process.wait(BUSY * 5)

    def output(self) -> str:
        """Return what it has printed since it was started last."""
        return self._processes.log(self.name).read_text(encoding="utf-8")
