"""Many texts as columns, each made when it is asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeVar, overload

from numpy.typing import NDArray

T = TypeVar("T")

HALVES = "surrogatepass"
"""Half a character is kept as it is; where it must not be, that is told there."""

_MOST_KNOWN = 10_000
"""different texts, and mappings, that are kept as such."""


class _Columns(Sequence[T]):
    """Values that are made when they are asked for; equal to any sequence of the same values."""

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
    """K texts of which many are the same: text k is ``table[codes[k]]``."""

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
    """K mappings, kept as the texts that ``read`` makes mappings of."""

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
