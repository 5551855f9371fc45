"""Texts written into columns as they come: those that :mod:`.texts` reads."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .row_file import ColumnFiles
from .texts import HALVES

_MOST_KNOWN = 8 << 20
"""bytes, about, of texts that are remembered, so that each is written once."""
_EACH = 100
"""bytes, about, that one of them takes besides its characters."""


class TextColumns:
    """Appends texts to the columns ``name`` + ``_text`` and ``_offsets``, which it makes."""

    def __init__(self, columns: ColumnFiles, name: str) -> None:
        self._content = columns.make(f"{name}_text", np.uint8)
        self._offsets = columns.make(f"{name}_offsets", np.int64)
        self._end = 0
        self._offsets.append(np.zeros(1, dtype=np.int64))

    def add(self, texts: Iterable[str]) -> None:
        """Add ``texts``; raises OSError."""
        content, lengths = bytes_of_texts(texts)
        self.add_bytes(content)
        self.add_lengths(lengths)

    def add_bytes(self, content: NDArray[Any]) -> None:
        """Add bytes of texts whose lengths come by :meth:`add_lengths`; raises OSError."""
        self._content.append(content)

    def add_lengths(self, lengths: NDArray[Any]) -> None:
        """Add texts of so many bytes each; raises OSError."""
        self._offsets.append(self._end + np.cumsum(lengths))
        self._end += int(lengths.sum())


class CodedTextColumns:
    """Appends texts of which many are the same: to a table of them, and their places to ``_codes``.

    Of very many different ones some stand in the table again.
    """

    def __init__(self, columns: ColumnFiles, name: str) -> None:
        self._codes = columns.make(f"{name}_codes", np.int32)
        self._table = TextColumns(columns, name)
        self._count = 0
        self._room = _MOST_KNOWN
        self._known: dict[str, int] = {}

    def add(self, texts: Iterable[str]) -> None:
        """Add ``texts``; raises OSError."""
        new: list[str] = []
        self._codes.append(np.array([self._code(text, new) for text in texts], dtype=np.int32))
        self._table.add(new)

    def _code(self, text: str, new: list[str]) -> int:
        code = self._known.get(text)
        if code is None:
            self._room -= len(text) + _EACH
            if self._room < 0:
                self._known.clear()
                self._room = _MOST_KNOWN
            code = self._known[text] = self._count
            self._count += 1
            new.append(text)
        return code


def bytes_of_texts(texts: Iterable[str]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return ``texts`` one after the other in UTF-8, and how many bytes each has."""
    raw = [text.encode("utf-8", HALVES) for text in texts]
    return np.frombuffer(b"".join(raw), np.uint8), np.fromiter(map(len, raw), np.int64, len(raw))
