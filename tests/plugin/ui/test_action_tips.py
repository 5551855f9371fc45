"""Tool tips: with the shortcuts that QGIS adds, and of texts that others wrote."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.ui.actions import EMERGENCY_KEYS, Actions
from fleet_supervisor.plugin.ui.steady_widgets import ElidedText, ScrollingText
from fleet_supervisor.plugin.ui.tables import TextModel
from qgis.gui import QgsGui
from qgis.PyQt import QtGui
from qgis.PyQt.QtCore import QObject, Qt
from qgis.PyQt.QtGui import QTextDocument


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


is_rich = getattr(Qt, "mightBeRichText", None) or QtGui.Qt.mightBeRichText


def shown_text(tip):
    """Return what Qt shows of a tool tip."""
    document = QTextDocument()
    (document.setHtml if is_rich(tip) else document.setPlainText)(tip)
    return document.toPlainText()


@pytest.mark.parametrize(
    "text", ['<img src="file:///etc/motd"> a <b>cone</b>\nat & in 3 <  4', "a &lt; b, 100 %\nand so on", ""]
)
def test_a_text_of_a_robot_is_shown_in_tips_as_it_is(qgis_app, text):
    model = TextModel(["What"], lambda row: [row])
    model.show_rows([text])
    scrolling = ScrollingText("text", lines=2)
    scrolling.setText(text)
    tips = [model.index(0, 0).data(Qt.ItemDataRole.ToolTipRole), ElidedText("text", text).toolTip()]
    for tip in (*tips, scrolling.toolTip()):
        assert shown_text(tip) == text
        assert "<img" not in tip
