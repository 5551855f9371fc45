"""The part on a full disk: hours by the gateway's clock, in which nothing can be stored."""

from __future__ import annotations

import contextlib
import os
import re
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, func, insert, select
from websockets.exceptions import WebSocketException

from benchmarks.clock import table
from benchmarks.load import MALLOC, site_with_room
from benchmarks.page import Part, goal
from benchmarks.swarm import Onlooker
from benchmarks.trial import size
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.schema import audit, commands, emergency_stops, trajectories
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError
from tests.support.faults.disk import DiskWithPower
from tests.support.fleet import Served, serve
from tests.support.operators import Desk, open_desk
from tests.support.processes import Processes
from tests.support.wire import RefusedError

FASTER = {"SQLite": 80.0, "PostgreSQL": 12.0}
"""How much faster the gateway's clocks go than this machine's; a server's commits take its own time."""
MINUTES = float(os.environ.get("MINUTES") or size(18.0, 1.0))
"""of this machine's, with SQLite."""
HOURS = {"SQLite": MINUTES * FASTER["SQLite"] / 60, "PostgreSQL": size(0.3, 0.2)}
"""by the gateway's clock, on a full disk."""
MEGABYTES = {"SQLite": 48, "PostgreSQL": 256}
ROBOTS, RATE, RATE_OF_ROBOTS = 50, 0.5, 3.0
"""how many, how often each says where it is by the gateway's clock, and how often they do elsewhere here."""
OBJECTS_EVERY, STOPS_EVERY, BACKUPS_EVERY = 600.0, 3600.0, 6 * 3600.0
FIRST_STOP = 600.0
SETTLED_AFTER = 3 * 3600.0
"""seconds by the gateway's clock after which all that waits waits, and memory is to grow no more."""
HOUR, DAY, KEPT_DAYS = 3600.0, 86400.0, 30.0
STOP_MS, HIGHER_MB, LINES_AN_HOUR = 1000.0, 25.0, 600.0
"""goals: milliseconds to the last robot; MB; lines of the log."""
HANDSHAKE_S, STUCK_S = 60.0, 600.0
"""seconds by the gateway's clock in which a client has to answer."""
ATTEMPTS = 10
WARM_UP, HEARD_WITHIN, STORED_WITHIN = 10.0, 10.0, 120.0
SETTLED_WITHIN = 300.0
"""seconds by the gateway's clock for retention and the last acknowledgements."""
PARTS = 8
"""of the time, at the end of each of which memory is noted."""
OLD = 4000
"""positions that become too old in the course of the day."""
LIBRARY = next(iter(sorted(Path("/usr/lib").glob("*/faketime/libfaketime.so.1"))), None)
OPEN = ("queued", "delivered", "acknowledged")

TEXT = """\
A gateway and its database on an ext4 of {sqlite_mb} MB ({postgresql_mb} MB with PostgreSQL), which is
filled to the last byte. The gateway's clocks go {sqlite_faster:g} times as fast as this machine's
(libfaketime; {postgresql_faster:g} times with PostgreSQL, whose commits take their own time), so all that
it does by time, such as retries, retention and lines of its log once a minute, it does as often as in so
many hours. {robots} robots on WebSocket drive and say where they are {rate:g} times a second by that clock;
at {usual:g} times a second it would be {usual_positions:.1f} million positions a day, which is more than
the machine takes in so short a time. Every {objects_every:.0f} minutes each says that it saw something.
Every {stops_every:.0f} minutes a desk comes, aborts one robot, stops all, tries to send one and to clear
the stop, which is refused, and goes. With SQLite a backup onto the same disk is tried every
{backups_every:.0f} hours. Then there is room again. Milliseconds are this machine's.

{table}

{memory}

Aborts and emergency stops: the milliseconds from the desk's request to the last robot that was to hear of
it, the slowest of all ({stop_goal}). Memory is the gateway's own: with the full disk's first {settled:.0f}
hours over, or half of fewer, by when as many positions wait as may, it was to grow by at most {higher:g} MB
({memory_goal}). Lines of the log: at most {lines:g} an hour ({lines_goal}). *Stored after*: seconds of this
machine's from when there was room again until the stop and all positions that waited were stored, without a
restart. Every stop that was made is in the database then, cleared where it was cleared; no command is open;
entries of the audit log are there; a robot is sent somewhere; and a gateway that is started anew on it has
no stop in force.

Wrong in all of this: {wrong}.
"""


