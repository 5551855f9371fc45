"""A queue filled, put in another order, paused and driven, and an override that is logged, for real."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsFeature, QgsGeometry, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QToolButton

WHY = "enters the keepout Loading bay because: it is cleared"
PLACES = {"first": (34.0, 8.0), "second": (40.0, 10.0), "third": (37.0, 8.0)}


def enqueue(operator, panel, name):
    before = len(panel.list.tasks.tasks)
    operator.choose("fleet_cone_target")
    operator.click_site(*PLACES[name])
    operator.press("fleet_enqueue")
    operator.wait(f"the task {name}", lambda: len(panel.list.tasks.tasks) == before + 1, 10)


def test_a_queue_is_driven_in_the_order_that_the_operator_gave_it(loop, operator, plugin):
    loop.start_robot("r1", (20, 8, 0), speed=1.5)
    operator.connect_to(loop, ["r1"])
    operator.select("r1")
    panel = plugin.window.dock.queue_panel
    plugin.window.dock.tabs.setCurrentWidget(panel)
    for name in PLACES:
        enqueue(operator, panel, name)
    QTest.mouseClick(panel.findChild(QToolButton, "fleet_queue_hold"), Qt.MouseButton.LeftButton)
    operator.wait("the pause", lambda: operator.desk.state.queues.get("r1").state.value == "paused", 10)
    third = panel.list.visualRect(panel.list.tasks.index(2, 1)).center()
    QTest.mouseClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=third)
    QTest.keyClick(panel.list, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    y = [PLACES["third"][0], PLACES["second"][0]]
    operator.wait("the order", lambda: in_order(panel)[-2:] == pytest.approx(y, abs=0.5), 10)
    # What was begun before the pause is finished, and nothing else is begun.
    operator.wait_for_state("r1", "SetPosEnd", CommandState.REACHED)
    operator.wait("two left", lambda: len(panel.list.tasks.tasks) == 2, 10)
    QTest.qWait(1500)
    assert len(operator.sent_to("r1")) == 1
    QTest.mouseClick(panel.findChild(QToolButton, "fleet_queue_hold"), Qt.MouseButton.LeftButton)
    operator.wait("the empty queue", lambda: panel.list.tasks.tasks == [], 60)
    driven = [c.params["x"] for c in sorted(operator.sent_to("r1"), key=lambda c: c.steps[0].at)]
    assert driven == pytest.approx([PLACES[name][0] for name in ("first", "third", "second")], abs=0.5)
    assert {c.state for c in operator.sent_to("r1")} == {CommandState.REACHED}


def in_order(panel):
    return [task.x for task in panel.list.tasks.tasks]


def test_an_override_stands_in_the_log_that_everybody_sees(loop, operator, plugin):
    loop.start_robot("r1", (20, 8, 0))
    operator.connect_to(loop, ["r1"])
    e, n = operator.desk.state.site.origin
    layer = QgsVectorLayer("Polygon?crs=EPSG:32633&field=name:string", "closed", "memory")
    feature = QgsFeature(layer.fields())
    feature.setGeometry(QgsGeometry.fromWkt("Polygon ((28 4, 36 4, 36 12, 28 12, 28 4))"))
    geometry = feature.geometry()
    geometry.translate(e, n)
    feature.setGeometry(geometry)
    feature.setAttributes(["Loading bay"])
    layer.dataProvider().addFeature(feature)
    layer.setCustomProperty("fleet/role", "keepout")
    QgsProject.instance().addMapLayer(layer)
    operator.select("r1")
    operator.choose("fleet_cone_target")
    operator.click_site(32, 8)
    operator.press("fleet_send")
    operator.wait("the check", lambda: not operator.is_looking, 20)
    QTest.qWait(500)
    assert operator.sent_to("r1") == []
    draft = operator.desk.drafts.draft
    assert draft.can_be_overridden
    operator.desk.drafts.renew(replace(draft, override=WHY))
    operator.press("fleet_send")
    command = operator.wait_for_state("r1", "SetPath", CommandState.REACHED)
    assert command.steps[0].reason == f"override: {WHY}"
