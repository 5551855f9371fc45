"""Simulated robot that localises itself by its sensors alone, its world, and an executor for fast time."""

from __future__ import annotations

import math
import secrets
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.messages.robots import Observed, SendImage, SetObject
from ...core.robotmap.model import RobotMap
from ..body import Body, BodyLimits, Pose
from . import sensors
from .avoidance import Avoidance, Discs, MovingObstacles, ObstacleShape, ranges_to
from .localiser import InitialBelief, Localiser, LocaliserSettings
from .map_doubts import Doubt, MapDoubts
from .map_gaps import FoundObject, MapGaps
from .segments import distances
from .settings import LocalisedRobotSettings, ReferenceRobotError, settings_tables
from .world import Walls, changed, inside_solids, walls_of

P = ParamSpec("P")
T = TypeVar("T")


class InlineExecutor(Executor):
    """Runs work synchronously; errors are kept in the future, as in other executors."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Call ``fn``."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


BLOCKED_REMARK_S = 1.0
"""seconds after which a robot reports that something is in its way."""
LASER_UP = 0.1
"""metres above its laser: the least height of objects that it sees."""
FIX_EVERY = 1.0
"""seconds between two positions of a GPS receiver."""


@dataclass(frozen=True, eq=False)
class SimulatedWorld:
    """The true world: ``walls`` for the laser, ``sky`` for GPS, and moving obstacles."""

    walls: Walls
    sky: Walls
    surroundings: MovingObstacles = field(default_factory=MovingObstacles)


@dataclass(frozen=True)
class LocalisedSettings:
    """The robot: its sensors and filter, limits, ``scans`` a second, and with ``gps`` a receiver.

    ``start`` is its initial estimate, ``truth`` its true pose. All randomness comes from ``seed``.
    """

    robot: LocalisedRobotSettings
    limits: BodyLimits
    truth: sensors.TruePose
    start: InitialBelief
    scans: float = 5.0
    gps: bool = False
    seed: int = 1
    shape: ObstacleShape = field(default_factory=ObstacleShape)
    compiled: bool | None = None


class LocalisedBody:
    """Moves as requested while it knows its place and its way is free; its pose is its estimate.

    The filter works on ``executor``. ``driven`` is metres by the wheels.
    """

    def __init__(self, settings: LocalisedSettings, world: SimulatedWorld, executor: Executor) -> None:
        self._settings = settings
        self._world = world
        self._body = Body(settings.truth, settings.limits)
        robot = settings.robot
        senses, mind = (np.random.default_rng([settings.seed, part]) for part in (1, 2))
        self._laser = sensors.SimulatedLaser(world.walls, robot.laser, senses)
        self._wheels = sensors.SimulatedOdometry(robot.odometry, senses)
        self._gyroscope = sensors.SimulatedGyroscope(robot.gyroscope, senses)
        self._receiver = sensors.SimulatedGps(world.sky, robot.gps_receiver, senses) if settings.gps else None
        self.avoidance = Avoidance(self._laser.bearings, settings.shape)
        limits = settings.limits
        localising = LocaliserSettings(
            robot.laser,
            robot.filter,
            sensors.BodyReach(limits.speed, limits.turn_rate),
            robot.gps_receiver.noise,
            settings.compiled,
        )
        self.localiser = Localiser(localising, settings.start, mind, executor)
        self.odometry = settings.start.pose
        """The pose by the wheels alone."""
        self._felt = sensors.Motion(0.0, 0.0)
        """The motion measured since the newest scan."""
        self._partial: list[sensors.Motion] = []
        self._target_speeds = 0.0, 0.0
        self._t = 0.0
        self._next_scan = 0.0
        self._next_fix = 0.0
        self._gaps: MapGaps | None = None
        self._doubts: MapDoubts | None = None
        self._found: list[FoundObject] = []
        self._doubted: list[Doubt] = []
        self._reported, self._run = 0, secrets.token_hex(3)
        self.readings = 0
        """The number of scans so far."""
        world.surroundings.add(self, lambda: self.discs)

    @property
    def truth(self) -> sensors.TruePose:
        """The true pose."""
        return self._body.pose

    @property
    def pose(self) -> sensors.TruePose:
        """The robot's pose estimate."""
        pose = self.localiser.pose
        for motion in self._partial:
            pose = sensors.moved(pose, motion)
        return pose

    @property
    def v(self) -> float:
        """Its speed by the wheels, m/s."""
        return self._body.v

    @property
    def driven(self) -> float:
        """Metres since the start."""
        return self._body.driven

    @property
    def accuracy(self) -> float | None:
        """The standard deviation of its position, metres; None before it has a map."""
        return None if self.localiser.map is None else self.localiser.accuracy

    @property
    def hindrance(self) -> str | None:
        """Why it must not drive, None when it knows its place."""
        return self.localiser.trouble

    @property
    def remark(self) -> str | None:
        """What keeps it from driving although it knows its place."""
        if not self.avoidance.waits or self.avoidance.blocked_for < BLOCKED_REMARK_S:
            return None
        return f"waits: something is in its way, {self.avoidance.free_ahead(0.0):.1f} m ahead"

    @property
    def blocked_for(self) -> float:
        """For how many seconds something has been in its way."""
        return self.avoidance.blocked_for

    @property
    def discs(self) -> Discs:
        """Itself, as others see it: (1, 3)."""
        x, y, _ = self._body.pose
        return np.array([[x, y, self._settings.shape.radius]])

    def place(self, pose: sensors.TruePose) -> None:
        """Set its estimate to ``pose``, like a robot that gets a start position from an operator."""
        if self.localiser.map is None:
            # It is switched on there.
            self._body.place(pose)
        self.odometry, self._partial = pose, []
        self.localiser.place(InitialBelief(pose, (0.5, math.radians(10))))

    def use_map(self, robot_map: RobotMap) -> str | None:
        """Switch to another map; return why not, or None."""
        try:
            self.localiser.use_map(robot_map)
        except ReferenceRobotError as error:
            return str(error)
        if self._gaps is None or self._doubts is None:
            laser, bearings = self._settings.robot.laser, self._laser.bearings
            self._gaps = MapGaps(robot_map, laser, bearings)
            self._doubts = MapDoubts(robot_map, laser, bearings)
        else:
            self._gaps.use_map(robot_map)
            self._doubts.use_map(robot_map)
        return None

    def observations(self) -> Sequence[Observed]:
        """Return what it saw again and again where its map has nothing, an object and an image of it.

        Also what its sensors repeatedly see through although the map has it.
        """
        found, self._found = self._found, []
        doubted, self._doubted = self._doubted, []
        observed: list[Observed] = []
        for doubt in doubted:
            if len(doubt.source) > SetObject.texts["doubts"]:
                continue
            self._reported += 1
            name, source = f"missing-{self._run}-{self._reported}", f"{self._run}-{self._reported}"
            observed.append(
                SetObject(
                    doubt.x,
                    doubt.y,
                    name,
                    doubt.semantics[: SetObject.texts["label"]] or None,
                    radius=min(doubt.radius, SetObject.ranges["radius"][1]),
                    source=source,
                    doubts=doubt.source,
                )
            )
        for thing in found:
            self._reported += 1
            name, source = f"seen-{self._run}-{self._reported}", f"{self._run}-{self._reported}"
            height = self._settings.robot.laser.height
            observed.append(
                SetObject(thing.x, thing.y, name, "obstacle", height + LASER_UP, thing.radius, source=source)
            )
            observed.append(SendImage(thing.image, thing.x, thing.y, name, "image/png", source=f"{source}i"))
        return observed

    def drive(self, v: float, turn_rate: float) -> None:
        """Request a motion, m/s and rad/s; it stands where it must not drive, and avoids what it sees."""
        if self.localiser.trouble is not None:
            v = turn_rate = 0.0
        self._target_speeds = v, turn_rate

    def step(self, dt: float) -> None:
        """Let ``dt`` seconds pass, and scan when due."""
        self._body.drive(*self.avoidance.adjusted(*self._target_speeds, dt))
        before = self._body.pose
        self._body.step(dt)
        true = sensors.motion_between(before, self._body.pose)
        wheels = self._wheels.measure(true)
        self.odometry = sensors.moved(self.odometry, wheels)
        motion = sensors.Motion(wheels.distance, self._gyroscope.measure(true.turn, dt))
        self._partial.append(motion)
        self._felt = sensors.Motion(self._felt.distance + motion.distance, self._felt.turn + motion.turn)
        self.avoidance.move(motion)
        self._t += dt
        if self._t >= self._next_scan - 1e-9:
            self._next_scan = self._t + 1 / self._settings.scans
            self._scan()

    def _scan(self) -> None:
        pose = self._body.pose
        nearer = ranges_to(self._world.surroundings.around(self), pose, self._laser.bearings)
        ranges = self._laser.scan(pose, nearer)
        self.readings += 1
        motion, self._felt, self._partial = self._felt, sensors.Motion(0.0, 0.0), []
        self.avoidance.observe(ranges, sensors.Motion(0.0, 0.0))
        self.localiser.observe(self.measured(sensors.SensorReading(self._t, motion, ranges, self._fix())))
        if self._gaps is not None and self._doubts is not None and self.localiser.trouble is None:
            self._found += self._gaps.observe(self.localiser.pose, ranges)
            self._doubted += self._doubts.observe(self.localiser.pose, ranges)

    def measured(self, reading: sensors.SensorReading) -> sensors.SensorReading:
        """Return the sensor reading of the true state; a hook for tests to let sensors fail."""
        return reading

    def _fix(self) -> tuple[float, float] | None:
        if self._receiver is None or self._t < self._next_fix:
            return None
        self._next_fix = self._t + FIX_EVERY
        return self._receiver.fix(self._body.pose)

    def carry(self, pose: sensors.TruePose) -> None:
        """Put the body elsewhere; neither its wheels nor its gyroscope notice."""
        self._body.place(pose)

    def clearance(self) -> float:
        """Return the true distance to the nearest obstacle, metres; below 0 it has hit it."""
        x, y, _ = self._body.pose
        walls = self._world.walls
        found: list[NDArray[Any]] = [distances(np.array([x, y]), walls.a, walls.b)]
        others = self._world.surroundings.around(self)
        found.append(np.hypot(others[:, 0] - x, others[:, 1] - y) - others[:, 2])
        return float(np.concatenate(found).min(initial=math.inf)) - self._settings.shape.radius


