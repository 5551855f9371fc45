"""The robot's behaviour: messages, tasks and memory, without a wire or a clock of its own."""

from __future__ import annotations

import json
import math
import random
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Protocol

from ..core.errors import BridgeError, RobotMapError
from ..core.files import write_state
from ..core.json_decoder import decode_json
from ..core.messages import robots as messages
from ..core.messages.roads import GetSurface, SetSurface
from ..core.robotmap.binary import decode
from ..core.robotmap.columns import LARGEST_TEXT
from ..core.robotmap.model import RobotMap
from .body import (
    Body,
    BodyLimits,
    Driver,
    Pose,
    ScriptedObject,
    ScriptedObjects,
    SimulatedVehicle,
    before_border,
)

STANDING = 0.01
"""m/s."""
RANGE = 10_000.0
"""metres of range of the simulated battery."""
STEER_EVERY = 0.05
"""seconds between steering steps, however late the program lets time pass."""
MOST_DONE = 10_000
"""Remembered messages: many more than a gateway ever has in flight to one robot."""
REMEMBER_EVERY = 1.0
"""seconds of driving between two records of the robot's progress."""
GREET_AGAIN = 1.0
"""seconds after which a refused robot sends Ready again."""
ASK_AGAIN = 3.0
"""seconds after which a robot that stands without a path requests it again."""
NEAR_BORDER = 0.25
"""share of the shorter side of a partial map: this near to its border a robot requests the next."""
SAME_MAP = 5.0
"""metres from where it got its map: nearer than that it would get the same one again."""
LEAST_KNOWN = 1e5
"""metres: larger accuracies mean an unknown position."""
FIRST_AREA = 10_000.0
"""m² of the map that a robot requests around itself when the first one was of no use."""
OFF_PATH = 1.0
"""metres from its path at which a robot that was lost and knows its place again requests another path."""
ASK_ROUND = 10.0
"""seconds for which something may block it until it requests another path, and between repetitions."""


@dataclass(frozen=True)
class AgentSettings:
    """``magic`` names this run of the robot, ``noise`` is metres on reported positions.

    ``things`` are seen on the way, with ``image`` as the picture of each; with ``asks_path`` the robot
    requests a path to every target, and stands until it has one; with ``asks_surface`` it requests the
    surface at its place and its goal, and reports it as its status. With a non-empty ``memory`` the robot
    continues from there. It also requests the next map when the border of its own is nearer than
    ``map_margin`` metres. ``body`` is driven instead of one at ``pose`` that always knows its place.
    """

    magic: int
    pose: Pose
    limits: BodyLimits
    rate: float = 5.0
    noise: float = 0.01
    seed: int = 1
    things: tuple[ScriptedObject, ...] = ()
    image: bytes | None = None
    asks_path: bool = False
    path_cones: bool = True
    asks_surface: bool = False
    memory: RobotMemory | None = None
    map_margin: float = 0.0
    body: SimulatedVehicle | None = None


@dataclass(frozen=True)
class Awaited:
    """A target (x, y) in metres with its heading, to which a path was requested."""

    place: tuple[float, float]
    theta: float | None


class RequestSink(Protocol):
    """A carrier of a robot's requests to the gateway."""

    def say(self, request: messages.Request) -> None:
        """Send a request."""


