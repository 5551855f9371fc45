"""Cone plan: stops of each robot with places and times; JSON document and checks."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from itertools import pairwise
from typing import Any, TypeVar

from ..errors import PlanFileError, counted
from ..json_decoder import DOCUMENT, DecodingError, decode_json
from .job import COLLECT, PLACE, ConeTarget, PlanRobot, Store

# --- The plan: stops of each robot, with places, times and paths ---

STORE, HOME = "store", "home"
"""Kinds of stops beside :data:`PLACE` and :data:`COLLECT`: load and unload at a store, end at the start."""

Path = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class PlanStop:
    """A place where a robot stops; ``id`` is that of the cone, the store, or, at home, the robot.

    ``path`` leads there from the stop before, (x, y) in metres in the site frame, ``metres`` long on the
    ground. Arrival, begin of the work and its end are seconds from the plan's begin.
    ``aboard`` cones to place and ``collected`` ones are on the robot afterwards.
    """

    kind: str
    id: str
    x: float
    y: float
    theta: float
    metres: float
    arrival_s: float
    begin_s: float
    end_s: float
    loaded: int
    unloaded: int
    aboard: int
    collected: int
    path: Path

    @property
    def is_target(self) -> bool:
        """Whether a cone is placed or collected here."""
        return self.kind in (PLACE, COLLECT)


@dataclass(frozen=True)
class PlannedTrip:
    """Stops from a visit to a store until the next; the first trip may begin with cones aboard."""

    number: int
    stops: tuple[PlanStop, ...]

    @property
    def targets(self) -> tuple[str, ...]:
        """The ids of the cones."""
        return tuple(stop.id for stop in self.stops if stop.is_target)


@dataclass(frozen=True)
class RobotPlan:
    """The trips of ``robot`` from its present state; ``done`` are the earlier stops.

    A ``lost`` robot has no trips.
    """

    robot: PlanRobot
    trips: tuple[PlannedTrip, ...]
    done: tuple[PlanStop, ...] = ()
    lost: bool = False

    @property
    def stops(self) -> tuple[PlanStop, ...]:
        """The stops to come."""
        return tuple(stop for trip in self.trips for stop in trip.stops)

    @property
    def metres(self) -> float:
        """Metres to drive."""
        return sum(stop.metres for stop in self.stops)

    @property
    def end_s(self) -> float:
        """When the robot has finished."""
        stops = self.stops
        return stops[-1].end_s if stops else self.robot.ready_s


@dataclass(frozen=True)
class LeftOut:
    """A target that no robot serves, and why."""

    target: ConeTarget
    reason: str


@dataclass(frozen=True)
class ConePlan:
    """The plan of all robots. ``targets`` are those to come and those done.

    ``finish`` is where robots go at the end, ``method`` found the plan, ``travel`` says what its ways follow,
    and ``crs`` names the CRS of its coordinates, empty for the site frame.
    """

    robots: tuple[RobotPlan, ...]
    targets: tuple[ConeTarget, ...]
    stores: tuple[Store, ...]
    finish: str
    objective: str
    method: str
    travel: str
    left_out: tuple[LeftOut, ...] = ()
    crs: str = ""

    @property
    def metres(self) -> float:
        """Metres to drive, of all robots."""
        return sum(one.metres for one in self.robots)

    @property
    def end_s(self) -> float:
        """When the last robot has finished."""
        return max((one.end_s for one in self.robots if not one.lost), default=0.0)

    @property
    def served_s(self) -> float:
        """When the last cone is placed or collected."""
        return max((stop.end_s for _, stop in self.all_stops() if stop.is_target), default=0.0)

    @property
    def done(self) -> frozenset[str]:
        """The ids of the cones that are placed or collected already."""
        return frozenset(stop.id for one in self.robots for stop in one.done if stop.is_target)

    def robot(self, name: str) -> RobotPlan | None:
        """Return the plan of robot ``name``."""
        return next((one for one in self.robots if one.robot.id == name), None)

    def all_stops(self) -> Iterator[tuple[RobotPlan, PlanStop]]:
        """Yield every stop to come with the robot that makes it."""
        for one in self.robots:
            for stop in one.stops:
                yield one, stop


@dataclass(frozen=True)
class PlanSituation:
    """The situation ``now_s`` seconds after the plan's begin.

    ``done`` are the ids of the cones that are placed or collected, ``lost`` the robots that dropped out,
    ``failed`` why cones are given up, by their ids; a cone to try again is in neither. ``robots`` holds
    positions, loads and batteries of robots, by their ids; for others the plan's values apply.
    """

    now_s: float
    done: frozenset[str] = frozenset()
    lost: frozenset[str] = frozenset()
    failed: Mapping[str, str] = field(default_factory=dict)
    robots: Mapping[str, PlanRobot] = field(default_factory=dict)


# --- Plans as JSON: one document with everything needed to show, change and send a plan ---
# Names and units are those of :mod:`.plan`; battery without a limit is ``null``.

FORMAT, VERSION = "fleet-supervisor-assignment", 1

T = TypeVar("T")


def plan_to_json(plan: ConePlan) -> str:
    """Return ``plan`` as a JSON document."""
    return json.dumps(document_of(plan), ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def document_of(plan: ConePlan) -> dict[str, Any]:
    """Return ``plan`` as plain values, as :func:`plan_to_json` writes them."""
    return {"format": FORMAT, "version": VERSION, **_plain_value(plan)}


def stop_document(stop: PlanStop) -> dict[str, Any]:
    """Return one stop as plain values."""
    values: dict[str, Any] = _plain_value(stop)
    return values


def stop_of_document(values: Any) -> PlanStop:
    """Return the stop of :func:`stop_document`; raises PlanFileError."""
    return _stop(values, "stop")


def plan_from_json(text: str | bytes) -> ConePlan:
    """Return the plan of a document that :func:`plan_to_json` made.

    :raises PlanFileError: naming the fault and its place in the document.
    """
    try:
        document = decode_json(text, DOCUMENT)
    except DecodingError as error:
        raise PlanFileError(f"This is no JSON document ({error}): choose the file of a plan.") from error
    return plan_of_document(document)


def plan_of_document(document: Any) -> ConePlan:
    """Return the plan of the plain values that :func:`document_of` made; raises PlanFileError as above."""
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise PlanFileError(f"This is no plan: its format is not {FORMAT!r}. Choose the file of a plan.")
    if document.get("version") != VERSION:
        raise PlanFileError(
            f"The plan has version {document.get('version')!r}, and {VERSION} can be read: make it again."
        )
    return _plan({name: value for name, value in document.items() if name not in ("format", "version")})


def _plain_value(value: Any) -> Any:
    if isinstance(
        value, ConePlan | RobotPlan | PlannedTrip | PlanStop | LeftOut | ConeTarget | Store | PlanRobot
    ):
        return {field.name: _plain_value(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, tuple):
        return [_plain_value(one) for one in value]
    if isinstance(value, float) and math.isinf(value):
        return None
    return value


def _plan(given: Any) -> ConePlan:
    return _made(
        ConePlan,
        given,
        "plan",
        robots=lambda value, at: _several(value, at, _robot_plan),
        targets=lambda value, at: _several(value, at, lambda one, where: _made(ConeTarget, one, where)),
        stores=lambda value, at: _several(value, at, lambda one, where: _made(Store, one, where)),
        left_out=lambda value, at: _several(value, at, _left_out),
    )


def _robot_plan(given: Any, at: str) -> RobotPlan:
    return _made(
        RobotPlan,
        given,
        at,
        robot=_robot,
        trips=lambda value, where: _several(value, where, _trip),
        done=lambda value, where: _several(value, where, _stop),
    )


def _robot(given: Any, at: str) -> PlanRobot:
    return _made(PlanRobot, given, at, range_m=_range)


def _range(given: Any, at: str) -> float:
    return math.inf if given is None else float(_checked(given, "float", at))


def _trip(given: Any, at: str) -> PlannedTrip:
    return _made(PlannedTrip, given, at, stops=lambda value, where: _several(value, where, _stop))


def _stop(given: Any, at: str) -> PlanStop:
    return _made(PlanStop, given, at, path=_path)


def _left_out(given: Any, at: str) -> LeftOut:
    return _made(LeftOut, given, at, target=lambda value, where: _made(ConeTarget, value, where))


def _path(given: Any, at: str) -> Path:
    def point(value: Any, where: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise PlanFileError(f"The plan's {where} is no point: it has to be [x, y].")
        return float(_checked(value[0], "float", where)), float(_checked(value[1], "float", where))

    points: Path = _several(given, at, point)
    return points


def _several(given: Any, at: str, one: Any) -> tuple[Any, ...]:
    if not isinstance(given, list):
        raise PlanFileError(f"The plan's {at} is no list: make the plan again.")
    return tuple(one(value, f"{at}[{k}]") for k, value in enumerate(given))


def _made(kind: type[T], given: Any, at: str, **parts: Any) -> T:
    if not isinstance(given, dict):
        raise PlanFileError(f"The plan's {at} is no object: make the plan again.")
    known = {field.name: field for field in fields(kind)}  # type: ignore[arg-type]
    wrong = sorted(set(given) ^ set(known))
    if wrong:
        problem = "is missing" if wrong[0] in known else "is not known"
        raise PlanFileError(f"{wrong[0]!r} {problem} in the plan's {at}: make the plan again.")
    return kind(
        **{
            name: (
                parts[name](given[name], f"{at}.{name}")
                if name in parts
                else _checked(given[name], str(field.type), f"{at}.{name}")
            )
            for name, field in known.items()
        }
    )


_KINDS: dict[str, tuple[type, ...]] = {"float": (int, float), "int": (int,), "str": (str,), "bool": (bool,)}


def _checked(value: Any, kind: str, at: str) -> Any:
    if not isinstance(value, _KINDS[kind]) or (isinstance(value, bool) and kind != "bool"):
        raise PlanFileError(f"The plan's {at} is {value!r}, which is no {kind}: make the plan again.")
    number: Any = value
    if kind != "float":
        return number
    try:
        finite = math.isfinite(number)
    except OverflowError:
        finite = False
    if not finite:
        raise PlanFileError(f"The plan's {at} is no finite number: make the plan again.")
    return float(number)


# --- Check of a plan from its stops alone, independent of the code that makes plans ---

_DONE = {PLACE: "placed", COLLECT: "collected"}
_NEAR = 0.01
"""Metres and seconds of rounding."""


def check_plan(plan: ConePlan, *, led_round: bool = False) -> list[str]:
    """Return the faults of ``plan``; empty if it can be driven.

    Checked are: every target once, room, load, unloading, times, speeds, paths that hang together,
    batteries, and that no target is begun before all of lower stages are done. Paths ``led_round`` obstacles
    may be longer than their counted metres, as those of ClearTravel are.
    """
    faults = list(_served_once(plan))
    for one in plan.robots:
        faults += _load_faults(one, {target.id: target for target in plan.targets})
        faults += _time_faults(one, {target.id: target for target in plan.targets})
        faults += _path_faults(one, led_round)
    return faults + list(_stage_faults(plan))


def _served_once(plan: ConePlan) -> Iterator[str]:
    served = Counter(stop.id for _, stop in plan.all_stops() if stop.is_target)
    served.update(stop.id for one in plan.robots for stop in one.done if stop.is_target)
    left_out = {one.target.id for one in plan.left_out}
    for target in plan.targets:
        count = served.pop(target.id, 0)
        if target.id in left_out and count:
            yield f"Cone {target.id} is left out and served nevertheless."
        elif target.id not in left_out and count != 1:
            yield f"Cone {target.id} is served {counted(count, 'time')}."
    for name in served:
        yield f"Cone {name} is served and not asked for."


def _load_faults(one: RobotPlan, targets: dict[str, ConeTarget]) -> Iterator[str]:
    robot = one.robot
    aboard, collected = robot.aboard, robot.collected
    for stop in one.stops:
        where = f"Robot {robot.id} at {stop.kind} {stop.id}"
        demand = targets[stop.id].demand if stop.is_target and stop.id in targets else 0
        if stop.is_target and stop.id in targets and stop.kind != targets[stop.id].kind:
            yield f"{where}: the cone is to be {_DONE[targets[stop.id].kind]}."
        if stop.kind != STORE and (stop.loaded or stop.unloaded):
            yield f"{where}: loads or unloads where there is no store."
        if stop.kind == STORE:
            total = aboard + collected + stop.loaded - stop.unloaded
            aboard, collected = stop.aboard, stop.collected
            if total != aboard + collected:
                yield f"{where}: {aboard + collected} are on it, and {total} should be."
        aboard -= demand if stop.kind == PLACE else 0
        collected += demand if stop.kind == COLLECT else 0
        if (aboard, collected) != (stop.aboard, stop.collected):
            yield f"{where}: {stop.aboard} and {stop.collected} are told, {aboard} and {collected} are on it."
        if aboard < 0:
            yield f"{where}: has no cone to place."
        if aboard + collected > robot.capacity:
            yield f"{where}: {aboard + collected} are on it, and there is room for {robot.capacity}."
    if collected and one.stops:
        yield f"Robot {robot.id} ends with {counted(collected, 'collected cone')} not unloaded."


def _time_faults(one: RobotPlan, targets: dict[str, ConeTarget]) -> Iterator[str]:
    robot = one.robot
    clock, metres = robot.ready_s, 0.0
    for stop in one.stops:
        where = f"Robot {robot.id} at {stop.kind} {stop.id}"
        metres += stop.metres
        if abs(stop.arrival_s - clock - stop.metres / robot.speed) > _NEAR:
            yield f"{where}: arrives at {stop.arrival_s:.2f} s, which its speed does not allow."
        if stop.begin_s < stop.arrival_s - _NEAR:
            yield f"{where}: begins before it is there."
        service = targets[stop.id].service_s if stop.is_target and stop.id in targets else 0.0
        if stop.end_s < stop.begin_s + service - _NEAR:
            yield f"{where}: ends before it can have been done."
        clock = stop.end_s
    if metres > robot.range_m + _NEAR:
        yield f"Robot {robot.id} drives {metres:.1f} m and has battery for {robot.range_m:.1f} m."


def _path_faults(one: RobotPlan, led_round: bool) -> Iterator[str]:
    at = one.robot.x, one.robot.y
    for stop in one.stops:
        where = f"Robot {one.robot.id} at {stop.kind} {stop.id}"
        if len(stop.path) < 2:
            yield f"{where}: there is no path."
            continue
        if math.dist(stop.path[0], at) > _NEAR:
            yield f"{where}: the path does not begin where the robot is."
        at = stop.x, stop.y
        if math.dist(stop.path[-1], at) > _NEAR:
            yield f"{where}: the path does not end there."
        length = 0.0 if led_round else sum(math.dist(a, b) for a, b in pairwise(stop.path))
        if not math.isfinite(stop.metres) or length > stop.metres * 1.001 + _NEAR * len(stop.path):
            yield f"{where}: the path is {length:.2f} m long, and {stop.metres:.2f} m are counted."
        if stop.kind == HOME and math.dist(at, (one.robot.x, one.robot.y)) > _NEAR:
            yield f"{where}: is not where the robot began."


def _stage_faults(plan: ConePlan) -> Iterator[str]:
    stage_of = {target.id: target.stage for target in plan.targets}
    stops: dict[int, list[PlanStop]] = {}
    for _, stop in plan.all_stops():
        if stop.is_target and stop.id in stage_of:
            stops.setdefault(stage_of[stop.id], []).append(stop)
    done_s, last = -math.inf, ""
    for stage in sorted(stops):
        for stop in stops[stage]:
            if stop.begin_s < done_s - _NEAR:
                yield f"Cone {stop.id} of stage {stage} is begun before {last} is done."
        latest = max(stops[stage], key=lambda one: one.end_s)
        if latest.end_s > done_s:
            done_s, last = latest.end_s, latest.id
