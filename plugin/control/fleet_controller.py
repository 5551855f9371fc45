"""The operator's desk: what is known, who is selected, what is asked; the parts on screen listen to it."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterable
from typing import Any

from qgis.core import QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.core.clock import steady_time
from ...robot_bridge.core.messages import (
    EmergencyReport,
    EmergencyStop,
    Links,
    PauseRobot,
    RobotReport,
    SiteReport,
    Suspensions,
    to_json,
)
from ..gateway_client.buffers import OperatorRequest, StateUpdate
from ..gateway_client.command_cache import CommandCache
from ..gateway_client.connection import ConnectionThread
from ..gateway_client.connection_status import ConnectionPhase, ConnectionStatus, OperatorCredentials
from ..gateway_client.report_caches import (
    GeofenceState,
    NearnessState,
    ObservationCache,
    PlacedConeCache,
    QueueCache,
)
from ..gateway_client.robot_states import RemovedRobots, RobotStates
from ..layers.site_transform import SiteToMapTransform
from ..ui.errors import FleetError, MapTransformError, NotSentError
from ..ui.language import tr
from ..ui.scheduling import PULL_EVERY_MS, UpdateScheduler
from .messages import (
    EMERGENCY,
    NO_DRAFT,
    SELECTION,
    Level,
    LinkNotices,
    MessageBoard,
    MessageEndings,
    SuspensionNotices,
    Topic,
    draft_topic,
    robot_topic,
)
from .pending_command import ROUTE, PendingCommand, PendingCommandModel, Point, in_brief
from .request_tracker import RequestTracker
from .roads import RoadStatus
from .route_queries import RouteQuery, TargetRoutes
from .sending import CommandSender
from .validation import CommandChecks, ValidationRunner

STOPPED_BY = "emergency stop"
"""What a gateway's refusal holds where an emergency stop is the reason."""
LATE_S = 0.1
"""Seconds after which what was pulled is not passed on without a look for what is newer."""


