"""Room for texts in the columns of a table: shared out, and kept to by leaving out the middle of a text."""

from __future__ import annotations

from collections.abc import Callable, Sequence


def shared(room: float, needs: Sequence[float]) -> list[float]:
    """Return ``room`` dealt out: each gets what it needs or an equal share, and the neediest what is left."""
    given = [0.0] * len(needs)
    order = sorted(range(len(needs)), key=needs.__getitem__)
    for done, each in enumerate(order):
        given[each] = min(needs[each], room / (len(needs) - done))
        room -= given[each]
    given[order[-1]] += room
    return given


def shortened(text: str, room: float, width_of: Callable[[str], float]) -> str:
    """Return ``text`` as it fits into ``room``, by ``width_of``: its end, often a number, tells it apart."""
    if width_of(text) <= room:
        return text
    for kept in range(len(text) - 1, 1, -1):
        end = text[len(text) - kept // 2 :]
        short = f"{text[: kept - len(end)]}…{end}"
        if width_of(short) <= room:
            return short
    return "…"
