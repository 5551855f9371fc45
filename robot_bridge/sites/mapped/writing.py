"""``site.cache`` written while the obstacles of a site are read: few of them are in memory at a time."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from ...robotmap.binary import encode_pieces
from ...robotmap.clipping import corners_of_rows, rows_of
from ...robotmap.errors import RobotMapError
from ...robotmap.grid import levels_of
from ...robotmap.group_texts import group_texts, size_in_binary
from ...robotmap.index import OutlineIndex
from ...robotmap.model import Border
from ...robotmap.outlines import Outlines
from ...robotmap.segments import oriented_segments
from ...robotmap.usable import inspected
from ..fences import fenced_boxes
from ..frame import SiteFrame
from ..obstacle_layer import as_read_back, row_spans
from .cache import COLUMNS, CONTENT, SURELY_TOO_LARGE, Publication, index_of, parts_of
from .cell_sorting import CellSorting
from .columns import write_columns
from .geopackage_digest import geopackage_digest
from .outline_columns import NoteColumns, OutlineColumns
from .row_file import AT_ONCE, ColumnFiles
from .text_columns import bytes_of_texts

_OBSTACLES = 2000
"""that are passed on together where many come at once."""


class CacheWriter:
    """Takes the obstacles of a site and writes ``site.cache`` of them.

    ``folder`` is made for what is kept meanwhile, some times as large as ``site.cache``. ``frame`` is the
    site's.
    """

    def __init__(self, folder: Path, frame: SiteFrame) -> None:
        folder.mkdir()
        self._folder, self._frame = folder, frame
        self._waiting: list[Outlines] = []
        self._points = 0
        self._columns = ColumnFiles(folder)
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
            if self._points >= AT_ONCE:
                self._add_waiting()

    def write(self, file: Path, geopackage: Path, publication: Publication, head: str, most: int) -> None:
        """Write the new ``file`` of what was added, which is what ``geopackage`` holds, or none.

        There is none for obstacles that only ``geopackage`` tells what becomes of. ``head`` is the text of
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
                "content": CONTENT,
                "geopackage": geopackage_digest(geopackage),
                **publication,
                "grid": grid,
                "fence_grid": fence_grid,
                "whole": whole,
            }
            made = self._columns.all()
            write_columns(file, about, {name: made[name] for name in COLUMNS if name in made})

    def remove(self) -> None:
        """Delete what was kept; nothing may be added or written any more."""
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
        found = inspected(outlines)
        self._outlines.add(found.outlines)
        self._notes.add(found)
        segments = oriented_segments(found.outlines, found.usable)
        rows = rows_of(segments, found.outlines.height, (self._count, self._last_number))
        low, high = corners_of_rows(rows)
        self._segments.add(low, levels_of(low, high), rows)
        if len(segments.number):
            self._last_number += float(segments.number[-1])
        groups, low, high = fenced_boxes(found.outlines)
        self._fences.add(low, levels_of(low, high), np.column_stack([groups + self._count, low, high]))
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

    def _add_whole(self, index: OutlineIndex, bounds: Border, head: str, most: int) -> dict[str, Any]:
        """Return what is said of the map of the whole site, whose columns are added where it is small."""
        size, is_estimate, groups = size_in_binary(index, bounds), True, []
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
        for part in group_texts(outlines, bounds):
            text, lengths = bytes_of_texts([part.text])
            column.append(text)
            groups.append([part.group, int(lengths[0])])
        return groups

    def _encoded(self, head: str, groups: list[list[Any]]) -> bytes | None:
        """Return the map in binary; None without the package for it, as in most QGIS."""
        text = self._columns["whole_text"].mapped()

        def pieces() -> Iterator[str]:
            return chain([head], (part.text for part in parts_of(text, groups)))

        try:
            return encode_pieces(pieces)
        except RobotMapError:
            return None


def _pieces(outlines: Outlines) -> Iterator[Outlines]:
    """Yield ``outlines``, many of them some at a time."""
    if len(outlines.coordinates) <= AT_ONCE:
        yield outlines
        return
    for first, last in row_spans(outlines, _OBSTACLES):
        yield outlines.chosen(np.arange(first, last))
