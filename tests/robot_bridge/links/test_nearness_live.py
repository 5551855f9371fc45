"""A phone, a robot and a replay on real links at a real gateway: who is told to be near whom."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robot_bridge.core.messages.robots import SendPos
from tests.support.bridge.adapter_on_the_line import LinkOnTheLine

ROBOT = SendPos(60.0, 22.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def bridge(start_bridge, limited_site):
    bridge = start_bridge(limited_site("[nearness]\nmetres = 4.0\nwithin_s = 8.0\n"))
    yield bridge
    bridge.end()


@pytest.fixture
def desk(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    return desk


@pytest.fixture
def links(bridge, tmp_path):
    """A link of robots, one of phones, and one that replays, by the kind of each."""
    links = {}
    for kind in ("robots", "phones", "replay"):
        links[kind] = LinkOnTheLine(bridge, tmp_path, kind, kind="replay" if kind == "replay" else "obedient")
    yield links
    for link in links.values():
        link.end()


def show(link, name, pose, abilities=()):
    link.do("add", name, abilities)
    link.do("position", name, pose)


def pairs(desk):
    return {(one["seen"], one["robot"], one["seconds"] > 0) for one in desk.nearness.get("alarms", [])}


def test_a_phone_comes_near_is_near_and_goes_and_a_replay_is_near_to_nobody(links, desk):
    show(links["robots"], "agv-1", ROBOT, ("targets", "paths"))
    show(links["replay"], "replay-1", replace(ROBOT, x=61.0))
    show(links["phones"], "anna", replace(ROBOT, x=70.0))
    desk.wait_for_robots("agv-1", "replay-1", "anna")

    def says(expected, **pose):
        """Go on saying where the phone is, as phones do, until a desk hears just this."""

        def heard():
            links["phones"].do("position", "anna", replace(ROBOT, **pose))
            links["robots"].do("position", "agv-1", ROBOT)
            links["replay"].do("position", "replay-1", replace(ROBOT, x=61.0))
            return pairs(desk) == expected

        desk.until(heard, 15)

    says({("anna", "agv-1", True)}, x=72.0, theta=3.14159, v=1.5)
    (coming,) = desk.nearness["alarms"]
    assert coming["metres"] == 4.0
    assert 0 < coming["seconds"] <= 8.0
    says({("anna", "agv-1", False)}, x=62.5)
    assert desk.nearness["alarms"][0]["metres"] == 2.5
    says(set(), x=90.0)
    says({("anna", "agv-1", False)}, x=63.0)
    links["phones"].do("position", "anna", replace(ROBOT, x=63.0))
    links["phones"].kill()
    desk.until(lambda: desk.robots["anna"]["state"] == "lost", 30)
    desk.until(lambda: pairs(desk) == set(), 15)


def test_who_is_only_seen_is_in_no_robots_way(links, desk):
    show(links["robots"], "agv-2", replace(ROBOT, x=20.0), ("targets", "paths"))
    show(links["replay"], "replay-2", replace(ROBOT, x=30.0))
    show(links["phones"], "bert", replace(ROBOT, x=35.0))
    desk.wait_for_robots("agv-2", "replay-2", "bert")
    override = "the way is not checked; because: this is what is tried out"
    params = {"points": [[20.0, 22.0], [40.0, 22.0]]}
    desk.ask(
        "send",
        {"command": "past-both", "robot": "agv-2", "op": "SetPath", "params": params, "override": override},
    )
    desk.wait_for_step("past-both", "acknowledged")
    names = {
        name for one in desk.ask("get_conflicts", {})["conflicts"] for name in (one["robot"], one["other"])
    }
    assert not names & {"replay-2", "bert"}
