"""The CRS in which positions are shown: the site's own metres, or whatever the operator chooses."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsProject, QgsSettings
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...errors import PlacementError
from ...language import tr
from ...sites.many_points import moved
from ..placement import Placement

KEY = "fleet_supervisor/position_crs"
Floats = np.ndarray


class PositionCrs(QObject):
    """Puts places of the site frame into the chosen CRS; an invalid one stands for the site frame."""

    changed = pyqtSignal()

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._crs = QgsCoordinateReferenceSystem(QgsSettings().value(KEY, "") or "")
        self._way: tuple[Placement | None, QgsCoordinateTransform | None] = (None, None)

    @property
    def crs(self) -> QgsCoordinateReferenceSystem:
        """The chosen CRS, invalid for the site frame."""
        return self._crs

    @property
    def name(self) -> str:
        """What the chosen CRS is called."""
        return self._crs.authid() or self._crs.description() if self._crs.isValid() else tr("site frame")

    def choose(self, crs: QgsCoordinateReferenceSystem) -> None:
        """Show positions in ``crs``, in later sessions as well; an invalid one is the site frame."""
        self._crs = crs
        self._way = (None, None)
        QgsSettings().setValue(KEY, crs.authid() if crs.isValid() else "")
        self.changed.emit()

    def placed(self, xy: Floats, placement: Placement) -> Floats:
        """Return (n, 2) metres in the site frame in the chosen CRS, not finite where it has no such place.

        :raises PlacementError: when the site's CRS is not usable.
        """
        if not self._crs.isValid():
            return xy
        known, way = self._way
        if known is not placement or way is None:
            way = QgsCoordinateTransform(placement.site_crs, self._crs, self._project)
            self._way = placement, way
        if not way.isValid():
            site = placement.site_crs.authid()
            raise PlacementError(
                tr(
                    "There is no way from {site} to {crs}. Choose another CRS under Columns.",
                    site=site,
                    crs=self.name,
                )
            )
        out = np.full((len(xy), 2), np.nan)
        there = np.isfinite(xy).all(axis=1)
        if there.any():
            out[there] = moved(placement.frame.to_crs(xy[there]), way)
        return out

    def place_in_words(self, x: float, y: float, placement: Placement) -> str:
        """Return a place of the site frame, in the chosen CRS, as text.

        :raises PlacementError: as :meth:`placed`.
        """
        ((x, y),) = self.placed(np.array([[x, y]]), placement).tolist()
        return self.in_words(x, y)

    def in_words(self, x: float, y: float) -> str:
        """Return a place in the chosen CRS as text: degrees as latitude, longitude, metres as x, y."""
        if not (np.isfinite(x) and np.isfinite(y)):
            return ""
        if self._crs.isValid() and self._crs.isGeographic():
            return f"{y:.7f}, {x:.7f}"
        return f"{x:.2f}, {y:.2f}"
