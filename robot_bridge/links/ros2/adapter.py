"""The adapter of ROS 2 robots: finds them on the network and leads each, in one loop."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from pathlib import Path
from typing import ClassVar

from ..base.adapter import Adapter
from ..base.errors import LinkError
from ..base.link import Link
from ..base.settings import LinkSettings, read_settings
from ..ros.adapter import RosAdapter
from ..ros.errors import RosError
from ..ros.geometry import Outgoing
from ..ros.grids import Grids
from ..ros.masks import Masks
from ..ros.notes import RobotNotes
from ..ros.robot import RosRobot
from ..ros.sensing import Sensing
from .acting import Acting
from .dds import Participant
from .interfaces import Interfaces
from .listening import Listening, Offers
from .names import topic_from_dds
from .services import by_topic
from .settings import Ros2Settings, check

EVERY = 0.02
"""seconds between two looks at what has come."""
MEET_EVERY = 0.2
"""seconds between two looks at who is there."""


class Ros2Adapter(RosAdapter[Offers]):
    """Robots of one DDS domain."""

    kind: ClassVar[str] = "ros2"

    def __init__(self, settings: Ros2Settings, state: Path) -> None:
        super().__init__(settings, RobotNotes(state))
        self._settings = settings

    async def run(self, link: Link) -> None:
        """Lead the robots of the network until cancelled."""
        settings = self._settings
        try:
            types = Interfaces(settings.distribution)
            participant = Participant(settings.dds)
        except RosError as error:
            raise LinkError(f"{link.settings.file}: ros2: {error}") from None
        outgoing = Outgoing(types, link.frame, settings.map_frame)
        grids = Grids(types.encode, outgoing, settings.map_resolution_m)
        masks = Masks(types.encode, outgoing, settings.map_resolution_m, link)

        def make(name: str) -> RosRobot[Offers]:
            sensing = Sensing(name, settings, link.frame)
            listening = Listening(sensing, participant, types)
            acting = Acting(name, settings, participant, types, outgoing, sensing)
            return RosRobot(name, settings, link, sensing, listening, acting, grids, masks)

        for name in settings.robots:
            self._meet(name, make)
        meet_at = 0.0
        changed = False
        while True:
            now = time.monotonic()
            changed |= participant.discover()
            if changed and now >= meet_at:
                meet_at, changed = now + MEET_EVERY, False
                offers: Offers = by_topic(participant.endpoints)
                offered = [topic_from_dds(topic) for topic, wants in offers if not wants]
                self._find([topic for topic in offered if topic is not None], offers, make)
            for robot in self._robots.values():
                self._lead(robot, partial(robot.step, now))
            self._report(link)
            await asyncio.sleep(max(0.001, EVERY - (time.monotonic() - now)))


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter that goes by them; raises LinkError."""
    settings, table = read_settings(file, "ros2", Ros2Settings)
    check(table, file)
    return settings, Ros2Adapter(table, settings.state_folder / f"{settings.name}.servers")
