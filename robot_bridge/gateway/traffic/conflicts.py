"""Conflicts: times and places where two robots come nearer than their sizes and a margin allow."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

# --- Movement of a robot in space and time ---

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Movement:
    """``robot`` is at ``points[k]``, (n, 2) metres in the site frame, at ``times[k]``, (n,) seconds.

    Before the first time it stands at the first point, after the last time at the last. Between two it drives
    at constant speed. ``times`` do not decrease. ``radius``, in metres, is that of a circle around the robot.
    """

    robot: str
    points: Floats
    times: Floats
    radius: float

    @cached_property
    def stands(self) -> bool:
        """Whether it does not move."""
        return not bool((np.abs(self.points - self.points[0]) > 1e-9).any())

    @property
    def ends(self) -> float:
        """Time at which it reaches its end."""
        return float(self.times[-1])

    def at(self, times: Any) -> Floats:
        """Return its positions at ``times``, (m,) seconds, as (m, 2)."""
        return np.column_stack([np.interp(times, self.times, self.points[:, k]) for k in (0, 1)])

    def times_around(self, begins: float, ends: float) -> Floats:
        """Return its times in a span, with the last before and the first after it, if any."""
        first = np.searchsorted(self.times, begins, side="right") - 1
        last = np.searchsorted(self.times, ends, side="left") + 1
        return self.times[max(first, 0) : last]

    def station_at(self, time: float) -> float:
        """Return the metres that it has driven at ``time``."""
        return float(np.interp(time, self.times, self._stations))

    def time_at(self, station: float) -> float:
        """Return the time at which it reaches ``station`` metres along its path."""
        return float(np.interp(station, self._stations, self.times))

    @cached_property
    def _stations(self) -> Floats:
        return _stations(self.points)

    def waiting(self, station: float, seconds: float) -> Movement:
        """Return the movement with a stop of ``seconds`` at ``station`` metres along its path."""
        along = self._stations
        station = float(np.clip(station, 0.0, along[-1]))
        at = float(np.interp(station, along, self.times))
        place = np.array([[np.interp(station, along, self.points[:, k]) for k in (0, 1)]])
        before, after = along < station - 1e-9, along > station + 1e-9
        return replace(
            self,
            points=np.concatenate([self.points[before], place, place, self.points[after]]),
            times=np.concatenate(
                [self.times[before], [at, at + seconds], self.times[after] + seconds],
            ),
        )


def standing_movement(robot: str, place: tuple[float, float], now: float, radius: float) -> Movement:
    """Return the movement of a standing robot."""
    return Movement(robot, np.array([place], dtype=np.float64), np.array([now]), radius)


def driving_movement(robot: str, points: Any, speed: float, begins: float, radius: float) -> Movement:
    """Return the movement along ``points``, (n, 2), at ``speed`` m/s from the second ``begins`` on."""
    line = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    return Movement(robot, line, begins + _stations(line) / speed, radius)


def _stations(points: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


# --- Selection of pairs that may come near at all: bounding boxes of each in consecutive time windows ---
# It saves the exact check of robots that pass the same places at other times, as nearly all do.

Ints = NDArray[np.int64]

_WINDOW = 5.0
"""seconds of a window: about as long as two robots take to pass one another."""
_MOST_WINDOWS = 256
"""Most windows: where some robots drive for hours, each window is longer."""
_SLACK = 1e-6
"""Metres added to boxes for rounding errors."""


class NearPair(NamedTuple):
    """Two movements, by index, that may be near one another only between two times."""

    one: int
    two: int
    begins: float
    ends: float


class TimeWindows:
    """Time from ``now`` on in windows, the last of them without an end."""

    def __init__(self, movements: Sequence[Movement], now: float) -> None:
        span = max((movement.ends for movement in movements), default=now) - now
        count = min(max(math.ceil(span / _WINDOW), 1), _MOST_WINDOWS)
        self._begins = now + max(span, 0.0) * np.arange(count) / count

    def boxes(self, movement: Movement, more: float) -> Floats:
        """Return the bounding box of the movement in each window as x_min, y_min, x_max, y_max, (n, 4), with
        ``more`` metres around it."""
        times, points = movement.times, movement.points
        at = movement.at(self._begins)
        low = np.minimum(at, np.concatenate([at[1:], points[-1:]]))
        high = np.maximum(at, np.concatenate([at[1:], points[-1:]]))
        # The points in between belong to the window in which they are reached.
        of = np.searchsorted(self._begins, times, side="right") - 1
        inner = of >= 0
        if inner.any():
            window, first = np.unique(of[inner], return_index=True)
            low[window] = np.minimum(low[window], np.minimum.reduceat(points[inner], first))
            high[window] = np.maximum(high[window], np.maximum.reduceat(points[inner], first))
        return np.hstack([low - more - _SLACK, high + more + _SLACK])

    def span(self, first: int, last: int) -> tuple[float, float]:
        """Return the begin of window ``first`` and the end of window ``last``."""
        ends = self._begins[last + 1] if last + 1 < len(self._begins) else math.inf
        return float(self._begins[first]), float(ends)


def near_pairs(movements: Sequence[Movement], margin: float, now: float) -> list[NearPair]:
    """Return the pairs that may come nearer than their radii and ``margin`` metres, ``one`` < ``two``."""
    if len(movements) < 2:
        return []
    windows = TimeWindows(movements, now)
    boxes = np.stack([windows.boxes(one, one.radius + margin / 2) for one in movements], axis=1)
    found = [(*_touching(at), window) for window, at in enumerate(boxes)]
    one, two = (np.concatenate([pairs[k] for pairs in found]) for k in (0, 1))
    window = np.repeat(np.arange(len(found)), [len(pairs[0]) for pairs in found])
    # The windows ascend, so that a pair's first window is its first entry, and its last the last.
    key = one * len(movements) + two
    _, first = np.unique(key, return_index=True)
    last = len(key) - 1 - np.unique(key[::-1], return_index=True)[1]
    columns = one[first], two[first], window[first], window[last]
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return [NearPair(a, b, *windows.span(begin, end)) for a, b, begin, end in rows]


def _touching(boxes: Floats) -> tuple[Ints, Ints]:
    """Return the pairs of ``boxes``, (n, 4), that touch, the lower number first."""
    order = np.argsort(boxes[:, 0], kind="stable")
    left = boxes[order, 0]
    # Boxes that begin, from the left, before this one ends, and not before it begins.
    count = np.searchsorted(left, boxes[order, 2], side="right") - np.arange(len(order)) - 1
    one = np.repeat(np.arange(len(order)), count)
    two = np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count) + one + 1
    one, two = order[one], order[two]
    touch = (boxes[one, 1] <= boxes[two, 3]) & (boxes[two, 1] <= boxes[one, 3])
    one, two = one[touch], two[touch]
    return np.minimum(one, two), np.maximum(one, two)


# --- Conflicts: times and places where two robots come nearer than their sizes and a margin allow
# Exact for robots that drive as planned: between two consecutive times both drive straight at constant speed,
# so that the squared distance between them is a parabola.

Span = tuple[float, float]
"""Begin and end of a conflict (inf: never), s."""
HEAD_ON, CROSSING, FOLLOWING, STANDING = "head-on", "crossing", "following", "standing"

_ALIKE = math.cos(math.radians(45.0))
"""Cosine beyond which two directions count as alike, or opposite."""
_ROOM = 1e-6
"""Tolerance in metres of a distance: robots may touch their margin."""


@dataclass(frozen=True)
class Conflict:
    """``robot`` and ``other`` are too near to one another from ``begins`` to ``ends`` (inf: for good), s.

    They are nearest at ``nearest_at`` with ``metres`` between their centres, about ``place``. ``stations``
    are the metres that each has driven at ``begins``. ``kind`` is how they meet; with STANDING ``other``
    does not move.
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
    """Return all conflicts from ``now`` on, soonest first; ``margin`` is metres between two robots.

    Two standing robots have none, however near they are.
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
    return OtherMovements(list(others), margin, now).conflicts(movement)


def conflicts_of(one: Movement, two: Movement, margin: float, now: float) -> list[Conflict]:
    """Return the conflicts of two movements from ``now`` on, soonest first."""
    return _conflicts_between(one, two, margin, now, now, math.inf)


class OtherMovements:
    """The movements of ``others``, with which single movements are compared from ``now`` on."""

    def __init__(self, others: Sequence[Movement], margin: float, now: float) -> None:
        self._others = others
        self._margin, self._now = margin, now
        self._windows = TimeWindows(others, now)
        boxes = [self._windows.boxes(other, other.radius + margin) for other in others]
        self._boxes: Floats = np.array(boxes) if boxes else np.empty((0, 1, 4))

    @property
    def ends(self) -> float:
        """Time at which all others have reached their ends, -inf without others."""
        return max((other.ends for other in self._others), default=-math.inf)

    def conflicts(self, movement: Movement) -> list[Conflict]:
        """Return the conflicts of ``movement`` with the others, soonest first."""
        found: list[Conflict] = []
        for other, begins, ends in self._near(movement):
            found += _conflicts_between(movement, other, self._margin, self._now, begins, ends)
        return sorted(found, key=lambda one: one.begins)

    def spans(self, movement: Movement) -> list[Span]:
        """Return only the times of the conflicts of ``movement`` with the others."""
        found: list[Span] = []
        for other, begins, ends in self._near(movement):
            found += _spans_between(movement, other, self._margin, self._now, begins, ends)
        return found

    def _near(self, movement: Movement) -> Iterator[tuple[Movement, float, float]]:
        """Yield the others that ``movement`` may come near to, each with the span of time."""
        box, boxes = self._windows.boxes(movement, movement.radius), self._boxes
        meet = (boxes[:, :, :2] <= box[:, 2:]) & (boxes[:, :, 2:] >= box[:, :2])
        touch: NDArray[np.bool_] = np.all(meet, axis=2)
        for number in np.flatnonzero(touch.any(axis=1)).tolist():
            windows = np.flatnonzero(touch[number])
            yield self._others[number], *self._windows.span(int(windows[0]), int(windows[-1]))


def _conflicts_between(
    one: Movement, two: Movement, margin: float, now: float, begins: float, ends: float
) -> list[Conflict]:
    """Return the conflicts from ``now`` on; none of them reaches beyond ``begins`` and ``ends``."""
    if one.stands:
        one, two = two, one
    return [_conflict(one, two, *span) for span in _spans_between(one, two, margin, now, begins, ends)]


def _spans_between(
    one: Movement, two: Movement, margin: float, now: float, begins: float, ends: float
) -> list[Span]:
    """Return the spans of the conflicts from ``now`` on, in order."""
    if one.stands and two.stands:
        return []
    limit = one.radius + two.radius + margin - _ROOM
    times = _times(one, two, now, begins, ends)
    return _joined(_spans(times, one.at(times) - two.at(times), limit))


def _times(one: Movement, two: Movement, now: float, begins: float, ends: float) -> Floats:
    """Return the times, (n,) seconds, that cover the span, with straight movements in between."""
    low, high = now, math.inf
    parts = [np.array([now])]
    for movement in (one, two):
        part = movement.times_around(begins, ends)
        # Outside the known times of one, the other's movement is irrelevant.
        low = max(low, part[0]) if part[0] <= begins else low
        high = min(high, part[-1]) if part[-1] >= ends else high
        parts.append(part)
    times = np.unique(np.concatenate(parts))
    within: Floats = times[(times >= low) & (times <= high)]
    return within


def _spans(times: Floats, apart: Floats, limit: float) -> list[Span]:
    """Return the spans in which the offset ``apart``, (n, 2) at ``times``, is shorter than ``limit``."""
    begin, step = apart[:-1], apart[1:] - apart[:-1]
    a = (step * step).sum(axis=1)
    b = (begin * step).sum(axis=1)
    c = (begin * begin).sum(axis=1) - limit * limit
    # A constant distance is too short all the time or never.
    still, square = a < 1e-18, b * b - a * c
    spans: list[Span] = []
    # There are rarely any, so these are computed one by one.
    for k in np.flatnonzero(np.where(still, c < 0, square > 0)).tolist():
        low, high = 0.0, 1.0
        if not still[k]:
            root = math.sqrt(square[k])
            low, high = max((-b[k] - root) / a[k], 0.0), min((-b[k] + root) / a[k], 1.0)
        if high > low:
            seconds = times[k + 1] - times[k]
            spans.append((float(times[k] + low * seconds), float(times[k] + high * seconds)))
    if len(apart) and math.hypot(*apart[-1]) < limit:
        spans.append((float(times[-1]), math.inf))
    return spans


def _joined(spans: list[Span]) -> list[Span]:
    joined: list[Span] = []
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
    """Return the time of the least distance."""
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
        # It has reached its end, or not started yet, and the other one approaches it.
        return CROSSING
    alike = float(headings[0] @ headings[1])
    return FOLLOWING if alike > _ALIKE else HEAD_ON if alike < -_ALIKE else CROSSING


def _heading(movement: Movement, begins: float, until: float) -> NDArray[np.float64] | None:
    """Return the unit vector of its direction at ``begins``, or else at ``until``."""
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
