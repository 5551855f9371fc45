"""What several gateways share goes for all of them: the chosen site, accepted observations, queues."""

from __future__ import annotations

import itertools
import json
import shutil
import urllib.request
from dataclasses import replace

import pytest

from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.sites.site import read_site, write_site
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.gateway_pair import GatewayPair, desk_at
from tests.support.errors import StageError
from tests.support.patience import BUSY

NUMBERS = itertools.count(1)


def publish(folder, sample, **changes):
    site = read_site(sample)
    settings = replace(site.settings, **changes)
    write_site(folder, settings, site.outlines, site.centrelines, site.surfaces, site.keepouts)


@pytest.fixture(scope="module")
def sites(tmp_path_factory, sample_site):
    """The sites of each gateway's computer, in a folder of its own."""
    folders = {}
    for name in "ab":
        folders[name] = folder = tmp_path_factory.mktemp(f"sites-{name}")
        (folder / "north").mkdir()
        for file in ("site.toml", "site.gpkg"):
            shutil.copy(sample_site / file, folder / "north")
        publish(folder / "south", sample_site, id="south", name="South field")
    publish(folders["a"] / "east", sample_site, id="east", name="East field")
    return folders


@pytest.fixture(scope="module")
def pair(start_bridge, sites, fleet_url, tmp_path_factory):
    """On PostgreSQL's notifications alone."""
    start = {name: sites[name] / "north" for name in "ab"}
    return GatewayPair(start_bridge, start, fleet_url, tmp_path_factory.mktemp("state"))


@pytest.fixture
def name():
    return f"robot-{next(NUMBERS)}"


def hearing(bridge, operator="Ben"):
    """Connect as an operator; return the desk, and the notifications that it hears as they come."""
    desk, told = bridge.desk(operator), []
    hear = desk._hear
    desk._hear = lambda frame: (told.append(frame), hear(frame))
    return desk, told


def site_told(told, **values):
    reports = [frame["params"] for frame in told if frame["method"] == "site"]
    return bool(reports) and all(reports[-1].get(key) == value for key, value in values.items())


def health_of(bridge):
    url = bridge.address.replace("ws://", "http://") + "/healthz"
    with urllib.request.urlopen(url, timeout=BUSY * 10) as page:
        return json.load(page)


def test_a_gateway_with_a_site_of_another_frame_does_not_enter_the_fleet(
    pair, start_bridge, sites, sample_site, fleet_url, tmp_path
):
    # First of all: nobody has chosen a site yet, which would be served in place of the given one.
    publish(tmp_path / "far", sample_site, origin=(640_000.0, 5_193_000.0))
    options = ["--gateway-name", "far", "--state", tmp_path]
    with pytest.raises(StageError, match=r"(?s)640000, 5193000.*the same metres are other places"):
        start_bridge(tmp_path / "far", fleet_url, options)
    assert desk_at(pair.a).ask("get_sites")["sites"]


def test_a_choice_of_a_site_goes_for_all_gateways(pair, name):
    robot, ada, (ben, told) = pair.robot(pair.b, name), pair.a.desk("Ada"), hearing(pair.b)
    assert ada.ask("choose_site", {"site": "south"})["id"] == "south"
    ben.until(lambda: site_told(told, id="south"))
    assert decode(robot.hear("SetMap")).meta["id"] == "south"
    # The last choice goes, wherever it was made.
    ben.ask("choose_site", {"site": "north"})
    wait_until(lambda: pair.a.desk("Eve").site["id"] == "sample")


def test_a_gateway_that_cannot_serve_what_was_chosen_says_so_until_it_can(pair, sites, sample_site):
    ada, (ben, told) = pair.a.desk("Ada"), hearing(pair.b)
    ada.ask("choose_site", {"site": "east"})
    ben.until(lambda: told and "no site in a folder 'east'" in (told[-1]["params"].get("problem") or ""))
    assert site_told(told, id="sample")
    health = health_of(pair.b)
    assert health["site"]["ok"] is False and "east was chosen for the fleet" in health["site"]["text"]
    # Published there as well it is served.
    publish(sites["b"] / "east", sample_site, id="east", name="East field")
    ben.until(lambda: site_told(told, id="east", problem=None))
    assert "ok" not in health_of(pair.b)["site"]


def test_a_gateway_takes_the_choice_when_it_starts(pair):
    pair.a.desk("Ada").ask("choose_site", {"site": "north"})
    wait_until(lambda: pair.b.desk("Eve").site["id"] == "sample")
    pair.b.kill_gateway()
    pair.a.desk("Ada").ask("choose_site", {"site": "south"})
    pair.b.start_gateway()
    assert pair.b.desk("Eve").site["id"] == "south"


