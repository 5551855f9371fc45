"""Transforms of coordinates: of many points, layers to the site, the site to the map and back, as shown."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsDatumTransform,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsRectangle,
    QgsSettings,
)
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.messages.administration import SiteReport
from ...robot_bridge.core.sites.frame import SiteFrame
from ..ui.errors import LayerCrsError, MapTransformError
from ..ui.language import tr
from .crs import crs_name, is_engineering, stated_crs

# --- Whether a transform between two CRSs is known ---


def check_transform(way: QgsCoordinateTransform) -> None:
    """Raise an error for an unknown transform ``way``, such as one from or to the metres of a local CRS.

    QGIS leaves coordinates unchanged there: degrees become metres. Where one of them has no CRS nothing
    needs to be done, and that is no error.

    :raises QgsCsException: when both ends have a CRS and no operation leads from one to the other.
    """
    if way.sourceCrs().isValid() and way.destinationCrs().isValid() and not way.isValid():
        raise QgsCsException(tr("nothing is known of how the two lie to each other"))


# --- The operation that transforms coordinates from one CRS to another, and its accuracy ---


@dataclass(frozen=True)
class DatumTransform:
    """The operation in words, its accuracy in metres if known, and what makes it worse than necessary."""

    name: str
    accuracy: float | None = None
    warning: str = ""

    def in_words(self) -> str:
        """Return one or two sentences."""
        exact = tr("accuracy not known")
        if self.accuracy is not None:
            exact = tr("accurate to {accuracy:g} m", accuracy=self.accuracy) if self.accuracy else tr("exact")
        return tr(
            "By {name} ({exact}).{warning}",
            name=self.name,
            exact=exact,
            warning=f" {self.warning}" if self.warning else "",
        )


def datum_transform(
    source: QgsCoordinateReferenceSystem,
    target: QgsCoordinateReferenceSystem,
    context: QgsCoordinateTransformContext,
) -> DatumTransform:
    """Return the operation that QGIS uses, by the project's settings, from ``source`` to ``target``."""
    if source == target:
        return DatumTransform(tr("no change: it is the site's CRS"), 0.0)
    way = QgsCoordinateTransform(source, target, context)
    used = way.instantiatedCoordinateOperationDetails()
    name = used.name or way.coordinateOperation() or tr("the default operation of PROJ")
    accuracy = used.accuracy if used.accuracy >= 0 else None
    if "ballpark" in name.lower():
        return DatumTransform(
            name, None, tr("PROJ knows no exact way between these two: the place may be off by metres.")
        )
    return DatumTransform(name, accuracy, _better(source, target, accuracy))


def _better(
    source: QgsCoordinateReferenceSystem, target: QgsCoordinateReferenceSystem, accuracy: float | None
) -> str:
    """Return what is missing for a more accurate operation; empty where this is the best."""
    most = math.inf if accuracy is None else accuracy
    for one in QgsDatumTransform.operations(source, target):
        missing = [grid.shortName for grid in one.grids if not grid.isAvailable]
        if missing and not one.isAvailable and 0 <= one.accuracy < most:
            grids = ", ".join(missing)
            return tr(
                "A way accurate to {accuracy:g} m needs the grid {grids}, which is not installed.",
                accuracy=one.accuracy,
                grids=grids,
            )
    return ""


# --- Many coordinates through one transform at once ---

_LINE_HEADER = struct.Struct("<BII")
_POINT_HEADER = struct.Struct("<BI")
_POINT, _LINE_STRING, _MULTI_POINT = 1, 2, 4
_MEMBER = np.dtype([("order", "u1"), ("kind", "<u4"), ("xy", "<f8", 2)])
"""A point of a multi-point."""


def line_of(xy: np.ndarray) -> QgsGeometry:
    """Return (n, 2) coordinates as a line, a single one as a point; an object for each would be slow."""
    head = _POINT_HEADER.pack(1, _POINT) if len(xy) == 1 else _LINE_HEADER.pack(1, _LINE_STRING, len(xy))
    geometry = QgsGeometry()
    geometry.fromWkb(head + xy.astype("<f8").tobytes())
    return geometry


