"""Roads as strips of their widths."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..centrelines import Centrelines, Floats, Ints

MITRE_LIMIT = 2.0
"""A corner reaches no further from its centre than twice half the width; a sharper one is cut off."""


def strips_of(roads: Centrelines, numbers: Ints) -> Any:
    """Return the polygon of each of the roads ``numbers``, an array of shapely's."""
    import shapely

    taken = roads.taken(numbers)
    if not len(taken):
        return np.empty(0, dtype=object)
    lines = shapely.linestrings(taken.xy, indices=np.repeat(np.arange(len(taken)), taken.counts()))
    return widened(lines, taken.width)


def widened(lines: Any, width: Floats) -> Any:
    """Return ``lines``, an array of shapely's, as strips with square ends and mitred corners."""
    import shapely

    return shapely.buffer(lines, width / 2, cap_style="flat", join_style="mitre", mitre_limit=MITRE_LIMIT)
