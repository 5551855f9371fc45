"""Messages between the gateways of a fleet: encoded, signed, decoded, bounded and exchanged.

Any account that may write to the bus can send anything: a robot's account may NOTIFY on PostgreSQL, and a
NATS server may serve others as well. So every message is signed with a key that the fleet's database holds
and robots cannot read. Messages not signed with it, or not understood, are ignored.
"""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import itertools
import logging
import secrets
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Annotated, Literal, TypeVar

import msgspec
import numpy as np
import numpy.typing as npt
from msgspec import Meta

from ...core.errors import BridgeError
from ...core.logs import RepeatedLines
from ...core.messages.base import LONGEST_STATUS, MessageError, check_command_id, check_robot_name
from ...core.messages.safety import FenceKind, PathDeclaration, StopAction, StopOutcome
from ..model.events import EventBus
from ..model.robot_columns import REPORTED_NUMBERS
from ..monitoring import until_tick
from .bus import EVERYBODY, RIGHTS_PROBE, STOP, Bus, NoBus, own_subject
from .membership import Membership

log = logging.getLogger(__name__)

FORM = b"\x01"
"""The format version of all messages; gateways with different ones do not understand each other."""
LARGEST = 256 * 1024
"""bytes of a message."""
SIGNATURE = 16
"""bytes."""
FRAME = 128
"""bytes of a message at most, without the robots in it."""
MOST_ROBOTS = 8192
"""in one message."""
PLACE_BYTES, NAME_BYTES = 4 * REPORTED_NUMBERS + 4 + 1, 2
"""bytes that a robot takes in a message of positions, and its name beside its letters."""
MOST_IDS = 1_000_000
"""numbers for robots in one run of a gateway."""

MOST_NAMED = 50
"""robots named individually in a message."""
MOST_ABORTS = 1000
"""Aborts in a message."""
MOST_ALARMS, MOST_UNJUDGED = 300, 20
"""alarms of the geofence, and robots that it cannot judge, in a message and in a report to operators."""
LONGEST_NAME = 200
"""characters of the name of a keepout or an obstacle."""

Gateway = Annotated[str, Meta(max_length=32)]
Robot = Annotated[str, Meta(max_length=63)]
Id = Annotated[str, Meta(max_length=64)]
Line = Annotated[str, Meta(max_length=600)]
Status = Annotated[str, Meta(max_length=LONGEST_STATUS)]
Names = Annotated[list[Robot], Meta(max_length=MOST_NAMED)]
Count = Annotated[int, Meta(ge=0, le=10_000_000)]
Finite = Annotated[float, Meta(ge=-1e12, le=1e12)]
Number = Annotated[int, Meta(ge=0, le=(1 << 63) - 1)]
"""Number of a message about stops: :class:`Exchange` numbers each, so that no two are the same bytes. It is 0
from earlier versions, which give none."""
Topic = Annotated[str, Meta(max_length=32)]
MOST_TOPICS = 32


class BusMessageError(BridgeError):
    """Bytes on the bus that are not a message of this fleet."""


class _SenderRun(msgspec.Struct, array_like=True, frozen=True, tag=True, kw_only=True):
    """Last field, added by :class:`Exchange`: ``sender_run``, "" from an earlier version.

    Earlier versions ignore fields behind those that they know: a field added to a message must be ``kw_only``
    as well.
    """

    sender_run: Annotated[str, Meta(max_length=32)] = ""


class BusMessage(_SenderRun, frozen=True, tag=True):
    """A message; ``gw`` is the gateway that sent it."""

    gw: Gateway


class Beat(BusMessage, frozen=True, tag="beat"):
    """The gateway is alive at the database's time ``t``, in seconds.

    ``changes`` are the numbers of its last stored changes, by :data:`WakeTopic`; None from an earlier
    version.
    """

    t: float = 0.0
    changes: Annotated[dict[Topic, Number], Meta(max_length=MOST_TOPICS)] | None = None


WakeTopic = Literal[
    "requests",
    "answers",
    "owners",
    "steps",
    "stops",
    "site",
    "observations",
    "placements",
    "plans",
    "queues",
    "closures",
    "positions",
]
"""What another gateway should check; ``positions`` asks it for all of its robots."""


class Wake(BusMessage, frozen=True, tag="wake"):
    """Something was committed that concerns another gateway, which should check at once."""

    what: WakeTopic


