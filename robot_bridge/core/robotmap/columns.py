"""Parts of codec 2: columns of numbers, paths, repeated shapes, heads, CBOR, limits for readers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import MapBinaryError, MissingCodecError, installation

# --- Limits of unpacking a binary map by the size of its file, against malicious files
# On a common computer a file of up to 1 MB costs less than 1 s and 200 MB; a larger one in proportion. A
# map of
# all buildings and walls of Malta, 1.3 MB, has half of the text and two thirds of the parts that it may
# have.

LARGEST_TEXT = 256 << 20
"""bytes of text that a reader accepts at most, whatever the size of its file."""

_ONE_FILE = 1_000_000
"""bytes; smaller files may unpack to as much as one of this size."""
_TEXT_PER_BYTE = 8
_PARTS_PER_BYTE = 0.9
_OBSTACLE_PARTS, _SEGMENT_PARTS = 16, 4
"""An obstacle costs as much as four segments, a segment as much as four lines, extras or comments."""


class ReadingLimits(NamedTuple):
    """The most bytes of text, and the most parts: obstacles, segments, lines, extras, weighted by cost."""

    text: int
    parts: float

    @classmethod
    def of_file(cls, size: int) -> ReadingLimits:
        """Return the limits for an untrusted file of ``size`` bytes."""
        size = max(size, _ONE_FILE)
        return cls(min(LARGEST_TEXT, _TEXT_PER_BYTE * size), _PARTS_PER_BYTE * size)

    @classmethod
    def of_text(cls, length: int) -> ReadingLimits:
        """Return the limits for a text of at most ``length`` bytes from a trusted source."""
        return cls(length, float("inf"))

    def check_text(self, text: str) -> None:
        """Raise MapBinaryError when ``text`` has too many parts; without parsing it."""
        obstacles = text.count("obstacle;")
        lines = text.count("\n") - 4 * obstacles
        self._check(_OBSTACLE_PARTS * obstacles + lines + text.count("=") + text.count(","))

    def check_counts(self, obstacles: int, segments: int, extras: int) -> None:
        """Raise MapBinaryError when a map of so many parts is too large."""
        self._check(_OBSTACLE_PARTS * obstacles + _SEGMENT_PARTS * segments + extras)

    def _check(self, parts: int) -> None:
        if parts > self.parts:
            raise MapBinaryError(
                "size check: the map has more obstacles, segments and labels than a file of its size may "
                "have; export it as text, or in tiles"
            )


# --- CBOR of one flat array, read defensively: the subset of RFC 8949 that a map needs ---

_UNSIGNED, _NEGATIVE, _BYTES, _TEXT, _ARRAY = 0, 1, 2, 3, 4
_LENGTH_BYTES = {24: 1, 25: 2, 26: 4, 27: 8}


def cbor_dumps(items: Sequence[int | str | bytes]) -> bytes:
    """Return ``items`` as a CBOR array; raises MissingCodecError without cbor2."""
    return bytes(_cbor2().dumps(list(items)))


def cbor_loads(content: bytes, count: int) -> list[int | str | bytes]:
    """Return the ``count`` items of the array in ``content``.

    Raises MapBinaryError for anything but whole numbers, texts and byte strings of stated length, before it
    is unpacked, and MissingCodecError without cbor2.
    """
    cbor2 = _cbor2()
    _check(content, count)
    try:
        items: list[int | str | bytes] = cbor2.loads(content)
    except (cbor2.CBORDecodeError, ValueError) as error:
        raise MapBinaryError(f"CBOR check: {error}; get the map once more") from None
    return items


def _check(content: bytes, count: int) -> None:
    """Check the heads of the items against the actual length."""
    kind, length, position = _head(content, 0)
    if kind != _ARRAY or length != count:
        raise MapBinaryError(f"CBOR check: an array of {count} items should be there; get the map once more")
    for item in range(count):
        kind, length, position = _head(content, position)
        if kind in (_BYTES, _TEXT):
            position += length
        elif kind not in (_UNSIGNED, _NEGATIVE):
            raise MapBinaryError(f"CBOR check: item {item} is of major type {kind}; get the map once more")
    if position != len(content):
        raise MapBinaryError(
            f"CBOR check: the items need {position} bytes and {len(content)} are there; get the map once more"
        )


def _head(content: bytes, position: int) -> tuple[int, int, int]:
    """Return major type, argument, and the position after them."""
    initial = content[position] if position < len(content) else 0xFF
    kind, argument = initial >> 5, initial & 0x1F
    if argument < 24:
        return kind, argument, position + 1
    size = _LENGTH_BYTES.get(argument, 0)
    end = position + 1 + size
    if not size or end > len(content):
        raise MapBinaryError(f"CBOR check: byte {position} begins no item; get the map once more")
    return kind, int.from_bytes(content[position + 1 : end], "big"), end


def _cbor2() -> Any:
    try:
        import cbor2
    except ImportError:
        raise MissingCodecError(
            "codec 2 of the binary format needs the Python package cbor2, which is not installed here; "
            f"install it {installation('cbor2')}, or use codec 1"
        ) from None
    return cbor2


# --- Columns of whole numbers as bytes: differences of one sign, in few bytes, ready to be compressed ---

_WIDTHS = (1, 2, 4, 8)
"""bytes per number in a column of fixed width; also the first byte of such a column."""
_VARIABLE = 0
"""The first byte of a column with variable-length numbers."""
_MOST_BYTES = 9
"""of one number; 63 bits."""
_FEW_BYTES = 1.5
"""per number, on average: where planes and variable lengths compress to equal sizes."""


def differences(values: NDArray[Any]) -> NDArray[Any]:
    """Return each of ``values``, (n,) or (n, axes) int64, less the one before it; the first less 0."""
    return np.diff(values, axis=0, prepend=np.int64(0))


def pack_numbers(values: NDArray[Any]) -> bytes:
    """Return ``values``, (n,) int64 of at most 62 bits: empty if all are 0, else a byte and the numbers.

    A number v is written as 2v, or as -2v - 1 where it is negative, so that small ones have few bytes
    whatever their sign. Either each has the number of bytes that the first byte says and they stand in
    planes: the lowest byte of each, then the next byte of each, ...; or the first byte is 0, and each is in
    bytes of seven bits, the lowest first, all but the last of them with 128 added (LEB128). Small numbers
    compress better in the second form, large ones in the first.
    """
    if not values.any():
        return b""
    unsigned = ((values << 1) ^ (values >> 63)).view(np.uint64)
    variable = _variable(unsigned)
    return variable if len(variable) <= _FEW_BYTES * len(values) else _in_planes(unsigned)


def unpack_numbers(column: bytes, count: int, name: str) -> NDArray[Any]:
    """Return the ``count`` numbers, int64, in ``column``; raises MapBinaryError naming the column."""
    if not column:
        return np.zeros(count, dtype=np.int64)
    numbers = np.frombuffer(column, np.uint8)[1:]
    unsigned = _from_variable(numbers, count) if column[0] == _VARIABLE else _from_planes(column, count)
    if unsigned is None:
        raise MapBinaryError(
            f"columns check: {name} has {len(column)} bytes for {count} numbers; get the map once more"
        )
    return (unsigned >> np.uint64(1)).astype(np.int64) ^ -(unsigned & np.uint64(1)).astype(np.int64)


def _in_planes(unsigned: NDArray[Any]) -> bytes:
    largest = int(unsigned.max())
    width = next(w for w in _WIDTHS if largest < 1 << 8 * w)
    planes = unsigned.astype("<u8").view(np.uint8).reshape(-1, 8)[:, :width]
    return bytes([width]) + planes.T.tobytes()


def _from_planes(column: bytes, count: int) -> NDArray[Any] | None:
    width = column[0]
    if width not in _WIDTHS or len(column) != 1 + width * count:
        return None
    planes = np.zeros((count, 8), dtype=np.uint8)
    planes[:, :width] = np.frombuffer(column, np.uint8)[1:].reshape(width, count).T
    return planes.view("<u8")[:, 0].astype(np.uint64)


def _variable(unsigned: NDArray[Any]) -> bytes:
    shifted = unsigned[:, None] >> (7 * np.arange(_MOST_BYTES, dtype=np.uint64))
    goes_on = shifted >= 128
    needed = np.ones(shifted.shape, dtype=bool)
    needed[:, 1:] = goes_on[:, :-1]
    written = (shifted & np.uint64(127)).astype(np.uint8) + 128 * goes_on.astype(np.uint8)
    return bytes([_VARIABLE]) + bytes(written[needed])


def _from_variable(numbers: NDArray[Any], count: int) -> NDArray[Any] | None:
    # The following needs many times the memory of a column, whose length must have been checked before.
    if not count <= len(numbers) <= _MOST_BYTES * count:
        return None
    ends = np.flatnonzero(numbers < 128)
    if len(ends) != count or not count or ends[-1] != len(numbers) - 1:
        return None
    starts = np.concatenate([[0], ends[:-1] + 1])
    lengths = ends - starts + 1
    longest = int(lengths.max())
    if longest > _MOST_BYTES:
        return None
    unsigned = np.zeros(count, dtype=np.uint64)
    for place in range(longest):
        own = np.flatnonzero(lengths > place) if place else slice(None)
        unsigned[own] |= (numbers[starts[own] + place] & 127).astype(np.uint64) << np.uint64(7 * place)
    return unsigned


# --- Segments as one path of points for each obstacle; points shared by two segments occur once ---

RING, CHAIN, LOOSE = 0, 1, 2
"""How the segments of an obstacle are connected: in a ring, in a chain, not at all."""


class Paths(NamedTuple):
    """K forms, K first points (K, 2), and the steps (S, 2) from point to point, one path after the other.

    The points of a loose obstacle are both ends of each segment. Without segments the first point is (0, 0).
    """

    forms: NDArray[Any]
    starts: NDArray[Any]
    steps: NDArray[Any]


def paths_of(a: NDArray[Any], b: NDArray[Any], counts: NDArray[Any]) -> Paths:
    """Return the paths of K obstacles with ``counts`` segments each, from ``a`` to ``b``, (n, 2) int64."""
    obstacle = np.repeat(np.arange(len(counts)), counts)
    ends = np.cumsum(counts)
    filled = counts > 0
    first, last = np.zeros(len(a), dtype=bool), np.zeros(len(a), dtype=bool)
    first[(ends - counts)[filled]] = last[ends[filled] - 1] = True
    parted = ~first
    parted[1:] &= (a[1:] != b[:-1]).any(axis=1)
    forms = np.where(np.bincount(obstacle, parted, len(counts)) > 0, LOOSE, CHAIN)
    forms[~filled] = LOOSE
    closes = np.zeros(len(counts), dtype=bool)
    closes[filled] = (a[first] == b[last]).all(axis=1)
    forms[closes & (forms == CHAIN)] = RING
    begins = first | (forms == LOOSE)[obstacle]
    given = np.column_stack([begins, ~(last & (forms == RING)[obstacle])]).ravel()
    points = np.stack([a, b], axis=1).reshape(-1, 2)[given]
    is_start = np.column_stack([first, np.zeros(len(a), dtype=bool)]).ravel()[given]
    starts = np.zeros((len(counts), 2), dtype=np.int64)
    starts[filled] = points[is_start]
    return Paths(forms, starts, np.diff(points, axis=0, prepend=points[:1])[~is_start])


def step_counts(forms: NDArray[Any], counts: NDArray[Any]) -> NDArray[Any]:
    """Return how many steps the path of each obstacle has, (K,) int64."""
    steps: NDArray[Any] = np.where(forms == LOOSE, np.maximum(2 * counts - 1, 0), counts - (forms == RING))
    return steps


def segments_of(paths: Paths, counts: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return ``a`` and ``b``, (n, 2) int64: the inverse of :func:`paths_of`."""
    filled = counts > 0
    forms, starts, lengths = (
        paths.forms[filled],
        paths.starts[filled],
        1 + step_counts(paths.forms, counts)[filled],
    )
    path = np.repeat(np.arange(len(lengths)), lengths)
    ends = np.cumsum(lengths)
    place = np.arange(len(path)) - (ends - lengths)[path]
    steps = np.zeros((len(path), 2), dtype=np.int64)
    steps[place > 0] = paths.steps
    moved = np.cumsum(steps, axis=0)
    points = moved + (starts - moved[ends - lengths])[path]
    is_last = place == lengths[path] - 1
    begins = np.flatnonzero(
        np.where((forms == LOOSE)[path], place % 2 == 0, ~is_last | (forms == RING)[path])
    )
    follows = np.where(is_last[begins], (ends - lengths)[path[begins]], begins + 1)
    return points[begins], points[follows]


