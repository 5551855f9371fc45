"""The way to the mouse: one question at a time, the newest next, and no click is passed over."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control.request_tracker import SLOW_AFTER
from fleet_supervisor.plugin.control.route_queries import (
    SHORTEST,
    UNANSWERED_AFTER,
    RoutePreferences,
    RouteQuery,
    RouteQuestion,
    route_in_words,
)
from fleet_supervisor.plugin.gateway_client.fleet_state import RequestResult
from fleet_supervisor.plugin.map.tools.route_tool import RoutePreferencesDialog, surfaces_of
from fleet_supervisor.plugin.ui.errors import NotSentError
from fleet_supervisor.robot_bridge.core.messages.roads import RouteReport, SurfaceMetres
from qgis.PyQt.QtWidgets import QLineEdit, QPushButton, QWidget


class Gateway:
    """Answers when the test says so."""

    def __init__(self):
        self.orders = []
        self.now = 0.0

    def answer(self, preview, **how):
        result = {"points": [[0, 0], [1, 1]], "metres": 1.4, "seconds": 1.0}
        return preview.accept_answer(RequestResult(self.orders[-1], **(how or {"result": result})))

    def submit(self, order):
        self.orders.append(order)

    def steady(self):
        return self.now

    def goals(self):
        return [order.params["x"] for order in self.orders]


@pytest.fixture
def gateway():
    return Gateway()


@pytest.fixture
def preview(qgis_app, gateway):
    return RouteQuery(gateway, gateway)


def to(x, **how):
    return RouteQuestion("r1", None, (x, 0.0), **how)


def test_while_one_is_under_way_only_the_newest_waits(preview, gateway):
    for x in (1.0, 2.0, 3.0, 4.0):
        preview.want(to(x))
    assert gateway.goals() == [1.0]
    gateway.answer(preview)
    assert gateway.goals() == [1.0, 4.0]
    assert preview.route.metres == 1.4
    gateway.answer(preview)
    assert gateway.goals() == [1.0, 4.0]


def test_a_click_is_answered_though_the_mouse_moves_on(preview, gateway):
    taken = []
    preview.answered.connect(lambda question, route: taken.append(question.goal))
    preview.want(to(1.0))
    preview.want(to(2.0, taken=True))
    preview.want(to(3.0))
    gateway.answer(preview)
    assert gateway.goals() == [1.0, 2.0]
    gateway.answer(preview)
    assert taken == [(2.0, 0.0)]


def test_a_lost_question_holds_nothing_up_and_its_late_answer_shows_nothing(preview, gateway):
    preview.want(to(1.0))
    lost = gateway.orders[-1]
    gateway.now = 3.1
    preview.want(to(2.0))
    assert gateway.goals() == [1.0, 2.0]
    assert preview.accept_answer(RequestResult(lost, result={"points": [[9, 9]], "metres": 9, "seconds": 9}))
    assert preview.route is None


def test_a_click_that_stays_unanswered_is_told_once_and_its_late_answer_leads_no_leg(preview, gateway):
    taken, refused = [], []
    preview.answered.connect(lambda question, route: taken.append(question.goal))
    preview.refused.connect(refused.append)
    preview.want(to(1.0, taken=True))
    gateway.now = SLOW_AFTER - 0.1
    preview.want(to(2.0))
    preview.watch()
    assert (gateway.goals(), refused, preview.awaits_click) == ([1.0], [], True)
    lost = gateway.orders[-1]
    gateway.now = SLOW_AFTER
    preview.watch()
    preview.watch()
    assert len(refused) == 1 and "5 s" in refused[0] and "Click there again" in refused[0]
    assert gateway.goals() == [1.0, 2.0], "what the mouse leads to meanwhile"
    assert not preview.awaits_click
    preview.accept_answer(RequestResult(lost, result={"points": [[9, 9]], "metres": 9, "seconds": 9}))
    assert taken == []


def test_a_click_that_waits_too_long_is_told_though_the_mouse_moves_first(preview, gateway):
    refused = []
    preview.refused.connect(refused.append)
    preview.want(to(1.0, taken=True))
    gateway.now = SLOW_AFTER
    preview.want(to(2.0))
    assert len(refused) == 1 and gateway.goals() == [1.0, 2.0]


def test_clicks_that_are_forgotten_or_cannot_be_asked_are_told(preview, gateway, monkeypatch):
    dropped = []
    preview.dropped.connect(lambda questions: dropped.append([question.goal[0] for question in questions]))
    preview.want(to(1.0, taken=True))
    preview.want(to(2.0, taken=True))
    preview.forget()
    preview.want(to(3.0))
    preview.forget()
    assert dropped == [[1.0, 2.0]]
    preview.want(to(4.0))
    preview.want(to(5.0, taken=True))
    monkeypatch.setattr(gateway, "submit", _no_link)
    gateway.answer(preview)
    assert dropped == [[1.0, 2.0], [5.0]]


def _no_link(order):
    raise NotSentError("not connected")


def test_a_click_behind_a_lost_question_is_asked_though_the_mouse_stands_still(preview, gateway):
    preview.want(to(1.0))
    preview.want(to(2.0, taken=True))
    gateway.now = UNANSWERED_AFTER
    preview.watch()
    assert gateway.goals() == [1.0, 2.0]


def test_an_answer_that_is_late_is_shown_as_long_as_nothing_else_was_asked(preview, gateway):
    preview.want(to(1.0))
    gateway.now = SLOW_AFTER + 1
    preview.watch()
    gateway.answer(preview)
    assert preview.route.metres == 1.4


def test_why_there_is_no_way_is_said_and_a_click_there_refused(preview, gateway):
    refused = []
    preview.refused.connect(refused.append)
    preview.want(to(1.0))
    gateway.answer(preview, error="the road is closed")
    assert (preview.route, preview.why_not, refused) == (None, "the road is closed", [])
    preview.want(to(1.0, taken=True))
    gateway.answer(preview, error="the road is closed")
    assert refused == ["the road is closed"]


def test_what_is_no_way_is_said_and_other_answers_are_left_alone(preview, gateway):
    preview.want(to(1.0))
    gateway.answer(preview, result={})
    assert "holds no way" in preview.why_not


def test_what_is_wanted_of_the_way_is_asked_of_the_gateway(preview, gateway):
    preferences = RoutePreferences(fastest=True, surfaces=("asphalt",), least_width=3.5, avoid_reserved=True)
    preview.want(to(1.0))
    gateway.answer(preview)
    preview.want(to(2.0, preferences=preferences))
    names = ("fastest", "surfaces", "least_width", "avoid_reserved")
    plain, wished = ([order.params.get(name) for name in names] for order in gateway.orders)
    assert plain == [False, None, 0.0, False]
    assert wished == [True, ["asphalt"], 3.5, True]


def test_what_was_wanted_stands_beside_the_way():
    route = RouteReport([(0.0, 0.0), (9.0, 0.0)], 9.0, 5.0)
    preferences = RoutePreferences(
        fastest=True, surfaces=("asphalt", "gravel"), least_width=3.5, avoid_reserved=True
    )
    assert route_in_words(route, SHORTEST) == "9.0 m, 5 s"
    told = (
        "the fastest way, off the roads of other robots, only on asphalt, gravel, roads at least 3.5 m wide"
    )
    assert route_in_words(route, preferences, apart="\n") == f"9.0 m, 5 s\n{told}"


def test_names_of_surfaces_are_read_with_commas_between():
    assert surfaces_of(" asphalt,, slippery section ,asphalt") == ("asphalt", "slippery section")
    assert surfaces_of(" ") == ()


def test_a_way_on_one_surface_tells_its_metres_once():
    def words(*surfaces):
        route = RouteReport([], 336.9, 59.0, [SurfaceMetres(name, metres) for name, metres in surfaces])
        return route_in_words(route, SHORTEST)

    assert words(("", 338.0)) == "336.9 m, 59 s, surface not known"
    assert words(("asphalt", 300.0), ("", 38.0)) == "336.9 m, 59 s, 300 m asphalt, 38 m surface not known"


def test_the_dialog_begins_with_what_holds_and_gives_what_was_changed(qgis_app):
    preferences = RoutePreferences(
        fastest=True, surfaces=("asphalt", "gravel"), least_width=3.5, avoid_reserved=True
    )
    window = QWidget()
    confirmed = []
    for begin in (preferences, SHORTEST):
        dialog = RoutePreferencesDialog(begin, window)
        dialog.confirmed.connect(confirmed.append)
        if begin is SHORTEST:
            dialog.findChild(QLineEdit, "fleet_way_wishes_surfaces").setText("gravel")
        dialog.findChild(QPushButton, "fleet_way_wishes_confirm").click()
    dialog = RoutePreferencesDialog(preferences, window)
    dialog.confirmed.connect(confirmed.append)
    dialog.findChild(QPushButton, "fleet_way_wishes_dialog_cancel").click()
    assert confirmed == [preferences, RoutePreferences(surfaces=("gravel",))]
