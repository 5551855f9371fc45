"""Robots that are gone are removed at the desk: one, or all of them, after a question."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.plugin.admin.supervision import RemovalDialog
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QComboBox, QDialog, QLabel, QLineEdit, QPushButton

LEFT = Qt.MouseButton.LeftButton


def connect_as(window, gateway, wait, role):
    window.actions.connect.trigger()
    wait(lambda: not gateway._sockets, what="the end of the link")
    gateway.who = {"operator": "anna", "role": role}
    window.actions.connect.trigger()
    wait(lambda: window.desk.state.link.role == role, what="the link")


@pytest.fixture
def gone(at_desk, gateway, make_robot, wait, iface):
    """r1 and r2 are heard; lost are 60 robots, and one is offline. Who is at the desk is a supervisor."""
    connect_as(at_desk, gateway, wait, "supervisor")
    gateway.show(
        *(make_robot(f"old-{k:02}", 10, 10, age=99.0, state=RobotState.LOST) for k in range(60)),
        make_robot("stored", 20, 20, age=99.0, state=RobotState.OFFLINE, stopped=True),
    )
    wait(lambda: at_desk.dock.table.model().rowCount() == 63, what="the robots in the table")
    gateway.answers["remove_robots"] = lambda params: {"result": {"removed": params["robots"], "kept": []}}
    return at_desk


@pytest.fixture
def asked(gone, iface):
    """Opens the question, with these robots selected, by the key in the table."""

    def ask(*selected):
        gone.desk.selection.select_all(selected)
        gone.dock.table.setFocus()
        QTest.keyClick(gone.dock.table, Qt.Key.Key_Delete)
        return iface.mainWindow().findChild(RemovalDialog)

    return ask


def choices(dialog):
    box = dialog.findChild(QComboBox, "fleet_removal_which")
    return box, [box.itemText(k) for k in range(box.count())]


def names(dialog):
    return dialog.findChild(QLabel, "fleet_removal_names").text()


def confirm(dialog):
    QTest.mouseClick(dialog.findChild(QPushButton, "fleet_removal_confirm"), LEFT)


def test_one_that_is_selected_is_removed_with_the_reason(asked, gone, gateway, iface, wait):
    dialog = asked("old-07")
    _, offered = choices(dialog)
    assert offered == ["the selected one", "all 61 that are lost or offline"]
    assert names(dialog) == "old-07"
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_removal_reason"), "sold")
    assert gateway.requests_of("remove_robots") == []
    confirm(dialog)
    wait(lambda: gateway.requests_of("remove_robots"), what="the request")
    assert gateway.requests_of("remove_robots") == [{"robots": ["old-07"], "reason": "sold"}]
    wait(lambda: any("1 robot was removed: old-07" in text for text in iface.texts()), what="the word of it")


def test_all_that_are_lost_or_offline_are_removed_together(asked, gateway, iface, wait):
    dialog = asked("r1", "old-07")
    box, offered = choices(dialog)
    assert (offered[0], names(dialog)) == ("the selected one", "old-07")
    button = dialog.findChild(QPushButton, "fleet_removal_confirm")
    before = button.pos()
    box.setCurrentIndex(1)
    assert names(dialog) == "old-00, old-01, old-02, old-03, old-04, old-05, old-06, old-07, and 53 more"
    QTest.qWait(10)
    assert button.pos() == before
    confirm(dialog)
    wait(lambda: gateway.requests_of("remove_robots"), what="the request")
    (asked_for,) = gateway.requests_of("remove_robots")
    assert asked_for["robots"] == [*(f"old-{k:02}" for k in range(60)), "stored"]
    wait(lambda: any("61 robots were removed" in text for text in iface.texts()), what="the word of it")


def test_who_is_back_meanwhile_is_named(asked, gateway, iface, wait):
    back = {"robot": "old-01", "reason": "robot 'old-01' is fresh"}
    gateway.answers["remove_robots"] = lambda _: {"result": {"removed": ["old-02"], "kept": [back]}}
    confirm(asked("old-01", "old-02"))
    told = "1 robot was not removed: robot 'old-01' is fresh"
    wait(lambda: any(told in text for text in iface.texts()), what="who was not removed")


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Escape])
def test_enter_and_escape_remove_nobody(asked, gateway, key):
    dialog = asked("old-01")
    QTest.keyClick(dialog, key)
    assert not dialog.isVisible()
    QTest.qWait(50)
    assert gateway.requests_of("remove_robots") == []


def test_a_link_to_the_same_fleet_again_leaves_the_question_and_its_reason(asked, gone, gateway, wait):
    dialog = asked("old-01")
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_removal_reason"), "sold")
    connect_as(gone, gateway, wait, "supervisor")
    assert dialog.isVisible()
    confirm(dialog)
    wait(lambda: gateway.requests_of("remove_robots"), what="the request")
    assert gateway.requests_of("remove_robots") == [{"robots": ["old-01"], "reason": "sold"}]


def test_at_another_fleet_the_question_is_gone(asked, gone, gateway, site, wait):
    dialog, closed = asked("old-01"), []
    dialog.finished.connect(closed.append)
    gateway.site = replace(site, id="other", name="Other")
    connect_as(gone, gateway, wait, "supervisor")
    wait(lambda: closed == [QDialog.DialogCode.Rejected], what="the end of the question")
    assert gateway.requests_of("remove_robots") == []


def test_an_unloaded_plugin_leaves_no_question(asked, gone, plugin):
    dialog = asked("old-01")
    plugin.unload()
    assert not dialog.isVisible()


def test_what_the_gateway_refuses_is_said(asked, gateway, iface, wait):
    gateway.refuse["remove_robots"] = "remove_robots: an emergency stop is in force; clear it first"
    confirm(asked("old-01"))
    wait(lambda: any("an emergency stop is in force" in text for text in iface.texts()), what="the refusal")


def test_who_may_not_is_told_so_and_nothing_is_asked(at_desk, gateway, iface, wait):
    connect_as(at_desk, gateway, wait, "operator")
    iface.findChild(QAction, "fleet_remove_robots").trigger()
    assert iface.mainWindow().findChild(RemovalDialog) is None
    assert any("This takes a supervisor" in text for text in iface.texts())


def test_where_nobody_is_gone_it_says_so(at_desk, gateway, iface, wait):
    connect_as(at_desk, gateway, wait, "supervisor")
    iface.findChild(QAction, "fleet_remove_robots").trigger()
    assert any("No robot is lost or offline" in text for text in iface.texts())


def test_an_unloaded_plugin_leaves_no_entry(plugin, iface):
    plugin.unload()
    assert "fleet_remove_robots" not in {action.objectName() for action in iface.plugins.actions()}
