"""The queues of the robots, as the gateway told them last."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ...robot_bridge.messages import QueueReport
from ..wire.queue_news import QueueNews


class QueueBook:
    """The newest report of each queue, by its robot."""

    def __init__(self) -> None:
        self.queues: dict[str, QueueReport] = {}

    def __iter__(self) -> Iterator[QueueReport]:
        return iter(self.queues.values())

    def __len__(self) -> int:
        return len(self.queues)

    def merge(self, news: QueueNews) -> list[str]:
        """Take in news and return the robots of whose queues they tell something new."""
        gone = self.queues.keys() - news.queues.keys() if news.every else set()
        for robot in gone:
            del self.queues[robot]
        new = [robot for robot, report in news.queues.items() if self.queues.get(robot) != report]
        self.queues.update(news.queues)
        return [*gone, *new]

    def forget(self, robots: Iterable[str]) -> None:
        """Forget the queues of robots that are there no more."""
        for robot in robots:
            self.queues.pop(robot, None)

    def get(self, robot: str) -> QueueReport | None:
        """Return a robot's queue, None for one that has none."""
        return self.queues.get(robot)

    def revision(self, robot: str) -> int:
        """Return the revision that an edit of a robot's queue has to name: 0 where it has none yet."""
        report = self.queues.get(robot)
        return 0 if report is None else report.revision

    def clear(self) -> None:
        """Forget everything: it is another site's."""
        self.queues.clear()
