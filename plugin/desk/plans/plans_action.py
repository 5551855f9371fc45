"""The menu entry that shows the panel of cone plans."""

from __future__ import annotations

from qgis.gui import QgisInterface

from ...language import tr
from ..desk import Desk
from ..dock_action import DockAction
from .plan_dock import PlanDock


class PlansAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: Desk):
        super().__init__(
            iface,
            menu,
            PlanDock(desk, iface.mainWindow()),
            icon="assign_cones.svg",
            text=tr("Cone plan"),
            name="fleet_plan_panel",
            tip=tr("Plan which robot places or collects which cone, send it, watch it; the as-placed report"),
        )
