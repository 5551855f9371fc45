"""What tells one ``site.gpkg`` from every other, whoever has opened it since."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import BinaryIO

_AT_ONCE = 1 << 20
# SQLite writes there whenever a program opens the file in another journal mode, as QGIS does to read it:
# https://www.sqlite.org/fileformat.html#the_database_header
_VOLATILE = (slice(18, 20), slice(24, 28), slice(92, 100))


def geopackage_digest(file: Path) -> str:
    """Return the SHA-256 of what ``file`` holds, with changes that wait beside it; raises OSError."""
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
