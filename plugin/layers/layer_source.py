"""Source of a layer in its role: features, attributes, geometries, and warnings about them."""

from __future__ import annotations

import math
import re
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import NamedTuple

from qgis.core import (
    QgsAbstractFeatureSource,
    QgsCoordinateReferenceSystem,
    QgsDataSourceUri,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsFeatureRequest,
    QgsFeatureSource,
    QgsFeedback,
    QgsFields,
    QgsGeometry,
    QgsProviderRegistry,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
    QgsWkbTypes,
)
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QDateTime, QObject, Qt, pyqtSignal

from ..ui.errors import LayerTypeError
from ..ui.language import tr
from .crs import stated_crs
from .layer_expressions import FeatureFilter
from .reading import IN_MEMORY, begin_reading, deleted_in, error_of_gdal, has_features, is_empty, open_again
from .roles import EXPRESSIONS, FURNITURE, LayerExpressions, LayerSetup, plain_name, setup_of
from .site_transform import LayerToSiteTransform

# --- A snapshot of a layer for reading: everything that must be fetched from it in the main thread ---


@dataclass(frozen=True)
class ObstacleSource:
    """One obstacle layer, readable from any thread.

    ``name`` is unique among the layers read together, so that ``name:id`` identifies a feature. ``provider``
    and ``uri`` are where its features are stored; ``uri`` is empty while it has unsaved changes. ``count`` is
    negative where only its server or file knows: querying that may block for ever. ``stored`` is the source
    to open it again regardless of its changes, which delete ``deleted`` of its features.
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
    stored: str = ""
    deleted: int = 0


Setups = Callable[[QgsVectorLayer], LayerSetup]
"""Returns the setup of a layer: from its own properties, a profile, or a dialog."""


def obstacle_sources(
    layers: Sequence[QgsVectorLayer],
    general: LayerExpressions,
    context: QgsExpressionContext,
    setups: Setups = setup_of,
) -> list[ObstacleSource]:
    """Return the sources of ``layers``; must be called in their thread.

    An expression that ``setups`` has for a layer wins over the one in ``general``. ``context`` is available
    to expressions besides the layer.

    :raises LayerTypeError: naming a layer that holds neither lines nor polygons; points only for furniture.
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
                # Without the password of a database.
                source=layer.publicSource(),
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
        count=layer.featureCount() if layer.providerType() == IN_MEMORY else -1,
        features=QgsVectorLayerFeatureSource(layer),
        expressions=LayerExpressions(
            **{name: getattr(own, name) or getattr(general, name) for name in EXPRESSIONS}
        ),
        context=scoped,
        provider=layer.providerType(),
        uri="" if layer.isEditable() else layer.source(),
        stored=layer.source(),
        deleted=deleted_in(layer),
    )


def _unique(names: Sequence[str]) -> list[str]:
    """Return ``names`` with a number appended to duplicates."""
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


# --- Whether a layer could be read: QGIS does not report a file that is gone


def count_stored(source: ObstacleSource) -> int:
    """Return the number of stored features, negative where unknown; from any thread, and it may hang."""
    return source.count if source.count >= 0 else open_again(source.provider, source.stored).featureCount()


def check_readable(source: ObstacleSource) -> None:
    """Raise :class:`LayerTypeError` where ``source`` could not be read, or only in part; call after reading.

    Of a damaged file QGIS returns the features before the damage, and no error.
    """
    error = error_of_gdal() if source.provider == "ogr" else ""
    if not _is_there(source):
        raise LayerTypeError(
            tr(
                "The layer {name} cannot be read any more: QGIS gets none of its features. Its file or "
                "database was moved, damaged or cut off since the project was opened. Bring it back, or "
                "repair the layer's data source, and open the project again.",
                name=source.name,
            )
        )
    if error:
        raise _half_read(source.name, error)


def _is_there(source: ObstacleSource) -> bool:
    if source.count == 0 or has_features(source.features):
        return True
    return source.provider == IN_MEMORY or is_empty(source.provider, source.stored, source.deleted)


def _half_read(name: str, error: str) -> LayerTypeError:
    return LayerTypeError(
        tr(
            "The layer {name} cannot be read to its end ({error}): its file is damaged, or was not "
            "copied whole. Replace it by a sound copy, or leave the layer out.",
            name=name,
            error=error,
        )
    )


