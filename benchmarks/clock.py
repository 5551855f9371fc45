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

import numpy as np

FEW = 10
"""Below so many runs the least and the most are stated, from there on the quartiles."""


class Spread(NamedTuple):
    """What some runs of the same came to: the median, and in between which values most of them lie."""

    median: float
    low: float
    high: float

    def __format__(self, spec: str) -> str:
        return f"{self.median:{spec}} [{self.low:{spec}}–{self.high:{spec}}]"

    def scaled(self, factor: float) -> Spread:
        """Return the same in another unit."""
        return Spread(*(factor * value for value in self))


def spread(values: Iterable[float]) -> Spread:
    """Return the median of ``values`` with the quartiles, of few values with the least and the most."""
    found = sorted(values)
    if len(found) < FEW:
        return Spread(statistics.median(found), found[0], found[-1])
    low, middle, high = statistics.quantiles(found, n=4, method="inclusive")
    return Spread(middle, low, high)


class Growth(NamedTuple):
    """The slope of a line through values, in an hour, and its standard error; NaN for too few to tell."""

    slope: float
    error: float


def hourly_growth(seconds: Iterable[float], values: Iterable[float]) -> Growth:
    """Return by how much ``values``, seen after so many ``seconds``, grew in an hour."""
    hours, found = np.array([*seconds]) / 3600, np.array([*values])
    if len(found) < 3:
        return Growth(float("nan"), float("nan"))
    line, covariance = np.polyfit(hours, found, 1, cov=True)
    return Growth(float(line[0]), float(np.sqrt(covariance[0, 0])))


class Times(NamedTuple):
    """Milliseconds of one thing done many times."""

    spread: Spread
    worst: float

    @property
    def median(self) -> float:
        """The median."""
        return self.spread.median

    def __str__(self) -> str:
        return f"{self.spread:.3f}" if self.median < 10 else f"{self.spread:.0f}"


Clock = Callable[[], float]


def with_children() -> float:
    """Return the seconds of processor time of this process and of those that it started and that ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def each(action: Callable[[Any], Any], things: Iterable[Any], clock: Clock = time.process_time) -> Times:
    """Return the processor times of ``action`` on each of ``things``, after the first, which warms up.

    What other programs do at the same time hardly counts.
    """
    times = []
    for thing in things:
        start = clock()
        action(thing)
        times.append((clock() - start) * 1e3)
    return Times(spread(times[1:]), max(times[1:]))


def once(action: Callable[[], Any]) -> tuple[Any, float]:
    """Return what ``action`` returns, and its seconds of processor time."""
    start = time.process_time()
    result = action()
    return result, time.process_time() - start


def again(action: Callable[[], Any], runs: int) -> tuple[Any, Spread]:
    """Return what ``action`` returns, and its seconds of processor time in so many runs."""
    times = []
    for _ in range(runs):
        result = None
        result, seconds = once(action)
        times.append(seconds)
    return result, spread(times)


def megabytes() -> float:
    """Return the memory that this process has now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / 1e6


def in_a_process(code: str) -> Any:
    """Return what ``code`` prints as JSON, run by a fresh Python that sees the project."""
    root = str(Path(__file__).parents[1])
    environment = {**os.environ, "PYTHONPATH": root}
    done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, check=True, env=environment)
    return json.loads(done.stdout)


def table(head: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """Return a Markdown table."""
    lines = [list(head)]
    lines.append(["---"] * len(lines[0]))
    lines += [[str(cell) for cell in row] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
