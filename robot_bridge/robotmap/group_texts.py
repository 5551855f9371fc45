"""The text of a large map part by part, by the groups that its obstacles stand in."""

from __future__ import annotations

import heapq
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .builder import group_of, map_of
from .clipping import clip
from .index import OutlineIndex
from .model import Border
from .outlines import Outlines
from .segments import oriented_segments
from .text import write_obstacles
from .usable import inspected
from .window import Window

_AT_ONCE = 1000
"""outlines whose obstacles are in memory together."""
_WINDOWS, _SIDE = 40, 60.0
"""Squares, and their metres, by which the size of all is estimated."""


class GroupText(NamedTuple):
    """The text of obstacles that stand one after the other, and the group that they are of."""

    group: str
    text: str


def group_texts(outlines: Outlines, border: Border) -> Iterator[GroupText]:
    """Yield the text of the map of ``border`` after its head, part by part; every ring is closed."""
    groups = [group_of(outlines, row) for row in range(len(outlines))]
    names = sorted(set(groups))
    places = {name: place for place, name in enumerate(names)}
    of = np.array([places[group] for group in groups], dtype=np.int64)
    order, ends = np.argsort(of, kind="stable"), np.cumsum(np.bincount(of, minlength=len(names)))
    for group, own in zip(names, np.split(order, ends[:-1]), strict=bool(names)):
        for begin in range(0, len(own), _AT_ONCE):
            if text := _text(outlines, own[begin : begin + _AT_ONCE], border):
                yield GroupText(group, text)


def merged(texts: Iterable[GroupText], more: Iterable[GroupText]) -> Iterator[GroupText]:
    """Yield both in the order of their groups; of one group ``more`` comes later."""
    return heapq.merge(texts, more, key=lambda part: part.group)


def size_in_binary(index: OutlineIndex, border: Border) -> int:
    """Return about how many bytes the map of ``border`` has in codec 1, told by some windows of it."""
    if not len(index.rows):
        return 0
    rows = index.rows[np.unique(np.linspace(0, len(index.rows) - 1, _WINDOWS).astype(np.int64))]
    texts, sampled = [], 0
    for x, y in rows[:, :2].tolist():
        near = index.map_of(Window(x / 100, y / 100, _SIDE, _SIDE))
        texts.append(write_obstacles(near.obstacles))
        sampled += near.segment_count
    if not sampled:
        return 0
    return len(zlib.compress("".join(texts).encode())) * index.count_near(border) // sampled


def _text(outlines: Outlines, rows: NDArray[Any], border: Border) -> str:
    """Return the text of the outlines ``rows``."""
    found = inspected(outlines.chosen(rows))
    segments = clip(oriented_segments(found.outlines, found.usable), border)
    own = replace(segments, outline=rows[segments.outline])
    return write_obstacles(map_of(outlines, own, border, None, ()).obstacles)
