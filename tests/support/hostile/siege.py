"""A gateway under nonsense from every account that it knows, and three robots that must not notice.

On any database: robots over WebSocket, over a link and, under accounts of their own, over SQL; operators of
every role.
What is checked in between is what an operator needs: a command reaches its robot, an emergency stop reaches
every robot within a second, also after the gateway was killed.
"""

from __future__ import annotations

import contextlib
import importlib
import itertools
import json
import secrets
import socket
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from hypothesis import strategies as st
from sqlalchemy import make_url
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from robot_bridge.core.messages import DESK_REQUESTS, REQUESTS, Role
from robot_bridge.gateway.auth.accounts import add_link, add_operator, issue_robot_token
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from tests.support.hostile.fuzzing import Conversation, desk_frames, robot_frames, rr_rows
from tests.support.hostile.hostile_values import calls, frames, link_frames
from tests.support.patience import BUSY, START
from tests.support.processes import Processes

GOOD_WS, GOOD_SQL, BAD_WS, BAD_SQL = "good-ws", "good-sql", "bad-ws", "bad-sql"
GOOD_LINK, BAD_LINK, GOOD_LINKED, BAD_LINKED = "good-link", "bad-link", "good-linked", "bad-linked"
GATEWAY = "siege-gateway"
STOP_WITHIN = 1.0
"""seconds from an operator's emergency stop to each robot."""
POSE = {"x": 20.0, "y": 40.0, "theta": 0.0, "v": 0.0}
DRIVERS = {"sqlite": "sqlite3", "postgresql": "psycopg", "mariadb": "pymysql"}
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
_cases = [
    st.tuples(st.just("ws"), frames(REQUESTS) | frames(REQUESTS) | robot_frames),
    st.tuples(st.just("link"), link_frames | link_frames | robot_frames),
    st.tuples(st.just("sql"), rows),
]
_cases += [
    st.tuples(st.just(role.value), frames(DESK_REQUESTS) | frames(DESK_REQUESTS) | desk_frames)
    for role in Role
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
        self._passwords = {name: secrets.token_urlsafe(12) for name in (GOOD_SQL, BAD_SQL, GATEWAY)}
        run_once(url, revisions.create)
        if admin is not None:
            run_once(admin, self._add_accounts)
        self._tokens: dict[str, str] = run_once(admin or url, _issue_tokens)
        self._robots = {name: SqlRobot(self._address_of(name), name) for name in (GOOD_SQL, BAD_SQL)}
        self._owner = SqlClient(url)
        self._wires: list[Any] = []
        self._spoken: dict[str, Conversation] = {}
        self.start()

    def _add_accounts(self, connection: Any) -> None:
        keeper = role_manager_on(connection)
        for name in (GOOD_SQL, BAD_SQL):
            keeper.add_robot(name, self._passwords[name])
        keeper.add_gateway(GATEWAY, self._passwords[GATEWAY])

    def _address_of(self, account: str) -> str:
        if self._admin is None:
            return self.url
        base, _, name = self.url.rpartition("/")
        scheme, _, where = base.partition("://")
        host = where.rpartition("@")[2]
        side = f"{name}_robots" if scheme == "mariadb" and account != GATEWAY else name
        return f"{scheme}://{account}:{self._passwords[account]}@{host}/{side}"

    # --- the gateway ----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start the gateway, on the port that it had; its robots and its operators come back."""
        name = f"siege-{id(self)}-{next(self._runs)}"
        words = ["serve", "--site", self._site, "--port", str(self._port), "--state", self._site]
        words += ["--database", self._address_of(GATEWAY)]
        self.process = self._processes.start(name, [sys.executable, "-m", "robot_bridge", *map(str, words)])
        self._logs.append(name)
        found = self._processes.wait_for_line(name, r"listening on ws://127\.0\.0\.1:(\d+)", START)
        self._port = int(found.group(1))
        self._spoken.clear()
        self.good = WebSocketRobot(self._connect("/robot", GOOD_WS))
        self.desk = Operator(self._connect("/desk", Role.SUPERVISOR.value))
        self.good.plug_in()
        self.linked = LinkedRobot(self._connect("/link", GOOD_LINK), GOOD_LINKED)
        self.linked.plug_in()
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
            with contextlib.suppress(OSError):
                wire.socket.shutdown(socket.SHUT_RDWR)
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
            self._owner.run("insert into rr (robot, op, params, payload) values (?, ?, ?, ?)", *row)

    def _wait_until_read(self) -> None:
        # A robot's own account may not read rr.
        until = time.monotonic() + 10 * BUSY
        while self._owner.rows("select id from rr where robot not in (?, ?)", GOOD_SQL, GOOD_WS):
            assert time.monotonic() < until, "a row of rr is not dealt with"
            time.sleep(0.005)

    def _conversation(self, who: str) -> Conversation:
        if who not in self._spoken:
            if who == "ws":
                robot = WebSocketRobot(self._connect("/robot", BAD_WS))
                robot.plug_in()
                self._spoken[who] = Conversation(robot.wire, BAD_WS, "SendPos", POSE)
            elif who == "link":
                robot = LinkedRobot(self._connect("/link", BAD_LINK), BAD_LINKED)
                robot.plug_in()
                self._spoken[who] = Conversation(robot.wire, BAD_LINK, "status", {"ok": True})
            else:
                desk = Operator(self._connect("/desk", who))
                self._spoken[who] = Conversation(desk.wire, who, "get_commands", {"limit": 1})
        return self._spoken[who]

    def _connect(self, path: str, who: str) -> Any:
        headers = {"Authorization": f"Bearer {self._tokens[who]}"}
        url = f"ws://127.0.0.1:{self._port}{path}"
        options: dict[str, Any] = {"max_size": None, "compression": None, "ping_interval": None}
        # A wire with a bounded queue that nobody reads for a minute leaves pings unanswered.
        wire = connect(url, additional_headers=headers, max_queue=None, **options)
        self._wires.append(wire)
        return wire

    # --- what must hold all the same ------------------------------------------------------------------------

    def check(self, beside: Sequence[tuple[str, Any]] = ()) -> None:
        """Raise AssertionError where the gateway, a robot or an operator was harmed.

        ``beside`` is said, and not waited for, as the emergency stop is made.
        """
        assert self.process.poll() is None, f"the gateway ended: {self.log()[-2000:]}"
        self.desk.clear()
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
            params = {"x": 50.0, "y": 40.0}
            self.desk.ask("send", {"command": command, "robot": name, "op": "SetPosEnd", "params": params})
            robot.take("SetPosEnd", 10 * BUSY)

    def _check_stop(self) -> None:
        began = time.monotonic()
        stop = f"stop-{next(self._numbers):06}-{secrets.token_hex(4)}"
        self.desk.begin("emergency_stop", {"command": stop})
        for name, robot in self._good_robots():
            robot.take("Abort", STOP_WITHIN * BUSY)
            took = time.monotonic() - began
            assert took < STOP_WITHIN * BUSY, f"the stop took {took:.1f} s to {name}"
        self.slowest_stop = max(self.slowest_stop, time.monotonic() - began)
        self.desk.clear()

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


class Operator:
    """A supervisor who does what is right."""

    def __init__(self, wire: Any) -> None:
        self.wire = wire
        self._ids = itertools.count(1)
        self.ask("hello", {"operator": "Ada"})

    def begin(self, method: str, params: Any) -> str:
        """Ask something; return the id of the call."""
        id = f"right-{next(self._ids)}"
        self.wire.send(json.dumps({"jsonrpc": "2.0", "id": id, "method": method, "params": params}))
        return id

    def ask(self, method: str, params: Any) -> Any:
        """Ask something and return the result; raises AssertionError where it is refused."""
        answer = self._answer(self.begin(method, params))
        assert "error" not in answer, f"{method} was refused: {answer['error']}"
        return answer["result"]

    def clear(self) -> None:
        """Clear emergency stops, also those that came meanwhile, until none is in force."""
        until = time.monotonic() + 10 * BUSY
        while True:
            answer = self._answer(self.begin("clear_emergency_stop", {"reason": "the siege goes on"}))
            if "nothing to clear" in answer.get("error", {}).get("message", ""):
                return
            assert time.monotonic() < until, f"a stop cannot be cleared: {answer}"

    def _answer(self, id: str) -> Any:
        until = time.monotonic() + 10 * BUSY
        while True:
            frame = self.wire.recv(max(0.01, until - time.monotonic()))
            if isinstance(frame, str) and (answer := json.loads(frame)).get("id") == id:
                return answer


class WebSocketRobot:
    """A robot over WebSocket that does what is right."""

    def __init__(self, wire: Any) -> None:
        self.wire = wire

    def plug_in(self) -> None:
        """Say Ready, take the map, and say where it is."""
        self.wire.send('{"jsonrpc": "2.0", "id": 0, "method": "Ready", "params": {"magic": 1}}')
        self._hear(lambda frame: frame.get("id") == 0, 10 * BUSY)
        self._send({"method": "SendPos", "params": POSE})

    def take(self, op: str, seconds: float) -> None:
        """Take on everything up to the next ``op``."""
        self._hear(lambda frame: frame.get("method") == op, seconds)
        self._send({"method": "SendPos", "params": POSE})

    def _hear(self, wanted: Callable[[Any], bool], seconds: float) -> None:
        until = time.monotonic() + seconds
        while True:
            frame = json.loads(self.wire.recv(max(0.01, until - time.monotonic())))
            if "method" in frame and frame.get("id") is not None:
                self._send({"id": frame["id"], "result": {}})
            if wanted(frame):
                return

    def _send(self, frame: dict[str, Any]) -> None:
        self.wire.send(json.dumps({"jsonrpc": "2.0", **frame}))


class LinkedRobot(WebSocketRobot):
    """The only robot of a link, both of which do what is right."""

    def __init__(self, wire: Any, name: str) -> None:
        super().__init__(wire)
        self._name = name

    def plug_in(self) -> None:
        """Say hello for the link, then Ready for the robot, and where it is."""
        ready = {"robot": self._name, "magic": 1, "abilities": ["targets", "paths"]}
        for id, method, params in ((1, "hello", {"protocol": 1, "kind": "siege"}), (0, "Ready", ready)):
            self._send({"id": id, "method": method, "params": params})
            self._hear(lambda frame, id=id: frame.get("id") == id, 10 * BUSY)
        self._say_place()

    def take(self, op: str, seconds: float) -> None:
        """Take on everything up to the next ``op``; an Abort is the one for all robots of the link."""
        found: list[dict[str, Any]] = []

        def wanted(frame: dict[str, Any]) -> bool:
            if frame.get("method") != op or (op == "Abort" and "robot" in frame["params"]):
                return False
            found.append(frame)
            return True

        self._hear(wanted, seconds)
        if op == "Abort":
            self._send({"id": f"{self._name}/{found[0]['params']['call']}", "result": {}})
        self._say_place()

    def _say_place(self) -> None:
        self._send({"method": "SendPos", "params": {"robot": self._name, **POSE}})


class SqlClient:
    """A connection to the database at ``address``; each statement is committed at once."""

    def __init__(self, address: str) -> None:
        self._kind = address.partition(":")[0]
        self._address = address
        self._driver = importlib.import_module(DRIVERS[self._kind])
        self._connection: Any = None

    def close(self) -> None:
        """Close the connection; the next statement makes another."""
        if self._connection is not None:
            self._connection.close()
        self._connection = None

    def rows(self, text: str, *values: Any) -> list[Any]:
        """Return the rows of a query; ``?`` stands for a value on every kind of database."""
        return list(self.run(text, *values).fetchall())

    def run(self, text: str, *values: Any) -> Any:
        """Run a statement; return its cursor. Raises the driver's errors."""
        if self._kind != "sqlite":
            text = text.replace("?", "%s")
        cursor = self._open().cursor()
        cursor.execute(text, values)
        return cursor

    def _open(self) -> Any:
        if self._connection is None:
            self._connection = self._connect()
        return self._connection

    def _connect(self) -> Any:
        url = make_url(self._address)
        if self._kind == "sqlite":
            return self._driver.connect(str(url.database), timeout=20, isolation_level=None)
        where: dict[str, Any] = {"host": url.host, "port": url.port, "user": url.username}
        name = "dbname" if self._kind == "postgresql" else "database"
        where |= {"password": url.password, name: url.database, "autocommit": True}
        return self._driver.connect(**where)


class SqlRobot(SqlClient):
    """A robot that reads and writes tables sa and rr, under its own account where there is one."""

    def __init__(self, address: str, name: str) -> None:
        super().__init__(address)
        self._name = name
        self._taken: set[int] = set()

    def plug_in(self) -> None:
        """Say Ready, take the map, and say where it is."""
        self.write("Ready", '{"magic": 1}')
        self.take("SetMap", 10 * BUSY)

    def take(self, op: str, seconds: float) -> None:
        """Take on everything in sa, until that was ``op``."""
        until = time.monotonic() + seconds
        while True:
            for id, found in self.rows(
                "select id, op from sa where robot = ? order by urgent desc, id", self._name
            ):
                if id in self._taken:
                    continue
                self._taken.add(id)
                self.write("OpAck", json.dumps({"id": id}))
                if found == op:
                    self.write("SendPos", json.dumps(POSE))
                    return
            assert time.monotonic() < until, f"{op} did not reach {self._name} within {seconds:g} s"
            time.sleep(0.01)

    def write(self, op: Any, params: Any, payload: Any = None) -> None:
        """Write a row of rr; what the database itself refuses is no row."""
        values = (self._name, op, params, payload)
        try:
            self.run("insert into rr (robot, op, params, payload) values (?, ?, ?, ?)", *values)
        except UnicodeEncodeError:
            return
        except self._driver.DataError:
            return
        except self._driver.Error:
            self.close()
