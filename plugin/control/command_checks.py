"""Checks of a pending command against the site, the map, layers, its robot and other robots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt
from qgis.core import QgsMapLayer, QgsProject, QgsVectorLayer, QgsWkbTypes
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.geometry import pairs_between
from ...robot_bridge.core.messages.administration import SiteReport
from ...robot_bridge.core.messages.commands import CommandReport
from ...robot_bridge.core.messages.queues import TaskState
from ...robot_bridge.core.messages.robots import SetPath, SetPosEnd
from ...robot_bridge.core.messages.safety import Ability, RobotState
from ..gateway_client.command_cache import CommandCache, command_in_words
from ..gateway_client.fleet_state import FleetState
from ..gateway_client.report_caches import QueueCache
from ..gateway_client.robot_states import RobotView
from ..gateway_client.state_words import ROBOT_STATES
from ..layers.layer_source import LayerWatch
from ..layers.roles import layers_with_role
from ..layers.site_transform import SiteToCanvas, SiteToMapTransform
from ..ui.language import tr
from ..ui.scheduling import STALLED_AFTER, Steps, scaled_progress
from .keepout_checks import (
    CheckedPath,
    KeepoutCheck,
    LayerReadings,
    ObstacleCheck,
    SurfaceCheck,
    Unread,
    UnreadError,
    is_looked_at,
)
from .pending_command import CONE, ROUTE, START, TARGETS, Findings, PendingCommand, Point

AT_ONCE = 500
"""Tracks processed between two readings of the clock."""

T = TypeVar("T")
Check = KeepoutCheck | ObstacleCheck | SurfaceCheck
Found = dict[CheckedPath, list[Any]]


def check_bounds(points: Sequence[Point], site: SiteReport) -> Findings:
    """Refuse points outside the site's bounds; ``points`` are metres in the site frame."""
    x_min, y_min, x_max, y_max = site.bounds
    outside = [(x, y) for x, y in points if not (x_min <= x <= x_max and y_min <= y <= y_max)]
    if not outside:
        return Findings()
    where = "; ".join(f"({x:.2f}, {y:.2f})" for x, y in outside[:3])
    return Findings(
        refused=(
            tr(
                "{where} m is outside the site {name}, which reaches from ({x_min:g}, {y_min:g}) to "
                "({x_max:g}, {y_max:g}) m. Click inside it.",
                where=where,
                name=site.name,
                x_min=x_min,
                y_min=y_min,
                x_max=x_max,
                y_max=y_max,
            ),
        )
    )


def check_map(transform: SiteToMapTransform) -> Findings:
    """Warn where the map has no CRS: then QGIS puts layers of every CRS into one map, each by its numbers."""
    if transform.map_crs.isValid():
        return Findings()
    return Findings(
        warnings=(
            tr(
                "The project has no CRS, so the map is taken to be in the site's, {crs}; a layer in another "
                "CRS lies at a wrong place on it. Choose the project's CRS at the bottom right in QGIS.",
                crs=transform.site_crs.authid(),
            ),
        )
    )