def points_of(xy: np.ndarray) -> list[QgsGeometry]:
    """Return (n, 2) coordinates as a point each; creating them one by one takes twice as long."""
    if len(xy) == 0:
        return []
    members = np.empty(len(xy), dtype=_MEMBER)
    members["order"], members["kind"], members["xy"] = 1, _POINT, xy
    together = QgsGeometry()
    together.fromWkb(_LINE_HEADER.pack(1, _MULTI_POINT, len(xy)) + members.tobytes())
    return together.asGeometryCollection()


def transform_points(xy: np.ndarray, transform: QgsCoordinateTransform) -> np.ndarray:
    """Return (n, 2) coordinates through ``transform``.

    :raises QgsCsException: when one of them has no place in the target CRS, unless QGIS makes it infinite,
    and when no transform between the CRSs is known.
    """
    check_transform(transform)
    if len(xy) == 0 or transform.isShortCircuited():
        return np.asarray(xy, dtype=np.float64).reshape(-1, 2)
    # A line string of one point is invalid, so the first point is repeated.
    geometry = line_of(np.concatenate([xy[:1], xy]))
    geometry.transform(transform)
    return np.frombuffer(geometry.asWkb().data(), dtype="<f8", offset=_LINE_HEADER.size).reshape(-1, 2)[1:]


PIECES = 8
"""Parts of points that have no place together which are tried next."""


def transform_points_or_nan(xy: np.ndarray, transform: QgsCoordinateTransform) -> np.ndarray:
    """Return coordinates through ``transform``, (n, 2), or (n, k, 2) for n things with k points each.

    A point has NaN where the target CRS has no place for it, a thing where it has none for one of its points.
    """
    try:
        moved = transform_points(xy.reshape(-1, 2), transform).reshape(xy.shape)
    except QgsCsException:
        if len(xy) <= 1 or not transform.isValid():
            return np.full(xy.shape, np.nan)
        parts = np.array_split(xy, min(len(xy), PIECES))
        return np.concatenate([transform_points_or_nan(part, transform) for part in parts])
    is_placed = np.isfinite(moved).all(axis=tuple(range(1, xy.ndim)), keepdims=True)
    return np.where(is_placed, moved, np.nan)


# --- From a layer's coordinates to metres in the site frame ---

Bounds = tuple[float, float, float, float]
"""x_min, y_min, x_max, y_max."""


EXACT_M = 1.0
"""Accuracy in metres up to which there is no warning; ETRS89 and WGS 84 agree to 1 m."""


class SiteTransformError(Exception):
    """A geometry cannot be transformed into the site's CRS."""


@dataclass(frozen=True)
class SiteGeoreference:
    """The georeference of the site: its CRS (invalid when nothing has one) and its frame in it.

    ``local`` is whether layers without a known place are in the site frame's metres already; None: they
    cannot be, and nobody is asked.
    """

    crs: QgsCoordinateReferenceSystem
    frame: SiteFrame
    transform_context: QgsCoordinateTransformContext
    local: bool | None = None

    @classmethod
    def in_crs(
        cls, crs: QgsCoordinateReferenceSystem, transform_context: QgsCoordinateTransformContext
    ) -> SiteGeoreference:
        """Return a site whose frame is ``crs`` itself, where no other one is known."""
        return cls(crs, SiteFrame(crs.authid(), (0.0, 0.0)), transform_context)

    def of_layer(self, name: str, crs: QgsCoordinateReferenceSystem) -> LayerToSiteTransform:
        """Return the transform of the layer ``name`` into the site frame.

        :raises LayerCrsError: when there is none.
        """
        crs = stated_crs(crs)
        if crs.isValid() and crs == self.crs:
            return LayerToSiteTransform(None, self.frame)
        unrelated = not crs.isValid() or is_engineering(crs) or is_engineering(self.crs)
        if unrelated and not self.local:
            raise LayerCrsError(self._why_unplaced(name, crs))
        if unrelated:
            return LayerToSiteTransform(None, None)
        return LayerToSiteTransform(QgsCoordinateTransform(crs, self.crs, self.transform_context), self.frame)

    def _why_unplaced(self, name: str, crs: QgsCoordinateReferenceSystem) -> str:
        if self.local is None:
            return _why_not_related(name, crs, self.crs)
        tick = tr("tick 'Layers without a CRS are in metres of the site' (LOCAL=true)")
        if not crs.isValid():
            return tr(
                "The layer {name} has no CRS, so its place on the site is not known: set the layer's "
                "CRS (Layer > Set CRS of Layer), or {tick}.",
                name=name,
                tick=tick,
            )
        return tr(
            "The layer {name} is in the CRS {crs}, which has no known relation to the site CRS "
            "{site_crs}: choose the layer's CRS as the site CRS, or {tick}.",
            name=name,
            crs=crs_name(crs),
            site_crs=crs_name(self.crs),
            tick=tick,
        )


