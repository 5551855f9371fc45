"""The part on endurance: a shift of half an hour with a crowd of robots, a bad network and a plugin that is
reloaded again and again, in QGIS Desktop itself."""

from __future__ import annotations

import os
import random
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from plugin_files import ROOT
from stage.faults.proxy import Proxy
from stage.fleet import PROJECT
from stage.processes import Processes
from stage.qgis import Profile, virtual_screen
from stage.session import follow, start_qgis

from robot_bridge.sites.publication import read_site

from .clock import table
from .load import MALLOC, SITE, site_with_room
from .page import Part

HERE = Path(__file__).parent
SESSION = "endurance/session.py"
FOLDER = ROOT / "build" / "endurance"
MINUTES = 30.0
"""Without another number in the environment's MINUTES."""
RELOADS = 20
SHORTEST_SHIFT = 45.0
"""Seconds: in less no operator does all there is to do, and fewer reloads are made."""
ROBOTS = 1000
WINDOW = (1280, 800)
EXTENT = (0.0, 0.0, 200.0, 160.0)
ENOUGH = 300.0
"""Seconds for a busy machine to begin and to end."""
PAUSES = (5.0, 40.0)
"""The least and the most seconds between two drops of the link."""
SEED = 6
WARM_UP = 60.0
"""Seconds that do not count."""
MEASURED = 2 / 3
"""The last part of the time, over which memory may not grow."""
FLAT = 40.0
"""MB an hour by which what is in use may grow, beyond what pictures of maps that come and go leave open."""
HIGHER = 60.0
"""MB by which the most that the process has may be higher in the last third of the time than in the first."""
RASTER_CACHE = 16
"""MB of rasters that GDAL may keep in QGIS: unbounded, it goes on filling for as long as the run takes."""
FEWEST_RELOADS = 4
"""In less, nobody can tell what each one costs."""
KEPT_BY_PYQT = 3000
"""Pieces of Python's memory that each reload may cost; PyQt keeps half as many for the plugin's classes."""
ROWS = 15


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


class BadNetwork:
    """Drops the link that leads through ``proxy``, in three ways, until it is ended.

    ``pauses`` are the least and the most seconds between two drops.
    """

    def __init__(self, proxy: Proxy, pauses: tuple[float, float] = PAUSES) -> None:
        self._proxy, self._pauses, self._chance = proxy, pauses, random.Random(SEED)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bad network")
        self.drops = {"reset": 0, "cable pulled": 0, "gateway out of reach": 0}

    def __enter__(self) -> BadNetwork:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ended.wait(self._chance.uniform(*self._pauses)):
            how = self._chance.choice(list(self.drops))
            self.drops[how] += 1
            if how == "cable pulled":
                self._proxy.stall()
                self._ended.wait(self._chance.uniform(1.0, 9.0))
            else:
                self._proxy.refuse()
                self._ended.wait(0.1 if how == "reset" else self._chance.uniform(1.0, 6.0))
            self._proxy.forward()


@dataclass(frozen=True)
class Run:
    """What was seen: samples, what was left after each unloading, what the session told at its end."""

    samples: list[Sample]
    unloaded: list[Unloaded]
    end: dict[str, Any]
    drops: dict[str, int]
    complaints: list[str]


def measure(_data: Path) -> Part:
    """Let it run for MINUTES of the environment, half an hour without."""
    minutes = float(os.environ.get("MINUTES") or MINUTES)
    run = endure(minutes * 60, reloads_in(minutes * 60))
    wrong = [*faults(run), *grown(run.samples, minutes * 60)]
    return Part("Endurance", report(run, minutes, wrong), failed=bool(wrong))


def reloads_in(seconds: float) -> int:
    """Return how often the plugin is reloaded."""
    return max(1, min(RELOADS, int(seconds / SHORTEST_SHIFT) - 1))


def endure(
    seconds: float,
    reloads: int,
    robots: int = ROBOTS,
    pauses: tuple[float, float] = PAUSES,
    folder: Path = FOLDER,
) -> Run:
    """Run gateway, robots, network and QGIS, with all their files in ``folder``, and return what was seen.

    :raises StageError: when something does not come up, or QGIS does not come to its end.
    """
    with _stage(folder, robots) as (processes, proxy):
        told = plan(folder, proxy.port, seconds, reloads, robots)
        display = virtual_screen(processes, *WINDOW)
        profile, settings = Profile(folder / "profile", link=False), {"GDAL_CACHEMAX": str(RASTER_CACHE)}
        qgis = start_qgis(processes, profile, SESSION, told, display, settings=settings)
        with BadNetwork(proxy, pauses) as network:
            entries = follow(processes, qgis, Path(str(told["journal"])), seconds + ENOUGH)
            samples, unloaded, end = _watched(entries, network)
        complaints = complaints_in(processes.log("qgis"))
    return Run(samples, unloaded, end, network.drops, complaints)