class Agent:
    """Receives answers, lets time pass, and passes requests to its ``sink``.

    A message received twice is acknowledged twice and done once. Until the gateway has accepted its Ready the
    robot sends nothing else: another one may run under its account.
    """

    def __init__(self, settings: AgentSettings, sink: RequestSink) -> None:
        self._settings = settings
        self._sink = sink
        self._random = random.Random(settings.seed)  # nosec B311 # simulates noise
        self._body: SimulatedVehicle = settings.body or Body(settings.pose, settings.limits)
        self._driver: Driver | None = None
        self._sightings = ScriptedObjects(settings.things, settings.image)
        self._done: dict[int, None] = {}
        """The ids of the newest messages done, in that order."""
        self._database: str | None = None
        self._admitted = False
        self._rests = False
        """Whether it stands until the gateway has admitted it: its task may have been aborted meanwhile."""
        self._greet_in = math.inf
        self._since_pose = math.inf
        self._moving = False
        self._awaited: Awaited | None = None
        """The target whose path it has not received yet."""
        self._ask_in = math.inf
        self._no_path: str | None = None
        """Why it got no path."""
        self._ground: str | None = None
        self._hindered = False
        self._ask_round_in = 0.0
        self._since_kept = 0.0
        self.map: RobotMap | None = None
        self._map_from = (0.0, 0.0)
        """Where it was when it received its map."""
        self._ask_map_in = 0.0
        self._map_refused = False
        self._magic = settings.magic
        remembered = settings.memory.recall() if settings.memory else None
        if remembered is not None:
            self._continue_run(remembered)
        self._keep()

    @property
    def pose(self) -> Pose:
        """The robot's own pose estimate."""
        return self._body.pose

    @property
    def is_admitted(self) -> bool:
        """Whether the gateway has accepted its Ready."""
        return self._admitted

    def greet(self) -> None:
        """Send Ready; repeated after each reconnection of the link."""
        self._greet_in = math.inf
        asks, cones = self._settings.asks_path or None, self._settings.path_cones or None
        self._sink.say(messages.Ready(magic=self._magic, asks_path=asks, path_cones=cones))

    def receive(self, answer: messages.Answer, id: int | None) -> messages.OpAck | None:
        """Receive message ``id`` of the server; return its acknowledgement."""
        if isinstance(answer, messages.Start):
            self._count_ids_of(answer.database)
            self.greet()
            return None if id is None else messages.OpAck(id=id)
        if isinstance(answer, messages.OpAck):
            self._apply_acknowledgement(answer)
            return None
        if isinstance(answer, messages.Abort) and self._admitted:
            # A task whose end the robot has reached counts as reached: its position is sent before the OpAck.
            self._sink.say(self._position())
        if id is not None and id in self._done:
            # The gateway has not received the outcome: it is reported again once all is done.
            self._moving = True
            return messages.OpAck(id=id)
        refusal = self._do(answer)
        if id is not None:
            self._record_done(id)
        # Before the acknowledgement: the server does not repeat acknowledged messages.
        self._keep()
        return messages.OpAck(id=id, ok=refusal is None, reason=refusal)

    def concerns(self, answer: messages.Answer) -> bool:
        """Return whether a message is for this run of the robot, and not for another one of its account."""
        if isinstance(answer, messages.OpAck) and answer.magic is not None:
            return answer.magic == self._magic
        return self._admitted or isinstance(answer, messages.Start)

    def step(self, dt: float) -> None:
        """Let ``dt`` seconds pass: drive, and send the position when due."""
        # A step that is a little late still counts as one step.
        steps = max(1, round(dt / STEER_EVERY))
        for _ in range(steps):
            self._move(dt / steps)
        self._since_kept += dt
        if self._moving and self._since_kept >= REMEMBER_EVERY:
            self._keep()
        if not self._admitted:
            self._greet_in -= dt
            if self._greet_in <= 0:
                self.greet()
            return
        for observed in (*self._sightings.observe(self._body.pose), *self._body.observations()):
            self._sink.say(observed)
        self._ask_in -= dt
        if self._ask_in <= 0:
            self._ask_path()
        self._ask_round_in -= dt
        if self._body.blocked_for >= ASK_ROUND and self._ask_round_in <= 0:
            self._ask_way_round()
        self._ask_map_in -= dt
        if self._ask_map_in <= 0:
            self._ask_map()
        self._since_pose += dt
        if self._since_pose >= 1 / self._settings.rate - dt / 2:
            self._since_pose = 0.0
            self._sink.say(self._position())
        self._notice_stop()

    def _move(self, dt: float) -> None:
        if self._rests:
            self._body.drive(0.0, 0.0)
        elif self._body.hindrance is not None:
            # A wrong pose must neither steer it nor complete its task.
            self._hindered = True
            self._body.drive(0.0, 0.0)
        elif self._driver is not None:
            self._steer(self._driver)
        self._body.step(dt)

    def _steer(self, driver: Driver) -> None:
        if self._hindered and driver.off(self._body.pose) > OFF_PATH:
            self._halt()
            self._await_path(Awaited(driver.left[-1], driver.theta))
            self._ask_path()
            return
        self._hindered = False
        motion = driver.steer(self._body.pose)
        if motion is None:
            self._driver = None
            self._keep()
        self._body.drive(*(motion or (0.0, 0.0)))

    def wait_for_gateway(self) -> None:
        """Stand until the gateway has admitted the robot again; its task stays, unless it is aborted."""
        self._rests = True

    def stop(self) -> None:
        """Send Stopped; the remembered task stays."""
        self._driver = None
        if self._admitted:
            self._sink.say(messages.Stopped())

    def alive(self) -> None:
        """Send Alive."""
        if self._admitted:
            self._sink.say(messages.Alive())

    def _continue_run(self, remembered: RememberedRun) -> None:
        """Continue the remembered run of the robot, and report again that all is done if it is."""
        self._magic, self._database = remembered.magic, remembered.database
        self._done = dict.fromkeys(remembered.done)
        self._body.place(remembered.pose)
        if remembered.way and remembered.awaits_path:
            self._awaited = Awaited(remembered.way[-1], remembered.theta)
        elif remembered.way:
            self._driver = Driver(remembered.way, remembered.theta, self._settings.limits)
        self._moving = True

    def _keep(self) -> None:
        self._since_kept = 0.0
        if self._settings.memory is None:
            return
        way, theta = ([], None) if self._driver is None else (self._driver.left, self._driver.theta)
        if self._awaited is not None:
            way, theta = [self._awaited.place], self._awaited.theta
        done, awaits = list(self._done), self._awaited is not None
        self._settings.memory.keep(
            RememberedRun(self._magic, self._database, done, self._body.pose, way, theta, awaits)
        )

    def _apply_acknowledgement(self, ack: messages.OpAck) -> None:
        if (
            self._awaited is not None
            and not ack.ok
            and (ack.reason or "").startswith(messages.GetPath.__name__)
        ):
            self._no_path = ack.reason
        if ack.magic != self._magic:
            return
        self._admitted = ack.ok
        if ack.ok:
            self._rests = False
            self._count_ids_of(ack.database)
            self._ask_path()
        else:
            self._greet_in = GREET_AGAIN

    def _count_ids_of(self, database: str | None) -> None:
        """Stop, and forget the done messages, when the database is another one: it does not hold the task."""
        if database != self._database:
            if self._database is not None:
                self._halt()
                self._moving = True
            self._done.clear()
            self._database = database
            self._keep()

    def _record_done(self, id: int) -> None:
        self._done[id] = None
        if len(self._done) > MOST_DONE:
            del self._done[next(iter(self._done))]

    def _do(self, answer: messages.Answer) -> str | None:
        """Execute a message; return why not, or None."""
        limits = self._settings.limits
        if isinstance(answer, messages.SetMap):
            return self._apply_map(answer)
        if isinstance(answer, messages.SetPosEnd):
            self._apply_target(answer)
            self._ask_surface((answer.x, answer.y))
        elif isinstance(answer, messages.SetPath):
            self._driver = Driver(answer.points, answer.theta, limits)
            self._await_path(None)
            self._ask_surface(answer.points[-1])
        elif isinstance(answer, SetSurface):
            names = ["no road" if name is None else name or "an unknown surface" for name in answer.surfaces]
            self._ground = " to ".join(names)
        elif isinstance(answer, messages.SetPosIni):
            return self._apply_place(answer)
        elif isinstance(answer, messages.Abort):
            self._halt()
        self._moving = self._moving or self._driver is not None
        return None

    def _apply_target(self, target: messages.SetPosEnd) -> None:
        """Drive straight to a target, or stand until its path is known."""
        place = target.x, target.y
        if not self._settings.asks_path:
            self._driver = Driver([place], target.theta, self._settings.limits)
            return
        self._halt()
        self._await_path(Awaited(place, target.theta))
        self._ask_path()

    def _halt(self) -> None:
        self._driver = None
        self._await_path(None)
        self._body.drive(0.0, 0.0)

    def _await_path(self, awaited: Awaited | None) -> None:
        self._awaited, self._no_path, self._ask_in = awaited, None, math.inf

    def _ask_path(self) -> None:
        """Request the awaited path, again after each Ready, since a dead gateway no longer answers.

        Also from time to time, as roads are opened again.
        """
        if self._awaited is None:
            self._ask_in = math.inf
            return
        self._ask_in = ASK_AGAIN
        # The path must begin where the robot is now.
        self._sink.say(self._position())
        self._sink.say(messages.GetPath())

    def _ask_way_round(self) -> None:
        """Request another path if something stays in the way; the present one is driven until it arrives."""
        if self._driver is not None and self._settings.asks_path:
            self._ask_round_in = ASK_ROUND
            self._sink.say(self._position())
            self._sink.say(messages.GetPath())

    def _ask_surface(self, goal: tuple[float, float]) -> None:
        if self._settings.asks_surface:
            self._sink.say(GetSurface([self._body.pose[:2], goal]))

    def _apply_map(self, answer: messages.SetMap) -> str | None:
        try:
            robot_map = decode(answer.map, LARGEST_TEXT)
        except RobotMapError as error:
            return f"the map cannot be read: {error}"
        refusal = self._body.use_map(robot_map)
        self._map_refused = refusal is not None
        if refusal is None:
            self.map, self._map_from = robot_map, self._body.pose[:2]
        return refusal

    def _ask_map(self) -> None:
        """Request the map around the robot when it is about to leave its partial map."""
        x, y, _ = self.pose
        if self.map is None:
            if self._map_refused:
                self._ask_map_in = ASK_AGAIN
                self._sink.say(messages.GetMap(round(x, 2), round(y, 2), FIRST_AREA))
            return
        border = self.map.border
        inside = before_border(self.map, x, y)
        width, height = border.x_max - border.x_min, border.y_max - border.y_min
        driven = math.dist((x, y), self._map_from)
        near = max(NEAR_BORDER * min(width, height), self._settings.map_margin)
        if inside < near and (driven > SAME_MAP or inside < SAME_MAP):
            self._ask_map_in = ASK_AGAIN
            self._sink.say(messages.GetMap(round(x, 2), round(y, 2), round(max(width, height) ** 2, 2)))

    def _apply_place(self, begin: messages.SetPosIni) -> str | None:
        drives = self._driver is not None and self._body.hindrance is None
        if drives or abs(self._body.v) >= STANDING:
            return "it drives, and knows where; abort its task first"
        self._body.place((begin.x, begin.y, self._body.pose[2] if begin.theta is None else begin.theta))
        return None

    def _position(self) -> messages.SendPos:
        x, y, theta = self._body.pose
        accuracy = self._body.accuracy
        noise = self._settings.noise if accuracy is None else 0.0
        return messages.SendPos(
            x=round(x + self._random.gauss(0, noise), 3),
            y=round(y + self._random.gauss(0, noise), 3),
            theta=round(theta, 4),
            v=round(self._body.v, 3),
            battery=round(max(0.0, 1 - self._body.driven / RANGE), 3),
            status=self._status(),
            accuracy=None if accuracy is None else round(min(accuracy, LEAST_KNOWN), 3),
        )

    def _status(self) -> str | None:
        if self._body.hindrance is not None:
            return f"stands: {self._body.hindrance}"
        if self._no_path is not None:
            return f"stands without a path: {self._no_path}"
        return self._body.remark or self._ground

    def _notice_stop(self) -> None:
        if self._awaited is not None:
            return
        if self._moving and self._driver is None and abs(self._body.v) < STANDING:
            self._moving = False
            self._keep()
            self._sink.say(self._position())
            self._sink.say(messages.Stopped())


