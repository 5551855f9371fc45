"""Features of a site as arrays, and ``site.gpkg`` that holds them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LayerError
from ..files import write_geopackage_layer
from ..json_decoder import DecodingError, decode_json
from ..roads.network import DEFAULT_SPEED, DRAWN, Centrelines, centrelines
from .frame import Points, crs_of, projections

# --- Centrelines and areas of a site, as plain arrays in the site frame ---


@dataclass(frozen=True)
class Centreline:
    """The centreline of one road: ``points`` is (n, 2), metres in the site frame, as digitised.

    ``direction`` is 1 for one way along the line, -1 against it, and 0 for both; ``level`` is 0 on the
    ground, above it on bridges.
    """

    points: Points
    width_m: float
    surface: str
    direction: int = 0
    speed_ms: float = DEFAULT_SPEED
    closed: bool = False
    level: int = 0


@dataclass(frozen=True)
class Area:
    """One polygon, such as a keepout, whose label is its name.

    ``rings`` holds the outer ring and then its holes, each (n, 2), metres in the site frame, closed.
    """

    rings: tuple[Points, ...]
    label: str


# --- The four layers of ``site.gpkg`` and the fields each one has ---


@dataclass(frozen=True)
class LayerSpec:
    """A layer's name, its OGR geometry type and its fields with the numpy type of each.

    ``defaults`` are the fields that a site of an older version may lack, with their values then.
    """

    name: str
    geometry: str
    fields: dict[str, type]
    defaults: Mapping[str, float | str] = field(default_factory=dict)

    def declared_geometry(self, empty: bool) -> str:
        """Return the geometry type that the layer's table declares.

        QGIS 3.22 reads an empty layer of any geometry as a table without geometry and CRS: so an empty one
        declares polygons.
        """
        return "Polygon" if empty and self.geometry == "Unknown" else self.geometry


OBSTACLES = LayerSpec(
    "obstacles",
    "Unknown",
    {
        "source": str,
        "semantics": str,
        "height_m": float,
        "outdoor": bool,
        "shape_type": int,
        "base_m": float,
        "ext": str,
    },
    defaults={"base_m": 0.0, "ext": ""},
)
CENTRELINES = LayerSpec(
    "road_centrelines",
    "LineString",
    {"width_m": float, "surface": str, "direction": int, "speed_ms": float, "closed": bool, "level": int},
    defaults={"direction": 0, "speed_ms": DEFAULT_SPEED, "closed": False, "level": 0},
)
SURFACES = LayerSpec(
    "road_surfaces",
    "Polygon",
    {"surface": str, "name": str, "origin": str},
    defaults={"name": "", "origin": DRAWN},
)
KEEPOUTS = LayerSpec("keepouts", "Polygon", {"name": str})


# --- Extras of an obstacle as one field of a layer: a JSON object of texts, or nothing ---


def extras_text(extras: Mapping[str, str]) -> str:
    """Return ``extras`` as they stand in the field ``ext``, such as ``{"h": "est"}``; nothing for none."""
    return _text(tuple(extras.items())) if extras else ""


@lru_cache(maxsize=1000)
def _text(extras: tuple[tuple[str, str], ...]) -> str:
    """Return the result of :func:`extras_text`, cached: a city has few different ones."""
    return json.dumps(dict(extras), ensure_ascii=False)


def extras_of(text: str | None, where: str) -> dict[str, str]:
    """Return the extras in the field ``ext``; ``where`` names its file, layer and feature.

    :raises LayerError: when it is no JSON object of texts.
    """
    try:
        found = decode_json(text) if text else {}
    except DecodingError:
        found = None
    if not isinstance(found, dict) or not all(isinstance(value, str) for value in found.values()):
        raise LayerError(
            f"{where}: its ext is {str(text)[:80]!r}, and not a JSON object of texts such as "
            '{"h": "est"}. Correct or empty it, or publish the site again.'
        )
    return found


# --- The roads of a site as input of the network ---


def road_lines(roads: Sequence[Centreline]) -> Centrelines:
    """Return ``roads``, at least one, with all their attributes."""
    return centrelines(
        [road.points for road in roads],
        width=[road.width_m for road in roads],
        surface=[road.surface for road in roads],
        direction=[road.direction for road in roads],
        speed=[road.speed_ms for road in roads],
        closed=[road.closed for road in roads],
        level=[road.level for road in roads],
    )


# --- Extent of known obstacles around a site ---

KNOWN_BEYOND = 100.0
"""metres outside the site's bounds within which obstacles are published, for a robot at its edge."""


