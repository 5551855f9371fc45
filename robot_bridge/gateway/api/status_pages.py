"""``/healthz`` and ``/metrics``: how the gateway is, for whoever watches over it."""

from __future__ import annotations

import asyncio
import http
import json
import logging
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from typing import Any

from sqlalchemy import Connection, func, select
from websockets.http11 import Response

from ...core.errors import BridgeError
from ...core.messages.safety import RobotState
from ..auth.port import http_response
from ..fleet.service import Fleet
from ..monitoring import CONTENT_TYPE, MetricReading, Metrics, Values, gateway_version
from ..storage.schema import rr, sa

log = logging.getLogger(__name__)

HEALTH, METRICS = "/healthz", "/metrics"
ANSWER_WITHIN = 2.0
"""seconds after which a database that says nothing counts as away."""
TOO_OLD = 10.0
"""seconds since the last success after which a task of the gateway counts as stuck."""
WATCHED = ("save", "sql link")


class StatusPages:
    """Answers requests for the two pages."""

    def __init__(self, fleet: Fleet, metrics: Metrics) -> None:
        self._fleet = fleet
        self._metrics = metrics
        self._began = time.monotonic()
        self._waiting: Values = {}
        self._database_up = False
        metrics.add(self._readings())
        metrics.add(self._link_readings())

    async def health(self) -> Response:
        """Return 200 when all is well and 503 when not, with JSON that says what is not."""
        latency = await self._database_latency()
        tasks = {name.replace(" ", "_"): self._task(name) for name in WATCHED}
        site = self._fleet.site.report
        well = latency is not None and all(task["ok"] for task in tasks.values())
        found = {
            "status": "ok" if well else "failing",
            "version": gateway_version(),
            "site": {"id": site.id, "version": site.version},
            "database": {"ok": latency is not None, "latency_s": latency},
            "links": {one.link: {"ok": one.up, "text": one.text} for one in self._fleet.links.report().links},
            "routes": self._routes(),
            **tasks,
        }
        status = http.HTTPStatus.OK if well else http.HTTPStatus.SERVICE_UNAVAILABLE
        return _page(status, "application/json", json.dumps(found).encode() + b"\n")

    async def metrics(self) -> Response:
        """Return every number in the format of Prometheus."""
        await self._database_latency()
        return _page(http.HTTPStatus.OK, CONTENT_TYPE, self._metrics.page())

    async def _database_latency(self) -> float | None:
        began = time.perf_counter()
        try:
            async with asyncio.timeout(ANSWER_WITHIN):
                self._waiting = await self._fleet.database.run(_waiting)
        except (BridgeError, TimeoutError) as error:
            log.debug("the database does not answer: %s", error)
            self._database_up, self._waiting = False, {}
            return None
        self._database_up = True
        return round(time.perf_counter() - began, 4)

    def _routes(self) -> dict[str, Any] | None:
        """Return what finds ways; all is well without the fastest, which is started again."""
        planner = self._fleet.roads.planner
        report = None if planner is None else planner.engine_report
        return None if report is None else asdict(report)

    def _task(self, name: str) -> dict[str, Any]:
        age = self._fleet.tally.age(name)
        since = time.monotonic() - self._began if age is None else age
        return {"ok": since < TOO_OLD, "age_s": None if age is None else round(age, 3)}

    def _readings(self) -> Iterator[MetricReading]:
        fleet, recorder = self._fleet, self._fleet.recorder
        yield MetricReading(
            "robot_bridge_info", "What runs here.", ("version", "site", "site_version"), self._info
        )
        yield MetricReading("robot_bridge_robots", "Robots by liveness.", ("state",), self._robots)
        yield MetricReading(
            "robot_bridge_robot_pose_age_seconds",
            "Since a robot said where it is.",
            ("robot",),
            self._pose_ages,
        )
        yield MetricReading(
            "robot_bridge_open_commands", "Commands with a step to come.", ("state",), self._commands
        )
        yield _single("desk_sessions", "Operators that are connected.", lambda: len(fleet.listeners))
        yield _single("emergency_stop", "1 while one is in force.", lambda: fleet.emergency.in_force)
        yield _single("database_up", "1 while the database answers.", lambda: self._database_up)
        yield _single("database_queue", "Work that waits for the database.", lambda: fleet.database.waiting)
        yield _single("waiting_positions", "Positions that wait to be stored.", lambda: recorder.waiting)
        yield MetricReading(
            "robot_bridge_positions_given_up", "Positions that could not be stored.", (),
            lambda: {(): float(recorder.given_up)}, counts=True,
        )  # fmt: skip
        yield MetricReading(
            "robot_bridge_waiting_messages", "Rows in rr and sa.", ("table",), lambda: self._waiting
        )
        yield MetricReading(
            "robot_bridge_task_age_seconds", "Since a task did its work.", ("task",), self._task_ages
        )

    def _link_readings(self) -> Iterator[MetricReading]:
        links = self._fleet.links
        for name, text in (
            ("up", "1 while a link is connected and its own side is in order."),
            ("robots", "Robots that a link speaks for."),
            ("starts", "How often the gateway has started a link."),
        ):
            yield MetricReading(f"robot_bridge_link_{name}", text, ("link",), partial(links.numbers, name))
        yield MetricReading(
            "robot_bridge_link_counts", "What a link has counted.", ("link", "name"), links.counts
        )

    def _info(self) -> Values:
        site = self._fleet.site.report
        return {(gateway_version(), site.id, str(site.version)): 1.0}

    def _robots(self) -> Values:
        found = Counter(report.state for report in self._fleet.reports())
        return {(state.value,): float(found[state]) for state in RobotState}

    def _pose_ages(self) -> Values:
        reports = self._fleet.reports()
        return {(report.robot,): report.pose_age for report in reports if report.pose_age is not None}

    def _commands(self) -> Values:
        return {(state.value,): float(count) for state, count in self._fleet.open_commands().items()}

    def _task_ages(self) -> Values:
        tally = self._fleet.tally
        return {(name,): age for name in list(tally.beats) if (age := tally.age(name)) is not None}


def _single(name: str, text: str, value: Any) -> MetricReading:
    return MetricReading(f"robot_bridge_{name}", text, (), lambda: {(): float(value())})


def _waiting(connection: Connection) -> dict[tuple[str, ...], float]:
    return {
        (table.name,): float(connection.scalar(select(func.count()).select_from(table)) or 0)
        for table in (rr, sa)
    }


def _page(status: http.HTTPStatus, kind: str, body: bytes) -> Response:
    return http_response(status, body, [("Content-Type", kind), ("Cache-Control", "no-store")])
