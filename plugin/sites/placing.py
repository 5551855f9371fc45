"""From a layer's coordinates to metres in the site frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsCsException,
    QgsFeature,
    QgsGeometry,
    QgsRectangle,
)

from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from .errors import LayerCrsError
from .site_crs import crs_name, is_engineering, stated_crs

Bounds = tuple[float, float, float, float]
"""x_min, y_min, x_max, y_max."""


class PlacingError(Exception):
    """One geometry cannot be transformed into the site's CRS."""


@dataclass(frozen=True)
class SitePlacing:
    """Where the site is: its CRS (invalid when nothing has one) and its frame in it.

    ``local`` says whether layers whose place is not known are in the site frame's metres already; None: they
    cannot be, and nobody is asked.
    """

    crs: QgsCoordinateReferenceSystem
    frame: SiteFrame
    transform_context: QgsCoordinateTransformContext
    local: bool | None = None

    @classmethod
    def in_crs(
        cls, crs: QgsCoordinateReferenceSystem, transform_context: QgsCoordinateTransformContext
    ) -> SitePlacing:
        """Return a site whose frame is ``crs`` itself: for what knows no other one."""
        return cls(crs, SiteFrame(crs.authid(), (0.0, 0.0)), transform_context)

    def of_layer(self, name: str, crs: QgsCoordinateReferenceSystem) -> LayerPlacing:
        """Return how the coordinates of the layer ``name`` come into the site frame.

        :raises LayerCrsError: when they do not.
        """
        crs = stated_crs(crs)
        if crs.isValid() and crs == self.crs:
            return LayerPlacing(None, self.frame)
        unrelated = not crs.isValid() or is_engineering(crs) or is_engineering(self.crs)
        if unrelated and not self.local:
            raise LayerCrsError(self._why_unplaced(name, crs))
        if unrelated:
            return LayerPlacing(None, None)
        return LayerPlacing(QgsCoordinateTransform(crs, self.crs, self.transform_context), self.frame)

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
class LayerPlacing:
    """How one layer's coordinates come into the site frame: by a transform or none, then a frame or none."""

    transform: QgsCoordinateTransform | None
    frame: SiteFrame | None

    def area_of(self, window: Bounds) -> QgsRectangle | None:
        """Return the rectangle in the layer's CRS that holds ``window``; None when it cannot be told."""
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

    def to_metres(self, geometry: QgsGeometry) -> QgsGeometry:
        """Return ``geometry`` in metres: the site CRS's, or the site frame's where there is no frame.

        :raises PlacingError: when the transform fails somewhere on it.
        """
        if self.transform is None:
            return geometry
        moved = QgsGeometry(geometry)
        try:
            moved.transform(self.transform)
        except QgsCsException as error:
            raise PlacingError(str(error)) from error
        return moved

    def of_feature(self, feature: QgsFeature, notes: list[str]) -> QgsGeometry | None:
        """Return the geometry of ``feature`` in metres; None, with a note of why, where it has none there."""
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            notes.append(tr("has no geometry; it is left out"))
            return None
        try:
            return self.to_metres(geometry)
        except PlacingError as error:
            notes.append(
                tr("cannot be transformed into the site's CRS ({error}); it is left out", error=error)
            )
            return None

    def to_site(self, xy: np.ndarray) -> np.ndarray:
        """Return ``xy``, (n, 2) metres as :meth:`to_metres` gives them, as (n, 2) in the site frame."""
        return xy if self.frame is None else self.frame.to_site(xy)


def widened(bounds: Bounds, by: float) -> Bounds:
    """Return ``bounds`` with ``by`` metres more on each side."""
    x_min, y_min, x_max, y_max = bounds
    return x_min - by, y_min - by, x_max + by, y_max + by


def corners_of(bounds: Sequence[float]) -> np.ndarray:
    """Return the four corners of (x_min, y_min, x_max, y_max) as (4, 2)."""
    x_min, y_min, x_max, y_max = bounds
    return np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