# --- ``site.gpkg`` on disk: layers of geometries and fields, read and written; errors name every defect ---

GEOPACKAGE_FILE = "site.gpkg"
STAMP_KEY = "FLEET_SITE"
"""The metadata item of every layer that names its publication."""

_REPAIR = "Publish the site again."


@dataclass(frozen=True)
class Layer:
    """The features of one layer: K shapely geometries in the site CRS, and K values of each field."""

    spec: LayerSpec
    ids: np.ndarray[Any, Any]
    geometries: np.ndarray[Any, Any]
    values: Mapping[str, np.ndarray[Any, Any]]

    def __len__(self) -> int:
        return len(self.geometries)


def layer_of(spec: LayerSpec, geometries: Sequence[Any], values: Mapping[str, Sequence[Any]]) -> Layer:
    """Return a layer ready to be written; ids are given by the file."""
    column = np.empty(len(geometries), dtype=object)
    column[:] = geometries
    kinds = {name: object if kind is str else kind for name, kind in spec.fields.items()}
    arrays: dict[str, np.ndarray[Any, Any]] = {
        name: np.array(values[name], dtype=kind) for name, kind in kinds.items()
    }
    return Layer(spec, np.arange(1, len(column) + 1), column, arrays)


def write_layers(file: Path, layers: Sequence[Layer], crs: str, stamp: str) -> None:
    """Write ``layers`` to the new GeoPackage ``file`` in ``crs``.

    Version 1.3 of the format, which GDAL 3.6 and older read. ``stamp`` names the publication this file
    belongs to. The environment variable OGR_CURRENT_DATE, if set, replaces the time of writing.

    :raises LayerError: when the file cannot be written.
    """
    _pyogrio()
    try:
        for layer in layers:
            kind = layer.spec.declared_geometry(len(layer.geometries) == 0)
            geometry = _shapely().to_wkb(layer.geometries)
            columns = dict(zip(layer.spec.fields, layer.values.values(), strict=True))
            write_geopackage_layer(file, layer.spec.name, kind, geometry, columns, crs, {STAMP_KEY: stamp})
    except OSError as error:
        raise LayerError(
            f"{file} cannot be written: {error}. Check the folder's rights and free space."
        ) from error


def read_layers(file: Path, specs: Sequence[LayerSpec], crs: str, stamp: str) -> list[Layer]:
    """Return the layers ``specs`` of the GeoPackage ``file``, fully checked.

    :raises LayerError: when the file is missing or damaged, belongs to another publication than ``stamp``,
        or a layer is missing, lacks a field, is in another CRS than ``crs`` or has a defective feature.
    """
    pyogrio = _pyogrio()
    if not file.is_file():
        raise LayerError(f"{file} is missing: the site is half there. {_REPAIR}")
    try:
        present = {str(name) for name in pyogrio.list_layers(str(file))[:, 0]}
        _check_stamp(file, specs, present, stamp)
        return [_read(file, spec, crs) for spec in specs]
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
        raise LayerError(f"{file} is not a readable GeoPackage: {error}. {_REPAIR}") from error


