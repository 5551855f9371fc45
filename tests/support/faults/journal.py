"""What robots write down before they do it; it outlives the process that wrote it."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any


class Journal:
    """A file of JSON lines that only grows. Each is one write: a killed process leaves whole lines."""

    def __init__(self, file: Path, **always: Any) -> None:
        self._always = always
        self._file = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)

    def note(self, robot: str, what: str, **details: Any) -> None:
        """Write one line."""
        line = {"at": time.time(), "robot": robot, "what": what, **self._always, **details}
        os.write(self._file, json.dumps(line).encode() + b"\n")


def entries(file: Path) -> Iterator[dict[str, Any]]:
    """Yield what was written so far, oldest first."""
    if file.is_file():
        for line in file.read_bytes().splitlines():
            yield json.loads(line)
