"""Adapter of one kind of robots, and the link to the gateway as adapters see it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

from ...core.messages.administration import SiteReport
from ...core.messages.links import Playback, PlaybackReport, SiteAreas
from ...core.messages.robots import Answer, OpAck, Request, SendGPS, SendPos
from ...core.messages.safety import Ability
from .errors import CommandRefusedError
from .frames import LinkFrame
from .settings import LinkSettings

# --- Interface from the adapter to the gateway: reports on robots, and the gateway's site ---


class Link(Protocol):
    """The gateway as seen by an adapter: all methods are called in the adapter's loop.

    Reports made while the gateway is away are dropped if they would be old (positions), and kept if they
    matter (:meth:`stopped`, :meth:`give_up`, :meth:`ask`).
    """

    @property
    def settings(self) -> LinkSettings:
        """The settings that every link has."""

    @property
    def site(self) -> SiteReport:
        """The site: its bounds, CRS, origin and rotation."""

    @property
    def frame(self) -> LinkFrame:
        """The frame of the link's robots on this site."""

    @property
    def largest_image_bytes(self) -> int:
        """Largest size of an image in bytes; a larger one would end the connection."""

    @property
    def is_connected(self) -> bool:
        """Whether the gateway has admitted this link."""

    @property
    def robots(self) -> list[str]:
        """The robots that it speaks for."""

    def add(self, robot: str, abilities: Sequence[Ability] = (), *, path_cones: bool = False) -> None:
        """Speak for ``robot`` from now on; without ``abilities`` it is seen and not commanded.

        Called again, it reports changed abilities to the gateway.

        :raises MessageError: for an invalid name of a robot.
        """

    def remove(self, robot: str) -> None:
        """Stop speaking for ``robot``: it becomes stale and lost, or offline after a Stopped."""

    def restarted(self, robot: str) -> None:
        """Record that the robot has restarted and forgotten its tasks: open messages are sent again."""

    def adrift(self, robot: str) -> None:
        """Record that ``robot`` may execute a task not requested under this name: it is stopped first.

        Its open commands fail.
        """

    def position(self, robot: str, position: SendPos | SendGPS) -> None:
        """Report a position of ``robot``; of several within a moment the last is sent, and no old one."""

    def alive(self, robot: str) -> None:
        """Report that ``robot`` is alive; call at least every second without other reports."""

    def stopped(self, robot: str) -> None:
        """Report that ``robot`` stands and is idle; kept until the gateway has acknowledged it."""

    def give_up(self, robot: str, command: int, reason: str) -> None:
        """Report that ``robot`` gave up an accepted command; ``reason`` is for operators."""

    async def ask(self, robot: str, request: Request) -> OpAck:
        """Send an acknowledged request, such as SetObject, SendImage or GetMap; return the acknowledgement.

        It is kept over reconnects until then. Give an observation a ``source``, so that it is stored once.

        :raises CommandRefusedError: when the gateway refuses it, with its reason.
        """

    async def areas(self, box: tuple[float, float, float, float]) -> SiteAreas:
        """Return the site's keepouts and roads that touch ``box``: x_min, y_min, x_max, y_max, site frame.

        The request is repeated on each new connection until the gateway has answered.

        :raises CommandRefusedError: when the gateway refuses it, with its reason.
        """

    def report(
        self,
        *,
        ok: bool,
        text: str | None = None,
        counts: dict[str, float] | None = None,
        reached: bool = False,
    ) -> None:
        """Report the state of the link's own side: ``ok`` false is an alarm for operators.

        Set ``reached`` if only some of its robots have faults, and none is out of reach.
        """


MOST_FAULTS = 3
"""faults given as text."""


def summary(faults: Sequence[str]) -> str | None:
    """Return the faults of robots as one line for operators; None without faults."""
    more = f" (and {len(faults) - MOST_FAULTS} more)" if len(faults) > MOST_FAULTS else ""
    return "; ".join(faults[:MOST_FAULTS]) + more or None


# --- Interface of an adapter: one kind of robots, called by the link's process ---


@dataclass(frozen=True)
class Command:
    """A message for ``robot``: SetPosEnd, SetPath, SetPosIni, SetMap or SetSurface, metres in the site frame.

    ``id`` identifies it among all messages of the gateway's database, and stays the same when it is sent
    again. ``again``: an earlier process began it, and died before it recorded the outcome. An order or goal
    id derived from ``id`` lets the robot's side execute it once.
    """

    robot: str
    id: int
    message: Answer
    again: bool = False


class Adapter(ABC):
    """One kind of robots. Every method is called in the loop of :meth:`run`, and must not block."""

    kind: ClassVar[str]
    """Its name on the command line."""
    holds_s: float = 0.0
    """seconds for which it may hold a command before sending it to the robot's side."""

    @abstractmethod
    async def run(self, link: Link) -> None:
        """Connect to the robots' side and report to ``link``, until cancelled.

        It is called once the gateway has sent the site, so that ``link.frame`` is known. Its errors end the
        process; raise LinkError for faults that a person must put right.
        """

    @abstractmethod
    async def command(self, command: Command) -> None:
        """Have the robot accept ``command``; return when it has.

        Commands of one robot come one at a time, in order. When an Abort comes this is cancelled, and
        :meth:`stop` is called.

        :raises CommandRefusedError: when the robot refuses it.
        """

    @abstractmethod
    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Have the robot drop its task and stand; return when it has accepted that.

        Called at once, concurrently with other calls, for each robot separately. Called again it does the
        same.

        :raises CommandRefusedError: when the robot's side does not answer, or refuses.
        """

    def stop_unannounced(self) -> None:
        """Stop the robots that it has met and not announced: an emergency stop came for all of the link."""
        return

    def playback(self, change: Playback) -> PlaybackReport:
        """Change the playback of a recording, and return its state.

        :raises CommandRefusedError: when there is none, or the change is impossible.
        """
        raise CommandRefusedError(f"a link of kind {self.kind} plays no recording")

    def admitted(self, robot: str) -> None:
        """Handle the admission of ``robot`` by the gateway: report its position, if known."""
        return

    def refused(self, robot: str, reason: str) -> None:
        """Handle the refusal of ``robot`` by the gateway; the request is repeated automatically."""
        return
