"""Table ``[ros2]`` of a link's settings: the DDS network beside the robots."""

from __future__ import annotations

from pathlib import Path

from ..base.errors import LinkError
from ..ros.errors import RosError
from ..ros.settings import RobotSettings, check_robots
from .dds import DdsSettings, Range


class Ros2Settings(RobotSettings, frozen=True, forbid_unknown_fields=True):
    """Table ``[ros2]``."""

    domain: int = 0
    range: Range = "subnet"
    interfaces: tuple[str, ...] = ()
    peers: tuple[str, ...] = ()

    @property
    def dds(self) -> DdsSettings:
        """The DDS domain."""
        return DdsSettings(self.domain, self.range, self.interfaces, self.peers)


def check(settings: Ros2Settings, file: Path) -> None:
    """Raise LinkError, naming file and key, for what the types alone do not refuse."""
    check_robots(settings, "ros2", file)
    try:
        _ = settings.dds
    except RosError as error:
        raise LinkError(f"{file}: ros2.{error}") from None
