"""Layers of ``site.gpkg``: obstacles, centrelines, surfaces and keepouts as features, and back."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import LayerError
from ..roads.network import DRAWN, GENERATED, Surface
from ..robotmap.model import ShapeType
from ..robotmap.outlines import OutlineRow, Outlines, is_closed
from . import geopackage
from .frame import Points, SiteFrame

# --- Obstacle outlines as features of the layer ``obstacles``, and back ---

_RINGS = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)


def obstacle_layer(outlines: Outlines, frame: SiteFrame) -> geopackage.Layer:
    """Return ``outlines`` as features in the site CRS.

    A courtyard becomes a hole of the ring before it; a flight of stairs one multi line string of risers.

    :raises LayerError: naming the source of an outline that should be a ring and is not, or whose risers are
        not pairs of points.
    """
    geometries: list[Any] = []
    columns: dict[str, list[Any]] = {name: [] for name in geopackage.OBSTACLES.fields}
    for first, last in outline_groups(outlines):
        geometries.append(_geometry(outlines, first, last, frame))
        for name, value in obstacle_values(outlines.row(first)).items():
            columns[name].append(value)
    return geopackage.layer_of(geopackage.OBSTACLES, geometries, columns)


def obstacle_values(row: OutlineRow) -> dict[str, Any]:
    """Return the fields of the published feature of ``row``."""
    return {
        "source": row.source,
        "semantics": row.semantics,
        "height_m": row.height,
        "outdoor": row.outdoor,
        "shape_type": int(row.shape_type),
        "base_m": row.base,
        "ext": geopackage.extras_text(row.ext),
    }


def outlines_of(layer: geopackage.Layer, frame: SiteFrame, place: str) -> Outlines:
    """Return the outlines in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming the feature whose geometry, shape type or extras are not those of an obstacle.
    """
    rows: list[OutlineRow] = []
    # A large city has few different extras: each is read and kept once.
    known: dict[str | None, dict[str, str]] = {}
    for k in range(len(layer)):
        shape_type = int(layer.values["shape_type"][k])
        where = f"{place}, layer {geopackage.OBSTACLES.name}, feature {layer.ids[k]}"
        if shape_type not in {int(member) for member in ShapeType}:
            raise LayerError(f"{where}: shape_type is {shape_type}; write 1 to 6 (paper 1, section II).")
        text = layer.values["ext"][k]
        if text not in known:
            known[text] = geopackage.extras_of(text, where)
        for points, courtyard in _lines(layer.geometries[k], ShapeType(shape_type), where):
            rows.append(
                OutlineRow(
                    points=frame.to_site(points),
                    shape_type=ShapeType(shape_type),
                    height=float(layer.values["height_m"][k]),
                    semantics=layer.values["semantics"][k] or "",
                    source=layer.values["source"][k] or "",
                    courtyard=courtyard,
                    outdoor=bool(layer.values["outdoor"][k]),
                    base=float(layer.values["base_m"][k]),
                    ext=known[text],
                )
            )
    return Outlines.from_rows(rows)


def outline_groups(outlines: Outlines) -> Iterator[tuple[int, int]]:
    """Yield (first, last + 1) of each outline with the courtyards that follow it."""
    first, last = group_spans(outlines).T.tolist()
    yield from zip(first, last, strict=True)


def group_spans(outlines: Outlines) -> NDArray[np.int64]:
    """Return the groups of :func:`outline_groups` as an array, (n, 2)."""
    first = np.flatnonzero(~_joined(outlines))
    return np.column_stack([first, np.append(first[1:], len(outlines))[: len(first)]])


def row_spans(outlines: Outlines, obstacles: int) -> Iterator[tuple[int, int]]:
    """Yield (first, last + 1) of ``obstacles`` obstacles at a time, each with its courtyards."""
    first = np.flatnonzero(~_joined(outlines))[::obstacles].tolist()
    yield from pairwise([*first, len(outlines)])


def as_read_back(outlines: Outlines, frame: SiteFrame) -> Outlines | None:
    """Return ``outlines`` as :func:`outlines_of` reads them from their own layer.

    None if a ring does not close or a number is not finite, as only the layer shows the result then.
    """
    joined, closed = _joined(outlines), is_closed(outlines.shape_type)
    group = np.cumsum(~joined) - 1
    of = np.flatnonzero(~joined)[group] if len(outlines) else group
    # Only rings have holes.
    kept = np.flatnonzero(~joined | closed[of])
    lengths = np.diff(outlines.offsets)[kept]
    if not (np.isfinite(outlines.coordinates).all() and np.isfinite(outlines.height).all() and lengths.all()):
        return None
    offsets = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
    point = np.repeat(outlines.offsets[kept] - offsets[:-1], lengths) + np.arange(offsets[-1])
    coordinates = frame.to_site(frame.to_crs(outlines.coordinates[point]))
    first, last = offsets[:-1][closed[of[kept]]], offsets[1:][closed[of[kept]]] - 1
    if not np.array_equal(outlines.coordinates[point[first]], outlines.coordinates[point[last]]):
        return None
    coordinates[last] = coordinates[first]
    rows = of[kept].tolist()
    based = outlines.base is not None and bool(outlines.base[of[kept]].any())
    extras = None if outlines.ext is None else [outlines.ext[k] for k in rows]
    return Outlines(
        coordinates=coordinates,
        offsets=offsets,
        shape_type=outlines.shape_type[of[kept]].astype(np.int8),
        courtyard=joined[kept],
        height=outlines.height[of[kept]].astype(np.float64),
        outdoor=outlines.outdoor[of[kept]].astype(bool),
        semantics=[outlines.semantics[k] for k in rows],
        source=[outlines.source[k] for k in rows],
        base=outlines.base[of[kept]].astype(np.float64) if outlines.base is not None and based else None,
        ext=extras if extras is not None and any(extras) else None,
    )


def _joined(outlines: Outlines) -> NDArray[np.bool_]:
    """Return a mask of the outlines that are holes of the one before them, (K,) bool."""
    joined = np.zeros(len(outlines), dtype=bool)
    for k in np.flatnonzero(outlines.courtyard).tolist():
        joined[k] = k > 0 and outlines.source[k] == outlines.source[k - 1]
    return joined


def _geometry(outlines: Outlines, first: int, last: int, frame: SiteFrame) -> Any:
    import shapely

    rings = [frame.to_crs(_points(outlines, k)) for k in range(first, last)]
    shape_type, source = ShapeType(int(outlines.shape_type[first])), outlines.source[first]
    try:
        if not all(np.isfinite(ring).all() for ring in rings):
            raise ValueError("it has a coordinate that is NaN or infinite")
        if shape_type is ShapeType.STAIRS:
            return shapely.MultiLineString(list(rings[0].reshape(-1, 2, 2)))
        if shape_type in _RINGS:
            return shapely.Polygon(rings[0], rings[1:])
        return shapely.LineString(rings[0])
    except (ValueError, shapely.errors.GEOSException) as error:
        raise LayerError(
            f"The obstacle {source} cannot be published as {shape_type.name.lower()}: {error}. "
            "Correct its geometry in the source layer."
        ) from error


def _points(outlines: Outlines, k: int) -> Points:
    points: Points = outlines.coordinates[outlines.offsets[k] : outlines.offsets[k + 1]]
    return points


def _lines(geometry: Any, shape_type: ShapeType, where: str) -> Iterator[tuple[Points, bool]]:
    """Yield each ring or line of ``geometry`` as (points, courtyard)."""
    if shape_type is ShapeType.STAIRS and geometry.geom_type in ("LineString", "MultiLineString"):
        yield _risers(geometry, where), False
    elif geometry.geom_type in ("Polygon", "MultiPolygon"):
        for polygon in _parts(geometry):
            yield np.asarray(polygon.exterior.coords)[:, :2], False
            for hole in polygon.interiors:
                yield np.asarray(hole.coords)[:, :2], True
    elif geometry.geom_type in ("LineString", "MultiLineString"):
        for line in _parts(geometry):
            yield np.asarray(line.coords)[:, :2], False
    else:
        raise LayerError(
            f"{where}: a {geometry.geom_type} cannot be an obstacle. Use lines or polygons in the source "
            "layer and publish the site again."
        )


def _risers(geometry: Any, where: str) -> Points:
    risers = [np.asarray(line.coords)[:, :2] for line in _parts(geometry)]
    if any(len(riser) != 2 for riser in risers):
        raise LayerError(f"{where}: a riser of these stairs has more than two points. Draw one line a riser.")
    return np.concatenate(risers)


def _parts(geometry: Any) -> Any:
    return getattr(geometry, "geoms", [geometry])


# --- Centrelines, road surfaces and keepouts as features of their layers, and back ---


def centreline_layer(centrelines: Sequence[geopackage.Centreline], frame: SiteFrame) -> geopackage.Layer:
    """Return ``centrelines`` as line strings in the site CRS.

    :raises LayerError: naming the first centreline with fewer than two points.
    """
    import shapely

    for k, line in enumerate(centrelines, start=1):
        if len(line.points) < 2:
            raise LayerError(f"Centreline {k} has {len(line.points)} point(s): a road needs two or more.")
    return geopackage.layer_of(
        geopackage.CENTRELINES,
        [shapely.LineString(frame.to_crs(line.points)) for line in centrelines],
        {
            "width_m": [line.width_m for line in centrelines],
            "surface": [line.surface for line in centrelines],
            "direction": [line.direction for line in centrelines],
            "speed_ms": [line.speed_ms for line in centrelines],
            "closed": [line.closed for line in centrelines],
            "level": [line.level for line in centrelines],
        },
    )


def centrelines_of(
    layer: geopackage.Layer, frame: SiteFrame, place: str
) -> tuple[geopackage.Centreline, ...]:
    """Return the centrelines in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming a road whose width is not above 0 or that is not a line.
    """
    _require(layer, "LineString", place)
    for name, rule in (("width_m", "a road is wider than 0 m"), ("speed_ms", "a speed is above 0 m/s")):
        numbers = np.asarray(layer.values[name], dtype=np.float64)
        if (numbers <= 0).any():
            k = int(np.argmax(numbers <= 0))
            raise LayerError(
                f"{place}, layer {layer.spec.name}, feature {layer.ids[k]}: {name} is {numbers[k]:g}; "
                f"{rule}. Correct it in the source layer and publish the site again."
            )
    columns = [layer.values[name] for name in layer.spec.fields]
    return tuple(
        geopackage.Centreline(
            frame.to_site(np.asarray(geometry.coords)[:, :2]),
            width_m=float(width),
            surface=surface or "",
            direction=int(np.sign(direction)),
            speed_ms=float(speed),
            closed=bool(closed),
            level=int(level),
        )
        for geometry, width, surface, direction, speed, closed, level in zip(
            layer.geometries, *columns, strict=True
        )
    )


def area_layer(
    spec: geopackage.LayerSpec, areas: Sequence[geopackage.Area], frame: SiteFrame
) -> geopackage.Layer:
    """Return ``areas`` as polygons in the site CRS, each label in the one field of ``spec``."""
    (label,) = spec.fields
    polygons = [_polygon(area.rings, frame) for area in areas]
    return geopackage.layer_of(spec, polygons, {label: [area.label for area in areas]})


def areas_of(layer: geopackage.Layer, frame: SiteFrame, place: str) -> tuple[geopackage.Area, ...]:
    """Return the polygons in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming a feature that is not a polygon.
    """
    _require(layer, "Polygon", place)
    (label,) = layer.spec.fields
    return tuple(
        geopackage.Area(tuple(frame.to_site(ring) for ring in _rings(geometry)), text or "")
        for geometry, text in zip(layer.geometries, layer.values[label], strict=True)
    )


def surface_layer(surfaces: Sequence[Surface], frame: SiteFrame) -> geopackage.Layer:
    """Return ``surfaces`` as polygons in the site CRS."""
    return geopackage.layer_of(
        geopackage.SURFACES,
        [_polygon(one.rings, frame) for one in surfaces],
        {
            "surface": [one.label for one in surfaces],
            "name": [one.name for one in surfaces],
            "origin": [one.origin for one in surfaces],
        },
    )


def surfaces_of(layer: geopackage.Layer, frame: SiteFrame, place: str) -> tuple[Surface, ...]:
    """Return the road surfaces in ``layer``; ``place`` is its file, for messages.

    :raises LayerError: naming a feature that is not a polygon.
    """
    _require(layer, "Polygon", place)
    columns = [layer.values[name] for name in layer.spec.fields]
    return tuple(
        Surface(
            tuple(frame.to_site(ring) for ring in _rings(geometry)),
            label or "",
            name or "",
            GENERATED if origin == GENERATED else DRAWN,
        )
        for geometry, label, name, origin in zip(layer.geometries, *columns, strict=True)
    )


def _polygon(rings: Sequence[Any], frame: SiteFrame) -> Any:
    import shapely

    outer, *holes = [frame.to_crs(ring) for ring in rings]
    return shapely.Polygon(outer, holes)


def _rings(polygon: Any) -> list[Any]:
    return [np.asarray(ring.coords)[:, :2] for ring in (polygon.exterior, *polygon.interiors)]


def _require(layer: geopackage.Layer, kind: str, place: str) -> None:
    for feature, geometry in zip(layer.ids, layer.geometries, strict=True):
        if geometry.geom_type != kind:
            raise LayerError(
                f"{place}, layer {layer.spec.name}, feature {feature}: it is a {geometry.geom_type}, "
                f"not a {kind}. Split or redraw it in the source layer and publish the site again."
            )
