"""The operator's desk: fleet state, selection and requests; the parts on screen listen to it."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from qgis.core import QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.messages.queues import PauseRobot
from ...robot_bridge.core.messages.roads import ReplannedRobot
from ...robot_bridge.core.reconnection import FleetGateways
from ..gateway_client.connection import ConnectionThread
from ..gateway_client.connection_status import ConnectionPhase, OperatorCredentials
from ..gateway_client.fleet_state import FleetState
from ..gateway_client.robot_states import RemovedRobots
from ..layers.site_transform import SiteToCanvas
from ..ui.errors import FleetError, NotSentError, Removal, remove_all
from ..ui.language import tr
from ..ui.scheduling import UpdateScheduler
from . import messages
from .command_checks import CommandChecks
from .messages import Level, LinkNotices, MessageBoard, MessageEndings, ReportNotices, SuspensionNotices
from .pending_command import ROUTE, PendingCommand, PendingCommandModel, Point, in_brief
from .request_tracker import RequestSender, RequestTracker, RoadStatus
from .route_queries import RouteQuery
from .sending import CommandSender
from .validation import TargetRoutes, ValidationRunner
from .view_subscription import RobotSearch, ViewSubscription

STOPPED_BY = "emergency stop"
"""Text in a gateway's refusal where an emergency stop is the reason."""


class Selection(QObject):
    """The robots that the operator has selected, without duplicates, in order of selection."""

    changed = pyqtSignal()

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self.robots: tuple[str, ...] = ()

    @property
    def last(self) -> str | None:
        """The robot that drafts are made for: the last one selected. None without a selection."""
        return self.robots[-1] if self.robots else None

    def select(self, robot: str | None) -> None:
        """Select one robot alone, None for none."""
        self.select_all([] if robot is None else [robot])

    def select_all(self, robots: Iterable[str]) -> None:
        """Select these robots and no others; the last of them is the one that drafts are made for."""
        selection = tuple(dict.fromkeys(robots))
        if selection != self.robots:
            self.robots = selection
            self.changed.emit()


