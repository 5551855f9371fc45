"""The part on the memory of links: an hour of ROS 2 robots and VDA 5050 vehicles, all adapters at once."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.clock import hourly_growth, spread, table
from benchmarks.link_ros2 import over_dds, over_rosbridge, publishing, rosbridge_server
from benchmarks.link_vda5050 import driving
from benchmarks.linked import Linked
from benchmarks.load import MALLOC
from benchmarks.page import Part
from benchmarks.trial import size
from tests.support.robots.ros_peer import ros_python

MINUTES = size(60.0, 0.4)
"""Without another number in the environment's MINUTES."""
ROBOTS, RATE = size((100, 2.0), (5, 2.0))
VEHICLES, VEHICLE_RATE = size(200, 5), 1.0
EVERY = size(10.0, 0.5)
"""seconds between two looks at the memory."""
MEASURED = 2 / 3
"""The last part of the time, over which memory may not grow: what is made once has been made."""
FLAT = 4.0
"""MB an hour by which a process may grow beyond the error of the slope."""
HEAD = (
    "process",
    *(f"MB, {which} sixth" for which in ("first", "2nd", "3rd", "4th", "5th", "last")),
    "largest",
    "growth, MB an hour",
)
TEXT = """\
{robots} ROS 2 robots publish Odometry at {rate:g} Hz from one rclpy node; one adapter tells a gateway of them
over DDS, a second one tells another gateway of the same robots over a rosbridge server. {vehicles} VDA 5050
vehicles tell a third gateway their state at {vehicle_rate:g} Hz through a mosquitto. An operator looks on at
each gateway. All of it runs at the same time for {minutes:g} minutes. Resident memory, looked at every
{every:g} s: medians of the sixths of the time, and the slope of a line through the last {measured:.0f}
minutes with its standard error.

{rows}

Goal: no process grows by more than {flat:g} MB an hour beyond that error, {met}. {short}
"""


class Watched(NamedTuple):
    """A link that runs, by the name that the page has for it."""

    name: str
    link: Linked


def measure(_data: Path) -> Part:
    """Let the adapters run for MINUTES of the environment, an hour without."""
    minutes = float(os.environ.get("MINUTES") or MINUTES)
    with ExitStack() as stack:
        crowd = stack.enter_context(publishing(ros_python(), ROBOTS, RATE))
        _, port = rosbridge_server(crowd)
        watched = [
            Watched("ROS 2 over DDS", stack.enter_context(over_dds())),
            Watched("ROS 2 over rosbridge", stack.enter_context(over_rosbridge(port))),
            Watched("VDA 5050", stack.enter_context(driving(VEHICLES, VEHICLE_RATE))),
        ]
        for one, expected in zip(watched, (ROBOTS, ROBOTS, VEHICLES), strict=True):
            one.link.wait_for(expected)
            one.link.look()
        times, samples = _samples(watched, 60 * minutes)
        for one, expected in zip(watched, (ROBOTS, ROBOTS, VEHICLES), strict=True):
            one.link.wait_for(expected)
    names = [f"{one.name}: {which}" for one in watched for which in ("adapter", "gateway")]
    counted = times >= times[-1] * (1 - MEASURED)
    rows, flat = [], True
    for name, megabytes in zip(names, samples.T, strict=True):
        slope, error = hourly_growth(times[counted], megabytes[counted])
        flat = flat and slope - error <= FLAT
        sixths = [f"{spread(part.tolist()).median:.1f}" for part in np.array_split(megabytes, 6)]
        rows.append([name, *sixths, f"{megabytes.max():.1f}", f"{slope:+.2f} ± {error:.2f}"])
    text = TEXT.format(
        robots=ROBOTS,
        rate=RATE,
        vehicles=VEHICLES,
        vehicle_rate=VEHICLE_RATE,
        minutes=minutes,
        every=EVERY,
        measured=minutes * MEASURED,
        rows=table(HEAD, rows),
        flat=FLAT,
        met="met" if flat else "**missed**",
        short="" if minutes >= MINUTES else f"{minutes:g} minutes say less than {MINUTES:g} do.",
    )
    return Part("Memory of links", text.strip(), failed=not flat, settings=MALLOC)


def _samples(watched: Sequence[Watched], seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times in s, and for each of them the MB of each link's adapter and gateway."""
    begin = time.monotonic()
    times: list[float] = []
    samples: list[list[float]] = []
    while (at := time.monotonic() - begin) < seconds:
        times.append(at)
        samples.append([megabytes for one in watched for megabytes in one.link.megabytes()])
        time.sleep(EVERY)
    return np.array(times), np.array(samples)
