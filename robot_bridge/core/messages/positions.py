"""Positions of robots as operators are told them: reports, and a table of numbers for thousands."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from .operator_requests import DeskRequest, Done, Role
from .safety import PathDeclaration, RobotState
from .validation import MessageError, check_finite

# --- Positions as a table of numbers: what a desk asks for that shows thousands of robots ---
# A binary frame (:mod:`..core.position_frame`): a JSON-RPC notification ``positions`` whose params are
# :class:`PositionColumns`, and behind it each of its columns, one 64-bit float for each robot. What is not
# known of a robot is NaN. A column of :data:`POSITION_TEXTS` holds places in ``words``. A link tells the
# gateway of its robots in the same form.

POSITION_NUMBERS = (
    "age", "x", "y", "theta", "v", "device_time", "fix_time", "pose_age",
    "latency", "battery", "accuracy", "altitude",
)  # fmt: skip
POSITION_FLAGS = ("stopped",)
"""1 for true, 0 for false."""
POSITION_TEXTS = ("state", "link", "status", "command", "theta_from", "paths", "abilities")
PLACE_COLUMNS = ("state", "x", "y", "theta")
POSITION_ALWAYS = ("age", "stopped", "state", "link")
"""What is known of every robot."""


ELSEWHERE = "gateway "
"""Begins the link of a robot that another gateway of the fleet has; its name follows."""


def link_elsewhere(gateway: str) -> str:
    """Return the link of a robot that the gateway named ``gateway`` has."""
    return f"{ELSEWHERE}{gateway}"


def gateway_of_link(link: str) -> str | None:
    """Return the name of the gateway that has the robot of this link, None for the one that tells of it."""
    return link[len(ELSEWHERE) :] if link.startswith(ELSEWHERE) else None


class PositionForm(str, Enum):
    """How positions are told: a JSON object for each robot, or a table of numbers behind a JSON head.

    ``places`` is the table of :data:`PLACE_COLUMNS` alone, as 32-bit floats: a quarter as long, for phones.
    """

    ROWS = "rows"
    COLUMNS = "columns"
    PLACES = "places"


@dataclass(frozen=True)
class PositionColumns:
    """What the table behind it holds, at the gateway's time ``t``.

    ``columns`` are names of RobotReport's fields, in the order in which they follow, 64-bit little-endian
    floats (32-bit in the form ``places``), one for each of ``robots``; NaN is what is not known, and what is
    known of no robot is left out. In columns ``state``, ``link``, ``status``, ``command``, ``theta_from``,
    ``paths`` and ``abilities`` a number is a place in ``words``, counted from 0. With ``everything`` they
    are all robots that there are; otherwise ``removed`` are gone for good.
    """

    t: float
    robots: list[str]
    columns: list[str]
    words: list[str]
    removed: list[str] = field(default_factory=list)
    everything: bool = False


@dataclass  # not frozen: thousands are made every second, and a frozen one takes three times as long
class RobotReport:
    """One robot as the gateway knows it. ``age`` is seconds since its last message, when this was sent.

    A robot that has said Ready and not yet where it is has no pose: x, y, theta, v are None. ``device_time``
    and ``fix_time`` are the robot's own clocks, ``pose_age`` is seconds since its pose came in, by the
    gateway's. ``latency`` is the seconds that the robot's link took there and back when last measured.
    ``paths`` is what the robot declared in Ready about its paths, None of one that declared nothing: it
    drives straight to a target, and places no cone at the end of a path. ``abilities`` are what it can do,
    with spaces between them: empty of one that is only seen, None of one that can do everything.
    """

    robot: str
    state: RobotState
    age: float
    link: str
    stopped: bool = False
    x: float | None = None
    y: float | None = None
    theta: float | None = None
    v: float | None = None
    device_time: float | None = None
    fix_time: float | None = None
    pose_age: float | None = None
    latency: float | None = None
    battery: float | None = None
    status: str | None = None
    command: str | None = None
    accuracy: float | None = None
    altitude: float | None = None
    theta_from: str | None = None
    paths: PathDeclaration | None = None
    abilities: str | None = None


@dataclass(frozen=True)
class Positions:
    """Where robots are, at the gateway's time ``t``.

    With ``everything`` they are all robots that there are; otherwise ``removed`` are gone for good.
    """

    t: float
    robots: list[RobotReport]
    removed: list[str] = field(default_factory=list)
    everything: bool = False


@dataclass(frozen=True)
class Subscribe(DeskRequest[Done]):
    """Ask for ``positions`` up to ``rate`` times a second, what changed only; everything at first.

    ``form`` says whether they come as an object for each robot or as a table of numbers.
    """

    method = "subscribe"
    least_role = Role.VIEWER
    rate: float = 5.0
    form: PositionForm = PositionForm.ROWS

    def __post_init__(self) -> None:
        check_finite(rate=self.rate)
        if not 0 < self.rate <= 50:
            raise MessageError(f"rate is {self.rate}; give snapshots a second, above 0 and up to 50")


@dataclass(frozen=True)
class GetPositions(DeskRequest[Positions]):
    """Ask for the position of every robot (the second paper's ``get_positions``)."""

    method = "get_positions"
    least_role = Role.VIEWER
