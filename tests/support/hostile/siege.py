"""A gateway under nonsense from every account that it knows, and three robots that must not notice.

On any database: robots over WebSocket, over a link and, under accounts of their own, over SQL; operators of
every role.
What is checked in between is what an operator needs: a command reaches its robot, an emergency stop reaches
every robot within a second, also after the gateway was killed.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import secrets
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed

from robot_bridge.core.messages.base import DESK_REQUESTS, Role
from robot_bridge.core.messages.robots import REQUESTS
from robot_bridge.gateway.auth.accounts import add_link, add_operator, issue_robot_token
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from tests.support.bridge.bridge_accounts import bearing
from tests.support.databases.database_client import DatabaseClient
from tests.support.databases.database_server import add_accounts
from tests.support.fleet import serve
from tests.support.hostile.fuzzing import Conversation, desk_frames, robot_frames, rr_rows
from tests.support.hostile.hostile_values import as_often, calls, frames, link_frames
from tests.support.operators import Desk
from tests.support.patience import BUSY
from tests.support.processes import Processes
from tests.support.robots.robot_wires import INSERT, RobotWire, SqlRobot
from tests.support.wire import RefusedError, Wire

GOOD_WS, GOOD_SQL, BAD_WS, BAD_SQL = "good-ws", "good-sql", "bad-ws", "bad-sql"
GOOD_LINK, BAD_LINK, GOOD_LINKED, BAD_LINKED = "good-link", "bad-link", "good-linked", "bad-linked"
GATEWAY = "siege-gateway"
STOP_WITHIN = 1.0
"""seconds from an operator's emergency stop to each robot."""
POSE = {"x": 20.0, "y": 40.0, "theta": 0.0, "v": 0.0}
GENEROUS = """
[limits]
robot_messages_per_s = 100000
robot_burst = 100000
link_messages_per_s = 100000
link_burst = 100000
desk_messages_per_s = 100000
desk_burst = 100000
failed_logins_per_minute = 100000
"""
"""For the site's settings: that much of it is refused by number shows nothing of what is in it."""

rows = st.one_of(
    calls(REQUESTS).map(lambda call: (*call, None)),
    calls({"OpAck": REQUESTS["OpAck"]}).map(lambda call: (*call, None)),
    st.tuples(
        st.sampled_from(sorted(REQUESTS))
        | st.text(max_size=8)
        | st.sampled_from(["Abort", "\x00", "x" * 300]),
        st.none() | st.text(max_size=30) | st.binary(max_size=30),
        st.none() | st.binary(max_size=2000),
    ),
)
"""What a robot's own account may write into rr: op, params and payload."""
_of_robots = as_often(frames(REQUESTS), 2) | robot_frames
_of_desks = as_often(frames(DESK_REQUESTS), 2) | desk_frames
_cases = [
    st.tuples(st.just("ws"), _of_robots),
    st.tuples(st.just("link"), link_frames | robot_frames),
    st.tuples(st.just("sql"), rows),
    *[st.tuples(st.just(role.value), _of_desks) for role in Role],
]


WORST_ROWS = [
    *[("OpAck", text * depth, None) for text in ("[", '{"a":') for depth in (500, 2000, 50_000)],
    *[("OpAck", f'{{"id": {id}}}', None) for id in ("true", "1e0", "[" * 2000, "9" * 5000, "1e400", "NaN")],
    *[
        ("OpAck", f'{{"id": 1, "ok": false, "reason": "{reason}"}}', None)
        for reason in ("\\u0000", "\\ud800")
    ],
    ("Ready", '{"magic": ' + "[" * 2000, None),
    ("SetObject", '{"x": 1e308, "y": 1e308, "object": "\\u0000"}', None),
    ("\x00", "\x00", b"\x00"),
]
"""Rows that have harmed a gateway, and their like; for every run."""


def cases(kind: str) -> st.SearchStrategy[tuple[str, Any]]:
    """Return who says it, and what: of every account as much. In an SQLite file anybody writes any name."""
    anybody = [st.tuples(st.just("anybody"), rr_rows)] if kind == "sqlite" else []
    return st.one_of([*_cases, *anybody])


unread_rows = st.tuples(st.just("sql"), rows)
"""Cases of :func:`cases` that can be said while no gateway is there."""


