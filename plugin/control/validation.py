"""Validation of a pending command: site, map, layers, robots; run again whenever something changes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from qgis.core import QgsProject, QgsVectorLayer, QgsWkbTypes
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.core.messages.administration import SiteReport
from ..gateway_client.fleet_state import FleetState
from ..layers.layer_source import LayerWatch
from ..layers.roles import layers_with_role
from ..layers.site_transform import SiteToCanvas, SiteToMapTransform
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask, Steps, scaled_progress
from .layer_checks import CheckedPath, KeepoutCheck, ObstacleCheck, SurfaceCheck, is_looked_at
from .pending_command import ROUTE, Findings, PendingCommand, PendingCommandModel, Point
from .robot_checks import TargetCheck, check_abilities, check_last_seen, check_orders, has_ability

AT_ONCE = 500
"""Tracks that are gone through between two looks at the clock."""

T = TypeVar("T")
Check = KeepoutCheck | ObstacleCheck | SurfaceCheck
Found = dict[CheckedPath, list[Any]]


def check_bounds(points: Sequence[Point], site: SiteReport) -> Findings:
    """Refuse what lies outside the site's bounds; ``points`` are metres in the site frame."""
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


def check_map(placement: SiteToMapTransform) -> Findings:
    """Warn where the map has no CRS: then QGIS puts layers of every CRS into one map, each by its numbers."""
    if placement.map_crs.isValid():
        return Findings()
    return Findings(
        warnings=(
            tr(
                "The project has no CRS, so the map is taken to be in the site's, {crs}; a layer in another "
                "CRS lies at a wrong place on it. Choose the project's CRS at the bottom right in QGIS.",
                crs=placement.site_crs.authid(),
            ),
        )
    )