def test_a_road_that_is_closed_at_one_gateway_is_closed_at_all(pair):
    ada, (ben, told) = pair.a.desk("Ada"), hearing(pair.b)

    def closed_at_b():
        reports = [frame["params"]["closures"] for frame in told if frame["method"] == "closures"]
        return [one["closure"] for one in reports[-1]] if reports else None

    ada.ask("close_road", {"closure": "closure-1", "x": 50.0, "y": 8.0})
    ben.until(lambda: closed_at_b() == ["closure-1"])
    (closure,) = ben.ask("get_closures", {})["closures"]
    assert closure["edges"] > 0 and closure["closed_by"] == "Ada"
    ben.ask("open_road", {"closure": "closure-1"})
    wait_until(lambda: not ada.ask("get_closures", {})["closures"])


def sources_on_the_map_of(robot):
    """Return the sources of the obstacles on the map that a robot is sent around (20, 8)."""
    robot.calls.clear()
    robot.ask("GetMap", {"x": 20.0, "y": 8.0, "area": 900})
    return {obstacle.ext.get("src") for obstacle in decode(robot.hear("SetMap")).obstacles}


def test_what_operators_accept_at_one_gateway_is_on_the_maps_of_the_other(pair, name):
    here, there, (ben, told) = pair.robot(pair.a, name), pair.robot(pair.b, f"{name}-b"), hearing(pair.b)

    def state():
        news = [f["params"] for f in told if f["method"] == "observation" and f["params"]["robot"] == name]
        return news[-1]["state"] if news else None

    here.ask("SetObject", {"x": 21.5, "y": 9.0, "object": "cone-7", "radius": 0.3})
    ben.until(lambda: state() == "pending")
    (seen,) = ben.ask("get_observations", {"robot": name})["observations"]
    source = f"observation:{seen['observation']}"
    ada = pair.a.desk("Ada")
    ada.ask("review_observation", {"observation": seen["observation"], "accept": True})
    wait_until(lambda: source in sources_on_the_map_of(there))
    ben.until(lambda: state() == "accepted")
    # Taken off it again, at the other one.
    ben.ask("review_observation", {"observation": seen["observation"], "accept": False, "revise": True})
    wait_until(lambda: source not in sources_on_the_map_of(here))
    # It is told once where it happened: that gateway has looked again when it tells of the next.
    ben.until(lambda: state() == "rejected")
    here.ask("SetObject", {"x": 22.5, "y": 9.0, "object": "cone-8"})
    ben.until(lambda: state() == "pending")
    assert [f["params"]["state"] for f in told if f["method"] == "observation"].count("rejected") == 1


def tasks(desk, robot):
    """Return the tasks of a robot's queue as a desk was told of it last, each with its state."""
    queue = desk.queues.get(robot, {})
    return [(one["task"], one["state"]) for one in (*queue.get("tasks", ()), *queue.get("ended", ()))]


def test_changes_of_a_queue_elsewhere_are_told_by_themselves(pair, name):
    robot, ada, ben = pair.robot(pair.a, name), desk_at(pair.a), desk_at(pair.b)
    ben.wait_for_robots(name)
    first, second = f"{name}-task-1", f"{name}-task-2"
    wanted = [{"task": first, "x": 22.0, "y": 8.0}, {"task": second, "x": 24.0, "y": 8.0}]
    ada.ask("set_queue", {"robot": name, "revision": 0, "tasks": wanted})
    ben.until(lambda: tasks(ben, name) == [(first, "current"), (second, "waiting")])
    assert ben.queues[name]["robot_state"] == "fresh"
    # What the robot does, and what an operator elsewhere does.
    robot.hear("SetPosEnd")
    robot.tell("SendPos", {"x": 22.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    ben.until(lambda: tasks(ben, name) == [(second, "current"), (first, "done")])
    ada.ask("pause_queue", {"robot": name})
    ben.until(lambda: ben.queues[name]["state"] == "paused")
    # One who connects later asks for all of them.
    eve = pair.b.desk("Eve")
    assert name in {one["robot"] for one in eve.ask("get_queue")["queues"]}
    # Nobody tells of this one.
    pair.b.sql("update queues set reason = 'a look finds it' where robot = ?", name)
    eve.until(lambda: eve.queues.get(name, {}).get("reason") == "a look finds it")
