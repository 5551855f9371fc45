"""Robots and operators by the hundred against one server, in two processes of their own.

The robots' process only sends, the operators' only looks: neither waits for the other, and neither is on the
server's core.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import time
import urllib.request
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from tests.support.processes import dying_with_this

ROOT = Path(__file__).parents[1]
COUNT = re.compile(
    r'^robot_bridge_requests_total\{link="(?:websocket|link)",op="SendPos"\} (\S+)', re.MULTILINE
)
SETTLE = 3.0
"""seconds of each window that do not count."""
IDLE_BELOW, IDLE_WITHIN = 0.2, 120.0
"""of a core, for a second: so much the pings and looks of a gateway with nothing to do may take; and the
seconds after which it must have come to that."""
ANSWER_WITHIN = 60.0
"""seconds in which a server that is not starved says how many messages it has read."""
READ_WITHIN = 0.5
"""seconds after the last message in which a server that keeps up has read it."""
BEHIND_MS = 300.0
"""milliseconds that a robot is late where the robots' process cannot send as fast as it is to."""
GIVE_UP_AFTER = 3.0
"""seconds without a message read, after which no more will be."""


@dataclass(frozen=True)
class Plan:
    """How many of whom, on the server with process ``pid``.

    ``operators`` subscribe at ``operator_rate``, ``stuck`` ones subscribe and never read. One more, the
    probe, subscribes at ``probe_rate`` and measures. ``rpc`` is false for a peer that forwards positions.
    The robots have a connection each, or with ``over_link`` one for all of them.
    """

    host: str
    port: int
    pid: int
    robots: int
    operators: int = 20
    operator_rate: float = 5.0
    stuck: int = 0
    probe_rate: float = 50.0
    rpc: bool = True
    over_link: bool = False


@dataclass(frozen=True)
class Seen:
    """What came of a window: messages a second sent, and how many of them the server never read.

    ``read_after`` is the seconds that it went on reading after the last was sent. ``delays`` and ``ages`` are
    those of :class:`.swarm_operators.Told`, ``cpu`` is the server's and ``own_cpu`` the robots', in cores.
    ``held_back`` are messages that a socket did not take, ``late`` is the most that one was behind its time
    in milliseconds: above some tens the machine was too busy to measure on.
    """

    rate: float
    unread: int
    read_after: float
    delays: list[float | None]
    ages: list[float | None]
    cpu: float
    own_cpu: float
    held_back: int
    late: float
    megabytes_before: float
    megabytes: float

    @property
    def kept_up(self) -> bool:
        """Tell whether the server had read everything a moment after it was sent."""
        return self.unread == 0 and self.held_back == 0 and self.read_after < READ_WITHIN

    @property
    def swarm_kept_up(self) -> bool:
        """Tell whether the robots sent as fast as they were to."""
        return self.late < BEHIND_MS


class Onlooker:
    """A process that is told of windows, and says as JSON what came of each."""

    def __init__(self, *command: str | Path, env: Mapping[str, str] | None = None) -> None:
        self._process = subprocess.Popen(
            dying_with_this(command),
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, **(env or {})},
        )
        self.pid = self._process.pid

    def tell(self, **window: Any) -> None:
        """Tell of the next window."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(window) + "\n")
        self._process.stdin.flush()

    def line(self) -> Any:
        """Return what it says next, None where that is that it is ready.

        :raises RuntimeError: when it has ended.
        """
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self._process.args!r} ended with status {self._process.wait()}")
        return None if line in ("ready\n", "up\n") else json.loads(line)

    def end(self) -> None:
        """End it."""
        self._process.kill()
        self._process.communicate()


class Swarm:
    """A context in which everybody of a plan is connected, and the server has done all that came of it.

    ``core`` is the one they share; ``arrival`` is the seconds from the first robot's connection, each
    following the one before, until the last one had its map.
    """

    def __init__(self, plan: Plan, core: int) -> None:
        self._plan = plan
        robots = "benchmarks.swarm_link" if plan.over_link else "benchmarks.swarm_robots"
        self._robots, self._operators = (
            Onlooker("taskset", "-c", str(core), sys.executable, "-m", module, json.dumps(asdict(plan)))
            for module in (robots, "benchmarks.swarm_operators")
        )

    def __enter__(self) -> Swarm:
        self.arrival = float(self._robots.line())
        self._operators.line()
        self._wait_until_idle()
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        self._robots.end()
        self._operators.end()

    def window(self, rate: float, seconds: float) -> Seen:
        """Return what comes of ``rate`` messages a second of each robot for that long, after SETTLE."""
        pid, before = self._plan.pid, self._count()
        begin = time.monotonic() + 0.2
        measured, end = begin + SETTLE, begin + SETTLE + seconds
        self._robots.tell(begin=begin, seconds=end - begin, rate=rate, measured=SETTLE)
        self._operators.tell(begin=measured, seconds=seconds)
        time.sleep(measured - time.monotonic())
        cpu, began, memory = cpu_seconds(pid), time.monotonic(), megabytes_of(pid)
        time.sleep(max(0.0, end - time.monotonic()))
        cpu = (cpu_seconds(pid) - cpu) / (time.monotonic() - began)
        sent, told = self._robots.line(), self._operators.line()
        unread, read_after = self._wait(before + sent["messages"], end)
        return Seen(
            rate=sent["messages"] / (end - begin),
            unread=unread,
            read_after=read_after,
            cpu=cpu,
            megabytes_before=memory,
            megabytes=megabytes_of(pid),
            **told,
            **{name: sent[name] for name in ("held_back", "late", "own_cpu")},
        )

    def _wait_until_idle(self) -> None:
        until, used = time.monotonic() + IDLE_WITHIN, float("-inf")
        while (now := cpu_seconds(self._plan.pid)) - used > IDLE_BELOW:
            if time.monotonic() > until:
                raise RuntimeError(f"the server is still busy {IDLE_WITHIN:g} s after everybody has come")
            used = now
            time.sleep(1.0)

    def _wait(self, wanted: int, end: float) -> tuple[int, float]:
        """Return how many messages were never read, and the seconds until the last one was."""
        count, at = self._count(), time.monotonic()
        while count < wanted and time.monotonic() - at < GIVE_UP_AFTER:
            time.sleep(0.02)
            now = self._count()
            if now > count:
                count, at = now, time.monotonic()
        return wanted - count, max(0.0, at - end)

    def _count(self) -> int:
        """Return how many positions the server has read, by its own account."""
        url = f"http://{self._plan.host}:{self._plan.port}/metrics"
        try:
            with urllib.request.urlopen(url, timeout=ANSWER_WITHIN) as page:
                found = COUNT.search(page.read().decode())
        except TimeoutError:
            text = f"the server says nothing for {ANSWER_WITHIN:g} s: the machine is too busy to measure on"
            raise RuntimeError(text) from None
        return int(float(found.group(1))) if found else 0


def cpu_seconds(pid: int) -> float:
    """Return the time that process ``pid`` has used."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def megabytes_of(pid: int) -> float:
    """Return the memory that process ``pid`` has now."""
    pages = int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
