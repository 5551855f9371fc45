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
from pathlib import Path
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
FLAT = 60.0
"""MB an hour that are taken for noise."""
ROWS = 15


@dataclass(frozen=True)
class Sample:
    """What there was ``at`` so many seconds after the begin; ``drops`` and ``reloads`` so far.

    ``megabytes`` is what the process has, ``in_use`` what of it is not free to be used again,
    ``blocks`` how many pieces of it Python has for its objects.
    """

    at: float
    megabytes: float
    in_use: float
    blocks: int
    reloads: int
    threads: int
    python_threads: int
    items: int
    exceptions: int
    drops: int = 0


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
    left: list[list[str]]
    after_unloading: list[float]
    end: dict[str, Any]
    drops: dict[str, int]
    complaints: list[str]


def measure(_data: Path) -> Part:
    """Let it run for MINUTES of the environment, half an hour without."""
    minutes = float(os.environ.get("MINUTES") or MINUTES)
    run = endure(minutes * 60, reloads_in(minutes * 60))
    slope = growth(run.samples, minutes * 60, "megabytes")
    return Part("Endurance", report(run, minutes), failed=bool(faults(run)) or slope > FLAT)


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
        qgis = start_qgis(processes, Profile(folder / "profile", link=False), SESSION, told, display)
        with BadNetwork(proxy, pauses) as network:
            entries = follow(processes, qgis, Path(str(told["journal"])), seconds + ENOUGH)
            samples, left, after, end = _watched(entries, network)
        complaints = complaints_in(processes.log("qgis"))
    return Run(samples, left, after, end, network.drops, complaints)


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
) -> tuple[list[Sample], list[list[str]], list[float], dict[str, Any]]:
    samples: list[Sample] = []
    left: list[list[str]] = []
    after: list[float] = []
    end: dict[str, Any] = {}
    for entry in entries:
        figures = entry["figures"]
        if entry["step"] == "sample":
            samples.append(Sample(**figures, drops=sum(network.drops.values())))
            print(samples[-1], file=sys.stderr, flush=True)
        elif entry["step"] == "unloaded":
            left.append(figures["left"])
            after.append(figures["megabytes"])
            print(entry["text"], file=sys.stderr, flush=True)
        else:
            end = figures
    return samples, left, after, end


def complaints_in(log: Path) -> list[str]:
    """Return what Qt and Python printed that is a fault: tracebacks, threads that were destroyed running."""
    words = ("Traceback", "QThread: Destroyed", "QObject::", "wrapped C/C++ object", "Segmentation")
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return [line for line in lines if any(word in line for word in words)]


def growth(samples: Sequence[Sample], seconds: float, what: str) -> float:
    """Return by how much ``what`` grew in an hour over the last part of the time: the slope of a line."""
    begin = max(WARM_UP, seconds * (1 - MEASURED))
    counted = [(sample.at / 3600, getattr(sample, what)) for sample in samples if sample.at >= begin]
    if len(counted) < 3:
        return float("nan")
    hours, values = np.array(counted).T
    return float(np.polyfit(hours, values, 1)[0])


def faults(run: Run) -> list[str]:
    """Return everything that must not have been."""
    found = [f"{number} × exception: {text}" for text, number in run.end["exceptions"].items()]
    found += [f"{number} × QGIS warned: {text}" for text, number in run.end["warnings"].items()]
    found += [f"left after unloading: {text}" for text in sorted({one for left in run.left for one in left})]
    return found + [f"printed: {line}" for line in dict.fromkeys(run.complaints)]


def report(run: Run, minutes: float) -> str:
    """Return the part's text."""
    wrong = faults(run)
    return TEXT.format(
        robots=ROBOTS,
        minutes=minutes,
        reloads=len(run.left) - 1,
        drops=", ".join(f"{number} × {how}" for how, number in run.drops.items()),
        table=_table(run.samples),
        last=minutes * MEASURED,
        **{what: growth(run.samples, minutes * 60, what) for what in ("megabytes", "in_use", "blocks")},
        first_unloaded=run.after_unloading[0],
        last_unloaded=run.after_unloading[-1],
        wrong="Wrong in all of this: nothing."
        if not wrong
        else "Wrong:\n\n" + "\n".join(f"- {w}" for w in wrong),
        told=", ".join(f"{number} × {level}" for level, number in sorted(run.end["told"].items()))
        or "nothing",
        busy=_busy(run.end),
        places=_places(run.end),
        load=os.getloadavg()[0],
    )


def _table(samples: Sequence[Sample]) -> str:
    chosen = samples[:: max(1, len(samples) // ROWS)]
    head = [
        "minute",
        "memory, MB",
        "of it in use",
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
                f"{one.in_use:.0f}",
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

Over the last {last:.0f} of {minutes:.0f} minutes the process grew by {megabytes:+.0f} MB an hour; what was in
use of it, and not free to be used again, by {in_use:+.0f} MB an hour, and what Python had for its objects by
{blocks:+,.0f} pieces an hour. With the plugin unloaded {first_unloaded:.0f} MB were in use after the first
time and {last_unloaded:.0f} MB after the last, with maps drawn and pictures forgotten. Loading and unloading
alone, without a link, costs 0.1 MB and 1 300 pieces each time, though no class, function or object of the
plugin stays (`tests/plugin/desk/test_reloads.py`): PyQt does not give back all of a class that is derived
from Qt's. Another 0.4 MB is Qt's cache of pictures, which ends at 10 MB.

{wrong}

The plugin told the operator of lost links and alarms, as it should: {told}.

### What holds the window up

How often the window's thread worked for longer than 10 ms without looking for events, and with what: what Qt
called in the plugin, and the innermost place that it was seen in. Time in which other programs had the
processor does not count.

{busy}

{places}
"""
