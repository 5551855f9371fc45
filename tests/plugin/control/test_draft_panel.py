"""The part of the panel about the draft: its buttons are always there, usable when they can do something."""

from __future__ import annotations

from fleet_supervisor.plugin.control.pending_command import CONE, Findings, PendingCommand
from qgis.PyQt.QtWidgets import QToolButton


def test_the_buttons_for_changes_stay_and_are_usable_while_there_is_something_to_take_back(at_desk):
    drafts = at_desk.desk.drafts
    undo = at_desk.dock.findChild(QToolButton, "fleet_undo_button")
    assert undo.isVisible() and not undo.isEnabled()
    for x in (60.0, 61.0):
        drafts.set_command(PendingCommand("r1", CONE, ((x, 50.0),), Findings()))
    assert undo.isVisible() and undo.isEnabled()
    drafts.done()
    assert undo.isVisible() and not undo.isEnabled()
