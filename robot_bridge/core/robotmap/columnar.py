"""Codec 2: a map in columns of centimetre differences; ``docs/robot-map.md`` describes each item.

It keeps the content of a map in centimetres. The spelling of numbers, comments and blanks are not kept.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import MapBinaryError
from .columns import (
    LOOSE,
    Heads,
    Paths,
    ReadingLimits,
    body_rows,
    cbor_dumps,
    cbor_loads,
    differences,
    distinct_lines,
    first_of_each_kind,
    kind_offsets,
    kinds_of_offsets,
    marks_in,
    pack_numbers,
    paths_of,
    segments_of,
    step_counts,
    unpack_numbers,
    with_numbers,
    without_numbers,
)
from .model import Border, Obstacle, RobotMap, ShapeType
from .text_format import escape, read_ext, unescape, write_ext

_SHORTEST_OBSTACLE = len("obstacle;\n0;1;0;;\n#\n")
_SHORTEST_SEGMENT = len("0;0;\n0;0;\n0;0;;\n#\n")
_FARTHEST = 1 << 52
"""centimetres; a float64 holds every whole number of them up to here."""
_LARGEST_ID = 10**18


class _Columns(NamedTuple):
    """The items of the array; a body is shared by obstacles that differ only in their place."""

    meta: str
    x_min: int
    y_min: int
    x_max: int
    y_max: int
    heads: str
    tails: str
    obstacles: int
    segments: int
    bodies: int
    starts: bytes
    steps: bytes
    heights: bytes
    varies: bytes
    tail: bytes
    kinds: bytes
    counts: bytes
    body: bytes
    head: bytes
    ids: bytes
    others: bytes
    numbers: bytes


_KINDS = (str, *[int] * 4, *[str] * 2, *[int] * 3, *[bytes] * 12)


def pack_map(robot_map: RobotMap) -> bytes:
    """Return ``robot_map`` in CBOR, not compressed.

    Raises MapBinaryError for numbers that are too large, and MissingCodecError without cbor2.
    """
    obstacles = robot_map.obstacles
    counts = np.array([len(o.a) for o in obstacles], dtype=np.int64)
    if any(abs(o.id) > _LARGEST_ID for o in obstacles):
        raise MapBinaryError("codec check: codec 2 has no room for an id as large as one here; use codec 1")
    paths = paths_of(
        _centimetres([o.a for o in obstacles], 2), _centimetres([o.b for o in obstacles], 2), counts
    )
    lines = without_numbers([_head(o) for o in obstacles], counts)
    heads, head = distinct_lines(lines.lines)
    tails, bodies = _bodies(obstacles, paths, counts)
    x_min, y_min, x_max, y_max = _centimetres([np.array(robot_map.border)], 1)[:, 0].tolist()
    columns = _Columns(
        meta="\n".join(f"{key} {' '.join(value.split())}" for key, value in robot_map.meta.items()),
        x_min=x_min,
        y_min=y_min,
        x_max=x_max,
        y_max=y_max,
        heads="\n".join(heads),
        tails="\n".join(tails),
        obstacles=len(obstacles),
        segments=int(counts.sum()),
        ids=pack_numbers(differences(np.array([o.id for o in obstacles], dtype=np.int64)) - 1),
        head=pack_numbers(differences(head)),
        others=pack_numbers(lines.others),
        numbers=pack_numbers(lines.numbers),
        starts=pack_numbers(differences(paths.starts).ravel()),
        **bodies,
    )
    return cbor_dumps(columns)


def _bodies(
    obstacles: Sequence[Obstacle], paths: Paths, counts: NDArray[Any]
) -> tuple[list[str], dict[str, Any]]:
    """Return the table of tails, and the items for the body of each obstacle and for the bodies."""
    tails, tail = distinct_lines([line for o in obstacles for line in _tails(o)])
    height = _centimetres([o.height for o in obstacles], 1)[:, 0]
    kinds = paths.forms * 8 + np.array([int(o.shape_type) for o in obstacles], dtype=np.int64)
    lengths = step_counts(paths.forms, counts)
    each = np.ones(len(counts), dtype=np.int64)
    first, body = first_of_each_kind(
        [(kinds, each), (paths.steps, lengths), (height, counts), (tail, counts)], len(counts)
    )
    own = body_rows(first, counts)
    tail, tail_varies = _once_where_equal(tail[own], counts[first])
    height, height_varies = _once_where_equal(height[own], counts[first])
    return tails, {
        "bodies": len(first),
        "body": pack_numbers(kind_offsets(body)),
        "kinds": pack_numbers(kinds[first]),
        "counts": pack_numbers(counts[first]),
        "steps": pack_numbers(paths.steps[body_rows(first, lengths)].ravel()),
        "varies": pack_numbers(tail_varies + 2 * height_varies),
        "tail": pack_numbers(tail),
        "heights": pack_numbers(differences(height)),
    }


def unpack_map(content: bytes, limits: ReadingLimits) -> RobotMap:
    """Return the map in ``content``, whose text has ``limits.text`` bytes.

    Raises MapBinaryError naming the check that failed, before anything larger than that text or of more than
    ``limits.parts`` is made, and MissingCodecError without cbor2.
    """
    columns = _checked(cbor_loads(content, len(_Columns._fields)), limits)
    bodies = _Bodies.of(columns)
    body, counts = bodies.body, bodies.counts[bodies.body]
    _require(counts.sum() == columns.segments, "counts do not add up")
    own = body_rows(body, bodies.counts)
    tail, height = bodies.tail[own], bodies.heights[own]
    forms = bodies.kinds >> 3
    steps = bodies.steps[body_rows(body, step_counts(forms, bodies.counts))]
    starts = np.cumsum(unpack_numbers(columns.starts, 2 * len(body), "starts").reshape(-1, 2), axis=0)
    a, b = segments_of(Paths(forms[body], starts, steps), counts)
    _require(max(_largest(a), _largest(b), _largest(height)) <= _FARTHEST, "a number is too large")
    tails = columns.tails.split("\n")
    lines = _lines(columns, counts, (tails, tail), limits)
    ids = np.cumsum(unpack_numbers(columns.ids, len(body), "ids") + 1)
    parts = _Parts(a / 100, b / 100, height / 100, tail, [_tail_read(line) for line in tails])
    border = Border(*(value / 100 for value in columns[1:5]))
    shape_types = (bodies.kinds & 7)[body]
    obstacles = _obstacles(ids.tolist(), shape_types.tolist(), counts, lines, parts)
    return RobotMap(border, tuple(obstacles), _meta(columns.meta))


class _Bodies(NamedTuple):
    """The bodies in the columns, checked, and the body of each obstacle."""

    body: NDArray[Any]
    kinds: NDArray[Any]
    counts: NDArray[Any]
    steps: NDArray[Any]
    tail: NDArray[Any]
    heights: NDArray[Any]

    @classmethod
    def of(cls, columns: _Columns) -> _Bodies:
        back, m, n = unpack_numbers(columns.body, columns.obstacles, "body"), columns.bodies, columns.segments
        _require((back >= 0).all() and (back == 0).sum() == m, "bodies do not add up")
        body = kinds_of_offsets(back)
        _require((body >= 0).all(), "a body is in no table")
        kinds, counts = unpack_numbers(columns.kinds, m, "kinds"), unpack_numbers(columns.counts, m, "counts")
        forms, shape_types = kinds >> 3, kinds & 7
        _require(((counts >= 0) & (counts <= n)).all() and counts.sum() <= n, "counts do not add up")
        _require(((forms >= 0) & (forms <= LOOSE)).all(), "a form is unknown")
        _require(((forms == LOOSE) | (counts > 0)).all(), "a path has no points")
        _require(((shape_types >= 1) & (shape_types <= 6)).all(), "a shape type is unknown")
        varies = unpack_numbers(columns.varies, m, "varies")
        tail = _for_each(columns.tail, counts, (varies & 1) > 0, "tail", plain=True)
        heights = _for_each(columns.heights, counts, (varies & 2) > 0, "heights", plain=False)
        steps = unpack_numbers(columns.steps, 2 * int(step_counts(forms, counts).sum()), "steps").reshape(
            -1, 2
        )
        return cls(body, kinds, counts, steps, tail, heights)


def _lines(
    columns: _Columns, counts: NDArray[Any], tails: tuple[list[str], NDArray[Any]], limits: ReadingLimits
) -> list[str]:
    """Return the text after the counts of each obstacle, after checking that all labels fit into the text."""
    table = columns.heads.split("\n")
    head = np.cumsum(unpack_numbers(columns.head, columns.obstacles, "head"))
    _check_labels(((table, head), tails), columns, limits)
    marked = [table[place] for place in head.tolist()]
    numbers, others = marks_in(marked)
    heads = Heads(
        marked,
        unpack_numbers(columns.numbers, numbers, "numbers"),
        unpack_numbers(columns.others, others, "others"),
    )
    return with_numbers(heads, counts)


def _centimetres(values: Sequence[NDArray[Any]], axes: int) -> NDArray[Any]:
    """Return all of ``values`` one after the other, (n, axes) int64."""
    scaled = np.concatenate([np.empty((0, axes)), *(v.reshape(-1, axes) for v in values)]) * 100
    if not (np.abs(scaled) < _FARTHEST).all():
        raise MapBinaryError(
            "codec check: codec 2 has no room for a number as large as one here; use codec 1"
        )
    rounded: NDArray[Any] = np.round(scaled).astype(np.int64)
    return rounded


def _head(obstacle: Obstacle) -> str:
    return f"{escape(obstacle.semantics)};{write_ext(obstacle.ext)}"


def _tails(obstacle: Obstacle) -> Iterator[str]:
    extras = obstacle.segment_ext or ({},) * len(obstacle.a)
    for row, outdoor in enumerate(obstacle.outdoor.tolist()):
        yield f"{'01'[outdoor]};{escape(obstacle.segment_semantics[row])};{write_ext(extras[row])}"


def _once_where_equal(values: NDArray[Any], counts: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return values, once for obstacles with one value for all segments, and which have several, (K,).

    Obstacles without segments have no value.
    """
    filled = counts > 0
    firsts = np.zeros(len(counts), dtype=np.int64)
    firsts[filled] = values[(np.cumsum(counts) - counts)[filled]]
    obstacle = np.repeat(np.arange(len(counts)), counts)
    differs = values != firsts[obstacle]
    varies = np.bincount(obstacle, differs, len(counts)) > 0
    kept = varies[obstacle]
    kept[(np.cumsum(counts) - counts)[filled]] = True
    return values[kept], varies.astype(np.int64)


