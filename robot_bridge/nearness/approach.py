"""Who is near a robot, and who will be if both go on as they do; no I/O."""

from __future__ import annotations

from collections.abc import Container, Sequence
from typing import NamedTuple

import numpy as np

from ..traffic.conflicts import Surroundings
from ..traffic.movement import Movement

MARGIN_M = 1.0
"""Metres beyond the limit at which who was near is so no more: phones are off by metres."""
Pair = tuple[str, str]
"""Who is seen, and the robot."""


class Meeting(NamedTuple):
    """Two that are near, or will be in ``seconds``, with ``metres`` between them then, about ``place``."""

    seen: str
    robot: str
    metres: float
    seconds: float
    place: tuple[float, float]

    @property
    def pair(self) -> Pair:
        """Both names."""
        return self.seen, self.robot


class Limits(NamedTuple):
    """Metres between the middles of two that are near, and seconds for which is looked ahead."""

    metres: float
    within_s: float


class Mover(NamedTuple):
    """Somebody at ``place``, metres, with ``velocity``, m/s, both in the site frame."""

    name: str
    place: tuple[float, float]
    velocity: tuple[float, float]

    def straight_on(self, now: float, seconds: float) -> Movement:
        """Return the movement of who goes on for ``seconds`` as now, and stands then."""
        begin = np.array(self.place, dtype=np.float64)
        points = np.stack([begin, begin + np.array(self.velocity, dtype=np.float64) * seconds])
        return Movement(self.name, points, np.array([now, now + seconds]), 0.0)


def meetings(
    people: Sequence[Movement],
    robots: Sequence[Movement],
    limits: Limits,
    now: float,
    near: Container[Pair] = (),
) -> list[Meeting]:
    """Return who is near which robot now, and who will be soon, the soonest first.

    All radii are 0. Those in ``near`` were near before, and are so up to a margin beyond the limit.
    """
    if not people or not robots:
        return []
    found = {one.pair: one for one in _near_now(people, robots, limits.metres, now, near)}
    surroundings = Surroundings(robots, limits.metres, now)
    for person in people:
        for conflict in surroundings.conflicts(person):
            robot = conflict.other if conflict.robot == person.robot else conflict.robot
            seconds = conflict.begins - now
            if seconds <= limits.within_s and (person.robot, robot) not in found:
                x, y = person.at([conflict.begins])[0].tolist()
                meeting = Meeting(person.robot, robot, limits.metres, seconds, (x, y))
                found[meeting.pair] = meeting
    return sorted(found.values(), key=lambda one: (one.seconds, one.metres, one.pair))


def _near_now(
    people: Sequence[Movement],
    robots: Sequence[Movement],
    metres: float,
    now: float,
    near: Container[Pair],
) -> list[Meeting]:
    here, there = (np.concatenate([one.at([now]) for one in some]) for some in (people, robots))
    apart = np.hypot(*(here[:, None, :] - there[None, :, :]).T).T
    found = []
    for i, j in np.argwhere(apart <= metres + MARGIN_M).tolist():
        pair, distance = (people[i].robot, robots[j].robot), float(apart[i, j])
        if distance <= metres or pair in near:
            x, y = here[i].tolist()
            found.append(Meeting(*pair, distance, 0.0, (x, y)))
    return found
