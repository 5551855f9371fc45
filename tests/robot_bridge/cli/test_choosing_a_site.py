"""Supervisors choose among the sites beside the one that is served; the choice outlives the gateway."""

from __future__ import annotations

import shutil
from dataclasses import replace

import pytest

from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.sites.site import read_site, write_site
from tests.support.bridge.bridge_programs import wait_until
from tests.support.errors import StageError
from tests.support.robots.robot_wires import map_bytes
from tests.support.wire import RefusedError


def publish(folder, sample, **changes):
    """Publish the sample site in ``folder`` with other settings."""
    site = read_site(sample)
    settings = replace(site.settings, **changes)
    write_site(folder, settings, site.outlines, site.centrelines, site.surfaces, site.keepouts)


@pytest.fixture(scope="module")
def published(tmp_path_factory, sample_site):
    """A folder of sites: two with one frame, one with another, one that cannot be read, and no site."""
    folder = tmp_path_factory.mktemp("published")
    for name in ("north", "elsewhere", "empty"):
        (folder / name).mkdir()
    for name in ("site.toml", "site.gpkg"):
        shutil.copy(sample_site / name, folder / "north")
    publish(folder / "south", sample_site, id="south", name="South field")
    publish(folder / "elsewhere", sample_site, id="elsewhere", origin=(640_000.0, 5_193_000.0))
    shutil.copytree(folder / "south", folder / "wrong")
    (folder / "wrong" / "site.gpkg").write_bytes(b"no GeoPackage")
    return folder


@pytest.fixture
def sites(published, tmp_path):
    """A copy of these sites that the test may change."""
    return shutil.copytree(published, tmp_path / "sites")


@pytest.fixture
def bridge(start_bridge, sites):
    bridge = start_bridge(sites / "north")
    yield bridge
    bridge.end()


def served(desk):
    return [one["site"] for one in desk.ask("get_sites")["sites"] if one["served"]]


def restart(bridge, *options):
    bridge.hang_up()
    bridge.kill_gateway()
    bridge.options[:] = options
    bridge.start_gateway()


def test_the_sites_are_told_with_what_keeps_them_from_being_chosen(bridge):
    offers = {one["site"]: one for one in bridge.desk().ask("get_sites")["sites"]}
    assert set(offers) == {"north", "south", "elsewhere", "wrong"}
    assert offers["north"] == {
        "site": "north",
        "served": True,
        "id": "sample",
        "name": "Sample proving ground and campus",
        "version": 1,
    }
    assert offers["south"]["name"] == "South field" and "refusal" not in offers["south"]
    assert "elsewhere has another frame" in offers["elsewhere"]["refusal"]


def test_a_chosen_site_is_served_and_robots_and_desks_are_told(bridge):
    robot, desk, other = bridge.robot("r1"), bridge.desk(), bridge.desk("Ben")
    robot.plug_in(1)
    told = []
    other._hear = told.append
    assert desk.ask("choose_site", {"site": "south"})["id"] == "south"
    other.until(lambda: [f for f in told if f["method"] == "site" and f["params"]["id"] == "south"])
    assert decode(map_bytes(robot.wait_for("SetMap"))).meta["id"] == "south"
    assert served(desk) == ["south"]
    assert bridge.desk("Eve").site["name"] == "South field"


def test_a_choice_outlives_the_gateway_until_the_given_site_is_asked_for(bridge):
    bridge.desk().ask("choose_site", {"site": "south"})
    assert bridge.sql("select value from bridge where name = 'site'") == [("south",)]
    restart(bridge)
    assert bridge.desk().site["id"] == "south"
    said = "site south is served, which a supervisor chose, and not north"
    wait_until(lambda: said in bridge.output())
    restart(bridge, "--site-as-given")
    assert bridge.desk().site["id"] == "sample"
    restart(bridge)
    assert bridge.desk().site["id"] == "sample"


def test_a_chosen_site_is_watched_as_the_given_one_was(bridge, sites, sample_site):
    desk = bridge.desk()
    desk.ask("choose_site", {"site": "south"})
    publish(sites / "south", sample_site, id="south", name="South field", version=7)
    wait_until(lambda: desk.ask("get_sites")["sites"][2]["version"] == 7)
    wait_until(lambda: bridge.desk("Eve").site["version"] == 7)


REFUSED = {
    "elsewhere": "positions of the one are wrong in the other",
    "wrong": "sample is served on",
    "empty": "choose one of: elsewhere, north, south, wrong",
    "../sites/south": "choose one of:",
    "": "choose one of:",
}


def test_what_cannot_be_served_is_refused_and_the_site_stays(bridge):
    desk = bridge.desk()
    for site, says in REFUSED.items():
        with pytest.raises(RefusedError, match=says):
            desk.ask("choose_site", {"site": site})
        assert served(desk) == ["north"]
        assert bridge.sql("select value from bridge where name = 'site'") == []
    restart(bridge)
    assert bridge.desk().site["id"] == "sample"


def test_a_gateway_does_not_start_with_another_site_than_the_chosen_one(bridge, sites):
    bridge.desk().ask("choose_site", {"site": "south"})
    shutil.rmtree(sites / "south")
    with pytest.raises(StageError, match=r"a supervisor chose cannot be served.*--site-as-given"):
        restart(bridge)
    restart(bridge, "--site-as-given")
    assert bridge.desk().site["id"] == "sample"


def serve_elsewhere(bridge, sites):
    """Start the gateway on its database with the site of another frame."""
    bridge.hang_up()
    bridge.kill_gateway()
    bridge.site = sites / "elsewhere"
    bridge.start_gateway()


def test_a_database_with_places_in_it_is_not_served_with_a_site_of_another_frame(bridge, sites):
    robot, desk = bridge.robot("r1"), bridge.desk()
    robot.plug_in(1)
    robot.close()
    # It would drive to these numbers on the other site as soon as it is back.
    target = {"op": "SetPosEnd", "params": {"x": 24.0, "y": 8.0}}
    desk.ask("send", {"command": "waits-for-r1", "robot": "r1", **target})
    with pytest.raises(StageError, match=r"(?s)640000, 5193000.*other places.*of its own"):
        serve_elsewhere(bridge, sites)
    assert bridge.sql("select count(*) from commands") == [(1,)]


def test_a_database_without_any_place_goes_with_the_site_that_is_served(bridge, sites):
    assert bridge.desk().site["id"] == "sample"
    serve_elsewhere(bridge, sites)
    assert bridge.desk().site["id"] == "elsewhere"
    assert "640000, 5193000" in bridge.sql("select value from bridge where name = 'frame'")[0][0]
