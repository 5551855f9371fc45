"""Conflicts: when and where two robots come nearer to one another than their sizes and a margin allow.

Exact for robots that drive their ways as planned: between two points of time both drive straight at one
speed, so that the distance between them squared is a parabola.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .movement import Floats, Movement
from .nearness import Windows, near_pairs

HEAD_ON, CROSSING, FOLLOWING, STANDING = "head-on", "crossing", "following", "standing"

_ALIKE = math.cos(math.radians(45.0))
"""Directions nearer to one another than this are alike, or opposite."""
_ROOM = 1e-6
"""Metres by which a distance may be short without being too short: robots may touch their margin."""


@dataclass(frozen=True)
class Conflict:
    """``robot`` and ``other`` are too near to one another from ``begins`` to ``ends`` (inf: for good), s.

    They are nearest at ``nearest_at`` with ``metres`` between their middles, about ``place``. ``stations``
    are the metres that each has driven at ``begins``. ``kind`` says how they meet; in one that is STANDING
    ``other`` does not move.
    """

    robot: str
    other: str
    kind: str
    begins: float
    ends: float
    nearest_at: float
    metres: float
    place: tuple[float, float]
    stations: tuple[float, float]


def find_conflicts(movements: Sequence[Movement], margin: float, now: float) -> list[Conflict]:
    """Return every conflict from ``now`` on, soonest first; ``margin`` is metres between two robots.

    Two robots that stand are none, however near they are.
    """
    found: list[Conflict] = []
    for near in near_pairs(movements, margin, now):
        pair = movements[near.one], movements[near.two]
        found += _conflicts_between(*pair, margin, now, near.begins, near.ends)
    return sorted(found, key=lambda one: (one.begins, one.robot, one.other))


def conflicts_with(
    movement: Movement, others: Iterable[Movement], margin: float, now: float
) -> list[Conflict]:
    """Return the conflicts of one movement with ``others``, soonest first."""
    return Surroundings(list(others), margin, now).conflicts(movement)


def conflicts_of(one: Movement, two: Movement, margin: float, now: float) -> list[Conflict]:
    """Return the conflicts of two movements from ``now`` on, soonest first."""
    return _conflicts_between(one, two, margin, now, now, math.inf)


class Surroundings:
    """The movements of ``others``, that one movement after the other is held against from ``now`` on."""

    def __init__(self, others: Sequence[Movement], margin: float, now: float) -> None:
        self._others = others
        self._margin, self._now = margin, now
        self._windows = Windows(others, now)
        boxes = [self._windows.boxes(other, other.radius + margin) for other in others]
        self._boxes: Floats = np.array(boxes) if boxes else np.empty((0, 1, 4))

    @property
    def ends(self) -> float:
        """When everybody has come to their end, -inf where nobody is around."""
        return max((other.ends for other in self._others), default=-math.inf)

    def conflicts(self, movement: Movement) -> list[Conflict]:
        """Return the conflicts of ``movement`` with the others, soonest first."""
        box, boxes = self._windows.boxes(movement, movement.radius), self._boxes
        meet = (boxes[:, :, :2] <= box[:, 2:]) & (boxes[:, :, 2:] >= box[:, :2])
        touch: NDArray[np.bool_] = np.all(meet, axis=2)
        found: list[Conflict] = []
        for number in np.flatnonzero(touch.any(axis=1)).tolist():
            windows = np.flatnonzero(touch[number])
            span = self._windows.span(int(windows[0]), int(windows[-1]))
            found += _conflicts_between(movement, self._others[number], self._margin, self._now, *span)
        return sorted(found, key=lambda one: one.begins)


def _conflicts_between(
    one: Movement, two: Movement, margin: float, now: float, begins: float, ends: float
) -> list[Conflict]:
    """Return the conflicts from ``now`` on; none of them reaches beyond ``begins`` and ``ends``."""
    if one.stands and two.stands:
        return []
    if one.stands:
        one, two = two, one
    limit = one.radius + two.radius + margin - _ROOM
    times = _times(one, two, now, begins, ends)
    apart = one.at(times) - two.at(times)
    spans = _spans(times, apart, limit)
    return [_conflict(one, two, *span) for span in _joined(spans)]


def _times(one: Movement, two: Movement, now: float, begins: float, ends: float) -> Floats:
    """Return the times, (n,) seconds, between which both drive straight, so that they cover the span."""
    low, high = now, math.inf
    parts = [np.array([now])]
    for movement in (one, two):
        part = movement.times_around(begins, ends)
        # Where one of them is not known of any more, what the other does says nothing.
        low = max(low, part[0]) if part[0] <= begins else low
        high = min(high, part[-1]) if part[-1] >= ends else high
        parts.append(part)
    times = np.unique(np.concatenate(parts))
    within: Floats = times[(times >= low) & (times <= high)]
    return within


def _spans(times: Floats, apart: Floats, limit: float) -> list[tuple[float, float]]:
    """Return when the way from one to the other, ``apart`` (n, 2) at ``times``, is shorter than ``limit``."""
    begin, step = apart[:-1], np.diff(apart, axis=0)
    a = (step * step).sum(axis=1)
    b = (begin * step).sum(axis=1)
    c = (begin * begin).sum(axis=1) - limit * limit
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b * b - a * c)
        low, high = (-b - root) / a, (-b + root) / a
    # Where the distance does not change it is too short all the time or never.
    still = a < 1e-18
    low = np.where(still, np.where(c < 0, 0.0, np.inf), np.nan_to_num(low, nan=np.inf))
    high = np.where(still, np.where(c < 0, 1.0, -np.inf), np.nan_to_num(high, nan=-np.inf))
    low, high = np.maximum(low, 0.0), np.minimum(high, 1.0)
    some = np.flatnonzero(high > low)
    seconds = np.diff(times)
    spans = [
        (float(times[k] + low[k] * seconds[k]), float(times[k] + high[k] * seconds[k])) for k in some.tolist()
    ]
    if len(apart) and math.hypot(*apart[-1]) < limit:
        spans.append((float(times[-1]), math.inf))
    return spans


def _joined(spans: list[tuple[float, float]]) -> list[tuple[float, float]]:
    joined: list[tuple[float, float]] = []
    for begins, ends in spans:
        if joined and begins <= joined[-1][1] + 1e-6:
            joined[-1] = joined[-1][0], max(ends, joined[-1][1])
        else:
            joined.append((begins, ends))
    return joined


def _conflict(one: Movement, two: Movement, begins: float, ends: float) -> Conflict:
    last = max(one.ends, two.ends, begins)
    inner = np.unique(np.concatenate([movement.times_around(begins, ends) for movement in (one, two)]))
    times = np.concatenate([[begins], inner[(inner > begins) & (inner < ends)], [min(ends, last)]])
    nearest_at = _nearest(times, one.at(times) - two.at(times))
    where = one.at([nearest_at])[0], two.at([nearest_at])[0]
    middle = (where[0] + where[1]) / 2
    return Conflict(
        one.robot,
        two.robot,
        _kind(one, two, begins, nearest_at),
        begins,
        ends,
        nearest_at,
        float(np.hypot(*(where[0] - where[1]))),
        (float(middle[0]), float(middle[1])),
        (one.station_at(begins), two.station_at(begins)),
    )


def _nearest(times: Floats, apart: Floats) -> float:
    """Return when the distance is least."""
    step = np.diff(apart, axis=0)
    square = np.maximum((step * step).sum(axis=1), 1e-18)
    share = np.clip(-(apart[:-1] * step).sum(axis=1) / square, 0.0, 1.0)
    least = np.hypot(*(apart[:-1] + share[:, None] * step).T)
    if not len(least):
        return float(times[0])
    k = int(np.argmin(least))
    return float(times[k] + share[k] * (times[k + 1] - times[k]))


def _kind(one: Movement, two: Movement, begins: float, nearest_at: float) -> str:
    headings = [_heading(movement, begins, nearest_at) for movement in (one, two)]
    if headings[1] is None:
        return STANDING
    if headings[0] is None:
        # It has come to its end, or not set out yet, and the other comes upon it.
        return CROSSING
    alike = float(headings[0] @ headings[1])
    return FOLLOWING if alike > _ALIKE else HEAD_ON if alike < -_ALIKE else CROSSING


def _heading(movement: Movement, begins: float, until: float) -> NDArray[np.float64] | None:
    """Return the unit vector of where it goes at ``begins``, or else goes before ``until``."""
    if movement.stands:
        return None
    for time in (begins, until):
        near = movement.at([time - 0.5, time + 0.5])
        step = near[1] - near[0]
        metres = float(np.hypot(*step))
        if metres > 1e-6:
            unit: NDArray[np.float64] = step / metres
            return unit
    return None
