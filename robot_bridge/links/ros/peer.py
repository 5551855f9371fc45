"""What the way to a robot does for it, however that is made: over DDS, or over rosbridge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from ...messages import SendGPS, SendPos, SetPosEnd, SetPosIni
from .effects import Abilities, CancelGoals, Effect, PublishTask, SendGoal
from .geometry import Pose
from .tasks import Tasks

Network = TypeVar("Network", contravariant=True)
"""Who is there on the network, as that way to the robot knows it."""


class Hearing(Protocol[Network]):
    """Hears a robot's topics."""

    def connect(self, network: Network) -> None:
        """Read what is offered under the robot's names now."""

    def poll(self) -> SendPos | SendGPS | None:
        """Take in what has come; return the robot's newest position, None where none came."""


class Acting(Protocol[Network]):
    """Speaks to a robot. ``server`` is who has its tasks, None where nobody does."""

    server: bytes | None
    feedback: str | None

    @property
    def abilities(self) -> Abilities:
        """Who of the robot's side hears this program at the moment."""

    def connect(self, network: Network) -> None:
        """Meet the servers and listeners that are there now."""

    def hears(self, setting: str) -> bool:
        """Tell whether somebody listens to the topic of a setting."""

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        """Take in what servers have said; return the effects."""

    def send_goal(self, asked: SendGoal, here: Pose | None) -> None:
        """Send a goal; ``here`` is where the robot is. Raises ValueError where it has no place there."""

    def ask_result(self, asked: SendGoal) -> None:
        """Ask for the result of a goal that was taken on."""

    def cancel(self, asked: CancelGoals) -> None:
        """Cancel goals."""

    def call(self, setting: str) -> None:
        """Call a service of type Trigger."""

    def publish_task(self, asked: PublishTask, here: Pose | None) -> None:
        """Publish a target or a path; raises ValueError where it has no place there."""

    def publish_target(self, target: SetPosEnd, here: Pose | None) -> None:
        """Publish a target."""

    def publish_zero(self) -> None:
        """Publish speed 0, with or without a time as its listeners want it."""

    def publish_start(self, start: SetPosIni, here: Pose | None) -> None:
        """Publish where the robot is to take itself to be."""

    def publish_latched(self, setting: str, message: bytes) -> None:
        """Publish what is encoded on a topic of LATCHED: who comes later is told it, too."""

    def serve_map(self, grid: bytes) -> None:
        """Answer with a map that is encoded who asks for it by the service ``get_map``."""
