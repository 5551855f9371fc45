"""What an adapter tells the gateway of its robots, and what it may know of the gateway's site."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from ...messages import Ability, OpAck, Request, SendGPS, SendPos, SiteReport
from ...messages.links import SiteAreas
from .frames import LinkFrame
from .settings import LinkSettings


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

    def report(self, *, ok: bool, text: str | None = None, counts: dict[str, float] | None = None) -> None:
        """Tell how the link's own side is: ``ok`` false is an alarm for operators."""
