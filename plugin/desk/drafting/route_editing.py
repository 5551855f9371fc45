"""Changes of a route that is drawn: vertices moved, put in, taken out, and the whole turned round.

Legs that follow the roads are the gateway's: their points are no vertices and are not changed by hand.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import accumulate

from ...errors import FleetError
from ...language import tr
from ..drafts import Draft, Findings, Point


class RouteEditError(FleetError):
    """A route cannot be changed so."""


def vertices(draft: Draft) -> list[int]:
    """Return the points that were clicked one by one, in order."""
    ends = accumulate(draft.legs)
    return [end - 1 for leg, end in zip(draft.legs, ends, strict=True) if leg == 1]


def moved(draft: Draft, vertex: int, to: Point) -> Draft:
    """Return the route with a vertex at another place, unchecked."""
    _check_vertex(draft, vertex)
    points = (*draft.points[:vertex], to, *draft.points[vertex + 1 :])
    return _changed(draft, points, draft.legs)


def inserted(draft: Draft, before: int, at: Point) -> Draft:
    """Return the route with another vertex in front of point ``before``, which ends a straight leg.

    :raises RouteEditError: where the route follows the roads there.
    """
    _check_vertex(draft, before)
    leg = _leg_of(draft, before)
    points = (*draft.points[:before], at, *draft.points[before:])
    return _changed(draft, points, (*draft.legs[:leg], 1, *draft.legs[leg:]))


def deleted(draft: Draft, vertex: int) -> Draft | None:
    """Return the route without a vertex, unchecked; None where nothing is left."""
    _check_vertex(draft, vertex)
    leg = _leg_of(draft, vertex)
    legs = (*draft.legs[:leg], *draft.legs[leg + 1 :])
    if not legs:
        return None
    return _changed(draft, (*draft.points[:vertex], *draft.points[vertex + 1 :]), legs)


def turned_round(draft: Draft) -> Draft:
    """Return the route from its end to its beginning, unchecked.

    :raises RouteEditError: when a part follows the roads: the way back may be another.
    """
    if len(vertices(draft)) < len(draft.points):
        raise RouteEditError(
            tr(
                "A part of this route follows the roads, and the way back may be another: it is not turned "
                "round. Draw it from the other end with Route on roads."
            )
        )
    return _changed(draft, draft.points[::-1], draft.legs)


def _changed(draft: Draft, points: tuple[Point, ...], legs: tuple[int, ...]) -> Draft:
    return replace(draft, points=points, legs=legs, findings=Findings(), override=None, is_checked=False)


def _leg_of(draft: Draft, vertex: int) -> int:
    return list(accumulate(draft.legs)).index(vertex + 1)


def _check_vertex(draft: Draft, vertex: int) -> None:
    if vertex not in vertices(draft):
        raise RouteEditError(
            tr(
                "This part of the route follows the roads and is not changed by hand. Take it back with "
                "Backspace, or draw this part with Draw route."
            )
        )