class StopCall(BusMessage, frozen=True, tag="stop"):
    """Every robot must stop; repeated until each gateway has answered."""

    id: Id
    at: float
    by: Annotated[str, Meta(max_length=200)]
    reason: Line | None = None
    number: Number = 0


class StopSeen(BusMessage, frozen=True, tag="stopped"):
    """The stop is in force at the gateway, and on its way to its robots; with their progress."""

    id: Id
    robots: Count
    acknowledged: Count
    standing: Count
    waiting: Names = []
    refused: Names = []
    number: Number = 0
    moving: Names = []
    moving_more: Count = 0
    unheard: Names = []
    unheard_more: Count = 0


class AbortCall(BusMessage, frozen=True, tag="abort"):
    """Send a robot an Abort over its open connection, wherever that is: the Abort may not be stored."""

    robot: Robot
    call_id: Annotated[str, Meta(max_length=100)]


class NotedAbort(msgspec.Struct, array_like=True, frozen=True):
    """An Abort that was sent and is not stored: what a command needs, and since when (database time, s)."""

    command: Id
    robot: Robot
    by: Annotated[str, Meta(max_length=200)]
    at: Finite
    reason: Line | None = None
    aborts: Id | None = None
    expires_in: Annotated[float, Meta(gt=0, le=1e12)] | None = None
    emergency: bool = False
    of_pause: bool = False
    """Whether a failed pause has left it: another one that succeeds makes it void."""


class AbortsNoted(BusMessage, frozen=True, tag="aborts"):
    """Aborts for the gateways that have, or get, their robots to store and send before anything else."""

    aborts: Annotated[list[NotedAbort], Meta(max_length=MOST_ABORTS)]


class AbortsSettled(BusMessage, frozen=True, tag="aborts-settled"):
    """Noted Aborts, by id, that are stored or void since a time (database, s): nobody has to store them."""

    commands: Annotated[dict[Id, Finite], Meta(max_length=MOST_ABORTS)]


class PositionBatch(BusMessage, frozen=True, tag="positions"):
    """Positions of robots of the gateway, at the database's time ``t``, in seconds.

    ``ids`` are uint32, the robots' numbers in run ``run`` of the gateway; ``names`` belong to the first of
    them, the others were named before. ``numbers`` are float32, robot by robot, NaN where there is none: x, y
    (m, site frame), theta (rad), v (m/s), seconds since its pose, and since its last message. ``flags`` are a
    byte of each robot: see :data:`~..model.robot_columns.REPORTED_FLAGS`.
    """

    t: float
    run: Number
    ids: Annotated[bytes, Meta(max_length=4 * MOST_ROBOTS)]
    names: Annotated[list[Robot], Meta(max_length=MOST_ROBOTS)]
    numbers: Annotated[bytes, Meta(max_length=4 * REPORTED_NUMBERS * MOST_ROBOTS)]
    flags: Annotated[bytes, Meta(max_length=MOST_ROBOTS)]

    def table(self) -> npt.NDArray[np.float32]:
        """Return the numbers, a row for each robot."""
        return np.frombuffer(self.numbers, dtype="<f4").reshape(-1, REPORTED_NUMBERS)

    def robots(self) -> npt.NDArray[np.uint32]:
        """Return the ids."""
        return np.frombuffer(self.ids, dtype="<u4")


class RobotDetails(msgspec.Struct, array_like=True, frozen=True):
    """Rarely changing values of a robot, as in :class:`~..model.robots.Robot` and its pose."""

    name: Robot
    battery: Annotated[float, Meta(ge=0, le=1)] | None = None
    status: Status | None = None
    doubt: Status | None = None
    latency: Annotated[float, Meta(ge=0, le=1e6)] | None = None
    paths: PathDeclaration | None = None
    abilities: Annotated[str, Meta(max_length=128)] | None = None
    magic: int | None = None


class DetailBatch(BusMessage, frozen=True, tag="details"):
    """Details of robots of the gateway, at the database's time ``t``, in seconds."""

    t: float
    robots: Annotated[list[RobotDetails], Meta(max_length=MOST_ROBOTS)]


class FencedRobot(msgspec.Struct, array_like=True, frozen=True):
    """A robot in a keepout or at an obstacle, as :class:`~...core.messages.safety.FenceAlarm` has it."""

    robot: Robot
    kind: FenceKind
    name: Annotated[str, Meta(max_length=LONGEST_NAME)]
    since: Finite
    x: Finite
    y: Finite
    action: StopAction
    outcome: StopOutcome
    reason: Line | None
    current: bool


