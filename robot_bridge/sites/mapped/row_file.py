"""Arrays on the disk that grow row by row: what is written of a large site is never in memory as a whole."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
        """Return the whole array, of which only what is looked at comes into memory; raises OSError."""
        self._rows.flush()
        if not self._count:
            return np.empty(self.shape, self.dtype)
        # As a plain array: every slice of the other kind takes some microseconds longer.
        return np.memmap(self._file, self.dtype, "r", shape=self.shape).view(np.ndarray)

    def close(self) -> None:
        """Write nothing more, and read no more."""
        self._rows.close()

    def remove(self) -> None:
        """Delete the file."""
        self.close()
        self._file.unlink(missing_ok=True)

    def _wrote(self, content: memoryview) -> None:
        self._rows.write(content)


class ColumnFile(RowFile):
    """A :class:`RowFile` that is to become a column; its rows are digested as they come."""

    def __init__(self, file: Path, kind: Any, width: int = 0) -> None:
        super().__init__(file, kind, width)
        self._digest = hashlib.sha256()

    @property
    def sha256(self) -> str:
        """The digest of all rows as they stand in the file."""
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
        """Return all columns as arrays that stay on the disk until they are looked at; raises OSError."""
        return {name: file.mapped() for name, file in self._files.items()}

    def close(self) -> None:
        """Write nothing more, and read no more."""
        for file in self._files.values():
            file.close()


def bytes_of(rows: NDArray[Any]) -> memoryview:
    """Return contiguous ``rows`` as they stand in memory."""
    return rows.reshape(math.prod(rows.shape)).view(np.uint8).data