# --- Features of a layer without geometry: a query by window never returns them ---

_NONE = "is_empty_or_null($geometry)"


def without_geometry(source: ObstacleSource) -> Iterator[QgsFeature]:
    """Yield the features of ``source`` whose geometry is missing or empty; from any thread.

    Files and databases that can find them are queried; for others every feature is checked.
    """
    ids = rows_without_index(source.uri) if source.provider == "ogr" and source.uri else None
    if ids is not None:
        found = source.features.getFeatures(QgsFeatureRequest().setFilterFids(ids)) if ids else []
        # Deleted rows are not there; the others come in any order.
        yield from sorted((QgsFeature(one) for one in found), key=QgsFeature.id)
        return
    subset = subset_without_geometry(source.provider, source.uri) if source.uri else ""
    if subset:
        options = QgsVectorLayer.LayerOptions()
        options.loadDefaultStyle = False
        layer = QgsVectorLayer(subset, source.name, source.provider, options)
        if layer.isValid():
            # Held in a variable, since its features do not keep it alive.
            features = QgsVectorLayerFeatureSource(layer)
            yield from features.getFeatures(QgsFeatureRequest())
            return
    yield from source.features.getFeatures(QgsFeatureRequest().setFilterExpression(_NONE))


_MOST_GAPS = 10_000
"""Rows missing in an index up to which each is queried; a layer that lost many has as many gaps."""
_AT_ONCE = 64
"""Rows of an incomplete range that are checked one by one; larger ranges are split."""


def rows_without_index(uri: str) -> list[int] | None:
    """Return the ids that the spatial index of a layer in a GeoPackage lacks, between its first and last row.

    The index holds each row whose geometry is not empty. Counting its ids takes a tenth of the time for
    checking the geometries of a city, which takes longer than all else needed for a window. None
    where there is no such index, or rows were filtered or many deleted.
    """
    parts = QgsProviderRegistry.instance().decodeUri("ogr", uri)
    path = str(parts.get("path") or "")
    if not path.lower().endswith(".gpkg") or parts.get("subset"):
        return None
    try:
        with closing(sqlite3.connect(f"{Path(path).absolute().as_uri()}?mode=ro", uri=True)) as database:
            return _unindexed(database, str(parts.get("layerName") or ""))
    except sqlite3.Error:
        return None


def _unindexed(database: sqlite3.Connection, layer: str) -> list[int] | None:
    known = database.execute(
        "SELECT g.table_name, g.column_name, e.extension_name FROM gpkg_geometry_columns g "
        "LEFT JOIN gpkg_extensions e ON lower(e.table_name) = lower(g.table_name) "
        "AND lower(e.column_name) = lower(g.column_name) AND lower(e.extension_name) = 'gpkg_rtree_index' "
        "WHERE ? IN ('', g.table_name)",
        [layer],
    ).fetchall()
    if len(known) != 1 or known[0][2] is None:
        return None
    table, index = _quoted(known[0][0]), _quoted(f"rtree_{known[0][0]}_{known[0][1]}_rowid")
    # Separately, each is found at once.
    edges = f"SELECT (SELECT min(rowid) FROM {table}), (SELECT max(rowid) FROM {table})"  # nosec B608 # names
    first, last = database.execute(edges).fetchone()
    if first is None:
        return []
    (count,) = database.execute(f"SELECT count(*) FROM {index}").fetchone()  # nosec B608 # names
    if last - first + 1 - count > _MOST_GAPS:
        return None
    return list(_gaps(database, index, range(first, last + 1), count))


def _gaps(database: sqlite3.Connection, index: str, ids: range, count: int) -> Iterator[int]:
    """Yield those of ``ids`` that are not in ``index``, which has ``count`` of them."""
    if count == len(ids):
        return
    within = f"FROM {index} WHERE rowid BETWEEN ? AND ?"
    if len(ids) <= _AT_ONCE:
        there = {id for (id,) in database.execute(f"SELECT rowid {within}", [ids[0], ids[-1]])}  # nosec B608 # names
        yield from (id for id in ids if id not in there)
        return
    step = _AT_ONCE**2 if len(ids) > _AT_ONCE**2 else _AT_ONCE
    for begin in range(0, len(ids), step):
        some = ids[begin : begin + step]
        (own,) = database.execute(f"SELECT count(*) {within}", [some[0], some[-1]]).fetchone()  # nosec B608 # names
        yield from _gaps(database, index, some, own)