class LayerCheck(QObject):
    """Checks drafts against the project's layers that carry the roles of obstacles, keepouts and surfaces.

    What was found for a part of a draft is kept until a layer changes or another check needs it no more.
    """

    changed = pyqtSignal()
    """A layer is not as it was: what is under way has to begin again."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._checks: tuple[Check, ...] = (
            KeepoutCheck(project),
            ObstacleCheck(project),
            SurfaceCheck(project),
        )
        self._kept: dict[Check, Found] = {}
        self._kept_for: tuple[Any, ...] = ()
        self._watch = LayerWatch(self)
        self._watch.changed.connect(self._forget)

    def remove(self) -> None:
        """Watch no layer any longer."""
        self._watch.remove()

    def check_command(
        self, draft: PendingCommand, placement: SiteToMapTransform, afresh: bool = False
    ) -> Steps[Findings]:
        """Find what touches a keepout or an obstacle, warn of what leaves the road; ``afresh`` all of it.

        Where a robot says that it stands is not looked at: it may have been put there.

        :raises MapTransformError: when a point has no place in a layer's CRS.
        :raises ExpressionError: when the filter of a layer is no expression.
        """
        if not is_looked_at(draft):
            return Findings()
        layers = {check: self._layers(check) for check in self._checks}
        looked_at = (placement, *(tuple(layer.id() for layer in of_one) for of_one in layers.values()))
        if afresh or looked_at != self._kept_for:
            self._kept.clear()
        self._kept_for = looked_at
        for of_one in layers.values():
            self._watch.watch(of_one)
        findings = self._unseen()
        for number, check in enumerate(self._checks):
            work = self._look_by(check, layers[check], draft, placement)
            findings += yield from scaled_progress(work, number, len(self._checks))
        return findings

    def _look_by(
        self,
        check: Check,
        layers: Sequence[QgsVectorLayer],
        draft: PendingCommand,
        placement: SiteToMapTransform,
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
        for number, layer in enumerate(layers if missing else ()):
            hits = yield from scaled_progress(
                check.check_paths(layer, missing, placement), number, len(layers)
            )
            for place, found in hits.items():
                new[missing[place]] += found
        found_for: list[tuple[CheckedPath, list[Any]]] = []
        still_needed: Found = {}
        for number, track in enumerate(tracks):
            found = new[track] if track in new else kept[track]
            found_for.append((track, found))
            still_needed[track] = found
            if number % AT_ONCE == 0:
                yield 0.0
        self._kept[check] = still_needed
        # As with the alarms: of layers with nothing in them, as published sites without surfaces have them.
        is_watched = any(layer.featureCount() != 0 for layer in layers)
        return (yield from _checked(check, draft, _without_repetition(draft, found_for), is_watched))

    def _unseen(self) -> Findings:
        """Tell of what a draft has to be held against and cannot be."""
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
                tr(
                    "The layer {layer} cannot be read, so what is in it was not looked at. Repair its "
                    "source, or take its role away.",
                    layer=layer.name(),
                )
                for layer in layers
                if not layer.isValid()
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
    """Return what is to be told of what was ``found``, and which of that is about the way to the draft."""
    if not draft.way.line:
        return (yield from check.findings(draft, found, is_watched))
    of_place = yield from check.findings(
        draft, [one for one in found if one[0] != draft.way.line], is_watched
    )
    if draft.kind == ROUTE:
        # By itself: what is told of the route's own legs must not change as its robot moves.
        way = [one for one in found if one[0] == draft.way.line]
        of_way = yield from check.findings(draft, way, is_watched)
        return of_place + replace(of_way, of_way=of_way.overridable + of_way.warnings)
    findings = yield from check.findings(draft, found, is_watched)
    texts = findings.overridable + findings.warnings
    # What is told of the place alone is not of the way to it.
    return replace(findings, of_way=tuple(text for text in texts if text not in of_place.all_texts))


def _without_repetition(
    draft: PendingCommand, found: Sequence[tuple[CheckedPath, list[Any]]]
) -> Sequence[tuple[CheckedPath, list[Any]]]:
    """Return what was ``found``, but of the way to a target not what is at the target as well."""
    if not draft.way.line:
        return found
    at_target = {_name(hit) for track, hits in found if len(track) == 1 for hit in hits}
    return [
        (track, hits if len(track) == 1 else [hit for hit in hits if _name(hit) not in at_target])
        for track, hits in found
    ]


def _name(hit: Any) -> Any:
    """Return the name of a keepout or an obstacle; what a surface holds of a track has none."""
    if isinstance(hit, str):
        return hit
    return hit[0] if isinstance(hit[0], str) else object()


def _has_areas(layer: QgsVectorLayer) -> bool:
    return layer.geometryType() == QgsWkbTypes.GeometryType.PolygonGeometry


def _listed(things: Iterable[T]) -> Steps[list[T]]:
    found = []
    for number, thing in enumerate(things):
        found.append(thing)
        if number % AT_ONCE == AT_ONCE - 1:
            yield 0.0
    return found


class CommandChecks(QObject):
    """Checks drafts against the project's layers, and against what the gateway reports of site and robots."""

    changed = pyqtSignal()
    """A layer is not as it was: what is under way has to begin again."""

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
        """Look at a draft, all of it ``afresh`` or only what is new; return it with what was found.

        An override holds for what was found when it was given: it is gone when something else is found.

        :raises FleetError: when there is no site or a layer cannot be read.
        """
        placement = self._site_to_canvas.transform()
        found = check_bounds(draft.points, placement.site) + check_map(placement)
        found += yield from self._layers.check_command(draft, placement, afresh)
        found += _approach_findings(draft)
        # At the end, so that nobody is sent there meanwhile.
        found += self._targets.check_command(draft)
        robot = self._state.robot(draft.robot)
        found += check_last_seen(draft, robot) + check_abilities(draft, robot)
        found += check_orders(draft, self._state.commands.task_of(draft.robot), self._state.link.operator)
        override = draft.override if found.overridable == draft.findings.overridable else None
        cones = has_ability(robot, "cones")
        return replace(draft, findings=found, override=override, is_checked=True, places_cone=cones)

    def forget_targets(self) -> None:
        """Forget what every robot has to do."""
        self._targets.clear()

    def remove(self) -> None:
        """Watch the project's layers no more."""
        self._layers.remove()

    def _mark_changed(self, robots: Iterable[str]) -> None:
        """Take in that something new is known of what these robots have to do."""
        self._targets.mark_changed(robots)


def _approach_findings(draft: PendingCommand) -> Findings:
    """Return what is to be told of the way to a target, besides what is in it."""
    way = draft.way
    if way.refusal:
        return Findings(refused=(way.refusal,), of_way=(way.refusal,))
    if way.note and not way.is_along_roads:
        return Findings(warnings=(way.note,), of_way=(way.note,))
    return Findings()


Work = Callable[[PendingCommand, bool], Steps[PendingCommand]]
"""Takes a draft, and whether all of it is to be looked at afresh; returns the draft with what was found."""


