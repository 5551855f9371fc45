"""A cone plan and the roads that are closed at the gateway."""

from __future__ import annotations

from tests.plugin.desk.plans.panel_parts import (
    SHORT,
    answer,
    closing,
    offered,
    planned,
    press,
    question,
    way_to,
)


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
    wait(lambda: not far_cones._desk.roads.closures, 5)
    assert max(y for _, y in way_to(planned(far_cones, wait), "far-1")) < 50


def test_a_road_that_is_closed_under_a_plan_that_is_driven_is_told_until_another_is_agreed_to(
    far_cones, gateway, wait, iface
):
    planned(far_cones, wait)
    answer(question(far_cones), send=True)
    wait(lambda: gateway.asked("set_queue") and not far_cones.driven.busy, 10)
    gateway.tell("closures", closing(SHORT))
    wait(lambda: far_cones.driven.trouble.closed, 5)

    def told():
        return [text for text in iface.texts() if "leads along a road that bert closed" in text]

    assert len(told()) == 1
    offered(far_cones, wait)
    assert max(y for _, y in way_to(far_cones.driven.offer.plan, "far-1")) > 85
    assert len(told()) == 1, "nobody has agreed yet"
    press(far_cones, "fleet_plan_confirm")
    wait(lambda: not far_cones.driven.busy, 10)
    assert told() == []
    assert far_cones.driven.trouble.closed == ()


def test_a_road_that_is_opened_again_is_no_trouble_any_more(far_cones, gateway, wait, iface):
    planned(far_cones, wait)
    answer(question(far_cones), send=True)
    wait(lambda: gateway.asked("set_queue") and not far_cones.driven.busy, 10)
    gateway.tell("closures", closing(SHORT))
    wait(lambda: far_cones.driven.trouble.closed, 5)
    gateway.tell("closures", closing())
    wait(lambda: not far_cones.driven.trouble, 5)
    assert not any("closed" in text for text in iface.texts())