def _why_not_related(
    name: str, crs: QgsCoordinateReferenceSystem, others: QgsCoordinateReferenceSystem
) -> str:
    if not crs.isValid():
        return tr(
            "The layer {name} has no CRS, so its place is not known: set the layer's CRS (Layer > Set CRS of "
            "Layer).",
            name=name,
        )
    return tr(
        "The layer {name} is in the CRS {crs}, which has no known relation to the CRS {site_crs}: give both "
        "layers a CRS that says where on the Earth they are.",
        name=name,
        crs=crs_name(crs),
        site_crs=crs_name(others),
    )


@dataclass(frozen=True)
class LayerToSiteTransform:
    """The transform of one layer into the site frame: by a CRS transform or none, then a frame or none."""

    transform: QgsCoordinateTransform | None
    frame: SiteFrame | None

    def doubts(self, layer: str) -> list[str]:
        """Return a warning naming the ``layer`` where its features may be metres off."""
        if self.transform is None:
            return []
        source, target = self.transform.sourceCrs(), self.transform.destinationCrs()
        used = datum_transform(source, target, self.transform.context())
        if not used.warning and (used.accuracy or 0.0) <= EXACT_M:
            return []
        return [
            tr(
                "Layer {layer}: its features may lie metres off on the site. They come from {crs} to "
                "{site_crs}. {way} Choose another transformation in the project's properties, or save the "
                "layer in the site's CRS by an exact one.",
                layer=layer,
                crs=crs_name(source),
                site_crs=crs_name(target),
                way=used.in_words(),
            )
        ]

    def area_of(self, window: Bounds) -> QgsRectangle | None:
        """Return the rectangle in the layer's CRS that contains ``window``; None when there is none."""
        corners = corners_of(window)
        if self.frame is not None:
            corners = self.frame.to_crs(corners)
        area = QgsRectangle(*corners.min(axis=0), *corners.max(axis=0))
        if self.transform is None:
            return area
        try:
            back = Qgis.TransformDirection.Reverse
            return self.transform.transformBoundingBox(area, back)
        except QgsCsException:
            return None

    def bounds_of(self, area: QgsRectangle) -> Bounds | None:
        """Return the bounds in the site frame of ``area`` in the layer's CRS; None when there are none."""
        try:
            moved = area if self.transform is None else self.transform.transformBoundingBox(area)
        except QgsCsException:
            return None
        corners = self.to_site(
            corners_of((moved.xMinimum(), moved.yMinimum(), moved.xMaximum(), moved.yMaximum()))
        )
        (x_min, y_min), (x_max, y_max) = corners.min(axis=0), corners.max(axis=0)
        return float(x_min), float(y_min), float(x_max), float(y_max)

    def to_metres(self, geometry: QgsGeometry) -> QgsGeometry:
        """Return ``geometry`` in metres: the site CRS's, or the site frame's where there is no frame.

        :raises SiteTransformError: when the transform fails somewhere on it.
        """
        if self.transform is None:
            return geometry
        moved = QgsGeometry(geometry)
        try:
            moved.transform(self.transform)
        except QgsCsException as error:
            raise SiteTransformError(str(error)) from error
        return moved

    def of_feature(self, feature: QgsFeature, notes: list[str]) -> QgsGeometry | None:
        """Return the geometry of ``feature`` in metres; None, with a note of why, where it has none there."""
        geometry = feature.geometry()
        if geometry.isEmpty():
            notes.append(tr("has no geometry; it is left out"))
            return None
        try:
            return self.to_metres(geometry)
        except SiteTransformError as error:
            notes.append(
                tr("cannot be transformed into the site's CRS ({error}); it is left out", error=error)
            )
            return None

    def to_site(self, xy: np.ndarray) -> np.ndarray:
        """Return ``xy``, (n, 2) metres as returned by :meth:`to_metres`, as (n, 2) in the site frame."""
        return xy if self.frame is None else self.frame.to_site(xy)


