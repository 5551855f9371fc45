"""Links: messages between a link and the gateway (at ``/link``), and reports on links to operators."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from .administration import SiteReport
from .base import LONGEST_STATUS, DeskRequest, MessageError, Role, check_finite, known_fields, one_line

LINK_PROTOCOL = 1
MOST_COUNTS = 50
MOST_AREA_POINTS = 500_000
"""of the keepouts and roads in one answer."""
LONGEST_NAME = 32
"""characters of the kind of a link, and of the name of a count."""


@dataclass(frozen=True)
class LinkHello:
    """A link's first message: the ``protocol`` that it speaks, and its ``kind``, such as ``vda5050``."""

    protocol: int
    kind: str
    method: ClassVar[str] = "hello"

    def __post_init__(self) -> None:
        if self.protocol != LINK_PROTOCOL:
            raise MessageError(
                f"protocol {self.protocol} is not spoken here, {LINK_PROTOCOL} is; install the link and the "
                "gateway in the same version"
            )
        _check_name("kind", self.kind)


@dataclass(frozen=True)
class LinkWelcome:
    """The answer to LinkHello: the link's name, patterns of the ``robots`` that it may speak for, the site.

    CRS, origin and rotation of the ``site`` are the frame of all positions. An image may have
    ``largest_image_bytes``.
    """

    protocol: int
    link: str
    robots: list[str]
    database: str
    site: SiteReport
    largest_image_bytes: int


@dataclass(frozen=True)
class GetAreas:
    """Ask for the site's keepouts and roads that touch ``box``: x_min, y_min, x_max, y_max, site frame."""

    box: tuple[float, float, float, float]
    method: ClassVar[str] = "get_areas"

    def __post_init__(self) -> None:
        check_finite(**dict(zip(("x_min", "y_min", "x_max", "y_max"), self.box, strict=True)))


@dataclass(frozen=True)
class SiteArea:
    """A keepout: the outer ring, then its holes, metres in the site frame."""

    name: str
    rings: list[list[tuple[float, float]]]


@dataclass(frozen=True)
class SiteRoad:
    """The centreline of a road on the ground, its ``width`` in metres and the ``speed`` on it in m/s."""

    points: list[tuple[float, float]]
    width: float
    speed: float


@dataclass(frozen=True)
class SiteAreas:
    """The answer to GetAreas, of the site's ``version``."""

    version: int
    keepouts: list[SiteArea]
    roads: list[SiteRoad]


@dataclass(frozen=True)
class LinkStatus:
    """The state of a link: whether its own side is in order, a line about that, and its counters.

    ``reached``: the trouble concerns some of its robots only, and all can be reached.
    """

    ok: bool
    text: str | None = None
    counts: dict[str, float] = field(default_factory=dict)
    reached: bool | None = None
    method: ClassVar[str] = "status"

    def __post_init__(self) -> None:
        if self.text is not None:
            object.__setattr__(self, "text", one_line(self.text, LONGEST_STATUS))
        if len(self.counts) > MOST_COUNTS:
            raise MessageError(f"counts holds {len(self.counts)} names; give at most {MOST_COUNTS}")
        for name in self.counts:
            _check_name("a name in counts", name)


@dataclass(frozen=True)
class LinkPositions:
    """Where robots of the link are, as JSON: SendPos or SendGPS of each, with its ``robot``."""

    positions: list[dict[str, Any]]
    method: ClassVar[str] = "positions"


@dataclass(frozen=True)
class LinkColumns:
    """Where robots of the link are, as the table that follows: in each column a 64-bit float for each robot.

    ``columns`` are x, y, theta, v, and the known ones of device_time, fix_time, battery, accuracy, altitude,
    status and theta_from; NaN is an unknown value. In the last two a number is an index into ``words``.
    """

    robots: list[str]
    columns: list[str]
    words: list[str]


@dataclass(frozen=True)
class AbortOfAll:
    """All robots of the link must stop, even those that have not sent Ready through it.

    Each robot answers by a reply of its own, whose id is its name, ``/`` and ``call``.
    """

    call: str
    emergency: bool = True
    method: ClassVar[str] = "Abort"


@dataclass(frozen=True)
class Released:
    """The link no longer speaks for ``robot``, until it sends Ready for it again: ``reason`` says why."""

    robot: str
    reason: str


def _check_name(what: str, name: str) -> None:
    if not (0 < len(name) <= LONGEST_NAME and name.isidentifier() and name.isascii()):
        raise MessageError(f"{what} is {name[:40]!r}; give 1 to {LONGEST_NAME} letters, digits or '_'")


# --- Reports on links to operators, and requests to one that plays a recording ---


@dataclass(frozen=True)
class LinkReport:
    """A link, which speaks for many robots; ``up``: it is connected, and its robots can be reached.

    Otherwise ``text`` says what is wrong, and ``robots`` are those that it spoke for: fifty names at most, of
    ``count`` in all. If it is up, ``text`` names troubles of some of its robots, if any.
    """

    link: str
    kind: str | None
    up: bool
    text: str | None = None
    robots: list[str] = field(default_factory=list)
    count: int = 0


@dataclass(frozen=True)
class Links:
    """All links named by the site, and those that have been connected since the gateway's start."""

    links: list[LinkReport] = field(default_factory=list)


def links_report(values: dict[str, Any]) -> Links:
    """Return the state of each link that a gateway sent as JSON."""
    return Links([LinkReport(**known_fields(LinkReport, one)) for one in values["links"]])


@dataclass(frozen=True)
class Playback:
    """How a link should continue its recording; fields left out stay unchanged.

    ``speed`` is seconds of the recording per second, ``place_s`` seconds from its beginning.
    """

    speed: float | None = None
    paused: bool | None = None
    loop: bool | None = None
    place_s: float | None = None
    method: ClassVar[str] = "playback"

    def __post_init__(self) -> None:
        check_finite(speed=self.speed, place_s=self.place_s)


@dataclass(frozen=True)
class PlaybackReport:
    """The state of a playback: the name of its file, and the position within its ``length_s`` seconds."""

    file: str
    speed: float
    paused: bool
    loop: bool
    place_s: float
    length_s: float


@dataclass(frozen=True)
class SetPlayback(DeskRequest[PlaybackReport]):
    """Change the playback of ``link``, as :class:`Playback`; with ``link`` alone, only query it."""

    method = "set_playback"
    least_role = Role.OPERATOR
    link: str
    speed: float | None = None
    paused: bool | None = None
    loop: bool | None = None
    place_s: float | None = None

    def __post_init__(self) -> None:
        check_finite(speed=self.speed, place_s=self.place_s)

    @property
    def change(self) -> Playback:
        """The change to send to the link."""
        return Playback(self.speed, self.paused, self.loop, self.place_s)
