"""Every dialog of the plugin, with something to say; to be imported once the language is chosen."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

from fleet_supervisor.plugin.admin.accounts_dialog import (
    Account,
    AccountsDialog,
    ChangeRoleDialog,
    NewAccountDialog,
    RenewTokenDialog,
    TokenDialog,
    confirm_revocation,
)
from fleet_supervisor.plugin.admin.supervision import (
    RecordingsDialog,
    RemovalDialog,
    SiteChoiceDialog,
    confirm_site_choice,
)
from fleet_supervisor.plugin.control.pending_command import CONE, PendingCommand
from fleet_supervisor.plugin.help import START, HelpWindow
from fleet_supervisor.plugin.layers.role_editor.roles_dialog import RolesDialog
from fleet_supervisor.plugin.map.tools.click_tools import ClosureDialog
from fleet_supervisor.plugin.panel.alarms.alarm_panel import AlarmLogDialog, ThresholdsDialog
from fleet_supervisor.plugin.panel.alarms.rules import Thresholds
from fleet_supervisor.plugin.panel.command_sources import CoordinatesDialog
from fleet_supervisor.plugin.panel.emergency import ClearDialog
from fleet_supervisor.plugin.panel.pending_command_panel import OverrideDialog
from fleet_supervisor.plugin.settings.connections_widget import ConnectionDialog, ConnectionsDialog
from fleet_supervisor.plugin.settings.profile import Connections, GatewayConnection
from fleet_supervisor.plugin.ui.language import tr
from fleet_supervisor.robot_bridge.core.messages.administration import (
    NewToken,
    OperatorReport,
    SiteOffer,
    TokenState,
)
from fleet_supervisor.robot_bridge.core.messages.base import Role
from fleet_supervisor.robot_bridge.core.messages.safety import EmergencyReport
from qgis.core import QgsProject
from qgis.PyQt.QtWidgets import QDialog

ROOT = Path(__file__).resolve().parents[3]
Dialogs = Iterator[tuple[str, QDialog]]


def dialogs(window, desk_window) -> Dialogs:
    """Yield each with its name; ``window`` is QGIS's."""
    yield from _of_connections(window)
    yield from _of_the_desk(window, desk_window)
    yield from _of_accounts(window, desk_window)
    yield from _of_sites(window, desk_window)
    yield from _of_the_menu(window)


def _of_connections(window) -> Dialogs:
    site = GatewayConnection("Proving ground", "wss://gateway.example.org:8765/desk", "anna")
    Connections().store(site)
    yield "connection", ConnectionDialog(site, Connections(), window)
    yield "connection_new", ConnectionDialog(GatewayConnection("", ""), Connections(), window)
    yield "connections", ConnectionsDialog(window)


def _of_the_desk(window, desk_window) -> Dialogs:
    yield "thresholds", ThresholdsDialog(Thresholds(), window)
    yield "alarm_log", AlarmLogDialog(window)
    yield "closure", ClosureDialog(window)
    yield "coordinates", CoordinatesDialog(desk_window.desk, window)
    found = "A cone target of r2 is 0.3 m from it", "It is on the obstacle bin-4"
    draft, then = PendingCommand("r1", CONE, ((60.0, 50.0),)).in_words(), tr("Nothing is sent yet.")
    yield "override", OverrideDialog(draft, found, then, window, is_safe=False)
    queue = tr("the queue of {robot}", robot="r1")
    then = tr("The plan is sent on at once, and robots set off.")
    yield "override_plan", OverrideDialog(queue, found, then, window, is_safe=True)
    stop = EmergencyReport(True, "s1", time.time(), "anna", robots=5, waiting=["r1", "r2"])
    yield "clear", ClearDialog(stop, window)
    gone = [f"robot-north-{k:03}" for k in range(30)]
    yield "removal", RemovalDialog(gone[:2], gone, window)
    yield "recordings", RecordingsDialog(desk_window.desk, window)


def _of_accounts(window, desk_window) -> Dialogs:
    yield "accounts", AccountsDialog(desk_window.desk, window)
    own = Account(OperatorReport("Ada", Role.SUPERVISOR, time.time(), TokenState.VALID), is_own=True)
    yield "new_account", NewAccountDialog(True, window)
    yield "role", ChangeRoleDialog(own, window)
    yield "new_token", RenewTokenDialog(own, window)
    yield "revocation", confirm_revocation(own, window, lambda: None)
    made = NewToken("Ada", Role.SUPERVISOR, f"fleet_op_{0:043d}", time.time())
    yield "token", TokenDialog(made, "wss://gateway:8765/desk", ends_link=True, parent=window)
    yield "token_here", TokenDialog(made, "ws://127.0.0.1:8765/desk", ends_link=True, parent=window)


def _of_sites(window, desk_window) -> Dialogs:
    yield "sites", SiteChoiceDialog(desk_window.desk, window)
    offer = SiteOffer("south", False, "south", "South field", 1)
    yield "site_question", confirm_site_choice(offer, window, lambda: None)


def _of_the_menu(window) -> Dialogs:
    help_window = HelpWindow(window)
    help_window.show_topic(START)
    yield "help", help_window
    QgsProject.instance().read(str(ROOT / "resources" / "sample_site" / "sample_site.qgz"))
    yield "roles", RolesDialog(QgsProject.instance(), window)
