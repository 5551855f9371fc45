"""A layer as it is read: everything that must be taken from it while the main thread holds it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsAbstractFeatureSource,
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFields,
    QgsProviderRegistry,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
    QgsWkbTypes,
)

from ..language import tr
from .errors import LayerTypeError
from .roles import EXPRESSIONS, FURNITURE, LayerExpressions, LayerSetup, setup_of
from .site_crs import stated_crs


@dataclass(frozen=True)
class ObstacleSource:
    """One obstacle layer, readable from any thread.

    ``name`` is unique among the layers read together, so that ``name:id`` names one feature. ``provider`` and
    ``uri`` say where its features are stored; there is no ``uri`` while it has changes that are not.
    """

    name: str
    role: str
    crs: QgsCoordinateReferenceSystem
    fields: QgsFields
    count: int
    features: QgsAbstractFeatureSource
    expressions: LayerExpressions
    context: QgsExpressionContext
    provider: str = ""
    uri: str = ""


Setups = Callable[[QgsVectorLayer], LayerSetup]
"""Tells what a layer is: by what it keeps itself, by a profile, by a dialog."""


def obstacle_sources(
    layers: Sequence[QgsVectorLayer],
    general: LayerExpressions,
    context: QgsExpressionContext,
    setups: Setups = setup_of,
) -> list[ObstacleSource]:
    """Return what is read of ``layers``; to be called in the thread that they belong to.

    An expression that ``setups`` has for a layer wins over the one in ``general``. ``context`` is what
    expressions see besides the layer.

    :raises LayerTypeError: naming the layer that holds neither lines nor polygons; points are furniture only.
    """
    for layer in layers:
        _check(layer, setups(layer).role)
    names = _unique([plain_name(layer) for layer in layers])
    return [
        _source(layer, name, setups(layer), general, context)
        for layer, name in zip(layers, names, strict=True)
    ]


def _check(layer: QgsVectorLayer, role: str) -> None:
    name = plain_name(layer)
    if not layer.isValid():
        raise LayerTypeError(
            tr(
                "The layer {name} cannot be opened ({source}): repair its data source or leave it out.",
                name=name,
                source=layer.source(),
            )
        )
    points = QgsWkbTypes.GeometryType.PointGeometry
    of_points = layer.isSpatial() and layer.geometryType() == points
    if not layer.isSpatial() or (of_points and role != FURNITURE):
        held = tr("points") if layer.isSpatial() else tr("no geometry")
        raise LayerTypeError(
            tr(
                "The layer {name} holds {held}, and only lines and polygons are obstacles: leave it out, "
                "give it an extent first (for example with Buffer), or the role furniture.",
                name=name,
                held=held,
            )
        )


def _source(
    layer: QgsVectorLayer,
    name: str,
    setup: LayerSetup,
    general: LayerExpressions,
    context: QgsExpressionContext,
) -> ObstacleSource:
    own = setup.expressions
    scoped = QgsExpressionContext(context)
    scoped.appendScope(QgsExpressionContextUtils.layerScope(layer))
    return ObstacleSource(
        name=name,
        role=setup.role,
        crs=stated_crs(layer.crs()),
        fields=layer.fields(),
        count=layer.featureCount(),
        features=QgsVectorLayerFeatureSource(layer),
        expressions=LayerExpressions(
            **{name: getattr(own, name) or getattr(general, name) for name in EXPRESSIONS}
        ),
        context=scoped,
        provider=layer.providerType(),
        uri="" if layer.isEditable() else layer.source(),
    )


def plain_name(layer: QgsVectorLayer) -> str:
    """Return the layer's name; the one inside its file where it is only called as the file is.

    That is what qgis_process calls ``campus.gpkg|layername=walls``: all layers of a file alike.
    """
    inside, path = _source_of(layer)
    called_as_file = bool(inside and path) and layer.name() == Path(path).stem
    return inside if called_as_file else layer.name()


def names_of(layer: QgsVectorLayer) -> list[str]:
    """Return the names that the layer goes by: the one that is shown, and the one in its file or database.

    QGIS's browser shows ``campus — walls`` for the layer ``walls`` of ``campus.gpkg``. A file of one layer
    may say no name of it: then it is the file's.
    """
    inside, path = _source_of(layer)
    return list(dict.fromkeys(name for name in (plain_name(layer), inside or Path(path).stem) if name))


def _source_of(layer: QgsVectorLayer) -> tuple[str, str]:
    """Return the layer's name in its source, and the source's path; each empty where there is none."""
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    # Of a database the name of the table is the layer's.
    inside = parts.get("layerName") or parts.get("table") or ""
    return str(inside), str(parts.get("path") or "")


def _unique(names: Sequence[str]) -> list[str]:
    """Return ``names`` with a number after each one that was there before."""
    taken: set[str] = set()
    unique = []
    for name in names:
        candidate, number = name, 1
        while candidate in taken:
            number += 1
            candidate = f"{name} ({number})"
        taken.add(candidate)
        unique.append(candidate)
    return unique
