"""Kinds of alarms with their thresholds, rules on columns, texts and hysteresis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from qgis.core import QgsSettings

from ....robot_bridge.core.geometry import Ints, close_pairs
from ....robot_bridge.core.messages.safety import RobotState
from ...gateway_client.robot_states import STATES
from ...ui.language import tr


class AlarmKind(str, Enum):
    """The subject of an alarm, most urgent first: the value it is stored under, and ``words`` for it.

    One that ``is_urgent`` needs attention at once.
    """

    LOST = "lost", tr("lost")
    UNSURE = "unsure of its place", tr("unsure of its place")
    IN_KEEPOUT = "in a keepout", tr("in a keepout")
    AT_OBSTACLE = "at an obstacle", tr("at an obstacle")
    NEAR_ROBOT = "near a robot", tr("near a robot")
    COMES_NEAR = "will come near a robot", tr("will come near a robot")
    TOO_CLOSE = "too close", tr("too close")
    WILL_PASS = "will pass too near", tr("will pass too near")  # nosec B105 # no password
    OUTSIDE_SITE = "outside the site", tr("outside the site")
    OFF_ROAD = "off the road", tr("off the road"), False
    STOPPED = "stopped unasked", tr("stopped unasked"), False
    LOW_BATTERY = "low battery", tr("low battery"), False

    words: str
    is_urgent: bool

    def __new__(cls, value: str, words: str, is_urgent: bool = True) -> AlarmKind:
        kind = str.__new__(cls, value)
        kind._value_, kind.words, kind.is_urgent = value, words, is_urgent
        return kind


@dataclass(frozen=True)
class Threshold:
    """One setting: the alarm that it belongs to, its range, and its display."""

    kind: AlarmKind
    least: float
    most: float
    label: str
    unit: str
    scale: float = 1.0
    decimals: int = 1


def _threshold(default: float, *of: Any) -> Any:
    """Return a field of :class:`Thresholds` with a :class:`Threshold` as metadata."""
    return field(default=default, metadata={Threshold: Threshold(*of)})


@dataclass(frozen=True)
class Thresholds:
    """The operator's settings. Each alarm begins beyond one value and ends only well within another.

    ``low_battery`` and ``battery_margin`` are parts of a full one: an alarm ends at the sum of both.
    ``too_close`` is in metres between the places of two robots; an alarm ends ``close_margin`` further
    apart. ``unsure`` is the standard deviation of a position in metres from which an alarm begins; it ends
    ``unsure_margin`` below. ``outside_margin`` and ``road_margin`` are metres beyond the site's bounds or
    beside the road from which an alarm begins; it ends on the site or road. ``stopped_after`` is seconds for
    which a robot with a task stands; ``pass_within`` is seconds before two robots pass one another too near.
    ``kinds`` are the alarms that are evaluated.
    """

    low_battery: float = _threshold(0.20, AlarmKind.LOW_BATTERY, 0.0, 1.0, tr("begins below"), " %", 100.0, 0)
    battery_margin: float = _threshold(
        0.05, AlarmKind.LOW_BATTERY, 0.0, 0.5, tr("ends so much above that"), " %", 100.0, 0
    )
    too_close: float = _threshold(
        1.0, AlarmKind.TOO_CLOSE, 0.0, 1000.0, tr("begins when two are nearer than"), " m"
    )
    close_margin: float = _threshold(
        0.3, AlarmKind.TOO_CLOSE, 0.0, 1000.0, tr("ends so much further apart"), " m"
    )
    unsure: float = _threshold(2.0, AlarmKind.UNSURE, 0.1, 1000.0, tr("begins when less exact than"), " m")
    unsure_margin: float = _threshold(0.5, AlarmKind.UNSURE, 0.0, 1000.0, tr("ends so much below that"), " m")
    outside_margin: float = _threshold(
        0.5, AlarmKind.OUTSIDE_SITE, 0.0, 1000.0, tr("begins so far outside"), " m"
    )
    road_margin: float = _threshold(
        0.5, AlarmKind.OFF_ROAD, 0.0, 100.0, tr("begins so far beside the road"), " m"
    )
    stopped_after: float = _threshold(
        10.0, AlarmKind.STOPPED, 1.0, 3600.0, tr("begins after standing with a task for"), " s", 1.0, 0
    )
    pass_within: float = _threshold(
        30.0, AlarmKind.WILL_PASS, 1.0, 3600.0, tr("begins so long before"), " s", 1.0, 0
    )
    kinds: frozenset[AlarmKind] = frozenset(AlarmKind)

    def __post_init__(self) -> None:
        for name, of in THRESHOLDS.items():
            value = getattr(self, name)
            if not of.least <= value <= of.most:
                raise ValueError(f"{name} is {value:g}; give {of.least:g} to {of.most:g}")


THRESHOLDS: dict[str, Threshold] = {
    one.name: one.metadata[Threshold] for one in fields(Thresholds) if Threshold in one.metadata
}


GROUP = "fleet_supervisor/alarms"


def read_thresholds() -> Thresholds:
    """Return the operator's settings; an invalid value, or one out of its range, counts as not set."""
    settings = QgsSettings()
    numbers = {name: _number(settings.value(f"{GROUP}/{name}"), name) for name in THRESHOLDS}
    off = str(settings.value(f"{GROUP}/off") or "").split(",")
    return Thresholds(
        **{name: value for name, value in numbers.items() if value is not None},
        kinds=frozenset(kind for kind in AlarmKind if kind.value not in off),
    )


