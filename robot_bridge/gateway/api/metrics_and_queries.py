"""Pages over HTTP: ``/metrics`` and ``/healthz`` for monitoring, and queries on the site."""

from __future__ import annotations

import asyncio
import http
import json
import logging
import re
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import numpy as np
from sqlalchemy import Connection, func, select
from websockets.http11 import Request, Response

from ...core.errors import BridgeError, CrsError, RefusedError
from ...core.messages.administration import SiteReport
from ...core.messages.base import MessageError
from ...core.messages.safety import RobotState
from ...core.sites.frame import lonlat_of
from ...protocol import schemas
from ...protocol.codec import decode_desk_request
from ..auth.port import http_response
from ..cluster.cluster import Cluster
from ..fleet.service import Fleet
from ..model.events import RequestHandlers
from ..monitoring import CONTENT_TYPE, MetricReading, Metrics, Values, gateway_version
from ..site.site_maps import SiteMaps
from ..storage.schema import rr, sa

log = logging.getLogger(__name__)

# --- ``/healthz`` and ``/metrics`` ---

HEALTH, METRICS = "/healthz", "/metrics"
ANSWER_WITHIN = 2.0
"""seconds after which a silent database counts as away."""
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
        if fleet.cluster is not None:
            metrics.add(_cluster_readings(fleet.cluster))

    async def health(self) -> Response:
        """Return 200 when all is well and 503 otherwise, with the problems as JSON."""
        latency = await self._database_latency()
        tasks = {name.replace(" ", "_"): self._task(name) for name in WATCHED}
        site = self._fleet.site.report
        well = latency is not None and all(task["ok"] for task in tasks.values())
        found = {
            "status": "ok" if well else "failing",
            "version": gateway_version(),
            "site": {"id": site.id, "version": site.version, **_problem_of(site)},
            "database": {"ok": latency is not None, "latency_s": latency},
            "links": {one.link: {"ok": one.up, "text": one.text} for one in self._fleet.links.report().links},
            "routes": self._routes(),
            **tasks,
        }
        if (cluster := self._fleet.cluster) is not None:
            found["cluster"] = cluster.report()
        status = http.HTTPStatus.OK if well else http.HTTPStatus.SERVICE_UNAVAILABLE
        return _page(status, "application/json", json.dumps(found).encode() + b"\n")

    async def metrics(self) -> Response:
        """Return all metrics in the format of Prometheus."""
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
        """Return the state of the route search; it counts as healthy while its fastest engine restarts."""
        planner = self._fleet.roads.planner
        report = None if planner is None else planner.engine_report
        return None if report is None else asdict(report)

    def _task(self, name: str) -> dict[str, Any]:
        age = self._fleet.counters.age(name)
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
        yield _single(
            "site_refused",
            "1 while the site that was chosen for the fleet cannot be served here.",
            lambda: fleet.site.report.problem is not None,
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
        counters = self._fleet.counters
        return {(name,): age for name in list(counters.beats) if (age := counters.age(name)) is not None}


def _cluster_readings(cluster: Cluster) -> Iterator[MetricReading]:
    membership, exchange = cluster.membership, cluster.exchange

    def states() -> Values:
        return {("alive",): len(membership.others()), ("heard",): len(exchange.heard())}

    def buses() -> Values:
        return {(name,): float(up) for name, up in exchange.connections().items()}

    yield MetricReading(
        "robot_bridge_gateway_info",
        "The name of this gateway.",
        ("gateway",),
        lambda: {(membership.name,): 1.0},
    )
    yield MetricReading("robot_bridge_bus_connected", "1 while a bus is connected.", ("bus",), buses)
    yield MetricReading(
        "robot_bridge_other_gateways",
        "Other gateways whose lease lives, and that are heard.",
        ("state",),
        states,
    )
    yield _single("lease_held", "1 while this gateway may command.", lambda: membership.trust.holds)
    yield _single("leads", "1 while this one does what is done once per fleet.", lambda: membership.leads)
    yield _single(
        "clock_offset_seconds",
        "Seconds that the database's clock is ahead of this computer's.",
        lambda: membership.clock_offset,
    )


def _problem_of(site: SiteReport) -> dict[str, Any]:
    return {} if site.problem is None else {"ok": False, "text": site.problem}


def _single(name: str, text: str, value: Any) -> MetricReading:
    return MetricReading(f"robot_bridge_{name}", text, (), lambda: {(): float(value())})


def _waiting(connection: Connection) -> dict[tuple[str, ...], float]:
    return {
        (table.name,): float(connection.scalar(select(func.count()).select_from(table)) or 0)
        for table in (rr, sa)
    }


def _page(status: http.HTTPStatus, kind: str, body: bytes) -> Response:
    return http_response(status, body, [("Content-Type", kind), ("Cache-Control", "no-store")])


# --- ``/site/surfaces`` and ``/site/route``: answers as GeoJSON ---

MOST_AT_ONCE = 8
"""Concurrent queries; a way through a city can take a second."""
MOST_FIELDS = 2_000
"""Parameters behind one ``?``, with their repetitions; the request line is limited to 8 kB before."""
DIGITS = 7
"""Decimals of a degree: a centimetre."""
_NAMES = {"point": "points", "surface": "surfaces"}
"""The names in the desk's requests of parameters that are repeated here."""

Places = list[list[float]]


class SiteQueries:
    """Answers queries by the services that answer the desks' requests."""

    def __init__(self, maps: SiteMaps, handlers: RequestHandlers) -> None:
        self._maps, self._handlers = maps, handlers
        self._under_way = 0

    def serves(self, path: str) -> bool:
        """Return whether ``path`` is one of these pages."""
        return path in schemas.PARAMETERS

    async def answer(self, request: Request) -> Response:
        """Return GeoJSON, or a problem document with the error and advice."""
        if self._under_way >= MOST_AT_ONCE:
            return _problem(
                http.HTTPStatus.SERVICE_UNAVAILABLE,
                f"{MOST_AT_ONCE} questions are being answered; ask again in a second.",
                [("Retry-After", "1")],
            )
        parts = urlsplit(request.path)
        self._under_way += 1
        try:
            query = read_query(parts.query, schemas.PARAMETERS[parts.path])
            features = await (self._route if parts.path == schemas.ROUTE else self._surfaces)(query)
        except MessageError as error:
            return _problem(http.HTTPStatus.BAD_REQUEST, _text(parts.path, error))
        except RefusedError as error:
            return _problem(http.HTTPStatus.UNPROCESSABLE_ENTITY, _text(parts.path, error))
        except CrsError as error:
            text = f"The site cannot be placed on the earth: {error}"
            return _problem(http.HTTPStatus.SERVICE_UNAVAILABLE, text)
        finally:
            self._under_way -= 1
        content = {"type": "FeatureCollection", "features": features}
        return _response(http.HTTPStatus.OK, schemas.GEOJSON, json.dumps(content, allow_nan=False).encode())

    async def _surfaces(self, query: dict[str, Any]) -> list[dict[str, Any]]:
        asked = decode_desk_request("get_surface", query)
        found = (await self._handlers.answer(asked, ""))["surfaces"]
        degrees = await asyncio.to_thread(self._on_earth, query["points"], query.get("crs"))
        return [
            _feature("Point", place, {"surface": None} if surface is None else surface)
            for place, surface in zip(degrees, found, strict=True)
        ]

    async def _route(self, query: dict[str, Any]) -> list[dict[str, Any]]:
        query["x"], query["y"] = query.pop("goal")
        found = await self._handlers.answer(decode_desk_request("get_route", query), "")
        if not found["engine"]:
            # A desk shows the straight line with its note; a program would take it for a road.
            raise RefusedError(f"there is no way along the roads: {found['note'].partition(': ')[2]}")
        line = await asyncio.to_thread(self._on_earth, found.pop("points"), None)
        found.pop("tight", None)
        return [_feature("LineString", line, found)]

    def _on_earth(self, places: Sequence[Sequence[float]], crs: str | None) -> Places:
        """Return places of ``crs``, or of the site frame, as longitudes and latitudes.

        :raises RefusedError, CrsError: when the places, or the site, cannot be converted.
        """
        pairs = [(x, y) for x, y in places]
        here = pairs if crs is None else self._maps.to_site(pairs, crs)
        degrees = lonlat_of(self._maps.site.frame)(np.array(here))
        if not np.isfinite(degrees).all():
            raise RefusedError("a place lies nowhere on the earth; give places of this site")
        # Without the sign of a zero.
        found: Places = (degrees.round(DIGITS) + 0.0).tolist()
        return found


def read_query(text: str, parameters: Sequence[schemas.QueryParameter]) -> dict[str, Any]:
    """Return the query string's parameters, by the names of the desk's requests.

    :raises MessageError: for a parameter that is unknown, missing, repeated or invalid.
    """
    known = {one.name: one for one in parameters}
    found: dict[str, Any] = {}
    try:
        pairs = parse_qsl(text, keep_blank_values=True, errors="strict", max_num_fields=MOST_FIELDS)
    except ValueError as error:
        raise MessageError(f"what stands behind the ? cannot be read: {error}") from None
    for name, value in pairs:
        if (one := known.get(name)) is None:
            raise MessageError(f"unknown parameter {name[:40]!r}; known are {', '.join(known)}")
        key = _NAMES.get(name, name)
        if one.is_repeated:
            found.setdefault(key, []).append(_value(name, value, one.schema["items"]))
            if len(found[key]) > (most := one.schema["maxItems"]):
                raise MessageError(f"{name} is there more than {most} times; ask in parts")
        elif key in found:
            raise MessageError(f"{name} is there twice; give it once")
        else:
            found[key] = _value(name, value, one.schema)
    if missing := [
        one.name for one in parameters if one.required and _NAMES.get(one.name, one.name) not in found
    ]:
        raise MessageError(f"{missing[0]} is missing; give {missing[0]}=…")
    if found.setdefault("crs", schemas.DEGREES) == schemas.SITE_FRAME:
        del found["crs"]
    return found


def _value(name: str, text: str, schema: Mapping[str, Any]) -> Any:
    if schema["type"] == "boolean":
        if text not in ("true", "false"):
            raise MessageError(f"{name} is {text[:40]!r}; give true or false")
        return text == "true"
    if schema["type"] == "number":
        return _numbers(name, text, 1)[0]
    longest = schema.get("maxLength")
    if longest is not None and len(text) > longest:
        raise MessageError(f"{name} has {len(text)} characters; at most {longest} are taken")
    return _numbers(name, text, 2) if schema is schemas.PLACE else text


def _numbers(name: str, text: str, count: int) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        raise MessageError(f"{name} is {text[:40]!r}; give {'a number' if count == 1 else 'x,y'}")
    return numbers


def _feature(kind: str, coordinates: Any, properties: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "type": "Feature",
        "geometry": {"type": kind, "coordinates": coordinates},
        "properties": dict(properties),
    }


def _text(path: str, error: Exception) -> str:
    """Return the error text, with the name of the query's path."""
    return f"{path}: {re.sub(r'get_(surface|route): ', '', str(error))}"


def _problem(status: http.HTTPStatus, detail: str, headers: Sequence[tuple[str, str]] = ()) -> Response:
    content = {"title": status.phrase, "status": status.value, "detail": detail}
    return _response(status, schemas.PROBLEM, json.dumps(content).encode(), headers)


def _response(
    status: http.HTTPStatus, kind: str, body: bytes, headers: Sequence[tuple[str, str]] = ()
) -> Response:
    fixed = [("Content-Type", kind), ("Cache-Control", "no-store")]
    return http_response(status, body, [*fixed, *headers])
