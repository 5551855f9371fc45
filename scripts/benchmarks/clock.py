"""Times as they are stated in the tables."""

from __future__ import annotations

import json
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple


class Times(NamedTuple):
    """Milliseconds of one thing done many times."""

    median: float
    worst: float

    def __str__(self) -> str:
        return f"{self.median:.3f}" if self.median < 10 else f"{self.median:.0f}"


def each(action: Callable[[Any], Any], things: Iterable[Any]) -> Times:
    """Return the times of ``action`` on each of ``things``, after the first, which warms up."""
    times = []
    for thing in things:
        start = time.perf_counter()
        action(thing)
        times.append((time.perf_counter() - start) * 1e3)
    return Times(statistics.median(times[1:]), max(times[1:]))


def once(action: Callable[[], Any]) -> tuple[Any, float]:
    """Return what ``action`` returns, and its seconds."""
    start = time.perf_counter()
    result = action()
    return result, time.perf_counter() - start


def megabytes() -> float:
    """Return the memory that this process has now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / 1e6


def in_a_process(code: str) -> Any:
    """Return what ``code`` prints as JSON, run by a fresh Python that sees the project."""
    root = Path(__file__).parents[2]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(root), str(root / "scripts")])}
    done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, check=True, env=environment)
    return json.loads(done.stdout)


def table(head: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """Return a Markdown table."""
    lines = [list(head)]
    lines.append(["---"] * len(lines[0]))
    lines += [[str(cell) for cell in row] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
