"""The queue panel, with a real mouse and real keys, against a gateway that keeps queues by its own rules."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.panel import queue
from fleet_supervisor.robot_bridge.core.messages.queues import QueueState, QueueTask, TaskKind
from qgis.PyQt.QtCore import QPoint, QPointF, Qt
from qgis.PyQt.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QLabel, QToolButton

from tests.support.button_places import Watched

ALT = Qt.KeyboardModifier.AltModifier
CTRL = Qt.KeyboardModifier.ControlModifier
NAMES = ["K1", "K2", "K3", "K4"]


def task(name: str, x: float = 60.0) -> QueueTask:
    return QueueTask(f"task-of-{name}", x, 50.0, kind=TaskKind.PLACE, cone=name)


@pytest.fixture
def panel(at_desk, gateway, wait):
    gateway.queues.give("r1", [task(name) for name in NAMES])
    at_desk.desk.selection.select("r1")
    at_desk.dock.tabs.setCurrentWidget(at_desk.dock.queue_panel)
    wait(lambda: shown(at_desk.dock.queue_panel) == NAMES, what="the queue")
    return at_desk.dock.queue_panel


def shown(panel) -> list[str]:
    return [one.cone for one in panel.list.tasks.tasks]


def there(gateway) -> list[str]:
    return [one.task.cone for one in gateway.queues.get("r1").tasks]


def choose(panel, row: int) -> None:
    rect = panel.list.visualRect(panel.list.tasks.index(row, 1))
    QTest.mouseClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=rect.center())


def press(panel, key, modifier=Qt.KeyboardModifier.NoModifier) -> None:
    QTest.keyClick(panel.list, key, modifier)


def push(panel, name: str) -> None:
    QTest.mouseClick(panel.findChild(QToolButton, name), Qt.MouseButton.LeftButton)


def text(panel, name: str) -> str:
    return panel.findChild(QLabel, name).text()


def test_the_queue_of_the_selected_robot_is_shown_with_what_is_done_now(panel, at_desk):
    assert panel.list.tasks.index(0, 2).data() == "now"
    assert panel.list.tasks.index(1, 1).data() == "place cone K2 at 60.00, 50.00"
    assert text(panel, "fleet_queue_head") == "r1: 4 tasks, running"
    at_desk.desk.selection.select("r2")
    assert shown(panel) == []
    assert text(panel, "fleet_queue_head").startswith("r2 has no queue")
    at_desk.desk.selection.select(None)
    assert "1 have one, 0 of them paused" in text(panel, "fleet_queue_head")


@pytest.mark.parametrize(
    ("row", "key", "after"),
    [
        (2, Qt.Key.Key_Up, ["K1", "K3", "K2", "K4"]),
        (1, Qt.Key.Key_Down, ["K1", "K3", "K2", "K4"]),
        (3, Qt.Key.Key_Home, ["K1", "K4", "K2", "K3"]),
        (1, Qt.Key.Key_End, ["K1", "K3", "K4", "K2"]),
    ],
)
def test_alt_and_an_arrow_move_the_selected_task_and_it_stays_selected(panel, gateway, wait, row, key, after):
    choose(panel, row)
    chosen = panel.list.chosen
    press(panel, key, ALT)
    wait(lambda: shown(panel) == after)
    assert there(gateway) == after
    assert panel.list.chosen == chosen


def test_up_and_down_buttons_do_the_same(panel, gateway, wait):
    choose(panel, 2)
    push(panel, "fleet_queue_up")
    wait(lambda: shown(panel) == ["K1", "K3", "K2", "K4"])
    push(panel, "fleet_queue_down")
    wait(lambda: shown(panel) == NAMES)


def test_what_the_robot_does_now_is_neither_moved_nor_overtaken(panel, gateway):
    choose(panel, 0)
    press(panel, Qt.Key.Key_Down, ALT)
    choose(panel, 1)
    press(panel, Qt.Key.Key_Up, ALT)
    press(panel, Qt.Key.Key_Home, ALT)
    QTest.qWait(150)
    assert gateway.requests_of("move_task") == []


def drag(panel, row: int, to: QPoint) -> None:
    """Drag as the window system would: offscreen it carries no drags itself."""
    view, tasks = panel.list.viewport(), panel.list.tasks
    index = tasks.index(row, 1)
    assert tasks.flags(index) & Qt.ItemFlag.ItemIsDragEnabled
    mime = tasks.mimeData([index])
    how = (Qt.DropAction.MoveAction, mime, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)
    for event in (QDragEnterEvent(to, *how), QDragMoveEvent(to, *how)):
        QApplication.sendEvent(view, event)
        assert event.isAccepted()
    QApplication.sendEvent(view, QDropEvent(QPointF(to), *how))


def test_a_task_is_dragged_to_another_place(panel, gateway, wait):
    second = panel.list.visualRect(panel.list.tasks.index(1, 1))
    drag(panel, 3, QPoint(second.center().x(), second.top() + 1))
    wait(lambda: shown(panel) == ["K1", "K4", "K2", "K3"], what="the drop")
    assert gateway.requests_of("move_task") == [
        {"robot": "r1", "revision": 1, "task": "task-of-K4", "before": "task-of-K2"}
    ]


def test_a_task_is_dragged_to_the_end(panel, gateway, wait):
    drag(panel, 1, panel.list.viewport().rect().bottomLeft() - QPoint(-40, 3))
    wait(lambda: shown(panel) == ["K1", "K3", "K4", "K2"], what="the drop")


def test_what_the_robot_does_now_cannot_be_dragged_and_nothing_be_dropped_before_it(panel, gateway):
    first = panel.list.tasks.index(0, 1)
    assert not panel.list.tasks.flags(first) & Qt.ItemFlag.ItemIsDragEnabled
    drag(panel, 1, panel.list.visualRect(first).topLeft() + QPoint(40, 1))
    QTest.qWait(100)
    assert gateway.requests_of("move_task") == []


def test_delete_takes_the_selected_task_out(panel, gateway, wait):
    choose(panel, 2)
    press(panel, Qt.Key.Key_Delete)
    wait(lambda: shown(panel) == ["K1", "K2", "K4"])
    choose(panel, 1)
    push(panel, "fleet_queue_remove")
    wait(lambda: shown(panel) == ["K1", "K4"])


def test_only_enter_with_ctrl_lets_a_task_be_done_now(panel, gateway, wait):
    choose(panel, 2)
    press(panel, Qt.Key.Key_Return)
    QTest.qWait(100)
    assert gateway.requests_of("make_current") == []
    press(panel, Qt.Key.Key_Return, CTRL)
    wait(lambda: shown(panel) == ["K3", "K1", "K2", "K4"])
    choose(panel, 3)
    push(panel, "fleet_queue_first")
    wait(lambda: shown(panel)[0] == "K4")


def test_the_queue_is_paused_and_resumed(panel, gateway, wait):
    push(panel, "fleet_queue_hold")
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"))
    assert "paused by anna" in text(panel, "fleet_queue_head")
    push(panel, "fleet_queue_hold")
    wait(lambda: "running" in text(panel, "fleet_queue_head"))
    assert [one["robot"] for one in gateway.requests_of("resume_queue")] == ["r1"]


def test_a_click_on_pause_does_not_resume_what_somebody_else_has_just_paused(
    panel, gateway, iface, wait, monkeypatch
):
    monkeypatch.setattr(queue, "DEAD_TIME", 3600.0)
    gateway.queues.fail("r1", "stuck")
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"), what="the pause")
    push(panel, "fleet_queue_hold")
    (told,) = iface.texts()
    assert "The queue of r1 was paused just before the click, so it was not resumed." in told
    assert gateway.requests_of("resume_queue") == []
    # Who selects a robot reads the button first, and who has paused it knows.
    panel._desk.selection.select("r2")
    panel._desk.selection.select("r1")
    push(panel, "fleet_queue_hold")
    wait(lambda: "running" in text(panel, "fleet_queue_head"), what="the queue going on")
    push(panel, "fleet_queue_hold")
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"), what="the pause")
    push(panel, "fleet_queue_hold")
    wait(lambda: len(gateway.requests_of("resume_queue")) == 2, what="the second request")


def test_a_click_means_what_the_button_said_when_the_mouse_was_pressed(panel, gateway, wait):
    button = panel.findChild(QToolButton, "fleet_queue_hold")
    QTest.mousePress(button, Qt.MouseButton.LeftButton)
    gateway.queues.fail("r1", "stuck")
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"), what="the pause")
    QTest.mouseRelease(button, Qt.MouseButton.LeftButton)
    wait(lambda: gateway.requests_of("pause_queue"), what="the request")
    assert gateway.requests_of("resume_queue") == []


def test_a_change_that_comes_too_late_is_not_done_and_the_newer_queue_is_shown(panel, gateway, wait, iface):
    gateway.queues.quiet = True
    gateway.queues.give("r1", [task("K9", 70.0)], by="ben")
    choose(panel, 3)
    press(panel, Qt.Key.Key_Delete)
    wait(lambda: shown(panel) == [*NAMES, "K9"], what="the newer queue")
    assert there(gateway) == [*NAMES, "K9"]
    assert "has changed since you saw it" in text(panel, "fleet_queue_conflict")
    assert any("is at revision 2, not 1" in one for one in iface.texts())
    choose(panel, 3)
    press(panel, Qt.Key.Key_Delete)
    wait(lambda: shown(panel) == ["K1", "K2", "K3", "K9"])
    assert text(panel, "fleet_queue_conflict") == ""


def test_no_button_moves_whatever_becomes_of_the_queue(panel, at_desk, gateway, wait):
    watched = Watched(panel)
    for row in (0, 3):
        choose(panel, row)
        watched.check(f"task {row} is chosen")
    push(panel, "fleet_queue_hold")
    watched.check("a pause is asked for")
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"))
    watched.check("it is paused")
    push(panel, "fleet_queue_hold")
    wait(lambda: "running" in text(panel, "fleet_queue_head"))
    gateway.queues.fail("r1", "a wall where the map has none, and no way round it " * 5)
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"))
    watched.check("a task has failed")
    gateway.queues.quiet = True
    gateway.queues.give("r1", [task("K9", 70.0)], by="ben")
    choose(panel, 3)
    press(panel, Qt.Key.Key_Delete)
    wait(lambda: text(panel, "fleet_queue_conflict"), what="a change that came too late")
    watched.check("a change came too late")
    at_desk.desk.selection.select("r2")
    watched.check("another robot is selected, which has none")
    at_desk.desk.selection.select(None)
    watched.check("none is selected")


@pytest.mark.parametrize("how", ["Delete", "Alt+Down"])
def test_while_an_answer_is_awaited_nothing_else_is_asked_but_to_pause(panel, gateway, iface, wait, how):
    gateway.mute.add("remove_task")
    choose(panel, 1)
    press(panel, Qt.Key.Key_Delete)
    wait(lambda: len(gateway.requests_of("remove_task")) == 1)
    assert iface.texts() == []
    press(panel, *((Qt.Key.Key_Delete,) if how == "Delete" else (Qt.Key.Key_Down, ALT)))
    (told,) = iface.texts()
    assert "has not answered yet what was asked of the queue of r1 before" in told
    QTest.qWait(150)
    assert len(gateway.requests_of("remove_task")) == 1
    assert gateway.requests_of("move_task") == []
    push(panel, "fleet_queue_hold")
    wait(lambda: gateway.queues.get("r1").state is QueueState.PAUSED)


@pytest.mark.parametrize("how", ["double click", "Enter"])
def test_a_double_click_or_enter_shows_the_place_on_the_map(panel, gateway, iface, wait, how):
    row = panel.list.visualRect(panel.list.tasks.index(1, 1)).center()
    QTest.mouseClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=row)
    if how == "Enter":
        QTest.keyClick(panel.list, Qt.Key.Key_Return)
    else:
        QTest.mouseDClick(panel.list.viewport(), Qt.MouseButton.LeftButton, pos=row)
    middle = iface.canvas.center()
    assert (middle.x() - 488000, middle.y() - 5190000) == pytest.approx((60, 50))


def test_a_failed_task_says_why_and_a_lost_robot_is_named(panel, gateway, wait, at_desk):
    gateway.queues.fail("r1", "robot r1 refused: no cone on board")
    wait(lambda: "PAUSED" in text(panel, "fleet_queue_head"))
    assert panel.list.tasks.index(0, 2).data() == "failed: robot r1 refused: no cone on board"
    gateway.queues.lose("r1")
    wait(lambda: "The robot is lost: it is sent nothing" in text(panel, "fleet_queue_head"))
