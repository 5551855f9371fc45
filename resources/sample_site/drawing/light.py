"""One sun for the whole picture: it stands in the south-east, so shadows fall to the north-west."""

from __future__ import annotations

import numpy as np
import shapely

SHADOW_PER_METRE = np.array([-0.40, 0.52])
"""Where the shadow of a point one metre up falls, in metres."""
SHADE = (0.42, 0.46, 0.55)
"""What is left of red, green and blue in full shade: the sky still lights it."""
SUN = np.array([0.52, -0.62, 0.78]) / np.linalg.norm([0.52, -0.62, 0.78])
"""Unit vector to the sun as (east, north, up)."""


def shadow(geometry: shapely.Geometry, height: float) -> shapely.Geometry:
    """Return the ground that an upright body with the outline ``geometry`` shades, its own base included."""
    reach = SHADOW_PER_METRE * height
    pieces = []
    for part in shapely.get_parts(geometry):
        lines = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
        for line in lines:
            xy = np.array(line.coords)[:, :2]
            quads = np.stack([xy[:-1], xy[1:], xy[1:] + reach, xy[:-1] + reach], axis=1)
            pieces += [shapely.MultiPoint(quad).convex_hull for quad in quads]
        if part.geom_type == "Polygon":
            pieces += [part, shapely.affinity.translate(part, *reach)]
    return shapely.unary_union([piece for piece in pieces if piece.geom_type == "Polygon"])
