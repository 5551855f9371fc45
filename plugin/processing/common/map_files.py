"""Robot maps read from files, and their place on the Earth."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsLineString,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFile,
)

from ....robot_bridge.core.errors import RobotMapError
from ....robot_bridge.core.robotmap.binary import MAGIC, decode
from ....robot_bridge.core.robotmap.columns import LARGEST_TEXT
from ....robot_bridge.core.robotmap.model import RobotMap
from ....robot_bridge.core.robotmap.text_format import read_text
from ....robot_bridge.core.sites.frame import SiteFrame
from ...layers.crs import check_site_crs, is_engineering
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import FleetError
from ...ui.language import tr, tr_count
from .algorithm import ParameterError, Parameters, advanced
from .parameters import ORIGIN, ROTATION, frame_in_crs_parameters, given_crs, point_in, site_crs_parameter

# --- The size of a map in words ---


def obstacles_in_words(obstacles: int, segments: int) -> str:
    """Return the number of obstacles, and of their segments."""
    return ", ".join(
        (tr_count(obstacles, "1 obstacle", "%n obstacles"), tr_count(segments, "1 segment", "%n segments"))
    )


# --- A robot map's file and its place on the Earth, from an algorithm's parameters ---

MAP = "MAP"
SITE_METRES = (
    'ENGCRS["Site frame of a robot map",EDATUM["Site"],CS[Cartesian,2],AXIS["x",unspecified,ORDER[1]],'
    'AXIS["y",unspecified,ORDER[2]],LENGTHUNIT["metre",1]]'
)
"""The CRS of layers without a known place: QGIS would take a layer without one for degrees."""


class MapFileError(FleetError):
    """A file cannot be read, or is no robot map."""


@dataclass(frozen=True)
class MapPlace:
    """The CRS of a map's layers and the site frame in it."""

    crs: QgsCoordinateReferenceSystem
    frame: SiteFrame

    def points(self, site: Any) -> np.ndarray:
        """Return ``site``, (..., 2) metres in the site frame, as an array of its shape in the CRS."""
        points = np.asarray(site, dtype=np.float64)
        return self.frame.to_crs(points.reshape(-1, 2)).reshape(points.shape)


def layer_crs(crs: QgsCoordinateReferenceSystem) -> QgsCoordinateReferenceSystem:
    """Return ``crs``, or local metres where it is not valid."""
    return crs if crs.isValid() else QgsCoordinateReferenceSystem.fromWkt(SITE_METRES)


def map_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the file and, where that does not contain it, of the map's place."""
    frame = frame_in_crs_parameters(
        tr("Origin of the site frame in it (default: as the map says, else 0,0)"),
        tr("Rotation of the site frame, counter-clockwise [degrees] (default: as the map says, else 0)"),
    )
    place = [site_crs_parameter(tr("Site CRS (default: as the map says)")), *frame]
    filters = tr("Robot maps (*.txt *.map *.rmap *.bin);;All files (*)")
    return [
        QgsProcessingParameterFile(MAP, tr("Robot map, text or binary"), fileFilter=filters),
        *map(advanced, place),
    ]


def file_problem(parameters: Parameters) -> str:
    """Return the error in the file parameter before it is opened, or an empty text."""
    value = parameters.get(MAP)
    if isinstance(value, (str, Path)) and str(value) and not Path(value).is_file():
        return tr("There is no file {file}: choose a robot map (MAP).", file=value)
    return ""


def read_map_file(path: Path) -> RobotMap:
    """Return the map in a file, text or binary.

    :raises MapFileError: naming the file, the error, and its place.
    """
    try:
        size = path.stat().st_size
        if size > LARGEST_TEXT:
            raise MapFileError(
                tr(
                    "The file {path} has {size} bytes, and a robot map at most {largest_text}: choose a map.",
                    path=path,
                    size=size,
                    largest_text=LARGEST_TEXT,
                )
            )
        content = path.read_bytes()
        return decode(content) if content.startswith(MAGIC) else read_text(content.decode("utf-8-sig"))
    except OSError as error:
        raise MapFileError(
            tr(
                "The robot map {path} cannot be read: {reason}. Check its rights.",
                path=path,
                reason=error.strerror or error,
            )
        ) from error
    except UnicodeDecodeError as error:
        raise MapFileError(
            tr(
                "The file {path} is no robot map: it is neither UTF-8 (byte {start}) nor in the binary "
                "format, which begins with {decode}. Choose another file.",
                path=path,
                start=error.start,
                decode=MAGIC.decode(),
            )
        ) from error
    except RobotMapError as error:
        raise MapFileError(
            tr("The robot map {path} cannot be read: {error}", path=path, error=error)
        ) from error


