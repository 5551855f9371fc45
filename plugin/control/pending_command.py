"""The pending command: the operator's draft, its changes, and its conversion to tasks of a queue."""

from __future__ import annotations

import math
import uuid
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from itertools import accumulate, chain
from typing import Any

import numpy as np
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.messages.base import to_json
from ...robot_bridge.core.messages.queues import QueueTask, TaskKind
from ...robot_bridge.core.messages.robots import SetPath, SetPosEnd, SetPosIni
from ..ui.errors import FleetError, NotSentError
from ..ui.language import tr, tr_count

Point = tuple[float, float]

CONE = "cone"
ROUTE = "route"
START = "start"
TARGETS = "targets"

LEAST_POINTS = 2
"""Points required for a route."""
MOST_STEPS = 100
"""Drafts kept for undo."""


@dataclass(frozen=True)
class Findings:
    """The findings of a check of a draft.

    ``refused`` forbids sending it. ``overridable`` does so until an operator overrides it, with a reason.
    ``warnings`` do not. ``of_way`` are those of all these that are about the way to a target from the present
    position of its robot: a task of a queue is driven from elsewhere.
    """

    refused: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    overridable: tuple[str, ...] = ()
    of_way: tuple[str, ...] = ()

    def __add__(self, other: Findings) -> Findings:
        return Findings(
            self.refused + other.refused,
            self.warnings + other.warnings,
            self.overridable + other.overridable,
            self.of_way + other.of_way,
        )

    @property
    def faults(self) -> tuple[str, ...]:
        """Findings that forbid sending it."""
        return self.refused + self.overridable

    @property
    def all_texts(self) -> frozenset[str]:
        """All findings."""
        return frozenset(self.refused + self.warnings + self.overridable)

    def without_way(self) -> Findings:
        """Return the findings except those on the way to a target."""
        kinds = (self.refused, self.warnings, self.overridable)
        return Findings(*(tuple(text for text in kind if text not in self.of_way) for kind in kinds))


class ApproachKind(Enum):
    """How a robot gets to a cone target, or to the beginning of its route."""

    UNKNOWN = "unknown"
    """Unknown: the robot has not reported its position, or the gateway does not answer."""
    SOUGHT = "sought"
    """The gateway has been asked for the way along the roads."""
    STRAIGHT = "straight"
    """The target or route is sent, and the robot drives straight to it."""
    PATH = "path"
    """The way is sent, with the cone at its end."""
    ON_REQUEST = "asked"
    """The target is sent, and the robot asks the gateway for the same way."""


@dataclass(frozen=True)
class Approach:
    """The way to a cone target, or to the beginning of a route, from the robot: metres, site frame.

    ``note`` is shown to operators, ``refusal`` is why it cannot be driven. ``declared`` is what the
    robot had declared of its paths when the way was found.
    """

    kind: ApproachKind = ApproachKind.UNKNOWN
    line: tuple[Point, ...] = ()
    note: str = ""
    refusal: str = ""
    declared: str | None = None

    @property
    def findings(self) -> Findings:
        """Findings about it, besides obstacles in its way."""
        if self.refusal:
            return Findings(refused=(self.refusal,), of_way=(self.refusal,))
        if self.note and not self.is_along_roads:
            return Findings(warnings=(self.note,), of_way=(self.note,))
        return Findings()

    @property
    def is_along_roads(self) -> bool:
        """Whether it leads along the roads."""
        return self.kind in (ApproachKind.PATH, ApproachKind.ON_REQUEST)


NO_APPROACH = Approach()


