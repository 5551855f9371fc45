"""Six recorded cars, played: how far what a desk sees is off the recording's own time."""

from __future__ import annotations

import asyncio
import csv
import gzip
import math
import time
from collections import defaultdict
from pathlib import Path

import numpy as np

from benchmarks.clock import table
from benchmarks.linked import COME_WITHIN, PROBING, Linked, NotMeasuredError, linked
from benchmarks.load import SITE
from benchmarks.raw_websocket import BINARY, Stream, call, connect
from benchmarks.trial import size
from robot_bridge.core.messages.positions import PositionForm
from robot_bridge.core.position_frame import split_frame
from robot_bridge.core.sites.settings import read_settings
from robot_bridge.links.replay.adapter import LEAST_STEP

FILE = "trajectories/openacc_zalazone_part17_6veh_10hz.csv.gz"
SPEEDS = (1.0, 10.0, 100.0)
SECONDS = size(20.0, 3.0)
"""of the wall clock; less where the recording ends before."""
COLUMNS = '{ time = "t_s", robot = "vehicle", x = "x_utm33", y = "y_utm33", v = "speed_mps" }'
"""The file as the guide on recordings reads it."""
SAME_M, LEAST_MPS = 0.02, 2.0
"""metres within which a place is one of the recording's; cars that stand are everywhere at once."""
HEAD = ("speed", "cars", "places seen", "error in time, ms: median", "p99", "largest", "played/wall")
"""of the wall clock."""
TEXT = """\
### Recordings

The cars of OpenACC, {cars} of them and {length:.0f} s, played onto a gateway and seen by a desk at
{desk:g} Hz. Each place that is seen is looked up in the recording, which says when it was; the error is how
much later it is seen than the one that was seen soonest for its time, in milliseconds of the wall clock. Cars
slower than {slow:g} m/s are left out: a place of theirs has no time of its own. The last column is the
recording's time that passed over the time that passed, by a line through all that was seen, over the speed
asked for: one where it neither falls behind nor runs ahead. At most every {step:g} s a position is told.

{rows}
"""


Track = tuple[np.ndarray, np.ndarray]
"""Times, (n,) seconds, and places, (n, 2) metres in the site frame."""


def section(data: Path) -> str:
    """Return what was measured, as Markdown."""
    tracks = _tracks(data / FILE)
    length = max(float(times[-1]) for times, _ in tracks.values())
    rows = []
    try:
        for speed in SPEEDS:
            settings = (
                f'[frame]\ncrs = "EPSG:32633"\n[replay]\nfile = "{data / FILE}"\nspeed = {speed}\n'
                f"columns = {COLUMNS}\n"
            )
            with linked("replay", settings) as link:
                seen = asyncio.run(_seen(link, min(SECONDS, 0.9 * length / speed)))
            rows.append([f"×{speed:g}", *_judged(seen, tracks, speed)])
    except NotMeasuredError as error:
        return f"### Recordings\n\n**Not measured**: {error}"
    return TEXT.format(
        cars=len(tracks),
        length=length,
        desk=PROBING,
        slow=LEAST_MPS,
        step=LEAST_STEP,
        rows=table(HEAD, rows),
    )


def _tracks(file: Path) -> dict[str, Track]:
    site = read_settings(SITE / "site.toml")
    samples = defaultdict(list)
    with gzip.open(file, "rt", encoding="utf-8") as lines:
        for row in csv.DictReader(lines):
            if float(row["speed_mps"]) >= LEAST_MPS:
                samples[f"replay-{row['vehicle']}"].append(
                    (float(row["t_s"]), float(row["x_utm33"]), float(row["y_utm33"]))
                )
    tracks = {name: np.array(rows) for name, rows in samples.items()}
    return {name: (rows[:, 0], rows[:, 1:] - np.array(site.origin)) for name, rows in tracks.items()}


async def _seen(link: Linked, seconds: float) -> list[tuple[float, str, float, float]]:
    """Return what a desk sees: when, of which robot, and where."""
    sock = await asyncio.to_thread(connect, "127.0.0.1", link.port, "/desk", None)
    stream = await Stream.on(sock)
    wanted = {"rate": PROBING, "form": PositionForm.COLUMNS}
    stream.writer.write(call("hello", {"operator": "bench"}, 1) + call("subscribe", wanted, 2))
    seen: list[tuple[float, str, float, float]] = []
    until = math.inf
    give_up = time.monotonic() + COME_WITHIN
    while time.monotonic() < until:
        if not seen and time.monotonic() > give_up:
            raise NotMeasuredError(f"no car was seen within {COME_WITHIN:g} s")
        kind, payload = await stream.receive()
        now = time.monotonic()
        if kind != BINARY:
            continue
        frame = split_frame(bytes(payload))
        if not {"x", "y"} <= set(frame.columns):
            continue
        x, y = (frame.table[frame.columns.index(name)] for name in ("x", "y"))
        seen += [(now, *row) for row in zip(frame.robots, x.tolist(), y.tolist(), strict=True)]
        until = min(until, now + seconds)
    stream.writer.close()
    return seen


def _judged(seen: list[tuple[float, str, float, float]], tracks: dict[str, Track], speed: float) -> list[str]:
    """Return a row of the table of what was seen at ``speed``."""
    found, known = [], set()
    for at, robot, x, y in seen:
        times, places = tracks.get(robot, (np.empty(0), np.empty((0, 2))))
        if (robot, x, y) in known or not len(times):
            continue
        known.add((robot, x, y))
        off = np.hypot(places[:, 0] - x, places[:, 1] - y)
        nearest = int(off.argmin())
        if off[nearest] <= SAME_M:
            found.append((at, float(times[nearest]), robot))
    if len(found) < 10:
        raise NotMeasuredError(f"only {len(found)} of {len(seen)} places are of the recording, at ×{speed:g}")
    wall, recorded = np.array([at for at, *_ in found]), np.array([t for _, t, _ in found])
    late = wall - recorded / speed
    # A lap is driven more than once: the same place at another time is none of what is asked here.
    kept = np.abs(late - np.median(late)) < 2.0
    late = 1e3 * (late[kept] - late[kept].min())
    pace = np.polyfit(wall[kept] - wall[0], recorded[kept], 1)[0] / speed
    cars = len({robot for (_, _, robot), is_kept in zip(found, kept, strict=True) if is_kept})
    numbers = [float(np.median(late)), float(np.quantile(late, 0.99)), float(late.max())]
    return [f"{cars}", f"{int(kept.sum())}", *(f"{one:.0f}" for one in numbers), f"{pace:.4f}"]
