"""What of a draft is looked at: places, and the ways between them.

Each is looked at by itself, so that after a change only what has changed is looked at again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np
from qgis.core import QgsCoordinateTransform, QgsGeometry, QgsProject, QgsRectangle, QgsVectorLayer

from ...language import tr
from ...sites.many_points import line_of
from ..drafts import ROUTE, START, Draft, Point, WayKind
from ..placement import Placement, transformed
from ..time_slices import Steps

Track = tuple[Point, ...]
"""One point is a place, several are a way; metres in the site frame."""
AT_BEGINNING_M = 0.5
"""Metres within which a robot stands where its route begins."""
AT_ONCE = 200
"""Tracks that become geometries between two looks at the clock."""


def legs(draft: Draft) -> Iterator[Track]:
    """Yield a draft's places and the way there, or each leg of a route with the point it leads on from."""
    if draft.kind != ROUTE:
        yield from _places(draft)
        if draft.way.line:
            yield draft.way.line
        return
    yield from _way_to_route(draft)
    for begin, end in _spans(draft):
        # The first click of several is where the second leg begins.
        if begin > 0 or end > 1 or len(draft.points) == 1:
            yield draft.points[max(0, begin - 1) : end]


def drawn_by_hand(draft: Draft) -> Iterator[Track]:
    """Yield the places of a draft and the straight way to it, and legs of a route that follow no roads.

    Legs along the roads are the gateway's, which knows obstacles as the site was published.
    """
    if draft.kind != ROUTE:
        yield from _places(draft)
        if draft.way.kind is WayKind.STRAIGHT:
            yield draft.way.line
        return
    yield from _way_to_route(draft)
    if len(draft.points) == 1:
        yield from _places(draft)
    for begin, end in _spans(draft):
        if end - begin == 1 and begin > 0:
            yield draft.points[begin - 1 : end]


def stops(draft: Draft) -> Iterator[Track]:
    """Yield the places of a draft, or those where the legs of a route end."""
    if draft.kind != ROUTE:
        yield from _places(draft)
        return
    for _, end in _spans(draft):
        yield (draft.points[end - 1],)


def is_looked_at(draft: Draft) -> bool:
    """Tell whether a draft is held against layers: where a robot says it stands it may have been put."""
    return draft.kind != START


def lines_in(
    tracks: Sequence[Track], placement: Placement, layer: QgsVectorLayer | None, project: QgsProject
) -> Steps[list[QgsGeometry]]:
    """Make geometries of tracks, in the CRS of ``layer``, or of the site for None.

    :raises PlacementError: when a point has no place in the layer's CRS.
    """
    flat = np.fromiter(chain.from_iterable(chain.from_iterable(tracks)), np.float64)
    yield 0.0
    corners = placement.frame.to_crs(flat.reshape(-1, 2))
    if layer is not None and layer.crs().isValid():
        corners = transformed(corners, QgsCoordinateTransform(placement.site_crs, layer.crs(), project))
    lines = []
    at = 0
    for number, track in enumerate(tracks):
        lines.append(line_of(corners[at : at + len(track)]))
        at += len(track)
        if number % AT_ONCE == 0:
            yield 0.0
    return lines


def boxes_of(lines: Sequence[QgsGeometry], around: float) -> Steps[list[QgsRectangle]]:
    """Return what each geometry takes up, and so much around it, in its own units."""
    boxes = []
    for number, line in enumerate(lines):
        boxes.append(line.boundingBox().buffered(around))
        if number % AT_ONCE == 0:
            yield 0.0
    return boxes


def place_in_words(track: Track) -> str:
    """Return the end of a track as operators read it."""
    x, y = track[-1]
    return tr("({x:.2f}, {y:.2f}) m", x=x, y=y)


def _way_to_route(draft: Draft) -> Iterator[Track]:
    """Yield the straight way of a robot to the beginning of its route, none to one that it stands at."""
    if draft.way.line and math.dist(*draft.way.line) > AT_BEGINNING_M:
        yield draft.way.line


def _places(draft: Draft) -> Iterator[Track]:
    for point in draft.points:
        yield (point,)


def _spans(draft: Draft) -> Iterator[tuple[int, int]]:
    """Yield the first point of each leg of a route, and the one after its last."""
    begin = 0
    for leg in draft.legs:
        yield begin, begin + leg
        begin += leg
