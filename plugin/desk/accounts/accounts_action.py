"""The menu entry that opens the operators' accounts."""

from __future__ import annotations

from qgis.gui import QgisInterface

from ...language import tr
from ..connection_menu import ConnectionMenu
from ..desk import Desk
from ..dialog_action import DialogAction
from .accounts_dialog import AccountsDialog


class AccountsAction(DialogAction):
    """The entry and its window."""

    def __init__(self, iface: QgisInterface, menu: str, connections: ConnectionMenu, desk: Desk):
        self._accounts = AccountsDialog(desk, iface.mainWindow())
        super().__init__(
            iface,
            menu,
            connections,
            self._accounts,
            icon="accounts.svg",
            text=tr("Accounts…"),
            name="fleet_accounts",
            tip=tr("Who may connect to the gateway and do what; takes a supervisor"),
        )

    def remove(self) -> None:
        self._accounts.close_tokens()
        super().remove()
