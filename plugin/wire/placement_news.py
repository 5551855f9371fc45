"""What the gateway tells of placed cones, and how it is kept until the window looks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from ...robot_bridge.messages import PlacementReport, placement_report

METHOD = "placement"


@dataclass
class PlacementNews:
    """The newest of each placed cone, by its number."""

    placements: dict[int, PlacementReport] = field(default_factory=dict)

    def take(self, reports: Iterable[PlacementReport]) -> None:
        """Take in what was told."""
        self.placements.update({report.placement: report for report in reports})


def placements_in(values: dict[str, Any]) -> list[PlacementReport]:
    """Return the placed cones in an answer; raises KeyError or TypeError for what names itself one."""
    return [placement_report(placement) for placement in values.get("placements") or ()]
