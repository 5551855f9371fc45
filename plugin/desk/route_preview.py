"""The way along the roads to where the mouse is: asked of the gateway, one at a time and newest first."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.messages import GetRoute, RouteReport, route_report, to_json
from ..errors import NotSentError
from ..language import tr
from ..wire.outbox import Answer, Order
from .drafts import Point
from .orders import SLOW_AFTER
from .way_wishes import SHORTEST, WayWishes

UNANSWERED_AFTER = 3.0
"""Seconds after which a question that follows the mouse is taken to be lost, so that the next is asked."""


@dataclass(frozen=True)
class Question:
    """A robot's way from where it is, or from ``start``, to ``goal``; ``taken`` when that was clicked."""

    robot: str
    start: Point | None
    goal: Point
    taken: bool = False
    wishes: WayWishes = SHORTEST


class RoutePreview(QObject):
    """Asks as often as the gateway answers, and never twice at once: what is shown is never long outdated."""

    shown = pyqtSignal()
    """There is another way to show, or none."""
    answered = pyqtSignal(object, object)
    """A question that was taken: the :class:`Question` and its RouteReport."""
    refused = pyqtSignal(str)
    """There is no way to where the operator clicked: why."""

    def __init__(
        self,
        submit: Callable[[Order], None],
        clock: Callable[[], float],
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._submit = submit
        self._clock = clock
        self._numbers = itertools.count(1)
        self._asked: tuple[str, Question, float] | None = None
        self._next: Question | None = None
        self.route: RouteReport | None = None
        self.wishes = SHORTEST
        """What was wanted of that way."""
        self.why_not = ""
        """Why there is no way to where the mouse is."""

    @property
    def awaits_click(self) -> bool:
        """Whether a way to where the operator clicked is still to be answered."""
        if not self._waits():
            return False
        return self._asked[1].taken or (self._next is not None and self._next.taken)

    def want(self, question: Question) -> None:
        """Ask for a way, now or when the question before is answered; raises NotSentError."""
        if self._waits():
            if self._next is None or not self._next.taken or question.taken:
                self._next = question
            return
        self._ask(question)

    def forget(self) -> None:
        """Show no way, and take no answer any more."""
        self._asked = self._next = self.route = None
        self.why_not = ""
        self.shown.emit()

    def accept_answer(self, answer: Answer) -> bool:
        """Take in the answer to a question; false when it is one to something else."""
        if answer.order.method != GetRoute.method:
            return False
        if self._asked is None or answer.order.key != self._asked[0]:
            return True
        question, self._asked = self._asked[1], None
        self._show(question, *way_in(answer))
        self._ask_next()
        return True

    def watch(self) -> None:
        """Give up a question that waits for its answer too long, and say so of one that was taken.

        One that only follows the mouse is given up when another waits behind it.
        """
        if self._asked is None or self._waits():
            return
        question = self._asked[1]
        if not question.taken and self._next is None:
            return
        self._asked = None
        if question.taken:
            self._show(question, None, _unanswered())
        self._ask_next()

    def _waits(self) -> bool:
        """Whether a question is asked whose answer may still come in time."""
        if self._asked is None:
            return False
        _, question, asked_at = self._asked
        return self._clock() - asked_at < (SLOW_AFTER if question.taken else UNANSWERED_AFTER)

    def _ask_next(self) -> None:
        following, self._next = self._next, None
        if following is None:
            return
        try:
            self._ask(following)
        except NotSentError:
            self.forget()

    def _show(self, question: Question, route: RouteReport | None, why_not: str) -> None:
        self.route, self.wishes, self.why_not = route, question.wishes, why_not
        self.shown.emit()
        if question.taken and self.route is not None:
            self.answered.emit(question, self.route)
        elif question.taken:
            self.refused.emit(self.why_not)

    def _ask(self, question: Question) -> None:
        from_robot = question.start is None
        request = GetRoute(
            *question.goal,
            robot=question.robot if from_robot else None,
            start=question.start,
            **_restrictions(question.wishes),
        )
        key = f"route-{id(self)}-{next(self._numbers)}"
        self._submit(Order(key, request.method, to_json(request), self._clock()))
        self._asked = key, question, self._clock()


def way_in(answer: Answer) -> tuple[RouteReport | None, str]:
    """Return the way that the answer to a GetRoute holds, and why it holds none."""
    if answer.error is not None:
        return None, answer.error
    try:
        return route_report(answer.result or {}), ""
    except (KeyError, TypeError, ValueError):
        return None, tr("the gateway's answer holds no way; it may be older than this plugin")


def _unanswered() -> str:
    return tr(
        "The gateway has not answered for {seconds:g} s which way leads to where you clicked, so the route "
        "does not go there. Click there again.",
        seconds=SLOW_AFTER,
    )


def _restrictions(wishes: WayWishes) -> dict[str, Any]:
    """Return wishes as the question's parameters."""
    return {**asdict(wishes), "surfaces": list(wishes.surfaces) or None}


def in_words(route: RouteReport, wishes: WayWishes, apart: str = "; ") -> str:
    """Return a way's length, time and surfaces, what was wanted of it, and what is not as it should be.

    ``apart`` stands between these.
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
    # Of one surface the metres are those of the way, which cuts corners that the roads' have.
    parts = (
        [tr("{metres:.0f} m {surface}", metres=metres, surface=surface) for metres, surface in surfaces]
        if len(surfaces) > 1
        else [surface for _, surface in surfaces]
    )
    text = ", ".join([tr("{metres:.1f} m", metres=route.metres), time, *parts])
    if wishes.in_words():
        text += apart + ", ".join(wishes.in_words())
    if route.tight:
        text += apart + tr("corners tighter than the robot turns: {tight}", tight=len(route.tight))
    return text + apart + route.note if route.note else text
