"""The part on big sites: what the gateway costs to serve one, and how long its robots wait."""

from __future__ import annotations

import asyncio
import base64
import json
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from websockets.asyncio.client import ClientConnection, connect

from benchmarks.clock import Spread, each, once, spread, table
from benchmarks.growth import PITCH, city
from benchmarks.load import MALLOC
from benchmarks.page import Part, goal
from benchmarks.swarm import cpu_seconds, megabytes_of
from benchmarks.trial import size
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.robotmap.model import PART_OF
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import cache_writer, read_site, write_site, write_site_cache
from robot_bridge.core.sites.site_cache import CACHE_FILE
from robot_bridge.gateway.site.site_maps import STORED_AT_ONCE, SiteMaps
from tests.support.fleet import serve
from tests.support.processes import Processes

SITES = size((150_000, 1_098_871), (2_000, 20_000))
READYS = size(20, 3)
QUESTIONS = size(300, 10)
SIDE = 100.0
PING_EVERY = 0.1
ACK_MS, PING_MS, CPU_S, RSS_MB, MAP_MS = 100.0, 50.0, 5.0, 600.0, 3.0

TEXT = """\
Cities that are made up, turned square buildings {pitch:g} m apart, published by the bridge's own writer. The
gateway is a process of its own on SQLite; its processor time and memory (RSS) are those that the system tells
of it. A robot says Ready on a new connection, {readys} times, while another one is pinged every
{every:.0f} ms over WebSocket; all waiting is by the clock on the wall, with whatever else the
machine does. OpAck: from Ready to its acknowledgement; first map: to the first SetMap.

{table}

GetMap is of {side:g} m × {side:g} m: over the wire, from the question until the map is there; and the map
itself, in this process, by processor time. What is between the two: the map is stored in the database before
OpAck says so, so that a restart loses none. The whole site is not stored for a robot on WebSocket: its row
says that it is that map.

- OpAck within {ack:g} ms at any size, the slowest: {ack_goal}
- p99 of another robot's pings below {ping:g} ms: {ping_goal}
- until the gateway listens and maps are at hand, {cpu:g} s of processor time: {cpu_goal}
- {rss:g} MB after all Readys and questions: {rss_goal}
- GetMap, the median within {map:g} ms: made {map_goal}; over the wire {wire_goal}
"""


class Measured(NamedTuple):
    """What was measured of one site; times in ms, processor time in s, memory in MB."""

    buildings: int
    megabytes: tuple[float, float]
    written: float
    cpu: float
    started: float
    rss: float
    acks: list[float]
    maps: list[float]
    first: str
    pings: list[float]
    questions: Spread
    stored: Spread
    made: Spread

    @property
    def ping_p99(self) -> float:
        """The 99th percentile of the pings."""
        return float(np.percentile(self.pings, 99))


def measure(_data: Path) -> Part:
    """Measure all sites, each with a gateway of its own."""
    found = [_measured(count) for count in SITES]
    largest = found[-1]
    met = {
        "ack_goal": all(max(one.acks) <= ACK_MS for one in found),
        "ping_goal": all(one.ping_p99 < PING_MS for one in found),
        "cpu_goal": all(one.cpu <= CPU_S for one in found),
        "rss_goal": all(one.rss <= RSS_MB for one in found),
        "map_goal": all(one.made.median <= MAP_MS for one in found),
        "wire_goal": all(one.questions.median <= MAP_MS for one in found),
    }
    said = {
        "ack_goal": goal(f"{max(max(one.acks) for one in found):.0f} ms", met["ack_goal"]),
        "ping_goal": goal(f"{max(one.ping_p99 for one in found):.1f} ms", met["ping_goal"]),
        "cpu_goal": goal(f"{largest.cpu:.1f} s", met["cpu_goal"]),
        "rss_goal": goal(f"{max(one.rss for one in found):.0f} MB", met["rss_goal"]),
        "map_goal": goal(f"{max(one.made.median for one in found):.2f} ms", met["map_goal"]),
        "wire_goal": goal(f"{max(one.questions.median for one in found):.2f} ms", met["wire_goal"]),
    }
    said = {name: text.removeprefix("goal: ") for name, text in said.items()}
    text = TEXT.format(
        table=_table(found),
        pitch=PITCH,
        readys=READYS,
        every=PING_EVERY * 1e3,
        side=SIDE,
        ack=ACK_MS,
        ping=PING_MS,
        cpu=CPU_S,
        rss=RSS_MB,
        map=MAP_MS,
        **said,
    )
    return Part("Big sites", text, settings=MALLOC)


