"""Features of a layer that have no geometry: a window, which is asked for by place, never has them."""

from __future__ import annotations

from collections.abc import Iterator

from qgis.core import (
    QgsDataSourceUri,
    QgsFeature,
    QgsFeatureRequest,
    QgsProviderRegistry,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
)

from .obstacle_source import ObstacleSource

_NONE = "is_empty_or_null($geometry)"


def without_geometry(source: ObstacleSource) -> Iterator[QgsFeature]:
    """Yield the features of ``source`` whose geometry is missing or empty; from any thread.

    Files and databases that know of it by themselves are asked; of others every feature is looked at.
    """
    subset = subset_without_geometry(source.provider, source.uri) if source.uri else ""
    if subset:
        options = QgsVectorLayer.LayerOptions()
        options.loadDefaultStyle = False
        layer = QgsVectorLayer(subset, source.name, source.provider, options)
        if layer.isValid():
            # Named, since its features do not keep it alive.
            found = QgsVectorLayerFeatureSource(layer)
            yield from found.getFeatures(QgsFeatureRequest())
            return
    yield from source.features.getFeatures(QgsFeatureRequest().setFilterExpression(_NONE))


def subset_without_geometry(provider: str, uri: str) -> str:
    """Return the source of what has no geometry in the layer ``uri``, nothing where it cannot be asked."""
    if provider == "ogr":
        return _in_geopackage(uri)
    if provider == "postgres":
        source = QgsDataSourceUri(uri)
        column = source.geometryColumn()
        source.setSql(_both(source.sql(), f"{_quoted(column)} IS NULL"))
        return source.uri(False) if column else ""
    return ""


def _in_geopackage(uri: str) -> str:
    registry = QgsProviderRegistry.instance()
    parts = registry.decodeUri("ogr", uri)
    path, subset = str(parts.get("path") or ""), str(parts.get("subset") or "")
    if not path.lower().endswith(".gpkg") or subset.lstrip().lower().startswith("select"):
        return ""
    sublayers = registry.providerMetadata("ogr").querySublayers(path)
    name = parts.get("layerName")
    columns = [one.geometryColumnName() for one in sublayers if name in (None, "", one.name())]
    if len(columns) != 1 or not columns[0]:
        return ""
    column = _quoted(columns[0])
    parts["subset"] = _both(subset, f"({column} IS NULL OR ST_IsEmpty({column}))")
    return str(registry.encodeUri("ogr", parts))


def _both(subset: str, condition: str) -> str:
    return f"({subset}) AND {condition}" if subset else condition


def _quoted(column: str) -> str:
    return '"' + column.replace('"', '""') + '"'
