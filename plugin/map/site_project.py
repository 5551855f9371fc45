"""Project of the site: whether the open one fits the gateway's site, and published sites dropped in."""

from __future__ import annotations

import math
from pathlib import Path

from qgis.core import QgsCoordinateReferenceSystem, QgsMimeDataUtils, QgsProject
from qgis.gui import QgisInterface, QgsCustomDropHandler
from qgis.PyQt.QtCore import QMimeData, QObject, QTimer, pyqtSignal

from ...robot_bridge.core.sites.frame import SiteFrame
from ..control.messages import MessageBar
from ..gateway_client.fleet_state import FleetState
from ..layers.crs import own_frame
from ..layers.live_layers import ProjectWatch
from ..layers.publishing.publication import LoadedSite, load_site, loaded_already, site_folder
from ..layers.site_transform import frame_of
from ..ui.errors import FleetError
from ..ui.language import tr, tr_count

SAME_PLACE = 0.01
"""Metres up to which two origins are one."""
SAME_ANGLE = 1e-6
"""Radians up to which two rotations are one."""


class ProjectMatch(QObject):
    """Tells of a project whose variables have another site frame than the site that is served.

    Robots are shown where they are all the same; what is checked before a command goes out, and what raises
    alarms, are the project's own roads, keepouts and obstacles.
    """

    differs = pyqtSignal(str)
    """What to tell the operator."""
    over = pyqtSignal(str)
    """What was told is not so any more."""

    def __init__(self, state: FleetState, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._state, self._project = state, project
        self._posted = ""
        self._watch = ProjectWatch(project, self)
        self._watch.opened.connect(self._compare)
        state.site_changed.connect(self._compare)

    def remove(self) -> None:
        """Compare no more."""
        self._watch.remove()

    def _compare(self) -> None:
        if self._posted:
            self.over.emit(self._posted)
        self._posted = ""
        site, mine = self._state.site, own_frame(self._project)
        if site is None or mine is None or _is_one(mine, frame_of(site)):
            return
        self._posted = tr(
            "This project is not that of site {site}: its variables have another origin, CRS or rotation. "
            "Checks and alarms go by the layers of this project: open the site's.",
            site=site.name,
        )
        self.differs.emit(self._posted)


def _is_one(a: SiteFrame, b: SiteFrame) -> bool:
    crs = [QgsCoordinateReferenceSystem(frame.crs) for frame in (a, b)]
    turned = math.remainder(a.rotation - b.rotation, math.tau)
    return crs[0] == crs[1] and math.dist(a.origin, b.origin) < SAME_PLACE and abs(turned) < SAME_ANGLE


WHOLE = ("directory", "collection")
"""What the browser panel calls a folder, and a GeoPackage with all that is in it."""


class SiteDropHandler(QgsCustomDropHandler):
    """Takes a site's folder, its site.toml or its site.gpkg; everything else is left to QGIS.

    :meth:`remove` undoes the constructor.
    """

    def __init__(self, iface: QgisInterface, project: QgsProject, notices: MessageBar):
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
