"""Layouts on circles: the constant-radius circle and the skid pad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .cone import BIG_ORANGE, BLUE, ORANGE, YELLOW, Spot
from .errors import DimensionError
from .layout import Layout, dimension
from .rows import across, lane, spaced

LEFT, RIGHT = 1, -1


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
        LEFT, "Which way it is driven", "", least=-1, choices={LEFT: "to the left", RIGHT: "to the right"}
    )

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
            *self._circle(RIGHT, (BLUE, YELLOW)),
            *self._circle(LEFT, (YELLOW, BLUE)),
            *lane(out, right, self.path_width, base, "exit"),
            *across(out[-1], right, self.path_width, int(self.end_cones), "end"),
        ]

    def _circle(self, turn: int, colours: tuple[str, str]) -> list[Spot]:
        """Return the cones of the circle driven by ``turn``; ``colours`` are those outside and inside."""
        y, away = turn * self.centres / 2, turn * math.pi / 2
        inside = away + math.pi + np.arange(int(self.inner_count)) * 2 * math.pi / self.inner_count * turn
        half = math.radians(self.outer_span) / 2
        outside = away + np.linspace(-half, half, int(self.outer_count)) * turn
        side = "left" if turn == LEFT else "right"
        near, far = self.inner / 2 - self.cone_base / 2, self.outer / 2 + self.cone_base / 2
        return [
            *(_at(0.0, y, near, float(angle), turn, colours[1], f"{side} inner") for angle in inside),
            *(_at(0.0, y, far, float(angle), turn, colours[0], f"{side} outer") for angle in outside),
        ]


def _at(x: float, y: float, radius: float, angle: float, turn: int, colour: str, role: str) -> Spot:
    """Return the spot on a circle; one drives past it as ``turn`` says."""
    theta = math.remainder(angle + turn * math.pi / 2, 2 * math.pi)
    return Spot(x + radius * math.cos(angle), y + radius * math.sin(angle), theta, colour, role)