class LayerCheck(QObject):
    """Checks drafts against the project's layers that carry the roles of obstacles, keepouts and surfaces.

    Findings for a part of a draft are kept until a layer changes or no check needs them any more.
    """

    changed = pyqtSignal()
    """A layer has changed: checks under way must start again."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._readings = readings = LayerReadings(project)
        self._checks: tuple[Check, ...] = (
            KeepoutCheck(project, readings),
            ObstacleCheck(project, readings),
            SurfaceCheck(project, readings),
        )
        self._kept: dict[Check, Found] = {}
        self._kept_for: tuple[Any, ...] = ()
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self._forget)

    def remove(self) -> None:
        """Stop watching layers."""
        self._watch.remove()
        self._readings.remove()

    def check_command(
        self, draft: PendingCommand, transform: SiteToMapTransform, afresh: bool = False
    ) -> Steps[Findings]:
        """Find keepouts and obstacles touched, warn where the draft leaves the road; check all if ``afresh``.

        The reported position of the robot is not checked: the robot may have been put there.

        :raises MapTransformError: when a point has no place in a layer's CRS.
        :raises ExpressionError: when the filter of a layer is no expression.
        """
        if not is_looked_at(draft):
            return Findings()
        layers = {check: self._layers(check) for check in self._checks}
        looked_at = (transform, *(tuple(layer.id() for layer in of_one) for of_one in layers.values()))
        if afresh or looked_at != self._kept_for:
            self._kept.clear()
        self._kept_for = looked_at
        for of_one in layers.values():
            self._watch.watch(of_one)
        findings = Findings()
        # A dictionary per draft: another draft is checked concurrently, and may find the layer read.
        unread: dict[str, Unread] = {}
        for number, check in enumerate(self._checks):
            work = self._check_by(check, layers[check], draft, transform, unread)
            findings += yield from scaled_progress(work, number, len(self._checks))
        return self._unseen(unread) + findings

    def _check_by(
        self,
        check: Check,
        layers: Sequence[QgsVectorLayer],
        draft: PendingCommand,
        transform: SiteToMapTransform,
        unread: dict[str, Unread],
    ) -> Steps[Findings]:
        kept = self._kept.get(check, {})
        tracks = yield from _listed(check.tracks(draft))
        new: Found = {}
        for number, track in enumerate(tracks):
            if track not in kept:
                new[track] = []
            if number % AT_ONCE == 0:
                yield 0.0
        missing = list(new)
        ids = [layer.id() for layer in layers]
        for number, layer in enumerate(layers if missing else ()):
            work = check.check_paths(layer, missing, transform)
            try:
                hits = yield from scaled_progress(work, number, len(layers))
            except UnreadError as error:
                unread[ids[number]] = error.why
                continue
            for place, found in hits.items():
                new[missing[place]] += found
            yield 0.0
        found_for: list[tuple[CheckedPath, list[Any]]] = []
        still_needed: Found = {}
        for number, track in enumerate(tracks):
            found = new[track] if track in new else kept[track]
            found_for.append((track, found))
            still_needed[track] = found
            if number % AT_ONCE == 0:
                yield 0.0
        # Nothing is known of a layer that was not read, nor will be the next time.
        self._kept[check] = {} if unread.keys() & set(ids) else still_needed
        # As with the alarms: layers that are empty, like those of published sites without surfaces.
        is_watched = not self._readings.empty.issuperset(ids)
        return (yield from _checked(check, draft, _without_repetition(draft, found_for), is_watched))

    def _unseen(self, unread: Mapping[str, Unread]) -> Findings:
        """Return findings on the layers that a draft should be checked against and cannot be."""
        layers = layers_with_role(self._project, *(role for check in self._checks for role in check.roles))
        if not layers:
            return Findings(
                warnings=(
                    tr(
                        "No layer of the project says where obstacles and keepouts are, so nobody has "
                        "looked. Open the site's project, or give layers their roles."
                    ),
                )
            )
        return Findings(
            overridable=tuple(
                text for layer in layers if (text := _why_unseen(layer, unread.get(layer.id())))
            )
        )

    def _layers(self, check: Check) -> list[QgsVectorLayer]:
        return [
            layer
            for layer in layers_with_role(self._project, *check.roles)
            if isinstance(layer, QgsVectorLayer)
            and layer.isValid()
            and layer.isSpatial()
            and (not check.only_polygons or _has_areas(layer))
        ]

    def _forget(self) -> None:
        self._kept.clear()
        self.changed.emit()


def _checked(
    check: Check, draft: PendingCommand, found: Sequence[tuple[CheckedPath, list[Any]]], is_watched: bool
) -> Steps[Findings]:
    """Return the findings to report of ``found``, and those of them about the way to the draft."""
    if not draft.way.line:
        return (yield from check.findings(draft, found, is_watched))
    of_place = yield from check.findings(
        draft, [one for one in found if one[0] != draft.way.line], is_watched
    )
    if draft.kind == ROUTE:
        # Separately: findings on the route's own legs must not change as its robot moves.
        way = [one for one in found if one[0] == draft.way.line]
        of_way = yield from check.findings(draft, way, is_watched)
        return of_place + replace(of_way, of_way=of_way.overridable + of_way.warnings)
    findings = yield from check.findings(draft, found, is_watched)
    texts = findings.overridable + findings.warnings
    # A finding about the place alone is not about the way to it.
    return replace(findings, of_way=tuple(text for text in texts if text not in of_place.all_texts))


def _without_repetition(
    draft: PendingCommand, found: Sequence[tuple[CheckedPath, list[Any]]]
) -> Sequence[tuple[CheckedPath, list[Any]]]:
    """Return ``found`` without findings on the way to a target that also hold at the target."""
    if not draft.way.line:
        return found
    at_target = {_name(hit) for track, hits in found if len(track) == 1 for hit in hits}
    return [
        (track, hits if len(track) == 1 else [hit for hit in hits if _name(hit) not in at_target])
        for track, hits in found
    ]


def _name(hit: Any) -> Any:
    """Return the name of a keepout or an obstacle; a surface's share of a track has none."""
    if isinstance(hit, str):
        return hit
    return hit[0] if isinstance(hit[0], str) else object()


