"""The plan as it is planned and edited at the desk; nothing of it is known to any robot."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence

import numpy as np
from qgis.core import QgsApplication
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.assignment import editing
from ....robot_bridge.assignment.errors import AssignmentError, MissingStoreError
from ....robot_bridge.assignment.job import COLLECT, Job, Robot, Target
from ....robot_bridge.assignment.plan import Plan
from ....robot_bridge.assignment.solving import AUTOMATIC, PREVIEW, Wanted, assign
from ....robot_bridge.messages import ClosureReport, QueueTask
from ....robot_bridge.sites.frame import SiteFrame
from ...errors import FleetError, PlacementError
from ...language import tr
from ..desk import Desk
from .available_robots import has_place, taking_part
from .closure_look import ClosureLook
from .cone_source import ConeFacts, read_cones, read_stores
from .draft import Draft
from .plan_settings import PlanSettings, settings_in
from .plan_task import PlanTask
from .plan_ways import PlanWays


class PlanningError(FleetError):
    """What cannot be planned as things are: names what is missing, and what to do."""


class DraftPlan(QObject):
    """Makes and changes the plan by one :class:`PlanTask` at a time."""

    changed = pyqtSignal()
    """There is another plan, or none, or one is being made."""
    refused = pyqtSignal(str)

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self.settings: PlanSettings = settings_in(desk.project)
        self.draft: Draft | None = None
        self.task: PlanTask | None = None
        self._look, self._look_at_made = ClosureLook(self), ClosureLook(self)
        desk.roads.closures_changed.connect(self.look_at_closures)

    @property
    def busy(self) -> bool:
        """Whether a plan is being made."""
        return self.task is not None

    def make(self, *, preview: bool) -> None:
        """Plan the chosen layer's cones, quickly or well.

        :raises FleetError: naming what is missing.
        """
        frame = self._frame()
        targets, facts = read_cones(self._desk.project, self.settings, frame)
        self._make(targets, facts, frame, preview)

    def make_collecting(self, tasks: Sequence[QueueTask], *, preview: bool) -> None:
        """Plan who collects placed cones, given as the gateway's tasks; raises FleetError."""
        frame = self._frame()
        targets, facts = [], {}
        for task in tasks:
            name = f"{task.cone or task.label or 'cone'} #{task.placement}"
            targets.append(Target(name, task.x, task.y, 0.0, 0, COLLECT, 1, self.settings.service_s))
            facts[name] = ConeFacts(task.cone or name, task.layout or "", task.placement, task.theta)
        self._make(tuple(targets), facts, frame, preview)

    def move(self, target: str, robot: str, trip: int, place: int) -> None:
        """Let ``robot`` serve ``target`` as number ``place``, from 0, of its trip ``trip``."""
        self._edit(lambda plan, travel_of: editing.moved(plan, travel_of, target, robot, trip, place))

    def remove(self, target: str) -> None:
        """Let nobody serve ``target``."""
        self._edit(lambda plan, travel_of: editing.removed(plan, travel_of, target))

    def put(self, draft: Draft | None) -> None:
        """Show another plan, None for none."""
        self.cancel()
        self.draft = draft
        self.changed.emit()

    def run(
        self, title: str, ground: Draft, work: Callable[[PlanTask], Plan], then: Callable[[Draft], None]
    ) -> None:
        """Make a plan on the ground of another, beside the window's thread; ``then`` gets it."""
        if self.task is not None:
            raise PlanningError(tr("A plan is being made. Wait for it, or press Cancel."))
        apart_m, closures = self.settings.apart_m, self._desk.roads.closures
        task = PlanTask(title, lambda task: ground.with_plan(work(task), apart_m, closures))
        task.made.connect(lambda draft: self._made(task, draft, closures, then))
        task.refused.connect(lambda why: self._refused(task, why))
        task.taskTerminated.connect(lambda: self._ended(task))
        self.task = task
        QgsApplication.taskManager().addTask(task)
        self.changed.emit()

    def cancel(self) -> None:
        """Give up what is being made; the plan of before stays."""
        task, self.task = self.task, None
        if task is None:
            return
        # QGIS deletes a task that is done; what it made may still be held against roads closed meanwhile.
        if not sip.isdeleted(task):
            task.cancel()
        self.changed.emit()

    def shut_down(self) -> None:
        """Give up what is being made and wait until its thread has left it."""
        task = self.task
        self._look.stop()
        self._look_at_made.stop()
        self.cancel()
        if task is not None and not sip.isdeleted(task) and task.isActive():
            task.left.wait(10.0)

    def look_at_closures(self) -> None:
        """Find out anew what of the plan leads along closed roads."""
        draft = self.draft
        if draft is None:
            return

        def found(drafts: list[Draft]) -> None:
            # Another plan was judged when it was made.
            if self.draft is draft and drafts[0] is not draft:
                self.draft = drafts[0]
                self.changed.emit()

        self._look.begin([draft], self._desk.roads.closures, found)

    def _make(
        self, targets: tuple[Target, ...], facts: dict[str, ConeFacts], frame: SiteFrame, preview: bool
    ) -> None:
        stores = read_stores(self._desk.project, self.settings, frame)
        try:
            job = Job(targets, self._robots(), stores, self.settings.finish)
            wanted = Wanted(self.settings.objective, PREVIEW if preview else AUTOMATIC, self.settings.seconds)
        except MissingStoreError as error:
            raise PlanningError(
                tr(
                    "There is no store where robots load or unload cones: choose a layer of points under "
                    "Stores, or write under Aboard how many cones each robot has to place."
                )
            ) from error
        except AssignmentError as error:
            raise PlanningError(str(error)) from error
        ways = PlanWays(self._desk.project, frame, self.settings)
        ways.cones = self._cones_of_before({one.placement for one in facts.values()})
        ways.standing = self._standing_robots()
        blank = Draft(Plan((), (), (), "", "", "", ""), ways, facts, uuid.uuid4().hex)
        ways.closures = self._desk.roads.closures
        self.run(
            tr("Preview of the cone plan") if preview else tr("Cone plan"),
            blank,
            lambda task: assign(job, ways.travel_of(job, task.goes_on), wanted, task.told),
            self._put,
        )

    def _edit(self, change: Callable[[Plan, editing.TravelOf], Plan]) -> None:
        draft = self.draft
        if draft is not None:
            title = tr("Change of the cone plan")
            draft.ways.closures = self._desk.roads.closures
            self.run(
                title,
                draft,
                lambda task: change(draft.plan, lambda job: draft.ways.travel_of(job, task.goes_on)),
                self._put,
            )

    def _put(self, draft: Draft) -> None:
        self.draft = draft

    def _made(
        self,
        task: PlanTask,
        draft: Draft,
        closures: Sequence[ClosureReport],
        then: Callable[[Draft], None],
    ) -> None:
        if task is not self.task:
            return
        now = self._desk.roads.closures
        if now != closures:
            # Meanwhile a road was closed or opened.
            self._look_at_made.begin([draft], now, lambda found: self._made(task, found[0], now, then))
            return
        self.task = None
        then(draft)
        self.changed.emit()

    def _refused(self, task: PlanTask, why: str) -> None:
        if task is self.task:
            self.task = None
            self.changed.emit()
            self.refused.emit(why)

    def _ended(self, task: PlanTask) -> None:
        if task is self.task and task.isCanceled():
            # Cancelled in QGIS's own list of tasks.
            self.task = None
            self.changed.emit()

    def _frame(self) -> SiteFrame:
        if self._desk.site is None:
            raise PlacementError(tr("The site is not known yet. Connect to a gateway first."))
        return self._desk.placement().frame

    def _robots(self) -> tuple[Robot, ...]:
        robots = self._desk.picture.arrays(self._desk.clock())
        used = taking_part(robots, self.settings)
        if not used.any():
            raise PlanningError(
                tr("No robot that is there is chosen: tick robots in the table, or connect some.")
            )
        return tuple(
            self.settings.of_robot(robots.names[row]).robot(robots.names[row], *robots.xy[row].tolist())
            for row in self._desk.picture.by_name()
            if used[row]
        )

    def _cones_of_before(self, collected: set[int | None]) -> np.ndarray:
        """Return where cones stand that the plan does not collect, (n, 2)."""
        cones = [
            (one.x, one.y)
            for one in self._desk.placements
            if one.collected_at is None and one.placement not in collected
        ]
        return np.array(cones, dtype=float).reshape(-1, 2)

    def _standing_robots(self) -> dict[str, tuple[float, float]]:
        """Return where robots are that do not take part."""
        robots = self._desk.picture.arrays(self._desk.clock())
        stand = has_place(robots) & ~taking_part(robots, self.settings)
        return {robots.names[row]: tuple(robots.xy[row].tolist()) for row in np.flatnonzero(stand)}
