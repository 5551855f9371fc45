"""A cone plan and the roads that are closed at the gateway."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from fleet_supervisor.plugin.planning.proposal import _Road, closed_ways
from fleet_supervisor.plugin.ui import scheduling
from fleet_supervisor.robot_bridge.core.messages.roads import ClosureReport
from qgis.PyQt import sip

from tests.plugin.planning.panel_parts import SHORT, answer, closing, planned, question, way_to


def test_a_plan_is_made_round_the_roads_that_are_closed_at_the_gateway(far_cones, gateway, wait):
    straight = way_to(planned(far_cones, wait), "far-1")
    assert max(y for _, y in straight) < 50
    assert far_cones.bar.trouble.text() == ""
    gateway.tell("closures", closing(SHORT))
    wait(lambda: "leads along a road that bert closed (tree)" in far_cones.bar.trouble.text(), 5)
    text = question(far_cones).text()
    assert "to far-1 leads along a road that bert closed (tree)" in text
    answer(far_cones.question, send=False)
    round_it = way_to(planned(far_cones, wait), "far-1")
    assert max(y for _, y in round_it) > 85
    assert far_cones.bar.trouble.text() == ""
    gateway.tell("closures", closing())
    wait(lambda: not far_cones._desk.state.closures, 5)
    assert max(y for _, y in way_to(planned(far_cones, wait), "far-1")) < 50


@pytest.mark.parametrize(
    ("way", "leads"),
    [
        ([(0, 40), (60, 40), (60, 90)], False),
        ([(0, 40), (60, 40)], False),
        ([(60, 0), (60, 90)], False),
        ([(0, 40), (64, 40)], True),
        ([(60, 90), (60, 40), (75, 40)], True),
    ],
)
def test_a_way_that_only_touches_the_end_of_a_closed_road_does_not_lead_along_it(way, leads):
    road = _Road(ClosureReport("c", SHORT, 0.0, "bert"))
    assert road.is_along(np.array(way, float)) is leads


class Held:
    """Looks at closed roads that come to a halt after one step each, until they are let go."""

    def __init__(self, dock, monkeypatch):
        monkeypatch.setattr(scheduling, "SLICE_SECONDS", 0.0)
        looks = (dock.drafts._closure_check, dock.drafts._made_check)
        self._timers = [look._slices._timer for look in looks]
        for timer in self._timers:
            timer.setInterval(3_600_000)

    @property
    def under_way(self):
        return any(timer.isActive() for timer in self._timers)

    def let_go(self):
        for timer in self._timers:
            timer.setInterval(0)
            if timer.isActive():
                timer.start()


@pytest.fixture
def held(far_cones, monkeypatch):
    return Held(far_cones, monkeypatch)


def close_road(dock, gateway, wait):
    gateway.tell("closures", closing(SHORT))
    wait(lambda: dock._desk.state.closures, 5)


def test_the_window_goes_on_while_a_plan_is_held_against_closed_roads(far_cones, held, gateway, wait):
    plan = planned(far_cones, wait)
    close_road(far_cones, gateway, wait)
    assert len(list(closed_ways(plan, far_cones._desk.state.closures))) == 1 + len(list(plan.all_stops()))
    assert held.under_way
    assert far_cones.drafts.draft.closed == () and far_cones.bar.trouble.text() == ""
    held.let_go()
    wait(lambda: "leads along a road that bert closed" in far_cones.bar.trouble.text(), 5)
    assert not held.under_way


def test_a_plan_that_took_the_place_of_another_is_left_alone_by_what_was_found_of_that(
    far_cones, held, gateway, wait
):
    planned(far_cones, wait)
    close_road(far_cones, gateway, wait)
    far_cones.drafts.set_proposal(None)
    held.let_go()
    wait(lambda: not held.under_way, 5)
    assert far_cones.drafts.draft is None


def test_a_plan_is_not_there_before_it_was_held_against_a_road_that_was_closed_meanwhile(
    far_cones, held, gateway, wait
):
    plan = planned(far_cones, wait)
    drafts, told, go_on = far_cones.drafts, [], threading.Event()
    drafts.run("a plan", drafts.draft, lambda task: (go_on.wait(60.0), plan)[1], told.append)
    close_road(far_cones, gateway, wait)
    go_on.set()
    wait(lambda: drafts._made_check._slices._timer.isActive(), 15)
    assert drafts.busy and told == []
    held.let_go()
    wait(lambda: not drafts.busy, 5)
    (made,) = told
    assert [one.stop for one in made.closed] == ["far-1"]


def test_the_panel_outlives_a_task_that_qgis_deleted_while_its_plan_is_held_against_roads(
    far_cones, held, gateway, wait
):
    plan = planned(far_cones, wait)
    drafts, go_on = far_cones.drafts, threading.Event()
    drafts.run("a plan", drafts.draft, lambda task: (go_on.wait(60.0), plan)[1], lambda made: None)
    close_road(far_cones, gateway, wait)
    go_on.set()
    wait(lambda: drafts.task is not None and sip.isdeleted(drafts.task), 15, "the end of the task")
    far_cones._pulled()
    far_cones.cancel.click()
    assert not drafts.busy
    held.let_go()


def test_nothing_is_looked_at_once_the_plugin_is_unloaded(far_cones, held, gateway, wait, plugin):
    planned(far_cones, wait)
    close_road(far_cones, gateway, wait)
    assert held.under_way
    plugin.unload()
    assert not held.under_way