class FenceReport(BusMessage, frozen=True, tag="fence"):
    """Robots of the gateway in keepouts and at obstacles, at the database's time ``t``, in seconds.

    ``more`` and ``unjudged_more`` count those that are not listed.
    """

    t: float
    alarms: Annotated[list[FencedRobot], Meta(max_length=MOST_ALARMS)]
    more: Count = 0
    unjudged: Annotated[list[Robot], Meta(max_length=MOST_UNJUDGED)] = []
    unjudged_more: Count = 0
    fault: Line | None = None


class QueuesChanged(BusMessage, frozen=True, tag="queues"):
    """Queues of robots have changed at the gateway, which owns or edited them; the change is stored."""

    robots: Names


class NameQuery(BusMessage, frozen=True, tag="name?"):
    """Asks whether another robot runs at the receiving gateway under the name of one that said Ready."""

    id: Id
    robot: Robot
    magic: int


class NameAnswer(BusMessage, frozen=True, tag="name"):
    """The answer to a :class:`NameQuery`: why that robot is refused, or None."""

    id: Id
    refusal: Line | None = None


AnyMessage = (
    Beat
    | Wake
    | StopCall
    | StopSeen
    | AbortCall
    | AbortsNoted
    | AbortsSettled
    | PositionBatch
    | DetailBatch
    | FenceReport
    | QueuesChanged
    | NameQuery
    | NameAnswer
)
_DECODER = msgspec.msgpack.Decoder(AnyMessage)
_ENCODER = msgspec.msgpack.Encoder()
Entry = TypeVar("Entry", bound=msgspec.Struct | str)
"""What a message has a list of."""


class Codec:
    """Converts messages to signed bytes and back; ``key`` is the secret of the fleet."""

    def __init__(self, key: bytes) -> None:
        self._key = key

    def encode(self, message: BusMessage) -> bytes:
        """Return a message as bytes."""
        content = FORM + _ENCODER.encode(message)
        return self._signature(content) + content

    def decode(self, data: bytes) -> AnyMessage:
        """Return the message in ``data``; raises BusMessageError with the reason if it is invalid."""
        if len(data) > LARGEST:
            raise BusMessageError(f"a message of {len(data)} bytes; {LARGEST} are the most")
        content = data[SIGNATURE:]
        if not hmac.compare_digest(data[:SIGNATURE], self._signature(content)):
            raise BusMessageError(
                "a message that is not signed by this fleet: another fleet, or somebody else, writes to its "
                "subjects; give each fleet a bus, or an account on it, of its own"
            )
        if content[:1] != FORM:
            raise BusMessageError(
                "a message of another version of robot-bridge; bring all gateways to the same version"
            )
        try:
            message: AnyMessage = _DECODER.decode(content[1:])
        except msgspec.DecodeError as error:
            raise BusMessageError(f"a message that cannot be read: {error}") from None
        if isinstance(message, PositionBatch):
            _check_lengths(message)
        elif isinstance(message, AbortsNoted):
            _check_aborts(message)
        return message

    def _signature(self, content: bytes) -> bytes:
        return hashlib.blake2b(content, digest_size=SIGNATURE, key=self._key).digest()


def position_batches(whole: PositionBatch, largest: int) -> Iterator[PositionBatch]:
    """Yield ``whole`` split into messages of at most ``largest`` bytes each."""
    sizes = np.full(len(whole.flags), PLACE_BYTES)
    # Names are ASCII.
    letters = np.array([len(name) for name in whole.names], dtype=np.intp)
    sizes[: len(letters)] += NAME_BYTES + letters
    ends, begin = np.cumsum(sizes), 0
    while begin < len(sizes):
        room = largest - FRAME + (int(ends[begin - 1]) if begin else 0)
        end = min(max(int(np.searchsorted(ends, room, side="right")), begin + 1), begin + MOST_ROBOTS)
        yield msgspec.structs.replace(
            whole,
            ids=whole.ids[4 * begin : 4 * end],
            names=whole.names[begin:end],
            numbers=whole.numbers[4 * REPORTED_NUMBERS * begin : 4 * REPORTED_NUMBERS * end],
            flags=whole.flags[begin:end],
        )
        begin = end


def batches(entries: Iterable[Entry], largest: int, most: int = MOST_ROBOTS) -> Iterator[list[Entry]]:
    """Yield entries in lists of at most ``most`` that fit into messages of ``largest`` bytes."""
    some: list[Entry] = []
    size = FRAME
    for one in entries:
        more = len(_ENCODER.encode(one))
        if some and (size + more > largest or len(some) == most):
            yield some
            some, size = [], FRAME
        some.append(one)
        size += more
    if some:
        yield some