def widen_bounds(bounds: Bounds, by: float) -> Bounds:
    """Return ``bounds`` grown by ``by`` metres on each side."""
    x_min, y_min, x_max, y_max = bounds
    return x_min - by, y_min - by, x_max + by, y_max + by


def corners_of(bounds: Sequence[float]) -> np.ndarray:
    """Return the four corners of (x_min, y_min, x_max, y_max) as (4, 2)."""
    x_min, y_min, x_max, y_max = bounds
    return np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])


# --- From the site frame to the canvas and back, many points at once ---

Points = npt.NDArray[np.float64]


def frame_of(site: SiteReport) -> SiteFrame:
    """Return the frame of a site reported by the gateway."""
    return SiteFrame(site.crs, site.origin, site.rotation)


class SiteToMapTransform:
    """Site frame → site CRS → a map's CRS, and back.

    :raises MapTransformError: when QGIS does not know the site's CRS.
    """

    def __init__(
        self,
        site: SiteReport,
        map_crs: QgsCoordinateReferenceSystem,
        context: QgsCoordinateTransformContext,
    ):
        self.site_crs = QgsCoordinateReferenceSystem(site.crs)
        if not self.site_crs.isValid():
            raise MapTransformError(
                tr(
                    "The site {name} is in the CRS {crs}, which this QGIS does not know: its robots cannot "
                    "be placed on the map. Correct crs in the site's site.toml, or update QGIS.",
                    name=site.name,
                    crs=site.crs,
                )
            )
        self.site = site
        self.map_crs = map_crs
        self._context = context
        self.frame = frame_of(site)
        self._forward = QgsCoordinateTransform(self.site_crs, map_crs, context)

    def leads_to(self, crs: QgsCoordinateReferenceSystem, context: QgsCoordinateTransformContext) -> bool:
        """Return whether this is the transform to ``crs`` by the operations that ``context`` prefers."""
        return self.map_crs == crs and self._context == context

    def to_map(self, xy: Points) -> Points:
        """Return (n, 2) metres in the site frame as (n, 2) coordinates of the map's CRS.

        :raises MapTransformError: when a point cannot be expressed in the map's CRS.
        """
        return transform_or_raise(self.frame.to_crs(xy), self._forward)

    def to_map_or_nan(self, xy: Points) -> Points:
        """Return (n, 2) or (n, k, 2) as :meth:`to_map` does, NaN for what has no place in the map's CRS.

        Of (n, k, 2) the k points of a thing have a place together, as in :func:`transform_points_or_nan`.
        """
        in_crs = self.frame.to_crs(xy.reshape(-1, 2)).reshape(xy.shape)
        return transform_points_or_nan(in_crs, self._forward)

    @property
    def axes(self) -> Points | None:
        """The site's x and y, a metre of each in the map's CRS as a row of (2, 2); None unless they are the
        same all over the map, as in the site's own CRS.
        """
        return self.frame.axes() if self._forward.isShortCircuited() else None

    def to_site(self, point: QgsPointXY) -> tuple[float, float]:
        """Return a point in the map's CRS as metres in the site frame.

        :raises MapTransformError: when the point cannot be expressed in the site's CRS.
        """
        try:
            check_transform(self._forward)
            in_site_crs = self._forward.transform(point, Qgis.TransformDirection.Reverse)
        except QgsCsException as error:
            raise _out_of_reach(self.map_crs, self.site_crs, error) from error
        ((x, y),) = self.frame.to_site([(in_site_crs.x(), in_site_crs.y())])
        return float(x), float(y)


def transform_or_raise(xy: Points, transform: QgsCoordinateTransform) -> Points:
    """Return (n, 2) coordinates through ``transform``, as one line string and not point by point.

    :raises MapTransformError: when a point has no place in the target CRS.
    """
    try:
        out = transform_points(xy, transform)
    except QgsCsException as error:
        raise _out_of_reach(transform.sourceCrs(), transform.destinationCrs(), error) from error
    if not np.isfinite(out).all():
        raise _out_of_reach(transform.sourceCrs(), transform.destinationCrs(), tr("not a finite place"))
    return out