class Siege:
    """One gateway on the database ``url``, whose ``admin`` may make accounts (None: an SQLite file)."""

    def __init__(self, processes: Processes, site: Path, url: str, admin: str | None) -> None:
        self.url, self.kind = url, url.partition(":")[0]
        self._processes, self._site, self._admin = processes, site, admin
        self._runs = itertools.count(1)
        self._numbers = itertools.count(1)
        self._port = 0
        self.slowest_stop = 0.0
        """seconds that the slowest emergency stop took to the last robot."""
        self._logs: list[str] = []
        robots = (GOOD_SQL, BAD_SQL)
        if run_once(url, revisions.current) is None:
            run_once(url, revisions.create)
        self._urls = dict.fromkeys((*robots, GATEWAY), url)
        if admin is not None:
            self._urls = add_accounts(url, admin, robots, GATEWAY)
        self._tokens: dict[str, str] = run_once(admin or url, _issue_tokens)
        self._robots = {name: RowRobot(self._urls[name], name) for name in robots}
        self._owner = DatabaseClient(url)
        self._wires: list[Wire] = []
        self._spoken: dict[str, Conversation] = {}
        self.start()

    # --- the gateway ----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start the gateway, on the port that it had; its robots and its operators come back."""
        name = f"siege-{id(self)}-{next(self._runs)}"
        self._logs.append(name)
        served = serve(
            self._processes,
            self._site,
            self._urls[GATEWAY],
            "--state",
            self._site,
            port=self._port,
            name=name,
            forked=True,
        )
        self.process, self._port = served.process, served.port
        self._spoken.clear()
        self.good = self._connect(WebSocketRobot, "/robot", GOOD_WS)
        self.desk = self._connect(Desk, "/desk", Role.SUPERVISOR.value, "Ada")
        self.good.plug_in()
        self.linked = self._connect(LinkedRobot, "/link", GOOD_LINK)
        self.linked.plug_in(GOOD_LINKED)
        self._robots[GOOD_SQL].plug_in()
        self._robots[BAD_SQL].write("Ready", '{"magic": 1}')

    def kill(self) -> None:
        """End the gateway the way a power cut does."""
        self.process.kill()
        self.process.wait(10)
        self._hang_up()

    def close(self) -> None:
        """End the gateway, the connections to the database, and the accounts of robots on its server."""
        self._hang_up()
        self.process.terminate()
        self.process.wait(30)
        for client in (self._owner, *self._robots.values()):
            client.close()
        if self._admin is not None:
            for name in self._robots:
                run_once(
                    self._admin, lambda connection, name=name: role_manager_on(connection).remove_robot(name)
                )

    def _hang_up(self) -> None:
        for wire in self._wires:
            wire.hang_up()
        self._wires.clear()

    def log(self) -> str:
        """Return what the gateway said, of every start."""
        texts = [
            self._processes.log(name).read_text(encoding="utf-8", errors="replace") for name in self._logs
        ]
        return "\n".join(texts)

    # --- the nonsense ---------------------------------------------------------------------------------------

    def say(self, case: tuple[str, Any], *, unread: bool = False) -> None:
        """Say one of :data:`cases`; raise AssertionError for what must not come back, or when nothing does.

        With ``unread`` nobody is there to read it: only rows are written.
        """
        who, what = case
        if who in ("sql", "anybody"):
            self._write(who, what)
            if not unread:
                self._wait_until_read()
            return
        if unread:
            return
        try:
            self._conversation(who).say(what)
        except UnicodeEncodeError:
            return
        except ConnectionClosed as closed:
            # Whoever says too much at once is cut off, and comes back.
            code = closed.rcvd.code if closed.rcvd is not None else None
            assert code not in (None, 1006, 1011), f"{who} was cut off with {code}: {str(what)[:200]!r}"
            del self._spoken[who]

    def _write(self, who: str, row: tuple[Any, ...]) -> None:
        if who == "sql":
            self._robots[BAD_SQL].write(*row)
            return
        with contextlib.suppress(UnicodeEncodeError):
            self._owner.sql(INSERT, *row)

    def _wait_until_read(self) -> None:
        # A robot's own account may not read rr.
        until = time.monotonic() + 10 * BUSY
        while self._owner.sql("select id from rr where robot not in (?, ?)", GOOD_SQL, GOOD_WS):
            assert time.monotonic() < until, "a row of rr is not dealt with"
            time.sleep(0.005)

    def _conversation(self, who: str) -> Conversation:
        if who not in self._spoken:
            if who == "ws":
                robot = self._connect(WebSocketRobot, "/robot", BAD_WS)
                robot.plug_in()
                self._spoken[who] = Conversation(robot.connection, BAD_WS, "SendPos", POSE)
            elif who == "link":
                linked = self._connect(LinkedRobot, "/link", BAD_LINK)
                linked.plug_in(BAD_LINKED)
                self._spoken[who] = Conversation(linked.connection, BAD_LINK, "status", {"ok": True})
            else:
                desk = self._connect(Desk, "/desk", who, "Ada")
                self._spoken[who] = Conversation(desk.connection, who, "get_commands", {"limit": 1})
        return self._spoken[who]

    def _connect(self, kind: type[Wire], path: str, who: str, *words: str) -> Any:
        wire = kind(f"ws://127.0.0.1:{self._port}{path}", *words, **bearing(self._tokens[who]))
        self._wires.append(wire)
        return wire

    # --- what must hold all the same ------------------------------------------------------------------------

    def check(self, beside: Sequence[tuple[str, Any]] = ()) -> None:
        """Raise AssertionError where the gateway, a robot or an operator was harmed.

        ``beside`` is said, and not waited for, as the emergency stop is made.
        """
        assert self.process.poll() is None, f"the gateway ended: {self.log()[-2000:]}"
        self._clear_stop()
        self._check_commands()
        for case in beside:
            self.say(case, unread=True)
        self._check_stop()
        self.check_log()

    def check_log(self) -> None:
        """Raise AssertionError where the log tells of something that nobody foresaw."""
        log = self.log()
        at = log.find("Traceback")
        assert at < 0, log[max(0, at - 1000) : at + 3000]
        assert "internal error" not in log, log[max(0, log.find("internal error") - 1000) :][:3000]

    def _check_commands(self) -> None:
        for name, robot in self._good_robots():
            command = f"siege-{next(self._numbers):06}-{secrets.token_hex(4)}"
            self.desk.send(command, name, "SetPosEnd", x=50.0, y=40.0)
            robot.carry_out("SetPosEnd", 10)

    def _check_stop(self) -> None:
        began = time.monotonic()
        stop = f"stop-{next(self._numbers):06}-{secrets.token_hex(4)}"
        self.desk.begin("emergency_stop", {"command": stop})
        for name, robot in self._good_robots():
            robot.carry_out("Abort", STOP_WITHIN)
            took = time.monotonic() - began
            assert took < STOP_WITHIN * BUSY, f"the stop took {took:.1f} s to {name}"
        self.slowest_stop = max(self.slowest_stop, time.monotonic() - began)
        self._clear_stop()

    def _clear_stop(self) -> None:
        """Clear emergency stops, also those that came meanwhile, until none is in force."""
        until = time.monotonic() + 10 * BUSY
        while time.monotonic() < until:
            try:
                self.desk.ask("clear_emergency_stop", {"reason": "the siege goes on"})
            except RefusedError as error:
                if "nothing to clear" in str(error):
                    return
        raise AssertionError("a stop cannot be cleared")

    def _good_robots(self) -> Iterator[tuple[str, Any]]:
        yield GOOD_SQL, self._robots[GOOD_SQL]
        yield GOOD_WS, self.good
        yield GOOD_LINKED, self.linked


