"""Reading of layers whose source may be gone, damaged or replaced, or may not answer."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from qgis.core import (
    QgsAbstractFeatureSource,
    QgsFeatureRequest,
    QgsMapLayer,
    QgsProcessingFeedback,
    QgsProviderRegistry,
    QgsVectorLayer,
)

from ..ui.errors import LayerReadingError
from ..ui.language import tr
from ..ui.scheduling import STALLED_AFTER, Reader, ReadingTurns, StalledError, Steps

IN_MEMORY = "memory"
"""The provider whose features are at hand at once."""
LayerFeatureSource = QgsAbstractFeatureSource | QgsVectorLayer


# --- Whether a layer can still be read: QGIS keeps one as it was opened, and tells of no file that is gone


def deleted_in(layer: QgsVectorLayer) -> int:
    """Return how many of the stored features of ``layer`` are deleted by changes that are not saved."""
    changes = layer.editBuffer()
    return 0 if changes is None else len(changes.deletedFeatureIds())


def has_features(features: LayerFeatureSource) -> bool:
    """Tell whether anything can be read; from any thread."""
    request = QgsFeatureRequest().setLimit(1).setFlags(QgsFeatureRequest.Flag.NoGeometry).setNoAttributes()
    return any(True for _ in features.getFeatures(request))


def is_empty(provider: str, stored: str, deleted: int = 0) -> bool:
    """Tell whether a layer of which nothing can be read has nothing but what was ``deleted``.

    One whose file or database is gone, or damaged, since it was opened is valid, has its count, and reads as
    an empty one. It is opened once more, from any thread: one that was emptied by another program since then
    says so.
    """
    layer = open_again(provider, stored)
    return layer.isValid() and layer.featureCount() <= deleted


def open_again(provider: str, stored: str) -> QgsVectorLayer:
    """Return the layer that is ``stored``, opened once more without its style."""
    options = QgsVectorLayer.LayerOptions()
    options.loadDefaultStyle = False
    return QgsVectorLayer(stored, "", provider, options)


FileState = tuple[int, ...] | None
"""What tells a file from one that has taken its place; None where there is none."""


def file_of(layer: QgsMapLayer) -> str:
    """Return the path of the file that ``layer`` is read from, nothing where it is none."""
    if not isinstance(layer, QgsVectorLayer) or layer.providerType() != "ogr":
        return ""
    return str(QgsProviderRegistry.instance().decodeUri("ogr", layer.source()).get("path") or "")


def file_state(path: str) -> FileState:
    """Return how the file ``path`` is, from a thread that may hang; None without a path, too."""
    if not path:
        return None
    try:
        found = Path(path).stat()
    except (OSError, ValueError):
        return None
    # A GeoPackage is written to by who only reads it.
    changed = () if path.lower().endswith((".gpkg", ".sqlite")) else (found.st_mtime_ns,)
    return found.st_dev, found.st_ino, found.st_size, *changed


def begin_reading() -> None:
    """Forget what GDAL found wrong in this thread before a layer is read, for :func:`check_readable`."""
    if (gdal := _gdal()) is not None:
        gdal.ErrorReset()


def error_of_gdal() -> str:
    """Return what went wrong last in this thread since :func:`begin_reading`, nothing where nothing did."""
    gdal = _gdal()
    failed = gdal is not None and gdal.GetLastErrorType() >= gdal.CE_Failure
    return str(gdal.GetLastErrorMsg() or "GDAL") if failed else ""


def _gdal() -> Any:
    """Return GDAL by which QGIS reads files, None where its Python bindings are missing."""
    try:
        from osgeo import gdal
    except ImportError:
        return None
    return gdal


# --- Reading beside the window's thread, which waits for no layer ---


T = TypeVar("T")


def thread_feedback(go_on: Callable[[], bool]) -> QgsProcessingFeedback:
    """Return the feedback of what reads in a thread: who asks whether it is cancelled makes progress."""

    class ThreadFeedback(QgsProcessingFeedback):
        def isCanceled(self) -> bool:
            return not go_on()

    return ThreadFeedback(False)


class OneAtATime:
    """Reads a layer for steps of the window's thread, in one thread after the other."""

    def __init__(self) -> None:
        self._turns = ReadingTurns()

    def read(self, name: str, provider: str, reader: Reader[T]) -> Steps[T]:
        """Return what ``reader`` reads of the layer ``name``.

        :raises LayerReadingError: when nothing has come from it for as long as anybody waits.
        """
        if provider == IN_MEMORY:
            return reader.read(lambda: True)
        try:
            return (yield from self._turns.read(reader))
        except StalledError as error:
            raise LayerReadingError(
                tr(
                    "The layer {layer} has not answered for {seconds:g} s. Bring its server or drive back "
                    "and try again.",
                    layer=name,
                    seconds=STALLED_AFTER,
                )
            ) from error
