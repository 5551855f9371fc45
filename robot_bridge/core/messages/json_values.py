"""Conversion of messages to and from plain JSON values."""

from __future__ import annotations

import dataclasses
import functools
import math
from enum import Enum
from typing import Any, TypeVar

from . import administration, roads
from .base import Role, known_fields
from .commands import CommandReport, CommandState, CommandStep
from .plans import PlanProblemKind, PlanProblemReport, PlanReport, PlanState, PlanStopReport
from .positions import MOST_CELLS, Density, FleetView, RobotReport
from .queues import QueueReport, QueueState, TaskKind, TaskReport, TaskState
from .records import ObservationReport, ObservationState, PlacementReport
from .safety import EmergencyReport, RobotState, StoppedGateways

# --- Messages to and from plain JSON values ---


def to_json(message: Any) -> dict[str, Any]:
    """Return a message as JSON values; what is None is left out, a bytes field is left to the payload."""
    return {
        name: value if type(value) in _PLAIN_ALREADY else _plain(value)
        for name in _names(message.__class__)
        if (value := getattr(message, name)) is not None and not isinstance(value, bytes)
    }


_PLAIN_ALREADY = frozenset({str, int, float, bool})


@functools.cache
def _names(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind))


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return to_json(value)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def robot_report(values: dict[str, Any]) -> RobotReport:
    """Return the report that a gateway sent as JSON; unknown fields of newer gateways are passed over."""
    return RobotReport(**{**known_fields(RobotReport, values), "state": RobotState(values["state"])})


def fleet_view(values: dict[str, Any]) -> FleetView:
    """Return the fleet as a desk sees it by its view, as a gateway sent it as JSON.

    :raises ValueError: when a count is none, or the cells of a density lie outside its grid.
    """
    view = FleetView(**{**known_fields(FleetView, values), "density": None})
    _check_counts("view", *(getattr(view, f.name) for f in dataclasses.fields(view) if f.name != "density"))
    if values.get("density") is None:
        return view
    density = Density(**known_fields(Density, values["density"]))
    groups = (density.fresh, density.silent, density.offline)
    _check_counts(
        "density", density.columns, density.rows, *density.cells, *(n for one in groups for n in one)
    )
    corner = (density.cell, density.x, density.y)
    if (
        not all(isinstance(value, (int, float)) and math.isfinite(value) for value in corner)
        or density.cell <= 0
    ):
        raise ValueError(f"the cells of a density have no place or no size: {corner}")
    size = density.columns * density.rows
    if not 0 < size <= MOST_CELLS**2 or any(cell >= size for cell in density.cells):
        raise ValueError(f"a density has cells outside its {density.columns} x {density.rows}")
    if any(len(group) != len(density.cells) for group in groups):
        raise ValueError("a density has other counts than cells")
    return dataclasses.replace(view, density=density)


def _check_counts(name: str, *counts: Any) -> None:
    for count in counts:
        if isinstance(count, bool) or not isinstance(count, int) or count < 0:
            raise ValueError(f"a count of {name} is {count!r}")


