"""What obstacles have in common that differ only in where they stand, such as benches of one kind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray


def firsts_of(
    parts: Sequence[tuple[NDArray[Any], NDArray[Any]]], count: int
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return which of ``count`` obstacles are the first of their kind, and the kind of each, (count,).

    Each of ``parts`` is a column and how many of its rows each obstacle has, (count,); obstacles are of one
    kind when all their rows are the same.
    """
    pieces = [_pieces(column, lengths) for column, lengths in parts]
    kinds: dict[tuple[bytes, ...], int] = {}
    kind = np.array(
        [kinds.setdefault(own, len(kinds)) for own in zip(*pieces, strict=True)], dtype=np.int64
    ).reshape(count)
    return np.unique(kind, return_index=True)[1], kind


def rows_of(which: NDArray[Any], lengths: NDArray[Any]) -> NDArray[Any]:
    """Return the rows of the obstacles ``which``, one after the other, where each has ``lengths`` rows."""
    own = lengths[which]
    shift = (np.cumsum(lengths) - lengths)[which] - (np.cumsum(own) - own)
    rows: NDArray[Any] = np.repeat(shift, own) + np.arange(int(own.sum()))
    return rows


def backwards(kind: NDArray[Any]) -> NDArray[Any]:
    """Return 0 for the first of each kind, else how many kinds back from the newest one it is, (n,) int64."""
    newest = np.maximum.accumulate(np.concatenate([[-1], kind]))[:-1] + 1
    back: NDArray[Any] = newest - kind
    return back


def forwards(back: NDArray[Any]) -> NDArray[Any]:
    """Return the kind of each: what :func:`backwards` was given."""
    kind: NDArray[Any] = np.cumsum(back == 0) - np.maximum(back, 1)
    return kind


def _pieces(column: NDArray[Any], lengths: NDArray[Any]) -> list[bytes]:
    content = np.ascontiguousarray(column).tobytes()
    size = len(content) // len(column) if len(column) else 0
    ends = (size * np.cumsum(lengths)).tolist()
    return [content[start:end] for start, end in zip([0, *ends[:-1]], ends, strict=True)] if ends else []