@dataclass(frozen=True)
class PendingCommand:
    """A cone target or start position (one point), a route (its points) or several cone targets.

    Points are metres in the site frame. ``robot`` is the one that was selected when the draft was begun:
    another selection does not change it. ``legs`` is how many of a route's points each click added: one,
    or a way along the roads. ``note`` is shown to the operator about such ways. ``theta`` is the heading of
    a start position. ``names`` are those of several targets. ``override`` is why it is sent in spite of
    overridable findings. There are no findings yet unless it ``is_checked``. ``way`` leads to a cone
    target, or to the beginning of a route; with ``is_direct`` the operator wants it straight. A robot that
    cannot place cones is sent there without: ``places_cone`` is false then.
    """

    robot: str
    kind: str
    points: tuple[Point, ...]
    findings: Findings = field(default_factory=Findings)
    legs: tuple[int, ...] = ()
    note: str = ""
    theta: float | None = None
    names: tuple[str, ...] = ()
    override: str | None = None
    is_checked: bool = False
    way: Approach = NO_APPROACH
    is_direct: bool = False
    places_cone: bool = True

    def with_leg(self, points: tuple[Point, ...], note: str = "") -> PendingCommand:
        """Return the route with another leg, unchecked."""
        notes = " + ".join(text for text in (self.note, note) if text)
        legs = (*self.legs, len(points))
        return PendingCommand(self.robot, self.kind, self.points + points, legs=legs, note=notes)

    def without_last_leg(self) -> PendingCommand | None:
        """Return the route without its last leg, unchecked; None where nothing is left."""
        left = self.points[: -self.legs[-1]] if self.legs else ()
        if not left:
            return None
        note = self.note.rpartition(" + ")[0] if self.legs[-1] > 1 else self.note
        return PendingCommand(self.robot, self.kind, left, legs=self.legs[:-1], note=note)

    @property
    def place(self) -> tuple[str, str, tuple[Point, ...]]:
        """The key that distinguishes drafts: robot, kind and places."""
        return self.robot, self.kind, self.points

    @property
    def fault(self) -> str | None:
        """The reason why it cannot be sent, None if it can."""
        if self.kind == ROUTE and len(self.points) < LEAST_POINTS:
            return tr("a route needs at least two points: click the next one")
        if self.way.kind is ApproachKind.SOUGHT:
            return tr("the way there is not known yet")
        if not self.is_checked:
            return tr("it has not been checked to its end")
        return in_brief(self.findings.refused if self.override else self.findings.faults) or None

    def as_task(self) -> PendingCommand:
        """Return the draft as a task of a queue: the way to it is found when its turn comes."""
        return replace(self, way=NO_APPROACH, findings=self.findings.without_way())

    @property
    def can_be_overridden(self) -> bool:
        """Return whether only an override is missing."""
        return bool(self.findings.overridable) and replace(self, override="all").fault is None

    @property
    def outline(self) -> tuple[Point, ...]:
        """The line to draw: the points, the way along the roads to a target, heading of a start position."""
        if self.way.is_along_roads:
            return self.way.line
        if self.theta is None:
            return self.points
        ((x, y),) = self.points
        return ((x, y), (x + math.cos(self.theta), y + math.sin(self.theta)))

    @cached_property
    def length(self) -> float:
        """Metres from the first point along all others."""
        flat = np.fromiter(chain.from_iterable(self.points), np.float64)
        steps = np.diff(flat.reshape(-1, 2), axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    def message(self) -> tuple[str, dict[str, Any]]:
        """Return the operation and its parameters."""
        x, y = self.points[0]
        if self.kind == CONE and self.way.kind is ApproachKind.PATH:
            return SetPath.__name__, to_json(SetPath(list(self.way.line), cone=self.places_cone or None))
        if self.kind == CONE:
            return SetPosEnd.__name__, to_json(SetPosEnd(x, y, cone=self.places_cone))
        if self.kind == START:
            return SetPosIni.__name__, to_json(SetPosIni(x, y, self.theta))
        return SetPath.__name__, to_json(SetPath(list(self.points)))

    def in_words(self) -> str:
        """Return the command and its robot in words."""
        if self.kind == CONE:
            cone = tr("Cone for {robot} at {place}", robot=self.robot, place=_place(self.points[0]))
            return cone + self._way_in_words()
        if self.kind == START:
            turned = (
                ""
                if self.theta is None
                else tr(
                    ", theta {degrees:.0f}°",
                    degrees=math.degrees(self.theta),
                )
            )
            return tr(
                "Start position of {robot} at {place}{turned}",
                robot=self.robot,
                place=_place(self.points[0]),
                turned=turned,
            )
        if self.kind == TARGETS:
            return tr_count(len(self.points), "1 cone for {robot}", "%n cones for {robot}", robot=self.robot)
        along_roads = tr("; along the roads {note}", note=self.note) if self.note else ""
        return tr(
            "Route for {robot}: {points} points, {length:.1f} m{along_roads}",
            robot=self.robot,
            points=len(self.points),
            length=self.length,
            along_roads=along_roads,
        )

    def _way_in_words(self) -> str:
        if self.way.is_along_roads:
            return tr("; along the roads {note}", note=self.way.note)
        if self.way.kind is ApproachKind.SOUGHT:
            return tr("; the way there is being found")
        if self.is_direct:
            return tr("; straight")
        return ""


class PendingCommandModel(QObject):
    """Holds the single draft, notifies views when it changes, and supports undo and redo."""

    changed = pyqtSignal()
    pointed = pyqtSignal()

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self.draft: PendingCommand | None = None
        self.is_dragged = False
        """Whether the draft is being dragged with the mouse, and is replaced at each move."""
        self.cursor: Point | None = None
        self._before: list[PendingCommand | None] = []
        self._after: list[PendingCommand | None] = []

    def set_command(self, draft: PendingCommand | None) -> None:
        """Set ``draft`` as the current one, None for no draft."""
        if draft is not None or self.draft is not None:
            self._before = [*self._before, self.draft][-MOST_STEPS:]
            self._after = []
        self._show(draft)

    def renew(self, draft: PendingCommand) -> None:
        """Replace the present draft by ``draft``, which differs from it in findings or override only."""
        self._show(draft, cursor=self.cursor)

    def drag(self, draft: PendingCommand) -> None:
        """Show ``draft`` as the mouse drags it; :meth:`renew` or :meth:`set_command` ends it."""
        self._show(draft, is_dragged=True)

    def done(self) -> None:
        """Remove the draft for good: it was sent, or belongs to another site."""
        self.forget_changes()
        self._show(None)

    def forget_changes(self) -> None:
        """Clear the history for undo and redo."""
        self._before, self._after = [], []

    @property
    def can_undo(self) -> bool:
        """Return whether there is an earlier draft."""
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        """Return whether a change was undone."""
        return bool(self._after)

    def undo(self) -> bool:
        """Return to the draft before the last change; false when there is none."""
        return self._go(self._before, self._after)

    def redo(self) -> bool:
        """Repeat the change that was undone last; false when there is none."""
        return self._go(self._after, self._before)

    def point_at(self, cursor: Point | None) -> None:
        """Set the position of the mouse, in the site frame, for the preview of the next leg."""
        self.cursor = cursor
        self.pointed.emit()

    def _go(self, here: list[PendingCommand | None], there: list[PendingCommand | None]) -> bool:
        if not here:
            return False
        there.append(self.draft)
        self._show(here.pop())
        return True

    def _show(
        self, draft: PendingCommand | None, is_dragged: bool = False, cursor: Point | None = None
    ) -> None:
        self.draft = draft
        self.is_dragged = is_dragged
        self.cursor = cursor
        self.changed.emit()


def in_brief(texts: Sequence[str], most: int = 3) -> str:
    """Return the first of ``texts`` and the number of the others: for a whole layer there may be hundreds."""
    more = len(texts) - most
    return " ".join([*texts[:most], *([tr("And {more} more.", more=more)] if more > 0 else [])])


def _place(point: Point) -> str:
    return tr("{x:.2f}, {y:.2f} m", x=point[0], y=point[1])


# Legs that follow the roads come from the gateway: their points are no vertices and not edited by hand.


class RouteEditError(FleetError):
    """A route cannot be changed in this way."""


def vertices(draft: PendingCommand) -> list[int]:
    """Return the indices of the points that were clicked one by one, in order."""
    ends = accumulate(draft.legs)
    return [end - 1 for leg, end in zip(draft.legs, ends, strict=True) if leg == 1]


def moved(draft: PendingCommand, vertex: int, to: Point) -> PendingCommand:
    """Return the route with a vertex moved to another place, unchecked."""
    _check_vertex(draft, vertex)
    points = (*draft.points[:vertex], to, *draft.points[vertex + 1 :])
    return _changed(draft, points, draft.legs)


def inserted(draft: PendingCommand, before: int, at: Point) -> PendingCommand:
    """Return the route with another vertex in front of point ``before``, which ends a straight leg.

    :raises RouteEditError: where the route follows the roads there.
    """
    _check_vertex(draft, before)
    leg = _leg_of(draft, before)
    points = (*draft.points[:before], at, *draft.points[before:])
    return _changed(draft, points, (*draft.legs[:leg], 1, *draft.legs[leg:]))


def deleted(draft: PendingCommand, vertex: int) -> PendingCommand | None:
    """Return the route without a vertex, unchecked; None where nothing is left."""
    _check_vertex(draft, vertex)
    leg = _leg_of(draft, vertex)
    legs = (*draft.legs[:leg], *draft.legs[leg + 1 :])
    if not legs:
        return None
    return _changed(draft, (*draft.points[:vertex], *draft.points[vertex + 1 :]), legs)


def turned_round(draft: PendingCommand) -> PendingCommand:
    """Return the route reversed, unchecked.

    :raises RouteEditError: when a part follows the roads: the way back may differ.
    """
    if len(vertices(draft)) < len(draft.points):
        raise RouteEditError(
            tr(
                "A part of this route follows the roads, and the way back may be another: it is not turned "
                "round. Draw it from the other end with Route on roads."
            )
        )
    return _changed(draft, draft.points[::-1], draft.legs)


def _changed(draft: PendingCommand, points: tuple[Point, ...], legs: tuple[int, ...]) -> PendingCommand:
    return replace(draft, points=points, legs=legs, findings=Findings(), override=None, is_checked=False)


def _leg_of(draft: PendingCommand, vertex: int) -> int:
    return list(accumulate(draft.legs)).index(vertex + 1)


def _check_vertex(draft: PendingCommand, vertex: int) -> None:
    if vertex not in vertices(draft):
        raise RouteEditError(
            tr(
                "This part of the route follows the roads and is not changed by hand. Take it back with "
                "Backspace, or draw this part with Draw route."
            )
        )


def queue_tasks(draft: PendingCommand) -> list[QueueTask]:
    """Return the tasks that a draft consists of, in order.

    :raises NotSentError: for a draft that cannot be a task.
    """
    if draft.kind == START:
        raise NotSentError(tr("A start position is no task: Send tells the robot at once."))
    if draft.kind in (CONE, TARGETS):
        names = draft.names or (None,) * len(draft.points)
        return [
            QueueTask(str(uuid.uuid4()), x, y, kind=TaskKind.PLACE, cone=name)
            for (x, y), name in zip(draft.points, names, strict=True)
        ]
    x, y = draft.points[-1]
    return [QueueTask(str(uuid.uuid4()), x, y, path=list(draft.points))]
