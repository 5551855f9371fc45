"""The desk's subscription to a part of the fleet, and its searches, where there are too many robots."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

from qgis.core import QgsPointXY, QgsRectangle
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.messages import positions
from ...robot_bridge.core.messages.base import is_robot_name
from ...robot_bridge.core.messages.positions import (
    AlarmLimits,
    FindRobots,
    PositionForm,
    Subscribe,
    View,
)
from ...robot_bridge.core.messages.safety import RobotState
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.fleet_state import FleetState, OperatorRequest, RequestResult
from ..gateway_client.protocol import VIEWS_FROM
from ..layers.site_transform import SiteToCanvas
from ..ui.errors import FleetError, MapTransformError
from .pending_command import PendingCommandModel
from .request_tracker import RequestSender

Bounds = tuple[float, float, float, float]

VIEWS_UNTIL = 0.8 * VIEWS_FROM
"""Number of robots below which the desk receives all of them again."""
LEAST_REST_S = 0.3
"""Seconds between two subscriptions of a canvas that moves."""
BUFFER = 0.25
"""Fraction of the canvas's width and height by which the view is larger at each side."""
TOO_LARGE = 2.5
"""Factor of the canvas's size beyond which the view is requested again, with finer cells."""
MOST_ALARMED = 200
MOST_SELECTED = 200
EDGE = tuple(itertools.product((0.0, 0.25, 0.5, 0.75, 1.0), repeat=2))
"""Points at which the canvas is sampled: its edges may be curved in the site frame."""


class FoundRobot(NamedTuple):
    """A robot that the gateway found; ``heard`` is when it was last heard, on the monotonic clock."""

    name: str
    state: RobotState
    heard: float


class RobotSearch(QObject):
    """Has the gateway find robots by a part of their names, while the desk does not receive all of them.

    ``what`` distinguishes it from other searches.
    """

    answered = pyqtSignal()
    """The search for the requested text has a result, or the gateway gives none."""

    def __init__(self, what: str, state: FleetState, sender: RequestSender, parent: QObject | None = None):
        super().__init__(parent)
        self._key, self._state, self._sender = f"{FindRobots.method} {what} ", state, sender
        self._numbers = itertools.count(1)
        self._text = ""
        self._asked_for = ("", "")
        """The text that was requested last, and the key of that request."""
        self._asked_at = -LEAST_REST_S
        self._answer: tuple[str, tuple[FoundRobot, ...]] = ("", ())
        """The text that was answered last, and the robots."""
        self._page: tuple[FoundRobot, ...] = ()
        """The robots found so far for the requested text."""

    def search(self, text: str) -> None:
        """Find robots with ``text`` in their names; none where no name can contain it."""
        self._text = text if _can_be_in_name(text) else ""

    def found(self, text: str) -> tuple[FoundRobot, ...]:
        """Return the robots that a search for ``text`` found, empty while that is not answered."""
        return self._answer[1] if text and self._answer[0] == text else ()

    @property
    def names(self) -> tuple[str, ...]:
        """The robots that the search found."""
        return tuple(robot.name for robot in self.found(self._text))

    def awaits(self, text: str) -> bool:
        """Return whether unknown robots may have ``text`` in their names."""
        return self._is_of_use and _can_be_in_name(text) and self._answer[0] != text

    @property
    def _is_of_use(self) -> bool:
        state = self._state
        return state.robots.fleet is not None and state.link.phase is ConnectionPhase.CONNECTED

    def renew(self) -> None:
        """Send the search unless it was sent; called periodically."""
        if not self._is_of_use:
            # It is sent again on the next link; the results stay until then, unless all robots are known.
            self._asked_for = ("", "")
            if self._state.robots.fleet is None:
                self._answer = ("", ())
            return
        now = self._state.clock.steady()
        if self._text == self._asked_for[0] or now - self._asked_at < LEAST_REST_S:
            return
        self._asked_at, self._page = now, ()
        self._ask(FindRobots(self._text))

    def _ask(self, request: FindRobots) -> None:
        self._asked_for = request.text, f"{self._key}{next(self._numbers)}"
        if not request.text:
            return
        now = self._state.clock.steady()
        try:
            self._sender.submit(OperatorRequest.of(self._asked_for[1], request, now))
        except FleetError:
            # The link has just gone.
            self._asked_for = ("", "")

    def accept_answer(self, answer: RequestResult) -> bool:
        """Handle a search result; return false when the answer belongs to another request."""
        if not answer.order.key.startswith(self._key):
            return False
        text, key = self._asked_for
        if answer.order.key != key:
            return True
        if answer.result is None:
            # Refused, for example for too many requests in a second: it is sent again.
            self._asked_for = ("", "")
            return True
        result, is_first = answer.result, not self._page
        more = _found_robots(result.get("robots", []), self._state.clock.steady())
        self._page = tuple({robot.name: robot for robot in (*self._page, *more)}.values())
        if is_first and result.get("count", 0) > len(self._page) > 0 and self._page[-1].name < text.lower():
            # The gateway returns the first by name: an exact match may come after them, as 17 does after
            # 1017, and in another case. Small letters come last.
            self._ask(FindRobots(text, whole=True))
            return True
        self._answer = text, self._page
        self.answered.emit()
        return True


