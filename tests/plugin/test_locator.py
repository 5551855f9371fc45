"""Robots in QGIS's locator: ``rb`` and a name goes to a robot."""

from __future__ import annotations

import threading

import pytest
from fleet_supervisor.plugin.locator import PREFIX_KEY, RobotFilter, rank_robots
from fleet_supervisor.plugin.plugin import FleetPlugin
from qgis.core import QgsExpression, QgsLocatorContext, QgsLocatorResult, QgsSettings
from qgis.gui import QgsLocatorWidget
from qgis.PyQt.QtTest import QSignalSpy
from qgis.PyQt.QtWidgets import QApplication, QLineEdit


def found(iface, text, wait):
    """What QGIS's locator finds for ``text``, typed with prefix and all."""
    spy = QSignalSpy(iface.locator.finished)
    results = []

    def keep(result):
        # A copy: the locator's own is gone when this returns.
        results.append(QgsLocatorResult(result))

    iface.locator.foundResult.connect(keep)
    iface.locator.fetchResults(text, QgsLocatorContext())
    wait(lambda: len(spy) > 0)
    QApplication.processEvents()
    iface.locator.foundResult.disconnect(keep)
    return results


def test_rb_and_a_name_finds_robots_goes_there_and_selects(at_desk, iface, wait, gateway, make_robot):
    gateway.show(make_robot("forklift-12", 150, 120))
    wait(lambda: QgsExpression("robot_state('forklift-12') IS NOT NULL").evaluate())
    results = found(iface, "rb lift", wait)
    assert [result.displayString for result in results] == ["forklift-12"]
    assert ", heard of " in results[0].description
    results[0].filter.triggerResult(results[0])
    assert at_desk.desk.selection.robots == ("forklift-12",)
    centre = iface.canvas.center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((150, 120), abs=1)


def test_enter_before_the_list_is_there_goes_by_what_is_typed(at_desk, iface, wait, monkeypatch):
    locator = QgsLocatorWidget(iface.mainWindow())
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    (result,) = found(iface, "rb r1", wait)
    for typed, goes_to in (
        ("rb r1", ["r1"]),
        ("RB r1 ", ["r1"]),
        # QGIS has not looked for the last letters yet, and hands on what it found for those before.
        ("rb r2", ["r2"]),
        ("r2", ["r2"]),
        ("rb r27", []),
        ("roads", []),
    ):
        locator.findChild(QLineEdit).setText(typed)
        gone_to = []
        monkeypatch.setattr(result.filter._viewer, "show_on_map", gone_to.append)
        result.filter.triggerResult(result)
        assert gone_to == goes_to, typed


def test_a_row_that_was_chosen_counts(at_desk, iface, wait):
    locator = QgsLocatorWidget(iface.mainWindow())
    locator.findChild(QLineEdit).setText("rb r")
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    _, second = found(iface, "rb r", wait)
    second.filter.triggerResult(second)
    assert at_desk.desk.selection.robots == ("r2",)


def test_rb_alone_lists_every_robot(at_desk, iface, wait):
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    assert sorted(result.displayString for result in found(iface, "rb ", wait)) == ["r1", "r2"]


def test_robots_are_looked_for_in_the_windows_thread(at_desk, iface, wait, monkeypatch):
    """A thread of QGIS's would wait for Python while unloading, in Python, waits for that thread."""
    threads = set()
    fetch = RobotFilter.fetchResults

    def noting(self, *given):
        threads.add(threading.current_thread())
        fetch(self, *given)

    monkeypatch.setattr(RobotFilter, "fetchResults", noting)
    wait(lambda: QgsExpression("robot_state('r2') IS NOT NULL").evaluate())
    assert len(found(iface, "rb ", wait)) == 2
    assert threads == {threading.main_thread()}


def test_a_prefix_of_the_users_own_stays(iface, plugin):
    assert QgsSettings().value(PREFIX_KEY) == "rb"
    plugin.unload()
    assert QgsSettings().value(PREFIX_KEY, "") == ""
    QgsSettings().setValue(PREFIX_KEY, "bot")
    again = FleetPlugin(iface)
    again.initGui()
    try:
        assert "bot" in [one.activePrefix() for one in iface.locator.filters()]
    finally:
        again.unload()
        assert QgsSettings().value(PREFIX_KEY) == "bot"
        QgsSettings().remove(PREFIX_KEY)


def test_the_same_name_comes_first_then_those_that_begin_so():
    names = ["x-r1", "r10", "r1", "b2"]
    assert [name for _, name in rank_robots("R1", names)] == ["r1", "r10", "x-r1"]
