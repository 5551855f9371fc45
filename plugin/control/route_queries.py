"""Queries to the gateway for routes along the roads to the mouse, and routes in words."""

from __future__ import annotations

import itertools
from dataclasses import asdict, dataclass
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.messages.roads import GetRoute, RouteReport, route_report
from ..gateway_client.fleet_state import OperatorRequest, RequestResult
from ..ui.errors import NotSentError
from ..ui.language import tr
from .pending_command import Point
from .request_tracker import SLOW_AFTER, RequestSender

UNANSWERED_AFTER = 3.0
"""Seconds after which a query that follows the mouse counts as lost, so that the next is sent."""


@dataclass(frozen=True)
class RoutePreferences:
    """Preferences for a route; by default the shortest way along all roads.

    ``surfaces`` names those that may be used, empty for all. ``least_width`` is the least width of a road
    in metres, besides the width of the site's robots. ``avoid_reserved`` leaves out roads that are reserved
    for other robots' tasks.
    """

    fastest: bool = False
    surfaces: tuple[str, ...] = ()
    least_width: float = 0.0
    avoid_reserved: bool = False

    def in_words(self) -> list[str]:
        """Return the preferences beyond the shortest way, a text for each."""
        words = []
        if self.fastest:
            words.append(tr("the fastest way"))
        if self.avoid_reserved:
            words.append(tr("off the roads of other robots"))
        if self.surfaces:
            words.append(tr("only on {surfaces}", surfaces=", ".join(self.surfaces)))
        if self.least_width:
            words.append(tr("roads at least {metres:g} m wide", metres=self.least_width))
        return words


SHORTEST = RoutePreferences()


@dataclass(frozen=True)
class RouteQuestion:
    """A robot's way from where it is, or from ``start``, to ``goal``; ``taken`` when that was clicked."""

    robot: str
    start: Point | None
    goal: Point
    taken: bool = False
    preferences: RoutePreferences = SHORTEST


