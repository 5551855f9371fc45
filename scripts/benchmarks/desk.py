"""The part on the desk: the live map over orthophoto and roads, against a memory layer, in QGIS itself."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from .clock import in_a_process, table
from .page import Part

NUMBERS = (100, 1000, 10_000)
RATES = (10, 20)
POINTS = 1000
GROWTH = 15.0
"""MB in an hour that are taken for the noise of memory allocation."""

TEXT = """\
A canvas of 1280 × 800 with the drone photo of ZalaZONE's track and its 362 lanes; all robots are in view,
drive with 1.5 m/s, and tell where they are ten times a second; 3 % have fallen silent. Load of the machine:
{load}.

### What an update costs the window

Milliseconds of computing by the window's thread for each update, everything drawn: robots with heading, state
and speed, trails, names, ages; medians. *Of it the map* is what QGIS takes to put its finished map there
without any robot. *Frames* is how many such updates fit into a second. *Layer* is a hundred robots written to
the vector layer; it is written once a second, so that of twenty updates one does it with 100 robots, ten with
1 000, and all with 10 000.

{overlay}

The same robots as a memory layer, moved by `changeGeometryValues` and repainted twenty times a second,
without headings, trails and names: *cost* is what its update takes on the window's thread, *frames* how many
renderings were completed in a second.

{layer}

### Table and alarms

Milliseconds of computing by the window's thread, medians, after all robots have moved: the robot table
renewed in the order that it has, put in another order, narrowed by a search of two words, and all robots
judged for alarms. The 10 000 drive so close to one another that some hundred pairs come too close, or part,
between two looks.

{lists}

### Checks of drafts

Against 5 000 obstacles, 500 keepouts and 300 road surfaces. *Computing* is what a check takes of the window's
thread, in *slices* of which the *longest* counts for the window; milliseconds. Before each Python has looked
for garbage, which takes it 30 ms to 45 ms once in a while, whatever it comes upon.

{drafts}

### From sending to painting

A process sends every robot as a table of numbers over a WebSocket, the desk's own connection receives. The
delay is from before a message is sent until it was painted; the desk looks for news twenty times a second,
and asks a gateway for ten messages a second. *Computing* is all that the window's thread did, by
its own clock.

{live}

The same with all that stands in the QGIS window beside the map: Fleet panel with the robot table, details,
queue and logs, alarms watched, the layer of robots written.

{window}

### Memory

1 000 robots, an hour of updates once a second, with trails, names and layer: {before:.0f} MB after five
minutes, {after:.0f} MB after the hour.
"""


def measure(data: Path) -> Part:
    """Measure each in a process of its own."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    overlay = {number: _run("overlay", data, number) for number in NUMBERS}
    layer = {number: _run("layer", data, number) for number in NUMBERS}
    lists = {number: _run_lists(data, number) for number in NUMBERS}
    drafts = in_a_process(f"from benchmarks.desk_drafts import drafts\ndrafts({str(data)!r}, {POINTS})")
    live = {(number, rate): _run("live", data, number, rate) for number in NUMBERS for rate in RATES}
    window = {(number, RATES[-1]): _run_window(data, number, RATES[-1]) for number in NUMBERS}
    before, after = _run("hour", data, 1000)
    text = TEXT.format(
        load=f"{os.getloadavg()[0]:.1f}",
        overlay=_overlay(overlay),
        layer=table(
            ["robots", "cost, ms", "frames/s"],
            [[n, f"{r['ms']:.1f}", f"{r['frames']:.1f}"] for n, r in layer.items()],
        ),
        lists=table(
            ["robots", *next(iter(lists.values()))],
            [[n, *(f"{taken:.1f}" for taken in r.values())] for n, r in lists.items()],
        ),
        drafts=table(
            ["draft", "computing", "slices", "longest"],
            [[name, f"{r['ms']:.1f}", r["slices"], f"{r['longest']:.1f}"] for name, r in drafts.items()],
        ),
        live=_frames(live),
        window=_frames(window),
        before=before,
        after=after,
    )
    return Part("The live map", text, failed=after > before + GROWTH)


def _overlay(measured: dict[int, Any]) -> str:
    parts = list(next(iter(measured.values()))["parts"])
    head = ["robots", *parts, "**all**", "p99", "frames/s"]
    rows = [
        [
            n,
            *(f"{r['parts'][part]:.1f}" for part in parts),
            f"{r['ms']:.1f}",
            f"{r['p99']:.1f}",
            f"{1000 / r['ms']:.0f}",
        ]
        for n, r in measured.items()
    ]
    return table(head, rows)


def _frames(measured: dict[tuple[int, int], Any]) -> str:
    ends = ["computing, ms a frame", "delay, ms: median", "p99"]
    head = ["robots", "messages/s", "painted/s", "of them with news", *ends]
    rows = [
        [n, rate]
        + [f"{r[name]:.1f}" for name in ("frames", "new", "computing")]
        + [f"{r[name]:.0f}" for name in ("p50", "p99")]
        for (n, rate), r in measured.items()
    ]
    return table(head, rows)


def _run_window(data: Path, number: int, rate: int) -> Any:
    return in_a_process(f"from benchmarks.desk_window import live\nlive({str(data)!r}, {number}, {rate})")


def _run_lists(data: Path, number: int) -> Any:
    return in_a_process(f"from benchmarks.desk_lists import lists\nlists({str(data)!r}, {number})")


def _run(what: str, data: Path, *numbers: int) -> Any:
    given = ", ".join(map(repr, (str(data), *numbers)))
    return in_a_process(f"from benchmarks.desk_canvas import {what}\n{what}({given})")
