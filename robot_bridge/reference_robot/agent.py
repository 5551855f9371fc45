"""What the robot says, does and remembers, without a wire or a clock of its own."""

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
"""metres that the simulated battery lasts."""
STEER_EVERY = 0.05
"""seconds; a robot steers as often, however late the program is in letting time pass."""
MOST_DONE = 10_000
"""Messages that are remembered: many more than a gateway ever has on their way to one robot."""
REMEMBER_EVERY = 1.0
"""seconds of driving between two notes of how far the robot has come."""
GREET_AGAIN = 1.0
"""seconds after which a robot that was refused says Ready once more."""
ASK_AGAIN = 3.0
"""seconds after which a robot that stands without a path asks for it once more."""
NEAR_BORDER = 0.25
"""of the shorter side of a map of a part of the site: so near to its border a robot asks for the next."""
SAME_MAP = 5.0
"""metres from where it was sent its map: nearer than that it would be sent the same one again."""
LEAST_KNOWN = 1e5
"""metres: a larger accuracy says no more."""
FIRST_AREA = 10_000.0
"""m² of the map that a robot asks for around itself when the first one was no use to it."""
OFF_PATH = 1.0
"""metres from its path at which a robot that has found itself again asks for another one."""
ASK_ROUND = 10.0
"""seconds for which something may be in its way until it asks for another path, and then again."""


@dataclass(frozen=True)
class AgentSettings:
    """``magic`` names this run of the robot, ``noise`` is metres on reported positions.

    ``things`` are seen on the way, with ``image`` as the picture of each; with ``asks_path`` the robot asks
    for a path to every target, and stands until it has one; with ``asks_surface`` it asks what ground it is
    on and is to go to, and says so as its status. With a ``memory`` in which something is, the robot goes on
    from there. It asks for the next map when the border of its own is nearer than ``map_margin`` metres, too.
    ``body`` is driven instead of one at ``pose`` that always knows its place.
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
    """A target (x, y) in metres, and the heading to end in, to which a path was asked for."""

    place: tuple[float, float]
    theta: float | None


class RequestSink(Protocol):
    """Who carries a robot's requests to the gateway."""

    def say(self, request: messages.Request) -> None:
        """Send a request."""


