"""What QGIS makes of the actions' tool tips when it adds their shortcuts."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.ui.actions import EMERGENCY_KEYS, Actions
from qgis.gui import QgsGui
from qgis.PyQt.QtCore import QObject


@pytest.fixture
def actions(qgis_app):
    owner = QObject()
    yield Actions(owner)
    owner.deleteLater()


def test_qgis_takes_no_words_out_of_a_tip(actions):
    manager = QgsGui.shortcutsManager()
    for action in actions.all():
        if action is actions.emergency:
            # Not QGIS's to change: its two keys are named in the text.
            assert all(key in action.toolTip() for key in EMERGENCY_KEYS)
            continue
        tip = action.toolTip()
        manager.registerAction(action, "")
        try:
            assert tip in action.toolTip()
        finally:
            manager.unregisterAction(action)
