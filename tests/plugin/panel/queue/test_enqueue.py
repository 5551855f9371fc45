"""Drafts that go into a robot's queue, with a real mouse on a real canvas."""

from __future__ import annotations

import pytest
from fleet_supervisor.robot_bridge.core.messages.queues import TaskKind
from qgis.core import QgsFeature, QgsGeometry, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QToolButton


@pytest.fixture
def desk(at_desk):
    at_desk.desk.selection.select("r1")
    return at_desk


def enqueue(desk):
    QTest.mouseClick(desk.dock.findChild(QToolButton, "fleet_enqueue_button"), Qt.MouseButton.LeftButton)


def tasks(gateway, robot="r1"):
    return [one.task for one in gateway.queues.get(robot).tasks]


def test_a_cone_goes_into_the_queue_of_the_robot_that_it_was_made_for(desk, iface, gateway, wait):
    desk.actions.cone.trigger()
    iface.click(70, 55)
    desk.desk.selection.select("r2")
    enqueue(desk)
    wait(lambda: len(tasks(gateway)) == 1)
    (task,) = tasks(gateway)
    assert (task.kind, task.x, task.y) == (TaskKind.PLACE, *(pytest.approx(v, abs=0.3) for v in (70, 55)))
    assert tasks(gateway, "r2") == []
    assert gateway.requests_of("send") == []
    wait(lambda: desk.desk.drafts.draft is None)


def test_a_route_goes_in_as_a_path_behind_what_is_there(desk, iface, gateway, wait):
    desk.actions.cone.trigger()
    iface.click(70, 55)
    enqueue(desk)
    wait(lambda: desk.desk.state.queues.revision("r1") == 1)
    desk.actions.route.trigger()
    for point in ((40, 30), (60, 30), (60, 60)):
        iface.click(*point)
    enqueue(desk)
    wait(lambda: len(tasks(gateway)) == 2)
    task = tasks(gateway)[1]
    assert task.kind is TaskKind.DRIVE
    assert [tuple(point) for point in task.path][-1] == (task.x, task.y)
    assert len(task.path) == 3


def test_a_layer_of_points_goes_in_by_name_and_in_order(desk, iface, gateway, wait):
    layer = QgsVectorLayer("Point?crs=EPSG:32633&field=id:string", "cones", "memory")
    for number in range(3):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromWkt(f"Point ({488050 + 5 * number} 5190050)"))
        feature.setAttributes([f"K{number}"])
        layer.dataProvider().addFeature(feature)
    QgsProject.instance().addMapLayer(layer)
    iface.canvas.setCurrentLayer(layer)
    desk.actions.from_layer.trigger()
    # What is pressed before is refused where the check finds what the operator has not seen.
    wait(lambda: desk.desk.drafts.draft is not None and desk.desk.drafts.draft.is_checked)
    enqueue(desk)
    wait(lambda: len(tasks(gateway)) == 3)
    assert [task.cone for task in tasks(gateway)] == ["K0", "K1", "K2"]
    assert len({task.task for task in tasks(gateway)}) == 3


def test_while_an_answer_is_awaited_it_stays_on_the_map_and_that_is_told(desk, iface, gateway, wait):
    gateway.mute.add("pause_queue")
    desk.queue_edits.pause("r1")
    desk.actions.cone.trigger()
    iface.click(70, 55)
    enqueue(desk)
    wait(lambda: any("has not answered yet what was asked of the queue" in text for text in iface.texts()))
    assert desk.desk.drafts.draft is not None
    assert gateway.requests_of("add_tasks") == []


def test_what_may_not_be_sent_may_not_be_queued(desk, iface, gateway, wait):
    iface.look_at(-60, -60, 260, 200)
    desk.actions.cone.trigger()
    iface.click(-20, 30)
    enqueue(desk)
    # A check that takes long on a busy machine answers later.
    wait(lambda: any("was not put into the queue" in text for text in iface.texts()))
    QTest.qWait(150)
    assert gateway.requests_of("add_tasks") == []
    assert desk.desk.drafts.draft is not None


def test_a_start_position_is_no_task(desk, iface, gateway):
    desk.actions.start.trigger()
    iface.click(70, 55)
    enqueue(desk)
    assert any("A start position is no task" in text for text in iface.texts())
    assert desk.desk.drafts.draft is not None


def test_a_draft_comes_back_when_the_queue_has_changed_meanwhile(desk, iface, gateway, wait):
    from fleet_supervisor.robot_bridge.core.messages.queues import QueueTask

    gateway.queues.quiet = True
    gateway.queues.give("r1", [QueueTask("task-of-ben", 60.0, 50.0)], by="ben")
    desk.actions.cone.trigger()
    iface.click(70, 55)
    enqueue(desk)
    wait(lambda: any("is at revision 1, not 0" in text for text in iface.texts()))
    assert desk.desk.drafts.draft is not None
    enqueue(desk)
    wait(lambda: len(tasks(gateway)) == 2)


def test_a_target_in_another_robots_queue_is_in_the_way(desk, iface, gateway, wait):
    from fleet_supervisor.robot_bridge.core.messages.queues import QueueTask

    queued = [QueueTask("task-one", 20.0, 20.0), QueueTask("task-two", 70.0, 55.0)]
    gateway.queues.give("r2", queued)
    wait(lambda: desk.desk.state.queues.revision("r2") == 1)
    desk.actions.cone.trigger()
    iface.click(70, 55)
    assert any("from a task of r2 at 70.00, 55.00" in text for text in iface.texts())
