"""Messages of a rosbag2 in SQLite."""

from __future__ import annotations

import shutil
import sqlite3
import struct
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from .message import LARGEST_RECORD, CutOffError, Message, plain

_MAGIC = b"SQLite format 3\0"
_HEADER = struct.Struct(">16xH10xI")
"""The size of a page (1 for 65 536) and how many there are."""


def messages(file: Path) -> Iterator[Message]:
    """Yield all messages in the order in which they were written; raises CutOffError and OSError."""
    missing = _missing_bytes(file)
    try:
        with _filled_up(file, missing) as whole:
            yield from _rows(whole)
    except sqlite3.Error as error:
        why = f"{missing} bytes are missing at its end" if missing else f"SQLite says: {error}"
        raise CutOffError(why) from None


def _rows(file: Path) -> Iterator[Message]:
    with closing(sqlite3.connect(f"{file.resolve().as_uri()}?mode=ro", uri=True)) as bag:
        bag.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_RECORD)
        topics = {
            id: (str(name), plain(str(kind)))
            for id, name, kind in bag.execute("SELECT id, name, type FROM topics")
        }
        rows = bag.execute("SELECT id, topic_id, timestamp, data FROM messages ORDER BY id")
        for id, topic, at, data in rows:
            if topic not in topics or not isinstance(at, int) or not isinstance(data, bytes):
                raise CutOffError(f"row {id} of messages makes no sense")
            yield Message(id, *topics[topic], at * 1e-9, data)


def _missing_bytes(file: Path) -> int:
    """Return by how much the file is shorter than it says."""
    with file.open("rb") as content:
        header = content.read(_HEADER.size)
    if len(header) < _HEADER.size or not header.startswith(_MAGIC):
        return 0
    size, count = _HEADER.unpack(header)
    whole = int(count) * (65_536 if size == 1 else int(size))
    return max(0, whole - file.stat().st_size)


@contextmanager
def _filled_up(file: Path, missing: int) -> Iterator[Path]:
    """Give the file; one that is cut off as a copy with noughts behind, since SQLite reads no shorter one."""
    if not missing:
        yield file
        return
    with tempfile.TemporaryDirectory(prefix="robot-bridge-") as folder:
        copy = Path(folder) / "bag.db3"
        shutil.copyfile(file, copy)
        with copy.open("r+b") as content:
            content.truncate(copy.stat().st_size + missing)
        yield copy
