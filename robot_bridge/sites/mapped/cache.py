"""What ``site.cache`` holds of a site: outlines, their index, what is fenced, and the whole map's text."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...robotmap.grid import BoxGrid, Cells
from ...robotmap.group_texts import GroupText
from ...robotmap.index import Notes, OutlineIndex
from ...robotmap.outlines import Outlines
from ..errors import CacheError
from ..extras import extras_of
from ..fences import FencedRows
from .columns import Columns, read_about, read_columns
from .geopackage_digest import geopackage_digest
from .texts import HALVES, CodedExtras, CodedTexts, Texts

CACHE_FILE = "site.cache"
CONTENT = 1
"""The version of what is computed: higher whenever the same site.gpkg would give other columns."""
SURELY_TOO_LARGE = 2
"""times the largest size of a whole map: one that has more, as far as some windows tell, is not tried."""
_NOT_USED = "It is not used; publish the site again, or delete it"

COLUMNS = (
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
"""What there may be in the file, in this order."""

Arrays = dict[str, NDArray[Any]]
Publication = Mapping[str, Any]
"""What columns depend on beside site.gpkg: the stamp, the frame and the bounds of the site."""


@dataclass(frozen=True)
class WholeMap:
    """The map of the whole site, made at publishing, of ``head`` and ``texts``; ``content`` is it in binary.

    Where it is too large to be sent there are no texts; ``size`` is how many bytes it has, or about that
    many where it ``is_estimate``.
    """

    size: int
    is_estimate: bool
    head: str
    texts: Callable[[], Iterator[GroupText]] | None
    content: bytes | None


@dataclass(frozen=True)
class SiteCache:
    """The arrays of one publication; those of a large site stay on the disk until they are looked at."""

    index: OutlineIndex
    fenced: FencedRows
    whole: WholeMap

    @property
    def outlines(self) -> Outlines:
        """The outlines of the site."""
        return self.index.outlines


def read_cache(file: Path, geopackage: Path, publication: Publication) -> SiteCache:
    """Return what ``file`` holds, computed of ``geopackage`` as it is now.

    :raises CacheError: for one that is damaged, of another version, or of another publication, saying what to
        do; and OSError.
    """
    try:
        _check_same(file, read_about(file), {"content": CONTENT, **publication})
        _check_same(file, read_about(file), {"geopackage": geopackage_digest(geopackage)})
        columns = read_columns(file)
        return _cache_of(columns)
    except CacheError as error:
        raise CacheError(f"{error}. {_NOT_USED}") from error
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise CacheError(f"{file} is altered: {error!r} is wrong in it. {_NOT_USED}") from error


def _check_same(file: Path, about: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    for name, value in wanted.items():
        if about.get(name) != value:
            raise CacheError(
                f"{file} belongs to another publication, or to another version of this program: its {name} "
                f"is {str(about.get(name))[:80]}, and {str(value)[:80]} is needed"
            )


def _cache_of(columns: Columns) -> SiteCache:
    about, arrays = columns
    index = index_of(arrays, about["grid"])
    _require(arrays["rows"].ndim == 2 and arrays["rows"].shape[1] == 7, "rows")
    _require(index.grid.cells.starts[-1] == len(index.rows), "grid_starts")
    grid = _grid(about["fence_grid"], arrays, "fence_grid")
    first, last, low, high = (arrays[f"fence_{name}"] for name in ("first", "last", "low", "high"))
    fenced = FencedRows(first, last, low, high, grid)
    _require(grid.cells.starts[-1] == len(fenced.first) == len(fenced.low), "fence_grid_starts")
    return SiteCache(index, fenced, _whole(about["whole"], arrays))


def index_of(arrays: Arrays, grid: Mapping[str, Any]) -> OutlineIndex:
    """Return the index that ``arrays`` hold; ``grid`` is what is said of its grid.

    :raises ValueError: naming what is wrong, or KeyError for a column that is missing.
    """
    notes = Notes(
        Texts(arrays["note_text"], arrays["note_offsets"]),
        arrays["note_low"],
        arrays["note_high"],
        arrays["note_everywhere"],
    )
    return OutlineIndex(_outlines(arrays), arrays["rows"], _grid(grid, arrays, "grid"), notes)


def parts_of(text: NDArray[Any], groups: Iterable[Sequence[Any]]) -> Iterator[GroupText]:
    """Yield the parts of ``text``, each of a group and so many bytes."""
    end = 0
    for group, length in groups:
        end += length
        yield GroupText(group, text[end - length : end].tobytes().decode("utf-8", HALVES))


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
        extras = CodedExtras(_decoded("ext", arrays), lambda text: extras_of(text, CACHE_FILE))
    outlines = Outlines(
        coordinates=arrays["coordinates"],
        offsets=arrays["offsets"],
        shape_type=arrays["shape_type"],
        courtyard=arrays["courtyard"],
        height=arrays["height"],
        outdoor=arrays["outdoor"],
        semantics=_decoded("semantics", arrays),
        source=Texts(arrays["source_text"], arrays["source_offsets"]),
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


def _grid(about: Mapping[str, Any], arrays: Arrays, name: str) -> BoxGrid:
    keys, starts = arrays[f"{name}_keys"], arrays[f"{name}_starts"]
    _require(len(starts) == len(keys) + 1, f"{name}_starts")
    origin = [float(edge) for edge in about["origin"]]
    return BoxGrid(Cells(keys, starts, origin, int(about["placed"]), tuple(map(int, about["levels"]))))


def _decoded(name: str, arrays: Arrays) -> CodedTexts:
    table = Texts(arrays[f"{name}_text"], arrays[f"{name}_offsets"])
    return CodedTexts(table, arrays[f"{name}_codes"])


def _require(fine: bool | np.bool_, column: str) -> None:
    if not fine:
        raise ValueError(column)