def _table(found: list[Measured]) -> str:
    lines: dict[str, list[str]] = {
        "buildings": [f"{one.buildings:,}".replace(",", " ") for one in found],
        "site.gpkg, site.cache, MB": ["{:.0f}, {:.0f}".format(*one.megabytes) for one in found],
        "site.cache written in, s of processor time": [f"{one.written:.1f}" for one in found],
        "gateway until it listens, s of processor time": [f"{one.cpu:.2f}" for one in found],
        "memory then, MB": [f"{one.started:.0f}" for one in found],
        "memory after all, MB": [f"{one.rss:.0f}" for one in found],
        "first map": [one.first for one in found],
        "OpAck, ms": [f"{spread(one.acks):.1f}, at most {max(one.acks):.0f}" for one in found],
        "first map there, ms": [f"{spread(one.maps):.0f}" for one in found],
        "pings of another robot meanwhile, ms": [
            f"{spread(one.pings):.2f}, p99 {one.ping_p99:.1f}" for one in found
        ],
        "GetMap over the wire, ms": [f"{one.questions:.2f}" for one in found],
        "of it until OpAck, ms": [f"{one.stored:.2f}" for one in found],
        "GetMap made, ms of processor time": [f"{one.made:.2f}" for one in found],
    }
    (first, *head), *rows = ([name, *cells] for name, cells in lines.items())
    return table([first, *head], rows)


def _measured(count: int) -> Measured:
    with tempfile.TemporaryDirectory(prefix="fleet-big-site-") as name:
        folder = Path(name) / "site"
        written = _publish(folder, count)
        made, follows = _made(folder)
        with _gateway(folder, Path(name)) as (pid, port):
            cpu, started = cpu_seconds(pid), megabytes_of(pid)
            told = asyncio.run(_asked(port, PITCH * count**0.5, follows=follows))
            rss = megabytes_of(pid)
        sizes = tuple((folder / file).stat().st_size / 1e6 for file in ("site.gpkg", CACHE_FILE))
        measured = Measured(count, (sizes[0], sizes[1]), written, cpu, started, rss, *told, made)
        print(measured._replace(pings=[], acks=[], maps=[]), file=sys.stderr, flush=True)
        return measured


def _publish(folder: Path, count: int) -> float:
    """Publish a city; return the seconds of processor time that its cache took."""
    outlines, side = city(count), PITCH * count**0.5
    bounds = SiteBounds(-20.0, -20.0, side + 20.0, side + 20.0)
    settings = SiteSettings("city", "City", 1, "EPSG:32633", (430000.0, 3960000.0), bounds)
    write_site(folder, settings, outlines)
    text = (folder / "site.toml").read_text(encoding="utf-8")

    def write_again() -> None:
        with cache_writer(folder, settings.frame) as cache:
            cache.add(outlines)
            write_site_cache(folder, settings, text, cache)

    return once(write_again)[1]


def _made(folder: Path) -> tuple[Spread, bool]:
    """Return what GetMap takes, and whether the whole map follows the window that a robot is sent first."""
    maps = SiteMaps(read_site(folder))
    whole = maps.whole_map()
    follows = whole is not None and len(whole) > STORED_AT_ONCE
    places = _places(maps.site.bounds.x_max)
    return each(lambda place: maps.map_around(*place, SIDE**2), places).spread, follows


def _places(side: float) -> list[tuple[float, float]]:
    found = np.random.default_rng(8).uniform(SIDE, side - SIDE, (QUESTIONS + 1, 2)).round(2)
    return [(x, y) for x, y in found.tolist()]


@contextmanager
def _gateway(site: Path, folder: Path) -> Iterator[tuple[int, int]]:
    with Processes(folder / "logs") as processes:
        served = serve(processes, site, f"sqlite:///{folder}/fleet.db", env=MALLOC, seconds=600)
        # The whole map and what is fenced are prepared behind that.
        time.sleep(1.0)
        yield served.process.pid, served.port


# --- robots -----------------------------------------------------------------------------------------------