def _out_of_reach(
    source: QgsCoordinateReferenceSystem, target: QgsCoordinateReferenceSystem, error: object
) -> MapTransformError:
    return MapTransformError(
        tr(
            "A position in {crs} has no place in {target} ({error}). Choose the site's CRS as the "
            "project's CRS (bottom right in the QGIS window).",
            crs=crs_name(source),
            target=crs_name(target),
            error=error,
        )
    )


# --- The CRS in which positions are shown: the site's own metres, or the operator's choice ---

POSITION_CRS_KEY = "fleet_supervisor/position_crs"
Floats = np.ndarray


class PositionCrs(QObject):
    """Transforms places of the site frame to the chosen CRS; an invalid one stands for the site frame."""

    changed = pyqtSignal()

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._crs = QgsCoordinateReferenceSystem(QgsSettings().value(POSITION_CRS_KEY, "") or "")
        self._way: tuple[SiteToMapTransform | None, QgsCoordinateTransform | None] = (None, None)

    @property
    def crs(self) -> QgsCoordinateReferenceSystem:
        """The chosen CRS, invalid for the site frame."""
        return self._crs

    @property
    def name(self) -> str:
        """The name of the chosen CRS."""
        return self._crs.authid() or self._crs.description() if self._crs.isValid() else tr("site frame")

    def choose(self, crs: QgsCoordinateReferenceSystem) -> None:
        """Show positions in ``crs``, in later sessions as well; an invalid one is the site frame."""
        self._crs = crs
        self._way = (None, None)
        QgsSettings().setValue(POSITION_CRS_KEY, crs.authid() if crs.isValid() else "")
        self.changed.emit()

    def placed(self, xy: Floats, transform: SiteToMapTransform) -> Floats:
        """Return (n, 2) metres in the site frame in the chosen CRS, not finite where impossible.

        :raises MapTransformError: when the site's CRS is not usable.
        """
        if not self._crs.isValid():
            return xy
        known, way = self._way
        if known is not transform or way is None:
            way = QgsCoordinateTransform(transform.site_crs, self._crs, self._project)
            self._way = transform, way
        if not way.isValid():
            site = transform.site_crs.authid()
            raise MapTransformError(
                tr(
                    "There is no way from {site} to {crs}. Choose another CRS under Columns.",
                    site=site,
                    crs=self.name,
                )
            )
        out = np.full((len(xy), 2), np.nan)
        there = np.isfinite(xy).all(axis=1)
        if there.any():
            out[there] = transform_points_or_nan(transform.frame.to_crs(xy[there]), way)
        return out

    def place_in_words(self, x: float, y: float, transform: SiteToMapTransform) -> str:
        """Return a place of the site frame, in the chosen CRS, as text.

        :raises MapTransformError: as :meth:`placed`.
        """
        ((x, y),) = self.placed(np.array([[x, y]]), transform).tolist()
        return self.in_words(x, y)

    def in_words(self, x: float, y: float) -> str:
        """Return a place in the chosen CRS as text: degrees as latitude, longitude, metres as x, y."""
        if not (np.isfinite(x) and np.isfinite(y)):
            return ""
        if self._crs.isValid() and self._crs.isGeographic():
            return f"{y:.7f}, {x:.7f}"
        return f"{x:.2f}, {y:.2f}"


class SiteSource(Protocol):
    """Provider of the site that is served, None before it is known."""

    site: SiteReport | None


class SiteToCanvas:
    """The transform from the site frame to the CRS of the canvas, for present site, canvas and project."""

    def __init__(self, state: SiteSource, canvas: QgsMapCanvas, project: QgsProject):
        self._state, self._canvas, self._project = state, canvas, project
        self._known: SiteToMapTransform | None = None

    def transform(self) -> SiteToMapTransform:
        """Return the transform, which is the same object for as long as nothing has changed.

        :raises MapTransformError: when no gateway has reported its site yet, or the CRS is not usable.
        """
        site = self._state.site
        if site is None:
            raise MapTransformError(tr("The site is not known yet. Connect to a gateway first."))
        target = self._canvas.mapSettings().destinationCrs(), self._project.transformContext()
        if self._known is None or self._known.site is not site or not self._known.leads_to(*target):
            self._known = SiteToMapTransform(site, *target)
        return self._known
