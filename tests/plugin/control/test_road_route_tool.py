"""The tool that leads along the roads, at a gateway that takes its time to find ways."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.control.route_queries import RoutePreferences
from fleet_supervisor.plugin.gateway_client.fleet_state import RequestResult
from fleet_supervisor.plugin.ui.errors import NotSentError
from pyproj import Transformer
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QApplication

X, Y = 488000.0, 5190000.0
AT = (50.0, 40.0)
"""Where r1 is."""
LEFT_OUT = "The way to where you clicked last was not known yet"


class SlowRoads:
    """The tool in hand; ways are found when the test says so, straight from one place to the other."""

    def __init__(self, hand, monkeypatch):
        self.hand, self.orders = hand, []
        self.preview = hand.window.desk.preview
        self.now = 100.0
        monkeypatch.setattr(self.preview, "_sender", SimpleNamespace(submit=self.orders.append))
        monkeypatch.setattr(self.preview, "_clock", SimpleNamespace(steady=lambda: self.now))

    @property
    def draft(self):
        return self.hand.drafts.draft

    @property
    def ends(self):
        """Where the legs of the draft end, metres rounded."""
        ends = [sum(self.draft.legs[: n + 1]) - 1 for n in range(len(self.draft.legs))]
        return [tuple(round(v) for v in self.draft.points[end]) for end in ends]

    def find(self, **error) -> None:
        """Answer the oldest question."""
        order = self.orders.pop(0)
        start, goal = order.params.get("start") or AT, (order.params["x"], order.params["y"])
        middle = [(a + b) / 2 for a, b in zip(start, goal, strict=True)]
        way = {"points": [list(start), middle, list(goal)], "metres": 1.0, "seconds": 1.0}
        assert self.preview.accept_answer(RequestResult(order, **(error or {"result": way})))
        self.hand.wait(self.hand.iface.is_settled, what="the check of the draft")

    def find_all(self) -> None:
        while self.orders:
            self.find()


@pytest.fixture
def roads(hand, monkeypatch):
    slow = SlowRoads(hand, monkeypatch)
    hand.take("road_route")
    return slow


def test_who_clicks_faster_than_ways_are_found_gets_every_leg_in_order(roads):
    roads.hand.click((60, 40), (60, 60), (90, 60))
    roads.find_all()
    assert roads.draft.robot == "r1"
    assert roads.ends == [(60, 40), (60, 60), (90, 60)]
    assert roads.hand.nothing_sent()


def test_a_click_while_the_way_to_the_mouse_is_asked_for_is_not_passed_over(roads):
    roads.hand.move(55, 45)
    roads.hand.click((60, 40), (60, 60))
    roads.find_all()
    assert roads.ends == [(60, 40), (60, 60)]


def test_backspace_takes_back_the_last_click_though_its_way_is_not_found_yet(roads):
    roads.hand.click((60, 40), (60, 60))
    roads.hand.key(Qt.Key.Key_Backspace)
    roads.find_all()
    assert roads.ends == [(60, 40)]
    roads.hand.key(Qt.Key.Key_Backspace)
    assert roads.draft is None


@pytest.mark.parametrize("how", ["link", "wishes"])
def test_clicks_whose_ways_are_dropped_are_told_and_are_not_what_backspace_takes_back(roads, how):
    roads.hand.click((60, 40))
    roads.find()
    roads.hand.click((60, 60), (90, 60))
    if how == "link":
        roads.hand.window.desk.close_link()
    else:
        roads.hand.iface.canvas.mapTool().set_preferences(RoutePreferences(fastest=True))
    assert roads.hand.complained("The ways to the 2 places clicked last were not known yet")
    assert roads.ends == [(60, 40)]
    roads.hand.key(Qt.Key.Key_Backspace)
    assert roads.draft is None


@pytest.mark.parametrize("how", ["check", "question"])
def test_the_click_after_one_that_failed_is_told_beside_the_error(roads, monkeypatch, how):
    def fail(_):
        raise NotSentError(f"there is no {how}")

    roads.hand.click((60, 40), (60, 60))
    if how == "check":
        roads.hand.click((90, 60))
        monkeypatch.setattr(roads.hand.iface.canvas.mapTool(), "set_command", fail)
    else:
        roads.hand.click((90, 60), (90, 80))
        monkeypatch.setattr(roads.preview, "_sender", SimpleNamespace(submit=fail))
    roads.find()
    assert roads.hand.complained(f"there is no {how}")
    assert roads.hand.complained("The ways to the 2 places clicked last were not known yet")


def test_a_mouse_that_moves_between_clicks_takes_none_of_them_away(roads):
    roads.hand.click((60, 40))
    roads.hand.move(60, 50)
    roads.hand.click((60, 60))
    roads.find_all()
    assert roads.ends == [(60, 40), (60, 60)]


def test_backspace_on_the_only_click_leaves_nothing(roads):
    roads.hand.click((60, 40))
    roads.hand.key(Qt.Key.Key_Backspace)
    roads.find_all()
    assert roads.draft is None


@pytest.mark.parametrize("how", ["escape", "cancel"])
def test_what_was_cancelled_does_not_come_when_its_way_is_found(roads, how):
    roads.hand.click((60, 40))
    if how == "escape":
        roads.hand.key(Qt.Key.Key_Escape)
    else:
        roads.hand.push("fleet_cancel")
    roads.find_all()
    assert roads.draft is None
    assert roads.hand.complained(LEFT_OUT)


def test_a_right_click_ends_drawing_and_the_ways_to_what_was_clicked_still_come(roads):
    roads.hand.move(55, 45)
    roads.hand.click((60, 40), (60, 60))
    roads.hand.right_click(30, 30)
    roads.find_all()
    assert roads.ends == [(60, 40), (60, 60)]
    roads.hand.move(80, 60)
    assert roads.orders == [], "the way still follows the mouse"
    assert roads.hand.nothing_sent()
    roads.hand.click((90, 60))
    roads.find_all()
    assert roads.ends == [(60, 40), (60, 60), (90, 60)]
    roads.hand.move(95, 65)
    assert len(roads.orders) == 1


def test_a_right_click_takes_the_way_to_the_mouse_off_the_map(roads):
    roads.hand.click((60, 40))
    roads.find()
    roads.hand.move(60, 60)
    roads.find()
    way = roads.hand.iface.canvas.mapTool()._way
    assert way.line
    roads.hand.right_click(60, 60)
    assert way.line == []
    assert roads.ends == [(60, 40)]


def test_after_a_right_click_a_way_that_was_not_found_leaves_the_tool_ready_for_another(roads):
    roads.hand.click((60, 40))
    roads.hand.right_click(30, 30)
    roads.find(error="no road comes near")
    roads.hand.move(70, 40)
    assert len(roads.orders) == 1, "no way is shown to the mouse any more"


def test_after_a_right_click_a_way_that_cannot_be_checked_leaves_the_tool_ready_for_another(
    roads, monkeypatch
):
    def fail(_):
        raise NotSentError("there is no check")

    roads.hand.click((60, 40))
    roads.hand.right_click(30, 30)
    monkeypatch.setattr(roads.hand.iface.canvas.mapTool(), "set_command", fail)
    roads.find()
    assert roads.hand.complained("there is no check")
    roads.hand.move(70, 40)
    assert len(roads.orders) == 1, "no way is shown to the mouse any more"


def test_who_sends_before_the_last_way_is_found_is_told_that_it_is_not_in_the_route(roads):
    roads.hand.click((60, 40))
    roads.find()
    roads.hand.click((60, 60))
    roads.hand.key(Qt.Key.Key_Return)
    points = roads.hand.sent()["params"]["points"]
    assert points[-1] == pytest.approx([60, 40], abs=0.3)
    assert roads.hand.complained(LEFT_OUT)
    roads.find_all()
    assert roads.draft is None


def test_where_no_way_leads_the_clicks_after_it_are_not_led_from_elsewhere(roads):
    roads.hand.click((60, 40), (60, 60))
    roads.find(error="no road comes near")
    assert roads.hand.complained("no road comes near (Nor is the place clicked after it in the route.)")
    roads.find_all()
    assert roads.draft is None
    roads.hand.click((70, 40))
    roads.find_all()
    assert roads.ends == [(70, 40)]


def test_an_answer_that_is_lost_holds_up_no_later_click(roads):
    roads.hand.click((60, 40))
    roads.orders.clear()
    roads.now += 10.0
    roads.hand.click((70, 40))
    roads.find_all()
    assert roads.ends == [(70, 40)]


def test_a_click_whose_answer_never_comes_is_told(roads):
    roads.hand.click((60, 40), (60, 60))
    roads.now += 10.0
    assert roads.hand.complained("The gateway has not answered for 5 s which way leads to where you clicked")
    assert len(roads.orders) == 1, "the second leg would begin where the first one does not lead"


def test_leaving_the_tool_forgets_what_was_clicked_and_sends_nothing(roads):
    roads.hand.click((60, 40))
    roads.hand.iface.actionPan().trigger()
    assert roads.hand.complained(LEFT_OUT)
    roads.find_all()
    assert roads.draft is None
    assert roads.hand.nothing_sent()


def test_a_leg_that_cannot_be_checked_is_told(roads, layer_of):
    layer = layer_of("Polygon", "Polygon ((1 1, 2 1, 2 2, 1 1))", role="keepout", name="Yard")
    layer.setCustomProperty("fleet/filter", "1 +")
    roads.hand.click((60, 40))
    roads.find_all()
    assert roads.hand.complained("The filter expression '1 +' for the layer Yard is not one")
    # Where the layer is come to after the first slice of the check, the draft is on the map, and refused.
    assert roads.draft is None or roads.draft.findings.refused
    assert roads.hand.nothing_sent()


def test_another_robots_click_does_not_go_on_with_this_ones_route(roads):
    roads.hand.click((60, 40))
    roads.find()
    roads.hand.window.desk.selection.select("r2")
    roads.hand.click((70, 40))
    assert roads.hand.complained("The route on the map is for r1, but r2 is selected.")
    assert roads.ends == [(60, 40)] and roads.orders == []


def test_keys_alone_lead_a_route_and_send_it(roads):
    to_earth = Transformer.from_crs("EPSG:32633", "EPSG:4326")
    for x, y in ((60, 40), (60, 60)):
        lat, lon = to_earth.transform(X + x, Y + y)
        QApplication.clipboard().setText(f"{lat}, {lon}")
        roads.hand.key(Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    roads.find_all()
    assert roads.ends == [(60, 40), (60, 60)]
    roads.hand.key(Qt.Key.Key_Return)
    assert roads.hand.sent()["op"] == "SetPath"
