"""What the page of benchmarks says of endurance."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from .clock import table
from .endurance_findings import MEASURED, Run, Sample, growth, kept_of_a_version, peak

ROWS = 15


def report(run: Run, minutes: float, wrong: Sequence[str], robots: int, raster_cache: int) -> str:
    """Return the part's text, with what is ``wrong``; GDAL might keep ``raster_cache`` MB of rasters."""
    return TEXT.format(
        robots=robots,
        minutes=minutes,
        reloads=len(run.unloaded) - 1,
        raster_cache=raster_cache,
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
