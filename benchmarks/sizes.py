"""How large maps are: the campus in the paper's window, and a quarter of a city."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyogrio
import pyproj
import shapely

from benchmarks.clock import table
from benchmarks.layers import features, rows
from robot_bridge.core.robotmap.binary import decode_text, encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import RobotMap, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.shaping import Shaping, shaped
from robot_bridge.core.robotmap.text_format import write_text

WINDOW = Window(48, 48, 104, 104)
PLANE = (0.3, 1.0)
"""metres above the ground: what a knee-high robot of 1 m cannot drive under or over."""
PAPER = 3
"""bytes/m² that the paper gives for its text."""
NO_FURNITURE = ("buildings", "walls")
LOSSLESS = Shaping(plane=PLANE, dissolve=True, chain=True)
FEWER_CORNERS = replace(LOSSLESS, tolerance=0.05, shortest=0.1, height_step=0.5)
PROFILES = (
    ("every face an obstacle, as exported without options", Shaping(), None),
    ("faces chained, walls in and along buildings dissolved", Shaping(dissolve=True, chain=True), None),
    (f"the same, only what the robot's plane from {PLANE[0]:g} m to {PLANE[1]:g} m meets", LOSSLESS, None),
    (
        f"the same, simplified by {100 * FEWER_CORNERS.tolerance:g} cm, corners nearer than "
        f"{100 * FEWER_CORNERS.shortest:g} cm joined, heights in steps of {FEWER_CORNERS.height_step:g} m",
        FEWER_CORNERS,
        None,
    ),
    ("the plane, dissolved and chained, without furniture", LOSSLESS, NO_FURNITURE),
    ("the same, simplified", FEWER_CORNERS, NO_FURNITURE),
)


def campus(file: Path) -> list[OutlineRow]:
    """Return the campus with each thing's base above the ground beside it."""
    _, _, wkb, (ground,) = pyogrio.raw.read(file, "ground_surfaces", columns=["z_mean"])
    surfaces = shapely.STRtree(shapely.from_wkb(wkb))
    made = []
    for layer, low in (("buildings", None), ("walls", "z_min"), ("furniture", "z_min")):
        for source, shape, (height, *lowest) in features(
            file, layer, ("height", low) if low else ("height",)
        ):
            # Buildings are modelled down to the lowest ground around them.
            level = ground[surfaces.nearest(shapely.centroid(shape))]
            base = float(lowest[0] - level) if lowest else 0.0
            made += [replace(row, base=base) for row in rows(shape, source, float(height))]
    return made


def campus_table(file: Path) -> str:
    """Return the sizes of the campus in the paper's window, in bytes/m²."""
    everything = campus(file)
    lines = []
    for name, shaping, kept in PROFILES:
        some = [row for row in everything if kept is None or row.semantics in kept]
        robot_map = build_map(shaped(Outlines.from_rows(some), shaping), WINDOW)
        lines.append((name, len(robot_map.obstacles), robot_map.segment_count, *_densities(robot_map)))
    formats = ("text", "text, strict", "codec 1, strict", "codec 2", "codec 2, strict")
    return table(
        (f"campus, {WINDOW.width:g} m × {WINDOW.height:g} m", "obstacles", "segments", *formats), lines
    )


def _densities(robot_map: RobotMap) -> list[str]:
    area, strict = robot_map.border.area, write_text(robot_map, strict=True)
    sizes = (
        len(write_text(robot_map)),
        len(strict),
        len(encode(strict)),
        len(encode(robot_map, codec=2)),
        len(encode(strict, codec=2)),
    )
    return [f"{size / area:.3f}" if size < area else f"{size / area:.2f}" for size in sizes]


def quarter_table(file: Path) -> str:
    """Return the sizes of the quarter's buildings in UTM, in bytes for each segment."""
    to_utm = pyproj.Transformer.from_crs(3857, 32633, always_xy=True)

    def place(points: np.ndarray) -> np.ndarray:
        return np.column_stack(to_utm.transform(*points.T))

    outlines = [
        row for source, shape, _ in features(file, "buildings") for row in rows(shape, source, 3.0, place)
    ]
    robot_map = build_map(Outlines.from_rows(outlines))
    text, segments = write_text(robot_map), robot_map.segment_count
    lines = []
    for name, content in (
        ("text", text.encode()),
        ("codec 1", encode(robot_map)),
        ("codec 2", encode(robot_map, codec=2)),
    ):
        if name.startswith("codec"):
            assert decode_text(content) == text
        lines.append((name, len(content), f"{len(content) / segments:.2f}"))
    return table(
        (f"bubenec, {len(robot_map.obstacles)} obstacles, {segments} segments", "bytes", "bytes/segment"),
        lines,
    )
