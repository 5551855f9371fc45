"""File of numpy columns: written row by row, fully checked, mapped into memory; texts as columns."""

from __future__ import annotations

import hashlib
import io
import json
import math
import mmap
import os
import struct
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, NamedTuple, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from ..errors import CacheError
from ..json_decoder import DecodingError, JsonBounds, decode_json

# --- Arrays on the disk that grow row by row: data of a large site is never in memory as a whole

AT_ONCE = 100_000
"""rows that are in memory together."""


class RowFile:
    """The rows of one array in the new ``file``: each of ``width`` numbers of ``kind``, one where it is 0."""

    def __init__(self, file: Path, kind: Any, width: int = 0) -> None:
        self.dtype = np.dtype(kind)
        self._file = file
        self._shape = (width,) if width else ()
        self._row_bytes = self.dtype.itemsize * max(width, 1)
        self._count = 0
        self._rows = file.open("w+b")

    def __len__(self) -> int:
        return self._count

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the whole array."""
        return (self._count, *self._shape)

    def append(self, rows: NDArray[Any]) -> None:
        """Add ``rows`` at the end, converted to the kind of the array; raises OSError."""
        if not len(rows):
            return
        self._wrote(bytes_of(np.ascontiguousarray(rows, self.dtype)))
        self._count += len(rows)

    def read(self, begin: int, end: int) -> NDArray[Any]:
        """Return some of the rows, which must not be written to; raises OSError."""
        rows = np.empty((end - begin, *self._shape), self.dtype)
        self._rows.seek(begin * self._row_bytes)
        if self._rows.readinto(bytes_of(rows)) != rows.nbytes:
            raise OSError(f"{self._file} was cut off while it was in use")
        self._rows.seek(0, 2)
        return rows

    def pieces(self) -> Iterator[NDArray[Any]]:
        """Yield all rows in their order, no more than :data:`AT_ONCE` at a time; raises OSError."""
        for begin in range(0, self._count, AT_ONCE):
            yield self.read(begin, min(begin + AT_ONCE, self._count))

    def mapped(self) -> NDArray[Any]:
        """Return the whole array, of which only accessed parts are loaded into memory; raises OSError."""
        self._rows.flush()
        if not self._count:
            return np.empty(self.shape, self.dtype)
        # As a plain array: every slice of a memmap takes some microseconds longer.
        return np.memmap(self._file, self.dtype, "r", shape=self.shape).view(np.ndarray)

    def close(self) -> None:
        """Close for reading and writing."""
        self._rows.close()

    def remove(self) -> None:
        """Delete the file."""
        self.close()
        self._file.unlink(missing_ok=True)

    def _wrote(self, content: memoryview) -> None:
        self._rows.write(content)


class ColumnFile(RowFile):
    """A :class:`RowFile` that will become a column; its rows are digested as they are written."""

    def __init__(self, file: Path, kind: Any, width: int = 0) -> None:
        super().__init__(file, kind, width)
        self._digest = hashlib.sha256()

    @property
    def sha256(self) -> str:
        """The digest of all rows as stored in the file."""
        return self._digest.hexdigest()

    def _wrote(self, content: memoryview) -> None:
        super()._wrote(content)
        self._digest.update(content)


class ColumnFiles:
    """Columns by name, in the empty ``folder``; each is made when it gets its first rows."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, ColumnFile] = {}

    def __getitem__(self, name: str) -> ColumnFile:
        return self._files[name]

    def append(self, name: str, rows: NDArray[Any]) -> None:
        """Add ``rows``, (n,) or (n, width), to the column ``name``; raises OSError."""
        if name not in self._files:
            self.make(name, rows.dtype, *rows.shape[1:])
        self._files[name].append(rows)

    def make(self, name: str, kind: Any, width: int = 0) -> ColumnFile:
        """Return the new column ``name``, which is empty; raises OSError."""
        made = self._files[name] = ColumnFile(self._folder / f"{name}.column", kind, width)
        return made

    def remove(self, name: str) -> None:
        """Delete the column ``name``."""
        self._files.pop(name).remove()

    def all(self) -> dict[str, ColumnFile]:
        """Return the columns in the order in which they were made."""
        return dict(self._files)

    def mapped(self) -> dict[str, NDArray[Any]]:
        """Return all columns as arrays that stay on the disk until accessed; raises OSError."""
        return {name: file.mapped() for name, file in self._files.items()}

    def close(self) -> None:
        """Close for reading and writing."""
        for file in self._files.values():
            file.close()


def bytes_of(rows: NDArray[Any]) -> memoryview:
    """Return the memory of contiguous ``rows``."""
    return rows.reshape(math.prod(rows.shape)).view(np.uint8).data


# --- A file of numpy columns: written at once, checked whole before anything in it is used, mapped into
# memory offset  bytes  what
# 0       8      magic, ``FLEETCOL``
# 8       4      version of the layout, 1, little-endian
# 12      4      length of the head
# 16      32     SHA-256 of the head
# 48             head: JSON in UTF-8, ``about`` and ``columns``
# ...            the columns in their order, each from a multiple of 64 on; the file ends with the last one

