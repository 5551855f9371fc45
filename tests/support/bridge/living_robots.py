"""Robots that obey and live on while the gateway is gone: they drive, remember, and come back by themselves.

Each keeps a record of what it really did, which no database can be wrong about.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass, field

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.base import to_json
from robot_bridge.core.messages.robots import MOTION_OPS, OpAck, Ready, SendPos, SetObject, Stopped
from robot_bridge.protocol.codec import parse_params
from tests.support.robots.robot_lives import MindOverSql, Said

SPEED = 4.0
"""metres a second."""


@dataclass
class Task:
    """What a robot drives: ``points`` ahead of it, in which heading it ends, and what it does there."""

    op: str
    points: list[tuple[float, float]]
    theta: float | None = None
    does: str | None = None


@dataclass
class Record:
    """What a robot did: the messages it began to drive after, where it put down or took cones, and stops.

    ``ends`` are the places at which it finished a task, ``driven`` those at which it was on its way.
    ``after_stop`` is what it was sent while nobody may have sent it anywhere.
    """

    began: list[tuple[str, tuple[float, float]]] = field(default_factory=list)
    ends: list[tuple[float, float]] = field(default_factory=list)
    placed: list[tuple[float, float]] = field(default_factory=list)
    collected: list[tuple[float, float]] = field(default_factory=list)
    stops: int = 0
    driven: list[tuple[float, float]] = field(default_factory=list)
    after_stop: list[str] = field(default_factory=list)


class Robot:
    """A robot, without its wire; cones that it puts down stand at ``offset``: metres ahead, left.

    Until ``away_until`` it cannot be reached. One that ``says_late`` hears first, and then says where it is.
    """

    link = ""

    def __init__(self, play, name, place, offset=(0.0, 0.0)):
        self.play, self.name, self.offset = play, name, offset
        self.x, self.y = place
        self.theta, self.v = 0.0, 0.0
        self.magic = 1
        self.task: Task | None = None
        self.record = Record()
        self.away_until = 0.0
        self.says_late = False
        self.must_stand = False
        self._database = None
        self._done: set[int] = set()
        self._told_stopped = True

    # --- its body ------------------------------------------------------------------------------------------

    def move(self, seconds):
        """Let time pass."""
        self.v = 0.0
        left = SPEED * seconds
        while self.task is not None:
            x, y = self.task.points[0]
            away = math.dist((self.x, self.y), (x, y))
            if away > left:
                self.x += (x - self.x) * left / away
                self.y += (y - self.y) * left / away
                self.v = SPEED
                self.record.driven.append((self.x, self.y))
                return
            left -= away
            self.x, self.y = x, y
            self.task.points.pop(0)
            if not self.task.points:
                self._finish(self.task)

    def _finish(self, task):
        self.task = None
        self.theta = self.theta if task.theta is None else task.theta
        self.record.ends.append((self.x, self.y))
        self._told_stopped = False
        if task.does is not None:
            ahead, left = self.offset
            cos, sin = math.cos(self.theta), math.sin(self.theta)
            cone = self.x + ahead * cos - left * sin, self.y + ahead * sin + left * cos
            (self.record.placed if task.does == "place" else self.record.collected).append(cone)

    def lose_link(self):
        """The gateway is gone, or cannot be reached."""

    def end(self):
        """The play is over."""

    def start_anew(self):
        """Start as a program that knows nothing of before; the robot stands where it was."""
        self.lose_link()
        self.magic += 1
        self.task, self.v = None, 0.0
        self._done.clear()
        self._database = None

    # --- what it is told ------------------------------------------------------------------------------------

    def hear(self, id, op, params):
        """Take in a message of the gateway; what it did before it does not do again."""
        if id in self._done:
            self._told_stopped = False
            return
        self._done.add(id)
        if op == "Abort":
            self.stop()
        elif op in ("SetPath", "SetPosEnd"):
            self._begin(op, params)

    def stop(self):
        """Stand."""
        self.task = None
        self.v = 0.0
        self._told_stopped = False
        self.record.stops += 1

    def count_ids_of(self, database):
        """Forget what was done when ids begin anew."""
        if database != self._database:
            self._done.clear()
            self._database = database

    def _begin(self, op, params):
        if self.must_stand:
            self.record.after_stop.append(f"{op} {params}")
        theta = params.get("theta")
        if op == "SetPath":
            points = [(x, y) for x, y in params["points"]]
            self.task = Task(op, points, theta)
        else:
            points = [(params["x"], params["y"])]
            does = "place" if params.get("cone") else "collect" if params.get("collect") else None
            self.task = Task(op, points, theta, does)
        self.record.began.append((op, points[-1]))

    def position(self):
        """Return where it is, as it says it."""
        return SendPos(self.x, self.y, self.theta, self.v)


class WebSocketRobot(Robot):
    """A robot at the other end of a WebSocket, taken as calls of the fleet in the order of its session's."""

    link = "websocket"

    def __init__(self, *how, **more):
        super().__init__(*how, **more)
        self._connected = False
        self._last = {False: 0, True: 0}
        self._unsent: list[SetObject] = []
        self._call = 0

    def lose_link(self):
        self._connected = False

    def see(self, told):
        """Have the gateway told of an object, until it says that it has stored it."""
        self._unsent.append(told)

    def stop_now(self, call_id):
        """Take the direct call of an emergency stop."""
        if self._connected:
            self.stop()
            self.play.fleet.emergency.answered(self.name, call_id, refused=False)

    async def exchange(self):
        """Say and hear what there is to say and to hear; what fails is said again in the next second."""
        with contextlib.suppress(StoreError):
            await self._exchange()

    async def _exchange(self):
        fleet = self.play.fleet
        if self.play.now < self.away_until:
            self._connected = False
            return
        if not self._connected and not await self._connect():
            return
        while self._unsent:
            outcome = await fleet.receive(self.name, self.link, self._unsent[0], self._next_call())
            assert outcome.ack.ok
            self._unsent.pop(0)
        if not self.says_late:
            await self._say_where_it_is()
        for row in await fleet.outboxes.outbox(self.name, self._last[False], self._last[True]):
            if not await self._take(row):
                break
        if self.says_late:
            await self._say_where_it_is()
        if self.task is None and not self._told_stopped:
            await fleet.receive(self.name, self.link, Stopped(), self._next_call())
            self._told_stopped = True

    async def _take(self, row):
        """Do what a message says and acknowledge it; return false where the gateway begins anew with all."""
        fleet = self.play.fleet
        drives = row.op in MOTION_OPS
        if drives and not await fleet.outboxes.mark_sending(self.name, row.id):
            self._last[row.urgent] = row.id
            return True
        self.hear(row.id, row.op, parse_params(row.op, row.params) or {})
        self._last[row.urgent] = row.id
        if not drives:
            with contextlib.suppress(StoreError):
                await fleet.outboxes.delivered([row.id])
        try:
            await fleet.receive(self.name, self.link, OpAck(id=row.id), None)
        except StoreError:
            self._last = {False: 0, True: 0}
            return False
        return True

    async def _say_where_it_is(self):
        if (rest := self.play.fleet.accept_pose(self.name, self.link, self.position())) is not None:
            await rest

    async def _connect(self):
        fleet = self.play.fleet
        self.count_ids_of(fleet.reception.greeting().database)
        if fleet.emergency.call_id is not None:
            self.stop()
        outcome = await fleet.receive(self.name, self.link, Ready(self.magic), self._next_call())
        if outcome.answer is not None:
            await fleet.outboxes.finish([outcome], [], acks=False)
        self._connected, self._last = outcome.admitted, {False: 0, True: 0}
        return self._connected

    def _next_call(self):
        self._call += 1
        return self._call


