"""The part on the desk: the live map over orthophoto and roads, against a memory layer, in QGIS itself."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from benchmarks import desk_canvas, desk_drafts, desk_fleet
from benchmarks.clock import Spread, in_a_process, table
from benchmarks.page import Part, goal
from benchmarks.trial import size
from robot_bridge.core.messages.positions import MOST_IN_VIEW

NUMBERS = size((100, 1000, 10_000), (100,))
MOST_SHOWN = size(MOST_IN_VIEW, 200)
"""robots in view up to which a gateway tells of each, and in a fleet up to which the panel asks for all."""
DENSE = 21_000
"""robots on a square of which the canvas shows a part."""
RATES = size((10, 20), (20,))
POINTS = size(1000, 100)
FEW_ROBOTS = size(1000, 50)
GROWTH = 15.0
"""MB in an hour that are taken for the noise of memory allocation."""

TEXT = """\
A canvas of {width} × {height} with the drone photo of ZalaZONE's track and its {lanes} lanes; all robots
are in view, drive with {speed:g} m/s, and tell where they are {told:g} times a second; {silent:.0f} % have
fallen silent. Computing is processor time; what is counted a second and the delays go by the wall's clock,
and are worse where the machine has other things to do.

### What an update costs the window

Milliseconds of computing by the window's thread for each of {updates} updates, everything drawn: robots
with heading, state and speed, trails, names, ages. *Of it the map* is what QGIS takes to put its finished
map there without any robot. *Frames* is how many such updates fit into a second. *Layer* is up to {at_once}
robots written to the vector layer, which has them all already; each robot is written once a second, so that
the more there are, the more of the updates write.

{overlay}

A fleet of more than {most_shown} robots is told of by view, and more than {most_shown} robots in a view as a
density: {inside} robots on the canvas are taken in, prepared and painted in {density:.1f} ms. So the row of
{last} is of robots that are told of one by one all the same, as by a gateway that knows no views.

The same robots as a memory layer, moved by `changeGeometryValues` and repainted {memory_rate:.0f} times a
second, without headings, trails and names: *cost* is what its update takes on the window's thread, *frames*
how many renderings were completed in a second, in {rounds} rounds of {seconds:g} s.

{layer}

### Table and alarms

Milliseconds of computing by the window's thread after all robots have moved: the robot table renewed in the
order that it has, put in another order, narrowed by a search of some words, and all robots judged for
alarms. All robots are on the same ground: the more there are, the more pairs come too close, or part,
between two looks.

{lists}

### Checks of drafts

Against {obstacles} obstacles, {keepouts} keepouts and {surfaces} road surfaces, each kind of draft {runs}
times. *Computing* is what a check takes of the window's thread, in *slices* of which the *longest* counts
for the window; milliseconds. A slice begins nothing new after {slice:g} ms. Before each check Python has
looked for garbage: that takes it {garbage:.0f} ms, and would count to whatever it comes upon.

{drafts}

### From sending to painting

A process sends every robot as a table of numbers over a WebSocket, the desk's own connection receives. The
delay is from before a message is sent until it was painted; the desk looks for news every {pull:g} ms, and
asks a gateway for {asked:g} messages a second. *Computing* is all that the window's thread did, by its own
clock. Each row is of {rounds} rounds of {seconds:g} s.

{live}

The same with all that stands in the QGIS window beside the map: Fleet panel with the robot table, details,
queue and logs, alarms watched, the layer of robots written.

{window}

### Memory

