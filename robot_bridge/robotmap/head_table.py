"""What stands after the counts of an obstacle's line, without repeating it for every obstacle."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

# The number in src=walls:1204 differs from obstacle to obstacle while all else stays, and so does the second
# one in src=walls:1204+3. No written label holds the characters that stand for them.
_NUMBER = re.compile(r"(?<=[;,]src=)([^,;=]*:)(0|[1-9][0-9]{0,8})(?:\+([1-9][0-9]{0,8}))?(?=[,;])")
_ALONE, _WITH_OTHERS = "\x01", "\x02"


class Heads(NamedTuple):
    """Lines with marks where their numbers were, and the numbers as differences from what is expected.

    ``numbers``, (m,) int64, are those of the m lines with a mark; ``others``, (p,), those of the p lines with
    the second one, which may be 0 and is not written then.
    """

    lines: list[str]
    numbers: NDArray[Any]
    others: NDArray[Any]


def table_of(lines: Sequence[str]) -> tuple[list[str], NDArray[Any]]:
    """Return the different ones among ``lines`` in order of appearance, and the place of each, (n,) int64."""
    places: dict[str, int] = {}
    column = np.array([places.setdefault(line, len(places)) for line in lines], dtype=np.int64)
    return list(places), column


def without_numbers(lines: Sequence[str], counts: NDArray[Any]) -> Heads:
    """Return ``lines`` of obstacles with ``counts`` segments each, (n,) int64, without their numbers.

    The number of others is expected to be that of the segments less one, and a number to follow all that
    the line before it stands for.
    """
    found = [_NUMBER.search(line) for line in lines]
    bare = [_marked(line, match, _ALONE) if match else line for line, match in zip(lines, found, strict=True)]
    chained = {line for line, match in zip(bare, found, strict=True) if match and match[3]}
    marked = [line.replace(_ALONE, _WITH_OTHERS) if line in chained else line for line in bare]
    numbers = [(int(match[2]), int(match[3] or 0)) for match in found if match]
    number, others = np.array(numbers, dtype=np.int64).reshape(-1, 2).T
    expected = np.concatenate([[0], (number + 1 + others)[:-1]])[: len(number)]
    with_others = _marks(marked, _WITH_OTHERS)
    kept = with_others[_marks(marked, _ALONE) | with_others]
    return Heads(marked, number - expected, others[kept] - (counts[with_others] - 1))


def with_numbers(heads: Heads, counts: NDArray[Any]) -> list[str]:
    """Return the lines that :func:`without_numbers` was given; ``counts`` as there."""
    with_others = _marks(heads.lines, _WITH_OTHERS)
    marked = _marks(heads.lines, _ALONE) | with_others
    others = np.zeros(len(heads.lines), dtype=np.int64)
    others[with_others] = heads.others + counts[with_others] - 1
    others = others[marked]
    number = np.cumsum(heads.numbers) + np.cumsum(others + 1) - (others + 1)
    written = iter(
        f"{n}+{more}" if more else str(n) for n, more in zip(number.tolist(), others.tolist(), strict=True)
    )
    return [
        re.sub("[\x01\x02]", lambda _: next(written), line, count=1) if has else line
        for line, has in zip(heads.lines, marked.tolist(), strict=True)
    ]


def marks_in(lines: Sequence[str]) -> tuple[int, int]:
    """Return how many of ``lines`` have a number, and how many of them one of others."""
    with_others = _marks(lines, _WITH_OTHERS)
    return int((_marks(lines, _ALONE) | with_others).sum()), int(with_others.sum())


def _marked(line: str, match: re.Match[str], mark: str) -> str:
    return line[: match.start(2)] + mark + line[match.end() :]


def _marks(lines: Sequence[str], mark: str) -> NDArray[Any]:
    return np.array([mark in line for line in lines], dtype=bool)
