"""Texts for cone layouts and cone plans in the operator's language."""

from __future__ import annotations

from ..robot_bridge.core.assignment.job import COLLECT, PLACE, STAY, TO_START, TO_STORE
from ..robot_bridge.core.assignment.schedules import BALANCED, LEAST_DISTANCE
from ..robot_bridge.core.assignment.solver import AUTOMATIC, PREVIEW, PREVIEW_KEPT, PYVRP
from ..robot_bridge.core.layouts.layout import Dimension, DimensionFault, Layout
from .ui.language import tr

LAYOUT_TITLES = {
    "slalom": tr("Slalom"),
    "iso3888_1": tr("Double lane change"),
    "iso3888_2": tr("Obstacle avoidance"),
    "circle": tr("Constant-radius circle"),
    "fs_skidpad": tr("Formula Student skid pad"),
    "fs_acceleration": tr("Formula Student acceleration"),
    "braking_lane": tr("Braking lane"),
    "corridor": tr("Corridor"),
}
LAYOUT_STANDARDS = {
    "slalom": tr("no standard: 18 m as European testers drive it"),
    "circle": tr("ISO 4138:2021, method 1"),
    "fs_skidpad": tr("Formula Student Rules, D 4.1"),
    "fs_acceleration": tr("Formula Student Rules, D 5.1"),
    "braking_lane": tr("length after UN R13-H; test after ISO 21994"),
    "corridor": tr("no standard: colours, width and spacing of Formula Student"),
}
"""Names of layouts whose standard has words in its name."""
LAYOUT_DIMENSIONS = {
    "cone_base": tr("Across the base of a cone; the cones touch the track's limits"),
    "count": tr("Cones to go round"),
    "slalom.spacing": tr("From cone to cone"),
    "gate_distance": tr("From a gate to the nearest cone"),
    "gate_width": tr("Clear width of the gates"),
    "vehicle_width": tr("Width of the vehicle without mirrors"),
    "cones_per_row": tr("Cones on each side of each lane"),
    "exit_side": tr("What of the exit lane is in line with the entry lane"),
    "turn": tr("To which side it goes first"),
    "entry_length": tr("Section 1: entry lane"),
    "out_length": tr("Section 2: way to the side lane"),
    "side_length": tr("Section 3: side lane"),
    "back_length": tr("Section 4: way back"),
    "iso3888_1.exit_length": tr("Sections 5 and 6: exit lane"),
    "iso3888_2.exit_length": tr("Section 5: exit lane"),
    "entry_factor": tr("Vehicle widths in the width of the entry lane"),
    "side_factor": tr("Vehicle widths in the width of the side lane"),
    "exit_factor": tr("Vehicle widths in the width of the exit lane"),
    "margin": tr("What is added to each of these widths"),
    "iso3888_1.lane_offset": tr("From the right limit of the entry lane to that of the side lane"),
    "iso3888_2.lane_offset": tr("From the left limit of the entry lane to the right one of the side lane"),
    "entry_margin": tr("What is added to the width of the entry lane"),
    "side_margin": tr("What is added to the width of the side lane"),
    "exit_margin": tr("What is added to the width of the exit lane"),
    "exit_least": tr("Least width of the exit lane"),
    "radius": tr("Radius of the middle of the lane"),
    "circle.spacing": tr("From cone to cone along the middle of the lane"),
    "circle.turn": tr("Which way it is driven"),
    "width": tr("Clear width of the lane"),
    "fs_skidpad.entry_length": tr("Length of the way in that has cones"),
    "fs_skidpad.exit_length": tr("Length of the way out that has cones"),
    "centres": tr("From centre to centre of the circles"),
    "inner": tr("Diameter of the inner circles"),
    "outer": tr("Diameter of the outer circles"),
    "inner_count": tr("Cones inside each inner circle"),
    "outer_count": tr("Cones outside each outer circle"),
    "outer_span": tr("Part of each outer circle that has cones"),
    "path_width": tr("Clear width of the ways in and out"),
    "gate_start": tr("From the meeting point to the first cones of the ways in and out"),
    "gate_spacing": tr("From cone to cone along the ways in and out"),
    "fs_skidpad.end_cones": tr("Cones that close the way out"),
    "timing_along": tr("From the timing line to the big cones before and behind it"),
    "timing_across": tr("From the middle of the path to these cones"),
    "fs_acceleration.length": tr("From the starting line to the finish line"),
    "fs_acceleration.width": tr("Clear width of the track"),
    "fs_acceleration.spacing": tr("From cone to cone along the track"),
    "fs_acceleration.exit_length": tr("Lane to stop in behind the finish line"),
    "fs_acceleration.end_cones": tr("Cones that close the end of the lane"),
    "line_distance": tr("From a line to the big cones before and behind it"),
    "speed": tr("Speed at which braking begins"),
    "approach": tr("Lane before braking begins"),
    "braking_lane.spacing": tr("From cone to cone along the lane"),
    "corridor.length": tr("Length of the corridor"),
    "corridor.width": tr("Clear width of the corridor"),
    "corridor.spacing": tr("From pair to pair"),
}
"""By the dimension's name, or by layout and name where layouts give it different meanings."""