def fitting_report(report: FenceReport, largest: int) -> FenceReport:
    """Return ``report`` with as many of its first alarms as fit into ``largest`` bytes."""
    room = largest - FRAME - len(_ENCODER.encode(msgspec.structs.replace(report, alarms=[])))
    sizes = itertools.accumulate(len(_ENCODER.encode(alarm)) for alarm in report.alarms)
    fits = sum(size <= room for size in sizes)
    more = report.more + len(report.alarms) - fits
    return msgspec.structs.replace(report, alarms=report.alarms[:fits], more=more)


def _check_aborts(noted: AbortsNoted) -> None:
    try:
        for abort in noted.aborts:
            check_robot_name(abort.robot)
            check_command_id(abort.command)
            if abort.aborts is not None:
                check_command_id(abort.aborts)
    except MessageError as error:
        raise BusMessageError(f"an Abort that cannot be: {error}") from None


def _check_lengths(batch: PositionBatch) -> None:
    count = len(batch.flags)
    if (
        len(batch.numbers) != 4 * REPORTED_NUMBERS * count
        or len(batch.ids) != 4 * count
        or len(batch.names) > count
    ):
        raise BusMessageError(f"positions of {count} robots with numbers of others")
    if count and int(batch.robots().max()) >= MOST_IDS:
        raise BusMessageError(f"positions of a robot with a number of {MOST_IDS} or more")


# --- Exchange: sends messages to the buses, and delivers received ones to subscribers ---

HEARD_S = 5.0
"""seconds after which a silent gateway no longer counts as heard."""
COUNT_S = 1.0
"""seconds between log lines with the count of omitted lines."""
WITHOUT_LEASE = (
    "gateway {} does not renew its lease: see whether it reaches the database, and whether that is this "
    "fleet's and no copy; its stops and Aborts are done here, and nothing else of it counts"
)
"""Log text on a gateway that is listed in the database and was never seen alive there."""
COPY = (
    "gateway {} serves a copy of this fleet's database on the same bus; its stops and Aborts are done here, "
    "and nothing else of it counts: give it a bus of its own, or restore a backup in place of the copy"
)
"""Log text on a gateway that is not of this fleet and has its key."""

MOST_NUMBERED = 1024
"""messages about stops kept to detect copies: those of four gateways on a stop in 20 seconds."""

URGENT = (Wake, NameQuery, NameAnswer, AbortsNoted, AbortsSettled)
"""Messages that go over all buses."""

Kind = TypeVar("Kind", bound=BusMessage)