def write_thresholds(limits: Thresholds) -> None:
    """Store the settings."""
    settings = QgsSettings()
    for name in THRESHOLDS:
        settings.setValue(f"{GROUP}/{name}", getattr(limits, name))
    off = [kind.value for kind in AlarmKind if kind not in limits.kinds]
    settings.setValue(f"{GROUP}/off", ",".join(off))


def _number(value: object, name: str) -> float | None:
    try:
        number = float(str(value))
    except ValueError:
        return None
    of = THRESHOLDS[name]
    return number if of.least <= number <= of.most else None


Key = tuple[AlarmKind, str, str]
"""Kind, robot, and the other robot or the area if any."""


class Alarm(NamedTuple):
    """An alarm that holds since ``began``, or held until ``ended``; times are seconds since 1970.

    It stays until it is over and acknowledged. ``times`` counts how often it began since it was
    last acknowledged. ``area`` is the keepout or obstacle that it is about, ``unsure`` those of its robots
    that may be elsewhere. ``xy`` is the robot's position when it began, metres in the site frame.
    """

    kind: AlarmKind
    robot: str
    text: str
    began: float
    other: str = ""
    xy: tuple[float, float] | None = None
    ended: float | None = None
    acknowledged: float | None = None
    by: str = ""
    times: int = 1
    area: str = ""
    unsure: tuple[str, ...] = ()

    @property
    def key(self) -> Key:
        """The key by which it is recognised as the same alarm when it returns."""
        return self.kind, self.robot, self.other or self.area

    @property
    def is_new(self) -> bool:
        """Whether it is not acknowledged."""
        return self.acknowledged is None


class AlarmChange(str, Enum):
    """A change of an alarm."""

    BEGAN = "began"
    ENDED = "ended"
    ACKNOWLEDGED = "acknowledged"


@dataclass(frozen=True)
class AlarmEvent:
    """A line of the log: at ``at`` an alarm changed; ``by`` is the operator who acknowledged it."""

    at: float
    change: AlarmChange
    alarm: Alarm
    by: str = ""


# --- When an alarm begins and ends: rules on columns, one row for each robot
# Each rule returns two arrays: where it certainly holds, and where it is certainly over. Between the
# two nothing changes, so that a value that fluctuates about its threshold makes one alarm and not hundreds.

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Verdict = tuple[Bools, Bools]
"""(n,) true: begins; (n,) true: ends."""

FRESH = STATES.index(RobotState.FRESH)
LOST = STATES.index(RobotState.LOST)
OFFLINE = STATES.index(RobotState.OFFLINE)
STANDS = 0.05
"""Speed in m/s below which a robot stands."""
DRIVES = 0.2
"""Speed in m/s above which it drives."""


@dataclass(frozen=True)
class AlarmSnapshot:
    """All robots at one moment, n rows that keep their places.

    ``xy`` (n, 2) metres in the site frame, ``v`` (n,) metres per second, ``battery`` (n,) fraction of a full
    one, ``accuracy`` (n,) metres, each NaN where not known; ``state`` (n,) index into :data:`STATES`;
    ``stopped`` (n,) whether it reported that it stops; ``driving`` (n,) whether it accepted a task that is
    not finished and not paused; ``only_seen`` (n,) whether it accepts no commands, like phones; ``doubted``
    (n,) whether it may not be where ``xy`` is, for which ``doubts`` has the reasons by row; ``off_road`` (n,)
    whether it is further than the margin from every road surface, and ``on_road`` whether it is on one, both
    None where no surfaces are known. ``bounds`` is x_min, y_min, x_max, y_max.
    """

    names: list[str]
    xy: Floats
    v: Floats
    battery: Floats
    accuracy: Floats
    state: npt.NDArray[np.intp]
    stopped: Bools
    driving: Bools
    only_seen: Bools
    bounds: tuple[float, float, float, float]
    doubted: Bools
    doubts: dict[int, str]
    off_road: Bools | None = None
    on_road: Bools | None = None


