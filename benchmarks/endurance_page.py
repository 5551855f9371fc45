"""What the page of benchmarks says of endurance."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from statistics import median
from typing import Any

import numpy as np

from benchmarks.clock import table
from benchmarks.endurance_findings import (
    FLAT,
    HIGHER,
    KEPT_BY_PYQT,
    MEASURED,
    Run,
    Sample,
    growth,
    kept_of_a_version,
    peak,
)
from benchmarks.page import goal

ROWS = 15


def report(
    run: Run,
    minutes: float,
    wrong: Sequence[str],
    *,
    robots: int,
    raster_cache: int,
    window: tuple[int, int],
) -> str:
    """Return the part's text, with what is ``wrong``; GDAL might keep ``raster_cache`` MB of rasters."""
    seconds = minutes * 60
    begin, end = (peak(run.samples, seconds, third) for third in (0, 2))
    in_use = growth(run.samples, seconds, "in_use")
    return TEXT.format(
        width=window[0],
        height=window[1],
        robots=robots,
        every=median(later.at - one.at for one, later in pairwise(run.samples)),
        late=1000 * min(map(float, run.end["longer"])),
        minutes=minutes,
        reloads=len(run.unloaded) - 1,
        raster_cache=raster_cache,
        drops=", ".join(f"{number} × {how}" for how, number in run.drops.items()),
        table=_table(run.samples),
        counted=minutes * MEASURED,
        third=minutes / 3,
        begin=begin,
        end=end,
        peak_goal=goal(f"at most {HIGHER:g} MB more", end - begin <= HIGHER),
        in_use=in_use,
        in_use_goal=goal(f"at most {FLAT:g} MB beyond what is left open", in_use[0] - in_use[1] <= FLAT),
        blocks=growth(run.samples, seconds, "blocks"),
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
    )


def _kept_in_words(kept: float) -> str:
    if np.isnan(kept):
        return "there were too few reloads to tell what each one leaves"
    wanted = goal(f"at most {KEPT_BY_PYQT:,}", kept <= KEPT_BY_PYQT)
    return f"each reload left {kept:,.0f} pieces of Python's ({wanted})"


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
QGIS Desktop on a virtual screen of {width} × {height} with the sample project; a gateway on SQLite;
{robots} robots, each of which says where it is at a rate of its own, once a second or more often, drives
where it is sent and answers. The desk's link goes through a proxy that drops it at random moments: {drops}.
An operator works all the time: selects, draws, sends, aborts, stops everything and clears it, searches,
sorts, leafs through lists, opens each panel and dialog, replays; {reloads} times the plugin is unloaded and
loaded in the midst of it. Memory is that of the QGIS process, looked at every {every:.0f} s after Python's
garbage was collected.

{table}

Over the last {counted:.0f} of {minutes:.0f} minutes what was in use, and not free to be used again, grew by
{in_use[0]:+.0f} ± {in_use[1]:.0f} MB an hour ({in_use_goal}), and what Python had for its objects by
{blocks[0]:+,.0f} ± {blocks[1]:,.0f} pieces an hour: what comes and goes leaves it as open as that. The
process had {begin:.0f} MB at most in the first {third:.0f} minutes and {end:.0f} MB in the last
({peak_goal}): the C library keeps what was freed between two things that are still in use, so that it goes
up in steps. With the plugin unloaded {first.megabytes:.0f} MB were in use after the first time,
{first.rasters:.0f} of them GDAL's, and {last.megabytes:.0f} MB after the last, {last.rasters:.0f} of them
GDAL's; {kept}.

What may grow without being a leak:

- **Rasters that GDAL keeps.** QGIS reads the orthophoto through GDAL, which keeps blocks that it read,
  with or without this plugin, and QGIS opens the file once more for each map that it draws beside
  another. So GDAL may keep {raster_cache} MB here (`GDAL_CACHEMAX`), and whatever else grows shows.
- **Pictures of maps.** QGIS draws the map and its neighbours ahead of time: they come and go, and with
  them the figures above go up and down from one moment to the next.
- **Commands, alarms and names** as the shift goes on, each with a bound; unloading frees them.
- **Classes.** PyQt does not give back all of a class that is derived from Qt's, though no class, function
  or object of the plugin stays (`tests/plugin/test_endurance.py`).
- **Once only:** Python's table of names doubles, numpy keeps small arrays for later, Qt keeps the names
  of drawn buttons.

QGIS also leaves the mark of each layer in memory in its layer panel when such a layer goes, with or without
this plugin, and a separator in its menu of plugins: small objects for each reload and each replay.

{wrong}

The plugin told the operator of lost links and alarms, as it should: {told}.

### What holds the window up

How often the window's thread worked for longer than the table's times without looking for events, and,
where that was more than {late:.0f} ms, with what: what Qt called in the plugin, and the innermost place
that it was seen in. Time in which other programs had the processor does not count.

{busy}

{places}
"""