class SqlRobot(Robot):
    """A robot on RR and SA, whether a gateway runs or not; it is the mind of its own life there."""

    link = "sql"

    def __init__(self, play, *how, **more):
        super().__init__(play, *how, **more)
        self._life = MindOverSql(self, play.url, lambda: play.now)
        self._unsaid: list[Said] = []

    def see(self, told):
        """Say that it saw an object, until the gateway has stored it."""
        self._unsaid.append(Said(type(told).__name__, to_json(told)))

    def start_anew(self):
        super().start_anew()
        self._life.begin()

    async def exchange(self):
        """Read and write what there is to read and to write."""
        self.turn()

    def turn(self):
        """As :meth:`exchange`; it needs no gateway."""
        if self.play.now >= self.away_until:
            self._life.turn()

    def end(self):
        self._life.close()

    def note(self, what, **details):
        """Keep no journal: what it did is in its record."""

    def belongs_to(self, database):
        if database is not None:
            self.count_ids_of(database)

    def pose(self, _now):
        return to_json(self.position())

    def request(self, now):
        if self.task is None and not self._told_stopped:
            self._told_stopped = True
            self._unsaid.append(Said("Stopped", {}))
        if not self._unsaid or now < self._unsaid[0].say_at:
            return None
        if self._unsaid[0].op == "Stopped" and self.task is not None:
            # It drives again: that it has stopped is not said once more.
            del self._unsaid[0]
            return None
        self._unsaid[0].say_at = math.inf
        return self._unsaid[0]

    def acknowledged(self):
        del self._unsaid[:1]

    def unsent(self, after=0.0):
        if self._unsaid:
            self._unsaid[0].say_at = self.play.now + after