class Exchange:
    """Sends over the first bus; stops, Aborts, wakes and queries over all of them.

    A failing subscriber does not keep a message from others. Messages about stops arrive over several buses,
    and are delivered once: each copy would be answered, over every bus. A repeated call is another message,
    by its number.
    """

    def __init__(
        self, gateway: str, key: bytes, buses: Sequence[Bus], membership: Membership | None = None
    ) -> None:
        self.gateway = gateway
        self._membership = membership
        self._codec = Codec(key)
        self._buses = buses
        self._events = EventBus()
        self._heard: dict[str, float] = {}
        self._heard_without_lease: dict[str, float] = {}
        # Random start, so that a restarted gateway does not begin with the same ones.
        self._numbers = itertools.count(1 + secrets.randbits(48))
        self._known: dict[bytes, None] = {}
        """the signatures of messages about stops, the oldest first."""
        self._repeated = RepeatedLines()

    def subscribe(self, kind: type[Kind], handler: Callable[[Kind], None]) -> None:
        """Call ``handler``, which must not block, with each message of ``kind`` from another gateway."""
        self._events.subscribe(kind, handler)

    def send(self, subject: str, message: BusMessage) -> bool:
        """Send a message; return at once, true if a bus accepted it."""
        if isinstance(message, (StopCall, StopSeen)):
            message = msgspec.structs.replace(message, number=next(self._numbers))
        if self._membership is not None:
            message = msgspec.structs.replace(message, sender_run=self._membership.me.run)
        content = self._codec.encode(message)
        urgent = subject == STOP or isinstance(message, URGENT)
        taken = [bus.publish(subject, content) for bus in (self._buses if urgent else self._buses[:1])]
        return any(taken)

    def wake(self, what: WakeTopic, gateway: str | None = None) -> None:
        """Have a gateway, or all others, check at once: ``what`` has been committed."""
        subject = EVERYBODY if gateway is None else own_subject(gateway)
        self.send(subject, Wake(self.gateway, what))

    @property
    def connected(self) -> bool:
        """Whether the first bus, which carries all that is not urgent, is connected, as far as is known."""
        return self._buses[0].connected

    def connections(self) -> dict[str, bool]:
        """Return whether each bus is connected, by its name; the first one carries all messages."""
        return {bus.name: bus.connected for bus in self._buses if not isinstance(bus, NoBus)}

    def heard(self, within: float = HEARD_S) -> list[str]:
        """Return the other gateways that sent something ``within`` so many seconds."""
        return _recent(self._heard, within)

    def heard_without_lease(self) -> list[str]:
        """Return the recently heard gateways that are in the database without a lease."""
        return _recent(self._heard_without_lease, HEARD_S)

    async def run(self) -> None:
        """Keep all buses connected until cancelled."""
        async with asyncio.TaskGroup() as group:
            for bus in self._buses:
                group.create_task(bus.run(self.receive))
            group.create_task(self._count_repeated())

    def receive(self, subject: str, content: bytes) -> None:
        """Receive a message as it came from a bus."""
        if content == RIGHTS_PROBE:
            return
        try:
            message = self._codec.decode(content)
        except BusMessageError as error:
            self._warn(subject, f"bus, subject {subject}: {error}")
            return
        if not self._admit(subject, message):
            return
        if isinstance(message, (StopCall, StopSeen)) and message.number:
            if self._is_copy(content[:SIGNATURE]):
                return
            message = msgspec.structs.replace(message, number=0)
        self._events.publish(message)

    def _admit(self, subject: str, message: BusMessage) -> bool:
        """Record which gateway was heard; return whether its message is accepted."""
        if self._is_own(message):
            return False
        is_from_copy = self._is_from_copy(message)
        has_no_lease = self._has_no_lease(message)
        if is_from_copy:
            line = WITHOUT_LEASE if has_no_lease else COPY
            self._warn(subject, f"bus, subject {subject}: {line.format(message.gw)}")
        if isinstance(message, StopCall):
            is_due = subject == STOP
        elif isinstance(message, AbortCall):
            is_due = True
        else:
            # Another process of this one's name is not one of the others.
            is_due = message.gw != self.gateway and not is_from_copy
        is_read = message.gw != self.gateway and self._is_read(message)
        if is_read:
            self._heard[message.gw] = time.monotonic()
        elif has_no_lease and message.gw != self.gateway:
            self._heard_without_lease[message.gw] = time.monotonic()
        # Robots in an answer belong to this fleet only if its gateway is known to.
        return is_due and (is_read or not isinstance(message, StopSeen))

    def _is_own(self, message: BusMessage) -> bool:
        """Return whether this gateway sent a message.

        Compared by run: a gateway on a copy of the database, or one that stood still, may have the same name.
        """
        known = self._membership
        return message.gw == self.gateway and (known is None or message.sender_run == known.me.run)

    def _is_read(self, message: BusMessage) -> bool:
        """Return whether a message comes from a gateway that was read in the database of this fleet."""
        known = self._membership
        return known is None or message.sender_run == "" or known.has_read(message.sender_run)

    def _has_no_lease(self, message: BusMessage) -> bool:
        """Return whether a message comes from a gateway in the database that was not alive there."""
        return self._membership is not None and self._membership.is_without_lease(message.sender_run)

    def _is_from_copy(self, message: BusMessage) -> bool:
        """Return whether a message has this fleet's key and comes from none of its gateways."""
        known = self._membership
        return known is not None and message.sender_run != "" and known.is_stranger(message.sender_run)

    def _warn(self, subject: str, line: str) -> None:
        self._repeated.warn(log, ("bus", "of the fleet:", subject.partition(".")[0]), line)

    async def _count_repeated(self) -> None:
        while True:
            await asyncio.sleep(until_tick(COUNT_S))
            self._repeated.summarise()

    def _is_copy(self, signature: bytes) -> bool:
        if signature in self._known:
            return True
        self._known[signature] = None
        if len(self._known) > MOST_NUMBERED:
            del self._known[next(iter(self._known))]
        return False


def _recent(heard: dict[str, float], within: float) -> list[str]:
    now = time.monotonic()
    return sorted(name for name, at in heard.items() if now - at < within)