class FleetController(QObject):
    """Pulls the newest state twenty times a second and passes it on; nothing in it waits for the network."""

    pulled = pyqtSignal()
    """A twentieth of a second went by: positions, ages and countdowns may have changed."""
    site_changed = pyqtSignal()
    robots_removed = pyqtSignal(object)
    """Robots are there no more, and others have moved up into their rows: the Gone."""
    link_changed = pyqtSignal()
    commands_changed = pyqtSignal(list)
    selection_changed = pyqtSignal()
    emergency_changed = pyqtSignal()
    """An emergency stop was asked for, or the gateway said how one stands."""
    queues_changed = pyqtSignal(list)
    """The robots of whose queues something new is known."""
    placements_changed = pyqtSignal(list)
    """The numbers of the placed cones of which something new is known."""
    observations_changed = pyqtSignal(list)
    """The numbers of the observations of which something new is known."""
    answered = pyqtSignal(object)
    """What became of an order: the Answer."""
    failed = pyqtSignal(str)
    """Something that was asked for was not done: the text must not go unseen."""
    settled = pyqtSignal(str)
    """What ``failed`` told with this text is over: it need not hang there any longer."""
    complained = pyqtSignal(str)
    """A text that the operator needs in order to go on."""
    noted = pyqtSignal(str)
    """What came of something small: a text that is seen for a while, whatever else is told of drafts."""
    remarked = pyqtSignal(str)
    """A text that the operator may want to see where drafts are told of, while there is none."""

    def __init__(
        self,
        canvas: QgsMapCanvas,
        project: QgsProject,
        parent: QObject | None = None,
        clock: Callable[[], float] = steady_time,
    ):
        super().__init__(parent)
        self.canvas = canvas
        self.project = project
        self.clock = clock
        self.beat = UpdateScheduler()
        self.connection = ConnectionThread(self)
        self.picture = RobotStates()
        self.book = CommandCache()
        self.queues = QueueCache()
        self.placements = PlacedConeCache()
        self.observations = ObservationCache()
        self.messages = MessageBoard(self)
        self.drafts = PendingCommandModel(self)
        self.orders = RequestTracker(self._submit, clock, self)
        self.preview = RouteQuery(self._submit, clock, self)
        self.roads = RoadStatus(self.orders.ask, clock, self)
        self.geofence = GeofenceState(clock)
        self.nearness = NearnessState(clock)
        self._endings = MessageEndings(self.messages, self.drafts, self.roads, self)
        self.suspensions = SuspensionNotices(self)
        self.links = LinkNotices(self)
        self.link = ConnectionStatus(ConnectionPhase.CLOSED)
        self.site: SiteReport | None = None
        self._url, self._is_other_gateway = "", False
        self._database = ""
        """What tells the gateway's database from every other; empty where it does not say."""
        self._not_sent_yet = ""
        """What was told of a stop that waits for the link."""
        self.emergency: EmergencyReport | None = None
        self.selection: tuple[str, ...] = ()
        self._placement: SiteToMapTransform | None = None
        self._rules = CommandChecks(
            project,
            self.placement,
            lambda: self.link.operator,
            self.book,
            self.queues,
            lambda robot: self.picture.view(robot, self.clock()),
            self,
        )
        self.checks = ValidationRunner(self.drafts, self._rules.check_command, self)
        self.checks.found.connect(self._found)
        self.drafts.changed.connect(self._drafted)
        self._rules.changed.connect(self.checks.begin_anew)
        self.target_ways = TargetRoutes(self.drafts, self.checks, self._report_of, self._submit, clock, self)
        self.sending = CommandSender(self.drafts, self.checks, self.target_ways, self.orders, self)
        self._rules.changed.connect(self.sending.outgoing.begin_anew)
        self._timer = QTimer(self)
        self._timer.setInterval(PULL_EVERY_MS)
        self._timer.timeout.connect(self.pull)
        self._pulled_at = clock()
        self._after_pull = QTimer(self)
        self._after_pull.setSingleShot(True)
        self._after_pull.timeout.connect(self._pass_on)
        self._pass_on_words()

    def _pass_on_words(self) -> None:
        """Tell as the desk's own what its parts have to say to the operator."""
        for signal, level in (
            (self.failed, Level.ERROR),
            (self.complained, Level.WARNING),
            (self.noted, Level.INFO),
        ):
            signal.connect(lambda text, level=level: self.messages.post(text, level))
        self.settled.connect(self.messages.withdraw)
        self.orders.asked_again.connect(self.messages.end)
        self.sending.failed.connect(lambda text, topics: self.report_failure(text, *topics))
        self.selection_changed.connect(self._endings.selection_changed)
        self.commands_changed.connect(self._endings.commands_changed)
        self.queues_changed.connect(lambda _: self._endings.queues_changed(self.queues))
        self.observations_changed.connect(lambda _: self._endings.observations_changed(self.observations))
        self.sending.complained.connect(lambda text: self.messages.post(text, Level.WARNING, NO_DRAFT))
        self.orders.accepted.connect(self.remarked)
        self.orders.slow.connect(self.failed)
        self.orders.settled.connect(self.settled)
        self.roads.failed.connect(self._robot_strays)
        self.suspensions.began.connect(self.failed)
        self.suspensions.over.connect(self.settled)
        self.links.began.connect(self.failed)
        self.links.over.connect(self.settled)
        self.roads.remarked.connect(self.remarked)
        self.preview.refused.connect(self.complained)

    # --- the link ---

    def open_link(self, url: str, operator: str, credentials: OperatorCredentials | None = None) -> None:
        """Connect to a gateway; what another one told is forgotten when this one says which site it serves.

        :raises FleetError: when the URL, the name, the token or the CA file cannot be used.
        """
        if not operator.strip():
            raise NotSentError(tr("The operator's name is empty. Write who you are: it stands in every log."))
        self.connection.open(url, operator.strip(), credentials)
        self._is_other_gateway = self._is_other_gateway or url != self._url
        self._url = url
        self._timer.start()
        self.pull()

    def close_link(self) -> None:
        """Disconnect; what is known stays on the map and ages."""
        self.connection.close()
        self.pull()

    def shut_down(self) -> None:
        """Stop the timer and wait for the connection's threads."""
        self._timer.stop()
        self._after_pull.stop()
        self.checks.stop()
        self.sending.outgoing.withdraw()
        self._rules.remove()
        self.connection.shut_down()

    def pull(self) -> None:
        """Take in what arrived since the last call.

        ``pulled`` follows in a piece of its own: the window looks for the operator's events in between.
        """
        self._take_in()
        self._after_pull.start(0)

    def _take_in(self) -> None:
        self._pulled_at = self.clock()
        news = self.connection.collect_updates()
        if news.link != self.link:
            self.link = news.link
            self.link_changed.emit()
            if self.link.phase is not ConnectionPhase.CONNECTED:
                self.preview.forget()
            if self.link.phase is ConnectionPhase.CONNECTED:
                self.geofence.begin_link()
                self.settled.emit(self._not_sent_yet)
        if news.site is not None:
            self._take_site(news.site, news.greeting_of)
        self._take_news(news)
        self.orders.watch()
        self.target_ways.watch()
        self.preview.watch()

    def _pass_on(self) -> None:
        if self.clock() - self._pulled_at > LATE_S:
            # The window stood still meanwhile: what it shows first is what is so now.
            self._take_in()
        self.beat.pulls += 1
        self.pulled.emit()

    def _take_site(self, site: SiteReport, greeting_of: str | None = None) -> None:
        before, is_elsewhere = self.site, self._is_other_gateway
        is_other_database = bool(greeting_of and self._database and greeting_of != self._database)
        self._database = greeting_of or self._database
        if site == before and not is_elsewhere and not is_other_database:
            return
        is_another = is_other_database or self._is_another(site, is_greeting=greeting_of is not None)
        if before is not None and is_another:
            self.messages.clear()
        if before is not None and site.id != before.id and not is_elsewhere:
            # Nobody at this desk asked for it, and it comes with alarms that would hide what goes by itself.
            self.failed.emit(
                tr(
                    "Another site is served now: {site}, no longer {before}. Open its project.",
                    site=site.name,
                    before=before.name,
                )
            )
        elif is_other_database and not is_elsewhere:
            self.failed.emit(
                tr(
                    "The gateway has another database than before: its robots and commands are others, "
                    "and those of before are not shown any more."
                )
            )
        if is_another:
            self._forget_robots()
        self.site, self._is_other_gateway = site, False
        self.target_ways.site = site
        self.picture.stale_after, self.picture.lost_after = site.stale_after, site.lost_after
        self._placement = None
        self._look_at_draft_anew()
        self.site_changed.emit()

    def _is_another(self, site: SiteReport, *, is_greeting: bool) -> bool:
        """Tell whether other robots are on ``site`` than on the one before.

        Two gateways may serve one site, for practice and for work, each with robots of its own. Chosen while
        the link is up, a site is served to the same robots: commands, queues and an emergency stop go on.
        """
        was = self.site
        if was is None or self._is_other_gateway or (is_greeting and site.id != was.id):
            return True
        return (site.crs, site.origin, site.rotation) != (was.crs, was.origin, was.rotation)

    def _forget_robots(self) -> None:
        self.picture.clear()
        self.book.clear()
        self.queues.clear()
        self.placements.clear()
        self.observations.clear()
        self.emergency = None
        self.suspensions.show(Suspensions())
        self.links.show(Links())
        self.roads.clear()
        self.geofence.clear()
        self.nearness.clear()
        self._rules.forget_targets()
        self.select(None)
        lost = self.sending.outgoing.withdraw()
        if self.drafts.draft is not None:
            lost.append(self.drafts.draft)
        for draft in lost:
            words = draft.in_words()
            self.failed.emit(
                tr("{words} was not sent: another site is served now. Draw it anew.", words=words)
            )
        self.drafts.done()

    def _let_go(self, gone: RemovedRobots) -> None:
        """Forget robots that an administrator has removed; what they did stays in the log."""
        self.queues.forget(gone.names)
        self._endings.robots_removed(gone.names)
        self.robots_removed.emit(gone)
        self.select_all(robot for robot in self.selection if robot not in gone.names)
        self._rules.take_targets(gone.names)
        self.queues_changed.emit(sorted(gone.names))
        draft = self.drafts.draft
        if draft is not None and draft.robot in gone.names:
            words = draft.in_words()
            self.failed.emit(
                tr("{words} was not sent: robot {robot} was removed.", words=words, robot=draft.robot)
            )
            self.drafts.done()

    def _look_at_draft_anew(self) -> None:
        """Check the draft on the map once more: the site has been published anew beneath it."""
        self.sending.outgoing.begin_anew()
        if self.checks.is_under_way:
            self.checks.begin_anew()
        elif self.drafts.draft is not None:
            self._try(lambda: self.checks.again(lambda _: None))

    def _take_news(self, news: StateUpdate) -> None:
        gone = self.picture.merge(news.robots)
        if gone.names:
            self._let_go(gone)
        changed = self.book.merge(news.commands.values())
        if changed:
            self._rules.take_targets(report.robot for report in changed)
            self.commands_changed.emit(changed)
        self.roads.apply_updates(news.roads)
        if news.geofence is not None:
            self.geofence.update(news.geofence)
        if news.nearness is not None:
            self.nearness.update(news.nearness)
        self._take_queues(news)
        for answer in news.answers:
            if not (self.target_ways.accept_answer(answer) or self.preview.accept_answer(answer)):
                self.orders.answered(answer)
                self.answered.emit(answer)
        self._take_notices(news)
        if news.emergency is not None:
            self.emergency = news.emergency
            if not news.emergency.in_force:
                self._endings.emergency_cleared()
        if news.emergency is not None or news.answers:
            self.emergency_changed.emit()

    def _take_notices(self, news: StateUpdate) -> None:
        if news.suspensions is not None:
            self.suspensions.show(news.suspensions)
        if news.links is not None:
            self.links.show(news.links)

    def _take_queues(self, news: StateUpdate) -> None:
        queues = self.queues.merge(news.queues)
        if queues:
            self._rules.take_targets(queues)
            self.queues_changed.emit(queues)
        placed = self.placements.merge(news.placements)
        if placed:
            self.placements_changed.emit(placed)
        seen = self.observations.merge(news.observations)
        if seen:
            self.observations_changed.emit(seen)

    # --- places ---

    def placement(self) -> SiteToMapTransform:
        """Return the way from the site frame to the canvas as it is set now.

        :raises MapTransformError: when no gateway said yet which site it serves, or the CRS is not usable.
        """
        if self.site is None:
            raise MapTransformError(tr("The site is not known yet. Connect to a gateway first."))
        way = self.canvas.mapSettings().destinationCrs(), self.project.transformContext()
        if self._placement is None or not self._placement.leads_to(*way):
            self._placement = SiteToMapTransform(self.site, *way)
        return self._placement

    def put_draft(self, draft: PendingCommand) -> None:
        """Make a draft the one on the map, have it checked, and say what speaks against it.

        :raises FleetError: when there is no site or a layer cannot be read; what was on the map stays then.
        """
        self.checks.set_command(self.target_ways.begun(draft))

    def _drafted(self) -> None:
        if self.drafts.draft is None:
            # It was sent, or given up: so is what led to the mouse.
            self.preview.forget()

    def _report_of(self, robot: str) -> RobotReport | None:
        view = self.picture.view(robot, self.clock())
        return None if view is None else view.report

    def _found(self, draft: PendingCommand) -> None:
        if draft.findings.faults:
            text = in_brief(draft.findings.faults)
            self.messages.post(text, Level.WARNING, draft_topic(draft.place))

    # --- what the operator does ---

    @property
    def selected(self) -> str | None:
        """The robot that drafts are made for: of several selected ones the last. None without any."""
        return self.selection[-1] if self.selection else None

    def select(self, robot: str | None) -> None:
        """Select a robot alone, None for none."""
        self.select_all([] if robot is None else [robot])

    def select_all(self, robots: Iterable[str]) -> None:
        """Select these robots and no others; the last of them is the one that drafts are made for."""
        selection = tuple(dict.fromkeys(robots))
        if selection != self.selection:
            self.selection = selection
            self.selection_changed.emit()

    def abort_selected(self) -> None:
        """Ask every selected robot to give up its task."""
        if not self.selection:
            text = tr("No robot is selected, so none was aborted. Select it in the table or on the map.")
            self.messages.post(text, Level.WARNING, SELECTION)
        for robot in self.selection:
            self._try(lambda robot=robot: self.orders.abort(robot))
        self._give_up_drafting()

    def abort_all(self) -> None:
        """Ask every robot to give up its task, at once and without a question."""
        self._try(self.orders.abort_all)
        self._give_up_drafting()

    def emergency_stop(self) -> None:
        """Stop every robot at once and without a question, until a supervisor clears it."""
        self._try(self.orders.emergency_stop)
        self._give_up_drafting()
        self.emergency_changed.emit()

    def _give_up_drafting(self) -> None:
        """Send nothing that is still looked at, and show no way to the mouse: robots are to stand."""
        self.sending.withdraw()
        self.preview.forget()

    def clear_emergency(self, stop: str, reason: str) -> None:
        """Ask for the emergency stop ``stop`` to be cleared; the gateway lets supervisors only."""
        self._try(lambda: self.orders.clear_emergency(stop, reason))

    def close_road(self, place: Point, reach: float, reason: str, seconds: float | None) -> None:
        """Ask for the road at ``place`` to be closed, for ``seconds`` or until it is opened."""
        self._try(lambda: self.roads.close(place, reach, reason, seconds))

    def open_road(self, closure: str) -> None:
        """Ask for a closed road to be opened."""
        self._try(lambda: self.roads.open(closure))

    def resolve_conflict(self, robot: str, other: str) -> None:
        """Ask for ``robot`` to give way to ``other``."""
        self._try(lambda: self.roads.resolve(robot, other))

    def pause_robot(self, robot: str) -> None:
        """Ask for ``robot`` to stand and keep what it is doing; never refused here, as nothing that stops."""
        self._try(lambda: self.ask(PauseRobot(robot), tr("Pause of {robot}", robot=robot)))

    def propose_route(self, robot: str, points: list[Point]) -> None:
        """Put a route for ``robot`` on the map, to be looked at, and sent as any other."""
        route = PendingCommand(robot, ROUTE, tuple(points), legs=(1,) * len(points))
        self._try(lambda: self.put_draft(route))

    def ask(self, request: Any, words: str, *topics: Topic, draft: PendingCommand | None = None) -> str:
        """Ask the gateway for ``request``, which is ``words`` to the operator, and return the order's key.

        What becomes of it comes with :attr:`answered`. A refusal is told until one of ``topics`` is over;
        the ``draft`` that it was made of comes back then.

        :raises NotSentError: when it cannot be sent.
        """
        order = OperatorRequest(str(uuid.uuid4()), request.method, to_json(request), self.clock())
        self.orders.ask(order, words, topics, draft)
        return order.key

    def inquire(self, request: Any, *, lasting: bool = False) -> str:
        """Ask the gateway for what it knows, without a word to the operator, and return the order's key.

        A ``lasting`` one is asked again however long the link was lost.

        :raises NotSentError: when it cannot be sent.
        """
        order = OperatorRequest(str(uuid.uuid4()), request.method, to_json(request), self.clock(), lasting)
        self._submit(order)
        return order.key

    def _try(self, action: Callable[[], object]) -> bool:
        try:
            action()
        except FleetError as error:
            self.report_failure(str(error), *error.topics)
            return False
        return True

    def report_failure(self, text: str, *topics: Topic) -> None:
        """Say that something was not done, until one of ``topics`` is over."""
        in_force = self.emergency is not None and self.emergency.in_force
        if in_force and STOPPED_BY in text:
            topics = (*topics, EMERGENCY)
        self.messages.post(text, Level.ERROR, *topics)

    def _robot_strays(self, text: str, robot: str) -> None:
        self.messages.post(text, Level.ERROR, robot_topic(robot))

    def _submit(self, order: OperatorRequest) -> None:
        if self.link.phase is ConnectionPhase.CONNECTED:
            self.connection.submit(order)
            return
        if order.method != EmergencyStop.method or not self.connection.is_open:
            raise NotSentError(
                tr(
                    "the desk is not connected to a gateway. Connect first; to stop a robot now use the "
                    "robot's own emergency stop."
                )
            )
        self.connection.submit(order)
        self._not_sent_yet = tr(
            "EMERGENCY STOP is NOT sent yet: the link is down. It is sent as soon as that is back; use "
            "the robots' own emergency stops now."
        )
        self.failed.emit(self._not_sent_yet)
