"""The GeoPackage beside the project that keeps the operator's cones when the project is saved."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProject, QgsVectorFileWriter, QgsVectorLayer
from qgis.PyQt.QtCore import QObject

from ..language import tr
from .cone_store import ConeStore
from .notices import Notices

TABLE = "cones"
IN_MEMORY = "memory"
"""The name of the provider whose features are gone when the project is closed."""


class ConeFile(QObject):
    """Moves the layer of cones from memory into a file when its project is saved.

    A layer that is in a file, here or wherever the user keeps it, is left alone. :meth:`remove` undoes the
    constructor.
    """

    def __init__(self, project: QgsProject, notices: Notices, parent: QObject | None = None):
        super().__init__(parent)
        self._project, self._notices = project, notices
        self._store = ConeStore(project)
        # Comes before the layers are written, with the source that they have then.
        project.writeProject.connect(self._keep_cones)

    def remove(self) -> None:
        """Let projects be saved without it."""
        self._project.writeProject.disconnect(self._keep_cones)

    def _keep_cones(self, *_document: object) -> None:
        layer = self._store.layer()
        if layer is None or layer.providerType() != IN_MEMORY:
            return
        path = _free_path(self._project)
        problem = tr("the project is not a file") if path is None else self._move(layer, path)
        if problem:
            self._notices.warning(
                tr(
                    "The cones of the layer {layer} are not saved with the project: {problem}. Export the "
                    "layer to a file before you close QGIS.",
                    layer=layer.name(),
                    problem=problem,
                )
            )

    def _move(self, layer: QgsVectorLayer, path: Path) -> str:
        """Write ``layer`` to ``path`` and let it be that file's; return what went wrong, if something did."""
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.driverName, options.layerName = "GPKG", TABLE
        # Of the format's versions the one that GDAL 3.6 and older read.
        options.datasourceOptions = ["VERSION=1.3"]
        context = self._project.transformContext()
        error, words, *_ = QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(path), context, options)
        if error != QgsVectorFileWriter.WriterError.NoError:
            return tr("{path} cannot be written ({words})", path=path, words=words)
        source = f"{path}|layername={TABLE}"
        # Before the layer in use lets go of the cones in memory.
        if not QgsVectorLayer(source, TABLE, "ogr").isValid():
            return tr("{path} cannot be read again", path=path)
        layer.setDataSource(source, layer.name(), "ogr", False)
        return ""


def _free_path(project: QgsProject) -> Path | None:
    """Return a file beside the project that is not there yet; None for a project that is no file."""
    if project.projectStorage() is not None or not project.absoluteFilePath():
        return None
    file = Path(project.absoluteFilePath())
    names = [f"{file.stem}_cones{number}.gpkg" for number in ("", *(f"_{k}" for k in range(2, 1000)))]
    return next((path for name in names if not (path := file.with_name(name)).exists()), None)