class Agent:
    """Takes in answers, lets time pass, and hands the requests to send to its ``sink``.

    A message that came twice is acknowledged twice and done once. Until the gateway has taken its Ready the
    robot says nothing else: another one may run under its account.
    """

    def __init__(self, settings: AgentSettings, sink: RequestSink) -> None:
        self._settings = settings
        self._sink = sink
        self._random = random.Random(settings.seed)  # nosec B311 # simulates noise
        self._body: SimulatedVehicle = settings.body or Body(settings.pose, settings.limits)
        self._driver: Driver | None = None
        self._sightings = ScriptedObjects(settings.things, settings.image)
        self._done: dict[int, None] = {}
        """The ids of the newest messages that were done, in that order."""
        self._database: str | None = None
        self._admitted = False
        self._rests = False
        """Whether it stands until the gateway has let it in: its task may have been aborted meanwhile."""
        self._greet_in = math.inf
        self._since_pose = math.inf
        self._moving = False
        self._awaited: Awaited | None = None
        """The target to which it was not told the path yet."""
        self._ask_in = math.inf
        self._no_path: str | None = None
        """Why it was not told it."""
        self._ground: str | None = None
        self._hindered = False
        self._ask_round_in = 0.0
        self._since_kept = 0.0
        self.map: RobotMap | None = None
        self._map_from = (0.0, 0.0)
        """Where it was when it was sent its map."""
        self._ask_map_in = 0.0
        self._map_refused = False
        self._magic = settings.magic
        remembered = settings.memory.recall() if settings.memory else None
        if remembered is not None:
            self._go_on(remembered)
        self._keep()

    @property
    def pose(self) -> Pose:
        """Where the robot takes itself to be."""
        return self._body.pose

    def greet(self) -> None:
        """Say Ready; done again whenever the link is made anew."""
        self._greet_in = math.inf
        asks, cones = self._settings.asks_path or None, self._settings.path_cones or None
        self._sink.say(messages.Ready(magic=self._magic, asks_path=asks, path_cones=cones))

    def receive(self, answer: messages.Answer, id: int | None) -> messages.OpAck | None:
        """Take in message ``id`` of the server; return what to acknowledge it with."""
        if isinstance(answer, messages.Start):
            self._count_ids_of(answer.database)
            self.greet()
            return None if id is None else messages.OpAck(id=id)
        if isinstance(answer, messages.OpAck):
            self._take_acknowledgement(answer)
            return None
        if isinstance(answer, messages.Abort) and self._admitted:
            # What it has come to the end of has been reached, and is not aborted: said before its OpAck.
            self._sink.say(self._position())
        if id is not None and id in self._done:
            # The gateway has not heard what became of it: it is told once more that all is done, when it is.
            self._moving = True
            return messages.OpAck(id=id)
        refusal = self._do(answer)
        if id is not None:
            self._note_done(id)
        # Before it is acknowledged: what a robot has acknowledged it is not told once more.
        self._keep()
        return messages.OpAck(id=id, ok=refusal is None, reason=refusal)

    def concerns(self, answer: messages.Answer) -> bool:
        """Tell whether a message is for this run of the robot, and not for another one of its account."""
        if isinstance(answer, messages.OpAck) and answer.magic is not None:
            return answer.magic == self._magic
        return self._admitted or isinstance(answer, messages.Start)

    def step(self, dt: float) -> None:
        """Let ``dt`` seconds pass: drive, and say where the robot is when it is time."""
        # A step that comes a little late is one step all the same.
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
            # It is not steered by a pose that is wrong, nor does it come to the end of its task by one.
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
        """Stand until the gateway has let the robot in once more; its task stays, unless it is aborted."""
        self._rests = True

    def stop(self) -> None:
        """Say that the robot stands and does nothing; what it remembers of its task stays."""
        self._driver = None
        if self._admitted:
            self._sink.say(messages.Stopped())

    def alive(self) -> None:
        """Say Alive."""
        if self._admitted:
            self._sink.say(messages.Alive())

    def _go_on(self, remembered: RememberedRun) -> None:
        """Be the run of the robot that is remembered, and say once more that all is done when it is."""
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

    def _take_acknowledgement(self, ack: messages.OpAck) -> None:
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
        """Stop, and forget what was done, when ids begin again: its task is in no other database."""
        if database != self._database:
            if self._database is not None:
                self._halt()
                self._moving = True
            self._done.clear()
            self._database = database
            self._keep()

    def _note_done(self, id: int) -> None:
        self._done[id] = None
        if len(self._done) > MOST_DONE:
            del self._done[next(iter(self._done))]

    def _do(self, answer: messages.Answer) -> str | None:
        """Do what a message asks; return why not, or None."""
        limits = self._settings.limits
        if isinstance(answer, messages.SetMap):
            return self._take_map(answer)
        if isinstance(answer, messages.SetPosEnd):
            self._take_target(answer)
            self._ask_surface((answer.x, answer.y))
        elif isinstance(answer, messages.SetPath):
            self._driver = Driver(answer.points, answer.theta, limits)
            self._await_path(None)
            self._ask_surface(answer.points[-1])
        elif isinstance(answer, SetSurface):
            names = ["no road" if name is None else name or "an unknown surface" for name in answer.surfaces]
            self._ground = " to ".join(names)
        elif isinstance(answer, messages.SetPosIni):
            return self._take_place(answer)
        elif isinstance(answer, messages.Abort):
            self._halt()
        self._moving = self._moving or self._driver is not None
        return None

    def _take_target(self, target: messages.SetPosEnd) -> None:
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
        """Ask for the path that is wanted, again after each Ready: a gateway that died answers no more.

        Also from time to time: roads are opened again.
        """
        if self._awaited is None:
            self._ask_in = math.inf
            return
        self._ask_in = ASK_AGAIN
        # The path is to begin where the robot is now.
        self._sink.say(self._position())
        self._sink.say(messages.GetPath())

    def _ask_way_round(self) -> None:
        """Ask for another path where something stays in the way; what it has is driven until one comes."""
        if self._driver is not None and self._settings.asks_path:
            self._ask_round_in = ASK_ROUND
            self._sink.say(self._position())
            self._sink.say(messages.GetPath())

    def _ask_surface(self, goal: tuple[float, float]) -> None:
        if self._settings.asks_surface:
            self._sink.say(GetSurface([self._body.pose[:2], goal]))

    def _take_map(self, answer: messages.SetMap) -> str | None:
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
        """Ask for the map around the robot where it is about to leave the one of a part that it has."""
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

    def _take_place(self, begin: messages.SetPosIni) -> str | None:
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


# --- What it keeps on its disk, so that a program that is started anew goes on as the one before it ---

Point = tuple[float, float]


@dataclass(frozen=True)
class RememberedRun:
    """The run of a robot: its ``magic`` number, and the ids of the messages of ``database`` that it has done.

    ``pose`` is where it was, ``way`` the points that are left of its task (none when it has nothing to do),
    and ``theta`` the heading to end in; metres and radians in the site frame. With ``awaits_path`` it was not
    told the path to the end of ``way`` yet, and stands.
    """

    magic: int
    database: str | None = None
    done: Sequence[int] = field(default_factory=list)
    pose: Pose = (0.0, 0.0, 0.0)
    way: Sequence[Point] = field(default_factory=list)
    theta: float | None = None
    awaits_path: bool = False


class RobotMemory:
    """A file with what a robot remembers: on the disk when :meth:`keep` returns, and never half of it."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def recall(self) -> RememberedRun | None:
        """Return what an earlier run kept, None where there was none; raises BridgeError."""
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
                "robot may be told once more what it has done"
            ) from None

    def keep(self, remembered: RememberedRun) -> None:
        """Write what is to be remembered in place of what was; raises BridgeError."""
        try:
            write_state(self._file, json.dumps(asdict(remembered)).encode())
        except OSError as error:
            raise BridgeError(
                f"memory {self._file} cannot be written: {error.strerror or error}; check its folder and "
                "free space"
            ) from error
