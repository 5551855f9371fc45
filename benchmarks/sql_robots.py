"""Robots on SQL that ask and wait for the answer, a thread and a connection for each, with plain drivers.

``python sql_robots.py < PLAN`` prints what they saw as JSON; the plan is a :class:`Plan` as JSON.
"""

from __future__ import annotations

import itertools
import json
import random
import select
import sqlite3
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any
from urllib.parse import unquote, urlsplit

PATIENCE_S = 20.0
READ = "select id, op from sa where robot = %s order by urgent desc, id"
INSERT = "insert into rr (robot, op, params) values (%s, %s, %s)"
DELETE = "delete from sa where id = %s"
PREPARED = {READ: "read_answers", INSERT: "write_request", DELETE: "delete_answer"}


@dataclass(frozen=True)
class Plan:
    """Robots' names and URLs, for how long and how often a second they ask (0: again once answered).

    Without notifications they look first after ``poll`` seconds, then less and less often. Those that are not
    ``durable`` do not wait for the server's disk, where they have a choice.
    """

    robots: dict[str, str]
    seconds: float
    rate: float
    poll: float
    durable: bool = True


@dataclass
class Seen:
    """Seconds from each request to the OpAck in the robot's hand."""

    times: list[float] = field(default_factory=list)
    seconds: float = 0.0
    failed: list[str] = field(default_factory=list)


class Client(ABC):
    """One robot's connection."""

    def __init__(self, name: str, plan: Plan) -> None:
        self.name, self.plan = name, plan
        self.connection = self.connect(plan.robots[name])

    @abstractmethod
    def connect(self, url: str) -> Any:
        """Return a connection whose statements are committed one by one."""

    def ask(self, op: str, params: str | None = None) -> None:
        """Write a request."""
        self.run((INSERT, (self.name, op, params)))

    def read(self) -> list[tuple[int, str]]:
        """Return the ids and operation codes of what is answered."""
        return list(self.run((READ, (self.name,))))

    def delete(self, ids: Sequence[int]) -> None:
        """Delete what was read."""
        self.run(*((DELETE, (id,)) for id in ids))

    def delete_and_ask(self, ids: Sequence[int], op: str) -> None:
        """Delete what was read and write the next request, in one transaction."""
        self.run(*((DELETE, (id,)) for id in ids), (INSERT, (self.name, op, None)))

    def wait(self, looks: int) -> None:
        """Wait until it is time to look again after so many looks: soon, then less and less often."""
        time.sleep(self.plan.poll * 1.5 ** min(looks, 6))

    def wait_for(self, op: str) -> list[int]:
        """Return the ids of all that is answered, once an ``op`` is among it."""
        until = time.perf_counter() + PATIENCE_S
        for looks in itertools.count():
            self.wait(looks)
            rows = self.read()
            if any(row[1] == op for row in rows):
                return [row[0] for row in rows]
            if time.perf_counter() > until:
                raise TimeoutError(f"{self.name}: no {op} within {PATIENCE_S:g} s")
        raise AssertionError("the loop ends by itself")

    @abstractmethod
    def run(self, *statements: tuple[str, tuple[Any, ...]]) -> Any:
        """Run statements in one transaction; return the rows of the last, if it has any."""


class SQLite(Client):
    """Looks again and again."""

    def connect(self, url: str) -> Any:
        file = url.removeprefix("sqlite:///")
        connection = sqlite3.connect(file, timeout=PATIENCE_S, isolation_level=None, check_same_thread=False)
        # A request that a power cut takes has no answer, and is asked again.
        connection.execute("pragma synchronous = normal")
        return connection

    def run(self, *statements: tuple[str, tuple[Any, ...]]) -> Any:
        if len(statements) > 1:
            self.connection.execute("begin immediate")
        found = [self.connection.execute(text.replace("%s", "?"), values) for text, values in statements]
        rows = found[-1].fetchall()
        if len(statements) > 1:
            self.connection.execute("commit")
        return rows


class MariaDB(Client):
    """Looks again and again, by prepared statements: the server reads a view anew for any other.

    By a driver in C: one in Python takes as long for a request as the gateway does, and what many robots'
    drivers take on their own computers would be taken from the server here.
    """

    def connect(self, url: str) -> Any:
        import MySQLdb
        from MySQLdb.constants import CLIENT

        connection = MySQLdb.connect(
            **where(url),
            database=urlsplit(url).path[1:],
            autocommit=True,
            read_timeout=int(PATIENCE_S),
            client_flag=CLIENT.MULTI_STATEMENTS,
            # At the level that MariaDB begins with, many robots' inserts lock each other out.
            init_command="set session transaction isolation level read committed",
        )
        with connection.cursor() as cursor:
            for text, name in PREPARED.items():
                cursor.execute(f"prepare {name} from %s", (text.replace("%s", "?"),))
        return connection

    def run(self, *statements: tuple[str, tuple[Any, ...]]) -> Any:
        text = "; ".join(
            f"execute {PREPARED[text]} using {', '.join(['%s'] * len(values))}" for text, values in statements
        )
        values = [value for _, values in statements for value in values]
        with self.connection.cursor() as cursor:
            cursor.execute(f"begin; {text}; commit" if len(statements) > 1 else text, values)
            rows = cursor.fetchall()
            while cursor.nextset():
                pass
        return rows