def _why_unseen(layer: QgsMapLayer, unread: Unread | None) -> str:
    """Return why a layer cannot be checked against a draft; empty where it can."""
    if layer.isValid() and unread is Unread.SILENT:
        return tr(
            "The layer {layer} has not answered for {seconds:g} s, so what is in it was not looked at. "
            "Bring its server or drive back and try again, or take the role of the layer away.",
            layer=layer.name(),
            seconds=STALLED_AFTER,
        )
    if not layer.isValid() or unread is not None:
        return tr(
            "The layer {layer} cannot be read, so what is in it was not looked at. Repair its "
            "source, or take its role away.",
            layer=layer.name(),
        )
    if layer.isSpatial() and not layer.crs().isValid():
        # QGIS draws it by its numbers in whatever CRS the map has.
        return tr(
            "The layer {layer} has no CRS, so nobody knows where on the site it lies. Set it (Layer > "
            "Set CRS of Layer), or take its role away.",
            layer=layer.name(),
        )
    return ""


def _has_areas(layer: QgsVectorLayer) -> bool:
    return layer.geometryType() == QgsWkbTypes.GeometryType.PolygonGeometry


def _listed(things: Iterable[T]) -> Steps[list[T]]:
    found = []
    for number, thing in enumerate(things):
        found.append(thing)
        if number % AT_ONCE == AT_ONCE - 1:
            yield 0.0
    return found


# --- The robot of the command, and other robots ---

_NEEDED: dict[str, Ability] = {CONE: "targets", TARGETS: "targets", ROUTE: "paths", START: "start"}


def has_ability(robot: RobotView | None, ability: Ability) -> bool:
    """Return whether a robot has not declared that it lacks this ability."""
    abilities = None if robot is None else robot.values.get("abilities")
    return abilities is None or ability in abilities.split()


def check_abilities(draft: PendingCommand, robot: RobotView | None) -> Findings:
    """Refuse what the draft's ``robot`` cannot do; warn where it goes to a cone target without a cone."""
    if robot is None or robot.values.get("abilities") is None:
        return Findings()
    if not robot.values["abilities"]:
        return Findings(refused=(tr("{robot} is only seen: it takes no commands.", robot=draft.robot),))
    if not has_ability(robot, _NEEDED[draft.kind]):
        texts = {
            ROUTE: tr("{robot} cannot follow routes.", robot=draft.robot),
            START: tr("{robot} cannot be told where it starts.", robot=draft.robot),
        }
        otherwise = tr("{robot} cannot be sent to targets.", robot=draft.robot)
        return Findings(refused=(texts.get(draft.kind, otherwise),))
    if has_ability(robot, "cones"):
        return Findings()
    if draft.kind == TARGETS:
        return Findings(refused=(tr("{robot} places no cones.", robot=draft.robot),))
    if draft.kind == CONE:
        return Findings(warnings=(tr("{robot} places no cones: it only drives there.", robot=draft.robot),))
    return Findings()


REPLACING = (CONE, ROUTE)
"""Commands that replace a robot's current one."""


GONE = (RobotState.LOST, RobotState.OFFLINE)


