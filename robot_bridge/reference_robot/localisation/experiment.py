"""A drive along a route in a simulated world: truth, odometry, and the filter's estimate."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.geometry import Polyline
from ...core.robotmap.model import RobotMap
from ..body import Body, BodyLimits, Driver
from . import sensors
from .particle_filter import ParticleFilter
from .settings import LocalisedRobotSettings, Metres, Positive, ReferenceRobotError, settings_tables
from .world import changed, inside_solids, walls_of

EXPERIMENTS = Path(__file__).with_name("experiments")
"""The folder of the settings that come with the program."""
STEERING = 20.0
"""times a second."""
PATIENCE = 3.0
"""times the route's duration at full speed, until an experiment is given up."""

Coordinate = Annotated[float, msgspec.Meta(ge=-1e7, le=1e7)]
Place = tuple[Coordinate, Coordinate]


class Carried(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The robot is carried forward ``after`` so many metres, by so many metres of its route."""

    after: Metres
    by: Metres


class ExperimentSettings(LocalisedRobotSettings, frozen=True, forbid_unknown_fields=True):
    """A route, how it is driven, and the settings of the robot and its world.

    ``route`` are points, metres in the site frame; ``speed`` is m/s and ``scans`` a second. ``start`` is
    ``known`` to ``start_m`` metres and ``start_deg`` degrees (standard deviations), or ``unknown``: then it
    is somewhere on the route. ``length`` ends the drive after so many metres. With ``gps`` the filter gets
    the receiver's position once a second. With ``end_heading_deg``, degrees counter-clockwise from the x
    axis, the robot must have this heading at the end of its route, and the error is measured.
    """

    title: Annotated[str, msgspec.Meta(max_length=200)] = ""
    route: Annotated[list[Place], msgspec.Meta(min_length=2, max_length=10_000)] = []  # noqa: RUF012
    speed: Annotated[float, msgspec.Meta(gt=0, le=20)] = 1.0
    scans: Annotated[float, msgspec.Meta(gt=0, le=20)] = 5.0
    steered_by: Literal["belief", "truth"] = "belief"
    start: Literal["known", "unknown"] = "known"
    start_m: Metres = 0.1
    start_deg: Annotated[float, msgspec.Meta(ge=0, le=180)] = 2.0
    length: Positive | None = None
    end_heading_deg: Annotated[float, msgspec.Meta(ge=-360, le=360)] | None = None
    gps: bool = False
    carried: Carried | None = None


@dataclass(frozen=True, eq=False)
class SensorLog:
    """The sensor data of a drive, for trying other filters.

    ``start`` is where the robot was when it made the first of n + 1 ``scans``, (n + 1, B) metres, NaN where a
    beam has no reading and infinite where it met nothing; ``motions``, (n, 2), are its measured motions
    between scans: metres forward and radians counter-clockwise.
    """

    start: sensors.TruePose
    motions: NDArray[Any]
    scans: NDArray[Any]


@dataclass(frozen=True, eq=False)
class Record:
    """One drive, a row for each of n scans.

    ``truth``, ``odometry`` and ``belief`` are (n, 3): x, y in metres and theta in radians, site frame;
    ``driven`` and ``accuracy`` are (n,) metres, ``lost`` (n,) bool as the robot reports it, ``seconds`` (n,)
    of processor time for an update, and ``particles`` (n,) how many there are after it. The robot was carried
    away before row ``carried``; ``goal`` is where it should stand in the end. Of a drive at a gateway:
    ``maps`` that the robot was sent, of ``map_bytes`` in all, and the least distance, metres, between its
    body and any obstacle, ``clearance``; ``accepted`` observations of robots were on its map, None if none
    were reviewed. Of a drive without a gateway: its sensor data, ``log``.
    """

    seed: int
    carried: int | None
    truth: NDArray[Any]
    odometry: NDArray[Any]
    belief: NDArray[Any]
    driven: NDArray[Any]
    accuracy: NDArray[Any]
    lost: NDArray[Any]
    seconds: NDArray[Any]
    particles: NDArray[Any]
    _: KW_ONLY
    goal: sensors.TruePose | None = None
    maps: int | None = None
    map_bytes: int | None = None
    clearance: float | None = None
    accepted: int | None = None
    log: SensorLog | None = None


def names() -> list[str]:
    """Return the experiments that come with the program."""
    return sorted(file.stem for file in EXPERIMENTS.glob("*.toml"))


def read_settings(file: Path) -> ExperimentSettings:
    """Return the experiment in a TOML ``file``.

    :raises ReferenceRobotError: naming the file and the fault in it.
    """
    try:
        return msgspec.convert(settings_tables(file), ExperimentSettings)
    except msgspec.ValidationError as error:
        raise ReferenceRobotError(f"settings {file}: {error}; see docs/experiments.md") from None


def run(robot_map: RobotMap, settings: ExperimentSettings, seed: int, compiled: bool | None = None) -> Record:
    """Return one drive on ``robot_map``; all randomness comes from ``seed``.

    :raises ReferenceRobotError: for a route that leaves the map or passes through obstacles, and for one that
        is not driven to its end.
    """
    check_route(robot_map, settings.route)
    drive = _Drive(robot_map, settings, seed, compiled)
    most = drive.length / settings.speed * PATIENCE + 10.0
    while drive.go_on():
        if drive.seconds > most:
            raise ReferenceRobotError(
                f"seed {seed}: {drive.body.driven:.0f} m driven in {drive.seconds:.0f} s, and not at the end "
                "of the route; it steers by a belief that is wrong"
            )
    return drive.record()


def goal_of(settings: ExperimentSettings) -> sensors.TruePose | None:
    """Return the robot's final pose, None if it does not matter."""
    heading = settings.end_heading_deg
    return None if heading is None else (*settings.route[-1], math.radians(heading))


def route_from(route: Sequence[Place], part: float) -> list[Place]:
    """Return a closed ``route`` begun after ``part`` of its length; 0 leaves any route as it is.

    :raises ReferenceRobotError: for a route that does not end where it begins, and a part above 0.
    """
    if not part:
        return list(route)
    if math.dist(route[0], route[-1]) > 1e-6:
        raise ReferenceRobotError("route: several robots at once begin all along it; end it where it begins")
    line = Polyline(route)
    station = part * line.length
    begin = _along(route, line, station)[:2]
    places = list(zip(route, line.stations, strict=True))
    later = [place for place, at in places if at > station + 1e-6]
    return [begin, *later, *(place for place, at in places[1:] if at < station - 1e-6), begin]


def check_route(robot_map: RobotMap, route: Sequence[Place]) -> None:
    """Raise ReferenceRobotError for a route that is not on the map, or goes through something solid."""
    line = Polyline(route)
    stations = np.linspace(0, line.length, max(2, math.ceil(line.length / 0.2)))
    points = np.array([_along(route, line, at)[:2] for at in stations])
    border = robot_map.border
    outside = (points < (border.x_min, border.y_min)) | (points > (border.x_max, border.y_max))
    bad = np.flatnonzero(outside.any(axis=1) | inside_solids(robot_map, points))
    if len(bad):
        x, y = points[bad[0]]
        raise ReferenceRobotError(
            f"route: ({x:.1f}, {y:.1f}) is not on map {robot_map.meta.get('id', 'without id')}, or in "
            "something solid there; correct the route, or serve another site"
        )


class _Drive:
    """One drive in progress."""

    def __init__(
        self, robot_map: RobotMap, settings: ExperimentSettings, seed: int, compiled: bool | None
    ) -> None:
        self._settings = settings
        self._seed = seed
        world, senses, mind = (np.random.default_rng([seed, part]) for part in range(3))
        seen = walls_of(robot_map).higher_than(settings.laser.height)
        self._laser = sensors.SimulatedLaser(changed(seen, settings.world, world), settings.laser, senses)
        self._wheels = sensors.SimulatedOdometry(settings.odometry, senses)
        self._gyroscope = sensors.SimulatedGyroscope(settings.gyroscope, senses)
        self._line = Polyline(settings.route)
        whole = self._line.length
        self.length = min(settings.length or whole, whole)
        begin = float(world.uniform(0, whole - self.length)) if settings.start == "unknown" else 0.0
        self._receiver = (
            sensors.SimulatedGps(walls_of(robot_map), settings.gps_receiver, senses) if settings.gps else None
        )
        self._limits = BodyLimits(speed=settings.speed)
        self.body = Body(_along(settings.route, self._line, begin), self._limits)
        self._driver = self._driver_from(begin)
        self._filter = ParticleFilter(robot_map, settings.laser, settings.filter, mind, compiled)
        self._odometry = self.body.pose
        self._carried: int | None = None
        self._rows: list[tuple[Any, ...]] = []
        self._start = self.body.pose
        self._motions: list[sensors.Motion] = []
        self._scans: list[NDArray[Any]] = []
        self.seconds = 0.0
        self._begin()

    def go_on(self) -> bool:
        """Drive until the next scan, and process it; False at the end."""
        settings = self._settings
        steps = max(1, round(STEERING / settings.scans))
        dt = 1 / settings.scans / steps
        distance = turn = 0.0
        steered = self.body.pose if settings.steered_by == "truth" else self._filter.belief.pose
        for _ in range(steps):
            motion = self._driver.steer(steered)
            if motion is None or self.body.driven >= self.length:
                return False
            before = self.body.pose
            self.body.drive(*motion)
            self.body.step(dt)
            true = sensors.motion_between(before, self.body.pose)
            wheels = self._wheels.measure(true)
            self._odometry = sensors.moved(self._odometry, wheels)
            felt = sensors.Motion(wheels.distance, self._gyroscope.measure(true.turn, dt))
            distance, turn = distance + felt.distance, turn + felt.turn
            steered = self.body.pose if settings.steered_by == "truth" else sensors.moved(steered, felt)
        self.seconds += steps * dt
        self._carry()
        self._process(sensors.Motion(distance, turn))
        return True

    def record(self) -> Record:
        """Return the record so far."""
        columns = [np.array(column) for column in zip(*self._rows, strict=True)]
        log = SensorLog(self._start, np.array(self._motions), np.array(self._scans))
        return Record(self._seed, self._carried, *columns, goal=goal_of(self._settings), log=log)

    def _begin(self) -> None:
        scan = self._scan()
        settings = self._settings
        self._receive_fix()
        if settings.start == "unknown":
            self._filter.search(scan)
        else:
            self._filter.place(self.body.pose, (settings.start_m, math.radians(settings.start_deg)))
            self._filter.observe(scan)

    def _scan(self) -> NDArray[Any]:
        scan = self._laser.scan(self.body.pose)
        self._scans.append(scan)
        return scan

    def _process(self, motion: sensors.Motion) -> None:
        scan = self._scan()
        self._motions.append(motion)
        if len(self._rows) % max(1, round(self._settings.scans)) == 0:
            self._receive_fix()
        begin = time.process_time()
        self._filter.move(motion)
        self._filter.observe(scan)
        belief = self._filter.belief
        seconds = time.process_time() - begin
        believed = belief.pose, self.body.driven, belief.accuracy, belief.lost
        self._rows.append((self.body.pose, self._odometry, *believed, seconds, len(self._filter.particles)))

    def _receive_fix(self) -> None:
        fix = self._receiver.fix(self.body.pose) if self._receiver is not None else None
        if fix is not None:
            self._filter.observe_fix(*fix, self._settings.gps_receiver.noise)

    def _carry(self) -> None:
        carried = self._settings.carried
        if carried is None or self._carried is not None or self.body.driven < carried.after:
            return
        self._carried = len(self._rows)
        station = min(carried.after + carried.by, self._line.length)
        self.body.place(_along(self._settings.route, self._line, station))
        self._driver = self._driver_from(station)

    def _driver_from(self, station: float) -> Driver:
        """Return the driver for the rest of the route."""
        x, y, _ = _along(self._settings.route, self._line, station)
        stations = zip(self._settings.route, self._line.stations, strict=True)
        left = [point for point, at in stations if at > station + 1e-6]
        goal = goal_of(self._settings)
        return Driver([(x, y), *left], None if goal is None else goal[2], self._limits)


def _along(route: Sequence[Place], line: Polyline, station: float) -> sensors.TruePose:
    """Return the pose at ``station`` metres of the route, heading along it."""
    piece = min(int(np.searchsorted(line.stations, station, side="right")), len(route) - 1)
    (x0, y0), (x1, y1) = route[piece - 1], route[piece]
    length = max(float(line.stations[piece] - line.stations[piece - 1]), 1e-9)
    part = (station - float(line.stations[piece - 1])) / length
    return x0 + part * (x1 - x0), y0 + part * (y1 - y0), math.atan2(y1 - y0, x1 - x0)
