"""The part on a site's small computer: a gateway, its database and QGIS Server under its limits."""

from __future__ import annotations

import json
import math
import os
import re
import statistics
import sys
import tempfile
import threading
import time
import urllib.parse
import urllib.request
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from sqlalchemy import make_url

from benchmarks.appliance_crowd import Plan
from benchmarks.clock import table
from benchmarks.limits import PERIOD_US, Group, LimitError, Throttling, small_computer
from benchmarks.load import MALLOC, site_with_room
from benchmarks.page import Part, goal
from benchmarks.swarm import Onlooker
from benchmarks.trial import size
from robot_bridge.core.sites.settings import read_settings
from robot_bridge.gateway.auth import certificates
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.map_views import map_views_on, virtual_layers
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError
from tests.support.fleet import SITE, serve
from tests.support.patience import START
from tests.support.processes import Processes, free_port
from tools.plugin_files import ROOT

MODEL, CORES, SHARE, MEGABYTES = "Raspberry Pi 4", 4, 0.4, 2000
"""What the small computer is on paper, and how fast a core of it is taken to be, of one of this machine's."""
GATEWAY, DATABASE, MAPS = "gateway", "database", "maps"
SQLITE, POSTGRESQL = "SQLite", "PostgreSQL"
ROBOTS, ROBOT_RATE, DESKS, PHONES = 50, 3.0, 3, 5
SETTLE, SECONDS, STOPS = size((15.0, 45.0, 4), (3.0, 12.0, 2))
STOP_MS, MAP_EVERY = 1000.0, 1.0
"""milliseconds in which a stop is to be at the last robot, and seconds from one map to the next."""
PICTURE, PICTURE_SIDES = (640, 480), (100.0, 75.0)
"""pixels, and metres."""
LAYERS = ("Orthophoto", "Road surfaces", "Buildings", "Walls", "Robots")
MAPS_NICE = 5
"""As the unit of the map services has it."""
FRAME = read_settings(SITE / "site.toml").frame
PANEL = ROOT / "plugin" / "settings" / "profile.py"
PAGE = ROOT / "robot_bridge" / "gateway" / "field" / "assets" / "budget.js"

TEXT = """\
A {model} on paper, {cores} cores and {megabytes} MB; nobody ran this on one. A core of it is taken to do
{percent:.0f} % of what one of this machine does. So {time:g} cores' processor time on {cpus} processors
is all that control groups let the gateway, its database and QGIS Server have together, counted anew every
{period:g} ms, and {megabytes} MB of memory, the system's copies of files included. Two of four rows hold
each of the three to the time of one such core besides: a gateway hardly uses more than one, and of this
machine's it is given a whole one otherwise. A card or a disk of such a computer is not imitated, and nor
is its network.

Outside of the limits, on the same processors: {robots} robots, each on a WebSocket, which drive and say
where they are {robot_rate:g} times a second; {desks} desks that subscribe as the panel does, to a table
at {desk_rate:g} Hz; {phones} phones that subscribe as the field page does, to a table at {phone_rate:g}
Hz, and for less where that takes more than {budget_kb:.0f} kB a minute: here in the end to `{last_form}`
at {last_rate:g} Hz. All of it is TLS, without accounts. A client asks QGIS Server for a map every
{map_every:g} s, of {wide} × {high} pixels and another place each time, with {layers}. After {settle:g} s
{seconds:g} s count, in which a desk makes {stops} emergency stops. Delays are from the robot's clock, of
positions that are new to whoever is told: at {desk_rate:g} Hz the newest one waits for up to
{desk_wait:.0f} ms by nature, at {phone_rate:g} Hz for up to {phone_wait:.0f} ms. A stop's are from when
the desk asks to when the last robot has heard of it.

{delays}

All in milliseconds. *Late* is the most that a robot was behind its time: where it is many milliseconds,
this machine itself was too busy for the figures beside it. {maps_counted}

{used}

*Of a core* is processor time, of one of this machine's cores. *Memory* is the most that processes held by
themselves, and, of all together, with the system's copies of files. *Held back* are the periods in which
something waited for processor time that was used up; for the whole, and for that part.

The slowest stop was at the last robot after {slowest:.0f} ms ({stop_goal}). A phone took {phone_kb:.0f}
kB a minute at most. Killed for want of memory: {killed}.
"""


