"""Whether a window takes longer in a larger city: cities that are made up, each measured by itself."""

from __future__ import annotations

import numpy as np

from benchmarks.clock import each, in_a_process, megabytes, once, spread, table
from benchmarks.trial import size
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.core.robotmap.window_index import OutlineIndex

PITCH, SIDE = 20.0, 100.0
RUNS = size(5, 2)
SIZES = size((10_000, 100_000, 1_000_000), (1_000, 10_000))


def city(count: int) -> Outlines:
    """Return ``count`` turned square buildings, PITCH apart."""
    side = int(np.ceil(np.sqrt(count)))
    chance = np.random.default_rng(3)
    number = np.arange(count)
    centres = PITCH * np.column_stack([number % side, number // side]) + chance.uniform(-1, 1, (count, 2))
    angles = chance.uniform(0, np.pi / 2, (count, 1)) + np.pi / 2 * np.array([0, 1, 2, 3, 0])
    reach = chance.uniform(4, 9, (count, 1))
    points = centres[:, None] + np.stack([reach * np.cos(angles), reach * np.sin(angles)], axis=2)
    return Outlines(
        coordinates=points.reshape(-1, 2),
        offsets=np.arange(count + 1) * 5,
        shape_type=np.full(count, int(ShapeType.CLOSED_POLYGON), dtype=np.int8),
        courtyard=np.zeros(count, dtype=bool),
        height=chance.uniform(3, 30, count).round(2),
        outdoor=np.ones(count, dtype=bool),
        semantics=["building"] * count,
        source=[f"buildings:{k}" for k in range(count)],
    )


def measure(count: int) -> list[str]:
    """Return one line of the table."""
    outlines = city(count)
    before = megabytes()
    index, first = once(lambda: OutlineIndex.of(outlines))
    memory = megabytes() - before
    indexing = spread([first, *(once(lambda: OutlineIndex.of(outlines))[1] for _ in range(RUNS - 1))])
    side = PITCH * np.sqrt(count)
    places = np.random.default_rng(5).uniform(SIDE, side - SIDE, (300, 2)).tolist()
    windows = [Window(x, y, SIDE, SIDE) for x, y in places]
    extraction = each(lambda w: index.segments_in(w.border), windows)
    complete = each(lambda w: encode(index.map_of(w)), windows)
    return [
        f"{count:,}".replace(",", " "),
        str(extraction),
        str(complete),
        f"{indexing:.2f}",
        f"{memory:.0f}",
    ]


def growth_table() -> str:
    """Return the table of all sizes."""
    code = "import json; from benchmarks.growth import measure; print(json.dumps(measure({})))"
    lines = [in_a_process(code.format(count)) for count in SIZES]
    return table(("obstacles", "extraction, ms", "complete GetMap, ms", "indexing, s", "index, MB"), lines)