class FleetController(QObject):
    """Builds the parts that draw, check and send commands, and does what the operator asks for."""

    emergency_changed = pyqtSignal()
    """An emergency stop was requested, or the gateway reported its state."""
    failed = pyqtSignal(str)
    """A request was not carried out: the text must be seen by the operator."""
    resolved = pyqtSignal(str)
    """The failure reported with this text is over: the message can be removed."""
    warning = pyqtSignal(str)
    """A text that the operator needs in order to continue."""
    info = pyqtSignal(str)
    """A minor outcome: a text shown for a while, whatever else is shown about drafts."""
    hint = pyqtSignal(str)
    """An optional text shown in the place for texts about drafts, while there is none."""

    def __init__(
        self,
        canvas: QgsMapCanvas,
        project: QgsProject,
        parent: QObject | None = None,
        clock: Clock | None = None,
    ):
        super().__init__(parent)
        self.canvas = canvas
        self.project = project
        self.clock = clock = Clock() if clock is None else clock
        self.beat = UpdateScheduler()
        self.connection = ConnectionThread(self)
        self.state = state = FleetState(self.connection, clock, self)
        self.site_to_canvas = SiteToCanvas(state, canvas, project)
        self.messages = MessageBoard(self)
        self.drafts = PendingCommandModel(self)
        self.sender = RequestSender(self.connection, state, self)
        self.orders = RequestTracker(self.sender, clock, self)
        self.preview = RouteQuery(self.sender, clock, self)
        self.roads = RoadStatus(state, self.orders, self)
        self._endings = MessageEndings(self.messages, self.drafts, state, self)
        self._suspensions = SuspensionNotices(self)
        self._links = LinkNotices(self)
        self._site_problem = ReportNotices(self)
        self.selection = Selection(self)
        self.view = ViewSubscription(
            canvas, state, self.site_to_canvas, self.drafts, self.sender, clock, self
        )
        self.search = RobotSearch("robots", state, self.sender, self)
        self.selection.changed.connect(lambda: self.view.select(self.selection.robots))
        self._rules = CommandChecks(project, self.site_to_canvas, state, self)
        self.checks = ValidationRunner(self.drafts, self._rules.check_command, self)
        self.checks.found.connect(self._found)
        self.drafts.changed.connect(self._drafted)
        self._rules.changed.connect(self.checks.restart_checks)
        self.target_ways = TargetRoutes(self.drafts, self.checks, state, self.sender, self)
        self.sending = CommandSender(self.drafts, self.checks, self.target_ways, self.orders, self)
        self._rules.changed.connect(self.sending.outgoing.restart_checks)
        for receiver in (self.target_ways, self.preview, self.view, self.search, self.orders):
            self.sender.add_receiver(receiver)
        self.orders.answered.connect(lambda _: self.emergency_changed.emit())
        self._follow_state()
        self._forward_messages()

    def _follow_state(self) -> None:
        """Connect the parts to the state's signals before those on screen are connected."""
        state = self.state
        state.link_changed.connect(self._link_changed)
        state.about_to_forget.connect(self.messages.clear)
        state.forgotten.connect(self._forget_robots)
        state.site_changed.connect(self._check_draft_again)
        state.site_changed.connect(self._show_site_problem)
        state.robots_removed.connect(self._robots_removed)
        state.replanned.connect(self._replanned)
        state.emergency_changed.connect(self._emergency_reported)
        state.suspensions_changed.connect(self._show_suspensions)
        state.links_changed.connect(self._show_links)
        state.merged.connect(self._merged)
        state.updated.connect(self.beat.advance)

    def _forward_messages(self) -> None:
        """Forward messages of the parts as the desk's own."""
        for signal, level in (
            (self.failed, Level.ERROR),
            (self.warning, Level.WARNING),
            (self.info, Level.INFO),
        ):
            signal.connect(lambda text, level=level: self.messages.post(text, level))
        self.resolved.connect(self.messages.withdraw)
        self.state.replaced.connect(self.failed)
        self.sender.failed.connect(self.failed)
        self.sender.resolved.connect(self.resolved)
        self.orders.retried.connect(self.messages.end)
        self.sending.failed.connect(lambda text, topics: self.report_failure(text, *topics))
        self.selection.changed.connect(self._endings.selection_changed)
        self.sending.warning.connect(lambda text: self.messages.post(text, Level.WARNING, messages.NO_DRAFT))
        self.orders.accepted.connect(self.hint)
        self.orders.slow.connect(self.failed)
        self.orders.resolved.connect(self.resolved)
        for notices in (self._suspensions, self._links, self._site_problem):
            notices.began.connect(self.failed)
            notices.over.connect(self.resolved)

    def open_link(
        self,
        url: str,
        operator: str,
        credentials: OperatorCredentials | None = None,
        known: FleetGateways | None = None,
    ) -> None:
        """Connect to a gateway; reports of a previous one are forgotten once this one reports its site.

        ``known`` are other gateways of its fleet, from an earlier session.

        :raises FleetError: when the URL, the name, the token or the CA file cannot be used.
        """
        if not operator.strip():
            raise NotSentError(tr("The operator's name is empty. Write who you are: it stands in every log."))
        self.connection.open(url, operator.strip(), credentials, known)
        self.state.start(url)

    def close_link(self) -> None:
        """Disconnect; the known state stays on the map and ages."""
        self.connection.close()
        self.state.pull()

    def shut_down(self) -> None:
        """Stop collecting and wait for the connection's threads.

        :raises Exception: the first one raised by a part, after all the others have ended.
        """
        ends = (
            self.state.stop,
            self.checks.stop,
            self.sending.outgoing.withdraw,
            self._rules.remove,
            self.connection.shut_down,
        )
        remove_all([Removal(end) for end in reversed(ends)])

    def _link_changed(self) -> None:
        if self.state.link.phase is not ConnectionPhase.CONNECTED:
            self.preview.forget()

    def _show_suspensions(self) -> None:
        self._suspensions.show(self.state.suspensions)

    def _show_site_problem(self) -> None:
        problem = None if self.state.site is None else self.state.site.problem
        text = tr(
            "This gateway serves another site than the rest of the fleet: {reason}.", reason=problem or ""
        )
        self._site_problem.renew([] if problem is None else [text])

    def _show_links(self) -> None:
        self._links.show(self.state.links)

    def _merged(self) -> None:
        self.orders.watch()
        self.target_ways.watch()
        self.preview.watch()
        self.view.renew()
        self.search.renew()

    def _emergency_reported(self) -> None:
        if not self.state.emergency.in_force:
            self._endings.emergency_cleared()
        self.emergency_changed.emit()

    def _replanned(self, robot: ReplannedRobot) -> None:
        if robot.became == "another way":
            self.hint.emit(robot.text)
        else:
            self.messages.post(robot.text, Level.ERROR, messages.robot_topic(robot.robot))

    def _forget_robots(self) -> None:
        self._rules.forget_targets()
        self.selection.select(None)
        self.orders.forget_drafts()
        lost = [*self.target_ways.withdraw(), *self.sending.outgoing.withdraw()]
        if self.drafts.draft is not None:
            lost.append(self.drafts.draft)
        for draft in lost:
            words = draft.in_words()
            self.failed.emit(
                tr("{words} was not sent: another site is served now. Draw it anew.", words=words)
            )
        self.drafts.done()

    def _robots_removed(self, gone: RemovedRobots) -> None:
        """Forget robots that an administrator has removed; their commands stay in the log."""
        self._endings.robots_removed(gone.names)
        self.selection.select_all(robot for robot in self.selection.robots if robot not in gone.names)
        draft = self.drafts.draft
        if draft is not None and draft.robot in gone.names:
            words = draft.in_words()
            self.failed.emit(
                tr("{words} was not sent: robot {robot} was removed.", words=words, robot=draft.robot)
            )
            self.drafts.done()

    def _check_draft_again(self) -> None:
        """Check the draft on the map again: the site may have been published again meanwhile."""
        self.sending.outgoing.restart_checks()
        if self.checks.is_under_way:
            self.checks.restart_checks()
        elif self.drafts.draft is not None:
            self._try(lambda: self.checks.again(lambda _: None))

    def _drafted(self) -> None:
        if self.drafts.draft is None:
            # It was sent or given up, so the way to the mouse is dropped as well.
            self.preview.forget()

    def _found(self, draft: PendingCommand) -> None:
        if draft.findings.faults:
            text = in_brief(draft.findings.faults)
            self.messages.post(text, Level.WARNING, messages.draft_topic(draft.place))

    # --- Actions of the operator ---

    def abort_selected(self) -> None:
        """Request an abort for every selected robot."""
        if not self.selection.robots:
            text = tr("No robot is selected, so none was aborted. Select it in the table or on the map.")
            self.messages.post(text, Level.WARNING, messages.SELECTION)
        self.orders.ask_each(self.selection.robots, self.orders.abort, tr("Abort of {robot}"))
        self._give_up_drafting()

    def abort_all(self) -> None:
        """Request an abort for every robot, at once and without confirmation."""
        self._try(self.orders.abort_all)
        self._give_up_drafting()

    def emergency_stop(self) -> None:
        """Stop every robot at once and without confirmation, until a supervisor clears it."""
        self._try(self.orders.emergency_stop)
        self._give_up_drafting()
        self.emergency_changed.emit()

    def _give_up_drafting(self) -> None:
        """Send no draft that is still being checked, and show no way to the mouse: robots must stand."""
        self.sending.withdraw()
        self.preview.forget()

    def clear_emergency(self, stop: str, reason: str) -> None:
        """Request that the emergency stop ``stop`` be cleared; the gateway allows it to supervisors only."""
        self._try(lambda: self.orders.clear_emergency(stop, reason))

    def close_road(self, place: Point, reach: float, reason: str, seconds: float | None) -> None:
        """Request that the road at ``place`` be closed, for ``seconds`` or until it is opened."""
        self._try(lambda: self.roads.close(place, reach, reason, seconds))

    def open_road(self, closure: str) -> None:
        """Request that a closed road be opened."""
        self._try(lambda: self.roads.open(closure))

    def resolve_conflict(self, robot: str, other: str) -> None:
        """Request that ``robot`` give way to ``other``."""
        self._try(lambda: self.roads.resolve(robot, other))

    def pause_robots(self, robots: Iterable[str]) -> dict[str, str]:
        """Request that ``robots`` stand and keep their tasks, and send no draft still being checked.

        Like all that stops robots, never refused here. Returns the keys of the requests sent, and the robot
        of each.
        """

        def ask(robot: str) -> str:
            topic = messages.queue_state_topic(robot, self.state.queues.get(robot))
            return self.orders.ask(PauseRobot(robot), tr("Pause of {robot}", robot=robot), topic)

        asked = self.orders.ask_each(robots, ask, tr("Pause of {robot}"))
        self.sending.withdraw()
        return asked

    def propose_route(self, robot: str, points: list[Point]) -> None:
        """Put a route for ``robot`` on the map, to be checked and sent like any other."""
        route = PendingCommand(robot, ROUTE, tuple(points), legs=(1,) * len(points))
        self._try(lambda: self.target_ways.set_command(route))

    def _try(self, action: Callable[[], object]) -> bool:
        try:
            action()
        except FleetError as error:
            self.report_failure(str(error), *error.topics)
            return False
        return True

    def report_failure(self, text: str, *topics: messages.Topic) -> None:
        """Report that something was not done; shown until one of ``topics`` is over."""
        stop = self.state.emergency
        if stop is not None and stop.in_force and STOPPED_BY in text:
            topics = (*topics, messages.EMERGENCY)
        self.messages.post(text, Level.ERROR, *topics)