def lost(now: AlarmSnapshot, limits: Thresholds) -> Verdict:
    """A robot has fallen silent; over when it is heard again or went offline in good order."""
    return now.state == LOST, (now.state == FRESH) | (now.state == OFFLINE)


def unsure(now: AlarmSnapshot, limits: Thresholds) -> Verdict:
    """A robot may not be where it is shown, or reports that it has lost its position; over when neither
    holds, or it reports no accuracy any more, or is offline.

    A margin as large as the limit would never end: then half the limit is used.
    """
    surely = max(limits.unsure - limits.unsure_margin, limits.unsure / 2)
    fresh = now.state == FRESH
    known = ((now.accuracy < surely) | np.isnan(now.accuracy)) & ~now.doubted
    begins = (now.accuracy >= limits.unsure) | now.doubted
    return fresh & begins, (fresh & known) | (now.state == OFFLINE)


def low_battery(now: AlarmSnapshot, limits: Thresholds) -> Verdict:
    """A battery is low; over when it has clearly been charged."""
    charged = min(1.0, limits.low_battery + limits.battery_margin)
    return now.battery < limits.low_battery, now.battery >= charged


def stopped(now: AlarmSnapshot, limits: Thresholds) -> Verdict:
    """A robot stands although it accepted a task; over when it drives, or has no task any more."""
    stands = now.stopped | (now.v < STANDS)
    return now.driving & (now.state == FRESH) & stands, ~now.driving | (~now.stopped & (now.v > DRIVES))


def outside_site(now: AlarmSnapshot, limits: Thresholds) -> Verdict:
    """A robot has left the site's bounds; over when it is inside them."""
    x_min, y_min, x_max, y_max = now.bounds
    x, y = now.xy.T
    # Negative inside, positive outside; a robot without a position is neither.
    beyond = np.maximum.reduce([x_min - x, x - x_max, y_min - y, y - y_max])
    return beyond > limits.outside_margin, beyond <= 0.0


def off_road(now: AlarmSnapshot, limits: Thresholds) -> Verdict:
    """A robot has left every road surface; over when it is on one."""
    if now.off_road is None or now.on_road is None:
        nobody = np.zeros(len(now.names), dtype=bool)
        return nobody, ~nobody
    return now.off_road, now.on_road


RULES: dict[AlarmKind, Callable[[AlarmSnapshot, Thresholds], Verdict]] = {
    AlarmKind.LOST: lost,
    AlarmKind.UNSURE: unsure,
    AlarmKind.LOW_BATTERY: low_battery,
    AlarmKind.STOPPED: stopped,
    AlarmKind.OUTSIDE_SITE: outside_site,
    AlarmKind.OFF_ROAD: off_road,
}
"""The rules for single robots; :func:`too_close` is for pairs."""


def too_close(now: AlarmSnapshot, limits: Thresholds) -> tuple[Ints, Ints, Floats]:
    """Return pairs i < j of robots that are near each other, and their distances.

    These are all pairs nearer than the distance that ends an alarm; two that are both offline are parked,
    not near. Nearness to robots that accept no commands is reported by the gateway.
    """
    placed = np.flatnonzero(np.isfinite(now.xy).all(axis=1) & ~now.only_seen)
    one, other, apart = close_pairs(now.xy[placed], limits.too_close + limits.close_margin)
    one, other = placed[one], placed[other]
    counts = (now.state[one] != OFFLINE) | (now.state[other] != OFFLINE)
    return one[counts], other[counts], apart[counts]


