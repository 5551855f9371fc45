"""The observations that the desk knows of, as the gateway told them last."""

from __future__ import annotations

from collections.abc import Iterator

from ...robot_bridge.messages import ObservationReport, ObservationState
from ..wire.observation_news import ObservationNews

MOST_REVIEWED = 1000
"""Reviewed ones that are kept; those that wait for their review are all kept."""


class ObservationBook:
    """The newest report of each observation, by its number."""

    def __init__(self) -> None:
        self._reports: dict[int, ObservationReport] = {}

    def __iter__(self) -> Iterator[ObservationReport]:
        return iter(self._reports.values())

    def __len__(self) -> int:
        return len(self._reports)

    @property
    def pending(self) -> int:
        """How many wait for their review."""
        return sum(is_pending(report) for report in self._reports.values())

    def merge(self, news: ObservationNews) -> list[int]:
        """Take in news and return the numbers of those of which they tell something new."""
        new = [number for number, one in news.observations.items() if self._reports.get(number) != one]
        self._reports.update(news.observations)
        if new:
            reviewed = sorted(n for n, one in self._reports.items() if not is_pending(one))
            for number in reviewed[: max(0, len(reviewed) - MOST_REVIEWED)]:
                del self._reports[number]
        return new

    def get(self, number: int) -> ObservationReport | None:
        """Return an observation, None if it is not known."""
        return self._reports.get(number)

    def ordered(self) -> list[ObservationReport]:
        """Return all, those that wait first, of these the newest first."""
        return sorted(self._reports.values(), key=lambda one: (not is_pending(one), -one.observation))

    def clear(self) -> None:
        """Forget everything: it is another site's."""
        self._reports.clear()


def is_pending(report: ObservationReport) -> bool:
    """Tell whether nobody has reviewed an observation yet."""
    return report.state is ObservationState.PENDING