def check_last_seen(draft: PendingCommand, robot: RobotView | None) -> Findings:
    """Warn where the draft's ``robot`` is silent: a message waits, or is not carried out.

    Without its age: the operator has seen the warning as long as it is the same text.
    """
    if robot is None or robot.state not in GONE:
        return Findings()
    return Findings(
        warnings=(
            tr(
                "{robot} is {state}: it is told this when it is heard again, if that is soon enough.",
                robot=draft.robot,
                state=ROBOT_STATES[robot.state],
            ),
        )
    )


def check_orders(draft: PendingCommand, task: CommandReport | None, operator: str) -> Findings:
    """Warn where ``task``, the current command of the draft's robot, comes from another than ``operator``.

    ``operator`` is empty where the gateway has not reported its name.
    """
    if task is None or not operator or task.operator == operator or draft.kind not in REPLACING:
        return Findings()
    return Findings(
        warnings=(
            tr(
                "{robot} is at work for {operator} ({task}): sending this takes its place.",
                robot=draft.robot,
                operator=task.operator,
                task=command_in_words(task),
            ),
        )
    )


CLEAR_M = 1.0
"""Metres between the targets of two robots."""


class OtherTarget(NamedTuple):
    """The target of a robot, metres in the site frame, and ``what`` describes it in words."""

    robot: str
    what: str
    x: float
    y: float


class TargetCheck:
    """Knows the targets of all robots, current and queued; reads again only robots with changes."""

    def __init__(self, cache: CommandCache, queues: QueueCache):
        self._cache = cache
        self._queues = queues
        self._of: dict[str, list[OtherTarget]] = {}
        self._with_news: set[str] = set()
        self._targets: list[OtherTarget] = []
        self._places: npt.NDArray[np.float64] = np.empty((0, 2))

    def mark_changed(self, robots: Iterable[str]) -> None:
        """Record that the commands or queues of these robots have changed."""
        self._with_news.update(robots)

    def clear(self) -> None:
        """Forget every robot."""
        self._of.clear()
        self._with_news.clear()
        self._targets, self._places = [], np.empty((0, 2))

    def check_command(self, draft: PendingCommand) -> Findings:
        """Find the targets of other robots that a draft ends too near to."""
        if draft.kind == START:
            return Findings()
        self._read_news()
        ends = np.array(draft.points if draft.kind == TARGETS else draft.points[-1:], dtype=np.float64)
        if not self._targets:
            return Findings()
        one, other, apart = pairs_between(ends, self._places, CLEAR_M)
        found: dict[str, None] = {}
        for end, number, away in sorted(zip(one.tolist(), other.tolist(), apart.tolist(), strict=True)):
            target = self._targets[number]
            if target.robot != draft.robot and away < CLEAR_M:
                found[_target_text(*ends[end].tolist(), target, away)] = None
        return Findings(overridable=tuple(found))

    def _read_news(self) -> None:
        if not self._with_news:
            return
        for robot in self._with_news:
            self._of[robot] = [*_now(self._cache.task_of(robot)), *self._later(robot)]
            if not self._of[robot]:
                del self._of[robot]
        self._with_news.clear()
        self._targets = [target for targets in self._of.values() for target in targets]
        self._places = np.array([target[2:] for target in self._targets], dtype=np.float64).reshape(-1, 2)

    def _later(self, robot: str) -> Iterator[OtherTarget]:
        queue = self._queues.get(robot)
        for task in queue.tasks if queue is not None else ():
            # The current one is under way, as a command.
            if task.state is not TaskState.CURRENT:
                yield OtherTarget(robot, tr("a task"), task.x, task.y)


def _now(report: CommandReport | None) -> Iterator[OtherTarget]:
    if report is None:
        return
    if report.op == SetPosEnd.__name__:
        yield OtherTarget(report.robot, tr("the target"), report.params["x"], report.params["y"])
    elif report.op == SetPath.__name__:
        x, y = report.params["points"][-1]
        yield OtherTarget(report.robot, tr("the end of the route"), x, y)


def _target_text(x: float, y: float, target: OtherTarget, away: float) -> str:
    return tr(
        "({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, {other_y:.2f}: keep "
        "{clear_m:g} m between targets.",
        x=x,
        y=y,
        away=away,
        what=target.what,
        robot=target.robot,
        other_x=target.x,
        other_y=target.y,
        clear_m=CLEAR_M,
    )


