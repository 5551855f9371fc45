"""The operator's desk: what is known, who is selected, what is asked; the parts on screen listen to it."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterable
from typing import Any

from qgis.core import QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.messages import EmergencyReport, EmergencyStop, SiteReport, to_json
from ...robot_bridge.steady_time import steady_time
from ..connection import Connection
from ..errors import FleetError, NotSentError, PlacementError
from ..language import tr
from ..wire.addresses import Credentials
from ..wire.mailbox import News
from ..wire.outbox import Order
from ..wire.status import LinkStatus, Phase
from .beat import PULL_EVERY_MS, Beat
from .command_book import CommandBook
from .draft_rules import DraftRules
from .drafting.draft_checker import DraftChecker
from .drafting.draft_sending import DraftSending
from .drafts import Draft, DraftBoard, Point, in_brief
from .observation_book import ObservationBook
from .orders import Orders
from .picture import Gone, RobotPicture
from .placement import Placement
from .placement_book import PlacementBook
from .queue_book import QueueBook
from .road_board import RoadBoard
from .route_preview import RoutePreview

LATE_S = 0.1
"""Seconds after which what was pulled is not passed on without a look for what is newer."""


class Desk(QObject):
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
        self.beat = Beat()
        self.connection = Connection(self)
        self.picture = RobotPicture()
        self.book = CommandBook()
        self.queues = QueueBook()
        self.placements = PlacementBook()
        self.observations = ObservationBook()
        self.drafts = DraftBoard(self)
        self.orders = Orders(self._submit, clock, self)
        self.preview = RoutePreview(self._submit, clock, self)
        self.roads = RoadBoard(self.orders.ask, clock, self)
        self.link = LinkStatus(Phase.CLOSED)
        self.site: SiteReport | None = None
        self._url, self._is_other_gateway = "", False
        self._not_sent_yet = ""
        """What was told of a stop that waits for the link."""
        self.emergency: EmergencyReport | None = None
        self.selection: tuple[str, ...] = ()
        self._placement: Placement | None = None
        self._rules = DraftRules(
            project, self.placement, lambda: self.link.operator, self.book, self.queues, self
        )
        self.checks = DraftChecker(self.drafts, self._rules.look, self)
        self.checks.found.connect(self._found)
        self._rules.changed.connect(self.checks.begin_anew)
        self.sending = DraftSending(self.drafts, self.checks, self.orders, self)
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
        self.sending.failed.connect(self.failed)
        self.sending.complained.connect(self.complained)
        self.orders.accepted.connect(self.remarked)
        self.orders.slow.connect(self.failed)
        self.orders.settled.connect(self.settled)
        self.roads.failed.connect(self.failed)
        self.roads.remarked.connect(self.remarked)
        self.preview.refused.connect(self.complained)

    # --- the link ---

    def open_link(self, url: str, operator: str, credentials: Credentials | None = None) -> None:
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
        news = self.connection.take()
        if news.link != self.link:
            self.link = news.link
            self.link_changed.emit()
            if self.link.phase is Phase.CONNECTED:
                self.settled.emit(self._not_sent_yet)
        if news.site is not None:
            self._take_site(news.site, news.is_greeting)
        self._take_news(news)
        self.orders.watch()
        self.preview.watch()

    def _pass_on(self) -> None:
        if self.clock() - self._pulled_at > LATE_S:
            # The window stood still meanwhile: what it shows first is what is so now.
            self._take_in()
        self.beat.pulls += 1
        self.pulled.emit()

    def _take_site(self, site: SiteReport, is_greeting: bool) -> None:
        if site == self.site and not self._is_other_gateway:
            return
        if self.site is not None and site.id != self.site.id and not self._is_other_gateway:
            # Nobody at this desk asked for it, and it comes with alarms that would hide what goes by itself.
            self.failed.emit(
                tr(
                    "Another site is served now: {site}, no longer {before}. Open its project.",
                    site=site.name,
                    before=self.site.name,
                )
            )
        if self._is_another(site, is_greeting):
            self._forget_robots()
        self.site, self._is_other_gateway = site, False
        self.picture.stale_after, self.picture.lost_after = site.stale_after, site.lost_after
        self._placement = None
        self._look_at_draft_anew()
        self.site_changed.emit()

    def _is_another(self, site: SiteReport, is_greeting: bool) -> bool:
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
        self.roads.clear()
        self._rules.forget_targets()
        self.select(None)
        if self.drafts.draft is not None:
            words = self.drafts.draft.in_words()
            self.failed.emit(
                tr("{words} was not sent: another site is served now. Draw it anew.", words=words)
            )
        self.drafts.done()

    def _let_go(self, gone: Gone) -> None:
        """Forget robots that an administrator has removed; what they did stays in the log."""
        self.queues.forget(gone.names)
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
        if self.checks.is_under_way:
            self.checks.begin_anew()
        elif self.drafts.draft is not None:
            self._try(lambda: self.checks.again(lambda _: None))

    def _take_news(self, news: News) -> None:
        gone = self.picture.merge(news.robots)
        if gone.names:
            self._let_go(gone)
        changed = self.book.merge(news.commands.values())
        if changed:
            self._rules.take_targets(report.robot for report in changed)
            self.commands_changed.emit(changed)
        self.roads.take(news.roads)
        self._take_queues(news)
        for answer in news.answers:
            if not self.preview.take(answer):
                self.orders.answered(answer)
                self.answered.emit(answer)
        if news.emergency is not None:
            self.emergency = news.emergency
        if news.emergency is not None or news.answers:
            self.emergency_changed.emit()

    def _take_queues(self, news: News) -> None:
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

    def placement(self) -> Placement:
        """Return the way from the site frame to the canvas as it is set now.

        :raises PlacementError: when no gateway said yet which site it serves, or the CRS is not usable.
        """
        if self.site is None:
            raise PlacementError(tr("The site is not known yet. Connect to a gateway first."))
        way = self.canvas.mapSettings().destinationCrs(), self.project.transformContext()
        if self._placement is None or not self._placement.leads_to(*way):
            self._placement = Placement(self.site, *way)
        return self._placement

    def put_draft(self, draft: Draft) -> None:
        """Make a draft the one on the map, have it checked, and say what speaks against it.

        :raises FleetError: when there is no site or a layer cannot be read; what was on the map stays then.
        """
        self.checks.put(draft)

    def _found(self, draft: Draft) -> None:
        if draft.findings.faults:
            self.complained.emit(in_brief(draft.findings.faults))

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
            self.complained.emit(
                tr("No robot is selected, so none was aborted. Select it in the table or on the map.")
            )
        for robot in self.selection:
            self._try(lambda robot=robot: self.orders.abort(robot))
        self.sending.withdraw()

    def abort_all(self) -> None:
        """Ask every robot to give up its task, at once and without a question."""
        self._try(self.orders.abort_all)
        self.sending.withdraw()

    def emergency_stop(self) -> None:
        """Stop every robot at once and without a question, until a supervisor clears it."""
        self._try(self.orders.emergency_stop)
        self.sending.withdraw()
        self.emergency_changed.emit()

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

    def ask(self, request: Any, words: str) -> str:
        """Ask the gateway for ``request``, which is ``words`` to the operator, and return the order's key.

        What becomes of it comes with :attr:`answered`.

        :raises NotSentError: when it cannot be sent.
        """
        order = Order(str(uuid.uuid4()), request.method, to_json(request), self.clock())
        self.orders.ask(order, words)
        return order.key

    def inquire(self, request: Any, *, lasting: bool = False) -> str:
        """Ask the gateway for what it knows, without a word to the operator, and return the order's key.

        A ``lasting`` one is asked again however long the link was lost.

        :raises NotSentError: when it cannot be sent.
        """
        order = Order(str(uuid.uuid4()), request.method, to_json(request), self.clock(), lasting)
        self._submit(order)
        return order.key

    def _try(self, action: Callable[[], object]) -> bool:
        try:
            action()
        except FleetError as error:
            self.failed.emit(str(error))
            return False
        return True

    def _submit(self, order: Order) -> None:
        if self.link.phase is Phase.CONNECTED:
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
