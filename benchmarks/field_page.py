"""The part on the field page: what many robots cost a phone, in frames, in processor time and in data."""

from __future__ import annotations

import tempfile
import threading
import time
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from benchmarks.clock import table
from benchmarks.page import Part, goal
from benchmarks.swarm_link import LinkRobots
from benchmarks.trial import size
from tests.support.fleet import SITE, serve
from tests.support.phone import PHONE, chromium
from tests.support.processes import Processes

NUMBERS = size((10, 100, 1000), (5, 50))
SETTLED, MEASURED = size((40.0, 60.0), (3.0, 4.0))
"""seconds until the page has found its rate, and those that are counted."""
DATA_KB = 1000.0
COUNT_FRAMES = Path(__file__).with_name("count_frames.js")
TEXT = """\
A gateway of its own process, robots that all drive and tell where they are once a second over one link, and
the page in a headless Chromium of a phone's size and touch, with software rendering, {wide} × {high} points
at a density of {dense}, all robots in view. The page asks for positions once a second and less often where
they take more than its budget; it has {settled:g} s to find that, then {measured:g} s are counted. *Frames*
are drawings of all robots; *script* and *all* are what the page's main thread computed, of the wall's clock.

{table}

The most data a minute: {largest:.0f} kB ({goal}).
"""


class Seen(NamedTuple):
    """What the page did with so many robots; seconds of the main thread for each second."""

    robots: int
    frames: float
    script: float
    busy: float
    kilobytes: float
    positions: float


def measure(_data: Path) -> Part:
    """Watch robots on the page."""
    seen = [_watch(number) for number in NUMBERS]
    head = ["robots", "frames a second", "positions a second", "script, %", "all, %", "kB a minute"]
    rows = [
        [
            f"{one.robots}",
            f"{one.frames:.2f}",
            f"{one.positions:.2f}",
            f"{100 * one.script:.1f}",
            f"{100 * one.busy:.1f}",
            f"{one.kilobytes:.0f}",
        ]
        for one in seen
    ]
    largest = max(one.kilobytes for one in seen)
    text = TEXT.format(
        wide=PHONE["viewport"]["width"],
        high=PHONE["viewport"]["height"],
        dense=PHONE["device_scale_factor"],
        settled=SETTLED,
        measured=MEASURED,
        table=table(head, rows),
        largest=largest,
        goal=goal(f"at most {DATA_KB:g} kB", largest <= DATA_KB),
    )
    return Part("The field page", text)


def _watch(number: int) -> Seen:
    with tempfile.TemporaryDirectory() as folder, Processes(Path(folder) / "logs") as processes:
        served = serve(processes, SITE, f"sqlite:///{folder}/fleet.db")
        robots = LinkRobots({"robots": number, "host": "127.0.0.1", "port": served.port})
        robots.arrive()
        seconds = SETTLED + MEASURED + 15
        driving = threading.Thread(
            target=robots.drive, args=(time.monotonic(), seconds, 1.0, 0.0), daemon=True
        )
        driving.start()
        with chromium() as browser:
            seen = _count(browser, f"http://{urlsplit(served.address).netloc}/field", number)
        driving.join()
    return seen


def _count(browser: Any, address: str, number: int) -> Seen:
    page = browser.new_context(**PHONE).new_page()
    page.add_init_script(path=COUNT_FRAMES)
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable")
    frames: list[int] = []
    tables: list[float] = []
    page.on("websocket", lambda socket: socket.on("framereceived", lambda told: _note(told, frames, tables)))
    page.goto(address)
    page.locator("#connection.up").wait_for()
    page.wait_for_timeout(SETTLED * 1000)
    before, at = _figures(page, session), time.perf_counter()
    data, positions = sum(frames), len(tables)
    page.wait_for_timeout(MEASURED * 1000)
    after, took = _figures(page, session), time.perf_counter() - at
    rates = [(later - earlier) / took for earlier, later in zip(before, after, strict=True)]
    return Seen(number, *rates, (sum(frames) - data) / 1000 * 60 / took, (len(tables) - positions) / took)


def _note(told: Any, frames: list[int], tables: list[float]) -> None:
    frames.append(len(told))
    if isinstance(told, bytes):
        tables.append(time.perf_counter())


def _figures(page: Any, session: Any) -> tuple[float, float, float]:
    """Return how many frames were drawn, and the seconds of scripts and of all tasks of the main thread."""
    told = {one["name"]: one["value"] for one in session.send("Performance.getMetrics")["metrics"]}
    return page.evaluate("window.fleetFrames"), told["ScriptDuration"], told["TaskDuration"]