# --- State on the disk, so that a restarted program continues as the one before ---

Point = tuple[float, float]


@dataclass(frozen=True)
class RememberedRun:
    """A run of a robot: its ``magic`` number, and the ids of its done messages of ``database``.

    ``pose`` is where it was, ``way`` the remaining points of its task (none without a task), and ``theta``
    the final heading; metres and radians in the site frame. With ``awaits_path`` it has not received the path
    to the end of ``way`` yet, and stands.
    """

    magic: int
    database: str | None = None
    done: Sequence[int] = field(default_factory=list)
    pose: Pose = (0.0, 0.0, 0.0)
    way: Sequence[Point] = field(default_factory=list)
    theta: float | None = None
    awaits_path: bool = False


class RobotMemory:
    """A file with a robot's memory: on the disk when :meth:`keep` returns, and written atomically."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def recall(self) -> RememberedRun | None:
        """Return the state of an earlier run, None if there was none; raises BridgeError."""
        try:
            kept = decode_json(self._file.read_bytes())
            x, y, theta = kept["pose"]
            way = [(float(to_x), float(to_y)) for to_x, to_y in kept["way"]]
            return RememberedRun(**{**kept, "pose": (float(x), float(y), float(theta)), "way": way})
        except FileNotFoundError:
            return None
        except OSError as error:
            raise BridgeError(f"memory {self._file} cannot be read: {error.strerror or error}") from None
        except (ValueError, TypeError, KeyError) as error:
            raise BridgeError(
                f"memory {self._file} is none of a robot ({error}); name another file, or delete it if the "
                "robot may be sent again what it has done"
            ) from None

    def keep(self, remembered: RememberedRun) -> None:
        """Replace the stored state; raises BridgeError."""
        try:
            write_state(self._file, json.dumps(asdict(remembered)).encode())
        except OSError as error:
            raise BridgeError(
                f"memory {self._file} cannot be written: {error.strerror or error}; check its folder and "
                "free space"
            ) from error