class Setting(NamedTuple):
    """A database, and the time of how many of this machine's cores each part may use, None for all of it."""

    database: str
    cores: float | None

    @property
    def name(self) -> str:
        """The setting as the tables name it."""
        return self.database + (", each part on one core" if self.cores else "")


@dataclass
class Use:
    """What a group used in the time that counts."""

    cpu: float
    megabytes: float
    throttling: Throttling


@dataclass
class Pictures:
    """Milliseconds of each map, and what went wrong with others."""

    times: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)


@dataclass
class Run:
    """What came of a setting: ``seen`` are the fields of :class:`.appliance_crowd.Seen`."""

    setting: Setting
    seen: dict[str, Any]
    pictures: Pictures
    parts: dict[str, Use]
    whole: Use
    megabytes_with_files: float
    killed: int

    @property
    def slowest_stop(self) -> float:
        """Milliseconds until the last robot heard of the slowest stop, NaN where one never did."""
        return max(self.seen["stops"], key=lambda ms: (math.isnan(ms), ms))


def measure(_data: Path) -> Part:
    """Measure each setting; say what is missing where this machine cannot be made a small one."""
    settings = [Setting(kind, cores) for cores in (None, SHARE) for kind in (SQLITE, POSTGRESQL)]
    heading, runs = "A site on a small computer", list[Run]()
    try:
        for setting in settings:
            runs.append(_run(setting))
            print(" | ".join(_delay_row(runs[-1])), file=sys.stderr, flush=True)
    except (LimitError, StageError) as error:
        return Part(heading, f"Not measured: {error}.", failed=True)
    return report(heading, runs)


def report(heading: str, runs: list[Run]) -> Part:
    """Return the part of the page that some runs come to."""
    slowest = max((run.slowest_stop for run in runs), key=lambda ms: (math.isnan(ms), ms))
    in_time, killed = slowest <= STOP_MS, sum(run.killed for run in runs)
    failures = [text for run in runs for text in run.pictures.failures]
    asked = sum(len(run.pictures.times) + len(run.pictures.failures) for run in runs)
    desk, phone, _, budget = subscriptions()
    last = runs[-1].seen["phone"]["subscription"]
    text = TEXT.format(
        **{
            "model": MODEL,
            "cores": CORES,
            "megabytes": MEGABYTES,
            "percent": 100 * SHARE,
            "time": CORES * SHARE,
        },
        **{"cpus": os.cpu_count(), "period": PERIOD_US / 1000, "robots": ROBOTS, "robot_rate": ROBOT_RATE},
        **{"desks": DESKS, "desk_rate": desk["rate"], "desk_wait": 1000 / desk["rate"]},
        **{"phones": PHONES, "phone_rate": phone["rate"], "phone_wait": 1000 / phone["rate"]},
        **{"map_every": MAP_EVERY, "wide": PICTURE[0], "high": PICTURE[1], "layers": ", ".join(LAYERS)},
        **{"settle": SETTLE, "seconds": SECONDS, "stops": STOPS, "slowest": slowest},
        delays=_delays(runs),
        used=_used(runs),
        maps_counted=f"Of {asked} maps that were asked for {len(failures) or 'none'} failed.",
        stop_goal=goal(f"at most {STOP_MS:.0f} ms", in_time),
        phone_kb=max(run.seen["phone"]["bytes"] for run in runs) / SECONDS * 60 / 1000,
        budget_kb=budget / 1000,
        last_form=last["form"],
        last_rate=last["rate"],
        killed=killed or "nothing",
    )
    wrong = "".join(f"\n- {text}" for text in sorted(set(failures)))
    return Part(heading, text + wrong, bool(killed or failures or not in_time), settings=MALLOC)


class Subscriptions(NamedTuple):
    """What the panel and the field page subscribe to at first, and by what the page asks for less then."""

    desk: dict[str, Any]
    phone: dict[str, Any]
    phone_rates: list[float]
    budget: int


def subscriptions() -> Subscriptions:
    """Return what the sources of panel and page say."""
    page = PAGE.read_text(encoding="utf-8")
    rate = float(_found(r"positions_rate: float = ([\d.]+)", PANEL.read_text(encoding="utf-8")))
    rates = [float(text) for text in _found(r"\[([\d., ]+)\]\.map\(\(rate\)", page).split(",")]
    form = _found(r'STEPS = \[\{ form: "(\w+)"', page)
    budget = int(_found(r"BUDGET = ([\d_]+)", page))
    return Subscriptions({"rate": rate, "form": "columns"}, {"rate": rates[0], "form": form}, rates, budget)