@contextmanager
def _stage(folder: Path, robots: int) -> Iterator[tuple[Processes, Proxy]]:
    folder.mkdir(parents=True, exist_ok=True)
    for file in folder.glob("fleet.db*"):
        file.unlink()
    with Processes(folder / "logs") as processes:
        options = ["--database", f"sqlite:///{folder}/fleet.db", "--port", "0"]
        command = [sys.executable, "-m", "robot_bridge", "serve", "--site", site_with_room(folder), *options]
        processes.start("gateway", command, env=MALLOC)
        port = processes.wait_for_line("gateway", r"listening on ws://\S+:(\d+)", 60).group(1)
        crowd = [sys.executable, HERE / "endurance_robots.py", "127.0.0.1", port, str(robots)]
        processes.start("robots", crowd)
        processes.wait_for_line("robots", "ready", 60)
        with Proxy(int(port)) as proxy:
            yield processes, proxy


def plan(folder: Path, port: int, seconds: float, reloads: int, robots: int) -> dict[str, object]:
    """Return what the session inside QGIS is told."""
    frame = read_site(SITE).frame
    return {
        "journal": str(folder / "journal.jsonl"),
        "project": str(PROJECT),
        "gateway": f"ws://127.0.0.1:{port}/desk",
        "operator": "endurance",
        "robots": [f"robot-{number:04d}" for number in range(robots)],
        "window": WINDOW,
        "crs": frame.crs,
        "extent": frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]])).ravel().tolist(),
        "seconds": seconds,
        "reloads": reloads,
    }


def _watched(
    entries: Iterator[dict[str, Any]], network: BadNetwork
) -> tuple[list[Sample], list[Unloaded], dict[str, Any]]:
    samples: list[Sample] = []
    unloaded: list[Unloaded] = []
    end: dict[str, Any] = {}
    for entry in entries:
        figures = entry["figures"]
        if entry["step"] == "sample":
            samples.append(Sample(**figures, drops=sum(network.drops.values())))
            print(samples[-1], file=sys.stderr, flush=True)
        elif entry["step"] == "unloaded":
            unloaded.append(Unloaded(**figures))
            print(entry["text"], file=sys.stderr, flush=True)
        else:
            end = figures
    return samples, unloaded, end


def complaints_in(log: Path) -> list[str]:
    """Return what Qt and Python printed that is a fault: tracebacks, threads that were destroyed running."""
    words = ("Traceback", "QThread: Destroyed", "QObject::", "wrapped C/C++ object", "Segmentation")
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return [line for line in lines if any(word in line for word in words)]


def growth(samples: Sequence[Sample], seconds: float, what: str) -> tuple[float, float]:
    """Return by how much ``what`` grew in an hour over the last part of the time, and the error of that.

    It is the slope of a line and its standard error: pictures of maps come and go by tens of megabytes, and
    of half an hour a slope is not known better. NaN for too few samples to tell.
    """
    begin = max(WARM_UP, seconds * (1 - MEASURED))
    counted = [(sample.at / 3600, getattr(sample, what)) for sample in samples if sample.at >= begin]
    if len(counted) < 3:
        return float("nan"), float("nan")
    hours, values = np.array(counted).T
    line, covariance = np.polyfit(hours, values, 1, cov=True)
    return float(line[0]), float(np.sqrt(covariance[0, 0]))


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


def report(run: Run, minutes: float, wrong: Sequence[str]) -> str:
    """Return the part's text, with what is ``wrong``."""
    return TEXT.format(
        robots=ROBOTS,
        minutes=minutes,
        reloads=len(run.unloaded) - 1,
        raster_cache=RASTER_CACHE,
        drops=", ".join(f"{number} × {how}" for how, number in run.drops.items()),
        table=_table(run.samples),
        counted=minutes * MEASURED,
        third=minutes / 3,
        begin=peak(run.samples, minutes * 60, 0),
        end=peak(run.samples, minutes * 60, 2),
        in_use=growth(run.samples, minutes * 60, "in_use"),
        blocks=growth(run.samples, minutes * 60, "blocks"),
        first=run.unloaded[0],
        last=run.unloaded[-1],
        kept=_kept_in_words(kept_of_a_version(run.unloaded)),
        wrong="Wrong in all of this: nothing."
        if not wrong
        else "Wrong:\n\n" + "\n".join(f"- {w}" for w in wrong),
        told=", ".join(f"{number} × {level}" for level, number in sorted(run.end["told"].items()))
        or "nothing",
        busy=_busy(run.end),
        places=_places(run.end),
        load=os.getloadavg()[0],
    )


def _kept_in_words(kept: float) -> str:
    if np.isnan(kept):
        return "there were too few reloads to tell what each one leaves"
    return f"each reload left {kept:,.0f} pieces of Python's"


