"""What was seen while QGIS endured, and what of it must not have been."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.clock import Growth, hourly_growth

WARM_UP = 60.0
"""Seconds that do not count."""
MEASURED = 2 / 3
"""The last part of the time, over which memory may not grow."""
FLAT = 40.0
"""MB an hour by which what is in use may grow, beyond what pictures of maps that come and go leave open."""
HIGHER = 60.0
"""MB by which the most that the process has may be higher in the last third of the time than in the first."""
FEWEST_RELOADS = 4
"""In less, nobody can tell what each one costs."""
KEPT_BY_PYQT = 3000
"""Pieces of Python's memory that each reload may cost; PyQt keeps half as many for the plugin's classes."""


@dataclass(frozen=True)
class Sample:
    """What there was ``at`` so many seconds after the begin; ``drops`` and ``reloads`` so far.

    ``megabytes`` is what the process has, ``files`` what of it is of files or shared, ``in_use`` what of the
    rest is not free to be used again, ``rasters`` what of that GDAL keeps of rasters that it read, ``blocks``
    how many pieces Python has for its objects.
    """

    at: float
    megabytes: float
    files: float
    in_use: float
    rasters: float
    blocks: int
    reloads: int
    threads: int
    python_threads: int
    items: int
    exceptions: int
    drops: int = 0


@dataclass(frozen=True)
class Unloaded:
    """What was left once the plugin was unloaded: things by name, megabytes in use, and of them GDAL's
    rasters; pieces that Python has for its objects."""

    left: list[str]
    megabytes: float
    rasters: float
    blocks: int


@dataclass(frozen=True)
class Run:
    """What was seen: samples, what was left after each unloading, what the session told at its end."""

    samples: list[Sample]
    unloaded: list[Unloaded]
    end: dict[str, Any]
    drops: dict[str, int]
    complaints: list[str]


def complaints_in(log: Path) -> list[str]:
    """Return what Qt and Python printed that is a fault: tracebacks, threads that were destroyed running."""
    words = ("Traceback", "QThread: Destroyed", "QObject::", "wrapped C/C++ object", "Segmentation")
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return [line for line in lines if any(word in line for word in words)]


def growth(samples: Sequence[Sample], seconds: float, what: str) -> Growth:
    """Return by how much ``what`` grew in an hour over the last part of the time, and the error of that.

    It is the slope of a line and its standard error: pictures of maps come and go by tens of megabytes, and
    of half an hour a slope is not known better. NaN for too few samples to tell.
    """
    begin = max(WARM_UP, seconds * (1 - MEASURED))
    counted = [sample for sample in samples if sample.at >= begin]
    return hourly_growth((one.at for one in counted), (getattr(one, what) for one in counted))


def grown(samples: Sequence[Sample], seconds: float) -> list[str]:
    """Return what of the memory grew.

    Of what the process has the peaks are held against each other: the C library keeps what was freed between
    two things that are still in use, so that it goes up in steps and hardly down.
    """
    found = []
    slope, error = growth(samples, seconds, "in_use")
    rise = peak(samples, seconds, 2) - peak(samples, seconds, 0)
    if not slope - error <= FLAT:
        found.append(f"what is in use grew by {slope:.0f} ± {error:.0f} MB an hour, {FLAT:.0f} at most")
    if not rise <= HIGHER:
        found.append(f"the process had {rise:.0f} MB more at the end than at the begin, {HIGHER:.0f} at most")
    return found


def peak(samples: Sequence[Sample], seconds: float, third: int) -> float:
    """Return the most MB that the process had in a third of the time (0, 1, 2); NaN if unknown."""
    counted = [one.megabytes for one in samples if third <= 3 * one.at / seconds < third + 1]
    return max(counted, default=float("nan"))


def kept_of_a_version(unloaded: Sequence[Unloaded]) -> float:
    """Return how many pieces of Python's memory each reload costs; NaN for too few reloads to tell.

    The median: whatever is done for the first time costs more, and only once.
    """
    more = [later.blocks - earlier.blocks for earlier, later in pairwise(unloaded)]
    return median(more) if len(more) >= FEWEST_RELOADS else float("nan")


def faults(run: Run) -> list[str]:
    """Return everything that must not have been."""
    found = [f"{number} × exception: {text}" for text, number in run.end["exceptions"].items()]
    found += [f"{number} × QGIS warned: {text}" for text, number in run.end["warnings"].items()]
    left = sorted({text for one in run.unloaded for text in one.left})
    found += [f"left after unloading: {text}" for text in left]
    kept = kept_of_a_version(run.unloaded)
    if kept > KEPT_BY_PYQT:
        found.append(f"each reload leaves {kept:,.0f} pieces of Python's memory, {KEPT_BY_PYQT:,} at most")
    return found + [f"printed: {line}" for line in dict.fromkeys(run.complaints)]