def _for_each(
    column: bytes, counts: NDArray[Any], varies: NDArray[Any], name: str, plain: bool
) -> NDArray[Any]:
    """Return a value for each segment, (n,) int64: the inverse of :func:`_once_where_equal`."""
    repeats = np.where(varies, 1, counts)
    repeats = np.repeat(repeats, np.where(varies, counts, counts > 0))
    values = unpack_numbers(column, len(repeats), name)
    return np.repeat(values if plain else np.cumsum(values), repeats)


def _largest(values: NDArray[Any]) -> int:
    """Return the largest absolute value; that of the least int64 is its own."""
    return max(int(values.max()), -int(values.min())) if values.size else 0


def _checked(items: list[int | str | bytes], limits: ReadingLimits) -> _Columns:
    columns = _Columns(*items)  # type: ignore[arg-type]
    for name, value, kind in zip(_Columns._fields, items, _KINDS, strict=True):
        _require(type(value) is kind, f"{name} is not of type {kind.__name__}")
    _require(min(columns.obstacles, columns.segments, columns.bodies) >= 0, "a count is negative")
    _require(max(abs(value) for value in columns[1:5]) <= _FARTHEST, "the border is too large")
    _require(columns.x_min < columns.x_max and columns.y_min < columns.y_max, "the border has no inside")
    if columns.obstacles * _SHORTEST_OBSTACLE + columns.segments * _SHORTEST_SEGMENT > limits.text:
        raise MapBinaryError(
            f"size check: {columns.obstacles} obstacles and {columns.segments} segments are declared, more "
            f"than a text of {limits.text} bytes holds; get the map once more"
        )
    # Checked before parsing: a table has no unused line, and its lines are read once.
    _require(columns.heads.count("\n") < max(columns.obstacles, 1), "heads has more lines than obstacles")
    _require(columns.tails.count("\n") < max(columns.segments, 1), "tails has more lines than segments")
    limits.check_counts(
        columns.obstacles, columns.segments, _parts_in(columns.tails) + columns.meta.count("\n")
    )
    return columns


