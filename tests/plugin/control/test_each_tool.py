"""What every tool that makes a draft does with mouse and keys alike."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.ui import scheduling
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication

CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
OPS = {"cone": "SetPosEnd", "route": "SetPath", "start": "SetPosIni"}


@pytest.fixture(params=list(OPS))
def tool(request, hand):
    """A hand with one of the tools, and a draft of it on the map."""
    hand.take(request.param).click((40, 30), (60, 30))
    hand.op = OPS[request.param]
    return hand


def test_either_enter_sends_once(tool):
    for count, key in enumerate((Qt.Key.Key_Return, Qt.Key.Key_Enter), 1):
        tool.key(key)
        assert tool.sent(count)["op"] == tool.op
        tool.key(key)
        QTest.qWait(150)
        assert len(tool.gateway.requests_of("send")) == count
        tool.click((40, 30), (60, 30))


def test_an_enter_that_is_held_down_sends_once(tool):
    QTest.keyPress(tool.iface.canvas, Qt.Key.Key_Return)
    tool.wait(tool.iface.is_settled)
    assert tool.sent()["op"] == tool.op
    QTest.keyRelease(tool.iface.canvas, Qt.Key.Key_Return)
    QTest.qWait(150)
    assert len(tool.gateway.requests_of("send")) == 1


def test_escape_takes_the_draft_away_and_undo_brings_it_back(tool):
    before = tool.points
    tool.key(Qt.Key.Key_Escape)
    assert tool.points is None
    tool.key(Qt.Key.Key_Z, CTRL)
    assert tool.points == before
    tool.key(Qt.Key.Key_Z, CTRL, SHIFT)
    assert tool.points is None
    assert tool.nothing_sent()


def test_a_right_click_leaves_the_draft_as_it_is_and_enter_still_sends_it(tool):
    before = tool.points
    tool.right_click(50, 50)
    assert tool.points == before
    assert tool.nothing_sent()
    tool.key(Qt.Key.Key_Return)
    assert tool.sent()["op"] == tool.op


def test_backspace_and_delete_take_back_the_last_click(tool):
    left = {"SetPath": 1}.get(tool.op, 0)
    for key in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
        tool.move(100, 90)
        tool.key(key)
        assert len(tool.points or ()) == left
        tool.click((60, 30))
        assert len(tool.points) == left + 1
    assert tool.nothing_sent()


def test_a_double_click_sends_nothing(tool):
    view, at = tool.iface.canvas.viewport(), tool.iface.pixel(80, 60)
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    QTest.mouseDClick(view, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)
    tool.wait(tool.iface.is_settled)
    assert tool.nothing_sent()
    assert tool.points[-1] == pytest.approx((80, 60), abs=0.3)


def test_leaving_the_tool_keeps_the_draft_and_sends_nothing(tool):
    before = tool.points
    tool.iface.actionPan().trigger()
    assert tool.points == before
    assert tool.nothing_sent()


def test_everything_is_possible_without_a_mouse(tool):
    tool.key(Qt.Key.Key_Escape)
    for place in ("46.86370254, 14.84308310", "46.86388288, 14.84334498"):
        QApplication.clipboard().setText(place)
        tool.key(Qt.Key.Key_V, CTRL)
    assert len(tool.points) == {"SetPath": 2}.get(tool.op, 1)
    tool.key(Qt.Key.Key_Return)
    assert tool.sent()["op"] == tool.op


@pytest.mark.parametrize("tool", ["cone", "route"], indirect=True)
def test_a_step_of_the_keys_that_cannot_be_checked_is_told_and_the_draft_stays(tool, layer_of, monkeypatch):
    # As on an idle machine, where a slice is long enough for a check of one place.
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", 60.0)
    layer = layer_of("Polygon", "Polygon ((1 1, 2 1, 2 2, 1 1))", role="keepout", name="Yard")
    if tool.op == OPS["route"]:
        tool.type(">")
    draft = tool.drafts.draft
    layer.setCustomProperty("fleet/filter", "1 +")
    QTest.qWait(1000)  # until the desk has noticed: nothing is said of that
    tool.key(Qt.Key.Key_Right, CTRL)
    assert tool.complained("The filter expression '1 +' for the layer Yard is not one")
    assert tool.points == draft.points