COLUMN_MAGIC, COLUMN_VERSION = b"FLEETCOL", 1
_PREFIX = struct.Struct("<8sII32s")
_ALIGNED = 64
_LARGEST_HEAD = 4 << 20
_HEAD = JsonBounds(depth=6, length=_LARGEST_HEAD, values=200_000)
_KINDS = ("|b1", "|i1", "|u1", "<i4", "<i8", "<f8")
_AT_ONCE = 1 << 20
_LARGE = 16 << 20
"""bytes from which a file is mapped instead of held in memory."""


class ColumnSet(NamedTuple):
    """Arrays by name, and their description ``about``."""

    about: dict[str, Any]
    arrays: dict[str, NDArray[Any]]


class _Place(NamedTuple):
    name: str
    kind: np.dtype[Any]
    shape: tuple[int, ...]
    offset: int
    size: int
    digest: str


def write_columns(file: Path, about: Mapping[str, Any], columns: Mapping[str, ColumnFile]) -> None:
    """Write ``columns`` to the new ``file``, piece by piece; raises OSError."""
    entries = {
        name: {"kind": column.dtype.str, "shape": list(column.shape), "sha256": column.sha256}
        for name, column in columns.items()
    }
    head = json.dumps({"about": about, "columns": entries}, ensure_ascii=False).encode()
    with file.open("wb") as target:
        target.write(_PREFIX.pack(COLUMN_MAGIC, COLUMN_VERSION, len(head), hashlib.sha256(head).digest()))
        target.write(head)
        for column in columns.values():
            target.write(bytes(_gap(target.tell())))
            for piece in column.pieces():
                target.write(bytes_of(piece))
        target.flush()
        os.fsync(target.fileno())


def read_columns(file: Path) -> ColumnSet:
    """Return the content of ``file``, fully checked; the arrays are read-only.

    A large file is copied and the copy mapped: overwriting or truncating the file while it is in use neither
    changes the data nor crashes a reader.

    :raises CacheError: for a file that is cut off, altered or of another version; and OSError.
    """
    with file.open("rb") as source:
        size = os.fstat(source.fileno()).st_size
        about, places = _head(file, source, size)
        copy = _copy(file, source, size, places)
    return ColumnSet(about, {one.name: _array(copy, one) for one in places})


def read_about(file: Path) -> dict[str, Any]:
    """Return the description of the columns in ``file``, which are not read; raises as
    :func:`read_columns`."""
    with file.open("rb") as source:
        return _head(file, source, os.fstat(source.fileno()).st_size)[0]


def _head(file: Path, source: IO[bytes], size: int) -> tuple[dict[str, Any], list[_Place]]:
    prefix = source.read(_PREFIX.size)
    if len(prefix) < _PREFIX.size:
        raise CacheError(f"{file} is cut off: it has {size} bytes")
    magic, version, length, digest = _PREFIX.unpack(prefix)
    if magic != COLUMN_MAGIC:
        raise CacheError(f"{file} is no file of columns: it begins with {magic!r}")
    if version != COLUMN_VERSION:
        raise CacheError(f"{file} has layout {version}, and {COLUMN_VERSION} is known")
    if length > min(_LARGEST_HEAD, size - _PREFIX.size):
        raise CacheError(f"{file} is cut off or altered: its head is to have {length} bytes")
    head = source.read(length)
    if hashlib.sha256(head).digest() != digest:
        raise CacheError(f"{file} is altered: its head is not the one that was written")
    try:
        content = decode_json(head, _HEAD)
        places = _places(content["columns"], _PREFIX.size + length)
        about = dict(content["about"])
    except (DecodingError, KeyError, TypeError, ValueError) as error:
        raise CacheError(f"{file}: its head cannot be read: {error}") from None
    end = places[-1].offset + places[-1].size if places else _PREFIX.size + length
    if end != size:
        raise CacheError(f"{file} is cut off or altered: it has {size} bytes, and its columns end at {end}")
    return about, places


def _places(entries: Any, begin: int) -> list[_Place]:
    """Return the places of columns; raises KeyError, TypeError or ValueError for invalid entries."""
    places = []
    for name, entry in dict(entries).items():
        kind, shape = entry["kind"], tuple(entry["shape"])
        if kind not in _KINDS or not 1 <= len(shape) <= 2:
            raise ValueError(f"column {name!r} is of kind {kind!r} and shape {shape}")
        if not all(type(count) is int and 0 <= count < 1 << 40 for count in shape):
            raise ValueError(f"column {name!r} has the shape {shape}")
        offset, size = begin + _gap(begin), math.prod(shape) * np.dtype(kind).itemsize
        places.append(_Place(name, np.dtype(kind), shape, offset, size, str(entry["sha256"])))
        begin = offset + size
    return places


