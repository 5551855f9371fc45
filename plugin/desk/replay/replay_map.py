"""A map of its own beside the live one: the same layers, and the robots as they were."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsProject
from qgis.gui import QgsMapCanvas, QgsMapToolPan
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QSize, QTimer
from qgis.PyQt.QtWidgets import QWidget

from ....robot_bridge.messages import SiteReport
from ...errors import PlacementError
from ..live.following import show_places
from ..live.live_view import FRAME_MS
from ..live.overlay import FleetOverlay
from ..live.plans import Plans
from ..live.scene import Placer, Scene
from ..live.trails import Trails
from ..live_layers import MARK, live_layers
from ..placement import Placement
from .history import History
from .past_commands import PastCommands

OWN_LAYER = "replay"
"""The kind of the live layer that is shown here; the others show what is now."""
AROUND = 10.0
"""Metres that are shown around what was driven."""
JUMP = 20.0
"""Seconds over which a robot's trail is not drawn as if it had been seen driving."""


class ReplayMap(QgsMapCanvas):
    """Follows the layers, the CRS and the rotation of ``live``; its view is its own."""

    def __init__(self, live: QgsMapCanvas, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_replay_map")
        self._live = live
        self._trails = Trails()
        self.overlay = FleetOverlay(self, self._trails)
        self._placer, self._plans = Placer(), Plans()
        self._placement: Placement | None = None
        self._site: SiteReport | None = None
        self._moment: float | None = None
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(FRAME_MS)
        self._soon.timeout.connect(self._go_on)
        self.extentsChanged.connect(self._soon.start)
        self._pan = QgsMapToolPan(self)
        self.setMapTool(self._pan)
        self.setCanvasColor(live.canvasColor())
        live.layersChanged.connect(self.follow)
        live.destinationCrsChanged.connect(self.follow)
        live.rotationChanged.connect(self.follow)

    def sizeHint(self) -> QSize:
        # A canvas would ask for more room than the live one has.
        return QSize(340, 300)

    def remove(self) -> None:
        """Draw nothing any more and leave the live map alone."""
        self._soon.stop()
        self._live.layersChanged.disconnect(self.follow)
        self._live.destinationCrsChanged.disconnect(self.follow)
        self._live.rotationChanged.disconnect(self.follow)
        self.stopRendering()
        self.setLayers([])
        self.unsetMapTool(self._pan)
        if not sip.isdeleted(self.overlay):
            self.scene().removeItem(self.overlay)

    def begin(self, site: SiteReport) -> None:
        """Show what the live map shows; robots of ``site`` follow."""
        self._site, self._placement, self._moment = site, None, None
        self._trails.clear()
        self._plans = Plans()
        self.follow()
        self.setExtent(self._live.extent())
        self.refresh()

    def show_all(self, history: History) -> None:
        """Show every place in ``history``, and its surroundings.

        :raises PlacementError: when the site has no place in the map's CRS.
        """
        if self._site is None or not len(history):
            return
        least, greatest = history.extent
        corners = np.array([least - AROUND, greatest + AROUND])
        show_places(self, self._place().to_map(corners))

    def follow(self, *_what: object) -> None:
        """Take over the live map's layers, CRS and rotation; what was driven lies above the layers."""
        self.setDestinationCrs(self._live.mapSettings().destinationCrs())
        self.setRotation(self._live.rotation())
        own = [one for one in live_layers(QgsProject.instance()) if one.customProperty(MARK) == OWN_LAYER]
        layers = own + [layer for layer in self._live.layers() if layer.customProperty(MARK) is None]
        if layers != self.layers():
            self.setLayers(layers)

    def show_moment(
        self, history: History, commands: PastCommands, moment: float, chosen: tuple[str, ...]
    ) -> None:
        """Draw robots, and what they were doing, as they were at ``moment``.

        :raises PlacementError: when the site has no place in the map's CRS.
        """
        if self._site is None:
            return
        robots = history.at(moment)
        if self._moment is None or not 0 <= moment - self._moment <= JUMP:
            self._trails.clear()
        self._moment = moment
        self._trails.extend(robots.xy, moment)
        plans = self._plans.of(commands.under_way_at(moment))
        rows = {
            name: row
            for name in {*chosen, *(p.robot for p in plans)}
            if (row := history.row(name)) is not None
        }
        scene = Scene(robots, moment, tuple(n for n in chosen if n in rows), plans, rows=rows)
        try:
            self.overlay.show_scene(self._placer.placed(scene, self._place()))
        except PlacementError:
            self.overlay.show_scene(None)
            raise
        self._soon.start()

    def show_nothing(self) -> None:
        """Draw no robots."""
        self._site = self._moment = None
        self.overlay.show_scene(None)

    def _go_on(self) -> None:
        """Have the moment as the map shows it now, and whole: while time is held nothing else follows."""
        self.overlay.prepare()
        if not self.overlay.is_whole:
            self._soon.start()

    def _place(self) -> Placement:
        way = self.mapSettings().destinationCrs(), QgsProject.instance().transformContext()
        if self._placement is None or not self._placement.leads_to(*way):
            self._placement = Placement(self._site, *way)
        return self._placement