def subset_without_geometry(provider: str, uri: str) -> str:
    """Return the source of the features without geometry in the layer ``uri``, empty where there is none."""
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


# --- Signals when layers have to be read again ---

_CHANGES = (
    "afterCommitChanges",
    "afterRollBack",
    "crsChanged",
    "customPropertyChanged",
    "dataChanged",
    "dataSourceChanged",
    "layerModified",
    "subsetStringChanged",
    "willBeDeleted",
)
"""Signals of a layer after which its features, or their meaning, have changed; older QGIS lacks some."""


class LayerWatch(QObject):
    """Watches layers given to :meth:`watch`, until they are deleted or :meth:`remove`."""

    changed = pyqtSignal()
    """A watched layer has changed, or is about to be deleted."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._watched: dict[str, QgsVectorLayer] = {}

    def watch(self, layers: Iterable[QgsVectorLayer]) -> None:
        """Watch these layers in addition to those already watched."""
        for layer in layers:
            known = self._watched.get(layer.id())
            # A project that is read again has other layers under the same ids.
            if known is None or sip.isdeleted(known):
                self._watched[layer.id()] = layer
                for name in _signals_of(layer):
                    getattr(layer, name).connect(self._announce)

    def remove(self) -> None:
        """Stop watching layers."""
        for layer in self._watched.values():
            if not sip.isdeleted(layer):
                for name in _signals_of(layer):
                    getattr(layer, name).disconnect(self._announce)
        self._watched.clear()

    def _announce(self, *_what: object) -> None:
        self.changed.emit()


def _signals_of(layer: QgsVectorLayer) -> list[str]:
    return [name for name in _CHANGES if hasattr(layer, name)]


# --- Features of a layer read one after the other: those that count, with their geometry in metres ---


def each_feature(
    source: QgsFeatureSource, feedback: QgsFeedback, progress: float = 0.0
) -> Iterator[QgsFeature]:
    """Yield the features of ``source`` until cancelled; at the last one ``progress`` percent are done."""
    total = max(source.featureCount(), 1) if progress else 1
    step = max(total // 1000, 1)
    for number, feature in enumerate(source.getFeatures()):
        if feedback.isCanceled():
            return
        if progress and number % step == 0:
            feedback.setProgress(progress * number / total)
        yield feature


def parse_seconds(value: object) -> float | None:
    """Return seconds since 1970 from a date and time, seconds, or ISO 8601 (UTC without an offset)."""
    if isinstance(value, QDateTime):
        if value.timeSpec() == Qt.TimeSpec.LocalTime:
            # Without an offset, or read by QGIS 3.22, which drops it: a gateway exports UTC.
            value = QDateTime(value.date(), value.time(), Qt.TimeSpec.UTC)
        return value.toMSecsSinceEpoch() / 1000.0 if value.isValid() else None
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value) if math.isfinite(value) else None
    if not isinstance(value, str):
        return None
    try:
        at = datetime.fromisoformat(value.strip().replace("Z", "+00:00"))
    except ValueError:
        return None
    return (at if at.tzinfo else at.replace(tzinfo=timezone.utc)).timestamp()


class FeatureRow(NamedTuple):
    """One feature, whether the filter ``counts`` it, and its geometry in metres; None where it has none.

    ``notes`` are the problems; later readers add to them.
    """

    feature: QgsFeature
    counts: bool
    geometry: QgsGeometry | None
    notes: list[str]


@dataclass
class FeatureReader:
    """Yields every feature of the layer ``name``, transformed to the site by ``placing``, as FeatureRow.

    Without a filter ``counted`` all count. ``complete`` is false if cancelled.

    :raises LayerTypeError: at the end of a layer whose file is damaged.
    """

    name: str
    source: QgsFeatureSource | QgsAbstractFeatureSource
    placing: LayerToSiteTransform
    counted: FeatureFilter | None
    feedback: QgsFeedback
    progress: float = 0.0
    complete: bool = True

    def __iter__(self) -> Iterator[FeatureRow]:
        begin_reading()
        for feature in each_feature(self.source, self.feedback, self.progress):
            notes: list[str] = []
            counts = self.counted is None or self.counted.keeps(feature, notes)
            geometry = self.placing.of_feature(feature, notes) if counts else None
            yield FeatureRow(feature, counts, geometry, notes)
        self.complete = not self.feedback.isCanceled()
        # For a layer with a role, check_readable has checked that it exists.
        error = error_of_gdal() if isinstance(self.source, QgsFeatureSource) else ""
        if self.complete and error:
            raise _half_read(self.name, error)


# --- Warnings about features, grouped: a city has thousands that differ only in the feature ---

NAMED = 5
"""Number of features that a warning about several names."""
MOST_KINDS = 50
"""Number of kinds of warnings about one layer that are reported separately."""

_QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")
_NUMBER = re.compile(r"\d+(?:[.,]\d+)*(?:e[-+]?\d+)?")


@dataclass
class SomeFeatures:
    """The number of features, and the ids of the first ones."""

    count: int = 0
    first: list[int] = field(default_factory=list)

    def add(self, feature: int) -> None:
        """Count the feature with this id."""
        self.count += 1
        if len(self.first) < NAMED:
            self.first.append(feature)

    def __str__(self) -> str:
        shown = ", ".join(str(number) for number in self.first)
        if self.count > len(self.first):
            return tr("features {shown} and {more} more", shown=shown, more=self.count - len(self.first))
        return tr("features {shown}", shown=shown) if self.count > 1 else tr("feature {shown}", shown=shown)


@dataclass
class _Kind:
    """Notes that differ only in numbers and quoted values; ``notes`` are those of the first features."""

    features: SomeFeatures = field(default_factory=SomeFeatures)
    notes: list[str] = field(default_factory=list)
    alike: bool = True

    def add(self, feature: int, note: str) -> None:
        self.features.add(feature)
        if len(self.notes) < NAMED:
            self.notes.append(note)
        self.alike = self.alike and note == self.notes[0]

    def texts(self, layer: str) -> list[str]:
        """Return one warning, or one per feature where they are few and differ."""
        features = self.features
        if self.alike and features.count > 1:
            return [
                tr("Layer {layer}, {features}: {note}", layer=layer, features=features, note=self.notes[0])
            ]
        if features.count <= NAMED:
            return [
                tr("Layer {layer}, feature {id}: {note}", layer=layer, id=id, note=note)
                for id, note in zip(features.first, self.notes, strict=True)
            ]
        return [
            tr(
                "Layer {layer}, {features}; of the first: {note}",
                layer=layer,
                features=features,
                note=self.notes[0],
            )
        ]


class FeatureWarnings:
    """Warnings in the order of the first of each kind; many features of one kind become one warning."""

    def __init__(self) -> None:
        self._warnings: list[str | tuple[str, _Kind]] = []
        self._kinds: dict[str, dict[str, _Kind]] = {}
        self._others: dict[str, SomeFeatures] = {}

    def add(self, layer: str, feature: int, note: str) -> None:
        """Add ``note`` about the feature with this id."""
        kinds = self._kinds.setdefault(layer, {})
        pattern = _NUMBER.sub("0", _QUOTED.sub("''", note))
        if pattern not in kinds and len(kinds) >= MOST_KINDS:
            self._others.setdefault(layer, SomeFeatures()).add(feature)
            return
        if pattern not in kinds:
            kinds[pattern] = _Kind()
            self._warnings.append((layer, kinds[pattern]))
        kinds[pattern].add(feature, note)

    def add_text(self, text: str) -> None:
        """Add a warning about a layer as a whole."""
        self._warnings.append(text)

    def texts(self) -> list[str]:
        """Return every warning."""
        texts: list[str] = []
        for one in self._warnings:
            texts += [one] if isinstance(one, str) else one[1].texts(one[0])
        return texts + [
            tr("Layer {layer}: warnings of more kinds about {features}", layer=layer, features=features)
            for layer, features in self._others.items()
        ]