def _copy(file: Path, source: IO[bytes], size: int, places: list[_Place]) -> bytes | mmap.mmap:
    source.seek(0)
    if size < _LARGE:
        content = source.read(size)
        _check(file, io.BytesIO(content), places)
        return content
    with tempfile.TemporaryFile(prefix="fleet-site-", dir=_roomy_folder()) as copy:
        left = size
        while left and (some := source.read(min(_AT_ONCE, left))):
            copy.write(some)
            left -= len(some)
        copy.flush()
        # Read, not accessed through the map: that would load all of it into this process.
        _check(file, copy, places)
        return mmap.mmap(copy.fileno(), size, access=mmap.ACCESS_READ)


def _check(file: Path, copy: IO[bytes], places: list[_Place]) -> None:
    for place in places:
        found, left = hashlib.sha256(), place.size
        copy.seek(place.offset)
        while left and (some := copy.read(min(_AT_ONCE, left))):
            found.update(some)
            left -= len(some)
        if left or found.hexdigest() != place.digest:
            raise CacheError(f"{file} is altered: column {place.name!r} is not the one that was written")


def _array(copy: bytes | mmap.mmap, place: _Place) -> NDArray[Any]:
    if not place.size:
        return np.empty(place.shape, place.kind)
    return np.frombuffer(copy, place.kind, math.prod(place.shape), place.offset).reshape(place.shape)


def _roomy_folder() -> str | None:
    """Return a folder that is likely to be on a disk and not in memory; None for the system's own choice."""
    folder = "/var/tmp"  # nosec B108 # files in it get random names
    return None if "TMPDIR" in os.environ or not os.access(folder, os.W_OK) else folder


def _gap(offset: int) -> int:
    return -offset % _ALIGNED


# --- Many texts as columns, each created on access ---

T = TypeVar("T")

HALVES = "surrogatepass"
"""Lone surrogates are kept; where they are not allowed, that is reported there."""

_MOST_KNOWN = 10_000
"""distinct texts, and mappings, that are cached."""


class _Columns(Sequence[T]):
    """Values that are created on access; equal to any sequence of the same values."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and list(self) == list(other)

    # It may equal a list, which has no hash either.
    __hash__ = None  # type: ignore[assignment]


class Texts(_Columns[str]):
    """K texts in one array of bytes: text k is ``content[offsets[k]:offsets[k + 1]]`` in UTF-8."""

    def __init__(self, content: NDArray[Any], offsets: NDArray[Any]) -> None:
        self.content = content
        self.offsets = offsets

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @overload
    def __getitem__(self, k: int) -> str: ...
    @overload
    def __getitem__(self, k: slice) -> list[str]: ...
    def __getitem__(self, k: int | slice) -> str | list[str]:
        if isinstance(k, slice):
            return [self[one] for one in range(*k.indices(len(self)))]
        count = len(self.offsets) - 1
        if not -count <= k < count:
            raise IndexError(f"text {k} of {count}")
        k %= count
        begin, end = self.offsets.item(k), self.offsets.item(k + 1)
        return self.content[begin:end].tobytes().decode("utf-8", HALVES)


class CodedTexts(_Columns[str]):
    """K texts of which many are equal: text k is ``table[codes[k]]``."""

    def __init__(self, table: Sequence[str], codes: NDArray[Any]) -> None:
        self.table = table
        self.codes = codes
        self._known: dict[int, str] = {}

    def __len__(self) -> int:
        return len(self.codes)

    @overload
    def __getitem__(self, k: int) -> str: ...
    @overload
    def __getitem__(self, k: slice) -> list[str]: ...
    def __getitem__(self, k: int | slice) -> str | list[str]:
        if isinstance(k, slice):
            return [self.table[code] for code in self.codes[k].tolist()]
        code = self.codes.item(k)
        known = self._known.get(code)
        if known is None:
            if len(self._known) >= _MOST_KNOWN:
                self._known.clear()
            known = self._known[code] = self.table[code]
        return known


class CodedExtras(_Columns[Mapping[str, str]]):
    """K mappings, stored as texts that ``read`` parses."""

    def __init__(self, texts: CodedTexts, read: Any) -> None:
        self._texts = texts
        self._read = read
        self._known: dict[int, Mapping[str, str]] = {}

    def __len__(self) -> int:
        return len(self._texts)

    def __iter__(self) -> Iterator[Mapping[str, str]]:
        return (self[k] for k in range(len(self)))

    @overload
    def __getitem__(self, k: int) -> Mapping[str, str]: ...
    @overload
    def __getitem__(self, k: slice) -> list[Mapping[str, str]]: ...
    def __getitem__(self, k: int | slice) -> Mapping[str, str] | list[Mapping[str, str]]:
        if isinstance(k, slice):
            return [self[one] for one in range(*k.indices(len(self)))]
        code = int(self._texts.codes[k])
        found = self._known.get(code)
        if found is None:
            if len(self._known) >= _MOST_KNOWN:
                self._known.clear()
            found = self._known[code] = self._read(self._texts.table[code])
        return found
