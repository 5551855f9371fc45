"""A desk that is told of the robots in its view: what it asks for, and what becomes of those out of view."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.control import view_subscription
from fleet_supervisor.plugin.gateway_client import protocol
from fleet_supervisor.plugin.map.overlay.scene import FollowMode
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.positions import fleet_view
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import QLabel

SITE = {
    "robots": 100_000,
    "fresh": 99_000,
    "stale": 0,
    "lost": 600,
    "offline": 400,
    "inside": 2,
    "alarmed": 0,
}
CELLS = {"cell": 16.0, "x": 0.0, "y": 0.0, "columns": 8, "rows": 6, "cells": [0, 27]}
DENSITY = {**CELLS, "fresh": [40_000, 0], "silent": [0, 7], "offline": [0, 0]}


@pytest.fixture
def many(gateway):
    """The gateway says of itself that it has very many robots."""
    gateway.who["robots"] = 100_000


@pytest.fixture
def desk(many, at_desk, gateway, wait):
    """A desk that was told of the two robots in its view."""
    tell(gateway, *gateway.robots.values(), everything=True, view=SITE)
    wait(lambda: at_desk.desk.state.robots.fleet is not None, what="the view")
    return at_desk


def tell(gateway, *robots, **more):
    gateway.tell("positions", {"t": time.time(), "robots": [to_json(one) for one in robots], **more})


def views(gateway):
    return [params.get("view") for params in gateway.requests_of("subscribe")]


def asks(gateway, wait, true):
    """Wait for a view that is asked for, and return it."""
    wait(lambda: any(one is not None and true(one) for one in views(gateway)), what="the view")
    return [one for one in views(gateway) if one is not None and true(one)][-1]


def test_it_asks_for_the_site_first_and_then_for_what_the_canvas_shows(desk, gateway, iface, wait):
    assert views(gateway)[0]["bounds"] == list(gateway.site.bounds)
    iface.look_at(40, 30, 60, 50)
    view = asks(gateway, wait, lambda one: one["bounds"][2] - one["bounds"][0] < 100)
    shown = iface.canvas.extent()
    x_min = shown.xMinimum() - gateway.site.origin[0]
    assert view["bounds"][0] == pytest.approx(max(x_min, -25.0) - 0.25 * shown.width(), abs=20)
    assert view["bounds"][0] < x_min
    assert view["alarms"] == {"low_battery": 0.2, "unsure": 2.0, "outside": 0.5}


def test_a_canvas_that_moves_a_little_asks_for_nothing(desk, gateway, iface, wait):
    iface.look_at(40, 30, 60, 50)
    asked = asks(gateway, wait, lambda one: one["bounds"][2] - one["bounds"][0] < 100)
    count = len(views(gateway))
    iface.look_at(41, 30, 61, 50)
    for _ in range(3):
        desk.desk.view._polled_at = -1.0
        desk.desk.view.renew()
    iface.look_at(90, 30, 110, 50)
    asks(gateway, wait, lambda one: one["bounds"][0] > asked["bounds"][0] + 20)
    assert len(views(gateway)) == count + 1


def test_selected_robots_are_asked_for_wherever_they_are(desk, gateway, wait):
    desk.desk.selection.select("r2")
    asks(gateway, wait, lambda one: one["always"] == ["r2"])


def test_the_search_brings_robots_from_anywhere(desk, gateway, wait):
    gateway.answers["find_robots"] = lambda params: {
        "result": {
            "t": 1.0,
            "robots": [
                {"robot": f"x-{params['text']}", "state": "fresh", "age": 0.1},
                {"robot": "no name", "state": "fresh", "age": 0.1},
            ],
            "count": 2,
        }
    }
    desk.dock.robots._search.setText("van 17")
    assert asks(gateway, wait, lambda one: one["always"])["always"] == ["x-van"]
    desk.dock.robots._search.setText("")
    wait(lambda: views(gateway)[-1]["always"] == [], what="the end of the search")


def select(desk, gateway, wait, *robots):
    """Select robots; what is told next is all that the desk is told."""
    gateway.robots.clear()
    desk.desk.selection.select_all(robots)
    asks(gateway, wait, lambda one: one["always"] == [*robots])


def test_who_is_out_of_view_is_neither_removed_nor_lost(desk, gateway, wait, iface, make_robot):
    task = {"task": "t1", "kind": "place", "state": "waiting", "added_by": "anna", "added_at": 1.0}
    queue = {"robot": "r1", "revision": 1, "state": "paused", "robot_state": "fresh"}
    gateway.tell("queue", {**queue, "tasks": [{**task, "robot": "r1", "x": 6.0, "y": 5.0}]})
    wait(lambda: len(list(desk.desk.state.queues)) == 1, what="the queue")
    select(desk, gateway, wait, "r1")
    tell(gateway, untracked=["r1"])
    wait(lambda: len(desk.desk.state.robots) == 1, what="the news")
    assert desk.desk.selection.robots == ("r1",)
    assert [one.robot for one in desk.desk.state.queues] == ["r1"]
    assert iface.texts() == []
    tell(gateway, make_robot("r1"))
    wait(lambda: len(desk.desk.state.robots) == 2, what="its return")


def test_who_is_gone_is_removed_though_others_are_out_of_view(desk, gateway, wait):
    select(desk, gateway, wait, "r1", "r2")
    tell(gateway, untracked=["r1"], removed=["r2"])
    wait(lambda: len(desk.desk.state.robots) == 0, what="the news")
    assert desk.desk.selection.robots == ("r1",)


def test_the_table_says_how_many_there_are(desk, gateway, wait):
    label = desk.dock.findChild(QLabel, "fleet_robot_count")
    wait(lambda: label.text() == "2 of 100000", what="the count")
    assert "The search finds others by name" in label.toolTip()


def test_a_density_is_painted_where_robots_are_and_goes_when_they_come_singly(desk, gateway, iface, wait):
    iface.look_at(0, 0, 120, 100)
    tell(gateway, untracked=["r1", "r2"], view={**SITE, "inside": 40_007, "density": DENSITY})

    def colour(x, y):
        at = iface.pixel(x, y)
        return QColor(iface.canvas.grab().toImage().pixel(at.x(), at.y()))

    wait(lambda: colour(8, 8).blue() > colour(8, 8).red() + 60, what="a cell of fresh robots")
    silent, empty = colour(56, 56), colour(40, 8)
    assert silent.red() > silent.blue() + 30
    assert empty.red() == empty.green() == empty.blue()
    tell(gateway, *gateway.robots.values(), view=SITE)
    wait(lambda: colour(8, 8) == empty, what="the map without cells")


def test_with_few_robots_left_it_asks_for_all_of_them_again(desk, gateway, wait):
    asks(gateway, wait, lambda one: True)
    wait(lambda: desk.desk.view._asked is not None, what="the first view of the canvas")
    tell(gateway, view={**SITE, "robots": 3000})
    wait(lambda: views(gateway)[-1] is None, what="a subscription without a view")
    tell(gateway, *gateway.robots.values(), everything=True)
    wait(lambda: desk.desk.state.robots.fleet is None, what="all robots")


def test_all_are_not_followed_by_those_in_view(desk, gateway, wait, iface):
    iface.look_at(0, 0, 20, 20)
    desk.view.follow(FollowMode.ALL)
    before = iface.canvas.extent()
    desk.view._go_after()
    assert iface.canvas.extent() == before


def test_a_small_fleet_and_an_older_gateway_are_asked_for_all(at_desk, gateway, wait, monkeypatch):
    monkeypatch.setattr(view_subscription, "VIEWS_FROM", 1)
    monkeypatch.setattr(protocol, "VIEWS_FROM", 1)
    wait(lambda: at_desk.desk.view._asked is not None, what="what the canvas shows")
    at_desk.desk.abort_all()
    wait(lambda: gateway.requests_of("abort_all"), what="what was sent after it")
    assert views(gateway) == [None]


@pytest.mark.parametrize(
    "density",
    [
        {**DENSITY, "cells": [0, 48]},
        {**DENSITY, "fresh": [1]},
        {**DENSITY, "silent": [0, -1]},
        {**DENSITY, "cell": 0.0},
        {**DENSITY, "cell": float("nan")},
        {**DENSITY, "columns": 100_000},
        {**DENSITY, "x": "here"},
    ],
)
def test_a_density_that_is_none_is_refused(density):
    assert fleet_view({**SITE, "density": DENSITY}).density.fresh == [40_000, 0]
    with pytest.raises((ValueError, TypeError)):
        fleet_view({**SITE, "density": density})
