"""Lines that meet end to end joined into one: a wall given face by face is one obstacle."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from .model import ShapeType
from .outlines import OutlineRow
from .watch import UNWATCHED, Watch

LINES = (ShapeType.OPEN_POLYGON, ShapeType.OPEN_CURVE)


class _End(NamedTuple):
    """One end of a line."""

    row: int
    last: bool


class _Part(NamedTuple):
    """One line of a chain, and whether it runs against it."""

    row: int
    backwards: bool


def chained(rows: Sequence[OutlineRow], watch: Watch = UNWATCHED) -> list[OutlineRow]:
    """Return ``rows`` with lines joined where exactly two of a kind meet, to the centimetre.

    Of a kind are lines that are alike in everything but points and source. A chain runs in the direction of
    its first line and stands in its place; its source is that of the first line and how many others are in
    it, ``walls:3+7``. Lines have no free side, so some are turned round. Raises CancelledError when ``watch``
    says so.
    """
    kinds: dict[Any, list[int]] = defaultdict(list)
    for k, row in enumerate(rows):
        if row.shape_type in LINES and len(row.points) > 1 and np.isfinite(row.points).all():
            kinds[_kind(row)].append(k)
    result = dict(enumerate(rows))
    for members in watch.over(list(kinds.values())):
        partners = _partners(rows, members)
        for k in members:
            if k in result:
                chain = _chain(k, partners)
                for part in chain:
                    del result[part.row]
                result[k] = _joined(rows, chain, k)
    return [result[k] for k in sorted(result)]


def _kind(row: OutlineRow) -> Any:
    extras = tuple(sorted(row.ext.items()))
    return row.shape_type, row.height, row.semantics, row.outdoor, row.base, extras


def _partners(rows: Sequence[OutlineRow], members: Sequence[int]) -> Mapping[_End, _End]:
    """Return for each end that meets exactly one other line's end, that end."""
    nodes: dict[tuple[float, float], list[_End]] = defaultdict(list)
    for k in members:
        for last in (False, True):
            x, y = np.round(rows[k].points[-1 if last else 0], 2).tolist()
            nodes[x, y].append(_End(k, last))
    partners: dict[_End, _End] = {}
    for ends in nodes.values():
        if len(ends) == 2 and ends[0].row != ends[1].row:
            partners[ends[0]], partners[ends[1]] = ends[1], ends[0]
    return partners


def _chain(k: int, partners: Mapping[_End, _End]) -> list[_Part]:
    """Return the chain that line ``k`` is in, in the direction of ``k``."""
    after, goes_round = _followed(_End(k, True), partners)
    before = [] if goes_round else _followed(_End(k, False), partners)[0]
    return [
        *(_Part(end.row, not end.last) for end in reversed(before)),
        _Part(k, False),
        *(_Part(end.row, end.last) for end in after),
    ]


def _followed(end: _End, partners: Mapping[_End, _End]) -> tuple[list[_End], bool]:
    """Return at which ends the lines beyond ``end`` are entered, and whether they come back to its line."""
    start = end.row
    entered: list[_End] = []
    while end in partners:
        met = partners[end]
        if met.row == start:
            return entered, True
        entered.append(met)
        end = _End(met.row, not met.last)
    return entered, False


def _joined(rows: Sequence[OutlineRow], chain: Sequence[_Part], first: int) -> OutlineRow:
    if len(chain) == 1:
        return rows[first]
    points = [rows[part.row].points[:: -1 if part.backwards else 1] for part in chain]
    return replace(
        rows[first],
        points=np.concatenate([points[0], *(line[1:] for line in points[1:])]),
        source=f"{rows[first].source}+{len(chain) - 1}" if rows[first].source else "",
    )
