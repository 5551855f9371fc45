"""Help: F1 explains what has the keyboard, and every topic is a heading of a guide."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.help import (
    ACCOUNTS,
    CONNECTIONS,
    DOCS,
    OPTIONS,
    SITES,
    START,
    TOPICS,
    HelpWindow,
    heading_link,
    topic_of,
)
from qgis.PyQt.QtCore import Qt, QUrl
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLineEdit, QTableView, QWidget


def test_f1_explains_what_has_the_keyboard(plugin, iface):
    panel = plugin.window.dock
    panel.show()
    panel.findChild(QLineEdit, "fleet_operator").setFocus()
    QTest.keyClick(panel.findChild(QLineEdit, "fleet_operator"), Qt.Key.Key_F1)
    window = iface.findChild(HelpWindow)
    assert window.topic == TOPICS["fleet_operator"]
    panel.findChild(QTableView, "fleet_robot_table").setFocus()
    QTest.keyClick(panel.findChild(QTableView, "fleet_robot_table"), Qt.Key.Key_F1)
    assert window.topic == TOPICS["fleet_robot_table"]
    assert window.browser.verticalScrollBar().value() > 0
    assert len(iface.findChildren(HelpWindow)) == 1


def test_a_link_leads_to_another_page(plugin, iface):
    iface.plugin_help.actions()[-1].trigger()
    window = iface.findChild(HelpWindow)
    assert window.topic == START
    window._follow(QUrl("roads.md#closed-roads"))
    assert (window.topic.page, window.topic.heading) == ("roads", "closed-roads")
    assert "Closed roads" in window.browser.toPlainText()


@pytest.mark.parametrize(
    "topic", sorted({START, CONNECTIONS, OPTIONS, ACCOUNTS, SITES, *TOPICS.values()}, key=str), ids=str
)
def test_every_topic_is_a_heading_of_a_guide(topic):
    text = (DOCS / f"{topic.page}.md").read_text(encoding="utf-8")
    headings = [heading_link(line.lstrip("# ")) for line in text.splitlines() if line.startswith("#")]
    assert not topic.heading or topic.heading in headings


def test_every_widget_of_a_topic_is_in_the_panel(plugin):
    for name in TOPICS:
        widget = plugin.window.dock.findChild(QWidget, name)
        assert widget is not None, name
        assert topic_of(widget) == TOPICS[name]