def alarm_text(kind: AlarmKind, now: AlarmSnapshot, row: int, other: int | None = None) -> str:
    """Return the text of an alarm of the robot in ``row``, or of two."""
    name = now.names[row]
    x, y = now.xy[row].tolist()
    where = tr(" at {x:.1f}, {y:.1f} m", x=x, y=y) if np.isfinite(x) and np.isfinite(y) else ""
    if kind is AlarmKind.TOO_CLOSE and other is not None:
        apart = float(np.hypot(*(now.xy[row] - now.xy[other])))
        return tr(
            "{robot} and {other} are {apart:.1f} m apart{where}",
            robot=name,
            other=now.names[other],
            apart=apart,
            where=where,
        )
    if kind is AlarmKind.LOST:
        last = tr("; last{where}", where=where) if where else ""
        return tr("{robot} is lost: nothing is heard of it{last}", robot=name, last=last)
    if kind is AlarmKind.UNSURE:
        if now.doubted[row]:
            why = now.doubts.get(row, "")
            return tr("{robot} may not be where it is shown: {why}", robot=name, why=why)
        accuracy = now.accuracy[row]
        return tr(
            "{robot} does not know its place: ± {accuracy:.1f} m{where}",
            robot=name,
            accuracy=accuracy,
            where=where,
        )
    if kind is AlarmKind.LOW_BATTERY:
        return tr("{robot} has {part:.0%} of its battery left", robot=name, part=now.battery[row])
    if kind is AlarmKind.STOPPED:
        return tr("{robot} has a task and stands{where}", robot=name, where=where)
    if kind is AlarmKind.OUTSIDE_SITE:
        return tr("{robot} is outside the site{where}", robot=name, where=where)
    return tr("{robot} is off the road{where}", robot=name, where=where)


PAIR_SHIFT = np.int64(32)
MOST_AT_ONCE = 200
"""Changes per evaluation; others follow with the next: a fleet that is lost must not block the window."""


class RowHysteresis:
    """One rule for all robots: on where it has held for a while, off where it has been over for a while."""

    def __init__(self) -> None:
        self.on = np.zeros(0, dtype=bool)
        self._holds_since = np.full(0, np.inf)
        self._over_since = np.full(0, np.inf)

    def update(
        self, holds: Bools, over: Bools, now: float, on_after: float, off_after: float
    ) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Apply where the rule holds and is over, (n,), at time ``now``; return rows switched on, and off."""
        self._grow(len(holds))
        self._holds_since = np.where(holds, np.minimum(self._holds_since, now), np.inf)
        self._over_since = np.where(over, np.minimum(self._over_since, now), np.inf)
        rises = np.flatnonzero(~self.on & (now - self._holds_since >= on_after))[:MOST_AT_ONCE]
        falls = np.flatnonzero(self.on & ~holds & (now - self._over_since >= off_after))[:MOST_AT_ONCE]
        self.on[rises], self.on[falls] = True, False
        return rises, falls

    def drop(self, rows: Ints) -> None:
        """Forget robots that no longer exist; those below them move up."""
        rows = rows[rows < len(self.on)]
        self.on = np.delete(self.on, rows)
        self._holds_since = np.delete(self._holds_since, rows)
        self._over_since = np.delete(self._over_since, rows)

    def _grow(self, count: int) -> None:
        more = count - len(self.on)
        if more > 0:
            self.on = np.concatenate([self.on, np.zeros(more, dtype=bool)])
            self._holds_since = np.concatenate([self._holds_since, np.full(more, np.inf)])
            self._over_since = np.concatenate([self._over_since, np.full(more, np.inf)])


class PairHysteresis:
    """Pairs of robots: on when nearer than one distance, off when further apart than another."""

    def __init__(self) -> None:
        self._on = np.empty(0, np.int64)

    def update(
        self, one: Ints, other: Ints, apart: Floats, distance: float
    ) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
        """Apply all pairs that are not yet far enough apart; return the pairs switched on, and off."""
        key = (one << PAIR_SHIFT) + other
        begins = key[apart < distance]
        on = np.union1d(np.intersect1d(self._on, key), begins)
        rises = np.setdiff1d(on, self._on)[:MOST_AT_ONCE]
        falls = np.setdiff1d(self._on, on)[:MOST_AT_ONCE]
        self._on = np.setdiff1d(np.union1d(self._on, rises), falls)
        return _pairs(rises), _pairs(falls)

    def drop(self, rows: Ints) -> None:
        """Forget the pairs of robots that no longer exist; those below them move up."""
        pairs = np.array(_pairs(self._on), dtype=np.int64).reshape(-1, 2)
        pairs = pairs[~np.isin(pairs, rows).any(axis=1)]
        pairs -= np.searchsorted(np.sort(rows), pairs)
        self._on = np.sort((pairs[:, 0] << PAIR_SHIFT) + pairs[:, 1])


def _pairs(keys: Ints) -> list[tuple[int, int]]:
    low = (np.int64(1) << PAIR_SHIFT) - 1
    return list(zip((keys >> PAIR_SHIFT).tolist(), (keys & low).tolist(), strict=True))
