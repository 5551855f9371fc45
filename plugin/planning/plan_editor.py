"""The plan being edited by the operator, unknown to any robot; also plans for collecting a layout."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from qgis.core import QgsApplication
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment import plan_changes
from ...robot_bridge.core.assignment.job import COLLECT, AssignmentJob, ConeTarget, PlanRobot
from ...robot_bridge.core.assignment.plan import ConePlan
from ...robot_bridge.core.assignment.progress import ConeFacts
from ...robot_bridge.core.assignment.solver import AUTOMATIC, PREVIEW, Objective, assign
from ...robot_bridge.core.errors import AssignmentError, MissingStoreError
from ...robot_bridge.core.messages.base import MessageError
from ...robot_bridge.core.messages.queues import QueueTask, TaskKind
from ...robot_bridge.core.messages.records import CollectLayout
from ...robot_bridge.core.messages.roads import ClosureReport
from ...robot_bridge.core.sites.frame import SiteFrame
from ..control.fleet_controller import FleetController
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.state_words import part_in_words
from ..layers.reading import OneAtATime
from ..ui.errors import FleetError, MapTransformError
from ..ui.language import tr
from ..ui.scheduling import WAITING, CooperativeTask, Steps
from . import plan_settings
from .proposal import ClosureCheck, PlanProposal, PlanTask, PlanTravel

# --- The plan as it is made and edited at the desk; no robot knows it ---


class PlanningError(FleetError):
    """A plan cannot be made: names what is missing, and the remedy."""


class PlanEditor(QObject):
    """Makes and changes the plan by one :class:`PlanTask` at a time."""

    changed = pyqtSignal()
    """The plan has changed, is gone, or is being made."""
    refused = pyqtSignal(str)

    def __init__(self, desk: FleetController, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self.settings: plan_settings.PlanSettings = plan_settings.read_settings(desk.project)
        self.draft: PlanProposal | None = None
        self.task: PlanTask | None = None
        self._before: PlanTask | None = None
        """The task cancelled last: its thread may be in a layer that hangs."""
        self._layers = OneAtATime()
        self._reading, self._waiting = CooperativeTask(self), CooperativeTask(self)
        self._closures: Sequence[ClosureReport] = ()
        """The closures that the task considers."""
        self._then: Callable[[PlanProposal], None] = self._set_draft
        """Receives the plan that the task makes."""
        self._closure_check, self._made_check = ClosureCheck(self), ClosureCheck(self)
        desk.roads.closures_changed.connect(self.check_closures)

    def plan_with(self, settings: plan_settings.PlanSettings) -> None:
        """Make plans with ``settings`` from now on."""
        self.settings = settings

    @property
    def busy(self) -> bool:
        """Whether a plan is being made."""
        return self.task is not None or self._reading.is_busy

    def make(self, *, preview: bool) -> None:
        """Plan the chosen layer's cones, quickly or well.

        :raises FleetError: naming what is missing.
        """
        frame = self._frame()
        self._begin(self._make_placing(frame, preview))

    def make_collecting(self, tasks: Sequence[QueueTask], *, preview: bool) -> None:
        """Plan who collects placed cones, given as the gateway's tasks; raises FleetError."""
        frame = self._frame()
        targets, facts = [], {}
        for task in tasks:
            name = f"{task.cone or task.label or 'cone'} #{task.placement}"
            targets.append(ConeTarget(name, task.x, task.y, 0.0, 0, COLLECT, 1, self.settings.service_s))
            facts[name] = ConeFacts(task.cone or name, task.layout or "", task.placement, task.theta)
        self._begin(self._make(tuple(targets), facts, frame, preview))

    def move(self, target: str, robot: str, trip: int, place: int) -> None:
        """Move ``target`` to ``robot`` as number ``place``, from 0, of its trip ``trip``."""
        self._edit(
            lambda plan, travel_of: plan_changes.move_target(plan, travel_of, target, robot, trip, place)
        )

    def remove(self, target: str) -> None:
        """Remove ``target`` from the plan."""
        self._edit(lambda plan, travel_of: plan_changes.remove_target(plan, travel_of, target))

    def set_proposal(self, draft: PlanProposal | None) -> None:
        """Show another plan, None for none."""
        self.cancel()
        self.draft = draft
        self.changed.emit()

    def drop(self, draft: PlanProposal) -> None:
        """Hide ``draft``, if it is the plan; a computation under way continues."""
        if self.draft is draft:
            self.draft = None
            self.changed.emit()

    def run(
        self,
        title: str,
        ground: PlanProposal,
        work: Callable[[PlanTask], ConePlan],
        then: Callable[[PlanProposal], None],
    ) -> None:
        """Make a plan on the ground of another, in the background; ``then`` receives it."""
        self._check_idle()
        apart_m, closures = self.settings.apart_m, self._desk.roads.closures
        task = PlanTask(title, lambda task: ground.with_plan(work(task), apart_m, closures))
        task.ended.connect(self._ended)
        self.task, self._closures, self._then = task, closures, then
        self._waiting.begin(self._add_task(task))
        self.changed.emit()

    def cancel(self) -> None:
        """Cancel the computation under way; the previous plan stays."""
        if not self.busy:
            return
        self._reading.stop()
        self._waiting.stop()
        task, self.task = self.task, None
        # QGIS deletes a finished task; its plan may still be checked against roads closed meanwhile.
        if task is not None and not sip.isdeleted(task):
            task.cancel()
            if task.is_under_way:
                self._before = task
        self.changed.emit()

    def shut_down(self) -> None:
        """Cancel the computation under way; its thread may remain in a layer that hangs."""
        self._closure_check.stop()
        self._made_check.stop()
        self.cancel()

    def check_closures(self) -> None:
        """Find again which parts of the plan lead along closed roads."""
        draft = self.draft
        if draft is None:
            return

        def found(drafts: list[PlanProposal]) -> None:
            # Another plan was checked when it was made.
            if self.draft is draft and drafts[0] is not draft:
                self.draft = drafts[0]
                self.changed.emit()

        self._closure_check.begin([draft], self._desk.roads.closures, found)

    def _check_idle(self) -> None:
        if self.task is not None:
            raise PlanningError(tr("A plan is being made. Wait for it, or press Cancel."))

    def _begin(self, work: Steps[None]) -> None:
        """Read layers for a plan and start making it."""
        self._check_idle()
        self._reading.begin(work, done=lambda _: self.changed.emit(), failed=self._refused)
        if self._reading.is_busy:
            self.changed.emit()

    def _refused(self, error: FleetError) -> None:
        self.changed.emit()
        self.refused.emit(str(error))

    def _add_task(self, task: PlanTask) -> Steps[None]:
        """Start ``task`` when the thread of the one before has ended: threads would pile up."""
        while self._before is not None and self._before.is_under_way:
            yield WAITING
        self._before = None
        QgsApplication.taskManager().addTask(task)

    def _make_placing(self, frame: SiteFrame, preview: bool) -> Steps[None]:
        targets, facts = yield from plan_settings.read_cones(
            self._desk.project, self.settings, frame, self._layers
        )
        yield from self._make(targets, facts, frame, preview)

    def _make(
        self, targets: tuple[ConeTarget, ...], facts: dict[str, ConeFacts], frame: SiteFrame, preview: bool
    ) -> Steps[None]:
        stores = yield from plan_settings.read_stores(self._desk.project, self.settings, frame, self._layers)
        if not preview and (part := part_in_words(self._desk.state.robots)):
            self._desk.warning.emit(f"{part} {tr('Others take no part in the plan.')}")
        try:
            job = AssignmentJob(targets, self._robots(), stores, self.settings.finish)
            objective = Objective(
                self.settings.objective, PREVIEW if preview else AUTOMATIC, self.settings.seconds
            )
        except MissingStoreError as error:
            raise PlanningError(
                tr(
                    "There is no store where robots load or unload cones: choose a layer of points under "
                    "Stores, or write under Aboard how many cones each robot has to place."
                )
            ) from error
        except AssignmentError as error:
            raise PlanningError(str(error)) from error
        ways = PlanTravel(self._desk.project, frame, self.settings)
        ways.cones = self._standing_cones({one.placement for one in facts.values()})
        ways.standing = self._standing_robots()
        blank = PlanProposal(ConePlan((), (), (), "", "", "", ""), ways, facts, uuid.uuid4().hex)
        ways.closures = self._desk.roads.closures
        self.run(
            tr("Preview of the cone plan") if preview else tr("Cone plan"),
            blank,
            lambda task: assign(job, ways.travel_of(job, task.goes_on), objective, task.report_progress),
            self._set_draft,
        )

    def _edit(self, change: Callable[[ConePlan, plan_changes.TravelOf], ConePlan]) -> None:
        draft = self.draft
        if draft is not None:
            title = tr("Change of the cone plan")
            draft.ways.closures = self._desk.roads.closures
            self.run(
                title,
                draft,
                lambda task: change(draft.plan, lambda job: draft.ways.travel_of(job, task.goes_on)),
                self._set_draft,
            )

    def _set_draft(self, draft: PlanProposal) -> None:
        self.draft = draft

    def _made(
        self,
        task: PlanTask,
        draft: PlanProposal,
        closures: Sequence[ClosureReport],
        then: Callable[[PlanProposal], None],
    ) -> None:
        if task is not self.task:
            return
        now = self._desk.roads.closures
        if now != closures:
            # A road was closed or opened meanwhile.
            self._made_check.begin([draft], now, lambda found: self._made(task, found[0], now, then))
            return
        self.task = None
        then(draft)
        self.changed.emit()

    def _ended(self, task: PlanTask, _done: bool) -> None:
        if task is not self.task:
            return
        # It was cancelled in QGIS's own list of tasks.
        cancelled = task.isCanceled()
        if task.draft is not None and not cancelled:
            self._made(task, task.draft, self._closures, self._then)
            return
        self.task = None
        self.changed.emit()
        if not cancelled:
            self.refused.emit(task.why)

    def _frame(self) -> SiteFrame:
        if self._desk.state.site is None:
            raise MapTransformError(tr("The site is not known yet. Connect to a gateway first."))
        return self._desk.site_to_canvas.transform().frame

    def _robots(self) -> tuple[PlanRobot, ...]:
        robots = self._desk.state.robots.arrays(self._desk.clock.steady())
        used = plan_settings.participating_robots(robots, self.settings)
        if not used.any():
            raise PlanningError(
                tr("No robot that is there is chosen: tick robots in the table, or connect some.")
            )
        return tuple(
            self.settings.of_robot(robots.names[row]).robot(robots.names[row], *robots.xy[row].tolist())
            for row in self._desk.state.robots.by_name()
            if used[row]
        )

    def _standing_cones(self, collected: set[int | None]) -> np.ndarray:
        """Return the positions of cones that the plan does not collect, (n, 2)."""
        cones = [
            (one.x, one.y)
            for one in self._desk.state.standing_cones()
            if one.placement is None or one.placement not in collected
        ]
        return np.array(cones, dtype=float).reshape(-1, 2)

    def _standing_robots(self) -> dict[str, tuple[float, float]]:
        """Return the positions of robots that do not take part."""
        robots = self._desk.state.robots.arrays(self._desk.clock.steady())
        stand = plan_settings.have_position(robots) & ~plan_settings.participating_robots(
            robots, self.settings
        )
        return {robots.names[row]: tuple(robots.xy[row].tolist()) for row in np.flatnonzero(stand)}


