"""The operator's desk: what is known, who is selected, what is asked; the parts on screen listen to it."""

from __future__ import annotations

import time
from collections.abc import Callable

from qgis.core import QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.messages import EmergencyReport, EmergencyStop, SiteReport
from ..connection import Connection
from ..errors import FleetError, NotSentError, PlacementError
from ..wire.addresses import Credentials
from ..wire.mailbox import News
from ..wire.outbox import Order
from ..wire.status import LinkStatus, Phase
from .checks import LayerCheck, check_bounds
from .command_book import CommandBook
from .drafts import Draft, DraftBoard, Findings, Point
from .orders import Orders
from .picture import RobotPicture
from .placement import Placement
from .trails import Trails

PULL_EVERY_MS = 100


class Desk(QObject):
    """Pulls the newest state ten times a second and passes it on; nothing in it waits for the network."""

    pulled = pyqtSignal()
    """A tenth of a second went by: positions, ages and countdowns may have changed."""
    site_changed = pyqtSignal()
    link_changed = pyqtSignal()
    commands_changed = pyqtSignal(list)
    selection_changed = pyqtSignal()
    emergency_changed = pyqtSignal()
    """An emergency stop was asked for, or the gateway said how one stands."""
    failed = pyqtSignal(str)
    """Something that was asked for was not done: the text must not go unseen."""
    complained = pyqtSignal(str)
    """A text that the operator needs in order to go on."""
    remarked = pyqtSignal(str)
    """A text that the operator may want to see."""

    def __init__(
        self,
        canvas: QgsMapCanvas,
        project: QgsProject,
        parent: QObject | None = None,
        clock: Callable[[], float] = time.monotonic,
    ):
        super().__init__(parent)
        self.canvas = canvas
        self.project = project
        self.clock = clock
        self.connection = Connection(self)
        self.picture = RobotPicture()
        self.trails = Trails()
        self.book = CommandBook()
        self.drafts = DraftBoard(self)
        self.orders = Orders(self._submit, clock, self)
        self.link = LinkStatus(Phase.CLOSED)
        self.site: SiteReport | None = None
        self.emergency: EmergencyReport | None = None
        self.selected: str | None = None
        self._placement: Placement | None = None
        self._check_layers = LayerCheck(project)
        self.orders.refused.connect(self._refused)
        self.orders.accepted.connect(self.remarked)
        self.orders.slow.connect(self.failed)
        self._timer = QTimer(self)
        self._timer.setInterval(PULL_EVERY_MS)
        self._timer.timeout.connect(self.pull)

    # --- the link ---

    def open_link(self, url: str, operator: str, credentials: Credentials | None = None) -> None:
        """Connect to a gateway; another gateway's robots are forgotten when it says which site it serves.

        :raises FleetError: when the URL, the name, the token or the CA file cannot be used.
        """
        if not operator.strip():
            raise NotSentError("The operator's name is empty. Write who you are: it stands in every log.")
        self.connection.open(url, operator.strip(), credentials)
        self._timer.start()
        self.pull()

    def close_link(self) -> None:
        """Disconnect; what is known stays on the map and ages."""
        self.connection.close()
        self.pull()

    def shut_down(self) -> None:
        """Stop the timer and wait for the connection's threads."""
        self._timer.stop()
        self.connection.shut_down()

    def pull(self) -> None:
        """Take in what arrived since the last call."""
        news = self.connection.take()
        if news.link != self.link:
            self.link = news.link
            self.link_changed.emit()
        if news.site is not None:
            self._take_site(news.site)
        self._take_news(news)
        self.orders.watch()
        self.pulled.emit()

    def _take_site(self, site: SiteReport) -> None:
        if site == self.site:
            return
        if self.site is None or site.id != self.site.id:
            self.picture.clear()
            self.trails.clear()
            self.book.clear()
            self.emergency = None
            self.select(None)
        self.drafts.put(None)
        self.site = site
        self.picture.stale_after, self.picture.lost_after = site.stale_after, site.lost_after
        self._placement = None
        self.site_changed.emit()

    def _take_news(self, news: News) -> None:
        self.picture.merge(news.robots)
        self.trails.extend(news.robots)
        changed = self.book.merge(news.commands.values())
        if changed:
            self.commands_changed.emit(changed)
        for answer in news.answers:
            self.orders.answered(answer)
        if news.emergency is not None:
            self.emergency = news.emergency
        if news.emergency is not None or news.answers:
            self.emergency_changed.emit()

    # --- places ---

    def placement(self) -> Placement:
        """Return the way from the site frame to the canvas as it is set now.

        :raises PlacementError: when no gateway said yet which site it serves, or the CRS is not usable.
        """
        if self.site is None:
            raise PlacementError("The site is not known yet. Connect to a gateway first.")
        crs = self.canvas.mapSettings().destinationCrs()
        if self._placement is None or self._placement.map_crs != crs:
            self._placement = Placement(self.site, crs, self.project.transformContext())
        return self._placement

    def checked(self, points: tuple[Point, ...]) -> Findings:
        """Check points in the site frame against the site and the project's layers.

        :raises PlacementError: as :meth:`placement`.
        """
        placement = self.placement()
        return check_bounds(points, self.site) + self._check_layers(points, placement)

    # --- what the operator does ---

    def select(self, robot: str | None) -> None:
        """Select a robot, None for none."""
        if robot != self.selected:
            self.selected = robot
            self.selection_changed.emit()

    def send_draft(self) -> None:
        """Send the draft; without one, or when it cannot be sent, say so."""
        draft = self.drafts.draft
        if draft is None:
            self.complained.emit(
                "There is nothing to send. Select a robot, then set a cone target or draw a route on the map."
            )
            return
        if self._try(lambda: self.orders.send(draft)):
            self.drafts.put(None)

    def abort_selected(self) -> None:
        """Ask the selected robot to give up its task."""
        if self.selected is None:
            self.complained.emit(
                "No robot is selected, so none was aborted. Select it in the table or on the map."
            )
            return
        self._try(lambda: self.orders.abort(self.selected))

    def abort_all(self) -> None:
        """Ask every robot to give up its task, at once and without a question."""
        self._try(self.orders.abort_all)

    def emergency_stop(self) -> None:
        """Stop every robot at once and without a question, until a supervisor clears it."""
        self._try(self.orders.emergency_stop)
        self.emergency_changed.emit()

    def clear_emergency(self, stop: str, reason: str) -> None:
        """Ask for the emergency stop ``stop`` to be cleared; the gateway lets supervisors only."""
        self._try(lambda: self.orders.clear_emergency(stop, reason))

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
                "the desk is not connected to a gateway. Connect first; to stop a robot now use the robot's "
                "own emergency stop."
            )
        self.connection.submit(order)
        self.failed.emit(
            "EMERGENCY STOP is NOT sent yet: the link is down. It is sent as soon as that is back; use the "
            "robots' own emergency stops now."
        )

    def _refused(self, text: str, draft: Draft | None) -> None:
        self.failed.emit(text)
        if draft is not None and self.drafts.draft is None:
            # Nothing the operator drew is lost because a gateway refused it.
            self.drafts.put(draft)