def _table(samples: Sequence[Sample]) -> str:
    chosen = samples[:: max(1, len(samples) // ROWS)]
    head = [
        "minute",
        "memory, MB",
        "of it files'",
        "in use",
        "of that GDAL's",
        "links dropped",
        "reloads",
        "threads",
        "of them Python's",
        "map items",
        "exceptions",
    ]
    return table(
        head,
        [
            [
                f"{one.at / 60:.1f}",
                f"{one.megabytes:.0f}",
                f"{one.files:.0f}",
                f"{one.in_use:.0f}",
                f"{one.rasters:.0f}",
                one.drops,
                one.reloads,
                one.threads,
                one.python_threads,
                one.items,
                one.exceptions,
            ]
            for one in chosen
        ],
    )


def _busy(end: dict[str, Any]) -> str:
    minutes = end["seconds"] / 60
    steps = sorted(end["longer"].items(), key=lambda item: float(item[0]))
    return table(
        ["longer than, ms", "times a minute"],
        [[f"{float(step) * 1000:.0f}", f"{number / minutes:.1f}"] for step, number in steps],
    )


def _places(end: dict[str, Any]) -> str:
    work, number = end["work_at"], end["gaps_at"]
    worst: dict[str, float] = {}
    for gap in end["worst"]:
        worst.setdefault(gap["busy_with"], gap["worked"])
    rows = [
        [
            place,
            number[place],
            f"{1000 * work[place] / number[place]:.0f}",
            f"{1000 * worst[place]:.0f}" if place in worst else "–",
        ]
        for place in sorted(work, key=work.get, reverse=True)[:ROWS]
    ]
    return table(["busy with", "times", "ms on average", "longest, ms"], rows)


TEXT = """\
QGIS Desktop on a virtual screen of 1280 × 800 with the sample project; a gateway on SQLite; {robots} robots,
each of which says where it is between once and ten times a second, drives where it is sent and answers. The
desk's link goes through a proxy that drops it at random moments: {drops}. An operator works all the time:
selects, draws, sends, aborts, stops everything and clears it, searches, sorts, leafs through lists, opens
each panel and dialog, replays; {reloads} times the plugin is unloaded and loaded in the midst of it. Memory
is that of the QGIS process, looked at every ten seconds after Python's garbage was collected. Load of the
machine: {load:.1f}.

{table}

Over the last {counted:.0f} of {minutes:.0f} minutes what was in use, and not free to be used again, grew by
{in_use[0]:+.0f} ± {in_use[1]:.0f} MB an hour, and what Python had for its objects by {blocks[0]:+,.0f} ±
{blocks[1]:,.0f} pieces an hour: what comes and goes leaves it as open as that. The process had {begin:.0f} MB
at most in the first {third:.0f} minutes and {end:.0f} MB in the last: the C library keeps what was freed
between two things that are still in use, so that it goes up in steps. With the plugin unloaded
{first.megabytes:.0f} MB were in use after the first time, {first.rasters:.0f} of them GDAL's, and
{last.megabytes:.0f} MB after the last, {last.rasters:.0f} of them GDAL's; {kept}.

What grows, as a heap profiler tells by comparing two moments some minutes apart:

- **Rasters that GDAL keeps.** QGIS reads the orthophoto through GDAL, which keeps each block that it read
  until they take 5 % of the machine's memory, and QGIS opens the file once more for each map that it draws
  beside another. QGIS alone, without this plugin, goes from 8 MB to 39 MB in half a minute of looking about;
  while an operator works that goes on for many minutes and looks like a leak. So GDAL may keep
  {raster_cache} MB here (`GDAL_CACHEMAX`), and whatever else grows shows.
- **Pictures of maps.** QGIS draws the map and its neighbours ahead of time: up to 50 MB come and go, and with
  them the figures above go up and down from one moment to the next.
- **Commands, alarms and names** as the shift goes on: at most 2 000 commands (of 1.5 kB, of 11 kB with a path
  of 600 points), 5 000 lines of alarms (2 MB) and 600 pictures of names (6 MB); unloading frees them.
- **Classes.** PyQt does not give back all of a class that is derived from Qt's: 0.07 MB and 1 540 pieces for
  each loading of the plugin, though no class, function or object of it stays
  (`tests/plugin/desk/test_reloads.py`).
- **Once only:** Python's table of names doubles (2 MB), numpy keeps small arrays for later (1 MB), Qt keeps
  the names of drawn buttons (0.3 MB).

QGIS 3.22 also leaves the mark of each layer in memory in its layer panel when such a layer goes, with or
without this plugin, and a separator in its menu of plugins: small objects for each reload and each replay,
and up to 0.1 MB for each attribute table, each round of dialogs and each look into its locator.

{wrong}

The plugin told the operator of lost links and alarms, as it should: {told}.

### What holds the window up

How often the window's thread worked for longer than 10 ms without looking for events, and with what: what Qt
called in the plugin, and the innermost place that it was seen in. Time in which other programs had the
processor does not count.

{busy}

{places}
"""
