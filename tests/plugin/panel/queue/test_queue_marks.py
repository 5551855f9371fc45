"""The selected robot's queue on a real canvas."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay import task_painter
from fleet_supervisor.robot_bridge.core.messages.queues import QueueTask
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsPointXY, QgsProject
from qgis.PyQt.QtCore import QRect
from qgis.PyQt.QtGui import QColor, QImage

PLACES = [(60.0, 50.0), (80.0, 50.0), (80.0, 70.0)]


@pytest.fixture
def marks(at_desk, gateway, wait):
    gateway.queues.give("r1", [QueueTask(f"task-of-{k}", *place) for k, place in enumerate(PLACES)])
    wait(lambda: at_desk.desk.state.queues.get("r1") is not None)
    at_desk.desk.selection.select("r1")
    return at_desk.queue_marks


def there(marks):
    return (marks.places - (488000.0, 5190000.0)).tolist()


def test_the_tasks_of_the_selected_robot_are_marked_in_their_order(marks, at_desk, gateway, wait):
    assert there(marks) == [pytest.approx(place) for place in PLACES]
    at_desk.queue_edits.move("r1", "task-of-2", "task-of-1")
    wait(lambda: there(marks)[1] == pytest.approx(PLACES[2]))
    at_desk.desk.selection.select("r2")
    assert there(marks) == []
    at_desk.desk.selection.select(None)
    assert there(marks) == []


def is_ringed(iface, place):
    """Tell whether the orange ring of a task is to be seen around ``place``."""
    orange = QColor("#F26A1B")
    seen: QImage = iface.canvas.grab().toImage()
    centre = iface.pixel(*place)
    ring = [seen.pixelColor(centre.x() + dx, centre.y()) for dx in range(7, 12)]
    return any(abs(c.red() - orange.red()) + abs(c.green() - orange.green()) < 40 for c in ring)


def test_marks_are_painted_where_the_tasks_are_and_go_with_the_map(marks, iface, wait):
    def are_painted():
        return all(is_ringed(iface, place) for place in PLACES[1:])

    wait(are_painted, what="the marks")
    iface.look_at(40, 30, 130, 110)
    wait(are_painted, what="the marks elsewhere")


def test_marks_go_with_the_queue_that_they_are_of(marks, at_desk, iface, wait):
    wait(lambda: is_ringed(iface, PLACES[2]), what="the mark")
    at_desk.desk.selection.select("r2")
    assert not is_ringed(iface, PLACES[2])


def test_marks_are_painted_once_for_a_queue_and_a_view(marks, at_desk, gateway, iface, wait, monkeypatch):
    painted, paint = [], task_painter._paint
    monkeypatch.setattr(task_painter, "_paint", lambda *given: painted.append(1) or paint(*given))
    iface.look_at(40, 30, 130, 110)
    for _ in range(3):
        iface.canvas.grab()
    assert len(painted) == 1
    at_desk.queue_edits.move("r1", "task-of-2", "task-of-1")
    wait(lambda: there(marks)[1] == pytest.approx(PLACES[2]))
    for _ in range(3):
        iface.canvas.grab()
    assert len(painted) == 2


@pytest.mark.parametrize("tasks", [task_painter.MOST_DOTTED, task_painter.MOST_DOTTED + 1])
def test_the_line_leads_through_few_and_through_many(marks, iface, tasks):
    there = [(60.0, 50.0), (100.0, 50.0)] * (tasks // 2) + [(60.0, 80.0)] * (tasks % 2)
    marks.places = np.add(there, (488000.0, 5190000.0))
    marks._made_for = None
    before = iface.canvas.grab().toImage().copy(line := line_between(iface))
    marks.places = task_painter.NOWHERE
    assert before != iface.canvas.grab().toImage().copy(line)


def line_between(iface):
    """Return the pixels around the middle of the line from (60, 50) to (100, 50), clear of the rings."""
    return QRect(iface.pixel(75, 50.5), iface.pixel(85, 49.5))


def test_marks_are_right_in_another_crs_of_the_map(marks, iface):
    other = QgsCoordinateReferenceSystem("EPSG:3857")
    iface.canvas.setDestinationCrs(other)
    way = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem("EPSG:32633"), other, QgsProject.instance().transformContext()
    )
    expected = way.transform(QgsPointXY(488060, 5190050))
    assert marks.places[0].tolist() == pytest.approx([expected.x(), expected.y()], abs=0.01)