@dataclass
class Seen:
    """What came of the hours on one kind of database; ``memory`` in MB by parts of the time."""

    kind: str
    hours: float
    positions: float = 0.0
    given_up: float = 0.0
    most_waiting: float = 0.0
    refused: int = 0
    aborts: list[float] = field(default_factory=list)
    stops: list[float] = field(default_factory=list)
    lost: int = 0
    memory: dict[int, float] = field(default_factory=dict)
    lines: Counter[str] = field(default_factory=Counter)
    backups: int = 0
    stored_after: float = float("nan")
    wrong: list[str] = field(default_factory=list)

    @property
    def grown(self) -> float:
        """MB from when all waits that may to the end."""
        first = min(SETTLED_AFTER / HOUR / self.hours, 0.5) * PARTS
        settled = [mb for part, mb in sorted(self.memory.items()) if part >= first]
        return settled[-1] - settled[0]


def measure(_data: Path) -> Part:
    """Live through the hours on each kind of database."""
    heading, seen = "A full disk", list[Seen]()
    try:
        if LIBRARY is None:
            raise StageError("libfaketime is not on this machine")
        for kind in HOURS:
            with tempfile.TemporaryDirectory(prefix="fleet-full-disk-") as folder:
                seen.append(_live_through(kind, Path(folder)))
            print(seen[-1], file=sys.stderr, flush=True)
    except StageError as error:
        return Part(heading, f"Not measured: {error}.", failed=True)
    return report(heading, seen)


def report(heading: str, seen: list[Seen]) -> Part:
    """Return the part of the page that some hours come to."""
    slowest = max(ms for one in seen for ms in [*one.aborts, *one.stops])
    grown, lines = max(one.grown for one in seen), max(_lines_an_hour(one) for one in seen)
    goals = (slowest <= STOP_MS, grown <= HIGHER_MB, lines <= LINES_AN_HOUR)
    wrong = [f"{one.kind}: {text}" for one in seen for text in one.wrong]
    text = TEXT.format(
        **{"sqlite_mb": MEGABYTES["SQLite"], "postgresql_mb": MEGABYTES["PostgreSQL"]},
        **{f"{kind.lower()}_faster": faster for kind, faster in FASTER.items()},
        **{"robots": ROBOTS, "rate": RATE, "usual": RATE_OF_ROBOTS},
        usual_positions=ROBOTS * RATE_OF_ROBOTS * DAY / 1e6,
        objects_every=OBJECTS_EVERY / 60,
        stops_every=STOPS_EVERY / 60,
        backups_every=BACKUPS_EVERY / HOUR,
        table=_table(seen),
        memory=_memory(seen),
        stop_goal=goal(f"at most {STOP_MS:.0f} ms", goals[0]),
        settled=SETTLED_AFTER / HOUR,
        higher=HIGHER_MB,
        memory_goal=f"{grown:+.1f} MB; " + goal(f"at most {HIGHER_MB:g} MB", goals[1]),
        lines=LINES_AN_HOUR,
        lines_goal=goal(f"at most {LINES_AN_HOUR:g}", goals[2]),
        wrong=len(wrong) or "nothing",
    )
    failed = bool(wrong) or not all(goals)
    return Part(heading, "\n".join([text, *(f"- {one}" for one in wrong)]), failed, settings=MALLOC)


def _table(seen: list[Seen]) -> str:
    head = ["database", "hours", "positions", "given up", "most that waited", "requests of robots refused"]
    head += ["connections lost", "Aborts", "slowest, ms", "stops", "slowest, ms", "lines of the log an hour"]
    head += ["backups refused", "stored after, s"]
    rows = [
        [
            *(one.kind, f"{one.hours:g}", f"{one.positions:.0f}", f"{one.given_up:.0f}"),
            *(f"{one.most_waiting:.0f}", one.refused, one.lost),
            *(len(one.aborts), f"{max(one.aborts):.0f}", len(one.stops), f"{max(one.stops):.0f}"),
            *(f"{_lines_an_hour(one):.0f}", one.backups or "–", f"{one.stored_after:.1f}"),
        ]
        for one in seen
    ]
    return table(head, rows)


