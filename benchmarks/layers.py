"""Real layers as outlines, read without QGIS."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio
import shapely

from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow

Place = Callable[[np.ndarray], np.ndarray]


def features(file: Path, layer: str, columns: tuple[str, ...] = ()) -> Iterator[tuple[str, Any, tuple]]:
    """Yield source, shapely geometry and the values of ``columns`` for each feature that shapely can hold."""
    meta, ids, wkb, columns_read = pyogrio.raw.read(file, layer, columns=list(columns), return_fids=True)
    # They come in the order of the file.
    named = dict(zip(meta["fields"], columns_read, strict=True))
    values = [named[name] for name in columns]
    # Some rings in the data have two points, which shapely has no geometry for.
    geometries = shapely.from_wkb(wkb, on_invalid="ignore")
    for k, (fid, geometry) in enumerate(zip(ids, geometries, strict=True)):
        if geometry is not None and not geometry.is_empty:
            yield f"{layer}:{fid}", geometry, tuple(column[k] for column in values)


def rows(geometry: Any, source: str, height: float = 3.0, place: Place = lambda p: p) -> list[OutlineRow]:
    """Return the outlines of one feature; its label is the layer's name, ``place`` moves its points."""
    label = source.partition(":")[0]
    made = []
    for part in shapely.get_parts(geometry):
        polygon = part.geom_type == "Polygon"
        for k, line in enumerate([part.exterior, *part.interiors] if polygon else [part]):
            kind = ShapeType.CLOSED_POLYGON if polygon else ShapeType.OPEN_POLYGON
            points = place(shapely.get_coordinates(line))
            made.append(OutlineRow(points, kind, height, label, source, courtyard=k > 0))
    return made


def moved(origin: tuple[float, float]) -> Place:
    """Return what takes points into a frame with this origin."""
    return lambda points: points - np.array(origin)
