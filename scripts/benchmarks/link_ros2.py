"""ROS 2 robots through the adapter, beside rclpy's own subscriber to the same topics in the same seconds."""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from stage.errors import StageError
from stage.processes import dying_with_this
from stage.ros_peer import DISTRIBUTION, ros_python

from .clock import table
from .linked import HERE, PROBING, Linked, NotMeasuredError, Window, linked, memory
from .swarm import cpu_seconds
from .trial import size

CROWDS = size(((200, 10.0), (1000, 1.0)), ((10, 10.0), (20, 1.0)))
SECONDS, LONG = size((30.0, 90.0), (3.0, 6.0))
"""of a window; of the first crowd's, in which memory is looked at."""
ALL_HEARD = 0.95
"""of what is to be published that rclpy's subscriber must have heard, for the figures to say anything."""
DOMAIN = 1 + os.getpid() % 50
SETTINGS = f"""
[ros2]
domain = {DOMAIN}
range = "localhost"
distribution = "{DISTRIBUTION}"
"""
NETWORK = {"ROS_DOMAIN_ID": str(DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
HEAD = (
    "robots",
    "heard/s by rclpy",
    "delay to rclpy, ms: median",
    "p99",
    "rclpy's CPU",
    "delay to the desk, ms: median",
    "p99",
    "adapter's CPU",
    "gateway's CPU",
)
TEXT = """\
### ROS 2

Odometry of many robots, published by one rclpy node, best effort. The adapter tells the gateway, and a desk
at {desk:g} Hz sees it; a second rclpy process, which does nothing but take the time, subscribes to the same
topics. Delays are from the message's stamp. CPU is of a core; a window takes {seconds:g} s, the first one
{long:g} s. All processes share the machine. {busy}

{rows}

{memory}
"""


def section() -> str:
    """Return what was measured, as Markdown."""
    try:
        python = ros_python()
        rows: list[list[str]] = []
        remembered, starved = "", []
        for number, (robots, rate) in enumerate(CROWDS):
            told, window = _measure(python, robots, rate, SECONDS if number else LONG)
            rows.append([f"{robots} × {rate:g} Hz", *told, *window.row()])
            if float(told[0]) < ALL_HEARD * robots * rate:
                starved.append(rows[-1][0])
            remembered = remembered or memory(rows[0][0], window)
    except (StageError, NotMeasuredError) as error:
        return f"### ROS 2\n\n**Not measured**: {error}"
    busy = f"It was too busy for {', '.join(starved)}: fewer came than were to." if starved else ""
    return TEXT.format(
        desk=PROBING, busy=busy, seconds=SECONDS, long=LONG, rows=table(HEAD, rows), memory=remembered
    )


def _measure(python: Path, robots: int, rate: float, seconds: float) -> tuple[list[str], Window]:
    with linked("ros2", SETTINGS) as link, _listening(python, robots) as listener:
        link.processes.start(
            "crowd", [python, HERE / "ros_crowd.py", "publish", str(robots), str(rate)], env=NETWORK
        )
        link.wait_for(robots)
        link.look()
        # What discovery still has to do is none of what positions cost.
        time.sleep(size(10.0, 1.0))
        return _window(link, listener, seconds)


def _window(link: Linked, listener: subprocess.Popen[str], seconds: float) -> tuple[list[str], Window]:
    assert listener.stdin is not None and listener.stdout is not None
    listener.stdin.write(json.dumps({"begin": time.monotonic(), "seconds": seconds}) + "\n")
    listener.stdin.flush()
    before = cpu_seconds(listener.pid)
    window = link.window(seconds)
    cpu = (cpu_seconds(listener.pid) - before) / seconds
    heard: dict[str, Any] = json.loads(listener.stdout.readline())
    delays = ["–" if one is None else f"{one:.1f}" for one in heard["delays"]]
    return [f"{heard['heard'] / seconds:.0f}", *delays, f"{100 * cpu:.0f} %"], window


@contextmanager
def _listening(python: Path, robots: int) -> Iterator[subprocess.Popen[str]]:
    listener = subprocess.Popen(
        dying_with_this([python, HERE / "ros_crowd.py", "listen", str(robots)]),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, **NETWORK},
    )
    try:
        assert listener.stdout is not None
        if listener.stdout.readline() != "up\n":
            raise NotMeasuredError("rclpy's subscriber did not come up")
        yield listener
    finally:
        listener.kill()
        listener.wait()