def map_place(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    meta: Mapping[str, str],
    feedback: QgsProcessingFeedback,
) -> MapPlace:
    """Return the place of a map with the leading lines ``meta``; parameters win over those.

    Where no CRS is known the layers get a local one in metres, with a warning.

    :raises ParameterError: when a parameter or a leading line cannot be used.
    :raises SiteCrsError: when SITE_CRS cannot carry a site.
    """
    crs = _crs(algorithm, parameters, context, meta, feedback)
    origin = _numbers(meta, "origin", 2) or (0.0, 0.0)
    if parameters.get(ORIGIN):
        origin = point_in(algorithm, parameters, ORIGIN, context, crs)
    (rotation,) = _numbers(meta, "rotation", 1) or (0.0,)
    if parameters.get(ROTATION) not in (None, ""):
        rotation = math.radians(algorithm.parameterAsDouble(parameters, ROTATION, context))
    if not all(math.isfinite(number) for number in (*origin, rotation)):
        raise ParameterError(
            tr(
                "ORIGIN {origin} or ROTATION {rotation} is not finite: give numbers.",
                origin=origin,
                rotation=rotation,
            )
        )
    return MapPlace(crs, SiteFrame(crs.authid(), (origin[0], origin[1]), rotation))


def _crs(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    meta: Mapping[str, str],
    feedback: QgsProcessingFeedback,
) -> QgsCoordinateReferenceSystem:
    chosen = given_crs(algorithm, parameters, context)
    if chosen.isValid():
        check_site_crs(chosen)
        return chosen
    stated = meta.get("crs", "")
    known = QgsCoordinateReferenceSystem(stated) if stated else QgsCoordinateReferenceSystem()
    if known.isValid():
        return known
    why = (
        tr("the CRS {stated!r} that the map names is not known to QGIS", stated=stated)
        if stated
        else tr("it names no CRS")
    )
    feedback.pushWarning(
        tr(
            "The map's place is not known, because {why}: its layers are in local metres. Give SITE_CRS, "
            "ORIGIN and ROTATION to place it.",
            why=why,
        )
    )
    return layer_crs(known)


def _numbers(meta: Mapping[str, str], key: str, count: int) -> tuple[float, ...]:
    """Return the numbers in the leading line ``key``, empty where there is no such line."""
    if key not in meta:
        return ()
    try:
        numbers = tuple(float(part) for part in meta[key].split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != count or not all(math.isfinite(number) for number in numbers):
        wanted = tr("two numbers 'x,y'") if count == 2 else tr("a number")
        raise ParameterError(
            tr(
                "The leading line '%{key} {meta}' of the map should hold {wanted}: correct it there, or "
                "give {parameter}.",
                key=key,
                meta=meta[key],
                wanted=wanted,
                parameter=key.upper(),
            )
        )
    return numbers


# --- From the place of a robot map to layers beside it and to longitudes and latitudes ---

WGS_84 = "EPSG:4326"


@dataclass(frozen=True)
class PlacedMap:
    """The place of a map, with the project's choice of transforms."""

    place: MapPlace
    transform_context: QgsCoordinateTransformContext

    @property
    def is_local(self) -> bool:
        """Whether the map's metres have no known place on the Earth."""
        return is_engineering(self.place.crs)

    @property
    def layers(self) -> SiteGeoreference:
        """The georeference of layers; beside a local map their coordinates are the site's."""
        return SiteGeoreference(self.place.crs, self.place.frame, self.transform_context, local=self.is_local)

    def to_lonlat(self, xy: np.ndarray) -> np.ndarray:
        """Return (n, 2) metres in the site frame as (n, 2) longitudes and latitudes (WGS 84).

        :raises ParameterError: when the map's place is not known, or PROJ has no transform.
        """
        if self.is_local:
            raise ParameterError(
                tr(
                    "GeoJSON needs longitudes and latitudes, and the map's place is not known: give "
                    "SITE_CRS, ORIGIN and ROTATION, or choose geopackage, which keeps the site's metres."
                )
            )
        line = QgsLineString(*self.place.points(xy).T.tolist())
        target = QgsCoordinateReferenceSystem(WGS_84)
        try:
            line.transform(QgsCoordinateTransform(self.place.crs, target, self.transform_context))
        except QgsCsException as error:
            raise ParameterError(
                tr(
                    "The map's positions cannot be transformed from {crs} to longitudes and latitudes "
                    "({error}): check the map's lines crs, origin and rotation.",
                    crs=self.place.crs.authid(),
                    error=error,
                )
            ) from error
        wkb = line.asWkb().data()
        # 9 bytes come first: byte order, geometry type, number of points.
        return np.frombuffer(wkb, ("<" if wkb[0] else ">") + "f8", offset=9).reshape(-1, 2)
