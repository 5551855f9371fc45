"""Robots that the gateway knows and the desk does not: in QGIS's locator and in expressions."""

from __future__ import annotations

import threading
import time

import pytest
from fleet_supervisor.plugin.expressions import MOST_NAMED
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from qgis.core import NULL, QgsExpression
from qgis.gui import QgsLocatorWidget
from qgis.PyQt.QtCore import QSortFilterProxyModel, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLineEdit, QTreeView

SITE = {
    "robots": 100_000,
    "fresh": 100_000,
    "stale": 0,
    "lost": 0,
    "offline": 0,
    "inside": 2,
    "alarmed": 0,
}
FRESH = {"state": "fresh", "age": 0.5, "link": "websocket"}


@pytest.fixture
def iface(iface):
    """A window with QGIS's locator in it."""
    widget = QgsLocatorWidget(iface)
    widget.setFixedWidth(300)
    widget.show()
    iface.locator = widget.locator()
    return iface


@pytest.fixture
def desk(iface, gateway, request, wait):
    """A desk that is told of two robots of 100 000."""
    gateway.who["robots"] = 100_000
    window = request.getfixturevalue("at_desk")
    tell(gateway, *gateway.robots.values(), everything=True, view=SITE)
    wait(lambda: window.desk.state.robots.fleet is not None, what="the view")
    plugin = request.getfixturevalue("plugin")
    wait(lambda: (seen := plugin._fleet.robots) and not seen.is_whole, what="what expressions are told of")
    # What a desk asks for is not answered with all robots any more.
    gateway.robots.clear()
    return window


def tell(gateway, *robots, **more):
    gateway.tell("positions", {"t": time.time(), "robots": [to_json(one) for one in robots], **more})


def has_robots(gateway, *names):
    """Have the gateway find these robots by a part of their names, once the event that is returned is set."""
    answers = threading.Event()

    def find(params):
        answers.wait(5)
        text, is_whole = params["text"].lower(), params.get("whole", False)
        found = sorted(name for name in names if (text == name.lower() if is_whole else text in name.lower()))
        told = [{"robot": name, **FRESH} for name in found if name > params.get("after", "")]
        return {"result": {"t": 1.0, "robots": told[: params.get("limit", 50)], "count": len(found)}}

    gateway.answers["find_robots"] = find
    return answers


def searched(gateway):
    return [params["text"] for params in gateway.requests_of("find_robots")]


def always(gateway):
    """The robots that the desk asks for wherever they are."""
    views = [params["view"] for params in gateway.requests_of("subscribe") if params.get("view")]
    return views[-1]["always"] if views else []


def value(text):
    found = QgsExpression(text).evaluate()
    return None if found == NULL else found


# --- QGIS's locator ---


class Locator:
    """QGIS's locator as it is used from the keyboard."""

    def __init__(self, iface):
        self._iface = iface
        self.field = iface.findChild(QgsLocatorWidget).findChild(QLineEdit)

    def type(self, text):
        self.field.clear()
        self.field.setFocus()
        QTest.keyClicks(self.field, text)

    def press(self, key):
        QTest.keyClick(self.field, key)

    def rows(self):
        return [name for index in self._indexes() if (name := self._name(index))]

    def marked(self):
        return self._name(self._list().currentIndex())

    def _list(self):
        lists = self._iface.findChildren(QTreeView)
        return next(one for one in lists if isinstance(one.model(), QSortFilterProxyModel))

    def _indexes(self):
        model = self._list().model()
        return [model.index(row, 0) for row in range(model.rowCount())]

    def _name(self, index):
        return (
            str(index.data()).split("\n")[0].strip() if index.flags() & Qt.ItemFlag.ItemIsSelectable else ""
        )


@pytest.fixture
def locator(iface, desk):
    return Locator(iface)