def _memory(seen: list[Seen]) -> str:
    parts = range(PARTS + 1)
    rows = [
        [one.kind, *(f"{one.memory[part]:.0f}" if part in one.memory else "–" for part in parts)]
        for one in seen
    ]
    return table(
        ["memory in MB, with so much of the hours over", *(f"{part}/{PARTS}" for part in parts)], rows
    )


def _lines_an_hour(seen: Seen) -> float:
    return sum(seen.lines.values()) / seen.hours


# --- the hours on one kind of database ---


def _live_through(kind: str, folder: Path) -> Seen:
    folder.chmod(0o711)
    with DiskWithPower(folder / "disk", MEGABYTES[kind]) as disk, Processes(folder / "logs") as processes:
        if kind == "SQLite":
            return _FullDisk(kind, folder, disk, processes, f"sqlite:///{disk.folder}/fleet.db").run()
        with PostgreSql(durable=True, within=disk.folder) as server:
            return _FullDisk(kind, folder, disk, processes, server.new_database(), server).run()


class _FullDisk:
    """One gateway, its robots and the disk."""

    def __init__(
        self,
        kind: str,
        folder: Path,
        disk: DiskWithPower,
        processes: Processes,
        url: str,
        server: PostgreSql | None = None,
    ) -> None:
        self._disk, self._processes, self._url, self._server = disk, processes, url, server
        self._site, self._seen = site_with_room(folder), Seen(kind, HOURS[kind])
        with (self._site / "site.toml").open("a", encoding="utf-8") as settings:
            # Robots answer by this machine's clock.
            settings.write(f"handshake_s = {HANDSHAKE_S}\nstuck_s = {STUCK_S}\n")
        self._backup = disk.folder / "backups" / "fleet.backup"
        self._faster = FASTER[kind]
        self._stops: list[str] = []
        self._crowd: Onlooker | None = None
        self._served: Served | None = None

    def run(self) -> Seen:
        """Live through it."""
        run_once(self._url, revisions.create)
        if self._server is None:
            run_once(self._url, _fill, time.time())
        self._served = self._serve("gateway")
        where = ["127.0.0.1", str(self._served.port), str(ROBOTS)]
        rates = [str(RATE * self._faster), str(OBJECTS_EVERY / self._faster)]
        self._crowd = Onlooker(sys.executable, "-m", "benchmarks.full_disk_robots", *where, *rates)
        try:
            self._crowd.line()
            time.sleep(WARM_UP)
            self._make_backup()
            self._be_full()
            self._have_room()
        finally:
            self._crowd.end()
        return self._seen

    def _serve(self, name: str) -> Served:
        clock = {"LD_PRELOAD": str(LIBRARY), "FAKETIME": f"+0 x{self._faster:g}"}
        return serve(self._processes, self._site, self._url, name=name, env={**MALLOC, **clock})

    def _be_full(self) -> None:
        log = self._processes.log("gateway")
        before, positions, lost = (
            len(_lines(log)),
            self._crowd_said()["positions"],
            self._crowd_said()["lost"],
        )
        refused = self._crowd_said()["answers"]["refused"]
        self._disk.fill()
        began, next_stop, next_backup = time.monotonic(), FIRST_STOP, BACKUPS_EVERY / 2
        while (now := (time.monotonic() - began) * self._faster) < self._seen.hours * HOUR:
            self._note(now)
            if now >= next_stop:
                next_stop += STOPS_EVERY
                self._stop_everybody(len(self._stops) + 1)
            if self._server is None and now >= next_backup:
                next_backup += BACKUPS_EVERY
                self._try_backup()
            time.sleep(1.0)
        self._note(self._seen.hours * HOUR)
        said = self._crowd_said()
        self._seen.positions, self._seen.lost = said["positions"] - positions, said["lost"] - lost
        self._seen.refused = said["answers"]["refused"] - refused
        for line in _lines(log)[before:]:
            self._seen.lines[re.sub(r"\d+", "#", line[24:])[:160]] += 1

    def _note(self, now: float) -> None:
        """Note memory and what waits."""
        assert self._served is not None
        if self._served.process.poll() is not None:
            raise StageError(f"the gateway ended with {self._served.process.returncode} on the full disk")
        figures = self._metrics()
        self._seen.most_waiting = max(self._seen.most_waiting, figures["robot_bridge_waiting_positions"])
        self._seen.given_up = figures["robot_bridge_positions_given_up_total"]
        part = int(now * PARTS / (self._seen.hours * HOUR))
        self._seen.memory.setdefault(part, _megabytes(self._served.process.pid))

    def _stop_everybody(self, number: int) -> None:
        assert self._served is not None
        seen, stop, robot = self._seen, f"full-disk-{number:04d}", f"full-{number % ROBOTS:02d}"
        self._stops.append(stop)
        with self._desk() as desk:
            began = time.monotonic()
            with contextlib.suppress(RefusedError):
                desk.ask("abort", {"command": f"abort-{number:08d}", "robot": robot})
            seen.aborts.append(self._heard(began, [robot], "the Abort"))
            began = time.monotonic()
            told = desk.ask("emergency_stop", {"command": stop, "reason": "the disk is full"})
            seen.stops.append(self._heard(began, [f"full-{k:02d}" for k in range(ROBOTS)], "the stop"))
            if not told["in_force"] or told["stop"] != stop or told["stored"]:
                seen.wrong.append(f"the stop {stop} was answered with {told}")
            for method, params in (
                (
                    "send",
                    {
                        "command": f"send-{number:08d}",
                        "robot": robot,
                        "op": "SetPosEnd",
                        "params": {"x": 40, "y": 8},
                    },
                ),
                ("clear_emergency_stop", {"stop": stop, "reason": "to try it"}),
            ):
                with contextlib.suppress(RefusedError):
                    desk.ask(method, params)
                    seen.wrong.append(f"{method} was not refused on a full disk, in stop {stop}")

    def _desk(self) -> Desk:
        """Return an operator's connection, when the gateway takes one."""
        assert self._served is not None
        for _ in range(ATTEMPTS):
            with contextlib.suppress(OSError, WebSocketException):
                return open_desk(self._served.address)
            time.sleep(1.0)
        raise StageError("the gateway takes no operator on a full disk")

    def _heard(self, since: float, robots: list[str], what: str) -> float:
        """Return the milliseconds until the last of ``robots`` heard of it."""
        until = time.monotonic() + HEARD_WITHIN
        while time.monotonic() < until:
            aborts = self._crowd_said()["aborts"]
            heard = [next((at for at in aborts[name] if at >= since), None) for name in robots]
            if None not in heard:
                return max((at - since) * 1e3 for at in heard if at is not None)
            time.sleep(0.02)
        self._seen.wrong.append(f"{what} did not reach {heard.count(None)} robots")
        return float("inf")

    def _make_backup(self) -> None:
        if self._server is None:
            self._backup.parent.mkdir()
            if (done := self._run_backup()).returncode:
                raise StageError(f"no backup before the disk is full: {done.stderr}")

    def _try_backup(self) -> None:
        before = self._backup.read_bytes()
        done = self._run_backup()
        left = sorted(path.name for path in self._backup.parent.iterdir())
        self._seen.backups += 1
        if not done.returncode or "robot-bridge: " not in done.stderr or "Traceback" in done.stderr:
            self._seen.wrong.append(f"a backup onto the full disk said {done.stderr!r}")
        if left != [self._backup.name] or self._backup.read_bytes() != before:
            self._seen.wrong.append(f"a backup onto the full disk left {left}")

    def _run_backup(self) -> subprocess.CompletedProcess[str]:
        words = ["database", "backup", "--replace", str(self._backup), "--database", self._url]
        command = [sys.executable, "-m", "robot_bridge", *words]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    # --- afterwards ---

    def _have_room(self) -> None:
        assert self._served is not None
        self._disk.free()
        began = time.monotonic()
        if self._server is not None:
            # As whoever runs the site, or its system: the server may have given up.
            self._server.start_again()
        while not self._is_stored():
            if time.monotonic() - began > STORED_WITHIN:
                self._seen.wrong.append("not everything was stored when there was room again")
                break
            time.sleep(0.1)
        self._seen.stored_after = time.monotonic() - began
        with open_desk(self._served.address) as desk:
            cleared = desk.ask("clear_emergency_stop", {"stop": self._stops[-1], "reason": "room"})
            desk.send("after-the-full-disk", "full-01", "SetPosEnd", x=40.0, y=8.0)
            desk.wait_for_step("after-the-full-disk", "acknowledged")
            desk.ask("abort", {"command": "the-last-abort", "robot": "full-01"})
            desk.wait_for_step("the-last-abort", "acknowledged")
        if cleared["in_force"]:
            self._seen.wrong.append("the stop was not cleared when there was room again")
        time.sleep(SETTLED_WITHIN / self._faster)
        self._processes.end("gateway")
        self._check_database()
        again = self._serve("gateway-again")
        with open_desk(again.address) as desk:
            if desk.emergency["in_force"] or not desk.emergency["stored"]:
                self._seen.wrong.append(f"a gateway that is started anew has {desk.emergency}")

    def _is_stored(self) -> bool:
        assert self._served is not None
        try:
            with open_desk(self._served.address) as desk:
                stored = desk.emergency["stored"]
            return (
                stored
                and self._metrics()["robot_bridge_waiting_positions"] < 10 * ROBOTS * RATE * self._faster
            )
        except OSError:
            return False

    def _check_database(self) -> None:
        found: dict[str, Any] = run_once(self._url, _found, self._stops)
        if found["stops"] != len(self._stops) or found["in force"]:
            self._seen.wrong.append(
                f"of {len(self._stops)} stops {found['stops']} are stored, {found['in force']} open"
            )
        if found["open"]:
            self._seen.wrong.append(f"commands are left open: {found['open']}")
        if found["audit"] < len(self._stops):
            self._seen.wrong.append(f"the audit log has {found['audit']} entries of {len(self._stops)} stops")
        if self._server is None and found["old"]:
            self._seen.wrong.append(f"{found['old']} positions are older than they may be")

    def _crowd_said(self) -> dict[str, Any]:
        assert self._crowd is not None
        self._crowd.tell()
        said: dict[str, Any] = self._crowd.line()
        return said

    def _metrics(self) -> dict[str, float]:
        assert self._served is not None
        address = self._served.address.replace("ws", "http", 1)
        for left in reversed(range(ATTEMPTS)):
            # A machine that is busy is too slow for the fast clock's limits now and then.
            try:
                with urllib.request.urlopen(f"{address}/metrics", timeout=30) as answer:
                    page = answer.read().decode()
                break
            except OSError:
                if not left:
                    raise
                time.sleep(1.0)
        lines = [line for line in page.splitlines() if not line.startswith("#")]
        return {name: float(value) for name, value in (line.rsplit(" ", 1) for line in lines)}


