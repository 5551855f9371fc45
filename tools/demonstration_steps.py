"""Steps of a demonstration: printed and written down as they happen, and waited for."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from tests.support.errors import StageError
from tests.support.patience import BUSY
from tests.support.processes import Processes

PATIENCE_S, PAUSE_S = 20 * BUSY, 0.2
"""seconds that a step is waited for, and between two looks."""


class DemonstrationSteps:
    """What has happened so far, in the file ``steps.txt`` of ``folder``, with seconds since the beginning."""

    def __init__(self, folder: Path, processes: Processes) -> None:
        self._file = folder / "steps.txt"
        self._processes = processes
        self._began = time.monotonic()
        self._lines: list[str] = []

    def happened(self, text: str) -> None:
        """Print and keep that a step has happened."""
        line = f"{time.monotonic() - self._began:6.1f} s  {text}"
        self._lines.append(line)
        print(line, flush=True)
        self._file.write_text("\n".join(self._lines) + "\n", encoding="utf-8")

    def wait(self, what: str, condition: Callable[[], bool]) -> None:
        """Wait until ``condition`` holds.

        :raises StageError: when it does not, or a program has ended meanwhile.
        """
        until = time.monotonic() + PATIENCE_S
        while not condition():
            self._processes.require_running()
            if time.monotonic() > until:
                raise StageError(f"{what} did not come about")
            time.sleep(PAUSE_S)