class RouteQuery(QObject):
    """Sends a query whenever the last one was answered, never two at once: the route shown is current."""

    shown = pyqtSignal()
    """The route to show has changed, or is gone."""
    answered = pyqtSignal(object, object)
    """The answer to a clicked query: the :class:`RouteQuestion` and its RouteReport."""
    refused = pyqtSignal(str)
    """There is no route to the clicked place: the reason."""
    dropped = pyqtSignal(object)
    """Clicked queries will not be answered: the list of their RouteQuestions."""

    def __init__(
        self,
        sender: RequestSender,
        clock: Clock,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._sender = sender
        self._clock = clock
        self._numbers = itertools.count(1)
        self._pending: tuple[str, RouteQuestion, float] | None = None
        self._next: RouteQuestion | None = None
        self.route: RouteReport | None = None
        self.preferences = SHORTEST
        """The preferences for that route."""
        self.why_not = ""
        """Why there is no route to the mouse."""

    @property
    def awaits_click(self) -> bool:
        """Whether a route to a clicked place has not been answered yet."""
        if not self._waits():
            return False
        return self._pending[1].taken or (self._next is not None and self._next.taken)

    def want(self, question: RouteQuestion) -> None:
        """Request a route, now or when the query before is answered; raises NotSentError."""
        self.watch()
        if self._waits():
            if self._next is None or not self._next.taken or question.taken:
                self._next = question
            return
        self._ask(question)

    def forget(self) -> None:
        """Show no route, and ignore answers still to come."""
        questions = [self._pending[1]] if self._pending is not None else []
        questions += [self._next] if self._next is not None else []
        self._pending = self._next = self.route = None
        self.why_not = ""
        self.shown.emit()
        if clicked := [question for question in questions if question.taken]:
            self.dropped.emit(clicked)

    def accept_answer(self, answer: RequestResult) -> bool:
        """Handle an answer; return false when it belongs to another request."""
        if answer.order.method != GetRoute.method:
            return False
        if self._pending is None or answer.order.key != self._pending[0]:
            return True
        question, self._pending = self._pending[1], None
        self._show(question, *route_in(answer))
        self._ask_next()
        return True

    def watch(self) -> None:
        """Give up a query that waits too long for its answer, and report it if it was clicked.

        One that only follows the mouse is given up when another waits behind it.
        """
        if self._pending is None or self._waits():
            return
        question = self._pending[1]
        if not question.taken and self._next is None:
            return
        self._pending = None
        if question.taken:
            self._show(question, None, _click_unanswered())
        self._ask_next()

    def _waits(self) -> bool:
        """Whether a query is pending whose answer may still come in time."""
        if self._pending is None:
            return False
        _, question, requested_at = self._pending
        return self._clock.steady() - requested_at < (SLOW_AFTER if question.taken else UNANSWERED_AFTER)

    def _ask_next(self) -> None:
        if self._next is None or self._pending is not None:
            # Whoever received the answer may have asked for the next leg.
            return
        try:
            self._ask(self._next)
        except NotSentError:
            self.forget()
        else:
            self._next = None

    def _show(self, question: RouteQuestion, route: RouteReport | None, why_not: str) -> None:
        self.route, self.preferences, self.why_not = route, question.preferences, why_not
        self.shown.emit()
        if question.taken and self.route is not None:
            self.answered.emit(question, self.route)
        elif question.taken:
            self.refused.emit(self.why_not)

    def _ask(self, question: RouteQuestion) -> None:
        from_robot = question.start is None
        request = GetRoute(
            *question.goal,
            robot=question.robot if from_robot else None,
            start=question.start,
            **_restrictions(question.preferences),
        )
        key = f"route-{id(self)}-{next(self._numbers)}"
        self._sender.submit(OperatorRequest.of(key, request, self._clock.steady()))
        self._pending = key, question, self._clock.steady()


def route_in(answer: RequestResult) -> tuple[RouteReport | None, str]:
    """Return the route in the answer to a GetRoute, and why there is none."""
    if answer.error is not None:
        return None, answer.error
    try:
        return route_report(answer.result or {}), ""
    except (KeyError, TypeError, ValueError):
        return None, tr("the gateway's answer holds no way; it may be older than this plugin")


def _click_unanswered() -> str:
    return tr(
        "The gateway has not answered for {seconds:g} s which way leads to where you clicked, so the route "
        "does not go there. Click there again.",
        seconds=SLOW_AFTER,
    )


def _restrictions(preferences: RoutePreferences) -> dict[str, Any]:
    """Return preferences as the query's parameters."""
    return {**asdict(preferences), "surfaces": list(preferences.surfaces) or None}


def route_in_words(route: RouteReport, preferences: RoutePreferences, apart: str = "; ") -> str:
    """Return a route's length, time and surfaces, its preferences, and what is not as it should be.

    ``apart`` separates these.
    """
    minutes, seconds = divmod(round(route.seconds), 60)
    time = (
        tr(
            "{minutes} min {seconds} s",
            minutes=minutes,
            seconds=seconds,
        )
        if minutes
        else tr("{seconds} s", seconds=seconds)
    )
    surfaces = [(one.metres, one.surface or tr("surface not known")) for one in route.surfaces]
    # With one surface, use the length of the route, which cuts corners that the roads have.
    parts = (
        [tr("{metres:.0f} m {surface}", metres=metres, surface=surface) for metres, surface in surfaces]
        if len(surfaces) > 1
        else [surface for _, surface in surfaces]
    )
    text = ", ".join([tr("{metres:.1f} m", metres=route.metres), time, *parts])
    if preferences.in_words():
        text += apart + ", ".join(preferences.in_words())
    if route.tight:
        text += apart + tr("corners tighter than the robot turns: {tight}", tight=len(route.tight))
    return text + apart + route.note if route.note else text
