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

# --- What an adapter tells the gateway of its robots, and what it may know of the gateway's site ---


class Link(Protocol):
    """The way to the gateway, as an adapter has it: all methods are called in the adapter's loop.

    What is said of a robot while the gateway does not listen is left out where it would be old (positions),
    and kept where it counts (:meth:`stopped`, :meth:`give_up`, :meth:`ask`).
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
        """How large an image may be; a larger one would end the connection."""

    @property
    def is_connected(self) -> bool:
        """Whether the gateway listens."""

    @property
    def robots(self) -> list[str]:
        """The robots that it speaks for."""

    def add(self, robot: str, abilities: Sequence[Ability] = (), *, path_cones: bool = False) -> None:
        """Speak for ``robot`` from now on; without ``abilities`` it is seen and not commanded.

        Said again, with what it can do now, the gateway is told that.

        :raises MessageError: for a name that no robot can have.
        """

    def remove(self, robot: str) -> None:
        """Speak for ``robot`` no more: it becomes stale and lost, or is offline where it said Stopped."""

    def restarted(self, robot: str) -> None:
        """Note that the robot has started anew and forgotten its tasks: what is open is sent once more."""

    def adrift(self, robot: str) -> None:
        """Note that ``robot`` may do what nobody asked of it under this name: it is stopped first of all.

        Its open commands have failed then.
        """

    def position(self, robot: str, position: SendPos | SendGPS) -> None:
        """Tell where ``robot`` is; of several within a moment the last is told, and none that is old."""

    def alive(self, robot: str) -> None:
        """Tell that ``robot`` is there; at least every second while it says nothing else."""

    def stopped(self, robot: str) -> None:
        """Tell that ``robot`` stands and has nothing to do: kept until the gateway has acknowledged it."""

    def give_up(self, robot: str, command: int, reason: str) -> None:
        """Tell that ``robot`` gave up a command that it had taken on; ``reason`` is for operators."""

    async def ask(self, robot: str, request: Request) -> OpAck:
        """Say what is acknowledged, such as SetObject, SendImage or GetMap; return the acknowledgement.

        It is kept over reconnects until then. Give an observation a ``source``, so that it is stored once.

        :raises CommandRefusedError: when the gateway refuses it, with its reason.
        """

    async def areas(self, box: tuple[float, float, float, float]) -> SiteAreas:
        """Return the site's keepouts and roads that touch ``box``: x_min, y_min, x_max, y_max, site frame.

        Asked again on each new connection until the gateway has answered.

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
        """Tell how the link's own side is: ``ok`` false is an alarm for operators.

        ``reached`` where that is the matter with some of its robots, and none is out of reach.
        """


MOST_FAULTS = 3
"""that are told in words."""


def summary(faults: Sequence[str]) -> str | None:
    """Return what is the matter with robots, as one line for operators; None for nothing."""
    more = f" (and {len(faults) - MOST_FAULTS} more)" if len(faults) > MOST_FAULTS else ""
    return "; ".join(faults[:MOST_FAULTS]) + more or None


# --- What an adapter is: one kind of robots, as its process drives it and is driven by it ---


@dataclass(frozen=True)
class Command:
    """A message for ``robot``: SetPosEnd, SetPath, SetPosIni, SetMap or SetSurface, metres in the site frame.

    ``id`` tells it from every other message of the gateway's database, and stays the same however often the
    message is sent. ``again``: an earlier process began it, and died before it noted what came of it. Whoever
    makes the id of an order or a goal from ``id`` gives the robot's side the means to do it once.
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
    """seconds for which it may hold a command before the robot's side is asked."""

    @abstractmethod
    async def run(self, link: Link) -> None:
        """Connect to the robots' side and tell ``link`` what happens there, until cancelled.

        It is called once the gateway has told the site, so that ``link.frame`` is known. What it raises ends
        the process; raise LinkError for what a person has to put right.
        """

    @abstractmethod
    async def command(self, command: Command) -> None:
        """Have the robot take on ``command``; return when it has.

        Commands of one robot come one at a time, in order. When an Abort comes this is cancelled, and
        :meth:`stop` is called.

        :raises CommandRefusedError: when the robot will not do it.
        """

    @abstractmethod
    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Have the robot give up what it does and stand; return when it has taken that on.

        Called at once, whatever else goes on, and for each robot by itself. Called again it does the same.

        :raises CommandRefusedError: when the robot's side does not answer, or refuses.
        """

    def playback(self, change: Playback) -> PlaybackReport:
        """Play a recording otherwise from now on, and return how it is played.

        :raises CommandRefusedError: when there is none, or it cannot be played so.
        """
        raise CommandRefusedError(f"a link of kind {self.kind} plays no recording")

    def admitted(self, robot: str) -> None:
        """Note that the gateway has let ``robot`` in: tell where it is, if that is known."""
        return

    def refused(self, robot: str, reason: str) -> None:
        """Note that the gateway does not let ``robot`` in; it is asked again by itself."""
        return
