"""The map of the whole site, sent to a robot because an operator asks for it."""

from __future__ import annotations

from .errors import RefusedError
from .fleet import Fleet
from .messages import RobotState, SendMap


async def send_map(fleet: Fleet, request: SendMap) -> None:
    """Return when the map for the robot is stored; it replaces one that still waits for it.

    :raises RefusedError: for a robot that is not known, or is not there.
    """
    fleet.robots.check_known(request.robot)
    if fleet.robots.get(request.robot).state is RobotState.OFFLINE:
        raise RefusedError(
            f"robot {request.robot!r} is offline; it is sent the map by itself when it connects"
        )
    if not fleet.robots.get(request.robot).can("map"):
        raise RefusedError(f"robot {request.robot!r} takes no maps, as it said when it connected")
    await fleet.maps.send(request.robot)
