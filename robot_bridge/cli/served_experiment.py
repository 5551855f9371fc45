"""An experiment at a real gateway: robots over WebSocket, sent by an operator, in accelerated time."""

from __future__ import annotations

import asyncio
import itertools
import json
import shutil
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ParamSpec, TypeVar

import msgspec
import numpy as np
from sqlalchemy import URL
from websockets.asyncio.client import ClientConnection, connect

from ..core.errors import BridgeError
from ..core.json_decoder import decode_json
from ..core.messages.records import ObservationState
from ..core.messages.robots import Answer, OpAck, Request, SetMap, SetObject, Stopped
from ..core.robotmap.model import RobotMap
from ..core.sites.settings import SETTINGS_FILE
from ..gateway.app import GatewaySettings, Signals
from ..gateway.app import run as run_gateway
from ..reference_robot.agent import STEER_EVERY, Agent, AgentSettings
from ..reference_robot.body import BodyLimits
from ..reference_robot.localisation import experiment, simulation
from ..reference_robot.localisation.avoidance import MovingObstacles, People
from ..reference_robot.localisation.experiment import ExperimentSettings, Record
from ..reference_robot.localisation.localiser import InitialBelief
from ..reference_robot.localisation.sensors import TruePose
from ..reference_robot.websocket_link import RobotWebSocketLink

P = ParamSpec("P")
T = TypeVar("T")
Point = tuple[float, float]

ASIDE = 1.5
"""metres from the route within which people walk."""
STORED = 60.0
"""seconds of a robot's time for its observations to be stored."""
LOCATED = 300.0, 5.0
"""seconds of a robot's time to be admitted, get its map and localise itself, and the pace meanwhile."""


@dataclass(frozen=True)
class ServedDrives:
    """Options of drives at a gateway: on which ``database``, all ``at_once`` or one after the other.

    ``pace`` is the largest speed-up over real time; ``people`` walk along the route. With a ``window`` robots
    are sent maps with sides of so many metres instead of that of the site. With ``accept`` an operator
    accepts all reports of a robot on its map, and it drives once more in the same world; then all are
    rejected again, so that the next one begins with the map of the site. With a ``reporter`` the reports come
    from another robot with these settings, on a drive of its own in the same world.
    """

    site: Path
    database: URL
    name: str
    at_once: bool = False
    pace: float = 20.0
    people: int = 0
    compiled: bool | None = None
    window: float | None = None
    accept: bool = False
    reporter: ExperimentSettings | None = None


def drive_at_gateway(
    drives: ServedDrives, robot_map: RobotMap, settings: ExperimentSettings, seeds: Sequence[int]
) -> list[Record]:
    """Return the record of a drive for each seed, of a robot that a gateway of its own sends round.

    The world is made from ``robot_map``; robots are sent the map of ``drives.site``. With
    ``drives.accept`` there are two records a seed, before and after the operator's review.

    :raises BridgeError: for settings that do not work at a gateway, and for refusals of the gateway.
    """
    if settings.carried is not None or settings.start == "unknown" or settings.steered_by != "belief":
        raise BridgeError(
            f"experiment {drives.name}: at a gateway a robot that does not know its place stands until it is "
            "told; leave --gateway out"
        )
    if drives.reporter is not None and drives.reporter.world != settings.world:
        raise BridgeError(
            f"experiment {drives.name}: the reporter is set to another world; give both the same [world]"
        )
    if drives.accept and drives.at_once:
        raise BridgeError(
            f"experiment {drives.name}: each seed has a world of its own for what is reported there; give "
            "--accept or --at-once, not both"
        )
    experiment.check_route(robot_map, settings.route)
    if drives.window is None:
        return asyncio.run(_all_drives(drives, robot_map, settings, seeds))
    with TemporaryDirectory() as folder:
        site = _site_of_windows(drives.site, Path(folder) / drives.site.resolve().name, drives.window)
        return asyncio.run(_all_drives(replace(drives, site=site), robot_map, settings, seeds))


def _site_of_windows(site: Path, copy: Path, window: float) -> Path:
    """Copy a site, too large for one map by its settings; raises BridgeError."""
    shutil.copytree(site, copy)
    settings = copy / SETTINGS_FILE
    text = settings.read_text(encoding="utf-8")
    if "[maps]" in text:
        raise BridgeError(f"{site / SETTINGS_FILE} has a table [maps] already; leave --window out")
    table = f"\n[maps]\nlargest_whole_bytes = 1000\nwindow_m = {window}\n"
    settings.write_text(text + table, encoding="utf-8")
    return copy