# --- Queries the gateway for the standing cones of a layout, and plans their collection ---


class CollectionPlanner(QObject):
    """Makes a draft of the answer. Nothing is sent to robots."""

    refused = pyqtSignal(str)

    def __init__(self, desk: FleetController, drafts: PlanEditor, parent: QObject | None = None):
        super().__init__(parent)
        self._desk, self._drafts = desk, drafts
        self._key: str | None = None
        self._only: frozenset[int] | None = None
        desk.orders.answered.connect(self._answered)
        desk.state.forgotten.connect(self._forget)

    def ask(self, request: CollectLayout, only: frozenset[int] | None = None) -> None:
        """Request the cones to collect, of which the draft takes the placed cones ``only``, if given.

        :raises NotSentError: when that cannot be sent.
        """
        self._only = only
        self._key = self._desk.orders.ask(request, tr("What is to be collected"))

    def _forget(self) -> None:
        # An answer may arrive after a later change of site: its places belong to the site before.
        self._key = None

    def _answered(self, answer: RequestResult) -> None:
        if answer.order.key != self._key:
            return
        self._key = None
        if answer.error is not None or answer.result is None:
            return
        queued = int(answer.result.get("in_queues") or 0)
        try:
            tasks = [_task(values) for values in answer.result.get("tasks", [])]
            if self._only is not None:
                tasks = [task for task in tasks if task.placement in self._only]
            if not tasks:
                layout = answer.order.params.get("layout")
                self.refused.emit(_nothing(layout, queued) if self._only is None else _nothing_of_plan())
                return
            self._drafts.make_collecting(tasks, preview=False)
        except (FleetError, MessageError, KeyError, TypeError, ValueError) as error:
            self.refused.emit(tr("Collecting cannot be planned: {error}", error=error))


def _nothing(layout: str | None, queued: int) -> str:
    also = tr("; {queued} are in queues already", queued=queued) if queued else ""
    if layout:
        return tr(
            "No cone of layout {layout} stands that could be collected{also}.", layout=layout, also=also
        )
    return tr("No cone stands that could be collected{also}.", also=also)


def _nothing_of_plan() -> str:
    return tr(
        "No cone of this plan stands that could be collected: none was placed, or they are collected or in "
        "queues already. For others choose a layout, or everything."
    )


def _task(values: dict[str, Any]) -> QueueTask:
    known = {field.name for field in fields(QueueTask)}
    given = {name: value for name, value in values.items() if name in known}
    return QueueTask(**{**given, "kind": TaskKind(given["kind"])})
