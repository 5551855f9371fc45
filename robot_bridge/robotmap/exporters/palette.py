"""Which colour an obstacle has in a picture, by what its label says it is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ..model import Obstacle, ShapeType
from .solids import first_label

FACE, GRID_LINE, INK, QUIET = "#f5f2ec", "#ffffff", "#2f2a26", "#847c74"


class Colours(NamedTuple):
    """The fill of an area and the stroke of its walls, ``#rrggbb``."""

    fill: str
    stroke: str


STAIRS = Colours("#ecbfa3", "#96512c")
RAMP = Colours("#d3e3ec", "#4f7b96")
_KNOWN = (
    (("building", "house", "hall", "roof", "garage"), Colours("#dcc7aa", "#6b563f")),
    (("wall", "fence", "barrier", "railing", "kerb"), Colours("#a49c91", "#47423d")),
    (("column", "pillar", "pier"), Colours("#c0b0d4", "#5b4a78")),
    (("bin", "waste"), Colours("#9fcdbb", "#2a6a56")),
    (("bench", "planter", "furniture", "rack", "table"), Colours("#cbd8a6", "#5a6d31")),
    (("lamp", "post", "bollard", "pole", "mast"), Colours("#f1d283", "#846510")),
    (("tree", "hedge", "plant", "wood"), Colours("#aed299", "#3b6a29")),
    (("stair", "step"), STAIRS),
)
_OTHERS = (
    Colours("#b5cbe3", "#33557c"),
    Colours("#e6b8c2", "#8a3a4d"),
    Colours("#c9d9d2", "#43665a"),
    Colours("#e3d4ee", "#6d4a86"),
    Colours("#efd9b4", "#8b6424"),
    Colours("#cfcfd8", "#52525f"),
)


def colours_of_labels(obstacles: Iterable[Obstacle]) -> dict[str, Colours]:
    """Return the colours of every first label, commonest first; the same labels always get the same ones."""
    counts: dict[str, int] = {}
    for obstacle in obstacles:
        counts[first_label(obstacle)] = counts.get(first_label(obstacle), 0) + 1
    others = [label for label in sorted(counts) if _known(label) is None]
    colours = {label: _OTHERS[k % len(_OTHERS)] for k, label in enumerate(others)}
    order = sorted(counts, key=lambda label: (-counts[label], label))
    return {label: _known(label) or colours[label] for label in order}


def colours_of(shape_type: int, semantics: str, by_label: Mapping[str, Colours]) -> Colours:
    """Return the colours of an obstacle: what stairs and ramps are is said by their shape type."""
    if shape_type == ShapeType.STAIRS:
        return STAIRS
    if shape_type == ShapeType.RAMP:
        return RAMP
    return by_label[semantics.partition(",")[0]]


def deepened(colour: str, height: float) -> str:
    """Return a fill that is darker for what is higher, up to 30 m."""
    keep = 1.0 - 0.30 * min(max(height, 0.0), 30.0) / 30.0
    return "#" + "".join(f"{round(int(colour[k : k + 2], 16) * keep):02x}" for k in (1, 3, 5))


def _known(label: str) -> Colours | None:
    text = label.lower()
    return next((colours for words, colours in _KNOWN if any(word in text for word in words)), None)