def test_a_robot_that_the_gateway_found_is_listed_selected_and_shown(
    locator, desk, gateway, wait, make_robot, iface
):
    has_robots(gateway, "van1", "van2").set()
    locator.type("rb van")
    wait(lambda: locator.rows() == ["van1", "van2"], what="what the gateway found")
    assert locator.marked() == "van1"
    locator.press(Qt.Key.Key_Down)
    locator.press(Qt.Key.Key_Return)
    assert desk.desk.selection.robots == ("van2",)
    wait(lambda: always(gateway) == ["van2"], what="the view with the robot")
    assert iface.texts() == []
    tell(gateway, make_robot("van2", 150, 120))
    wait(lambda: abs(iface.canvas.center().x() - 488150) < 1, what="the map where it is")


def test_the_very_name_is_found_behind_many_that_hold_it(locator, gateway, wait):
    has_robots(gateway, "17", *(f"1{number}17" for number in range(10, 70)), "1700").set()
    locator.type("rb 17")
    wait(lambda: "17" in locator.rows(), what="what the gateway found")
    assert locator.marked() == "17"
    assert len(gateway.requests_of("find_robots")) == 2


def test_the_name_in_other_letters_is_found_behind_many_that_hold_it(locator, desk, gateway, wait):
    has_robots(gateway, "Van-7", *(f"1{number}-van-7" for number in range(10, 70)), "van-70").set()
    locator.type("rb van-7")
    wait(lambda: "Van-7" in locator.rows(), what="what the gateway found")
    assert locator.marked() == "Van-7"
    locator.press(Qt.Key.Key_Return)
    wait(lambda: desk.desk.selection.robots == ("Van-7",), what="the robot")


def test_of_names_that_differ_by_case_all_are_listed_and_the_one_that_was_typed_first(
    locator, desk, gateway, wait
):
    has_robots(gateway, "VAN-7", "Van-7", "van-7", *(f"1{number}-van-7" for number in range(10, 70))).set()
    locator.type("rb Van-7")
    wait(lambda: {"VAN-7", "Van-7", "van-7"} <= {*locator.rows()}, what="what the gateway found")
    assert locator.rows()[0] == "Van-7" and {*locator.rows()[1:3]} == {"VAN-7", "van-7"}
    locator.press(Qt.Key.Key_Return)
    wait(lambda: desk.desk.selection.robots == ("Van-7",), what="the robot that was typed")


def test_of_names_that_differ_by_case_the_row_that_was_chosen_is_gone_to(locator, desk, gateway, wait):
    has_robots(gateway, "VAN-7", "Van-7").set()
    locator.type("rb van-7")
    wait(lambda: {*locator.rows()} == {"VAN-7", "Van-7"}, what="what the gateway found")
    locator.press(Qt.Key.Key_Down)
    chosen = locator.marked()
    assert chosen == locator.rows()[1]
    locator.press(Qt.Key.Key_Return)
    wait(lambda: desk.desk.selection.robots == (chosen,), what="the robot of the row")


def test_enter_waits_for_the_letters_that_were_typed_though_another_case_is_known(
    locator, desk, gateway, wait, make_robot
):
    tell(gateway, make_robot("VAN1", 20, 20))
    wait(lambda: value("robot_state('VAN1')"), what="another robot")
    answers = has_robots(gateway, "VAN1", "van1")
    locator.type("rb van1")
    wait(lambda: locator.marked() == "VAN1" and searched(gateway) == ["van1"], what="the list")
    locator.press(Qt.Key.Key_Return)
    assert desk.desk.selection.robots == ()
    answers.set()
    wait(lambda: desk.desk.selection.robots == ("van1",), what="the robot that was typed")


def test_a_search_that_is_refused_is_made_again(locator, gateway, wait):
    has_robots(gateway, "van1").set()
    find, refused = gateway.answers["find_robots"], []

    def refuse_first(params):
        if refused:
            return find(params)
        refused.append(params)
        return {"error": {"code": -32001, "message": "too many messages; wait"}}

    gateway.answers["find_robots"] = refuse_first
    locator.type("rb van")
    wait(lambda: locator.rows() == ["van1"], what="what the gateway found")
    assert refused


def test_nothing_is_waited_for_in_the_windows_thread(locator, gateway, wait):
    answers = has_robots(gateway, "van1")
    locator.type("rb van1")
    wait(lambda: searched(gateway) == ["van1"], what="the search")
    assert locator.rows() == []
    answers.set()
    wait(lambda: locator.rows() == ["van1"], what="what the gateway found")


