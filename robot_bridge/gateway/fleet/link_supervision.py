"""Supervision of links, their processes, connections by name, and accounts that block the database."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import subprocess
import sys
import threading
import time
from collections import Counter, defaultdict, deque
from collections.abc import Awaitable, Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Protocol

import msgspec

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import RefusedError
from ...core.messages.administration import Suspension, Suspensions
from ...core.messages.base import to_json
from ...core.messages.links import LinkReport, Links, LinkStatus, Playback, PlaybackReport, SetPlayback
from ...core.sites.settings_tables import LinkOptions
from ..model.events import Listeners, handles
from ..model.robots import Robot, Robots
from ..storage.database import Database
from ..storage.roles import blocking_sessions

# --- State of each link: connected or not, its own side in order or not, and the reports to operators

GRACE = 3.0
"""seconds that a link may be away before operators are notified: most come back by themselves."""
MOST_NAMES = 50
AWAY = "it is not connected"
REPLAY = "replay"
"""Kind of links that play recordings."""

Ask = Callable[[str, dict[str, Any]], Awaitable[Any]]
"""Calls a method of a link, and returns its result; raises RefusedError."""


@dataclass
class LinkProcess:
    """A link that the gateway starts; ``fault`` is the reason why it does not run, one line for operators."""

    name: str
    kind: str
    file: Path
    starts: int = 0
    pid: int | None = None
    fault: str | None = "it is not started yet"


@dataclass(frozen=True)
class ConnectedLink:
    """A connected link: its kind, None before its hello, and its last report on itself."""

    name: str
    kind: str | None
    status: LinkStatus | None
    robots: int


@dataclass
class _Known:
    seen_at: float
    kind: str | None = None
    status: LinkStatus | None = None
    process: LinkProcess | None = None
    robots: int = 0
    counts: Mapping[str, float] = field(default_factory=dict)
    ask: Ask | None = None
    """None while it is not connected."""


class LinkWatch:
    """The links that a site names, and those that have connected. Operators are notified of each change."""

    def __init__(self, robots: Robots, listeners: Listeners, clock: Clock = SYSTEM_CLOCK) -> None:
        self._robots = robots
        self._listeners = listeners
        self._clock = clock
        self._known: dict[str, _Known] = {}
        self._last_report = Links()

    def update(self, connected: Iterable[ConnectedLink], processes: Iterable[LinkProcess] = ()) -> None:
        """Update the state of the links, and notify operators of changes."""
        now = self._clock.steady()
        for process in processes:
            self._known.setdefault(process.name, _Known(now, process.kind)).process = process
        for known in self._known.values():
            known.robots = 0
        for link in connected:
            known = self._known.setdefault(link.name, _Known(now))
            known.seen_at, known.status, known.robots = now, link.status, link.robots
            known.kind = link.kind or known.kind
            known.counts = {} if link.status is None else link.status.counts
        report = self.report()
        if report != self._last_report:
            self._last_report = report
            self._listeners.announce("links", "", to_json(report))

    def introduce(self, link: str, kind: str, ask: Ask) -> None:
        """Record the kind of a link at its hello, before any message of a robot, and how to call it."""
        known = self._known.setdefault(link, _Known(self._clock.steady()))
        known.kind, known.ask = kind, ask

    def withdraw(self, link: str, ask: Ask) -> None:
        """Record that a connection has ended; one that has replaced it is kept."""
        known = self._known.get(link)
        if known is not None and known.ask == ask:
            known.ask = None

    @handles(SetPlayback)
    async def set_playback(self, request: SetPlayback) -> PlaybackReport:
        """Set how a link plays its recording, and return its playback state; raises RefusedError."""
        known = self._known.get(request.link)
        if known is None or known.kind != REPLAY:
            played = ", ".join(sorted(name for name, one in self._known.items() if one.kind == REPLAY))
            raise RefusedError(f"{request.link[:40]!r} plays no recording; those that do: {played or 'none'}")
        if known.ask is None:
            raise RefusedError(f"link {request.link}: {AWAY}")
        result = await known.ask(Playback.method, to_json(request.change))
        try:
            return msgspec.convert(result, PlaybackReport)
        except msgspec.ValidationError as error:
            raise RefusedError(f"link {request.link} answers with what is no report: {error}") from None

    def kind_of(self, link: str) -> str | None:
        """Return the kind of a link; None for one that has not connected, and for an unknown name."""
        known = self._known.get(link)
        return None if known is None else known.kind

    def report(self) -> Links:
        """Return the state of each link; one not started here whose robots are all elsewhere is dropped."""
        now = self._clock.steady()
        found = []
        for name, known in sorted(self._known.items()):
            text = self._fault(known, now)
            up = text is None or _reaches(known, now)
            robots = [] if up else self._of(name)
            if not up and known.process is None and not robots and now - known.seen_at > GRACE:
                continue
            found.append(LinkReport(name, known.kind, up, text, robots[:MOST_NAMES], len(robots)))
        return Links(found)

    def numbers(self, name: str) -> dict[tuple[str, ...], float]:
        """Return one number of each link by its name: ``up``, ``robots`` or ``starts``."""
        now = self._clock.steady()
        each: dict[str, Callable[[_Known], float]] = {
            "up": lambda known: float(self._fault(known, now) is None),
            "robots": lambda known: float(known.robots),
            "starts": lambda known: float(known.process.starts if known.process else 0),
        }
        return {(link,): each[name](known) for link, known in self._known.items()}

    def counts(self) -> dict[tuple[str, ...], float]:
        """Return the counters of links, by link and name."""
        return {(link, name): n for link, known in self._known.items() for name, n in known.counts.items()}

    def _fault(self, known: _Known, now: float) -> str | None:
        """Return the fault of a link, None if it has none."""
        if now - known.seen_at > GRACE:
            return (known.process.fault if known.process else None) or AWAY
        if known.status is not None and not known.status.ok:
            return known.status.text or "its own side is not in order"
        return None

    def _of(self, link: str) -> list[str]:
        return [robot.name for robot in self._robots.own() if robot.link == link]


def _reaches(known: _Known, now: float) -> bool:
    """Return whether a link reaches its robots although some of them have a fault."""
    return now - known.seen_at <= GRACE and known.status is not None and bool(known.status.reached)


# --- Claims to names: a second robot that says Ready under the same account is detected and refused


class ConnectionClaim(Protocol):
    """A connection of a robot."""

    async def answers(self) -> bool:
        """Return whether the robot at its other end responds; takes a second at most."""


class ConnectionClaims:
    """The connections of robots, by name. Robots on SQL have none."""

    def __init__(self) -> None:
        self._holds: dict[str, ConnectionClaim] = {}

    def claim(self, robot: str, hold: ConnectionClaim) -> None:
        """Record that ``robot`` is at the other end of ``hold``, and of no other."""
        self._holds[robot] = hold

    def free(self, robot: str, hold: ConnectionClaim) -> None:
        """Record that ``robot`` is no longer at the other end of ``hold``."""
        if self._holds.get(robot) is hold:
            del self._holds[robot]

    async def answers(self, robot: str) -> bool:
        """Return whether the robot has a connection and responds."""
        hold = self._holds.get(robot)
        return hold is not None and await hold.answers()


async def claim_refusal(
    robot: Robot, magic: int, silent: float, stale_after: float, holds: ConnectionClaims
) -> str | None:
    """Return why a Ready with ``magic`` is refused: it comes from another robot than the one of this name.

    ``silent`` is the seconds since the last message of that one. A restarted robot is admitted: its old
    connection is closed or does not answer; on SQL it said Stopped, or is silent for ``stale_after`` seconds.
    """
    if robot.magic == magic or silent >= stale_after:
        return None
    there = not robot.ended_in_order if robot.link == "sql" else await holds.answers(robot.name)
    if not there:
        return None
    return (
        f"another robot runs as {robot.name!r} (magic {robot.magic}, heard {silent:.1f} s ago); give each "
        "robot an account of its own, or end the other one"
    )


# --- Links that a site names: each is started as a process of its own, and restarted when it ends ---

log = logging.getLogger(__name__)

FIRST_WAIT, LONGEST_WAIT = 1.0, 10.0
"""seconds between two starts; each time twice as long, until one has lasted for LONGEST_WAIT."""
END_WITHIN = 1.0
"""seconds for a process to end in good order: a gateway ends within five in all."""
LONGEST_LINE = 65_536
"""bytes; longer than any line of a log."""
URL = "ROBOT_BRIDGE_LINK_URL"
"""The environment variable with the URL of the gateway for a link, unless its settings have one."""


class LinkProcesses:
    """Keeps the links of ``options`` running, with settings in the site's ``folder``."""

    def __init__(self, options: LinkOptions, folder: Path) -> None:
        self._processes = [
            LinkProcess(Path(file).stem, kind, folder / file) for kind, file in options.files()
        ]

    @property
    def states(self) -> Sequence[LinkProcess]:
        """The state of each process."""
        return self._processes

    async def run(self, url: str) -> None:
        """Keep them running until cancelled, with the gateway at ``url``; then end them."""
        async with asyncio.TaskGroup() as group:
            for one in self._processes:
                group.create_task(self._keep(one, url))
            # Without any, nothing would be left to wait for.
            await asyncio.Event().wait()

    async def _keep(self, one: LinkProcess, url: str) -> None:
        wait = FIRST_WAIT
        while True:
            began = time.monotonic()
            try:
                one.fault = await self._run_once(one, url)
            except Exception as error:
                # A failure of one link must end no other, whose robots could not be stopped then.
                log.exception("link %s: unexpected %s", one.name, type(error).__name__)
                one.fault = f"it cannot be kept going: {error}"
            if time.monotonic() - began > LONGEST_WAIT:
                wait = FIRST_WAIT
            log.error("link %s ended: %s; it is started again in %g s", one.name, one.fault, wait)
            await asyncio.sleep(wait)
            wait = min(wait * 2, LONGEST_WAIT)

    async def _run_once(self, one: LinkProcess, url: str) -> str:
        """Run a link to its end; return the reason why it ended."""
        try:
            process = _Process(one, url)
        except OSError as error:
            return f"it cannot be started: {error.strerror or error}"
        one.starts, one.pid, one.fault = one.starts + 1, process.pid, None
        log.info("link %s runs as process %d", one.name, process.pid)
        try:
            return await process.wait()
        finally:
            one.pid = None
            await process.end()


