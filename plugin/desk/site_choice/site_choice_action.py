"""The menu entry that opens the choice of the site."""

from __future__ import annotations

from qgis.gui import QgisInterface

from ...language import tr
from ..connection_menu import ConnectionMenu
from ..desk import Desk
from ..dialog_action import DialogAction
from .site_choice_dialog import SiteChoiceDialog


class SiteChoiceAction(DialogAction):
    """The entry and its window."""

    def __init__(self, iface: QgisInterface, menu: str, connections: ConnectionMenu, desk: Desk):
        super().__init__(
            iface,
            menu,
            connections,
            SiteChoiceDialog(desk, iface.mainWindow()),
            icon="sites.svg",
            text=tr("Site…"),
            name="fleet_site_choice",
            tip=tr("Which of the published sites the gateway serves; takes a supervisor"),
        )
