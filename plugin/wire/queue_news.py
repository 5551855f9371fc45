"""What the gateway tells of queues, and how it is kept until the window looks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ...robot_bridge.messages import QueueReport, queue_report

METHOD = "queue"


@dataclass
class QueueNews:
    """The newest of each queue by its robot; ``every`` says that there are no others."""

    queues: dict[str, QueueReport] = field(default_factory=dict)
    every: bool = False

    def take(self, report: QueueReport) -> None:
        """Take in how a robot's queue stands."""
        self.queues[report.robot] = report

    def take_all(self, reports: Iterable[QueueReport]) -> None:
        """Take in how every queue stands."""
        self.queues = {report.robot: report for report in reports}
        self.every = True


def queues_in(values: dict[str, Any]) -> list[QueueReport]:
    """Return the queues in an answer, or in what comes with a refusal.

    :raises KeyError: for what names itself a queue and is none; ValueError and TypeError likewise.
    """
    if {"robot", "revision", "tasks", "robot_state"} <= values.keys():
        return [queue_report(values)]
    return [queue_report(queue) for queue in values.get("queues") or ()]
