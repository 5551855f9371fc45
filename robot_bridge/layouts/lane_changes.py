"""Severe lane changes: ISO 3888-1 and ISO 3888-2.

The texts of the standards are not public; the dimensions come from models that name them as their source.
Where those differ, the difference is said, and is a dimension.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .cone import Spot
from .layout import Layout, dimension
from .rows import lane, mirrored

LEFT, CENTRE, RIGHT = 1, 0, -1


@dataclass(frozen=True)
class _LaneChange(Layout):
    """Three lanes: in, to the side, and back. The origin is the middle of the entry."""

    vehicle_width: float = dimension(1.8, "Width of the vehicle without mirrors", least=0.1)
    cones_per_row: float = dimension(3, "Cones on each side of each lane", "", least=2, whole=True)
    exit_side: float = dimension(
        CENTRE,
        "What of the exit lane is in line with the entry lane",
        "",
        least=-1,
        choices={LEFT: "left limit", CENTRE: "middle", RIGHT: "right limit"},
    )
    turn: float = dimension(
        LEFT, "To which side it goes first", "", least=-1, choices={LEFT: "left", RIGHT: "right"}
    )

    @abstractmethod
    def lanes(self) -> list[tuple[str, float, float, float, float]]:
        """Return role, start, length, y of the right limit and width of each lane, for a turn to the left."""

    def spots(self) -> list[Spot]:
        count = int(self.cones_per_row)
        made = [
            spot
            for role, start, length, right, width in self.lanes()
            for spot in lane(
                [float(x) for x in np.linspace(start, start + length, count)],
                right,
                width,
                self.cone_base,
                role,
            )
        ]
        return made if self.turn == LEFT else mirrored(made)

    def exit_right(self, entry: float, out: float) -> float:
        """Return the y of the exit lane's right limit, from the widths of both lanes."""
        return -out / 2 + self.exit_side * (entry - out) / 2


@dataclass(frozen=True)
class DoubleLaneChange(_LaneChange):
    """ISO 3888-1: 125 m, three lanes whose widths follow the vehicle's.

    Sections of 15, 30, 25, 25 and 15 + 15 m; widths 1.1, 1.2 and 1.3 times the vehicle's and 0.25 m; lane
    offset 3.5 m (Table 1 of the standard, after MathWorks' Simscape Vehicle Templates, a Modelica model of
    the 1999 edition and Project Chrono, which ends after the first 15 m of the exit). Cones at start, middle
    and end of each row: Project Chrono. What the offset is measured between differs: the right limits of both
    lanes (a model after the published drawing of the track, taken here), the middles of both (the Modelica
    model), or the middle of the first and the right limit of the second (Project Chrono). The exit lane has
    the middle of the entry lane (the drawing) or its right limit (Project Chrono).
    """

    NAME: ClassVar[str] = "iso3888_1"
    TITLE: ClassVar[str] = "Double lane change"
    STANDARD: ClassVar[str] = "ISO 3888-1:2018"

    entry_length: float = dimension(15, "Section 1: entry lane", least=0.1)
    out_length: float = dimension(30, "Section 2: way to the side lane")
    side_length: float = dimension(25, "Section 3: side lane", least=0.1)
    back_length: float = dimension(25, "Section 4: way back")
    exit_length: float = dimension(30, "Sections 5 and 6: exit lane", least=0.1)
    entry_factor: float = dimension(1.1, "Vehicle widths in the width of the entry lane", "")
    side_factor: float = dimension(1.2, "Vehicle widths in the width of the side lane", "")
    exit_factor: float = dimension(1.3, "Vehicle widths in the width of the exit lane", "")
    margin: float = dimension(0.25, "What is added to each of these widths")
    lane_offset: float = dimension(3.5, "From the right limit of the entry lane to that of the side lane")

    def lanes(self) -> list[tuple[str, float, float, float, float]]:
        factors = (self.entry_factor, self.side_factor, self.exit_factor)
        entry, side, out = (factor * self.vehicle_width + self.margin for factor in factors)
        aside = self.entry_length + self.out_length
        back = aside + self.side_length + self.back_length
        return [
            ("entry", 0.0, self.entry_length, -entry / 2, entry),
            ("side", aside, self.side_length, self.lane_offset - entry / 2, side),
            ("exit", back, self.exit_length, self.exit_right(entry, out), out),
        ]


@dataclass(frozen=True)
class ObstacleAvoidance(_LaneChange):
    """ISO 3888-2, the moose test of the VDA: 61 m, three lanes whose widths follow the vehicle's.

    Sections of 12, 13.5, 11, 12.5 and 12 m, 61 m in all; widths 1.1 times the vehicle's and 0.25 m, the
    vehicle's and 1 m, 1.3 times the vehicle's and 0.25 m but at least 3 m; 1 m between the left limit of the
    entry lane and the right limit of the side lane; cones of 500 mm or more whose bases touch the limits from
    outside (clauses 4.1 and 4.2, Table 1 and Figures 1 and 3 of the 2011 edition, after models that quote
    them; the VDA gives the same width of the entry lane). For the exit lane Project Chrono has 3 m for every
    vehicle, CommonRoad at most instead of at least 3 m. Its left limit is in line with that of the entry lane
    (a model that quotes Figures 1 and 3, taken here), or its middle (CommonRoad), or its right limit (Project
    Chrono).
    """

    NAME: ClassVar[str] = "iso3888_2"
    TITLE: ClassVar[str] = "Obstacle avoidance"
    STANDARD: ClassVar[str] = "ISO 3888-2:2011"

    entry_length: float = dimension(12, "Section 1: entry lane", least=0.1)
    out_length: float = dimension(13.5, "Section 2: way to the side lane")
    side_length: float = dimension(11, "Section 3: side lane", least=0.1)
    back_length: float = dimension(12.5, "Section 4: way back")
    exit_length: float = dimension(12, "Section 5: exit lane", least=0.1)
    entry_factor: float = dimension(1.1, "Vehicle widths in the width of the entry lane", "")
    entry_margin: float = dimension(0.25, "What is added to the width of the entry lane")
    side_factor: float = dimension(1.0, "Vehicle widths in the width of the side lane", "")
    side_margin: float = dimension(1.0, "What is added to the width of the side lane")
    exit_factor: float = dimension(1.3, "Vehicle widths in the width of the exit lane", "")
    exit_margin: float = dimension(0.25, "What is added to the width of the exit lane")
    exit_least: float = dimension(3.0, "Least width of the exit lane")
    lane_offset: float = dimension(
        1.0, "From the left limit of the entry lane to the right one of the side lane"
    )
    exit_side: float = dimension(
        LEFT,
        "What of the exit lane is in line with the entry lane",
        "",
        least=-1,
        choices={LEFT: "left limit", CENTRE: "middle", RIGHT: "right limit"},
    )

    def lanes(self) -> list[tuple[str, float, float, float, float]]:
        entry = self.entry_factor * self.vehicle_width + self.entry_margin
        side = self.side_factor * self.vehicle_width + self.side_margin
        out = max(self.exit_factor * self.vehicle_width + self.exit_margin, self.exit_least)
        aside = self.entry_length + self.out_length
        back = aside + self.side_length + self.back_length
        return [
            ("entry", 0.0, self.entry_length, -entry / 2, entry),
            ("side", aside, self.side_length, entry / 2 + self.lane_offset, side),
            ("exit", back, self.exit_length, self.exit_right(entry, out), out),
        ]
