"""What stands after the counts of an obstacle's line, without repeating it for every obstacle."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

# The number in src=walls:1204 differs from obstacle to obstacle while all else stays. No written label holds
# the character that stands for it.
_NUMBER = re.compile(r"(?<=[;,]src=)([^,;=]*:)(0|[1-9][0-9]{0,8})(?=[,;+])")
_PLACE = "\x01"


def table_of(lines: Sequence[str]) -> tuple[list[str], NDArray[Any]]:
    """Return the different ones among ``lines`` in order of appearance, and the place of each, (n,) int64."""
    places: dict[str, int] = {}
    column = np.array([places.setdefault(line, len(places)) for line in lines], dtype=np.int64)
    return list(places), column


def without_numbers(lines: Sequence[str], otherwise: NDArray[Any]) -> tuple[list[str], NDArray[Any]]:
    """Return ``lines`` with a mark where their source's number was, and the numbers, (n,) int64.

    ``otherwise`` holds what stands for the number of a line without any.
    """
    numbers = otherwise.copy()
    marked = []
    for row, line in enumerate(lines):
        match = _NUMBER.search(line)
        if match:
            numbers[row] = int(match[2])
            line = line[: match.start(2)] + _PLACE + line[match.end() :]
        marked.append(line)
    return marked, numbers


def with_numbers(lines: Sequence[str], numbers: NDArray[Any]) -> list[str]:
    """Return ``lines`` with their numbers where the marks are."""
    return [
        line.replace(_PLACE, str(n), 1) if _PLACE in line else line
        for line, n in zip(lines, numbers.tolist(), strict=True)
    ]
