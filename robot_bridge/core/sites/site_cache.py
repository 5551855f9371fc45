"""``site.cache``: data computed from a site's obstacles, made at publishing and mapped by the gateway."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..errors import CacheError, RobotMapError
from ..robotmap import window_index
from ..robotmap.binary import encode_pieces
from ..robotmap.builder import corners_of_rows, rows_of
from ..robotmap.model import Border
from ..robotmap.outlines import Outlines, oriented_segments, validate_outlines
from . import column_file
from .column_writers import CellSorting, NoteColumns, OutlineColumns, bytes_of_texts
from .fences import FencedRows, fenced_boxes
from .frame import SiteFrame
from .geopackage import extras_of
from .site_layers import as_read_back, row_spans

# --- Identity of a ``site.gpkg``, whichever program has opened it since ---

_AT_ONCE = 1 << 20
# SQLite writes there whenever a program opens the file in another journal mode, as QGIS does to read it:
# https://www.sqlite.org/fileformat.html#the_database_header
_VOLATILE = (slice(18, 20), slice(24, 28), slice(92, 100))


def geopackage_digest(file: Path) -> str:
    """Return the SHA-256 of the content of ``file``, including pending changes beside it; raises OSError."""
    digest = hashlib.sha256()
    with file.open("rb") as source:
        head = bytearray(source.read(_AT_ONCE))
        for part in _VOLATILE:
            head[part] = bytes(len(head[part]))
        digest.update(head)
        _add(digest, source)
    waiting = file.with_name(f"{file.name}-wal")
    if waiting.is_file():
        with waiting.open("rb") as source:
            _add(digest, source)
    return digest.hexdigest()


def _add(digest: hashlib._Hash, source: BinaryIO) -> None:
    while some := source.read(_AT_ONCE):
        digest.update(some)


# --- Content of ``site.cache``: outlines, their index, fenced areas, and the text of the whole map

CACHE_FILE = "site.cache"
CACHE_CONTENT = 1
"""The version of the computation: increased whenever the same site.gpkg would give other columns."""
SURELY_TOO_LARGE = 2
"""times the largest size of a whole map: one estimated from some windows to have more is not tried."""
_NOT_USED = "It is not used; publish the site again, or delete it"

CACHE_COLUMNS = (
    "coordinates",
    "offsets",
    "shape_type",
    "courtyard",
    "height",
    "outdoor",
    "semantics_codes",
    "semantics_text",
    "semantics_offsets",
    "source_text",
    "source_offsets",
    "base",
    "ext_codes",
    "ext_text",
    "ext_offsets",
    "rows",
    "grid_keys",
    "grid_starts",
    "note_text",
    "note_offsets",
    "note_low",
    "note_high",
    "note_everywhere",
    "fence_grid_keys",
    "fence_grid_starts",
    "fence_first",
    "fence_last",
    "fence_low",
    "fence_high",
    "whole_text",
    "whole_map",
)
"""The possible columns of the file, in this order."""

Arrays = dict[str, NDArray[Any]]
Publication = Mapping[str, Any]
"""The values that columns depend on besides site.gpkg: the stamp, the frame and the bounds of the site."""


@dataclass(frozen=True)
class WholeMap:
    """The map of the whole site, made at publishing, of ``head`` and ``texts``; ``content`` is binary.

    If it is too large to send there are no texts; ``size`` is its bytes, approximate if ``is_estimate``.
    """

    size: int
    is_estimate: bool
    head: str
    texts: Callable[[], Iterator[window_index.GroupText]] | None
    content: bytes | None


@dataclass(frozen=True)
class SiteCache:
    """The arrays of one publication; those of a large site stay on the disk until accessed."""

    index: window_index.OutlineIndex
    fenced: FencedRows
    whole: WholeMap

    @property
    def outlines(self) -> Outlines:
        """The outlines of the site."""
        return self.index.outlines


def read_cache(file: Path, geopackage: Path, publication: Publication) -> SiteCache:
    """Return the content of ``file``, which must be computed from ``geopackage`` as it is now.

    :raises CacheError: for one that is damaged, of another version, or of another publication, with the
        remedy; and OSError.
    """
    try:
        _check_same(file, column_file.read_about(file), {"content": CACHE_CONTENT, **publication})
        _check_same(file, column_file.read_about(file), {"geopackage": geopackage_digest(geopackage)})
        columns = column_file.read_columns(file)
        return _cache_of(columns)
    except CacheError as error:
        raise CacheError(f"{error}. {_NOT_USED}") from error
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise CacheError(f"{file} is altered: {error!r} is wrong in it. {_NOT_USED}") from error


def _check_same(file: Path, about: Mapping[str, Any], expected: Mapping[str, Any]) -> None:
    for name, value in expected.items():
        if about.get(name) != value:
            raise CacheError(
                f"{file} belongs to another publication, or to another version of this program: its {name} "
                f"is {str(about.get(name))[:80]}, and {str(value)[:80]} is needed"
            )


def _cache_of(columns: column_file.ColumnSet) -> SiteCache:
    about, arrays = columns
    index = index_of(arrays, about["grid"])
    _require(arrays["rows"].ndim == 2 and arrays["rows"].shape[1] == 7, "rows")
    _require(index.grid.cells.starts[-1] == len(index.rows), "grid_starts")
    grid = _grid(about["fence_grid"], arrays, "fence_grid")
    first, last, low, high = (arrays[f"fence_{name}"] for name in ("first", "last", "low", "high"))
    fenced = FencedRows(first, last, low, high, grid)
    _require(grid.cells.starts[-1] == len(fenced.first) == len(fenced.low), "fence_grid_starts")
    return SiteCache(index, fenced, _whole(about["whole"], arrays))


def index_of(arrays: Arrays, grid: Mapping[str, Any]) -> window_index.OutlineIndex:
    """Return the index in ``arrays``; ``grid`` is the description of its grid.

    :raises ValueError: naming the fault, or KeyError for a missing column.
    """
    notes = window_index.OutlineNotes(
        column_file.Texts(arrays["note_text"], arrays["note_offsets"]),
        arrays["note_low"],
        arrays["note_high"],
        arrays["note_everywhere"],
    )
    return window_index.OutlineIndex(_outlines(arrays), arrays["rows"], _grid(grid, arrays, "grid"), notes)


def parts_of(text: NDArray[Any], groups: Iterable[Sequence[Any]]) -> Iterator[window_index.GroupText]:
    """Yield the parts of ``text``; ``groups`` holds the group and the bytes of each."""
    end = 0
    for group, length in groups:
        end += length
        yield window_index.GroupText(
            group, text[end - length : end].tobytes().decode("utf-8", column_file.HALVES)
        )


def _whole(about: Mapping[str, Any], arrays: Arrays) -> WholeMap:
    text, content = arrays.get("whole_text"), arrays.get("whole_map")
    groups = [(str(group), int(length)) for group, length in about["groups"]]

    _require(text is None or sum(length for _, length in groups) == len(text), "whole_text")
    return WholeMap(
        int(about["size"]),
        bool(about["is_estimate"]),
        str(about["head"]),
        None if text is None else lambda: parts_of(text, groups),
        None if content is None else content.tobytes(),
    )


def _outlines(arrays: Arrays) -> Outlines:
    extras = None
    if "ext_codes" in arrays:
        extras = column_file.CodedExtras(_decoded("ext", arrays), lambda text: extras_of(text, CACHE_FILE))
    outlines = Outlines(
        coordinates=arrays["coordinates"],
        offsets=arrays["offsets"],
        shape_type=arrays["shape_type"],
        courtyard=arrays["courtyard"],
        height=arrays["height"],
        outdoor=arrays["outdoor"],
        semantics=_decoded("semantics", arrays),
        source=column_file.Texts(arrays["source_text"], arrays["source_offsets"]),
        base=arrays.get("base"),
        ext=extras,
    )
    count = len(outlines)
    columns = (outlines.courtyard, outlines.height, outlines.outdoor, outlines.semantics, outlines.source)
    _require(all(len(column) == count for column in columns), "outlines")
    _require(len(outlines.offsets) == count + 1 and outlines.coordinates.shape[1:] == (2,), "offsets")
    _require(outlines.base is None or len(outlines.base) == count, "base")
    _require(extras is None or len(extras) == count, "ext")
    return outlines


def _grid(about: Mapping[str, Any], arrays: Arrays, name: str) -> window_index.BoxGrid:
    keys, starts = arrays[f"{name}_keys"], arrays[f"{name}_starts"]
    _require(len(starts) == len(keys) + 1, f"{name}_starts")
    origin = [float(edge) for edge in about["origin"]]
    return window_index.BoxGrid(
        window_index.GridCells(keys, starts, origin, int(about["placed"]), tuple(map(int, about["levels"])))
    )


def _decoded(name: str, arrays: Arrays) -> column_file.CodedTexts:
    table = column_file.Texts(arrays[f"{name}_text"], arrays[f"{name}_offsets"])
    return column_file.CodedTexts(table, arrays[f"{name}_codes"])


def _require(fine: bool | np.bool_, column: str) -> None:
    if not fine:
        raise ValueError(column)


# --- Writing ``site.cache`` while the obstacles of a site are read: few of them are in memory at a time

_OBSTACLES = 2000
"""that are handled together."""


class CacheWriter:
    """Receives the obstacles of a site and writes ``site.cache`` from them.

    ``folder`` is created for temporary files, several times as large as ``site.cache``. ``frame`` is the
    site's.
    """

    def __init__(self, folder: Path, frame: SiteFrame) -> None:
        folder.mkdir()
        self._folder, self._frame = folder, frame
        self._waiting: list[Outlines] = []
        self._points = 0
        self._columns = column_file.ColumnFiles(folder)
        self._outlines = OutlineColumns(self._columns)
        self._notes = NoteColumns(folder)
        self._segments = CellSorting(folder, "segments")
        self._fences = CellSorting(folder, "fences")
        self._count = 0
        self._last_number = 0.0
        self._is_sound = True

    def __enter__(self) -> CacheWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self.remove()

    def add(self, outlines: Outlines) -> None:
        """Add whole obstacles, each with its courtyards behind it; raises OSError."""
        for some in _pieces(outlines):
            self._waiting.append(some)
            self._points += len(some.coordinates) + len(some)
            if self._points >= column_file.AT_ONCE:
                self._add_waiting()

    def write(self, file: Path, geopackage: Path, publication: Publication, head: str, most: int) -> None:
        """Write the new ``file`` from what was added, which must equal ``geopackage``, or write none.

        None is written for obstacles whose published form only ``geopackage`` shows. ``head`` is the text of
        the whole map up to its obstacles, ``most`` the largest in bytes that is sent. Raises OSError.
        """
        self._add_waiting()
        if self._is_sound:
            self._outlines.end()
            self._notes.end(self._columns)
            grid = self._segments.sort_into(self._columns, "grid", "rows")
            fence_grid = self._sort_fences()
            index = index_of(self._columns.mapped(), grid)
            whole = self._add_whole(index, Border(*publication["bounds"]), head, most)
            about = {
                "content": CACHE_CONTENT,
                "geopackage": geopackage_digest(geopackage),
                **publication,
                "grid": grid,
                "fence_grid": fence_grid,
                "whole": whole,
            }
            made = self._columns.all()
            column_file.write_columns(
                file, about, {name: made[name] for name in CACHE_COLUMNS if name in made}
            )

    def remove(self) -> None:
        """Delete the temporary files; nothing may be added or written afterwards."""
        self._columns.close()
        for kept in (self._notes, self._segments, self._fences):
            kept.remove()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _add_waiting(self) -> None:
        outlines = as_read_back(Outlines.joined(self._waiting), self._frame) if self._is_sound else None
        self._waiting, self._points = [], 0
        if outlines is None:
            self._is_sound = False
            return
        found = validate_outlines(outlines)
        self._outlines.add(found.outlines)
        self._notes.add(found)
        segments = oriented_segments(found.outlines, found.usable)
        rows = rows_of(segments, found.outlines.height, (self._count, self._last_number))
        low, high = corners_of_rows(rows)
        self._segments.add(low, window_index.levels_of(low, high), rows)
        if len(segments.number):
            self._last_number += float(segments.number[-1])
        groups, low, high = fenced_boxes(found.outlines)
        self._fences.add(
            low, window_index.levels_of(low, high), np.column_stack([groups + self._count, low, high])
        )
        self._count += len(outlines)

    def _sort_fences(self) -> dict[str, Any]:
        columns = self._columns
        grid = self._fences.sort_into(columns, "fence_grid", "fences")
        made = {
            "first": (np.int64, 0),
            "last": (np.int64, 0),
            "low": (np.float64, 2),
            "high": (np.float64, 2),
        }
        for name, (kind, width) in made.items():
            columns.make(f"fence_{name}", kind, width)
        for piece in columns["fences"].pieces():
            for name, some in zip(made, (piece[:, 0], piece[:, 1], piece[:, 2:4], piece[:, 4:]), strict=True):
                columns.append(f"fence_{name}", some)
        columns.remove("fences")
        return grid

    def _add_whole(
        self, index: window_index.OutlineIndex, bounds: Border, head: str, most: int
    ) -> dict[str, Any]:
        """Return the description of the map of the whole site, whose columns are added if it is small."""
        size, is_estimate, groups = window_index.size_in_binary(index, bounds), True, []
        if size <= SURELY_TOO_LARGE * most:
            groups = self._add_text(index.outlines, bounds)
            content = self._encoded(head, groups)
            if content is not None:
                size, is_estimate = len(content), False
                if size <= most:
                    self._columns.append("whole_map", np.frombuffer(content, np.uint8))
        return {"size": size, "is_estimate": is_estimate, "head": head, "groups": groups}

    def _add_text(self, outlines: Outlines, bounds: Border) -> list[list[Any]]:
        """Add the text of the map, and return the group of each of its parts and how many bytes that has."""
        column, groups = self._columns.make("whole_text", np.uint8), []
        for part in window_index.group_texts(outlines, bounds):
            text, lengths = bytes_of_texts([part.text])
            column.append(text)
            groups.append([part.group, int(lengths[0])])
        return groups

    def _encoded(self, head: str, groups: list[list[Any]]) -> bytes | None:
        """Return the map in binary; None without the package for it, as in most QGIS installations."""
        text = self._columns["whole_text"].mapped()

        def pieces() -> Iterator[str]:
            return chain([head], (part.text for part in parts_of(text, groups)))

        try:
            return encode_pieces(pieces)
        except RobotMapError:
            return None


def _pieces(outlines: Outlines) -> Iterator[Outlines]:
    """Yield ``outlines`` in pieces."""
    if len(outlines.coordinates) <= column_file.AT_ONCE:
        yield outlines
        return
    for first, last in row_spans(outlines, _OBSTACLES):
        yield outlines.chosen(np.arange(first, last))
