"""ROS 2 robots over DDS and over rosbridge, beside rclpy's own subscriber at the same time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from benchmarks.clock import table
from benchmarks.linked import HERE, PROBING, START, Linked, NotMeasuredError, linked
from benchmarks.swarm import Onlooker, cpu_seconds
from benchmarks.trial import size
from tests.support.errors import StageError
from tests.support.processes import Processes, free_port
from tests.support.robots.ros_nodes import own_domain
from tests.support.robots.ros_peer import DISTRIBUTION, ros_python
from tests.support.robots.rosbridge_peer import rosbridge_command

CROWDS = size(((200, 10.0), (1000, 1.0)), ((10, 10.0), (20, 1.0)))
SECONDS = size(30.0, 3.0)
"""of a window."""
ALL_HEARD = 0.95
"""of what is to be published that rclpy's subscriber must have heard, for the figures to say anything."""
DOMAIN = own_domain()
OVER_DDS = f"""
[ros2]
domain = {DOMAIN}
range = "localhost"
distribution = "{DISTRIBUTION}"
"""
OVER_ROSBRIDGE = """
[rosbridge]
url = "ws://127.0.0.1:{port}"
distribution = "{distribution}"
throttle_ms = 0
"""
NETWORK = {"ROS_DOMAIN_ID": str(DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
HEAD = (
    "robots, way",
    "heard/s by rclpy",
    "delay to rclpy, ms: median",
    "p99",
    "rclpy's CPU",
    "delay to the desk, ms: median",
    "p99",
    "adapter's CPU",
    "gateway's CPU",
    "rosbridge server's CPU",
)
TEXT = """\
### ROS 2

Odometry of many robots, published by one rclpy node, best effort. An adapter tells the gateway, and a desk
at {desk:g} Hz sees it: first over DDS, then over a rosbridge server (rosbridge-server-rs, CBOR, no throttle),
each with a gateway of its own, while the same node goes on publishing. A second rclpy process, which does
nothing but take the time, subscribes to the same topics all the while. Delays are from the message's stamp.
CPU is of a core; a window takes {seconds:g} s. All processes share the machine.
{busy}

{rows}

{missing}
"""


class Crowd(NamedTuple):
    """Robots that publish, and rclpy's own subscriber to them."""

    robots: int
    rate: float
    processes: Processes
    listener: Onlooker

    @property
    def name(self) -> str:
        """How the page calls it."""
        return f"{self.robots} × {self.rate:g} Hz"


def section() -> str:
    """Return what was measured, as Markdown."""
    rows: list[list[str]] = []
    starved: list[str] = []
    missing = ""
    try:
        python = ros_python()
        for robots, rate in CROWDS:
            with (
                publishing(python, robots, rate) as processes,
                _listening(python, robots) as listener,
            ):
                crowd = Crowd(robots, rate, processes, listener)
                rows.append(_dds_row(crowd))
                rows.append(_rosbridge_row(crowd))
            starved += [row[0] for row in rows[-2:] if float(row[1]) < ALL_HEARD * robots * rate]
    except (StageError, NotMeasuredError) as error:
        missing = f"**Not measured any further**: {error}"
    busy = f"It was too busy for {', '.join(starved)}: fewer came than were to." if starved else ""
    text = TEXT.format(desk=PROBING, busy=busy, seconds=SECONDS, rows=table(HEAD, rows), missing=missing)
    return text.strip()


def over_dds() -> AbstractContextManager[Linked]:
    """Run an adapter over DDS, and a gateway for it."""
    return linked("ros2", OVER_DDS)


def over_rosbridge(port: int) -> AbstractContextManager[Linked]:
    """Run an adapter to the rosbridge server at ``port``, and a gateway for it."""
    return linked("rosbridge", OVER_ROSBRIDGE.format(port=port, distribution=DISTRIBUTION))


def rosbridge_server(processes: Processes) -> tuple[int, int]:
    """Start a rosbridge server among ``processes``; return its process id and port once it listens."""
    port, name = free_port(), "rosbridge"
    server = processes.start(name, rosbridge_command(port), env=NETWORK)
    processes.wait_for_line(name, "listening", START)
    return server.pid, port


def _dds_row(crowd: Crowd) -> list[str]:
    with over_dds() as link:
        return [f"{crowd.name}, DDS", *_window(link, crowd), "–"]


def _rosbridge_row(crowd: Crowd) -> list[str]:
    server, port = rosbridge_server(crowd.processes)
    with over_rosbridge(port) as link:
        return [f"{crowd.name}, rosbridge", *_window(link, crowd, server)]


def _window(link: Linked, crowd: Crowd, *others: int) -> list[str]:
    """Return a row of the page without its name; processor time is of ``others`` too."""
    link.wait_for(crowd.robots)
    link.look()
    # What discovery still has to do is none of what positions cost.
    time.sleep(size(10.0, 1.0))
    listener = crowd.listener
    listener.tell(begin=time.monotonic(), seconds=SECONDS)
    pids = (listener.pid, *others)
    before = [cpu_seconds(pid) for pid in pids]
    window = link.window(SECONDS)
    used = [(cpu_seconds(pid) - was) / SECONDS for pid, was in zip(pids, before, strict=True)]
    own, *rest = [f"{100 * one:.0f} %" for one in used]
    heard: dict[str, Any] = listener.line()
    delays = ["–" if one is None else f"{one:.1f}" for one in heard["delays"]]
    return [f"{heard['heard'] / SECONDS:.0f}", *delays, own, *window.row(), *rest]


@contextmanager
def publishing(python: Path, robots: int, rate: float) -> Iterator[Processes]:
    """Let so many robots of one rclpy node publish, among the processes that are returned."""
    with TemporaryDirectory() as folder, Processes(Path(folder)) as processes:
        crowd = [python, HERE / "ros_crowd.py", "publish", str(robots), str(rate)]
        processes.start("crowd", crowd, env=NETWORK)
        yield processes


@contextmanager
def _listening(python: Path, robots: int) -> Iterator[Onlooker]:
    listener = Onlooker(python, HERE / "ros_crowd.py", "listen", str(robots), env=NETWORK)
    try:
        listener.line()
        yield listener
    except RuntimeError as error:
        raise NotMeasuredError(str(error)) from error
    finally:
        listener.end()
