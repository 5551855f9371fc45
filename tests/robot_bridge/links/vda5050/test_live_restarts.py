"""Vehicle, broker, adapter and gateway are killed on the way and come back: nothing lost, nothing twice."""

from __future__ import annotations

import itertools
import json
import math
import re
from dataclasses import replace

import pytest

from robot_bridge.core.sites.frame import SiteFrame
from robot_bridge.core.sites.site import read_site, write_site
from tests.robot_bridge.links.vda5050.driving import (
    SLOW,
    begin,
    orders_of,
    reason,
    send,
    steps,
    wait_at,
    wait_for_standing,
    wait_under_way,
)
from tests.robot_bridge.links.vda5050.peers import Yard
from tests.support.bridge.bridge_programs import wait_until
from tests.support.processes import Processes


def test_a_vehicle_that_is_killed_and_started_again_goes_on(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    command = send(desk, vehicle, x=40.0, y=8.0)
    wait_under_way(desk, vehicle)
    yard.kill(vehicle)
    desk.until(lambda: desk.robots[vehicle]["state"] == "lost")

    yard.start_vehicle(vehicle, 30.0, 8.0)
    desk.wait_for_step(command, "reached")
    assert steps(desk, command).count("acknowledged") == 1


def test_a_broker_that_is_killed_and_started_again_loses_nothing(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    command = send(desk, vehicle, x=30.0, y=8.0)
    wait_under_way(desk, vehicle)
    yard.kill("broker")
    desk.until(lambda: desk.robots[vehicle]["state"] == "lost")
    yard.start_broker()
    desk.wait_for_step(command, "reached", 60)
    assert steps(desk, command).count("acknowledged") == 1


def test_an_adapter_that_is_killed_and_started_again_goes_on(bridge, desk, yard):
    vehicle = begin(yard, desk, speed=3.0)
    points = [[20.0, 8.0], [44.0, 8.0], [44.0, 14.0]]
    command = send(desk, vehicle, "SetPath", points=points)
    wait_under_way(desk, vehicle)
    yard.kill("adapter")
    desk.until(lambda: desk.robots[vehicle]["state"] == "lost")
    yard.start_adapter(bridge.address, "unanswered_after_s = 2.0")
    desk.wait_for_step(command, "reached", 60)
    assert steps(desk, command).count("acknowledged") == 1
    assert orders_of(yard, vehicle) == {"accepted as new": 1}


def test_a_gateway_that_is_killed_and_started_again_finds_it_on_its_way(bridge, yard):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    vehicle = begin(yard, desk, speed=SLOW)
    command = send(desk, vehicle, x=30.0, y=8.0)
    wait_under_way(desk, vehicle)
    desk.wait_for_step(command, "acknowledged")
    bridge.kill_gateway()
    bridge.start_gateway()

    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots(vehicle)
    desk.wait_for_step(command, "reached", 60)
    assert orders_of(yard, vehicle) == {"accepted as new": 1}


def test_two_vehicles_under_one_serial_number_are_said(desk, yard):
    vehicle = begin(yard, desk)
    yard.start_vehicle(vehicle, 22.0, 8.0, called="the second")
    desk.until(lambda: "two vehicles" in (desk.robots[vehicle].get("status") or ""), 30)
    command = send(desk, vehicle, x=40.0, y=8.0)
    desk.wait_for_step(command, "failed")
    assert "two vehicles" in reason(desk, command)


def test_an_order_that_is_done_while_the_adapter_is_away_is_reached(bridge, desk, yard):
    vehicle = begin(yard, desk, speed=3.0)
    command = send(desk, vehicle, x=26.0, y=8.0)
    desk.wait_for_step(command, "acknowledged")
    yard.kill("adapter")
    desk.until(lambda: desk.robots[vehicle]["state"] == "lost")
    desk.listen(4.0)
    yard.start_adapter(bridge.address, "unanswered_after_s = 2.0")
    desk.wait_for_step(command, "reached")


def test_an_order_that_was_ended_while_the_adapter_was_away_has_failed(bridge, desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    command = send(desk, vehicle, x=90.0, y=8.0)
    desk.wait_for_step(command, "acknowledged")
    yard.kill("adapter")
    desk.until(lambda: desk.robots[vehicle]["state"] == "lost")
    cancel = [{"actionType": "cancelOrder", "actionId": "theirs", "blockingType": "NONE"}]
    head = {"headerId": 1, "timestamp": "2026-11-23T12:00:00Z", "version": "2.0.0"}
    head |= {"manufacturer": "Acme", "serialNumber": vehicle}
    yard.publish(
        f"uagv/v2/Acme/{vehicle}/instantActions",
        json.dumps({**head, "instantActions": cancel, "actions": cancel}),
    )
    desk.listen(1.0)
    yard.start_adapter(bridge.address, "unanswered_after_s = 2.0")
    desk.wait_for_step(command, "failed")
    assert "ended its order" in reason(desk, command)


@pytest.fixture
def moved_site(sample_site, tmp_path):
    """The sample site with an origin 10 m further along its x axis."""
    site = read_site(sample_site)
    settings = site.settings
    frame = SiteFrame(settings.crs, settings.origin, math.radians(settings.rotation_deg))
    ((x, y),) = frame.to_crs([(10.0, 0.0)]).tolist()
    moved = replace(settings, origin=(x, y))
    write_site(tmp_path / "moved", moved, site.outlines, site.centrelines, site.surfaces, site.keepouts)
    return tmp_path / "moved"


def frame_lines(site):
    """Return the settings of vehicles whose map is the frame of a site, wherever the gateway's site is."""
    settings = read_site(site).settings
    lines = [f'crs = "{settings.crs}"', f"origin = {list(settings.origin)}"]
    return ["unanswered_after_s = 2.0", "[frame]", *lines, f"rotation_deg = {settings.rotation_deg}"]


def test_on_a_site_of_another_frame_a_vehicle_is_where_it_is_and_drives_there(
    start_bridge, new_database, sample_site, moved_site, modules, tmp_path
):
    bridge = start_bridge(sample_site)
    with Processes(tmp_path / "logs") as processes:
        yard = Yard(processes, tmp_path, modules)
        yard.start_broker()
        yard.start_adapter(bridge.address, *frame_lines(sample_site))
        desk = bridge.desk()
        desk.ask("subscribe", {"rate": 10})
        stands, drives = begin(yard, desk), begin(yard, desk, y=16.0, speed=SLOW)
        wait_at(desk, stands, 20.0, 8.0)
        desk.wait_for_step(send(desk, drives, x=90.0, y=16.0), "acknowledged")
        bridge.kill_gateway()
        bridge.site, bridge.database = moved_site, new_database("sqlite")
        bridge.start_gateway()

        desk = bridge.desk()
        desk.ask("subscribe", {"rate": 10})
        desk.wait_for_robots(stands, drives)
        wait_at(desk, stands, 10.0, 8.0)
        desk.wait_for_step(send(desk, stands, x=14.0, y=8.0), "reached")
        wait_until(lambda: re.search(r'"x":2[34](\.\d+)?,"y":8\b', yard.output(stands)[-5000:]))
        # What it drove to was asked by nobody whom a desk knows of.
        assert wait_for_standing(desk, drives) < 70.0
        desk.hang_up()
        yard.end()
    bridge.end()


def named(**serials):
    """Return the settings of vehicles that have names of their own."""
    tables = (
        ["[[vda5050.vehicles]]", 'manufacturer = "Acme"', f'serial = "{serial}"', f'robot = "{robot}"']
        for robot, serial in serials.items()
    )
    return ["unanswered_after_s = 2.0", *itertools.chain(*tables)]


def placed(x):
    """Return the settings of vehicles whose map begins at (x, 0) of the site."""
    return ["unanswered_after_s = 2.0", "[vda5050.maps.local]", f"origin = [{x}, 0.0]"]


OTHERWISE = {
    "names": (named(left="one", right="two"), named(left="two", right="one"), ("left", "right")),
    "map": (placed(0.0), placed(10.0), ("one", "one")),
}


@pytest.mark.parametrize(("before", "after", "names"), OTHERWISE.values(), ids=OTHERWISE)
def test_settings_that_changed_on_the_way_stop_a_vehicle_and_its_command_has_failed(
    bridge, modules, tmp_path, before, after, names
):
    asked, drives = names
    with Processes(tmp_path / "logs") as processes:
        yard = Yard(processes, tmp_path, modules)
        yard.start_broker()
        yard.start_adapter(bridge.address, *before, name="changed")
        desk = bridge.desk()
        desk.ask("subscribe", {"rate": 10})
        yard.start_vehicle("one", 20.0, 8.0, speed=SLOW)
        yard.start_vehicle("two", 20.0, 16.0)
        desk.wait_for_robots(*names)
        command = send(desk, asked, x=95.0, y=8.0)
        wait_under_way(desk, asked)
        yard.kill("adapter")
        yard.start_adapter(bridge.address, *after, name="changed")
        # By the settings of now that place is another one, or another vehicle's.
        desk.wait_for_step(command, "failed")
        place = wait_for_standing(desk, drives)
        assert place < 70.0
        desk.wait_for_step(send(desk, drives, x=place + 2.0, y=10.0), "reached")
        desk.hang_up()
        yard.end()
