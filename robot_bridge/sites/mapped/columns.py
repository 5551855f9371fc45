"""A file of numpy columns: written at once, checked whole before anything in it is used, mapped into memory.

offset  bytes  what
0       8      magic, ``FLEETCOL``
8       4      version of the layout, 1, little-endian
12      4      length of the head
16      32     SHA-256 of the head
48             head: JSON in UTF-8, ``about`` and ``columns``
...            the columns in their order, each from a multiple of 64 on; the file ends with the last one
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import mmap
import os
import struct
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.decoding import Bounds, DecodingError, decode_json
from ..errors import CacheError
from .row_file import ColumnFile, bytes_of

MAGIC, VERSION = b"FLEETCOL", 1
_PREFIX = struct.Struct("<8sII32s")
_ALIGNED = 64
_LARGEST_HEAD = 4 << 20
_HEAD = Bounds(depth=6, length=_LARGEST_HEAD, values=200_000)
_KINDS = ("|b1", "|i1", "|u1", "<i4", "<i8", "<f8")
_AT_ONCE = 1 << 20
_LARGE = 16 << 20
"""bytes from which on a file is mapped, and not held in memory."""


class Columns(NamedTuple):
    """Arrays by name, and what is said of them."""

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
    """Write ``columns`` to the new ``file``, some at a time; raises OSError."""
    entries = {
        name: {"kind": column.dtype.str, "shape": list(column.shape), "sha256": column.sha256}
        for name, column in columns.items()
    }
    head = json.dumps({"about": about, "columns": entries}, ensure_ascii=False).encode()
    with file.open("wb") as target:
        target.write(_PREFIX.pack(MAGIC, VERSION, len(head), hashlib.sha256(head).digest()))
        target.write(head)
        for column in columns.values():
            target.write(bytes(_gap(target.tell())))
            for piece in column.pieces():
                target.write(bytes_of(piece))
        target.flush()
        os.fsync(target.fileno())


def read_columns(file: Path) -> Columns:
    """Return what is in ``file``, checked whole; the arrays cannot be written to.

    A large file is copied and the copy mapped: whoever writes over the file, or cuts it off, while it is in
    use changes nothing, and ends nobody who reads it.

    :raises CacheError: for a file that is cut off, altered or of another version; and OSError.
    """
    with file.open("rb") as source:
        size = os.fstat(source.fileno()).st_size
        about, places = _head(file, source, size)
        copy = _copy(file, source, size, places)
    return Columns(about, {one.name: _array(copy, one) for one in places})


def read_about(file: Path) -> dict[str, Any]:
    """Return what is said of the columns in ``file``, which are not read; raises as :func:`read_columns`."""
    with file.open("rb") as source:
        return _head(file, source, os.fstat(source.fileno()).st_size)[0]


def _head(file: Path, source: IO[bytes], size: int) -> tuple[dict[str, Any], list[_Place]]:
    prefix = source.read(_PREFIX.size)
    if len(prefix) < _PREFIX.size:
        raise CacheError(f"{file} is cut off: it has {size} bytes")
    magic, version, length, digest = _PREFIX.unpack(prefix)
    if magic != MAGIC:
        raise CacheError(f"{file} is no file of columns: it begins with {magic!r}")
    if version != VERSION:
        raise CacheError(f"{file} has layout {version}, and {VERSION} is known")
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
    """Return where columns are; raises KeyError, TypeError or ValueError for what describes none."""
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
        # Read and not looked at in the map: that would bring all of it into this process.
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
    if "TMPDIR" in os.environ or not os.access("/var/tmp", os.W_OK):
        return None
    return "/var/tmp"


def _gap(offset: int) -> int:
    return -offset % _ALIGNED