def command_report(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON."""
    steps = [
        CommandStep(**{**known_fields(CommandStep, step), "state": CommandState(step["state"])})
        for step in values.get("steps", [])
    ]
    report = CommandReport(
        **{**known_fields(CommandReport, values), "state": CommandState(values["state"]), "steps": steps}
    )
    if report.stood is None:
        return report
    x, y, theta = report.stood
    return dataclasses.replace(report, stood=(x, y, theta))


def site_report(values: dict[str, Any]) -> administration.SiteReport:
    """Return the site that a gateway sent as JSON."""
    known = known_fields(administration.SiteReport, values)
    return administration.SiteReport(
        **{**known, "origin": tuple(values["origin"]), "bounds": tuple(values["bounds"])}
    )


def observation_report(values: dict[str, Any]) -> ObservationReport:
    """Return the observation that a gateway sent as JSON."""
    known = known_fields(ObservationReport, values)
    return ObservationReport(**{**known, "state": ObservationState(values["state"])})


def queue_report(values: dict[str, Any]) -> QueueReport:
    """Return the queue that a gateway sent as JSON."""
    enums = {
        "state": QueueState(values["state"]),
        "robot_state": RobotState(values["robot_state"]),
        "tasks": [task_report(task) for task in values.get("tasks", [])],
        "ended": [task_report(task) for task in values.get("ended", [])],
    }
    return QueueReport(**{**known_fields(QueueReport, values), **enums})


def task_report(values: dict[str, Any]) -> TaskReport:
    """Return the task of a queue that a gateway sent as JSON."""
    typed: dict[str, Any] = {"kind": TaskKind(values["kind"]), "state": TaskState(values["state"])}
    if values.get("path") is not None:
        typed["path"] = [tuple(point) for point in values["path"]]
    return TaskReport(**{**known_fields(TaskReport, values), **typed})


def placement_report(values: dict[str, Any]) -> PlacementReport:
    """Return the placed cone that a gateway sent as JSON."""
    return PlacementReport(**known_fields(PlacementReport, values))


def plan_report(values: dict[str, Any]) -> PlanReport:
    """Return the cone plan that a gateway sent as JSON; its documents stay plain values."""
    stops = [
        PlanStopReport(**{**known_fields(PlanStopReport, one), "state": TaskState(one["state"])})
        for one in values.get("stops", [])
    ]
    problems = [
        PlanProblemReport(**{**known_fields(PlanProblemReport, one), "kind": PlanProblemKind(one["kind"])})
        for one in values.get("problems", [])
    ]
    typed = {"state": PlanState(values["state"]), "stops": stops, "problems": problems}
    return PlanReport(**{**known_fields(PlanReport, values), **typed})


def emergency_report(values: dict[str, Any]) -> EmergencyReport:
    """Return how an emergency stop stands, as a gateway sent it as JSON."""
    report = EmergencyReport(**known_fields(EmergencyReport, values))
    if not isinstance(report.gateways, dict):
        return report
    gateways = StoppedGateways(**known_fields(StoppedGateways, report.gateways))
    return dataclasses.replace(report, gateways=gateways)


# --- What gateways tell of roads, from plain JSON values; unknown fields of newer gateways are passed over

T = TypeVar("T")


def closures_report(values: dict[str, Any]) -> roads.Closures:
    """Return the roads that are closed."""
    return roads.Closures([closure_report(one) for one in values.get("closures", [])])


def closure_report(values: dict[str, Any]) -> roads.ClosureReport:
    """Return one closed road."""
    return _made(roads.ClosureReport, {**values, "line": _points(values["line"])})


def conflicts_report(values: dict[str, Any]) -> roads.Conflicts:
    """Return where robots are in each other's way."""
    return roads.Conflicts(
        float(values["t"]),
        [_made(roads.ConflictReport, one) for one in values.get("conflicts", [])],
        [_made(roads.HoldReport, one) for one in values.get("waiting", [])],
    )


def ways_out_report(values: dict[str, Any]) -> roads.WaysOut:
    """Return what two robots in each other's way can do."""
    ways = [_made(roads.WayOut, {**one, "points": _points(one.get("points", []))}) for one in values["ways"]]
    return roads.WaysOut(float(values["t"]), str(values["robot"]), str(values["other"]), ways)


def replanned_robot(values: dict[str, Any]) -> roads.ReplannedRobot:
    """Return what became of a robot whose road was closed."""
    return _made(roads.ReplannedRobot, values)


def route_report(values: dict[str, Any]) -> roads.RouteReport:
    """Return the way that was asked for."""
    surfaces = [_made(roads.SurfaceMetres, one) for one in values.get("surfaces", [])]
    points, tight = _points(values["points"]), _points(values.get("tight", []))
    return _made(roads.RouteReport, {**values, "points": points, "tight": tight, "surfaces": surfaces})


def _made(kind: type[T], values: dict[str, Any]) -> T:
    return kind(**known_fields(kind, values))


def _points(pairs: list[Any]) -> list[tuple[float, float]]:
    points = [(float(x), float(y)) for x, y in pairs]
    if not all(math.isfinite(x) and math.isfinite(y) for x, y in points):
        raise ValueError("a point has a coordinate that is no number")
    return points


# --- What supervisors are told, from plain JSON values: accounts, tokens, open sessions, sites ---


def operators_report(values: dict[str, Any]) -> administration.Operators:
    """Return every account that a gateway sent as JSON."""
    return administration.Operators([_operator_report(one) for one in values["operators"]])


def _operator_report(values: dict[str, Any]) -> administration.OperatorReport:
    enums = {"role": Role(values["role"]), "token": administration.TokenState(values["token"])}
    return administration.OperatorReport(**{**known_fields(administration.OperatorReport, values), **enums})


def new_token(values: dict[str, Any]) -> administration.NewToken:
    """Return the token that was just made, as a gateway sent it as JSON."""
    return administration.NewToken(
        **{**known_fields(administration.NewToken, values), "role": Role(values["role"])}
    )


def open_session(values: dict[str, Any]) -> administration.SessionReport:
    """Return one connection of an operator, as a gateway sent it as JSON."""
    return administration.SessionReport(**known_fields(administration.SessionReport, values))


def suspensions_report(values: dict[str, Any]) -> administration.Suspensions:
    """Return which robots' accounts are locked, as a gateway sent it as JSON."""
    return administration.Suspensions(
        [
            administration.Suspension(**known_fields(administration.Suspension, one))
            for one in values["robots"]
        ]
    )


def links_report(values: dict[str, Any]) -> administration.Links:
    """Return how each link is, as a gateway sent it as JSON."""
    return administration.Links(
        [administration.LinkReport(**known_fields(administration.LinkReport, one)) for one in values["links"]]
    )


def sites_report(values: dict[str, Any]) -> administration.Sites:
    """Return the sites that a gateway may serve, as it sent them as JSON."""
    return administration.Sites(
        [administration.SiteOffer(**known_fields(administration.SiteOffer, one)) for one in values["sites"]]
    )