def _found(pattern: str, text: str) -> str:
    found = re.search(pattern, text)
    assert found is not None, pattern
    return found.group(1)


# --- one setting ---


def _run(setting: Setting) -> Run:
    cpus = os.cpu_count() or 1
    if cpus < CORES * SHARE:
        raise LimitError(
            f"{CORES * SHARE:g} cores' time takes more processors than the {cpus} of this machine"
        )
    limits = {"cores": CORES * SHARE, "megabytes": MEGABYTES, "cpus": f"0-{cpus - 1}"}
    with (
        small_computer(f"fleet-bench-{os.getpid()}", (GATEWAY, DATABASE, MAPS), **limits) as (whole, parts),
        tempfile.TemporaryDirectory(prefix="fleet-appliance-") as name,
        _serving(setting, Path(name), parts) as (plan, pictures),
    ):
        crowd = Onlooker(sys.executable, "-m", "benchmarks.appliance_crowd", json.dumps(asdict(plan)))
        try:
            crowd.line()
            return _watched(setting, crowd, pictures, whole, parts)
        finally:
            crowd.end()


def _watched(
    setting: Setting, crowd: Onlooker, pictures: PictureClient, whole: Group, parts: Mapping[str, Group]
) -> Run:
    crowd.tell(seconds=SECONDS, settle=SETTLE, stops=STOPS)
    groups = {**parts, "": whole}
    time.sleep(SETTLE)
    before = {name: (group.cpu_seconds(), group.throttling()) for name, group in groups.items()}
    began, most, with_files = time.monotonic(), dict.fromkeys(groups, 0.0), 0.0
    pictures.begin()
    while time.monotonic() < began + SECONDS:
        most = {name: max(most[name], group.megabytes()) for name, group in groups.items()}
        with_files = max(with_files, whole.megabytes_with_files())
        time.sleep(0.5)
    took = time.monotonic() - began
    used = {
        name: Use((group.cpu_seconds() - cpu) / took, most[name], group.throttling() - throttling)
        for (name, group), (cpu, throttling) in zip(groups.items(), before.values(), strict=True)
    }
    taken = pictures.end()
    killed = max(whole.killed(), sum(group.killed() for group in parts.values()))
    return Run(setting, crowd.line(), taken, used, used.pop(""), with_files, killed)


@contextmanager
def _serving(
    setting: Setting, folder: Path, parts: Mapping[str, Group]
) -> Iterator[tuple[Plan, PictureClient]]:
    """Start all that the small computer runs, each in its part; give who comes, and who asks for maps."""
    for group in parts.values():
        group.hold(cores=setting.cores)
    files = certificates.create(folder / "tls", ["localhost"], ["127.0.0.1"])
    asked = subscriptions()
    with ExitStack() as stack:
        processes = stack.enter_context(Processes(folder / "logs"))
        database, fleet = _database(setting, folder, parts, stack)
        served = serve(
            processes,
            site_with_room(folder),
            database,
            *("--certificate", files.certificate, "--key", files.key),
            env=MALLOC,
            through=parts[GATEWAY].through,
        )
        port = free_port()
        program = [sys.executable, ROOT / "tools" / "serve_maps.py", "--fleet", fleet, "--port", str(port)]
        processes.start(
            MAPS,
            [*parts[MAPS].through, "nice", "-n", str(MAPS_NICE), *program],
            env={"QT_QPA_PLATFORM": "offscreen", "HOME": str(folder), "PYTHONPATH": str(ROOT)},
        )
        processes.wait_for_line(MAPS, "listening on", START)
        client = PictureClient(f"http://127.0.0.1:{port}/")
        client.warm()
        yield (
            Plan(
                *(served.address, str(files.ca), ROBOTS, ROBOT_RATE, DESKS, asked.desk, PHONES, asked.phone),
                *(asked.phone_rates, asked.budget),
            ),
            client,
        )
        processes.require_running()


