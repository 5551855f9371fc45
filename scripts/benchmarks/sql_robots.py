"""Robots on SQL that ask and wait for the answer, a thread and a connection for each, with plain drivers.

``python sql_robots.py < PLAN`` prints what they saw as JSON; the plan is a :class:`Plan` as JSON.
"""

from __future__ import annotations

import contextlib
import itertools
import json
import random
import sqlite3
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from typing import Any
from urllib.parse import unquote, urlsplit

PATIENCE_S = 20.0
READ = "select id, op from sa where robot = {mark} order by urgent desc, id"
INSERT = "insert into rr (robot, op, params) values ({mark}, {mark}, {mark})"
DELETE = "delete from sa where id = {mark}"


@dataclass(frozen=True)
class Plan:
    """Robots' names and URLs, for how long and how often a second they ask (0: again once answered).

    Without notifications they look first after ``poll`` seconds, then less and less often.
    """

    robots: dict[str, str]
    seconds: float
    rate: float
    poll: float


@dataclass
class Seen:
    """Seconds from each request to the OpAck in the robot's hand."""

    times: list[float] = field(default_factory=list)
    seconds: float = 0.0
    failed: list[str] = field(default_factory=list)


class Client(ABC):
    """One robot's connection."""

    mark = "%s"

    def __init__(self, name: str, url: str, poll: float) -> None:
        self.name, self.poll = name, poll
        self.connection = self.connect(url)

    @abstractmethod
    def connect(self, url: str) -> Any:
        """Return a connection whose statements are committed one by one."""

    def ask(self, op: str, params: str | None = None) -> None:
        """Write a request."""
        self._run(INSERT.format(mark=self.mark), self.name, op, params)

    def read(self) -> list[str]:
        """Read and delete what is answered; return the operation codes."""
        rows = self._run(READ.format(mark=self.mark), self.name)
        for id, _ in rows:
            self._run(DELETE.format(mark=self.mark), id)
        return [op for _, op in rows]

    def wait(self, looks: int) -> None:
        """Wait until it is time to look again after so many looks: soon, then less and less often."""
        time.sleep(self.poll * 1.5 ** min(looks, 6))

    def wait_for(self, op: str) -> None:
        """Return when ``op`` was read."""
        until = time.perf_counter() + PATIENCE_S
        for looks in itertools.count():
            if op in self.read():
                return
            if time.perf_counter() > until:
                raise TimeoutError(f"{self.name}: no {op} within {PATIENCE_S:g} s")
            self.wait(looks)

    def _run(self, text: str, *values: Any) -> list[Any]:
        with contextlib.closing(self.connection.cursor()) as cursor:
            cursor.execute(text, values)
            return [] if cursor.description is None else list(cursor.fetchall())


class SQLite(Client):
    """Looks again and again."""

    mark = "?"

    def connect(self, url: str) -> Any:
        file = url.removeprefix("sqlite:///")
        connection = sqlite3.connect(file, timeout=PATIENCE_S, isolation_level=None, check_same_thread=False)
        # A request that a power cut takes has no answer, and is asked again.
        connection.execute("pragma synchronous = normal")
        return connection


class MariaDB(Client):
    """Looks again and again."""

    def connect(self, url: str) -> Any:
        import pymysql

        return pymysql.connect(
            **_where(url),
            database=urlsplit(url).path[1:],
            autocommit=True,
            read_timeout=PATIENCE_S,
            # At the level that MariaDB begins with, many robots' inserts lock each other out.
            init_command="set session transaction isolation level read committed",
        )


class PostgreSQL(Client):
    """Is told by a notification."""

    def connect(self, url: str) -> Any:
        import psycopg

        connection = psycopg.connect(**_where(url), dbname=urlsplit(url).path[1:], autocommit=True)
        connection.execute(f'listen "sa_{self.name}"')
        return connection

    def wait(self, looks: int) -> None:
        """Wait for a notification, or a second."""
        for _ in self.connection.notifies(timeout=1.0, stop_after=1):
            pass


KINDS = {"sqlite": SQLite, "postgresql": PostgreSQL, "mariadb": MariaDB}


def _where(url: str) -> dict[str, Any]:
    parts = urlsplit(url)
    return {
        "host": parts.hostname,
        "port": parts.port,
        "user": unquote(parts.username or ""),
        "password": unquote(parts.password or ""),
    }


def _moments(plan: Plan, number: int, begin: float) -> Iterator[float]:
    """Yield when to ask, spread evenly over the robots; without a rate that is at once."""
    if not plan.rate:
        while True:
            yield 0.0
    at = begin + number / len(plan.robots) / plan.rate + random.random() * 0.01
    while True:
        yield at
        at += 1 / plan.rate


def _live(client: Client, plan: Plan, number: int, begin: float, seen: Seen) -> None:
    try:
        for at in _moments(plan, number, begin):
            time.sleep(max(0.0, at - time.perf_counter()))
            asked = time.perf_counter()
            if asked > begin + plan.seconds:
                return
            client.ask("Stopped")
            client.wait_for("OpAck")
            seen.times.append(time.perf_counter() - asked)
    except Exception as error:
        seen.failed.append(f"{type(error).__name__}: {error}")


def run(plan: Plan) -> Seen:
    """Let all robots ask, and return what they saw."""
    clients = [KINDS[url.split(":")[0]](name, url, plan.poll) for name, url in plan.robots.items()]
    for number, client in enumerate(clients):
        client.ask("Ready", json.dumps({"magic": number}))
    for client in clients:
        client.wait_for("SetMap")
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
