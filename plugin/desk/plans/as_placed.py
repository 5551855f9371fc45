"""The as-placed report: each cone with where it was to stand, where it stands, how far off, by whom, when."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timezone

from ....robot_bridge.messages import PlacementReport
from ...language import tr, tr_count

COLUMNS = (
    "cone", "layout", "planned_x", "planned_y", "x", "y", "deviation", "robot", "placed_at", "collected_at",
)  # fmt: skip


@dataclass(frozen=True)
class Tally:
    """What the report comes to; metres."""

    cones: int
    collected: int
    largest: float
    mean: float

    def in_words(self, expected: int | None = None) -> str:
        """Return the figures, with how many cones the plan has if that is known."""
        if not self.cones:
            return tr("No cone was put down yet.")
        placed = (
            tr_count(expected, "{cones} of 1 cone placed", "{cones} of %n cones placed", cones=self.cones)
            if expected
            else tr_count(self.cones, "1 cone placed", "%n cones placed")
        )
        gone = tr(", {collected} collected again", collected=self.collected) if self.collected else ""
        off = tr(
            "off by {mean:.3f} m on average, at most {largest:.3f} m",
            mean=self.mean,
            largest=self.largest,
        )
        return tr("{placed}{gone}; {off}", placed=placed, gone=gone, off=off)


def chosen(
    placements: Iterable[PlacementReport], *, plan: str | None = None, layout: str | None = None
) -> list[PlacementReport]:
    """Return the placed cones of a plan, of a layout, or of all, in the order of placing."""
    found = [
        one
        for one in placements
        if (plan is None or one.plan == plan) and (layout is None or one.layout == layout)
    ]
    return sorted(found, key=lambda one: (one.placed_at, one.placement))


def tally(placements: list[PlacementReport]) -> Tally:
    """Return what the report comes to."""
    off = [one.deviation for one in placements]
    collected = sum(one.collected_at is not None for one in placements)
    return Tally(len(off), collected, max(off, default=0.0), sum(off) / len(off) if off else 0.0)


def csv_row(one: PlacementReport) -> list[object]:
    """Return the values of ``COLUMNS``; metres in the site frame, times in UTC."""
    return [
        one.cone or one.label or "",
        one.layout or "",
        *(round(value, 3) for value in (one.planned_x, one.planned_y, one.x, one.y, one.deviation)),
        one.robot,
        utc_in_words(one.placed_at),
        utc_in_words(one.collected_at),
    ]


def utc_in_words(at: float | None) -> str:
    """Return seconds since 1970 as ISO 8601 in UTC, nothing for None."""
    if at is None:
        return ""
    return datetime.fromtimestamp(at, timezone.utc).isoformat(timespec="seconds").replace("+00:00", "Z")
