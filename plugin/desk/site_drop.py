"""A published site that is dropped onto the QGIS window is loaded."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProject
from qgis.gui import QgisInterface, QgsCustomDropHandler

from ..errors import FleetError
from ..language import tr
from ..sites.published_layers import LoadedSite, load_site, loaded_already, site_folder
from .notices import Notices


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

    def handleFileDrop(self, file: str) -> bool:
        folder = site_folder(Path(file))
        if folder is None:
            return False
        known = loaded_already(folder, self._project)
        if known:
            names = ", ".join(layer.name() for layer in known)
            self._notices.info(
                tr("The site in {folder} is in the project already: {names}.", folder=folder, names=names)
            )
            return True
        was_empty = not self._project.mapLayers()
        try:
            site = load_site(folder, self._project)
        except FleetError as error:
            self._notices.error(error)
            return True
        self._notices.info(_in_words(site))
        if was_empty:
            self._iface.mapCanvas().zoomToFullExtent()
        return True


def _in_words(site: LoadedSite) -> str:
    text = tr("{site}: {count} layers loaded.", site=site.name, count=len(site.layers))
    if site.without_role:
        text += tr(
            " {layers} have no role: other layers of the project have it. Plugins > Fleet "
            "Supervisor > Layer roles changes that.",
            layers=", ".join(site.without_role),
        )
    return text