def test_what_changes_with_each_letter_is_asked_for_seldom(desk, gateway, wait, monkeypatch):
    has_robots(gateway).set()
    monkeypatch.setattr("fleet_supervisor.plugin.control.view_subscription.LEAST_REST_S", 1.0)
    for text in ("v", "va", "van"):
        desk.desk.search.search(text)
        desk.desk.search.renew()
    wait(lambda: searched(gateway)[-1:] == ["van"], what="the search")
    assert searched(gateway) == ["v", "van"]


def test_what_was_found_for_other_letters_is_not_listed(locator, desk, gateway, wait):
    answers = has_robots(gateway, "van1", "van2")
    locator.type("rb van")
    wait(lambda: searched(gateway) == ["van"], what="the search")
    # QGIS looks for it in a moment only.
    locator.field.blockSignals(True)
    QTest.keyClicks(locator.field, "2")
    answers.set()
    wait(lambda: not desk.desk.search.awaits("van"), what="the answer")
    assert locator.rows() == []


def test_enter_before_the_answer_waits_for_the_robot_that_was_typed(locator, desk, gateway, wait, make_robot):
    tell(gateway, make_robot("van10", 20, 20))
    wait(lambda: value("robot_state('van10')"), what="another robot")
    answers = has_robots(gateway, "van1", "van10")
    locator.type("rb van1")
    wait(lambda: locator.marked() == "van10" and searched(gateway) == ["van1"], what="the list")
    locator.press(Qt.Key.Key_Return)
    assert desk.desk.selection.robots == ()
    answers.set()
    wait(lambda: desk.desk.selection.robots == ("van1",), what="the robot that was typed")


def test_enter_goes_to_the_row_where_the_gateway_has_no_robot_that_is_named_so(
    locator, desk, gateway, wait, make_robot
):
    tell(gateway, make_robot("van10", 20, 20))
    wait(lambda: value("robot_state('van10')"), what="another robot")
    answers = has_robots(gateway, "a-van1", "van10")
    locator.type("rb van1")
    wait(lambda: locator.marked() == "van10" and searched(gateway) == ["van1"], what="the list")
    locator.press(Qt.Key.Key_Return)
    answers.set()
    wait(lambda: desk.desk.selection.robots == ("van10",), what="the robot of the row")


def test_a_choice_that_waits_is_given_up_where_another_robot_is_selected(
    locator, desk, gateway, wait, make_robot
):
    tell(gateway, make_robot("van10", 20, 20))
    wait(lambda: value("robot_state('van10')"), what="another robot")
    answers = has_robots(gateway, "van1")
    locator.type("rb van1")
    wait(lambda: locator.marked() == "van10" and searched(gateway) == ["van1"], what="the list")
    locator.press(Qt.Key.Key_Return)
    desk.desk.selection.select("r2")
    answers.set()
    wait(lambda: locator.rows()[:1] == ["van1"], what="what the gateway found")
    assert desk.desk.selection.robots == ("r2",)


def test_a_row_that_was_marked_by_hand_stays_marked_and_is_gone_to_at_once(
    locator, desk, gateway, wait, make_robot
):
    tell(gateway, make_robot("van10", 20, 20), make_robot("old-van1", 20, 30))
    wait(lambda: value("robot_state('old-van1')"), what="other robots")
    answers = has_robots(gateway, "van1")
    locator.type("rb van1")
    wait(lambda: locator.rows() == ["van10", "old-van1"] and searched(gateway) == ["van1"], what="the list")
    locator.press(Qt.Key.Key_Down)
    assert locator.marked() == "old-van1"
    answers.set()
    wait(lambda: locator.rows() == ["van1", "van10", "old-van1"], what="what the gateway found")
    assert locator.marked() == "old-van1"
    locator.press(Qt.Key.Key_Return)
    assert desk.desk.selection.robots == ("old-van1",)


def test_a_robot_that_left_the_map_since_it_was_listed_is_gone_to(locator, desk, gateway, wait):
    has_robots(gateway).set()
    locator.type("rb r")
    wait(lambda: locator.rows() == ["r1", "r2"] and not desk.desk.search.awaits("r"), what="the list")
    tell(gateway, untracked=["r2"])
    wait(lambda: value("robot_state('r2')") is None, what="a robot out of view")
    locator.press(Qt.Key.Key_Down)
    locator.press(Qt.Key.Key_Return)
    assert desk.desk.selection.robots == ("r2",)


