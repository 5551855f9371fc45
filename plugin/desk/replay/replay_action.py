"""The menu entry that shows the replay."""

from __future__ import annotations

from qgis.gui import QgisInterface

from ...language import tr
from ..desk import Desk
from ..dock_action import DockAction
from .replay_dock import ReplayDock


class ReplayAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: Desk):
        super().__init__(
            iface,
            menu,
            ReplayDock(desk, iface.mainWindow()),
            icon="replay.svg",
            text=tr("Replay"),
            name="fleet_replay",
            tip=tr("Play what robots did, on a map beside the live one"),
        )