class _Process:
    """A running link; a thread passes on its output, and waits for its end.

    Not a subprocess of the loop: uvloop forks, and its copy of this process may wait for ever at a lock that
    another thread held just then, such as one of SQLite, and the loop waits for the copy.
    """

    def __init__(self, one: LinkProcess, url: str) -> None:
        self._process = subprocess.Popen(  # nosec B603 # our own words, no shell
            [
                *(sys.executable, "-m", "robot_bridge", "link", one.kind, "--config", str(one.file)),
                "--until-stdin-closes",
            ],
            stdin=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=_environment(url),
        )
        self.pid = self._process.pid
        self._reason = ""
        self._ended = asyncio.Event()
        loop = asyncio.get_running_loop()
        threading.Thread(target=self._follow, args=(loop,), name=f"link {one.name}", daemon=True).start()

    async def wait(self) -> str:
        """Wait for its end; return the reason."""
        await self._ended.wait()
        return self._reason

    async def end(self) -> None:
        """End it if it runs, in good order if possible."""
        if self._ended.is_set():
            return
        self._process.terminate()
        try:
            async with asyncio.timeout(END_WITHIN):
                await self._ended.wait()
        except TimeoutError:
            self._process.kill()
            await self._ended.wait()

    def _follow(self, loop: asyncio.AbstractEventLoop) -> None:
        with self._process as process:
            assert process.stderr is not None
            last = _pass_on(process.stderr)
            status = process.wait()
        self._reason = last or f"exit status {status}"
        # The loop may have ended before.
        with contextlib.suppress(RuntimeError):
            loop.call_soon_threadsafe(self._ended.set)


