"""Layouts along a straight line: slalom, braking lane, acceleration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .cone import BIG_ORANGE, BLUE, ORANGE, YELLOW, Spot
from .layout import Layout, dimension
from .rows import across, lane, spaced


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

    def spots(self) -> list[Spot]:
        right, base = -self.width / 2, self.cone_base
        stop = 0.1 * self.speed + 0.006 * self.speed**2
        before = spaced(0.0, self.approach, self.spacing)[:-1] if self.approach else []
        after = spaced(self.approach, stop, self.spacing)[1:]
        return [
            *lane(before, right, self.width, base, "approach"),
            *lane([self.approach], right, self.width, base, "braking", (BIG_ORANGE, BIG_ORANGE)),
            *lane(after, right, self.width, base, "stopping"),
        ]


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
