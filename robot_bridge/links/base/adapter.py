"""What an adapter is: one kind of robots, as its process drives it and is driven by it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from ...messages import Answer
from ...messages.service import Playback, PlaybackReport
from .errors import CommandRefusedError
from .link import Link


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