def _issue_tokens(connection: Any) -> dict[str, str]:
    now = time.time()
    tokens = {name: issue_robot_token(connection, name, now) for name in (GOOD_WS, BAD_WS)}
    for link, robot in ((GOOD_LINK, GOOD_LINKED), (BAD_LINK, BAD_LINKED)):
        tokens[link] = add_link(connection, link, [f"{robot}*"], now)
    return tokens | {role.value: add_operator(connection, f"Ada-{role.value}", role, now) for role in Role}


class WebSocketRobot(RobotWire):
    """A robot over WebSocket that does what is right."""

    def plug_in(self) -> None:
        """Say Ready, take the map, and say where it is."""
        self.ask("Ready", {"magic": 1})
        self.say_place()

    def carry_out(self, op: str, seconds: float) -> None:
        """Take on everything up to the next ``op``."""
        self.obey_until(op, seconds)
        self.say_place()

    def say_place(self) -> None:
        """Say where it is."""
        self.tell("SendPos", POSE)


class LinkedRobot(RobotWire):
    """The only robot of a link, both of which do what is right."""

    def plug_in(self, name: str) -> None:
        """Say hello for the link, then Ready for the robot, and where it is."""
        self._name = name
        self.ask("hello", {"protocol": 1, "kind": "siege"})
        self.ask("Ready", {"robot": name, "magic": 1, "abilities": ["targets", "paths"]})
        self.say_place()

    def carry_out(self, op: str, seconds: float) -> None:
        """Take on everything up to the next ``op``; an Abort is the one for all robots of the link."""
        call = self.obey_until(op, seconds)
        while op == "Abort" and "robot" in call["params"]:
            call = self.obey_until(op, seconds)
        if op == "Abort":
            self.say(f"{self._name}/{call['params']['call']}")
        self.say_place()

    def say_place(self) -> None:
        """Say where it is."""
        self.tell("SendPos", {"robot": self._name, **POSE})


class RowRobot(SqlRobot):
    """A robot on tables sa and rr that leaves in sa what it has read, and writes whatever it is handed."""

    def __init__(self, url: str, name: str) -> None:
        super().__init__(url, name)
        self._read: set[int] = set()

    def plug_in(self) -> None:
        """Say Ready, take the map, and say where it is."""
        self.write("Ready", '{"magic": 1}')
        self.carry_out("SetMap", 10)

    def carry_out(self, op: str, seconds: float) -> None:
        """Take on everything in sa, until that was ``op``."""
        until = time.monotonic() + BUSY * seconds
        while True:
            for id, found, _, _ in self.waiting():
                if id in self._read:
                    continue
                self._read.add(id)
                self.write("OpAck", json.dumps({"id": id}))
                if found == op:
                    self.write("SendPos", json.dumps(POSE))
                    return
            assert time.monotonic() < until, f"{op} did not reach {self.name} within {BUSY * seconds:g} s"
            time.sleep(0.01)

    def write(self, op: Any, params: Any = None, payload: bytes | None = None) -> None:
        """Write a row of rr; what the database itself refuses is no row."""
        try:
            super().write(op, params, payload)
        except (UnicodeEncodeError, self.driver.DataError):
            return
        except self.driver.Error:
            self.close()
