"""Labels as all styles have them: small, dark, with a halo that keeps them legible on a photograph."""

from __future__ import annotations

from qgis.core import QgsPalLayerSettings, QgsTextFormat, QgsUnitTypes
from qgis.PyQt.QtGui import QFont


def letters(size: float, halo: float) -> QgsTextFormat:
    """Return letters of ``size`` points with a halo of ``halo`` millimetres."""
    letters = QgsTextFormat()
    letters.setFont(QFont("Sans Serif", weight=QFont.Weight.DemiBold))
    letters.setSize(size)
    letters.setSizeUnit(QgsUnitTypes.RenderUnit.RenderPoints)
    edge = letters.buffer()
    edge.setEnabled(True)
    edge.setSize(halo)
    letters.setBuffer(edge)
    return letters


def around_points(field: str, format: QgsTextFormat, distance: float, scale: float) -> QgsPalLayerSettings:
    """Return labels that say ``field``, ``distance`` millimetres from their points, from 1:``scale`` on."""
    settings = QgsPalLayerSettings()
    settings.fieldName = field
    settings.placement = QgsPalLayerSettings.Placement.AroundPoint
    settings.dist = distance
    settings.setFormat(format)
    settings.scaleVisibility, settings.minimumScale, settings.maximumScale = True, scale, 0
    return settings