async def _all_drives(
    drives: ServedDrives, robot_map: RobotMap, settings: ExperimentSettings, seeds: Sequence[int]
) -> list[Record]:
    signals, address = Signals(), asyncio.get_running_loop().create_future()
    state = drives.site.resolve().parent
    gateway = GatewaySettings(drives.site, drives.database, port=0, state=state)
    serving = asyncio.create_task(run_gateway(gateway, signals, address.set_result))
    await asyncio.wait({serving, address}, return_when=asyncio.FIRST_COMPLETED)
    if serving.done():
        serving.result()
    try:
        groups = [list(seeds)] if drives.at_once else [[seed] for seed in seeds]
        records = []
        for group in groups:
            records += await _drive_together(drives, robot_map, settings, group, await address)
            if drives.accept:
                records += await _drive_reviewed(drives, robot_map, settings, group[0], await address)
        return records
    finally:
        signals.stop.set()
        await serving


async def _drive_reviewed(
    drives: ServedDrives, robot_map: RobotMap, settings: ExperimentSettings, seed: int, address: str
) -> list[Record]:
    """Return another drive of the robot of ``seed``, with the reports from its world on the map."""
    reporting = drives
    if drives.reporter is not None:
        reporting = replace(drives, name=f"{drives.name}-reporter")
        await _drive_together(reporting, robot_map, drives.reporter, [seed], address)
    name = _robot_name(reporting, seed)
    accepted = await _review(address, name, accept=True)
    try:
        drive = await _drive_together(drives, robot_map, settings, [seed], address)
    finally:
        await _review(address, name, accept=False)
    return [replace(record, accepted=accepted) for record in drive]


async def _review(address: str, robot: str, *, accept: bool) -> int:
    """Accept unreviewed reports of ``robot``, or reject accepted ones; return their number."""
    state = ObservationState.PENDING if accept else ObservationState.ACCEPTED
    async with connect(f"{address}/desk") as wire:
        desk = _Desk(wire)
        await desk.ask("hello", {"operator": "experiment"})
        query = {"robot": robot, "state": state.value, "limit": 1000}
        found = (await desk.ask("get_observations", query))["observations"]
        objects = [one["observation"] for one in found if one["op"] == SetObject.__name__]
        for number in objects:
            verdict = {"observation": number, "accept": accept, "revise": not accept}
            await desk.ask("review_observation", verdict)
    return len(objects)


async def _drive_together(
    drives: ServedDrives,
    robot_map: RobotMap,
    settings: ExperimentSettings,
    seeds: Sequence[int],
    address: str,
) -> list[Record]:
    surroundings = MovingObstacles()
    routes = [experiment.route_from(settings.route, number / len(seeds)) for number in range(len(seeds))]
    robots = [
        _Robot(drives, robot_map, settings, seed, route, surroundings, address)
        for seed, route in zip(seeds, routes, strict=True)
    ]
    people = People(drives.people, np.array(settings.route), ASIDE, np.random.default_rng([seeds[0], 3]))
    surroundings.add(people, lambda: people.discs)
    links = [asyncio.create_task(robot.link.run(robot.agent)) for robot in robots]
    try:
        async with connect(f"{address}/desk") as wire:
            desk = _Desk(wire)
            await desk.ask("hello", {"operator": "experiment"})
            pace = min(drives.pace, LOCATED[1])
            await _step_until(robots, people, pace, lambda robot: robot.is_located, LOCATED[0])
            for robot in robots:
                await desk.ask("send", robot.command())
                robot.begin()
            longest = experiment.PATIENCE * robots[0].length / settings.speed + 60.0
            await _step_until(robots, people, drives.pace, lambda robot: robot.is_done, longest)
            # Their observations must be stored before they disconnect.
            await _step_until(robots, people, pace, lambda robot: robot.has_reported, STORED)
    finally:
        for link in links:
            link.cancel()
        await asyncio.gather(*links, return_exceptions=True)
    return [robot.record() for robot in robots]


async def _step_until(
    robots: Sequence[_Robot],
    people: People,
    pace: float,
    condition: Callable[[_Robot], bool],
    seconds: float,
) -> None:
    """Let time pass until a condition holds for all; raises BridgeError after ``seconds`` of simulated
    time."""
    passed = 0.0
    while not all(condition(robot) for robot in robots):
        begin = time.monotonic()
        people.step(STEER_EVERY, np.concatenate([robot.body.discs for robot in robots]))
        for robot in robots:
            robot.step(STEER_EVERY)
        passed += STEER_EVERY
        if passed > seconds:
            late = next(robot for robot in robots if not condition(robot))
            raise BridgeError(f"robot {late.name}: not done after {passed:.0f} s; {late.state()}")
        # Let the gateway and its links run.
        await asyncio.sleep(max(0.0, STEER_EVERY / pace - (time.monotonic() - begin)))