def _environment(url: str) -> Mapping[str, str]:
    """Return the environment of a link: systemd watches only the gateway."""
    left_out = ("NOTIFY_SOCKET", "WATCHDOG_USEC")
    own = {name: value for name, value in os.environ.items() if name not in left_out}
    return {**own, URL: url}


def _pass_on(lines: IO[bytes]) -> str:
    """Write a link's output into this log's stream; return its last line, the reason why it ended."""
    last = ""
    while line := lines.readline(LONGEST_LINE).decode("utf-8", "replace"):
        # Whatever becomes of the line: a link whose output nobody reads comes to a halt.
        with contextlib.suppress(OSError):
            sys.stderr.write(line)
        last = line.strip() or last
    return last.removeprefix("robot-bridge: ")[:300]


# --- Suspension of robots' database accounts that block the others repeatedly

SUSPEND_INTERVAL = 0.5
"""Seconds between two decisions on accounts: less than a command waits for them."""
MOST_OFFENCES, WITHIN_S = 3, 60.0
"""How often an account may block the gateway, within how many seconds; one flood is too many."""
FIRST_S, LONGEST_S = 60.0, 3600.0
"""seconds for which an account is locked; twice as long each time, unless the last was long ago."""
FORGIVEN_AFTER_S = 6 * 3600.0
BLOCKS = "its transactions kept the gateway waiting again and again"
FLOODS = "it sent notifications without end"
UPGRADE = "have an administrator run: robot-bridge database upgrade"