MAP_MARGIN = 20.0
"""metres from the border of its map at which such a robot requests the next one."""


def read_robot_settings(file: Path) -> LocalisedRobotSettings:
    """Return the settings of a robot and its world in a TOML ``file``; raises ReferenceRobotError."""
    try:
        return msgspec.convert(settings_tables(file), LocalisedRobotSettings)
    except msgspec.ValidationError as error:
        raise ReferenceRobotError(f"settings {file}: {error}; see docs/experiments.md") from None


def simulated_world(robot_map: RobotMap, settings: LocalisedRobotSettings, seed: int) -> SimulatedWorld:
    """Return a world whose map is ``robot_map``; a different one for each ``seed``."""
    seen = walls_of(robot_map).higher_than(settings.laser.height)
    return SimulatedWorld(
        changed(seen, settings.world, np.random.default_rng([seed, 0])), walls_of(robot_map)
    )


def localised_robot(
    robot_map: RobotMap,
    settings: LocalisedRobotSettings,
    limits: BodyLimits,
    pose: Pose,
    executor: Executor,
    *,
    knows_pose: bool = True,
    gps: bool = False,
    seed: int = 1,
) -> LocalisedBody:
    """Return a robot at ``pose`` of a world made of ``robot_map``, whose filter works on ``executor``.

    :raises ReferenceRobotError: for a place that is not in that world, or in something solid.
    """
    x, y, _ = pose
    if not robot_map.border.holds(x, y) or inside_solids(robot_map, np.array([[x, y]]))[0]:
        raise ReferenceRobotError(
            f"pose ({x:.1f}, {y:.1f}) is not on the map of world {robot_map.meta.get('id', 'without id')}, "
            "or in something solid there; choose a place that is free"
        )
    belief = InitialBelief(pose, unknown=not knows_pose)
    robot = LocalisedSettings(settings, limits, pose, belief, gps=gps, seed=seed)
    return LocalisedBody(robot, simulated_world(robot_map, settings, seed), executor)