{few} robots, {updates_of_hour} updates, one a second by the desk's clock, with trails, names and layer:
{before:.0f} MB after the first {settled}, {after:.0f} MB after the last ({goal}).
"""

PLUGIN_CONSTANTS = """
import json
import pyogrio
from tools.plugin_files import register_plugin
register_plugin()
from fleet_supervisor.plugin.gateway_client.connection import ConnectionThread
from fleet_supervisor.plugin.ui.scheduling import PULL_EVERY_MS
from fleet_supervisor.plugin.map.reported_layers import AT_ONCE
from fleet_supervisor.plugin.ui.scheduling import SLICE_SECONDS
lanes = pyogrio.read_info({lanes!r}, layer="lanes")["features"]
slice_ms = 1000 * SLICE_SECONDS
told = dict(asked=ConnectionThread().rate, pull=PULL_EVERY_MS, at_once=AT_ONCE, slice=slice_ms, lanes=lanes)
print(json.dumps(told))
"""


def measure(data: Path) -> Part:
    """Measure each in a process of its own."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    overlay = {number: _run("overlay", data, number) for number in sorted({*NUMBERS, MOST_SHOWN})}
    density = _run("density", data, DENSE)
    layer = {number: _run("layer", data, number) for number in NUMBERS}
    lists = {number: _run_lists(data, number) for number in NUMBERS}
    drafts = in_a_process(f"from benchmarks.desk_drafts import drafts\ndrafts({str(data)!r}, {POINTS})")
    live = {(number, rate): _run("live", data, number, rate) for number in NUMBERS for rate in RATES}
    window = {(number, RATES[-1]): _run_window(data, number, RATES[-1]) for number in NUMBERS}
    before, after = _run("hour", data, FEW_ROBOTS)
    text = TEXT.format(
        **_constants(data),
        overlay=_overlay(overlay),
        **{"most_shown": MOST_SHOWN, "inside": density["inside"], "last": NUMBERS[-1]},
        density=Spread(*density["ms"]),
        layer=table(
            ["robots", "cost, ms", "frames/s"],
            [[n, *(f"{Spread(*r[name]):.1f}" for name in ("ms", "frames"))] for n, r in layer.items()],
        ),
        lists=table(
            ["robots", *next(iter(lists.values()))],
            [[n, *(f"{Spread(*taken):.1f}" for taken in r.values())] for n, r in lists.items()],
        ),
        drafts=_drafts(drafts["rows"]),
        garbage=Spread(*drafts["garbage"]),
        live=_frames(live),
        window=_frames(window),
        before=before,
        after=after,
        goal=goal(f"at most {GROWTH:g} MB more", after <= before + GROWTH),
    )
    return Part("The live map", text, failed=after > before + GROWTH)


def _constants(data: Path) -> dict[str, Any]:
    """Return what the page says of how it was measured, as the run has it."""
    lanes = str(data / "zalazone" / "zalazone_lanelets_utm33.gpkg")
    return {
        **in_a_process(PLUGIN_CONSTANTS.format(lanes=lanes)),
        "width": desk_canvas.WINDOW[0],
        "height": desk_canvas.WINDOW[1],
        "updates": desk_canvas.UPDATES,
        "memory_rate": 1 / desk_canvas.FRAME_S,
        "rounds": desk_canvas.ROUNDS,
        "seconds": desk_canvas.SECONDS,
        "updates_of_hour": desk_canvas.HOUR,
        "settled": desk_canvas.SETTLED,
        "speed": desk_fleet.SPEED,
        "told": 1 / desk_canvas.UPDATE_S,
        "silent": 100 * desk_fleet.SILENT,
        "obstacles": desk_drafts.LAYERS["obstacle"][0],
        "keepouts": desk_drafts.LAYERS["keepout"][0],
        "surfaces": desk_drafts.LAYERS["road_surface"][0],
        "runs": desk_drafts.RUNS,
        "few": FEW_ROBOTS,
    }


def _overlay(measured: dict[int, Any]) -> str:
    parts = list(next(iter(measured.values()))["parts"])
    head = ["robots", *parts, "**all**", "p99", "frames/s"]
    rows = [
        [
            n,
            *(f"{Spread(*r['parts'][part]):.1f}" for part in parts),
            f"{Spread(*r['ms']):.1f}",
            f"{r['p99']:.1f}",
            f"{1000 / r['ms'][0]:.0f}",
        ]
        for n, r in measured.items()
    ]
    return table(head, rows)


def _drafts(measured: dict[str, Any]) -> str:
    rows = [
        [name, f"{Spread(*r['ms']):.1f}", r["slices"], f"{Spread(*r['longest']):.1f}"]
        for name, r in measured.items()
    ]
    return table(["draft", "computing", "slices, at most", "longest"], rows)


def _frames(measured: dict[tuple[int, int], Any]) -> str:
    ends = ["computing, ms a frame", "delay, ms: median", "p99"]
    head = ["robots", "messages/s", "painted/s", "of them with news", *ends]
    rows = [
        [n, rate]
        + [f"{Spread(*r[name]):.1f}" for name in ("frames", "new", "computing")]
        + [f"{Spread(*r['p50']):.0f}", f"{r['p99']:.0f}"]
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
