"""The menu entry that shows the panel of observations."""

from __future__ import annotations

from qgis.gui import QgisInterface

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
            text="Observations",
            name="fleet_observations",
            tip="Objects and images that robots told of, to be accepted for the maps or rejected",
        )
