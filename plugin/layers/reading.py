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
"""The provider whose features are in memory."""
LayerFeatureSource = QgsAbstractFeatureSource | QgsVectorLayer


# --- Whether a layer can still be read: QGIS keeps it as it was opened, and does not report a missing file


def deleted_in(layer: QgsVectorLayer) -> int:
    """Return the number of stored features of ``layer`` that unsaved changes delete."""
    changes = layer.editBuffer()
    return 0 if changes is None else len(changes.deletedFeatureIds())


def has_features(features: LayerFeatureSource) -> bool:
    """Return whether anything can be read; from any thread."""
    request = QgsFeatureRequest().setLimit(1).setFlags(QgsFeatureRequest.Flag.NoGeometry).setNoAttributes()
    return any(True for _ in features.getFeatures(request))


def is_empty(provider: str, stored: str, deleted: int = 0) -> bool:
    """Return whether a layer from which nothing can be read really has no features but the ``deleted`` ones.

    A layer whose file or database is gone, or damaged, since it was opened is still valid, has its count, and
    reads as empty. It is opened again, from any thread: then a layer emptied by another program since reports
    no features.
    """
    layer = open_again(provider, stored)
    return layer.isValid() and layer.featureCount() <= deleted


def open_again(provider: str, stored: str) -> QgsVectorLayer:
    """Return the layer stored at ``stored``, opened again without its style."""
    options = QgsVectorLayer.LayerOptions()
    options.loadDefaultStyle = False
    return QgsVectorLayer(stored, "", provider, options)


FileState = tuple[int, ...] | None
"""The identity of a file, to detect its replacement; None where there is none."""


def file_of(layer: QgsMapLayer) -> str:
    """Return the path of the file that ``layer`` is read from, empty where it is none."""
    if not isinstance(layer, QgsVectorLayer) or layer.providerType() != "ogr":
        return ""
    return str(QgsProviderRegistry.instance().decodeUri("ogr", layer.source()).get("path") or "")


def file_state(path: str) -> FileState:
    """Return the state of the file ``path``, from a thread that may hang; None without a path, too."""
    if not path:
        return None
    try:
        found = Path(path).stat()
    except (OSError, ValueError):
        return None
    # A GeoPackage is written to even by readers.
    changed = () if path.lower().endswith((".gpkg", ".sqlite")) else (found.st_mtime_ns,)
    return found.st_dev, found.st_ino, found.st_size, *changed


def is_gone(path: str) -> bool:
    """Return whether the file ``path`` is missing, from a thread that may hang.

    QGIS goes on reading what it has open. False for what GDAL alone finds, such as a file in an archive.
    """
    if not path or path.startswith("/vsi") or not Path(path).is_absolute():
        return False
    try:
        return not Path(path).exists()
    except (OSError, ValueError):
        return True


def begin_reading() -> None:
    """Clear GDAL's errors in this thread before a layer is read, for :func:`check_readable`."""
    if (gdal := _gdal()) is not None:
        gdal.ErrorReset()


def error_of_gdal() -> str:
    """Return the last error in this thread since :func:`begin_reading`, empty where there is none."""
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


# --- Reading in the background, so that the window's thread waits for no layer ---


T = TypeVar("T")


def thread_feedback(go_on: Callable[[], bool]) -> QgsProcessingFeedback:
    """Return a feedback for reading in a thread: each check for cancellation counts as progress."""

    class ThreadFeedback(QgsProcessingFeedback):
        def isCanceled(self) -> bool:
            return not go_on()

    return ThreadFeedback(False)


class OneAtATime:
    """Reads a layer for steps in the window's thread, in one thread after the other."""

    def __init__(self) -> None:
        self._turns = ReadingTurns()

    def read(self, name: str, reader: Reader[T]) -> Steps[T]:
        """Return the result of ``reader`` for the layer ``name``.

        :raises LayerReadingError: when nothing has come from it within the time limit.
        """
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