class _Desk:
    """An operator's connection: sends requests, and ignores notifications."""

    def __init__(self, wire: ClientConnection) -> None:
        self._wire = wire
        self._ids = itertools.count(1)

    async def ask(self, method: str, params: dict[str, Any]) -> Any:
        id = next(self._ids)
        await self._wire.send(json.dumps({"jsonrpc": "2.0", "method": method, "id": id, "params": params}))
        async for frame in self._wire:
            reply = decode_json(frame)
            if reply.get("id") == id and "method" not in reply:
                if "error" in reply:
                    raise BridgeError(f"the gateway refuses {method}: {reply['error']['message']}")
                return reply["result"]
        raise BridgeError(f"the gateway closed the connection during {method}; see its log")


class _CountingAgent(Agent):
    """An agent that counts the maps it receives."""

    maps = map_bytes = 0

    def receive(self, answer: Answer, id: int | None) -> OpAck | None:
        if isinstance(answer, SetMap):
            self.maps += 1
            self.map_bytes += len(answer.map)
        return super().receive(answer, id)


class _TimedExecutor(simulation.InlineExecutor):
    """Works synchronously, and remembers the processor time of the newest work."""

    seconds = 0.0

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        begin = time.process_time()
        future = super().submit(fn, *args, **kwargs)
        self.seconds = time.process_time() - begin
        return future


def _robot_name(drives: ServedDrives, seed: int) -> str:
    return f"{drives.name}-{seed}"


class _Robot:
    """One robot, its driver, and its recorded data."""

    def __init__(
        self,
        drives: ServedDrives,
        robot_map: RobotMap,
        settings: ExperimentSettings,
        seed: int,
        route: list[Point],
        surroundings: MovingObstacles,
        address: str,
    ) -> None:
        self.name = _robot_name(drives, seed)
        self._seed, self._route, self._settings = seed, route, settings
        self.length = float(np.hypot(*np.diff(np.array(route), axis=0).T).sum())
        (x, y), (to_x, to_y) = route[:2]
        begin: TruePose = (x, y, float(np.arctan2(to_y - y, to_x - x)))
        made = simulation.simulated_world(robot_map, settings, seed)
        world = simulation.SimulatedWorld(made.walls, made.sky, surroundings)
        limits = BodyLimits(speed=settings.speed)
        belief = InitialBelief(begin, (settings.start_m, float(np.radians(settings.start_deg))))
        robot = msgspec.structs.replace(settings)
        body = simulation.LocalisedSettings(
            robot, limits, begin, belief, settings.scans, settings.gps, seed, compiled=drives.compiled
        )
        self._timed = _TimedExecutor()
        self.body = simulation.LocalisedBody(body, world, self._timed)
        self.link = RobotWebSocketLink(f"{address}/robot", self.name)
        self.agent = _CountingAgent(
            AgentSettings(
                magic=seed,
                pose=begin,
                limits=limits,
                asks_path=True,
                map_margin=simulation.MAP_MARGIN,
                body=self.body,
            ),
            self,
        )
        self._begun = self.is_done = False
        self._clearance = np.inf
        self._readings = 0
        self._rows: list[tuple[Any, ...]] = []

    @property
    def is_located(self) -> bool:
        """Return whether it has a map and knows its place on it."""
        return self.body.hindrance is None

    @property
    def has_reported(self) -> bool:
        """Return whether the gateway has acknowledged all its observations."""
        return not self.link.unacknowledged_observations

    def state(self) -> str:
        """Return its position and status, for a message."""
        x, y, _ = self.body.truth
        return f"it is at ({x:.1f}, {y:.1f}), status: {self.body.hindrance or self.body.remark}"

    def command(self) -> dict[str, Any]:
        """Return the parameters of the command that sends it round."""
        goal = experiment.goal_of(self._settings)
        points = {"points": self._route, **({} if goal is None else {"theta": goal[2]})}
        command = f"experiment-{self.name}-{time.time_ns()}"
        return {"command": command, "robot": self.name, "op": "SetPath", "params": points}

    def begin(self) -> None:
        """Start recording."""
        self._begun = True

    def step(self, dt: float) -> None:
        """Let time pass, and record its position after each scan."""
        self.agent.step(dt)
        if self._begun and not self.is_done and self.body.readings > self._readings:
            self._readings = self.body.readings
            self._record_scan()

    def record(self) -> Record:
        """Return the record."""
        columns = [np.array(column) for column in zip(*self._rows, strict=True)]
        return replace(
            Record(self._seed, None, *columns, goal=experiment.goal_of(self._settings)),
            maps=self.agent.maps,
            map_bytes=self.agent.map_bytes,
            clearance=float(self._clearance),
        )

    def _record_scan(self) -> None:
        body = self.body
        self._clearance = min(self._clearance, body.clearance())
        state = body.pose, body.driven, body.accuracy, body.localiser.lost
        self._rows.append((body.truth, body.odometry, *state, self._timed.seconds, body.localiser.particles))

    def say(self, request: Request) -> None:
        self.link.say(request)
        if isinstance(request, Stopped) and self._begun and self.body.driven > 0:
            self._record_scan()
            self.is_done = True