class ValidationRunner(QObject):
    """Checks the draft on ``board``, and no other.

    What was found is for the one draft that was looked at: a draft is never changed, only replaced, and with
    another one on the board nothing comes of the check that was under way. What was to follow it is passed on
    with ``displaced`` where another draft was begun.
    """

    progressed = pyqtSignal()
    """A check has begun, gone on, or come to its end."""
    overtaken = pyqtSignal(object)
    """The draft was changed before something could be done with it: the Draft as it was."""
    displaced = pyqtSignal(object, object)
    """Another draft was begun before something could be done with this one: the Draft, and what to do."""
    found = pyqtSignal(object)
    """The draft that was put on the map has been looked at: the Draft, with its findings."""

    def __init__(self, board: PendingCommandModel, work: Work, parent: QObject | None = None):
        super().__init__(parent)
        self._board = board
        self.work = work
        self._slices = CooperativeTask(self)
        self._draft: PendingCommand | None = None
        self._afresh = self._is_put = False
        self._then: Callable[[PendingCommand], None] | None = None
        self._anew = QTimer(self)
        self._anew.setSingleShot(True)
        self._anew.setInterval(0)
        self._anew.timeout.connect(self._begin_anew)
        board.changed.connect(self._changed)

    @property
    def is_under_way(self) -> bool:
        """Whether the draft on the board is being looked at."""
        return self._draft is not None

    @property
    def has_order(self) -> bool:
        """Whether something is to be done with the draft once it has been looked at."""
        return self._then is not None

    @property
    def share(self) -> float:
        """How much of the check is done, 0 to 1."""
        return self._slices.share

    def set_command(self, draft: PendingCommand) -> None:
        """Make ``draft`` the one on the board; a small one has been checked when this returns.

        :raises FleetError: when it cannot be checked; what was on the board stays then.
        """
        self._put(draft, self._board.set_command)

    def amend(self, draft: PendingCommand) -> None:
        """Put ``draft`` in place of the one on the board, whose way is another by now; check it as by put.

        :raises FleetError: as :meth:`set_command`.
        """
        self._put(draft, self._board.renew)

    def _put(self, draft: PendingCommand, place: Callable[[PendingCommand], None]) -> None:
        before, ordered = (self._draft, self._afresh, self._is_put, self._then), self._ordered
        self._draft, self._afresh, self._is_put, self._then = draft, False, True, None
        try:
            checked = self._begin()
        except FleetError:
            self._draft, self._afresh, self._is_put, self._then = before
            self._anew.start()
            raise
        self._draft = draft if checked is None else checked
        place(self._draft)
        if checked is not None:
            self._end(checked)
        if ordered is not None:
            # To take changes back must not lead to what is on its way out.
            self._board.forget_changes()
            self.displaced.emit(ordered, before[3])
        self.progressed.emit()

    def again(self, then: Callable[[PendingCommand], None]) -> None:
        """Look at the draft on the board afresh, then do something with it unless it is another by then.

        :raises FleetError: when it cannot be checked; nothing is done then.
        """
        self._draft, self._afresh, self._is_put, self._then = self._board.draft, True, False, then
        try:
            checked = self._begin()
        except FleetError:
            self._give_up()
            raise
        if checked is not None:
            self._take(checked)
        self.progressed.emit()

    def withdraw(self) -> bool:
        """Do nothing with the draft after the check; false where nothing was to be done."""
        had_order, self._then = self.has_order, None
        if had_order:
            self.progressed.emit()
        return had_order

    def begin_anew(self) -> None:
        """Give up what was found so far: a layer has changed under it."""
        if self._draft is not None:
            self._slices.stop()
            # A layer that is changed feature by feature tells of each.
            self._anew.start()

    def stop(self) -> None:
        """Look at nothing any more."""
        self._give_up()

    def _changed(self) -> None:
        draft = self._board.draft
        if draft is self._draft:
            return
        # Who takes a draft away needs not be told that it is not sent.
        ordered = self._ordered if draft is not None else None
        self._give_up()
        self._tell_of(ordered)
        if draft is not None and not draft.is_checked and not self._board.is_dragged:
            # Taken back to one whose check was not finished.
            self._draft = draft
            self._anew.start()
        self.progressed.emit()

    @property
    def _ordered(self) -> PendingCommand | None:
        return self._draft if self.has_order else None

    def _tell_of(self, ordered: PendingCommand | None) -> None:
        if ordered is not None:
            self.overtaken.emit(ordered)

    def _begin(self) -> PendingCommand | None:
        self._anew.stop()
        work = self.work(self._draft, self._afresh)
        return self._slices.begin(work, self.progressed.emit, self._take, self._failed)

    def _begin_anew(self) -> None:
        if self._draft is None:
            return
        try:
            checked = self._begin()
        except FleetError as error:
            self._failed(error)
            return
        if checked is not None:
            self._take(checked)

    def _failed(self, error: FleetError) -> None:
        self._take(replace(self._draft, findings=Findings(refused=(str(error),)), is_checked=True))

    def _take(self, checked: PendingCommand) -> None:
        """Put what was found into the draft on the board."""
        if checked != self._draft:
            # From here on it is this one that is looked at.
            self._draft = checked
            self._board.renew(checked)
        self._end(checked)
        self.progressed.emit()

    def _end(self, checked: PendingCommand) -> None:
        then, is_put = self._then, self._is_put
        self._give_up()
        if is_put:
            self.found.emit(checked)
        if then is not None:
            then(checked)

    def _give_up(self) -> None:
        self._anew.stop()
        self._slices.stop()
        self._draft, self._then = None, None
        self._afresh = self._is_put = False
