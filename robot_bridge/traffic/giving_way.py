"""Giving way: where and how long a robot waits so that others, who go on as they are, pass first.

Prioritised planning (Erdmann and Lozano-Pérez, 1987): who comes first is planned first and then fixed, and
who comes after is planned around it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .conflicts import Surroundings
from .movement import Movement

LONGEST_WAIT = 900.0
"""seconds."""
_BACK = 2.0
"""Metres between the places on its way at which a robot might wait."""
_PLACES = 12
"""How many of them are tried at most, further apart on a long way."""
_STEP = 0.5
"""Seconds by which a wait is made longer at least, as long as it is too short."""
_HALVINGS = 5
"""How often the last step is halved to find the shortest wait."""


@dataclass(frozen=True)
class Wait:
    """``movement`` waits ``seconds`` at ``station`` metres along its way and meets nobody."""

    movement: Movement
    station: float
    seconds: float


def give_way(
    movement: Movement,
    others: Sequence[Movement],
    margin: float,
    now: float,
    longest: float = LONGEST_WAIT,
) -> Wait | None:
    """Return the wait that lets ``movement`` pass ``others`` as early as can be; None where none does.

    The robot drives as near to the conflict as it can wait there without being in anyone's way. Nothing has
    to be waited for where there is no conflict.
    """
    around = Surroundings(others, margin, now)
    found = around.conflicts(movement)
    if not found:
        return Wait(movement, 0.0, 0.0)
    first = min(found, key=lambda one: one.begins)
    met = first.stations[0] if first.robot == movement.robot else first.stations[1]
    best: Wait | None = None
    for station in _places(met):
        wait = _wait_at(movement, station, around, longest)
        if wait is not None and (best is None or wait.movement.ends < best.movement.ends - 1.0):
            best = wait
    return best


def _places(met: float) -> list[float]:
    count = min(math.ceil(met / _BACK), _PLACES)
    places = [met - (k + 1) * met / count for k in range(count)] if count else []
    return [*(place for place in places if place > 1e-6), 0.0]


def _wait_at(movement: Movement, station: float, around: Surroundings, longest: float) -> Wait | None:
    """Return the wait at ``station`` metres, as short as can be within a tenth of a second or so."""
    short, seconds = 0.0, 0.0
    arrives = movement.time_at(station)
    # Once everybody stands nothing changes any more.
    longest = min(longest, around.ends - arrives + 2 * _STEP)
    while True:
        found = around.conflicts(movement.waiting(station, seconds))
        if not found:
            break
        if any(math.isinf(one.ends) or one.begins < arrives + seconds for one in found):
            # Nobody moves out of the way by being waited for, and here the robot is itself in the way.
            return None
        short = seconds
        seconds += max(max(one.ends - one.begins for one in found) / 2, _STEP)
        if seconds > longest:
            return None
    for _ in range(_HALVINGS):
        middle = (short + seconds) / 2
        if around.conflicts(movement.waiting(station, middle)):
            short = middle
        else:
            seconds = middle
    return Wait(movement.waiting(station, seconds), station, seconds)