def _found_robots(robots: list[dict[str, Any]], now: float) -> tuple[FoundRobot, ...]:
    try:
        found = [FoundRobot(one["robot"], RobotState(one["state"]), now - one["age"]) for one in robots]
        return tuple(one for one in found if is_robot_name(one.name))
    except (KeyError, TypeError, ValueError):
        # Not a gateway's report of robots: nothing is known of them.
        return ()


def _can_be_in_name(text: str) -> bool:
    return bool(text) and is_robot_name(f"0{text}")


class ViewSubscription(QObject):
    """Subscribes to robots in the canvas, and those selected, drafted for, alarmed, searched for or named.

    Nothing is requested where the fleet is small, or the gateway knows no views: all robots come then.
    """

    def __init__(
        self,
        canvas: QgsMapCanvas,
        state: FleetState,
        site_to_canvas: SiteToCanvas,
        drafts: PendingCommandModel,
        sender: RequestSender,
        clock: Clock,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._canvas, self._state, self._site_to_canvas = canvas, state, site_to_canvas
        self._drafts, self._sender, self._clock = drafts, sender, clock
        self._selected: tuple[str, ...] = ()
        self._alarmed: tuple[str, ...] = ()
        self._named: tuple[str, ...] = ()
        self._limits = AlarmLimits()
        self._search = RobotSearch("list", state, sender, self)
        self._asked: View | None = None
        self._polled_at = -LEAST_REST_S
        self._seen: tuple[QgsRectangle, Bounds] | None = None
        """The canvas's extent in the map, and in the site frame."""

    def select(self, robots: Iterable[str]) -> None:
        """Receive these robots wherever they are."""
        self._selected = tuple(robots)[-MOST_SELECTED:]

    def watch_alarms(self, robots: Iterable[str], limits: AlarmLimits) -> None:
        """Receive these robots, which have alarms, and all that get some by ``limits``."""
        self._alarmed, self._limits = tuple(itertools.islice(robots, MOST_ALARMED)), limits

    def watch_named(self, robots: Iterable[str]) -> None:
        """Receive these robots, which expressions name, as far as there is room beside all others."""
        self._named = tuple(robots)

    def search(self, text: str) -> None:
        """Receive robots with ``text`` in their names wherever they are, as many as a search finds.

        Of several words, which may refer to something else, the longest is used.
        """
        self._search.search(max(text.split(), key=len, default=""))

    def renew(self) -> None:
        """Subscribe to what the canvas shows now, unless that is current; called periodically."""
        self._search.renew()
        site = self._state.site
        if site is None or self._state.link.phase is not ConnectionPhase.CONNECTED:
            self._asked, self._seen = None, None
            return
        fleet = self._state.robots.fleet
        if self._state.robots.count <= (VIEWS_FROM if fleet is None else VIEWS_UNTIL):
            if fleet is not None and self._asked is not None:
                self._subscribe(None)
            return
        now = self._clock.steady()
        if now - self._polled_at < LEAST_REST_S:
            return
        self._polled_at = now
        if (view := self._wanted(site.bounds)) is not None:
            self._subscribe(view)

    def accept_answer(self, answer: RequestResult) -> bool:
        """Handle a search result; return false when the answer belongs to another request."""
        return self._search.accept_answer(answer)

    def _wanted(self, site: Bounds) -> View | None:
        """Return the view to request, None where the current one will do."""
        canvas = self._in_site(site)
        draft = self._drafts.draft
        drafted = () if draft is None else (draft.robot,)
        wanted = (*drafted, *self._selected, *self._search.names, *self._alarmed, *self._named)
        # A gateway refuses the whole view for one invalid robot name.
        always = dict.fromkeys(filter(is_robot_name, wanted))
        view = View(canvas, list(always)[: positions.MOST_ALWAYS], alarms=self._limits)
        if self._asked is None or not _will_do(self._asked.bounds, canvas):
            return replace(view, bounds=_grown(canvas))
        renewed = replace(view, bounds=self._asked.bounds)
        return None if renewed == self._asked else renewed

    def _in_site(self, site: Bounds) -> Bounds:
        """Return the part of the site, and a margin around it, that the canvas shows."""
        extent = self._canvas.extent()
        if self._seen is None or self._seen[0] != extent:
            self._seen = extent, _shown(self._placed(extent, site), _grown(site))
        return self._seen[1]

    def _placed(self, extent: QgsRectangle, site: Bounds) -> Bounds:
        try:
            transform = self._site_to_canvas.transform()
            width, height = extent.width(), extent.height()
            points = [
                transform.to_site(QgsPointXY(extent.xMinimum() + x * width, extent.yMinimum() + y * height))
                for x, y in EDGE
            ]
        except MapTransformError:
            # The canvas shows more of the world than the site's CRS can express.
            return site
        xs, ys = [x for x, _ in points], [y for _, y in points]
        return min(xs), min(ys), max(xs), max(ys)

    def _subscribe(self, view: View | None) -> None:
        self._asked = view
        # Rate and form are the connection's own.
        request = Subscribe(form=PositionForm.COLUMNS, view=view)
        try:
            self._sender.submit(OperatorRequest.of("view", request, self._clock.steady()))
        except FleetError:
            # The link has just gone: it is requested again on the next one.
            self._asked = None


def _grown(bounds: Bounds) -> Bounds:
    x_min, y_min, x_max, y_max = bounds
    # Never without an extent.
    dx, dy = max(BUFFER * (x_max - x_min), 1.0), max(BUFFER * (y_max - y_min), 1.0)
    return x_min - dx, y_min - dy, x_max + dx, y_max + dy


def _shown(canvas: Bounds, site: Bounds) -> Bounds:
    """Return the intersection; a metre of the site's corner where the canvas shows nothing of it."""
    x_min, y_min = max(canvas[0], site[0]), max(canvas[1], site[1])
    x_max, y_max = min(canvas[2], site[2]), min(canvas[3], site[3])
    if x_min < x_max and y_min < y_max:
        return x_min, y_min, x_max, y_max
    # Off the site there are no robots: a metre of its corner will do.
    return site[0], site[1], site[0] + 1.0, site[1] + 1.0


def _will_do(asked: Bounds, canvas: Bounds) -> bool:
    """Return whether a requested view contains the canvas, and is not much larger."""
    holds = (
        asked[0] <= canvas[0] and asked[1] <= canvas[1] and asked[2] >= canvas[2] and asked[3] >= canvas[3]
    )
    width, height = canvas[2] - canvas[0], canvas[3] - canvas[1]
    # As much as a view is grown by, at least, is never too much.
    is_close = asked[2] - asked[0] <= TOO_LARGE * width + 2.0
    return holds and (is_close or asked[3] - asked[1] <= TOO_LARGE * height + 2.0)