def test_where_it_is_unknown_for_long_the_operator_is_told(locator, desk, gateway, wait, iface, monkeypatch):
    has_robots(gateway, "van1").set()
    locator.type("rb van1")
    wait(lambda: locator.rows() == ["van1"], what="what the gateway found")
    monkeypatch.setattr("fleet_supervisor.plugin.map.live_view.SOUGHT_FOR_S", 0.2)
    locator.press(Qt.Key.Key_Return)
    wait(lambda: any("van1 has not said yet where it is" in text for text in iface.texts()), what="a text")


def test_where_all_robots_are_known_the_gateway_is_not_asked(at_desk, iface, gateway, wait):
    locator = Locator(iface)
    wait(lambda: value("robot_state('r2')") == "fresh", what="what expressions are told of")
    locator.type("rb r2")
    wait(lambda: locator.rows() == ["r2"], what="the list")
    assert value("robot_state('r9')") is None
    QTest.qWait(200)
    at_desk.desk.abort_all()
    wait(lambda: gateway.requests_of("abort_all"), what="what was sent after it")
    assert searched(gateway) == []
    assert always(gateway) == []


# --- Expressions ---


def test_a_robot_that_an_expression_names_is_asked_for_and_then_has_its_value(
    desk, gateway, wait, make_robot
):
    assert value("robot_state('van1')") is None
    wait(lambda: always(gateway) == ["van1"], what="the view with the robot")
    tell(gateway, make_robot("van1", 30, 40))
    wait(lambda: value("robot_state('van1')") == "fresh", what="its state")
    measured = "distance_to_robot('van1', make_point(488000, 5190000), 'EPSG:32633')"
    assert value(measured) == pytest.approx(50.0)


@pytest.mark.parametrize("name", ["robot_battery('van1')", "robot_age('van1')", "distance_to_robot('van1')"])
def test_each_function_has_it_asked_for(desk, gateway, wait, name):
    assert value(name) is None
    wait(lambda: always(gateway) == ["van1"], what="the view with the robot")


def test_it_is_noted_in_any_thread(desk, gateway, wait):
    drawn = threading.Thread(target=lambda: value("robot_state('van1')"))
    drawn.start()
    drawn.join()
    wait(lambda: always(gateway) == ["van1"], what="the view with the robot")


def test_who_is_on_the_map_and_who_can_be_no_robot_is_not_asked_for(desk, gateway, wait):
    for name in ("van1", "r1", *(f"no name {number}" for number in range(MOST_NAMED))):
        value(f"robot_state('{name}')")
    wait(lambda: "van1" in always(gateway), what="the view with the robot")
    assert always(gateway) == ["van1"]


def test_those_named_last_count_and_the_others_are_let_go(desk, gateway, wait):
    for number in range(MOST_NAMED + 1):
        value(f"robot_state('van{number}')")
    wait(lambda: len(always(gateway)) == MOST_NAMED, what="the view with the robots")
    assert "van0" not in always(gateway)
    value("robot_state('van0')")
    wait(lambda: "van0" in always(gateway), what="the view with another robot")
    assert len(always(gateway)) == MOST_NAMED
    assert "van1" not in always(gateway)


def test_who_is_not_named_for_a_minute_is_let_go(desk, gateway, wait, make_robot, monkeypatch):
    value("robot_state('van1')")
    value("robot_state('van2')")
    wait(lambda: always(gateway) == ["van1", "van2"], what="the view with the robots")
    tell(gateway, make_robot("van1", 20, 20), make_robot("van2", 60, 20))
    wait(lambda: value("robot_state('van2')") == "fresh", what="their states")
    monkeypatch.setattr("fleet_supervisor.plugin.expressions.NAMED_FOR_S", 0.5)

    def let_go():
        # It is known by now, and goes on being named.
        value("robot_state('van1')")
        return always(gateway) == ["van1"]

    wait(let_go, what="the view without the other robot")
