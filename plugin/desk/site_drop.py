"""A published site that is dropped onto the QGIS window is loaded, from QGIS's browser panel, too."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsMimeDataUtils, QgsProject
from qgis.gui import QgisInterface, QgsCustomDropHandler
from qgis.PyQt.QtCore import QMimeData, QTimer

from ..errors import FleetError
from ..language import tr, tr_count
from ..sites.published_layers import LoadedSite, load_site, loaded_already, site_folder
from .notices import Notices

WHOLE = ("directory", "collection")
"""What the browser panel calls a folder, and a GeoPackage with all that is in it."""


class SiteDrop(QgsCustomDropHandler):
    """Takes a site's folder, its site.toml or its site.gpkg; everything else is left to QGIS.

    :meth:`remove` undoes the constructor.
    """

    def __init__(self, iface: QgisInterface, project: QgsProject, notices: Notices):
        super().__init__()
        self._iface, self._project, self._notices = iface, project, notices
        iface.registerCustomDropHandler(self)

    def remove(self) -> None:
        """Take nothing more that is dropped."""
        self._iface.unregisterCustomDropHandler(self)
        self.deleteLater()

    def handleMimeDataV2(self, data: QMimeData) -> bool:
        # Not as files: what comes from the browser panel names data sources.
        sources = QgsMimeDataUtils.decodeUriList(data) if QgsMimeDataUtils.isUriList(data) else []
        folders = [site_folder(Path(one.uri)) for one in sources if one.layerType in WHOLE]
        if not folders or None in folders or len(folders) < len(sources):
            return False
        for folder in folders:
            self._load(folder)
        return True

    def handleFileDrop(self, file: str) -> bool:
        folder = site_folder(Path(file))
        if folder is None:
            return False
        self._load(folder)
        return True

    def _load(self, folder: Path) -> None:
        """Load the site, or say why not."""
        known = loaded_already(folder, self._project)
        if known:
            names = ", ".join(layer.name() for layer in known)
            self._notices.info(
                tr("The site in {folder} is in the project already: {names}.", folder=folder, names=names)
            )
            return
        was_empty = not self._project.mapLayers()
        try:
            site = load_site(folder, self._project)
        except FleetError as error:
            self._notices.error(error)
            return
        self._notices.info(_in_words(site))
        if was_empty:
            # QGIS takes over the site's CRS in a moment; what was shown whole before would be small then.
            QTimer.singleShot(0, self._iface.mapCanvas().zoomToFullExtent)


def _in_words(site: LoadedSite) -> str:
    text = tr_count(len(site.layers), "{site}: 1 layer loaded.", "{site}: %n layers loaded.", site=site.name)
    if site.without_role:
        text += tr(
            " Without a role, since other layers of the project have it: {layers}. Plugins > Fleet "
            "Supervisor > Layer roles changes that.",
            layers=", ".join(site.without_role),
        )
    return text