def _fill(connection: Connection, now: float) -> None:
    """Store positions that become too old while the disk is full."""
    began = now - KEPT_DAYS * DAY
    rows = [
        {"robot": "old", "received_at": began + DAY * k / OLD, "x": 1.0, "y": 1.0, "theta": 0.0, "v": 0.0}
        for k in range(OLD)
    ]
    # A clock that is far ahead of all that is stored deletes nothing.
    rows.append({**rows[-1], "received_at": now})
    connection.execute(insert(trajectories), rows)


def _found(connection: Connection, stops: list[str]) -> dict[str, Any]:
    def count(query: Any) -> int:
        return connection.execute(query).scalar_one()

    stored = select(func.count()).select_from(emergency_stops)
    newest = connection.execute(select(func.max(trajectories.c.received_at))).scalar_one()
    is_old = (trajectories.c.robot == "old") & (trajectories.c.received_at < newest - KEPT_DAYS * DAY - HOUR)
    return {
        "stops": count(stored.where(emergency_stops.c.id.in_(stops))),
        "in force": count(stored.where(emergency_stops.c.cleared_at.is_(None))),
        "open": connection.execute(
            select(commands.c.op, commands.c.state, func.count())
            .where(commands.c.state.in_(OPEN))
            .group_by(commands.c.op, commands.c.state)
        ).all(),
        "audit": count(select(func.count()).select_from(audit).where(audit.c.action == "emergency_stop")),
        "old": count(select(func.count()).select_from(trajectories).where(is_old)),
    }


def _lines(log: Path) -> list[str]:
    return log.read_text(errors="replace").splitlines()


def _megabytes(pid: int) -> float:
    text = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    return int(re.findall(r"VmRSS:\s+(\d+)", text)[0]) / 1000
