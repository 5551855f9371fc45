"""The selected robot's queue on a real canvas."""

from __future__ import annotations

import pytest
from fleet_supervisor.robot_bridge.messages import QueueTask
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsPointXY, QgsProject
from qgis.PyQt.QtGui import QColor, QImage
from qgis.PyQt.QtTest import QTest

PLACES = [(60.0, 50.0), (80.0, 50.0), (80.0, 70.0)]


@pytest.fixture
def marks(at_desk, gateway, wait):
    gateway.queues.give("r1", [QueueTask(f"task-of-{k}", *place) for k, place in enumerate(PLACES)])
    wait(lambda: at_desk.desk.queues.get("r1") is not None)
    at_desk.desk.select("r1")
    return at_desk.queue_marks


def there(marks):
    return [(place.x() - 488000, place.y() - 5190000) for place in marks.places]


def test_the_tasks_of_the_selected_robot_are_marked_in_their_order(marks, at_desk, gateway, wait):
    assert there(marks) == [pytest.approx(place) for place in PLACES]
    at_desk.queue_edits.move("r1", "task-of-2", "task-of-1")
    wait(lambda: there(marks)[1] == pytest.approx(PLACES[2]))
    at_desk.desk.select("r2")
    assert marks.places == []
    at_desk.desk.select(None)
    assert marks.places == []


def test_marks_are_painted_where_the_tasks_are(marks, iface):
    orange = QColor("#F26A1B")
    QTest.qWait(100)
    seen: QImage = iface.canvas.grab().toImage()
    for place in PLACES[1:]:
        centre = iface.pixel(*place)
        ring = [seen.pixelColor(centre.x() + dx, centre.y()) for dx in range(7, 12)]
        assert any(abs(c.red() - orange.red()) + abs(c.green() - orange.green()) < 40 for c in ring), place


def test_marks_are_right_in_another_crs_of_the_map(marks, iface):
    other = QgsCoordinateReferenceSystem("EPSG:3857")
    iface.canvas.setDestinationCrs(other)
    way = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem("EPSG:32633"), other, QgsProject.instance().transformContext()
    )
    expected = way.transform(QgsPointXY(488060, 5190050))
    assert (marks.places[0].x(), marks.places[0].y()) == pytest.approx((expected.x(), expected.y()), abs=0.01)
