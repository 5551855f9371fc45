"""What the robot says and does, without a wire or a clock of its own."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

from ..messages import (
    Abort,
    Alive,
    Answer,
    GetPath,
    GetSurface,
    OpAck,
    Ready,
    Request,
    SendPos,
    SetMap,
    SetPath,
    SetPosEnd,
    SetPosIni,
    SetSurface,
    Start,
    Stopped,
)
from ..robotmap.binary import decode
from ..robotmap.errors import RobotMapError
from ..robotmap.model import RobotMap
from .body import Body, BodyLimits, Pose
from .driver import Driver
from .memory import Memory, Remembered
from .sightings import Sightings, Thing

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


@dataclass(frozen=True)
class AgentSettings:
    """``magic`` names this run of the robot, ``noise`` is metres on reported positions.

    ``things`` are seen on the way, with ``image`` as the picture of each; with ``asks_path`` the robot asks
    for a path to every target; with ``asks_surface`` it asks what ground it is on and is to go to, and says
    so as its status. With a ``memory`` in which something is, the robot goes on from there.
    """

    magic: int
    pose: Pose
    limits: BodyLimits
    rate: float = 5.0
    noise: float = 0.01
    seed: int = 1
    things: tuple[Thing, ...] = ()
    image: bytes | None = None
    asks_path: bool = False
    asks_surface: bool = False
    memory: Memory | None = None


class Agent:
    """Takes in answers, lets time pass, and hands out the requests to send through ``say``.

    A message that came twice is acknowledged twice and done once. Until the gateway has taken its Ready the
    robot says nothing else: another one may run under its account.
    """

    def __init__(self, settings: AgentSettings, say: Callable[[Request], None]) -> None:
        self._settings = settings
        self._say = say
        self._random = random.Random(settings.seed)
        self._body = Body(settings.pose, settings.limits)
        self._driver: Driver | None = None
        self._sightings = Sightings(settings.things, settings.image, say)
        self._done: dict[int, None] = {}
        """The ids of the newest messages that were done, in that order."""
        self._database: str | None = None
        self._admitted = False
        self._greet_in = math.inf
        self._since_pose = math.inf
        self._moving = False
        self._wants_path = False
        self._ground: str | None = None
        self._since_kept = 0.0
        self.map: RobotMap | None = None
        self._magic = settings.magic
        remembered = settings.memory.recall() if settings.memory else None
        if remembered is not None:
            self._go_on(remembered)
        self._keep()

    @property
    def pose(self) -> Pose:
        """Where the robot really is."""
        return self._body.pose

    def greet(self) -> None:
        """Say Ready; done again whenever the link is made anew."""
        self._greet_in = math.inf
        self._say(Ready(magic=self._magic))

    def receive(self, answer: Answer, id: int | None) -> OpAck | None:
        """Take in message ``id`` of the server; return what to acknowledge it with."""
        if isinstance(answer, Start):
            self._count_ids_of(answer.database)
            self.greet()
            return None if id is None else OpAck(id=id)
        if isinstance(answer, OpAck):
            self._take_acknowledgement(answer)
            return None
        if isinstance(answer, Abort) and self._admitted:
            # What it has come to the end of has been reached, and is not aborted: said before its OpAck.
            self._say(self._position())
        if id is not None and id in self._done:
            # The gateway has not heard what became of it: it is told once more that all is done, when it is.
            self._moving = True
            return OpAck(id=id)
        refusal = self._do(answer)
        if id is not None:
            self._note_done(id)
        # Before it is acknowledged: what a robot has acknowledged it is not told once more.
        self._keep()
        return OpAck(id=id, ok=refusal is None, reason=refusal)

    def concerns(self, answer: Answer) -> bool:
        """Tell whether a message is for this run of the robot, and not for another one of its account."""
        if isinstance(answer, OpAck) and answer.magic is not None:
            return answer.magic == self._magic
        return self._admitted or isinstance(answer, Start)

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
        self._sightings.look(self._body.pose)
        self._since_pose += dt
        if self._since_pose >= 1 / self._settings.rate - dt / 2:
            self._since_pose = 0.0
            self._say(self._position())
        self._notice_stop()

    def _move(self, dt: float) -> None:
        if self._driver is not None:
            motion = self._driver.steer(self._body.pose)
            if motion is None:
                self._driver = None
                self._keep()
            self._body.drive(*(motion or (0.0, 0.0)))
        self._body.step(dt)

    def stop(self) -> None:
        """Say that the robot stands and does nothing; what it remembers of its task stays."""
        self._driver = None
        if self._admitted:
            self._say(Stopped())

    def alive(self) -> None:
        """Say Alive."""
        if self._admitted:
            self._say(Alive())

    def _go_on(self, remembered: Remembered) -> None:
        """Be the run of the robot that is remembered, and say once more that all is done when it is."""
        self._magic, self._database = remembered.magic, remembered.database
        self._done = dict.fromkeys(remembered.done)
        self._body.place(remembered.pose)
        if remembered.way:
            self._driver = Driver(remembered.way, remembered.theta, self._settings.limits)
        self._moving = True

    def _keep(self) -> None:
        self._since_kept = 0.0
        if self._settings.memory is None:
            return
        way, theta = ([], None) if self._driver is None else (self._driver.left, self._driver.theta)
        done = list(self._done)
        self._settings.memory.keep(Remembered(self._magic, self._database, done, self._body.pose, way, theta))

    def _take_acknowledgement(self, ack: OpAck) -> None:
        if ack.magic != self._magic:
            return
        self._admitted = ack.ok
        if ack.ok:
            self._count_ids_of(ack.database)
            self._ask_path()
        else:
            self._greet_in = GREET_AGAIN

    def _count_ids_of(self, database: str | None) -> None:
        """Forget what was done when ids begin anew, in another database."""
        if database != self._database:
            self._done.clear()
            self._database = database
            self._keep()

    def _note_done(self, id: int) -> None:
        self._done[id] = None
        if len(self._done) > MOST_DONE:
            del self._done[next(iter(self._done))]

    def _do(self, answer: Answer) -> str | None:
        """Do what a message asks; return why not, or None."""
        limits = self._settings.limits
        if isinstance(answer, SetMap):
            return self._take_map(answer)
        if isinstance(answer, SetPosEnd):
            self._driver = Driver([(answer.x, answer.y)], answer.theta, limits)
            self._wants_path = self._settings.asks_path
            self._ask_path()
            self._ask_surface((answer.x, answer.y))
        elif isinstance(answer, SetPath):
            self._driver = Driver(answer.points, answer.theta, limits)
            self._wants_path = False
            self._ask_surface(answer.points[-1])
        elif isinstance(answer, SetSurface):
            names = ["no road" if name is None else name or "an unknown surface" for name in answer.surfaces]
            self._ground = " to ".join(names)
        elif isinstance(answer, SetPosIni):
            return self._take_place(answer)
        elif isinstance(answer, Abort):
            self._driver = None
            self._wants_path = False
            self._body.drive(0.0, 0.0)
        self._moving = self._moving or self._driver is not None
        return None

    def _ask_path(self) -> None:
        """Ask for the path that is wanted, again after each Ready: a gateway that died answers no more."""
        if self._wants_path and self._driver is not None:
            # The path is to begin where the robot is now.
            self._say(self._position())
            self._say(GetPath())

    def _ask_surface(self, goal: tuple[float, float]) -> None:
        if self._settings.asks_surface:
            self._say(GetSurface([self._body.pose[:2], goal]))

    def _take_map(self, answer: SetMap) -> str | None:
        try:
            self.map = decode(answer.map)
        except RobotMapError as error:
            return f"the map cannot be read: {error}"
        return None

    def _take_place(self, begin: SetPosIni) -> str | None:
        if self._driver is not None or abs(self._body.v) >= STANDING:
            return "it drives, and knows where; abort its task first"
        self._body.place((begin.x, begin.y, self._body.pose[2] if begin.theta is None else begin.theta))
        return None

    def _position(self) -> SendPos:
        x, y, theta = self._body.pose
        noise = self._settings.noise
        return SendPos(
            x=round(x + self._random.gauss(0, noise), 3),
            y=round(y + self._random.gauss(0, noise), 3),
            theta=round(theta, 4),
            v=round(self._body.v, 3),
            battery=round(max(0.0, 1 - self._body.driven / RANGE), 3),
            status=self._ground,
        )

    def _notice_stop(self) -> None:
        if self._moving and self._driver is None and abs(self._body.v) < STANDING:
            self._moving = False
            self._keep()
            self._say(self._position())
            self._say(Stopped())
