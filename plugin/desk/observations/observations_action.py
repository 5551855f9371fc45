"""The menu entry that shows the panel of observations."""

from __future__ import annotations

from qgis.gui import QgisInterface

from ...language import tr
from ..desk import Desk
from ..dock_action import DockAction
from .observation_dock import ObservationDock


class ObservationsAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: Desk):
        super().__init__(
            iface,
            menu,
            ObservationDock(desk, iface.mainWindow()),
            icon="observations.svg",
            text=tr("Observations"),
            name="fleet_observations",
            tip=tr("Objects and images that robots told of, to be accepted for the maps or rejected"),
        )