DIMENSION_CHOICES = {
    "left": tr("left"),
    "right": tr("right"),
    "to the left": tr("to the left"),
    "to the right": tr("to the right"),
    "left limit": tr("left limit"),
    "middle": tr("middle"),
    "right limit": tr("right limit"),
}
"""The meaning of the choices of dimensions, by the bridge's words."""


def standard_in_words(layout: type[Layout]) -> str:
    """Return the standard that ``layout`` follows."""
    return LAYOUT_STANDARDS.get(layout.NAME, layout.STANDARD)


def layout_in_words(layout: type[Layout]) -> str:
    """Return the name of ``layout``, and the standard that it follows."""
    return f"{LAYOUT_TITLES[layout.NAME]} ({standard_in_words(layout)})"


def dimension_in_words(layout: type[Layout], dimension: Dimension) -> str:
    """Return the description of a dimension of ``layout``."""
    own = f"{layout.NAME}.{dimension.name}"
    return LAYOUT_DIMENSIONS[own] if own in LAYOUT_DIMENSIONS else LAYOUT_DIMENSIONS[dimension.name]


def whole_dimension_in_words(layout: type[Layout], dimension: Dimension) -> str:
    """Return the description of a dimension, with the number of each choice, where numbers are entered."""
    words = dimension_in_words(layout, dimension)
    meanings = ", ".join(
        f"{choice:g} {DIMENSION_CHOICES[name]}" for choice, name in dimension.choices.items()
    )
    return f"{words}: {meanings}" if meanings else words


def fault_in_words(dimension: Dimension, fault: DimensionFault) -> str:
    """Return the valid values in place of one that has ``fault``."""
    if fault is DimensionFault.NOT_CHOSEN:
        return tr("give one of {choices}", choices=dimension.choices_text)
    if fault is DimensionFault.TOO_SMALL:
        return tr("give {least:g} or more", least=dimension.least)
    return tr("give a whole number") if fault is DimensionFault.NOT_WHOLE else tr("give a number")


TASKS = {PLACE: tr("place them"), COLLECT: tr("collect them")}
FINISHES = {STAY: tr("stay where they are"), TO_STORE: tr("drive to a store"), TO_START: tr("drive back")}
OBJECTIVES = {BALANCED: tr("done as early as possible"), LEAST_DISTANCE: tr("fewest metres")}
METHODS = {
    AUTOMATIC: tr("the best that is installed"),
    PYVRP: "PyVRP",
    PREVIEW: tr("the preview: quick, not the best"),
}
RESULT_QUALITY = {
    PREVIEW: tr("quick preview"),
    PYVRP: tr("solved"),
    PREVIEW_KEPT: tr("solved: nothing better than the preview was found"),
}
"""The quality of a plan, by the method that found it."""
