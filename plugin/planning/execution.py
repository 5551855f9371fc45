"""The plan that robots drive: sent, and planned anew for what is left when something goes wrong."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

import numpy as np
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment.plan_changes import replan
from ...robot_bridge.core.assignment.progress import (
    PlanProblem,
    PlanProgress,
    SentStop,
    current_cones,
    current_stops,
    situation_of,
    tasks_of,
)
from ...robot_bridge.core.assignment.solver import Objective
from ...robot_bridge.core.messages import MessageError, QueueTask
from ..control.fleet_controller import FleetController
from ..control.messages import PLAN_ASKED, PLAN_SENT
from ..control.pending_command import in_brief
from ..ui.errors import FleetError
from ..ui.language import first_of, tr
from .plan_editor import PlanEditor, PlanningError
from .plan_settings import have_position
from .plan_views import after_sending
from .progress import PlanMonitor, problem_in_words
from .proposal import ClosureCheck, PlanProposal
from .queue_steps import (
    QueueRequests,
    QueueStep,
    RefusedStep,
    continuing_steps,
    first_steps,
    has_failed,
    holding_steps,
    later_steps,
    paused_at,
)

_REPLANNING_S = 2.0
"""How long a new plan for what is left may take at most: robots stand meanwhile."""
_LONGEST_REASON = 200
"""Characters of the reason that a pause is given."""


class PlanExecution(QObject):
    """Sends the draft when told to, and new plans for what is left of it. Robots are never sent by it
    unasked, unless ``settings.by_itself`` says so."""

    changed = pyqtSignal()
    """Something new is known of the plan that is driven."""
    remarked = pyqtSignal(str)

    def __init__(self, desk: FleetController, drafts: PlanEditor, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._drafts = drafts
        self.offer: PlanProposal | None = None
        """A new plan for what is left, that nobody confirmed yet."""
        self.sending: QueueRequests | None = None
        self.held: dict[str, float | None] = {}
        """Robots that wait for the new plan, with the time since which their queues are paused for that."""
        self._followed = PlanMonitor(desk, self)
        self._followed.changed.connect(self.changed)
        self._followed.troubled.connect(self._plan_rest_by_itself)
        self._look_at_offer = ClosureCheck(self)
        desk.roads.closures_changed.connect(self._take_closures)

    @property
    def driven(self) -> PlanProposal | None:
        """The plan that robots drive, None while none is followed."""
        return self._followed.draft

    @property
    def progress(self) -> PlanProgress | None:
        """How far the robots are, None while no plan is followed."""
        return self._followed.progress

    @property
    def trouble(self) -> PlanProblem:
        """What keeps the plan from going on as it is."""
        return self._followed.trouble

    @property
    def paused(self) -> dict[str, float | None]:
        """Robots that stand still with work to do because somebody paused their queues, and since when.

        Not those that are held for a new plan, nor those that are away or whose cone failed: it takes a new
        plan to let these go on.
        """
        if self.driven is None or self.held:
            return {}
        away = self.trouble.away
        ours = [one.robot.id for one in self.driven.plan.robots if not one.lost and one.robot.id not in away]
        return {
            robot: moment
            for robot, moment in paused_at(self._desk, ours).items()
            if self._desk.state.queues.get(robot).tasks and not has_failed(self._desk, robot)
        }

    def pauses_in_words(self) -> list[str]:
        """Return a text for each reason why robots are :attr:`paused`."""
        reports = [self._desk.state.queues.get(robot) for robot in self.paused]
        robots: dict[str, list[str]] = {}
        for one in reports:
            robots.setdefault(one.reason or one.by or "", []).append(one.robot)
        return [
            tr("Paused: {robots} ({why})", robots=", ".join(first_of(names)), why=why)
            for why, names in robots.items()
        ]

    @property
    def busy(self) -> bool:
        """Whether something is being sent or planned."""
        return self.sending is not None or self._drafts.busy

    @property
    def refusal(self) -> RefusedStep | None:
        """What the gateway sends with an override alone, while that is not decided."""
        return None if self.sending is None else self.sending.refusal

    def send(self) -> None:
        """Send the draft to the robots' queues.

        :raises FleetError: when it cannot be sent; nothing was sent then.
        """
        draft = self._drafts.draft
        if draft is None or self.busy:
            raise PlanningError(tr("There is no plan to send. Make one with Preview or Solve first."))
        self._check_no_emergency()
        tasks = _tasks(draft)
        self.offer, self.held = None, {}
        self._followed.begin(draft, tasks)
        self._start(first_steps(self._desk, tasks), self._sent)
        self._look_at_what_is_sent()

    def override(self, refusal: RefusedStep, why: str) -> None:
        """Send what was refused all the same, and then the rest of the plan.

        :raises PlanningError: when that is decided by now, or an emergency stop is in force.
        """
        if refusal is not self.refusal:
            raise PlanningError(
                tr("Nothing was overridden: what was refused is no longer being sent. Look at the plan.")
            )
        self._check_no_emergency()
        self._desk.messages.end(PLAN_SENT)
        self.sending.override(why)
        self.changed.emit()

    def leave(self) -> None:
        """Send no more of the plan than robots have by now; raises PlanningError if nothing is refused."""
        if self.refusal is None:
            raise PlanningError(tr("Nothing of the plan waits to be overridden."))
        self._desk.messages.end(PLAN_SENT)
        self.sending.leave()

    def plan_rest(self, *, try_again: bool = False) -> None:
        """Hold the robots and plan what is left; :meth:`confirm` sends it, :meth:`discard` lets them go on.

        :raises PlanningError: when no plan is driven, or nobody is left to drive.
        """
        if self.driven is None or self.busy:
            raise PlanningError(tr("No plan is being driven, or something is still being sent."))
        self._check_no_emergency()
        robots = self.driven.plan.robots
        staying = [one.robot.id for one in robots if not one.lost and one.robot.id not in self.trouble.away]
        if not staying:
            raise PlanningError(tr("No robot is left to take over: connect one, and plan anew."))
        trouble = self._followed.see_to()
        paused = {robot for robot in paused_at(self._desk, staying) if not has_failed(self._desk, robot)}
        ours = [robot for robot in staying if robot not in paused]

        def held(done: bool) -> None:
            self.held = paused_at(self._desk, ours)
            if done:
                self._plan_rest(trouble, try_again)

        self._start(holding_steps(ours, _reason(trouble)), held)

    def confirm(self) -> None:
        """Send the new plan for what is left; raises PlanningError when there is none."""
        offer, progress = self.offer, self.progress
        if offer is None or progress is None or self.busy:
            raise PlanningError(tr("There is no new plan to confirm."))
        self._check_no_emergency()
        given_up = offer.plan.done - progress.done - current_cones(progress)
        if given_up:
            raise PlanningError(
                tr(
                    "Given up since this plan was made: {cones}. Plan what is left again.",
                    cones=", ".join(first_of(sorted(given_up))),
                )
            )
        tasks = _tasks(offer, current_stops(progress))
        away = [one.robot.id for one in offer.plan.robots if one.lost]
        held, self.held, self.offer = self.held, {}, None
        self._followed.go_on(offer, tasks)
        self._start(later_steps(self._desk, tasks, away, held, tr("its robot is lost")), self._sent)
        self._look_at_what_is_sent()

    def discard(self) -> None:
        """Forget the new plan; robots that were held go on as before."""
        held, self.offer, self.held = self.held, None, {}
        self._drafts.cancel()
        self._start(continuing_steps(self._desk, held), lambda done: None)

    def resume(self) -> None:
        """Let the robots go on that are :attr:`paused`.

        :raises PlanningError: when there are none, or an emergency stop is in force.
        """
        paused = self.paused
        if not paused or self.busy:
            raise PlanningError(tr("No queue of the plan is paused, or something is still being sent."))
        self._check_no_emergency()
        self._start(continuing_steps(self._desk, paused), lambda done: None)

    def clear(self) -> None:
        """Watch no plan any more, and send no more of it; robots go on with what is in their queues."""
        self._desk.messages.end(PLAN_SENT)
        if self.sending is not None:
            self.sending.give_up()
            self._forget_sending()
        self.offer, self.held = None, {}
        self._followed.clear()
        self.changed.emit()

    def shut_down(self) -> None:
        """Look at nothing any more."""
        self._look_at_offer.stop()
        self._followed.shut_down()

    # --- what is left of it ---

    def _plan_rest(self, trouble: PlanProblem, try_again: bool) -> None:
        driven, progress = self.driven, self.progress
        robots = self._desk.state.robots.arrays(self._desk.clock.steady())
        places = {
            robots.names[row]: tuple(robots.xy[row].tolist()) for row in np.flatnonzero(have_position(robots))
        }
        drive = {one.robot.id for one in driven.plan.robots if not one.lost} - set(trouble.away)
        placed = [(one.x, one.y) for one in progress.placed.values() if one.collected_at is None]
        driven.ways.closures = self._desk.roads.closures
        driven.ways.cones = np.array([*driven.ways.cones, *placed], dtype=float).reshape(-1, 2)
        driven.ways.standing = {name: place for name, place in places.items() if name not in drive}
        now = situation_of(driven.plan, progress, places, trouble, time.time(), try_again=try_again)
        wanted = Objective(
            driven.plan.objective, time_limit_s=min(self._drafts.settings.seconds, _REPLANNING_S)
        )
        self._drafts.run(
            tr("Plan of what is left"),
            driven,
            lambda task: replan(
                driven.plan, lambda job: driven.ways.travel_of(job, task.goes_on), now, wanted, task.told
            ),
            self._offer,
        )

    def _offer(self, offer: PlanProposal) -> None:
        self.offer = offer
        self.changed.emit()
        if self._drafts.settings.by_itself and not offer.meetings and not offer.closed:
            why = problem_in_words(self._followed.seen_to)
            self.remarked.emit(tr("A new plan is sent by itself, as you switched on: {why}", why=why))
            # What made the plan is still telling of it.
            self._drafts.changed.connect(self._confirm_once)

    def _confirm_once(self) -> None:
        self._drafts.changed.disconnect(self._confirm_once)
        if self.offer is not None:
            self._try(self.confirm)

    def _plan_rest_by_itself(self) -> None:
        if self._drafts.settings.by_itself and self.offer is None and not self.busy:
            # Tried once: what cannot be planned is told once, and is the operator's from then on.
            self._followed.see_to()
            self._try(self.plan_rest)

    def _look_at_what_is_sent(self) -> None:
        """Find out which ways lead along closed roads: that may not be known yet of roads closed just now."""
        if self._desk.roads.closures:
            self._followed.look_at_closures()

    def _take_closures(self) -> None:
        """Find out anew which ways of the new plan lead along closed roads."""
        offer = self.offer
        if offer is None:
            return

        def found(drafts: list[PlanProposal]) -> None:
            if self.offer is offer:
                self.offer = drafts[0]
                self.changed.emit()

        self._look_at_offer.begin([offer], self._desk.roads.closures, found)

    # --- how it is sent ---

    def _check_no_emergency(self) -> None:
        stop = self._desk.state.emergency
        if stop is not None and stop.in_force:
            raise PlanningError(tr("An emergency stop is in force. It has to be cleared first."))

    def _start(self, steps: list[QueueStep], then: Callable[[bool], None]) -> None:
        self.sending = sending = QueueRequests(self._desk, steps, self)
        self._desk.messages.end(PLAN_SENT)

        def ended(done: bool, why: str) -> None:
            self._forget_sending()
            if not done:
                self._fail(tr("The cone plan was not sent as a whole. {why}", why=why))
            then(done)
            self.changed.emit()

        sending.ended.connect(ended)
        sending.refused.connect(self._refused)
        self.changed.emit()
        sending.start()

    def _refused(self) -> None:
        # One text that says where it is decided, in place of the one that every refusal brings.
        self._desk.messages.withdraw(self.refusal.told)
        self._fail(_in_words(self.refusal))
        self.changed.emit()

    def _forget_sending(self) -> None:
        sending, self.sending = self.sending, None
        sending.deleteLater()

    def _sent(self, done: bool) -> None:
        if done:
            self.remarked.emit(tr("The cone plan is in the robots' queues."))
            for text in after_sending(self._desk, self.driven.plan):
                self._fail(text)
        self._followed.look_at_queues()

    def _try(self, action: Callable[[], None]) -> None:
        try:
            action()
        except FleetError as error:
            self._desk.report_failure(str(error), PLAN_ASKED)

    def _fail(self, text: str) -> None:
        self._desk.report_failure(text, PLAN_SENT)


def _in_words(refusal: RefusedStep) -> str:
    return tr(
        "The cone plan is not sent any further. {words}: {found} Override… in the panel Cone plan sends it "
        "all the same, where your role may.",
        words=refusal.words,
        found=in_brief(refusal.found),
    )


def _reason(trouble: PlanProblem) -> str:
    """Return why robots are held, for their queues."""
    if not trouble:
        return tr("plan of what is left")
    return tr("plan of what is left: {in_words}", in_words=problem_in_words(trouble))[:_LONGEST_REASON]


def _tasks(draft: PlanProposal, now: Mapping[str, SentStop] | None = None) -> dict[str, list[QueueTask]]:
    try:
        return tasks_of(draft.plan, draft.name, draft.facts, under_way=now)
    except MessageError as error:
        raise PlanningError(tr("The plan cannot be sent: {error}", error=error)) from error
