"""What ground is there: asked of a real gateway by robots, on either wire, and by operators."""

from __future__ import annotations

import time

import numpy as np
import pytest

from robot_bridge.core.sites.site import read_site
from tests.support.bridge.bridge_wires import RefusedError

PLACES = {
    (20.0, 8.0): "asphalt",
    (66.0, 44.0): "slippery",
    (20.0, 101.0): "parking pavement",
    (100.0, 100.0): None,
}
"""Places of the sample site by what resources/sample_site/roads_plan.py draws there."""
ON_EARTH = (16.8437884, 46.8804021)
"""(66, 44) by PROJ."""


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


def test_a_robot_asks_what_ground_is_there(robot):
    ack = robot.ask("GetSurface", {"points": list(PLACES), "source": "my 7"})
    assert ack["ok"]
    assert robot.hear("SetSurface") == {"surfaces": list(PLACES.values()), "source": "my 7"}


def test_answers_come_in_the_order_of_the_questions(robot):
    for place in PLACES:
        robot.ask("GetSurface", {"points": [place]})
    for label in PLACES.values():
        assert robot.hear("SetSurface") == {"surfaces": [label]}


def test_a_robot_asks_in_the_crs_that_it_knows(robot):
    robot.ask("GetSurface", {"points": [ON_EARTH], "crs": "EPSG:4326"})
    assert robot.hear("SetSurface") == {"surfaces": ["slippery"]}
    robot.ask("GetSurface", {"points": [(640486.0, 5193524.0)], "crs": "EPSG:32633"})
    assert robot.hear("SetSurface") == {"surfaces": ["slippery"]}


@pytest.mark.parametrize(
    ("params", "text"),
    [
        ({"points": [[46.88, 200.84]], "crs": "EPSG:4326"}, r"GetSurface: points\[0\], \(46.88, 200.84\) "),
        ({"points": [[0, 0]], "crs": "EPSG:99999"}, r"GetSurface: The CRS 'EPSG:99999' is not known to PROJ"),
        ({"points": [[0, 0]], "crs": "+proj=utm"}, r"crs is '\+proj=utm'; give a code such as 'EPSG:4326'"),
        ({"points": []}, "points holds 0 points; give 1 to 1000"),
        ({"points": [[0, 0]] * 1001}, "points holds 1001 points; give 1 to 1000"),
        ({"points": [[0, 0], [0]]}, "GetSurface: Expected `array` of length 2"),
    ],
)
def test_a_question_that_cannot_be_answered_is_refused_with_why(robot, params, text):
    with pytest.raises(RefusedError, match=text):
        robot.ask("GetSurface", params)
    robot.ask("GetSurface", {"points": [(20, 8)]})
    assert robot.hear("SetSurface") == {"surfaces": ["asphalt"]}


def test_a_robot_may_ask_while_an_emergency_stop_is_in_force(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    desk.ask("emergency_stop", {"command": "stop-for-surfaces"})
    robot.ask("GetSurface", {"points": [(20, 8)]})
    assert robot.wait_for("SetSurface")["params"] == {"surfaces": ["asphalt"]}


def test_an_operator_asks_for_many_places_at_once(bridge, sample_site):
    desk = bridge.desk()
    places = np.random.default_rng(1).uniform((0, 0), (200, 160), (10_000, 2))
    told = desk.ask("get_surface", {"points": places.tolist()})["surfaces"]
    index = read_site(sample_site).surface_index
    wanted = [None if k < 0 else index.surfaces[k].label for k in index.at_many(places)]
    assert [one and one["surface"] for one in told] == wanted
    assert {one["origin"] for one in told if one} == {"drawn"}
    assert {"asphalt", "slippery", "parking pavement", None} == set(wanted)


def test_an_operator_asks_in_any_crs_and_is_refused_with_why(bridge):
    desk = bridge.desk()
    asked = {"points": [ON_EARTH], "crs": "EPSG:4326"}
    assert desk.ask("get_surface", asked) == {"surfaces": [{"surface": "slippery", "origin": "drawn"}]}
    with pytest.raises(RefusedError, match="get_surface: The CRS 'EPSG:99999' is not known"):
        desk.ask("get_surface", {"points": [[0, 0]], "crs": "EPSG:99999"})
    with pytest.raises(RefusedError, match="points holds 10001 points; give 1 to 10000"):
        desk.ask("get_surface", {"points": [[0, 0]] * 10_001})


def test_the_reference_robot_asks_and_says_what_it_is_told(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    bridge.start_robot("asker", (45.0, 44.0, 0.0), options=["--ask-surface"])
    desk.wait_for_robots("asker")
    desk.send(f"to-the-grass-{time.time():.0f}", "asker", "SetPosEnd", x=47.0, y=52.0, cone=False)
    desk.until(lambda: desk.robots["asker"].get("status") == "slippery to no road")
