"""The cones that robots put down, as the gateway told them last."""

from __future__ import annotations

from collections.abc import Iterator

from ...robot_bridge.messages import PlacementReport
from ..wire.placement_news import PlacementNews

MOST_PLACEMENTS = 20_000
MOST_ASKED = 5000
"""As many as a gateway tells at once."""


class PlacementBook:
    """The newest report of each placed cone, by its number; of very many the newest."""

    def __init__(self) -> None:
        self._reports: dict[int, PlacementReport] = {}

    def __iter__(self) -> Iterator[PlacementReport]:
        return iter(self._reports.values())

    def __len__(self) -> int:
        return len(self._reports)

    def merge(self, news: PlacementNews) -> list[int]:
        """Take in news and return the numbers of the cones of which they tell something new."""
        new = [number for number, one in news.placements.items() if self._reports.get(number) != one]
        self._reports.update(news.placements)
        for number in sorted(self._reports)[: max(0, len(self._reports) - MOST_PLACEMENTS)]:
            del self._reports[number]
        return new

    def clear(self) -> None:
        """Forget everything: it is another site's."""
        self._reports.clear()
