"""Standard layouts by name: circles, lane changes (ISO 3888), straights, corridor."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..errors import DimensionError
from .layout import (
    BIG_ORANGE,
    BLUE,
    ORANGE,
    YELLOW,
    Layout,
    Spot,
    across,
    dimension,
    lane,
    mirrored,
    pairs,
    spaced,
)

# --- Layouts on circles: the constant-radius circle and the skid pad ---

LEFT_TURN, RIGHT_TURN = 1, -1


@dataclass(frozen=True)
class ConstantRadius(Layout):
    """A circle to drive steadily on (ISO 4138, method 1). The origin is the middle of the circle.

    Drivers start on the x axis of the layout. 100 m is the usual radius; the text of the standard, which
    allows others, was not at hand, and its users drive 40 and 50 m too (Altair MotionView, a library of
    manoeuvres of 2021). Width and spacing are ours.
    """

    NAME: ClassVar[str] = "circle"
    TITLE: ClassVar[str] = "Constant-radius circle"
    STANDARD: ClassVar[str] = "ISO 4138:2021, method 1"

    radius: float = dimension(100, "Radius of the middle of the lane", least=1)
    width: float = dimension(3.5, "Clear width of the lane", least=0.1)
    spacing: float = dimension(10, "From cone to cone along the middle of the lane", least=0.5)
    turn: float = dimension(
        LEFT_TURN,
        "Which way it is driven",
        "",
        least=-1,
        choices={LEFT_TURN: "to the left", RIGHT_TURN: "to the right"},
    )

    def cone_counts(self) -> dict[str, float]:
        return {"radius": 4 * math.pi * self.radius / self.spacing}

    def spots(self) -> list[Spot]:
        within, around = self.radius - self.width / 2, self.radius + self.width / 2
        if within - self.cone_base <= 0:
            raise DimensionError(f"{self.NAME}: the lane is wider than the circle: give a larger radius.")
        count = max(3, round(2 * math.pi * self.radius / self.spacing))
        angles = np.arange(count) * 2 * math.pi / count * self.turn
        return [
            _at(0.0, 0.0, radius, float(angle), int(self.turn), ORANGE, role)
            for angle in angles
            for radius, role in (
                (within - self.cone_base / 2, "inner"),
                (around + self.cone_base / 2, "outer"),
            )
        ]


@dataclass(frozen=True)
class SkidPad(Layout):
    """Skid pad of Formula Student: a figure of eight, the right circle first. The origin is where they meet.

    Centres 18.25 m apart, circles of 15.25 and 21.25 m, 16 cones inside each inner and 13 outside each outer
    circle, a path of 3 m to go in and out that is a tangent of the circles where they meet (Formula Student
    Rules, D 4.1; Formula SAE Rules, D.10.1; both as programs quote them). The 13 cones stand 22.5° apart away
    from the meeting point, as in eufs_sim and AMZ's fssim. Where the cones of the ways in and out and the
    four at the timing line stand is eufs_sim's; its circles, though, are 18.5 m apart.
    """

    NAME: ClassVar[str] = "fs_skidpad"
    TITLE: ClassVar[str] = "Formula Student skid pad"
    STANDARD: ClassVar[str] = "Formula Student Rules, D 4.1"

    centres: float = dimension(18.25, "From centre to centre of the circles", least=1)
    inner: float = dimension(15.25, "Diameter of the inner circles", least=0.5)
    outer: float = dimension(21.25, "Diameter of the outer circles", least=1)
    inner_count: float = dimension(16, "Cones inside each inner circle", "", least=3, whole=True)
    outer_count: float = dimension(13, "Cones outside each outer circle", "", least=2, whole=True)
    outer_span: float = dimension(270, "Part of each outer circle that has cones", "degrees", least=1)
    path_width: float = dimension(3, "Clear width of the ways in and out", least=0.1)
    gate_start: float = dimension(9, "From the meeting point to the first cones of the ways in and out")
    entry_length: float = dimension(2, "Length of the way in that has cones")
    exit_length: float = dimension(12, "Length of the way out that has cones", least=0.1)
    gate_spacing: float = dimension(2, "From cone to cone along the ways in and out", least=0.5)
    end_cones: float = dimension(2, "Cones that close the way out", "", whole=True)
    timing_along: float = dimension(1.485, "From the timing line to the big cones before and behind it")
    timing_across: float = dimension(1.7837, "From the middle of the path to these cones")

    def cone_counts(self) -> dict[str, float]:
        return {
            "inner_count": 2 * self.inner_count,
            "outer_count": 2 * self.outer_count,
            "entry_length": pairs(self.entry_length, self.gate_spacing),
            "exit_length": pairs(self.exit_length, self.gate_spacing),
            "end_cones": self.end_cones,
        }

    def spots(self) -> list[Spot]:
        if not self.inner < self.outer or not 0 < self.outer_span <= 360:
            raise DimensionError(
                f"{self.NAME}: give an outer circle larger than the inner one, and a span of 1 to 360°."
            )
        right, base = -self.path_width / 2, self.cone_base
        entry = [
            x - self.gate_start - self.entry_length for x in spaced(0.0, self.entry_length, self.gate_spacing)
        ]
        out = spaced(self.gate_start, self.exit_length, self.gate_spacing)
        timing = [
            Spot(x, y, 0.0, BIG_ORANGE, "timing")
            for x in (-self.timing_along, self.timing_along)
            for y in (self.timing_across, -self.timing_across)
        ]
        return [
            *lane(entry, right, self.path_width, base, "entry"),
            *timing,
            *self._circle(RIGHT_TURN, (BLUE, YELLOW)),
            *self._circle(LEFT_TURN, (YELLOW, BLUE)),
            *lane(out, right, self.path_width, base, "exit"),
            *across(out[-1], right, self.path_width, int(self.end_cones), "end"),
        ]

    def _circle(self, turn: int, colours: tuple[str, str]) -> list[Spot]:
        """Return the cones of the circle driven by ``turn``; ``colours`` are those outside and inside."""
        y, away = turn * self.centres / 2, turn * math.pi / 2
        inside = away + math.pi + np.arange(int(self.inner_count)) * 2 * math.pi / self.inner_count * turn
        half = math.radians(self.outer_span) / 2
        outside = away + np.linspace(-half, half, int(self.outer_count)) * turn
        side = "left" if turn == LEFT_TURN else "right"
        near, far = self.inner / 2 - self.cone_base / 2, self.outer / 2 + self.cone_base / 2
        return [
            *(_at(0.0, y, near, float(angle), turn, colours[1], f"{side} inner") for angle in inside),
            *(_at(0.0, y, far, float(angle), turn, colours[0], f"{side} outer") for angle in outside),
        ]


def _at(x: float, y: float, radius: float, angle: float, turn: int, colour: str, role: str) -> Spot:
    """Return the spot on a circle; ``turn`` is the direction of driving past it."""
    theta = math.remainder(angle + turn * math.pi / 2, 2 * math.pi)
    return Spot(x + radius * math.cos(angle), y + radius * math.sin(angle), theta, colour, role)


# --- Severe lane changes: ISO 3888-1 and ISO 3888-2 ---
# The texts of the standards are not public; the dimensions come from models that name them as their source.
# Where those differ, the difference is documented, and is a dimension.

LEFT_LANE, CENTRE_LANE, RIGHT_LANE = 1, 0, -1


@dataclass(frozen=True)
class _LaneChange(Layout):
    """Three lanes: in, to the side, and back. The origin is the middle of the entry."""

    vehicle_width: float = dimension(1.8, "Width of the vehicle without mirrors", least=0.1)
    cones_per_row: float = dimension(3, "Cones on each side of each lane", "", least=2, whole=True)
    exit_side: float = dimension(
        CENTRE_LANE,
        "What of the exit lane is in line with the entry lane",
        "",
        least=-1,
        choices={LEFT_LANE: "left limit", CENTRE_LANE: "middle", RIGHT_LANE: "right limit"},
    )
    turn: float = dimension(
        LEFT_LANE,
        "To which side it goes first",
        "",
        least=-1,
        choices={LEFT_LANE: "left", RIGHT_LANE: "right"},
    )

    @abstractmethod
    def lanes(self) -> list[tuple[str, float, float, float, float]]:
        """Return role, start, length, y of the right limit and width of each lane, for a turn to the left."""

    def cone_counts(self) -> dict[str, float]:
        return {"cones_per_row": 6 * self.cones_per_row}

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
        return made if self.turn == LEFT_LANE else mirrored(made)

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
        LEFT_LANE,
        "What of the exit lane is in line with the entry lane",
        "",
        least=-1,
        choices={LEFT_LANE: "left limit", CENTRE_LANE: "middle", RIGHT_LANE: "right limit"},
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


# --- Layouts along a straight line: slalom, braking lane, acceleration ---


@dataclass(frozen=True)
class Slalom(Layout):
    """Cones in a row between two gates. The origin is the middle of the first gate.

    There is no standard of ISO for it. Nine cones 18 m apart with the timing 6 m before the first and behind
    the last, 156 m in all, are what European testers drive (Laboratorio Automotriz, Prueba de slalom); Motor
    Trend has seven cones 100 ft (30.48 m) apart. The width of the gates is ours.
    """

    NAME: ClassVar[str] = "slalom"
    TITLE: ClassVar[str] = "Slalom"
    STANDARD: ClassVar[str] = "no standard: 18 m as European testers drive it"

    count: float = dimension(9, "Cones to go round", "", least=1, whole=True)
    spacing: float = dimension(18, "From cone to cone", least=0.5)
    gate_distance: float = dimension(6, "From a gate to the nearest cone", least=0.1)
    gate_width: float = dimension(3, "Clear width of the gates", least=0.1)

    def cone_counts(self) -> dict[str, float]:
        return {"count": self.count}

    def spots(self) -> list[Spot]:
        def gate(x: float, role: str) -> list[Spot]:
            colours = (BIG_ORANGE, BIG_ORANGE)
            return lane([x], -self.gate_width / 2, self.gate_width, self.cone_base, role, colours)

        places = [self.gate_distance + k * self.spacing for k in range(int(self.count))]
        row = [Spot(x, 0.0, 0.0, ORANGE, "slalom") for x in places]
        return [*gate(0.0, "start"), *row, *gate(places[-1] + self.gate_distance, "finish")]


@dataclass(frozen=True)
class BrakingLane(Layout):
    """A lane to brake in, with a gate where braking begins. The origin is the middle of the entry.

    The lane is as long as the longest stopping distance that UN Regulation No. 13-H allows cars, 0.1 v +
    0.006 v² metres at v km/h (Annex 3, type-0 test, engine disconnected; its text was not at hand): 70 m at
    100 km/h. ISO 21994 says how such stops are driven and measured; approach, width and spacing are ours.
    """

    NAME: ClassVar[str] = "braking_lane"
    TITLE: ClassVar[str] = "Braking lane"
    STANDARD: ClassVar[str] = "length after UN R13-H; test after ISO 21994"

    speed: float = dimension(100, "Speed at which braking begins", "km/h", least=1)
    approach: float = dimension(20, "Lane before braking begins")
    width: float = dimension(3.5, "Clear width of the lane", least=0.1)
    spacing: float = dimension(10, "From cone to cone along the lane", least=0.5)

    def cone_counts(self) -> dict[str, float]:
        return {
            "approach": pairs(self.approach, self.spacing),
            "speed": pairs(self._stopping_distance(), self.spacing),
        }

    def spots(self) -> list[Spot]:
        right, base = -self.width / 2, self.cone_base
        before = spaced(0.0, self.approach, self.spacing)[:-1] if self.approach else []
        after = spaced(self.approach, self._stopping_distance(), self.spacing)[1:]
        return [
            *lane(before, right, self.width, base, "approach"),
            *lane([self.approach], right, self.width, base, "braking", (BIG_ORANGE, BIG_ORANGE)),
            *lane(after, right, self.width, base, "stopping"),
        ]

    def _stopping_distance(self) -> float:
        return 0.1 * self.speed + 0.006 * self.speed * self.speed


@dataclass(frozen=True)
class Acceleration(Layout):
    """Acceleration of Formula Student. The origin is the middle of the starting line.

    75 m from line to line, 3 m wide or more, cones about 5 m apart, a stop within 100 m in a marked exit lane
    (Formula Student Rules, D 5.1, as OpenDLV's mission control quotes them). The real layouts differ:
    eufs_sim is 3 m wide from cone to cone, AMZ's fssim 3.8 m. Where big orange cones stand, 0.3 m before and
    behind both lines, is AMZ's.
    """

    NAME: ClassVar[str] = "fs_acceleration"
    TITLE: ClassVar[str] = "Formula Student acceleration"
    STANDARD: ClassVar[str] = "Formula Student Rules, D 5.1"

    length: float = dimension(75, "From the starting line to the finish line", least=1)
    width: float = dimension(3, "Clear width of the track", least=0.1)
    spacing: float = dimension(5, "From cone to cone along the track", least=0.5)
    exit_length: float = dimension(100, "Lane to stop in behind the finish line", least=0.5)
    line_distance: float = dimension(0.3, "From a line to the big cones before and behind it")
    end_cones: float = dimension(1, "Cones that close the end of the lane", "", whole=True)

    def cone_counts(self) -> dict[str, float]:
        return {
            "length": pairs(self.length, self.spacing),
            "exit_length": pairs(self.exit_length, self.spacing),
            "end_cones": self.end_cones,
        }

    def spots(self) -> list[Spot]:
        right, base = -self.width / 2, self.cone_base

        def timing(x: float, role: str) -> list[Spot]:
            places = [x - self.line_distance, x + self.line_distance]
            return lane(places, right, self.width, base, role, (BIG_ORANGE, BIG_ORANGE))

        track = spaced(0.0, self.length, self.spacing)[1:-1]
        out = spaced(self.length, self.exit_length, self.spacing)[1:]
        return [
            *timing(0.0, "start"),
            *lane(track, right, self.width, base, "track", (BLUE, YELLOW)),
            *timing(self.length, "finish"),
            *lane(out, right, self.width, base, "exit"),
            *across(out[-1], right, self.width, int(self.end_cones), "end"),
        ]


# --- A corridor of cones of any length, straight in its own frame; along a line it follows the line ---


@dataclass(frozen=True)
class Corridor(Layout):
    """Pairs of cones, blue left and yellow right. The origin is the middle of the first pair.

    Colours, 3 m of width and 5 m from pair to pair are those of Formula Student's acceleration.
    """

    NAME: ClassVar[str] = "corridor"
    TITLE: ClassVar[str] = "Corridor"
    STANDARD: ClassVar[str] = "no standard: colours, width and spacing of Formula Student"

    length: float = dimension(50, "Length of the corridor", least=0.1)
    width: float = dimension(3, "Clear width of the corridor", least=0.1)
    spacing: float = dimension(5, "From pair to pair", least=0.5)

    def cone_counts(self) -> dict[str, float]:
        return {"length": pairs(self.length, self.spacing)}

    def spots(self) -> list[Spot]:
        places = spaced(0.0, self.length, self.spacing)
        return lane(places, -self.width / 2, self.width, self.cone_base, "", (BLUE, YELLOW))


# --- Every layout by its name ---

LAYOUTS: dict[str, type[Layout]] = {
    kind.NAME: kind
    for kind in (
        Slalom,
        DoubleLaneChange,
        ObstacleAvoidance,
        ConstantRadius,
        SkidPad,
        Acceleration,
        BrakingLane,
        Corridor,
    )
}
