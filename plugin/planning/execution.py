"""Cone plans driven by the gateway: submitted, controlled by requests, and followed by reports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.assignment.plan import ConePlan, document_of
from ...robot_bridge.core.messages import plans
from ...robot_bridge.core.messages.base import MessageError
from ...robot_bridge.core.messages.queues import GetQueue, QueueState, TaskState
from ...robot_bridge.core.messages.records import MOST_PLACEMENTS, GetPlacements
from ..control.fleet_controller import STOPPED_BY, FleetController
from ..control.messages import PLAN_SENT, Level, Topic, plan_topic
from ..control.pending_command import in_brief
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.report_caches import KnownPlan
from ..ui.errors import NotSentError
from ..ui.language import first_of, tr
from .plan_editor import PlanEditor, PlanningError
from .plan_texts import after_sending, problem_in_words
from .proposal import PlanProposal

REPLANNING_S = 2.0
"""Greatest time for a new plan for the remainder: robots stand meanwhile."""
GATEWAY = "gateway"
"""The author of actions that nobody requested."""


@dataclass(frozen=True)
class RefusedPlan:
    """A request that the gateway carries out only with an override: its text, and all that speaks against it.

    ``plan`` is its plan, as the operator saw it.
    """

    request: plans.SubmitPlan | plans.ConfirmReplan
    words: str
    found: tuple[str, ...]
    plan: ConePlan | None


@dataclass(frozen=True)
class _PendingRequest:
    request: Any
    words: str
    plan: ConePlan | None
    done: Callable[[dict[str, Any]], None]


class PlanExecution(QObject):
    """Submits the draft on request, shows one of the plans that the gateway drives, and controls that.

    The robots' tasks are kept by the gateway only. One request at a time waits for its answer; a pause
    waits for none.
    """

    changed = pyqtSignal()
    """The plan that is shown has changed, or another one is shown."""
    hint = pyqtSignal(str)

    def __init__(self, desk: FleetController, drafts: PlanEditor, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._drafts = drafts
        self.shown: str | None = None
        """The name of the plan that is shown, None for the draft."""
        self._refusal: RefusedPlan | None = None
        self._pending: dict[str, _PendingRequest] = {}
        self._wants_draft = False
        """Whether the operator chose not to be shown plans that others submit."""
        self._cleared_here: set[str] = set()
        self._fetched: tuple[str, int] | None = None
        """The plan, and its revision, whose documents were requested on this link."""
        self._submitted_here: PlanProposal | None = None
        """The plan submitted last by this desk: it is shown until the gateway has sent it back."""
        self._release_query: tuple[str, Sequence[str]] | None = None
        """The key of the query sent after robots were released, and these robots."""
        self._reports: dict[str, plans.PlanReport] = {}
        desk.state.plans_changed.connect(self._receive_plans)
        desk.state.queues_changed.connect(self._receive_queues)
        desk.orders.answered.connect(self._answered)
        desk.state.link_changed.connect(self._link_changed)
        drafts.changed.connect(self._submitted_before)
        if known := [one.plan for one in desk.state.plans.open()]:
            self._receive_plans(known)

    @property
    def known(self) -> KnownPlan | None:
        """The last report of the plan that is shown; None while the draft is shown."""
        return self._desk.state.plans.get(self.shown)

    @property
    def shown_plan(self) -> ConePlan | None:
        """The plan to show: a new plan for the remainder, the plan that is driven, or the draft."""
        known = self.known
        if known is None:
            return None if self._drafts.draft is None else self._drafts.draft.plan
        if known.report.state is plans.PlanState.PROPOSED and known.proposal is not None:
            return known.proposal
        own = self._submitted_here
        if known.document is None and own is not None and own.name == known.plan:
            return own.plan
        return known.document

    @property
    def choice(self) -> list[KnownPlan]:
        """The plans to choose from: those that are driven, newest first, and the one that is shown."""
        found, known = self._desk.state.plans.open(), self.known
        return found if known is None or known.is_open else [known, *found]

    @property
    def asking(self) -> bool:
        """Whether a request waits for its answer; pauses do not count."""
        return any(not isinstance(one.request, plans.PausePlan) for one in self._pending.values())

    @property
    def busy(self) -> bool:
        """Whether a request or a computation is under way."""
        return self.asking or self._drafts.busy

    @property
    def refusal(self) -> RefusedPlan | None:
        """The request that needs an override, while that is not decided."""
        refusal = self._refusal
        return None if refusal is None or refusal.plan is not self.shown_plan else refusal

    @property
    def paused(self) -> list[str]:
        """Robots of a driven plan that stand with tasks left because their queues were paused.

        Not those that are away or whose cone failed: they need a new plan to continue.
        """
        known = self.known
        if known is None or known.report.state is not plans.PlanState.DRIVEN:
            return []
        away = {one.robot for one in known.report.problems if one.kind is plans.PlanProblemKind.AWAY}
        queues = [self._desk.state.queues.get(robot) for robot in known.report.robots if robot not in away]
        return [
            one.robot
            for one in queues
            if one is not None and one.state is QueueState.PAUSED and one.tasks
            and not any(task.state is TaskState.FAILED for task in one.tasks)
        ]  # fmt: skip

    @property
    def is_without_plans(self) -> bool:
        """Whether the gateway is too old to drive cone plans."""
        return self._desk.state.plans.is_driving is False

    def pauses_in_words(self) -> list[str]:
        """Return a text for each reason why robots of the plan stand still."""
        known = self.known
        if known is None:
            return []
        report, robots = known.report, {}
        if report.state is plans.PlanState.PAUSED:
            robots[": ".join(text for text in (report.by, report.reason) if text)] = report.robots
        for robot in self.paused:
            queue = self._desk.state.queues.get(robot)
            robots.setdefault(queue.reason or queue.by or "", []).append(robot)
        return [
            tr("Paused: {robots} ({why})", robots=", ".join(first_of(names)), why=why)
            for why, names in robots.items()
        ]

    # --- Requests of the operator ---

    def choose(self, name: str | None) -> None:
        """Show a plan that the gateway drives, None for the draft."""
        self.shown, self._wants_draft = name, name is None
        self._fetch()
        self.changed.emit()

    def make_room(self) -> None:
        """Show the draft, which is about to be made; raises PlanningError while a driven plan is shown."""
        known = self.known
        if known is not None and known.is_open:
            raise PlanningError(
                tr(
                    "A plan is being driven. Plan what is left, choose New plan to plan for other robots, or "
                    "press Clear: nobody follows it then, and robots go on with their queues."
                )
            )
        if known is not None:
            self.choose(None)

    def send(self) -> None:
        """Submit the draft.

        :raises FleetError: when it cannot be sent; nothing was sent then.
        """
        draft = self._drafts.draft
        if draft is None or self.known is not None or self.busy:
            raise PlanningError(tr("There is no plan to send. Make one with Preview or Solve first."))
        if self.is_without_plans:
            raise PlanningError(no_plans_here())
        self._ask(self._submission(draft), tr("Sending the cone plan"), draft.plan, self._submitted)

    def override(self, refusal: RefusedPlan, why: str) -> None:
        """Repeat the refused request with reason ``why``; PlanningError when it is no longer pending."""
        if refusal is not self.refusal or self.asking:
            raise PlanningError(
                tr("Nothing was overridden: what was refused is no longer being sent. Look at the plan.")
            )
        done = self._submitted if isinstance(refusal.request, plans.SubmitPlan) else self._continued
        self._ask(replace(refusal.request, override=why), refusal.words, refusal.plan, done)

    def pause(self) -> None:
        """Pause the plan: its robots are sent no more tasks; raises PlanningError when none is driven."""
        self._ask(plans.PausePlan(self._open().plan), tr("Pause of the cone plan"))

    def resume(self) -> None:
        """Continue the plan's robots; raises PlanningError when none is driven."""
        report = self._open().report
        request = plans.ResumePlan(report.plan, report.revision)
        self._ask(request, tr("Going on with the cone plan"), done=self._continued)

    def plan_rest(self, *, try_again: bool = False) -> None:
        """Hold the robots and plan the remainder; raises PlanningError when no plan is driven."""
        report = self._open().report
        self._ask(plans.Replan(report.plan, report.revision, try_again), tr("Plan of what is left"))

    def confirm(self) -> None:
        """Have the new plan for the remainder driven; raises PlanningError when there is none to see."""
        known = self._open()
        if known.proposal is None or not known.is_whole:
            raise PlanningError(tr("There is no new plan to confirm."))
        request = plans.ConfirmReplan(known.plan, known.report.revision)
        self._ask(request, tr("The new cone plan"), known.proposal, self._continued)

    def discard(self) -> None:
        """Discard the new plan, or cancel its computation; robots that were held continue as before."""
        report = self._open().report
        self._ask(plans.DiscardReplan(report.plan, report.revision), tr("Going on as before"))

    def clear(self) -> None:
        """Stop following the plan that is shown, or hide an ended one; drop the draft."""
        known = self.known
        if known is not None and known.is_open:
            self._cleared_here.add(known.plan)
            self._ask(plans.ClearPlan(known.plan), tr("Clearing the cone plan"))
            return
        self._show_nothing(wants_draft=True)

    def forget(self) -> None:
        """Forget the plan or draft that is shown: it belongs to another site."""
        self._reports.clear()
        self._show_nothing(wants_draft=False)

    def _show_nothing(self, *, wants_draft: bool) -> None:
        self._desk.messages.end(PLAN_SENT)
        self.shown, self._refusal, self._wants_draft = None, None, wants_draft
        self._drafts.set_proposal(None)
        self.changed.emit()

    def _open(self) -> KnownPlan:
        known = self.known
        if known is None or not known.is_open:
            raise PlanningError(tr("No plan is being driven, or something is still being sent."))
        return known

    def _submission(self, draft: PlanProposal) -> plans.SubmitPlan:
        settings, ground = self._drafts.settings, draft.ways.settings
        driving = [one.robot.id for one in draft.plan.robots if one.stops]
        try:
            return plans.SubmitPlan(
                draft.name,
                document_of(draft.plan),
                [
                    plans.PlanCone(target, one.cone, one.layout, one.placement, one.theta)
                    for target, one in draft.facts.items()
                ],
                {robot: self._desk.state.queues.revision(robot) for robot in driving},
                [(x, y) for x, y in draft.ways.cones.tolist()],
                on_roads=ground.on_roads,
                direct_m=ground.direct_m,
                clearance_m=ground.clearance_m,
                apart_m=ground.apart_m,
                seconds=min(settings.seconds, REPLANNING_S),
                by_itself=settings.by_itself,
            )
        except MessageError as error:
            raise PlanningError(tr("The plan cannot be sent: {error}", error=error)) from error

    def _ask(
        self,
        request: Any,
        words: str,
        plan: ConePlan | None = None,
        done: Callable[[dict[str, Any]], None] = lambda result: None,
    ) -> None:
        if self.asking and not isinstance(request, plans.PausePlan):
            raise PlanningError(tr("No plan is being driven, or something is still being sent."))
        key = self._desk.orders.ask(request, words, PLAN_SENT)
        # Only now: if the request could not be sent, the refused one can still be overridden.
        self._desk.messages.end(PLAN_SENT)
        self._refusal = None
        self._pending[key] = _PendingRequest(request, words, plan, done)
        self.changed.emit()

    def _answered(self, answer: RequestResult) -> None:
        pending = self._pending.pop(answer.order.key, None)
        if pending is None:
            self._report_who_stays(answer.order.key)
            return
        if answer.error is None:
            pending.done(answer.result or {})
        elif answer.overridable:
            found = tuple(f"{text}." for text in answer.overridable)
            self._refusal = RefusedPlan(pending.request, pending.words, found, pending.plan)
            # A single text that says where it is decided replaces the one that every refusal brings.
            self._desk.messages.withdraw(f"{pending.words}: {answer.error}")
            self._fail(_in_words(self._refusal))
        if isinstance(pending.request, plans.ClearPlan):
            self._cleared_here.discard(pending.request.plan)
        self.changed.emit()

    def _submitted(self, result: dict[str, Any]) -> None:
        self.hint.emit(tr("The cone plan is in the robots' queues."))

    def _continued(self, result: dict[str, Any]) -> None:
        """Query the queues: their reports may arrive after the answer that continued them."""
        known = self._desk.state.plans.get(result.get("plan"))
        if known is None:
            return
        with suppress(NotSentError):
            self._release_query = (self._desk.orders.inquire(GetQueue()), known.report.robots)

    def _report_who_stays(self, key: str) -> None:
        if self._release_query is not None and key == self._release_query[0]:
            robots, self._release_query = self._release_query[1], None
            for text in after_sending(self._desk, robots):
                self._fail(text)

    def _fail(self, text: str) -> None:
        self._desk.report_failure(text, PLAN_SENT)

    # --- Reports of the gateway ---

    def _link_changed(self) -> None:
        if self._desk.state.link.phase is ConnectionPhase.CONNECTED:
            self._fetched = None
            self._fetch()

    def _receive_queues(self, robots: Sequence[str]) -> None:
        known = self.known
        if known is not None and not set(robots).isdisjoint(known.report.robots):
            # They may have been paused or continued.
            self.changed.emit()

    def _receive_plans(self, names: Sequence[str]) -> None:
        for name in names:
            self._notice(name)
        self._submitted_before()
        known = self.known
        if known is not None and known.report.state is plans.PlanState.CLEARED:
            self._leave_cleared(known.report)
        elif known is None:
            self._show_newest()
        self._fetch()
        self.changed.emit()

    def _submitted_before(self) -> None:
        """Show the gateway's copy of the draft in its place, even if the answer to its submission is lost."""
        draft = self._drafts.draft
        if draft is not None and self._desk.state.plans.get(draft.name) is not None:
            self.shown, self._wants_draft, self._refusal = draft.name, False, None
            self._submitted_here = draft
            self._fetch()
            self._drafts.drop(draft)

    def _show_newest(self) -> None:
        self.shown = None
        newest = next(iter(self._desk.state.plans.open()), None)
        if newest is not None and self._drafts.draft is None and not (self._drafts.busy or self._wants_draft):
            self.shown = newest.plan

    def _leave_cleared(self, report: plans.PlanReport) -> None:
        self.shown, self._wants_draft = None, True
        if report.plan not in self._cleared_here:
            text = tr(
                "{by} cleared the cone plan: nobody follows it any more, and robots go on with their queues.",
                by=report.by,
            )
            self._desk.messages.post(text, Level.WARNING, PLAN_SENT)

    def _fetch(self) -> None:
        """Request the documents of the plan that is shown, unless they belong to its last report."""
        known = self.known
        if known is None or known.is_whole or self._fetched == (known.plan, known.report.revision):
            return
        is_another = self._fetched is None or self._fetched[0] != known.plan
        try:
            self._desk.orders.inquire(plans.GetPlans(known.plan, documents=True))
            if is_another:
                self._desk.orders.inquire(GetPlacements(plan=known.plan, limit=MOST_PLACEMENTS))
        except NotSentError:
            # It is requested once the link is back.
            return
        self._fetched = (known.plan, known.report.revision)

    # --- Messages about plans, shown or not ---

    def _notice(self, name: str) -> None:
        known, before = self._desk.state.plans.get(name), self._reports.pop(name, None)
        trouble, by_itself = plan_topic(name, "trouble"), plan_topic(name, "unasked")
        if known is None or not known.is_open:
            self._desk.messages.end(trouble, by_itself)
            return
        report = self._reports[name] = known.report
        if before is None or before.problems != report.problems:
            self._desk.messages.end(trouble)
            if report.problems:
                why = problem_in_words(report.problems)
                text = tr("The cone plan cannot go on as it is: {why}. Plan what is left.", why=why)
                self._desk.report_failure(text, trouble)
        if before is not None and before.revision != report.revision:
            self._desk.messages.end(by_itself)
            if report.by == GATEWAY and report.reason and STOPPED_BY not in report.reason:
                self._notice_gateway(before.state, report, by_itself)

    def _notice_gateway(self, before: plans.PlanState, report: plans.PlanReport, topic: Topic) -> None:
        """Report the gateway's own actions on a plan."""
        why = report.reason
        if report.state is plans.PlanState.PAUSED:
            self._desk.report_failure(tr("The cone plan is paused: {why}.", why=why), topic)
        elif report.state is plans.PlanState.DRIVEN and not report.problems:
            self.hint.emit(tr("A new plan was sent by itself, as was switched on: {why}", why=why))
        elif report.state is before:
            self._desk.report_failure(tr("No new cone plan was sent by itself: {why}.", why=why), topic)


def no_plans_here() -> str:
    """Return the message where the gateway does not support cone plans."""
    return tr(
        "The gateway is older than this plugin and drives no cone plans: plans are made and looked at here, "
        "and nothing of them is sent. Update the gateway, or give robots their cones with Add to queue."
    )


def _in_words(refusal: RefusedPlan) -> str:
    return tr(
        "The cone plan was not sent. {words}: {found} Override… in the panel Cone plan sends it all the "
        "same, where your role may.",
        words=refusal.words,
        found=in_brief(refusal.found),
    )