def _database(
    setting: Setting, folder: Path, parts: Mapping[str, Group], stack: ExitStack
) -> tuple[str, str]:
    """Return the URL of a new database with views, and what the map services read the fleet from."""
    if setting.database == SQLITE:
        url = f"sqlite:///{folder}/fleet.db"
        fleet = str(folder / "fleet.vrt")
        (folder / "fleet.vrt").write_text(virtual_layers(f"{folder}/fleet.db", FRAME), "utf-8")
    else:
        server = PostgreSql(durable=True, through=parts[DATABASE].through)
        server.require_programs()
        stack.enter_context(server)
        url = fleet = server.new_database()
        server.sql("create extension postgis", make_url(url).database)
    run_once(url, revisions.create)
    run_once(url, lambda connection: map_views_on(connection).make(FRAME))
    return url, fleet


class PictureClient:
    """A client of a map server that asks for a picture every MAP_EVERY seconds, or when the last has come."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._pictures = Pictures()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._ask_again_and_again, daemon=True)

    def warm(self) -> None:
        """Ask once: the server reads the project then."""
        self._ask(0)

    def begin(self) -> None:
        """Begin to ask."""
        self._thread.start()

    def end(self) -> Pictures:
        """Return what came, when the last has."""
        self._ending.set()
        self._thread.join()
        return self._pictures

    def _ask_again_and_again(self) -> None:
        began, number = time.monotonic(), 0
        while not self._ending.wait(max(0.0, began + number * MAP_EVERY - time.monotonic())):
            number += 1
            asked = time.monotonic()
            try:
                self._ask(number)
                self._pictures.times.append((time.monotonic() - asked) * 1e3)
            except OSError as error:
                self._pictures.failures.append(f"{error}")

    def _ask(self, number: int) -> None:
        x, y = 5.0 * (number % 20), 4.0 * (number % 17)
        (low,), (high,) = (
            FRAME.to_crs([place]).tolist() for place in ((x, y), (x + PICTURE_SIDES[0], y + PICTURE_SIDES[1]))
        )
        query = {
            **{"SERVICE": "WMS", "VERSION": "1.3.0", "REQUEST": "GetMap", "STYLES": "", "CRS": FRAME.crs},
            **{"LAYERS": ",".join(LAYERS), "BBOX": ",".join(map(str, (*low, *high)))},
            **{"WIDTH": PICTURE[0], "HEIGHT": PICTURE[1], "FORMAT": "image/png"},
        }
        with urllib.request.urlopen(f"{self._address}?{urllib.parse.urlencode(query)}", timeout=60) as answer:
            kind = answer.headers.get_content_type()
            if kind != "image/png" or not answer.read():
                raise OSError(f"QGIS Server answers a question for a map with {kind}")


# --- what is said of it ---


def _delays(runs: list[Run]) -> str:
    head = ["", "positions/s"]
    for what in ("desk", "phone", "map"):
        head += [f"{what}: p50", "p99", "worst"]
    head += ["stop: median", "worst", "robots late"]
    return table(head, [_delay_row(run) for run in runs])


def _delay_row(run: Run) -> list[str]:
    seen, stops = run.seen, [ms for ms in run.seen["stops"] if not math.isnan(ms)]
    columns = (seen["desk"]["delays"], seen["phone"]["delays"], run.pictures.times)
    return [
        run.setting.name,
        f"{seen['positions']:.0f}",
        *(cell for times in columns for cell in _three(times)),
        f"{statistics.median(stops):.0f}" if stops else "–",
        f"{run.slowest_stop:.0f}" if len(stops) == len(seen["stops"]) else "**never**",
        f"{seen['late']:.0f}",
    ]


def _three(times: list[float]) -> list[str]:
    """Return the median, the 99th percentile and the most of some times."""
    found = sorted(times)
    return [f"{found[int(part * (len(found) - 1))]:.0f}" if found else "–" for part in (0.5, 0.99, 1.0)]


def _used(runs: list[Run]) -> str:
    head = ["", "part", "of a core", "memory, MB", "held back, of periods", "held back, s"]
    rows = []
    for run in runs:
        for name, use in {**run.parts, "all": run.whole}.items():
            if name == DATABASE and run.setting.database == SQLITE:
                continue
            share = use.throttling.throttled / max(1, use.throttling.periods)
            files = f", {run.megabytes_with_files:.0f} with files" if name == "all" else ""
            rows.append(
                [
                    run.setting.name,
                    name,
                    f"{100 * use.cpu:.0f} %",
                    f"{use.megabytes:.0f}{files}",
                    f"{100 * share:.1f} %" if use.throttling.periods else "–",
                    f"{use.throttling.seconds:.1f}" if use.throttling.periods else "–",
                ]
            )
    return table(head, rows)
