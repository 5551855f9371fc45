"""One robot's images on their way to the gateway: seldom, one at a time, with the place of the robot."""

from __future__ import annotations

import asyncio
import hashlib
from typing import Any

from ...messages import MessageError, SendImage
from ...messages.bounds import LONGEST_LABEL, one_line
from ...sites.frame import SiteFrame
from ..base.errors import CommandRefusedError
from ..base.frames import WGS84, FrameSettings, LinkFrame
from ..base.link import Link
from .errors import FaultError
from .images import image_of
from .positions import stamp
from .sensing import Sensing
from .settings import RobotSettings


class Camera:
    """Has the robot's sensing wait for an image when one is due, and sends it as an observation."""

    def __init__(self, robot: str, settings: RobotSettings, link: Link, sensing: Sensing) -> None:
        self._robot = robot
        self._settings = settings
        self._link = link
        self._sensing = sensing
        self._due = 0.0
        self._sending: asyncio.Task[None] | None = None

    def step(self, now: float) -> None:
        """Send the image that has come; ``now`` is a steady clock's."""
        sensing, image = self._sensing, self._sensing.image
        sensing.image = None
        place = self._place()
        if image is not None and place is not None and sensing.wants_image:
            self._due = now + self._settings.image_every_s
            self._sending = asyncio.create_task(self._send(*image, place))
        is_free = self._sending is None or self._sending.done()
        sensing.wants_image = is_free and now >= self._due and place is not None

    def _place(self) -> tuple[float, float] | None:
        """Return where the robot is in the site frame, None while that is not known."""
        pose, fix = self._sensing.pose, self._sensing.fix
        if pose is not None:
            return pose.x, pose.y
        if fix is None:
            return None
        site = self._link.site
        frame = SiteFrame(site.crs, (site.origin[0], site.origin[1]), site.rotation)
        try:
            return LinkFrame(FrameSettings(crs=WGS84), frame).to_site(fix.lon, fix.lat)
        except ValueError:
            return None

    async def _send(self, topic: str, type_name: str, message: Any, place: tuple[float, float]) -> None:
        largest = min(self._settings.largest_image_bytes, self._link.largest_image_bytes)
        try:
            image = await asyncio.to_thread(image_of, type_name, message, largest)
            digest = hashlib.sha256(image).hexdigest()[:16]
            x, y = place
            seen = one_line(str(message.header.frame_id), LONGEST_LABEL) or "camera"
            told = SendImage(image, x, y, seen, t=stamp(message.header), source=f"{topic[-100:]} {digest}")
            await self._link.ask(self._robot, told)
        except (FaultError, MessageError, CommandRefusedError) as error:
            self._sensing.refuse(topic, error)
        else:
            self._sensing.faults.pop(topic, None)