# --- Bodies shared by obstacles that differ only in their place, such as benches of one kind ---


def first_of_each_kind(
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


def body_rows(which: NDArray[Any], lengths: NDArray[Any]) -> NDArray[Any]:
    """Return the rows of the obstacles ``which``, one after the other, where each has ``lengths`` rows."""
    own = lengths[which]
    shift = (np.cumsum(lengths) - lengths)[which] - (np.cumsum(own) - own)
    rows: NDArray[Any] = np.repeat(shift, own) + np.arange(int(own.sum()))
    return rows


def kind_offsets(kind: NDArray[Any]) -> NDArray[Any]:
    """Return 0 for the first of each kind, else the distance back from the newest kind, (n,) int64."""
    newest = np.maximum.accumulate(np.concatenate([[-1], kind]))[:-1] + 1
    back: NDArray[Any] = newest - kind
    return back


def kinds_of_offsets(back: NDArray[Any]) -> NDArray[Any]:
    """Return the kind of each: the inverse of :func:`kind_offsets`."""
    kind: NDArray[Any] = np.cumsum(back == 0) - np.maximum(back, 1)
    return kind


def _pieces(column: NDArray[Any], lengths: NDArray[Any]) -> list[bytes]:
    content = np.ascontiguousarray(column).tobytes()
    size = len(content) // len(column) if len(column) else 0
    ends = (size * np.cumsum(lengths)).tolist()
    return [content[start:end] for start, end in zip([0, *ends[:-1]], ends, strict=True)] if ends else []


# --- The text after the counts of an obstacle's line, stored once for equal ones ---

# The number in src=walls:1204 differs from obstacle to obstacle while all else stays, and so does the second
# one in src=walls:1204+3. No written label holds the characters that stand for them.
_NUMBER = re.compile(r"(?<=[;,]src=)([^,;=]*:)(0|[1-9][0-9]{0,8})(?:\+([1-9][0-9]{0,8}))?(?=[,;])")
_ALONE, _WITH_OTHERS = "\x01", "\x02"


class Heads(NamedTuple):
    """Lines with marks in place of their numbers, and the numbers as differences from predictions.

    ``numbers``, (m,) int64, are those of the m lines with a mark; ``others``, (p,), those of the p lines with
    the second one, which may be 0 and is not written then.
    """

    lines: list[str]
    numbers: NDArray[Any]
    others: NDArray[Any]


def distinct_lines(lines: Sequence[str]) -> tuple[list[str], NDArray[Any]]:
    """Return the distinct ``lines`` in order of appearance, and the index of each line, (n,) int64."""
    places: dict[str, int] = {}
    column = np.array([places.setdefault(line, len(places)) for line in lines], dtype=np.int64)
    return list(places), column


def without_numbers(lines: Sequence[str], counts: NDArray[Any]) -> Heads:
    """Return ``lines`` of obstacles with ``counts`` segments each, (n,) int64, without their numbers.

    The number of others is predicted as that of the segments less one, and a number as following all those
    covered by the line before it.
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
    """Return the lines: the inverse of :func:`without_numbers`; ``counts`` as there."""
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
