"""What the simulated robot comes across: things at known places that it sees when it is near them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..messages import Observed, SendImage, SetObject
from .body import Pose

SIGHT = 10.0
"""metres within which the robot sees a thing."""


@dataclass(frozen=True)
class Thing:
    """Something at (x, y), metres in the site frame, that the robot knows as ``id``."""

    x: float
    y: float
    id: str


class Sightings:
    """Says each thing once, as an object and, where there is an ``image``, as an image of it."""

    def __init__(self, things: Sequence[Thing], image: bytes | None, say: Callable[[Observed], None]) -> None:
        self._unseen = list(things)
        self._image = image
        self._say = say
        self._count = 0

    def look(self, pose: Pose) -> None:
        """Say what is seen from ``pose``."""
        for thing in [thing for thing in self._unseen if _sees(pose, thing)]:
            self._unseen.remove(thing)
            self._say(SetObject(thing.x, thing.y, thing.id, source=self._source()))
            if self._image is not None:
                x, y, _ = pose
                self._say(SendImage(self._image, round(x, 3), round(y, 3), thing.id, source=self._source()))

    def _source(self) -> str:
        self._count += 1
        return str(self._count)


def _sees(pose: Pose, thing: Thing) -> bool:
    return math.hypot(thing.x - pose[0], thing.y - pose[1]) <= SIGHT