class SuspendedCommands(Protocol):
    """The commands of robots, as far as suspensions need them."""

    def awaits_any_abort(self, robot: str) -> bool:
        """Return whether an Abort is on its way to the robot, an emergency stop's or another."""


class AccountSuspensions:
    """Locks such accounts for a while, notifies operators, and unlocks them.

    All by the database's second connection: the first one may be waiting for just these accounts.
    Those that an earlier gateway has locked are unlocked in time, too. No account is locked while an Abort is
    on its way to its robot: a stop that cannot be read would be worse than a blocked database.
    """

    def __init__(
        self,
        database: Database,
        commands: SuspendedCommands,
        listeners: Listeners,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self._database = database
        self._commands = commands
        self._listeners = listeners
        self._clock = clock
        self._offences: defaultdict[str, deque[float]] = defaultdict(deque)
        self._last: dict[str, tuple[float, float]] = {}
        self._in_force: dict[str, tuple[float, str]] = {}
        self._not_locked: set[str] = set()

    def report(self) -> Suspensions:
        """Return the accounts that are suspended now."""
        return Suspensions(
            [
                Suspension(robot, why, None if robot in self._not_locked else until)
                for robot, (until, why) in sorted(self._in_force.items())
            ]
        )

    async def restore(self) -> None:
        """Restore the suspensions by an earlier gateway; raises StoreError."""
        self._in_force = await self._database.read(blocking_sessions.stored_suspensions)
        if self._in_force:
            self._notify()

    async def follow(self) -> None:
        """Apply the suspensions by another gateway of the fleet; raises StoreError."""
        stored = await self._database.run_aside(blocking_sessions.stored_suspensions)
        if stored != self._in_force:
            self._in_force = stored
            self._not_locked &= stored.keys()
            self._notify()

    async def update(self) -> None:
        """Lock accounts that have offended too often, unlock expired ones; raises StoreError."""
        now = self._clock.time()
        for robot, why in (await self._offenders(now)).items():
            if robot not in self._in_force and not self._commands.awaits_any_abort(robot):
                await self._suspend(robot, why, now)
        for robot, (until, _) in list(self._in_force.items()):
            # A clock that was set back must not lock an account forever.
            is_over = until <= now or until > now + LONGEST_S
            if is_over or self._commands.awaits_any_abort(robot):
                await self._resume(robot)

    async def _offenders(self, now: float) -> dict[str, str]:
        blocking, backends = self._database.offences.drain()
        flooding: list[str] = []
        if backends:
            flooding = await self._database.run_aside(blocking_sessions.robots_of_backends, backends)
        for robot, times in Counter(blocking).items():
            seen = self._offences[robot]
            seen.extend([now] * times)
            while seen and seen[0] < now - WITHIN_S:
                seen.popleft()
        often = [robot for robot, seen in self._offences.items() if len(seen) >= MOST_OFFENCES]
        for robot in often:
            del self._offences[robot]
        return dict.fromkeys(often, BLOCKS) | dict.fromkeys(flooding, FLOODS)

    async def _suspend(self, robot: str, why: str, now: float) -> None:
        last, lasted = self._last.get(robot, (0.0, 0.0))
        seconds = min(2 * lasted, LONGEST_S) if lasted and now - last < FORGIVEN_AFTER_S else FIRST_S
        self._last[robot] = now, seconds
        in_force = self._in_force | {robot: (now + seconds, why)}
        # Stored before it is done: after a crash in between the next gateway unlocks what may be locked.
        await self._database.run_aside(blocking_sessions.store_suspensions, in_force)
        self._in_force = in_force
        if await self._database.run_aside(blocking_sessions.set_suspended, robot, True):
            log.error("database account of robot %s: %s; locked for %.0f s", robot, why, seconds)
        else:
            self._not_locked.add(robot)
            log.error("database account of robot %s: %s; it cannot be locked: %s", robot, why, UPGRADE)
        self._notify()

    async def _resume(self, robot: str) -> None:
        await self._database.run_aside(blocking_sessions.set_suspended, robot, False)
        in_force = {name: one for name, one in self._in_force.items() if name != robot}
        await self._database.run_aside(blocking_sessions.store_suspensions, in_force)
        self._in_force = in_force
        self._not_locked.discard(robot)
        log.warning("database account of robot %s: not locked any more", robot)
        self._notify()

    def _notify(self) -> None:
        self._listeners.announce("suspensions", "", to_json(self.report()))
