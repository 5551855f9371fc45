"""By which way, and how exactly, coordinates of another CRS come into the site's."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCoordinateTransformContext,
    QgsDatumTransform,
)

from ...language import tr


@dataclass(frozen=True)
class DatumPath:
    """The operation in words, its accuracy in metres if it is known, and what makes it worse than need be."""

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


def datum_path(
    source: QgsCoordinateReferenceSystem,
    target: QgsCoordinateReferenceSystem,
    context: QgsCoordinateTransformContext,
) -> DatumPath:
    """Return the operation that QGIS uses, by the project's settings, from ``source`` to ``target``."""
    if source == target:
        return DatumPath(tr("no change: it is the site's CRS"), 0.0)
    way = QgsCoordinateTransform(source, target, context)
    used = way.instantiatedCoordinateOperationDetails()
    name = used.name or way.coordinateOperation() or tr("the default operation of PROJ")
    accuracy = used.accuracy if used.accuracy >= 0 else None
    if "ballpark" in name.lower():
        return DatumPath(
            name, None, tr("PROJ knows no exact way between these two: the place may be off by metres.")
        )
    return DatumPath(name, accuracy, _better(source, target, accuracy))


def _better(
    source: QgsCoordinateReferenceSystem, target: QgsCoordinateReferenceSystem, accuracy: float | None
) -> str:
    """Return what is missing for a more exact way; empty where this is the best."""
    for one in QgsDatumTransform.operations(source, target):
        missing = [grid.shortName for grid in one.grids if not grid.isAvailable]
        if missing and not one.isAvailable and 0 <= one.accuracy < (accuracy or 1e9):
            grids = ", ".join(missing)
            return tr(
                "A way accurate to {accuracy:g} m needs the grid {grids}, which is not installed.",
                accuracy=one.accuracy,
                grids=grids,
            )
    return ""