class PostgreSQL(Client):
    """Is told by a notification."""

    def connect(self, url: str) -> Any:
        import psycopg

        options = "" if self.plan.durable else "-c synchronous_commit=off"
        connection = psycopg.connect(
            **where(url), dbname=urlsplit(url).path[1:], autocommit=True, options=options
        )
        self.ear = Ear(connection, f"sa_{self.name}")
        return connection

    def run(self, *statements: tuple[str, tuple[Any, ...]]) -> Any:
        if len(statements) == 1:
            cursor = self.connection.execute(*statements[0])
            return cursor.fetchall() if cursor.description else []
        # What is sent before the next sync is one transaction.
        with self.connection.pipeline():
            for text, values in statements:
                self.connection.execute(text, values)
        return []

    def wait(self, looks: int) -> None:
        """Wait for a notification, or a second."""
        self.ear.wait()


KINDS = {"sqlite": SQLite, "postgresql": PostgreSQL, "mariadb": MariaDB}


def where(url: str) -> dict[str, Any]:
    """Return what a driver connects with."""
    parts = urlsplit(url)
    return {
        "host": parts.hostname,
        "port": parts.port,
        "user": unquote(parts.username or ""),
        "password": unquote(parts.password or ""),
    }


class Ear:
    """Hears notifications on a connection of psycopg, at less cost than the driver's own way."""

    def __init__(self, connection: Any, channel: str) -> None:
        self._wire = connection.pgconn
        self._heard: deque[Any] = deque(maxlen=1)
        # The driver hands over those that come along with the answer to a statement.
        connection.add_notify_handler(self._heard.append)
        connection.execute(f'listen "{channel}"')

    def wait(self) -> None:
        """Return once there was a notification since the last call, or after a second."""
        if not self._heard:
            select.select([self._wire.socket], [], [], 1.0)
            self._wire.consume_input()
            while self._wire.notifies():
                pass
        self._heard.clear()


def _moments(plan: Plan, number: int, begin: float) -> Iterator[float]:
    """Yield when to ask, spread evenly over the robots."""
    at = begin + number / len(plan.robots) / plan.rate + random.random() * 0.01
    while True:
        yield at
        at += 1 / plan.rate


def _live(client: Client, plan: Plan, number: int, begin: float, seen: Seen) -> None:
    try:
        if plan.rate:
            _ask_at_times(client, _moments(plan, number, begin), begin + plan.seconds, seen)
        else:
            _ask_on_and_on(client, begin, begin + plan.seconds, seen)
    except Exception as error:
        seen.failed.append(f"{type(error).__name__}: {error}")


def _ask_at_times(client: Client, moments: Iterator[float], end: float, seen: Seen) -> None:
    for at in itertools.takewhile(lambda at: at < end, moments):
        time.sleep(max(0.0, at - time.perf_counter()))
        asked = time.perf_counter()
        client.ask("Stopped")
        client.delete(client.wait_for("OpAck"))
        seen.times.append(time.perf_counter() - asked)


def _ask_on_and_on(client: Client, begin: float, end: float, seen: Seen) -> None:
    time.sleep(max(0.0, begin - time.perf_counter()))
    read: list[int] = []
    asked = time.perf_counter()
    while asked < end:
        client.delete_and_ask(read, "Stopped")
        read = client.wait_for("OpAck")
        seen.times.append(time.perf_counter() - asked)
        asked = time.perf_counter()
    client.delete(read)


def run(plan: Plan) -> Seen:
    """Let all robots ask, and return what they saw."""
    clients = [KINDS[url.split(":")[0]](name, plan) for name, url in plan.robots.items()]
    for number, client in enumerate(clients):
        client.ask("Ready", json.dumps({"magic": number}))
    for client in clients:
        client.delete(client.wait_for("SetMap"))
    seen, begin = Seen(), time.perf_counter() + 0.2
    threads = [
        threading.Thread(target=_live, args=(client, plan, number, begin, seen))
        for number, client in enumerate(clients)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    seen.seconds = time.perf_counter() - begin
    return seen


if __name__ == "__main__":
    print(json.dumps(asdict(run(Plan(**json.load(sys.stdin))))))