def _check_stamp(file: Path, specs: Sequence[LayerSpec], present: set[str], stamp: str) -> None:
    for spec in specs:
        if spec.name not in present:
            raise LayerError(
                f"{file} has no layer {spec.name!r}; it has {', '.join(sorted(present)) or 'none'}. {_REPAIR}"
            )
    found = (_pyogrio().read_info(str(file), layer=specs[0].name)["layer_metadata"] or {}).get(STAMP_KEY)
    if found != stamp:
        raise LayerError(
            f"{file} belongs to {found or 'no publication'} and the settings beside it to {stamp}: "
            f"publishing was interrupted or files were mixed. {_REPAIR}"
        )


def _read(file: Path, spec: LayerSpec, crs: str) -> Layer:
    meta, ids, wkb, columns = _pyogrio().raw.read(str(file), layer=spec.name, return_fids=True)
    values = dict(zip((str(name) for name in meta["fields"]), columns, strict=True))
    for name in spec.fields:
        if name in spec.defaults:
            values.setdefault(name, np.full(len(ids), spec.defaults[name]))
        elif name not in values:
            raise LayerError(f"{file}, layer {spec.name}: the field {name!r} is missing. {_REPAIR}")
    _check_crs(file, spec, meta["crs"], crs)
    layer = Layer(spec, ids, _geometries(wkb, ids, spec, file), {name: values[name] for name in spec.fields})
    check_features(layer, str(file))
    return layer


def _geometries(wkb: Any, ids: Any, spec: LayerSpec, file: Path) -> np.ndarray[Any, Any]:
    # A GeoPackage may hold unclosed rings and incomplete geometries; shapely does not say which one it was.
    with np.errstate(invalid="ignore"):
        geometries: np.ndarray[Any, Any] = _shapely().from_wkb(wkb, on_invalid="ignore")
    unreadable = _shapely().is_missing(geometries) & np.array([blob is not None for blob in wkb], dtype=bool)
    if unreadable.any():
        raise LayerError(
            f"{file}, layer {spec.name}, feature {ids[np.argmax(unreadable)]}: its geometry is broken, "
            f"such as a ring that is not closed. Correct it in the source layer. {_REPAIR}"
        )
    return geometries


def _check_crs(file: Path, spec: LayerSpec, found: str | None, expected: str) -> None:
    if found is None or crs_of(found) != crs_of(expected):
        raise LayerError(
            f"{file}, layer {spec.name}: its CRS is {found or 'not stated'}, and site.crs is {expected}. "
            f"{_REPAIR}"
        )


def check_features(layer: Layer, place: str) -> None:
    """Raise :class:`LayerError` for the first feature without a usable geometry or number.

    ``place`` is the file, for messages.
    """
    shapely = _shapely()
    geometries = layer.geometries
    finite = np.ones(len(layer), dtype=bool)
    points, owner = shapely.get_coordinates(geometries, return_index=True)
    finite[owner[~np.isfinite(points).all(axis=1)]] = False
    defects = [
        (shapely.is_missing(geometries) | shapely.is_empty(geometries), "has no geometry"),
        (~finite, "has a coordinate that is NaN or infinite"),
    ]
    for name, kind in layer.spec.fields.items():
        if kind is float:
            defects.append((~np.isfinite(layer.values[name]), f"has no finite number in {name}"))
    for wrong, what in defects:
        if wrong.any():
            feature = layer.ids[np.argmax(wrong)]
            raise LayerError(
                f"{place}, layer {layer.spec.name}, feature {feature}: it {what}. "
                "Correct or delete it in the source layer and publish the site again."
            )


def _pyogrio() -> Any:
    projections()  # before pyogrio imports pyproj aloud
    try:
        import pyogrio
        import pyogrio.raw
    except ImportError as error:
        raise LayerError(
            "The Python package pyogrio is missing, which reads and writes site.gpkg: install it with "
            "'python3 -m pip install pyogrio'."
        ) from error
    return pyogrio


def _shapely() -> Any:
    try:
        import shapely
    except ImportError as error:
        raise LayerError(
            "The Python package shapely 2 is missing, which reads and writes site.gpkg: install it with "
            "'python3 -m pip install shapely'."
        ) from error
    return shapely