# --- Robots and cones at the goal of a command ---

STANDS_M_S = 0.05
CLEAR_OF_CONES_M = 0.5


def check_standing(draft: PendingCommand, state: FleetState) -> Findings:
    """Warn where a draft ends at a robot that stands and has nowhere to go, or at a cone that was put down.

    A queue comes to its places later: robots may have left by then, cones have not.
    """
    if draft.kind == START:
        return Findings()
    ends = np.array(draft.points if draft.kind == TARGETS else draft.points[-1:], dtype=np.float64)
    texts = [] if draft.kind == TARGETS else list(_robots_at(ends[0], draft.robot, state))
    cones = state.standing_cones()
    if cones:
        places = np.array([(cone.x, cone.y) for cone in cones])
        for end, number, _ in sorted(zip(*pairs_between(ends, places, CLEAR_OF_CONES_M), strict=True)):
            cone = cones[number]
            texts.append(
                tr(
                    "({x:.2f}, {y:.2f}) m is where a cone stands: {robot} put it down at {cone_x:.2f}, "
                    "{cone_y:.2f}.",
                    x=ends[end, 0],
                    y=ends[end, 1],
                    robot=cone.robot,
                    cone_x=cone.x,
                    cone_y=cone.y,
                )
            )
    return Findings(warnings=tuple(texts))


def _robots_at(end: npt.NDArray[np.float64], but: str, state: FleetState) -> Iterator[str]:
    robots = state.robots.arrays(state.clock.steady())
    near = np.hypot(*(robots.xy - end).T) < CLEAR_M
    for row in np.flatnonzero(near & ~(np.abs(robots.v) >= STANDS_M_S)).tolist():
        robot = robots.names[row]
        if robot != but and state.commands.task_of(robot) is None:
            yield tr("({x:.2f}, {y:.2f}) m is where {robot} stands.", x=end[0], y=end[1], robot=robot)


# --- All checks of a command ---


class CommandChecks(QObject):
    """Checks drafts against the project's layers, and against what the gateway reports of site and robots."""

    changed = pyqtSignal()
    """A layer has changed: checks under way must start again."""

    def __init__(
        self,
        project: QgsProject,
        site_to_canvas: SiteToCanvas,
        state: FleetState,
        parent: QObject,
    ):
        super().__init__(parent)
        self._site_to_canvas = site_to_canvas
        self._state = state
        self._layers = LayerCheck(project, self)
        self._layers.changed.connect(self.changed)
        self._targets = TargetCheck(state.commands, state.queues)
        state.commands_changed.connect(lambda changed: self._mark_changed(report.robot for report in changed))
        state.queues_changed.connect(self._mark_changed)

    def check_command(self, draft: PendingCommand, afresh: bool) -> Steps[PendingCommand]:
        """Check a draft, everything if ``afresh``, else only what is new; return it with the findings.

        An override holds for the findings it was given for: it is dropped when there are others.

        :raises FleetError: when there is no site or a layer cannot be read.
        """
        transform = self._site_to_canvas.transform()
        found = check_bounds(draft.points, transform.site) + check_map(transform)
        found += yield from self._layers.check_command(draft, transform, afresh)
        found += draft.way.findings
        # At the end, so that no other draft is sent to the same place meanwhile.
        found += self._targets.check_command(draft)
        # Collisions first: the panel has room for a few lines.
        found = check_standing(draft, self._state) + found
        robot = self._state.robot(draft.robot)
        found += check_last_seen(draft, robot) + check_abilities(draft, robot)
        found += check_orders(draft, self._state.commands.task_of(draft.robot), self._state.link.operator)
        override = draft.override if found.overridable == draft.findings.overridable else None
        cones = has_ability(robot, "cones")
        return replace(draft, findings=found, override=override, is_checked=True, places_cone=cones)

    def forget_targets(self) -> None:
        """Forget the targets of every robot."""
        self._targets.clear()

    def remove(self) -> None:
        """Stop watching the project's layers."""
        self._layers.remove()

    def _mark_changed(self, robots: Iterable[str]) -> None:
        """Record that the commands or queues of these robots have changed."""
        self._targets.mark_changed(robots)
