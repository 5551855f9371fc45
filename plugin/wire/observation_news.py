"""What the gateway tells of observations, and how it is kept until the window looks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ...robot_bridge.messages import ObservationReport, observation_report

METHOD = "observation"


@dataclass
class ObservationNews:
    """The newest of each observation, by its number."""

    observations: dict[int, ObservationReport] = field(default_factory=dict)

    def take(self, reports: Iterable[ObservationReport]) -> None:
        """Take in what was told."""
        self.observations.update({report.observation: report for report in reports})


def observations_in(values: dict[str, Any]) -> list[ObservationReport]:
    """Return the observations in an answer.

    :raises KeyError: for what names itself one and is none; ValueError and TypeError likewise.
    """
    if {"observation", "op", "object", "state"} <= values.keys():
        return [observation_report(values)]
    return [observation_report(one) for one in values.get("observations") or ()]
