"""The plan that robots drive: sent, followed, and planned anew for what is left when something goes wrong."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.assignment.plan import Plan
from ....robot_bridge.assignment.replanning import replan
from ....robot_bridge.assignment.solving import Wanted
from ....robot_bridge.messages import GetPlacements, MessageError, QueueTask, TaskState
from ...errors import FleetError
from ...language import tr
from ..desk import Desk
from ..placement_book import MOST_ASKED
from .available_robots import has_place
from .closure_look import ClosureLook
from .draft import Draft
from .draft_plan import DraftPlan, PlanningError
from .progress import Progress, Trouble, behind, cones_under_way, situation_of, trouble_of, under_way
from .sending import (
    Sending,
    Step,
    first_steps,
    going_on_steps,
    has_failed,
    holding_steps,
    later_steps,
    paused_at,
)
from .sending_check import after_sending
from .task_rows import SentStop, sent_stops, tasks_of

_REPLANNING_S = 2.0
"""How long a new plan for what is left may take at most: robots stand meanwhile."""


class DrivenPlan(QObject):
    """Sends the draft when told to, and watches what becomes of it. Robots are never sent by it unasked,
    unless ``settings.by_itself`` says so."""

    changed = pyqtSignal()
    """Something new is known of the plan that is driven."""
    failed = pyqtSignal(str)
    remarked = pyqtSignal(str)
    settled = pyqtSignal(str)
    """What ``failed`` told with this text is over."""

    def __init__(self, desk: Desk, drafts: DraftPlan, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._drafts = drafts
        self.driven: Draft | None = None
        self.progress: Progress | None = None
        self.offer: Draft | None = None
        """A new plan for what is left, that nobody confirmed yet."""
        self.trouble = Trouble()
        self.sending: Sending | None = None
        self.held: dict[str, float | None] = {}
        """Robots that wait for the new plan, with the time since which their queues are paused for that."""
        self._dealt_with = Trouble()
        self._complaints: list[str] = []
        self._look_at_closures = ClosureLook(self)
        desk.roads.closures_changed.connect(self._take_closures)
        desk.queues_changed.connect(self._take_queues)
        desk.placements_changed.connect(self._take_placements)
        desk.link_changed.connect(self._ask_for_placements)

    @property
    def busy(self) -> bool:
        """Whether something is being sent or planned."""
        return self.sending is not None or self._drafts.busy

    def send(self) -> None:
        """Send the draft to the robots' queues.

        :raises FleetError: when it cannot be sent; nothing was sent then.
        """
        draft = self._drafts.draft
        if draft is None or self.busy:
            raise PlanningError(tr("There is no plan to send. Make one with Preview or Solve first."))
        self._check_no_emergency()
        tasks = _tasks(draft)
        self.progress = Progress(draft.name, draft.facts, time.time())
        self._note(draft.plan, tasks)
        self.driven, self.offer, self.held = draft, None, {}
        self.trouble = self._dealt_with = Trouble()
        self._settle()
        self._start(first_steps(self._desk, tasks), self._sent)
        if self._desk.roads.closures:
            # The draft may not have been looked at yet since they were closed.
            self._take_closures()

    def plan_rest(self, *, try_again: bool = False) -> None:
        """Hold the robots and plan what is left; :meth:`confirm` sends it, :meth:`discard` lets them go on.

        :raises PlanningError: when no plan is driven, or nobody is left to drive.
        """
        if self.driven is None or self.progress is None or self.busy:
            raise PlanningError(tr("No plan is being driven, or something is still being sent."))
        self._check_no_emergency()
        staying = [
            one.robot.id
            for one in self.driven.plan.robots
            if not one.lost and one.robot.id not in self.trouble.away
        ]
        if not staying:
            raise PlanningError(tr("No robot is left to take over: connect one, and plan anew."))
        trouble = self._dealt_with = self.trouble
        reason = (
            tr(
                "plan of what is left: {in_words}",
                in_words=trouble.in_words(),
            )[:200]
            if trouble
            else tr("plan of what is left")
        )
        paused = {robot for robot in paused_at(self._desk, staying) if not has_failed(self._desk, robot)}
        ours = [robot for robot in staying if robot not in paused]

        def held(done: bool) -> None:
            self.held = paused_at(self._desk, ours)
            if done:
                self._plan_rest(trouble, try_again)

        self._start(holding_steps(ours, reason), held)

    def confirm(self) -> None:
        """Send the new plan for what is left; raises PlanningError when there is none."""
        offer, progress = self.offer, self.progress
        if offer is None or progress is None or self.busy:
            raise PlanningError(tr("There is no new plan to confirm."))
        self._check_no_emergency()
        given_up = offer.plan.done - progress.done - cones_under_way(progress)
        if given_up:
            raise PlanningError(
                tr(
                    "Cone {cones} was given up since this plan was made: plan what is left again.",
                    cones=", ".join(sorted(given_up)),
                )
            )
        tasks = _tasks(offer, under_way(progress))
        away = [one.robot.id for one in offer.plan.robots if one.lost]
        progress.forget(
            task
            for task in list(progress.stops)
            if task not in progress.reports
            or progress.reports[task].state not in (TaskState.DONE, TaskState.CURRENT)
            or progress.stops[task].robot in away
        )
        self._note(offer.plan, tasks)
        held, self.held = self.held, {}
        self.driven, self.offer = offer, None
        self._settle()
        self._start(later_steps(self._desk, tasks, away, held, tr("its robot is lost")), self._sent)

    def discard(self) -> None:
        """Forget the new plan; robots that were held go on as before."""
        held, self.offer, self.held = self.held, None, {}
        self._drafts.cancel()
        self._start(going_on_steps(self._desk, held), lambda done: None)

    def shut_down(self) -> None:
        """Look at nothing any more."""
        self._look_at_closures.stop()

    def clear(self) -> None:
        """Watch no plan any more; robots go on with what is in their queues."""
        self.driven = self.progress = self.offer = None
        self.trouble, self.held = Trouble(), {}
        self._settle()
        self.changed.emit()

    # --- what becomes of it ---

    def _plan_rest(self, trouble: Trouble, try_again: bool) -> None:
        driven, progress = self.driven, self.progress
        robots = self._desk.picture.arrays(self._desk.clock())
        places = {
            robots.names[row]: tuple(robots.xy[row].tolist()) for row in np.flatnonzero(has_place(robots))
        }
        drive = {one.robot.id for one in driven.plan.robots if not one.lost} - set(trouble.away)
        placed = [(one.x, one.y) for one in progress.placed.values() if one.collected_at is None]
        driven.ways.closures = self._desk.roads.closures
        driven.ways.cones = np.array([*driven.ways.cones, *placed], dtype=float).reshape(-1, 2)
        driven.ways.standing = {name: place for name, place in places.items() if name not in drive}
        now = situation_of(driven.plan, progress, places, trouble, time.time(), try_again=try_again)
        wanted = Wanted(driven.plan.objective, time_limit_s=min(self._drafts.settings.seconds, _REPLANNING_S))
        self._drafts.run(
            tr("Plan of what is left"),
            driven,
            lambda task: replan(
                driven.plan, lambda job: driven.ways.travel_of(job, task.goes_on), now, wanted, task.told
            ),
            self._offer,
        )

    def _offer(self, offer: Draft) -> None:
        self.offer = offer
        self.changed.emit()
        if self._drafts.settings.by_itself and not offer.meetings and not offer.closed:
            why = self._dealt_with.in_words()
            self.remarked.emit(tr("A new plan is sent by itself, as you switched on: {why}", why=why))
            # What made the plan is still telling of it.
            self._drafts.changed.connect(self._confirm_once)

    def _confirm_once(self) -> None:
        self._drafts.changed.disconnect(self._confirm_once)
        if self.offer is None:
            return
        try:
            self.confirm()
        except FleetError as error:
            self.failed.emit(str(error))

    def _take_queues(self, robots: Sequence[str]) -> None:
        if self.progress is None or self.driven is None:
            return
        for robot in robots:
            report = self._desk.queues.get(robot)
            if report is not None:
                self.progress.take_queue(report)
        self._look()

    def _take_placements(self, numbers: Sequence[int]) -> None:
        if self.progress is None:
            return
        new = set(numbers)
        for report in self._desk.placements:
            if report.placement in new:
                self.progress.take_placement(report)
        self._look()

    def _take_closures(self) -> None:
        """Find out anew which ways are closed, of the plan that is driven and of the one that is offered."""
        if self.progress is None or self.driven is None:
            return
        drafts = [self.driven] if self.offer is None else [self.driven, self.offer]
        closures = self._desk.roads.closures
        self._look_at_closures.begin(drafts, closures, lambda found: self._judged(drafts, found))

    def _judged(self, before: list[Draft], after: list[Draft]) -> None:
        """Put drafts in place of those ``before`` them, where these are still driven or offered."""
        if self.progress is None or self.driven is None:
            return
        for old, new in zip(before, after, strict=True):
            if self.driven is old:
                self.driven = new
            if self.offer is old:
                self.offer = new
        self._look()

    def _look(self) -> None:
        """Find out what is wrong, and tell of what was not wrong before."""
        plan, queues = self.driven.plan, {one.robot: one for one in self._desk.queues}
        made = {id(stop) for stop in behind(self.progress)}
        closed = tuple(one for one in self.driven.closed if id(one.at) not in made)
        before, self.trouble = self.trouble, trouble_of(plan, self.progress, queues, closed)
        self.changed.emit()
        if not self.trouble:
            self._settle()
        if not self.trouble or self.trouble == self._dealt_with:
            return
        if self.trouble != before:
            why = self.trouble.in_words()
            self._complain(tr("The cone plan cannot go on as it is: {why}. Plan what is left.", why=why))
        if self._drafts.settings.by_itself and self.offer is None and not self.busy:
            # Tried once: what cannot be planned is told once, and is the operator's from then on.
            self._dealt_with = self.trouble
            try:
                self.plan_rest()
            except FleetError as error:
                self.failed.emit(str(error))

    def _complain(self, text: str) -> None:
        """Tell what a new plan is to mend: it hangs there until one was agreed to, and no longer."""
        self._settle()
        self._complaints.append(text)
        self.failed.emit(text)

    def _settle(self) -> None:
        for text in self._complaints:
            self.settled.emit(text)
        self._complaints.clear()

    def _ask_for_placements(self) -> None:
        """Ask for what was put down while this desk was not connected."""
        if self.progress is None or self._desk.link.phase.value != "connected":
            return
        request = GetPlacements(plan=self.progress.name, limit=MOST_ASKED)
        self._desk.ask(request, tr("Placed cones of the plan"))

    def _check_no_emergency(self) -> None:
        stop = self._desk.emergency
        if stop is not None and stop.in_force:
            raise PlanningError(tr("An emergency stop is in force. It has to be cleared first."))

    def _note(self, plan: Plan, tasks: dict[str, list[QueueTask]]) -> None:
        for one in plan.robots:
            if one.robot.id in tasks:
                self.progress.sent(sent_stops(one, tasks[one.robot.id]))

    def _start(self, steps: list[Step], then: Callable[[bool], None]) -> None:
        self.sending = sending = Sending(self._desk, steps, self)

        def ended(done: bool, why: str) -> None:
            self.sending = None
            sending.deleteLater()
            if not done:
                self.failed.emit(tr("The cone plan was not sent as a whole. {why}", why=why))
            then(done)
            self.changed.emit()

        sending.ended.connect(ended)
        self.changed.emit()
        sending.start()

    def _sent(self, done: bool) -> None:
        if done:
            self.remarked.emit(tr("The cone plan is in the robots' queues."))
            for text in after_sending(self._desk, self.driven.plan):
                self.failed.emit(text)
        self._take_queues([one.robot for one in self._desk.queues])


def _tasks(draft: Draft, now: Mapping[str, SentStop] | None = None) -> dict[str, list[QueueTask]]:
    try:
        return tasks_of(draft.plan, draft.name, draft.facts, under_way=now)
    except MessageError as error:
        raise PlanningError(tr("The plan cannot be sent: {error}", error=error)) from error