class _Robot:
    """One robot on its WebSocket, which acknowledges maps and measures how long it waits."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._ids = iter(range(1, 1 << 30))

    async def ask(self, method: str, params: dict[str, Any]) -> tuple[float, float, bytes]:
        """Return the ms until the acknowledgement, until the map that follows, and its frame."""
        id, start = next(self._ids), time.perf_counter()
        await self._connection.send(
            json.dumps({"jsonrpc": "2.0", "id": id, "method": method, "params": params})
        )
        acknowledged = there = 0.0
        frame = b""
        while not (acknowledged and there):
            heard = await self._connection.recv(decode=False)
            waited = (time.perf_counter() - start) * 1e3
            if b'"SetMap"' in heard[:80]:
                there, frame = waited, heard
                await self._acknowledge(heard)
            elif b'"result"' in heard[:80]:
                acknowledged = waited
            elif b'"error"' in heard[:80]:
                raise RuntimeError(heard[:300])
        return acknowledged, there, frame

    async def await_map(self) -> bytes:
        """Return the frame of the next map that comes by itself."""
        while b'"SetMap"' not in (heard := await self._connection.recv(decode=False))[:80]:
            pass
        await self._acknowledge(heard)
        return heard

    async def _acknowledge(self, frame: bytes) -> None:
        id = json.loads(frame)["id"]
        await self._connection.send(json.dumps({"jsonrpc": "2.0", "id": id, "result": {"ok": True}}))


async def _asked(
    port: int, side: float, *, follows: bool
) -> tuple[list[float], list[float], str, list[float], Spread, Spread]:
    """Return OpAcks, first maps, what those were, pings of another robot, and questions with their OpAcks."""
    url = f"ws://127.0.0.1:{port}/robot?robot="
    pinging = await asyncio.create_subprocess_exec(
        sys.executable, "-c", _PINGS, f"{url}pinged", str(PING_EVERY), stdout=-1, stdin=-1
    )
    assert pinging.stdout is not None and pinging.stdin is not None
    await pinging.stdout.readline()
    acks, maps, first = [], [], ""
    for number in range(READYS):
        async with connect(f"{url}r{number}", max_size=None, compression=None) as connection:
            robot = _Robot(connection)
            ack, there, frame = await robot.ask("Ready", {"magic": number + 1})
            acks.append(ack)
            maps.append(there)
            told = _described(frame) if not first else ""
            if follows:
                frame = await robot.await_map()
                told += f"; then {_described(frame)}" if not first else ""
            first = first or told
    async with connect(f"{url}asking", max_size=None, compression=None) as connection:
        robot = _Robot(connection)
        await robot.ask("Ready", {"magic": 1})
        if follows:
            await robot.await_map()
        waited, stored = [], []
        for x, y in _places(side):
            ack, there, _ = await robot.ask("GetMap", {"x": x, "y": y, "area": SIDE**2})
            waited.append(there)
            stored.append(ack)
            # A robot may send 100 messages a second, and acknowledges each map.
            await asyncio.sleep(0.03)
    pinging.stdin.close()
    pings = json.loads(await pinging.stdout.readline())
    await pinging.wait()
    return acks, maps, first, pings, spread(waited[1:]), spread(stored[1:])


def _described(frame: bytes) -> str:
    content = base64.b64decode(json.loads(frame)["params"]["map"])
    found = decode(content, 1 << 30)
    kind = "a window" if PART_OF in found.meta else "the whole site"
    return f"{kind}, {len(found.obstacles)} obstacles, {len(content) / 1e6:.2f} MB"


_PINGS = """
import asyncio, json, sys, time
from websockets.asyncio.client import connect

async def read(connection):
    async for frame in connection:
        pass

async def main(url, every):
    found = []
    async with connect(url, max_size=None, compression=None) as connection:
        await connection.recv()
        await connection.send('{"jsonrpc": "2.0", "id": 1, "method": "Ready", "params": {"magic": 1}}')
        reading = asyncio.create_task(read(connection))
        end = asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)
        print("pings", flush=True)
        while not end.done():
            start = time.perf_counter()
            await (await connection.ping())
            found.append(round((time.perf_counter() - start) * 1e3, 3))
            await asyncio.sleep(every)
    print(json.dumps(found), flush=True)

asyncio.run(main(sys.argv[1], float(sys.argv[2])))
"""