def _check_labels(
    tables: Sequence[tuple[list[str], NDArray[Any]]], columns: _Columns, limits: ReadingLimits
) -> None:
    """Raise MapBinaryError by the tables alone, before a label is repeated a million times."""
    size = extras = 0
    for lines, places in tables:
        _require(((places >= 0) & (places < len(lines))).all(), "a place is in no table")
        lengths = np.array([(len(line), _parts_in(line)) for line in lines], dtype=np.int64)
        size, extras = np.array([size, extras]) + lengths[places].sum(axis=0)
    if size > limits.text:
        raise MapBinaryError(f"size check: the labels alone have more than {limits.text} bytes")
    limits.check_counts(columns.obstacles, columns.segments, int(extras))


def _parts_in(labels: str) -> int:
    return labels.count("=") + labels.count(",")


def _require(fine: bool | np.bool_, problem: str) -> None:
    if not fine:
        raise MapBinaryError(f"columns check: {problem}; the file is altered, get it once more")


class _Parts(NamedTuple):
    """The columns of all segments, and the parsed table of tails."""

    a: NDArray[Any]
    b: NDArray[Any]
    height: NDArray[Any]
    tail: NDArray[Any]
    tails: list[tuple[bool, str, dict[str, str]]]


def _obstacles(
    ids: list[int], shape_types: list[int], counts: NDArray[Any], lines: list[str], parts: _Parts
) -> Iterator[Obstacle]:
    ends = np.cumsum(counts).tolist()
    for k, end in enumerate(ends):
        own = slice(ends[k - 1] if k else 0, end)
        semantics, ext = _fields(lines[k], 2)
        tails = [parts.tails[place] for place in parts.tail[own].tolist()]
        yield Obstacle(
            id=ids[k],
            shape_type=ShapeType(shape_types[k]),
            semantics=unescape(semantics),
            a=parts.a[own],
            b=parts.b[own],
            height=parts.height[own],
            outdoor=np.array([tail[0] for tail in tails], dtype=bool),
            segment_semantics=tuple(tail[1] for tail in tails),
            ext=_ext(ext),
            segment_ext=tuple(dict(tail[2]) for tail in tails) if any(tail[2] for tail in tails) else (),
        )


def _tail_read(line: str) -> tuple[bool, str, dict[str, str]]:
    if not line:
        # The table of a map without segments.
        return False, "", {}
    outdoor, semantics, ext = _fields(line, 3)
    return outdoor == "1", unescape(semantics), _ext(ext)


def _fields(line: str, count: int) -> list[str]:
    """Return the fields before the semicolons of ``line``; the last one, the extras, may be empty."""
    fields = line.split(";")
    _require(len(fields) in (count, count + 1) and not fields[-1], f"{line[:40]!r} has other fields")
    return fields[:count]


def _ext(text: str) -> dict[str, str]:
    try:
        return read_ext(text)
    except ValueError:
        raise MapBinaryError(
            f"columns check: {text[:40]!r} has no 'key=value'; get the map once more"
        ) from None


def _meta(text: str) -> dict[str, str]:
    pairs = (line.partition(" ") for line in text.split("\n") if line)
    return {key: value for key, _, value in pairs}
