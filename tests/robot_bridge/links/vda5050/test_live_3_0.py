"""Vehicles of 3.0 at a real broker, led from a desk through a real gateway and adapter."""

from __future__ import annotations

import itertools
import re

import pytest

from tests.robot_bridge.links.vda5050.driving import (
    SLOW,
    abort_on_the_way,
    reason,
    replace_on_the_way,
    send,
    steps,
    wait_at,
    wait_for_standing,
    wait_under_way,
)
from tests.robot_bridge.links.vda5050.peers import Yard, require_broker
from tests.support.bridge.bridge_programs import wait_until
from tests.support.processes import Processes

NUMBERS = itertools.count(1)


@pytest.fixture(scope="module")
def standing_yard(bridge, root, tmp_path_factory):
    require_broker()
    guide = (root / "docs" / "links-vda5050.md").read_text(encoding="utf-8")
    block = re.search(r"## Version 3\.0\n(.*?)\n\n[A-Z]", guide, re.DOTALL)[1]
    lines = [line.strip() for line in block.splitlines() if re.match(" +(interface|major_version) =", line)]
    assert len(lines) == 2
    folder = tmp_path_factory.mktemp("yard")
    with Processes(folder / "logs") as processes:
        yard = Yard(processes, folder, "")
        yard.start_broker()
        yard.start_adapter(bridge.address, "unanswered_after_s = 2.0", *lines)
        yield yard
        yard.end()
        for name in yard.names:
            said = yard.output(name)
            assert "INVALID" not in said and "Traceback" not in said, said


def begin(yard, desk, **options):
    name = f"mobile-{next(NUMBERS)}"
    yard.start_vehicle_3_0(name, 20.0, 8.0, **options)
    desk.wait_for_robots(name)
    return name


def actions(yard, vehicle):
    return re.findall("action (\\w+)", yard.output(vehicle))


def test_a_target_is_reached_and_a_start_position_is_its_own(desk, yard):
    vehicle = begin(yard, desk)
    command = send(desk, vehicle, x=40.0, y=8.0)
    desk.wait_for_step(command, "reached")
    wait_at(desk, vehicle, 40.0, 8.0)
    assert steps(desk, command) == ["queued", "delivered", "acknowledged", "reached"]
    assert desk.robots[vehicle]["battery"] == pytest.approx(0.66)

    start = send(desk, vehicle, "SetPosIni", x=60.0, y=30.0, theta=0.5)
    desk.until(lambda: "acknowledged" in steps(desk, start))
    wait_at(desk, vehicle, 60.0, 30.0)
    assert "initializePosition" in actions(yard, vehicle)


def test_a_route_is_followed_base_by_base_and_an_abort_stops_it(desk, yard):
    vehicle = begin(yard, desk)
    command = send(desk, vehicle, "SetPath", points=[[20.0, 8.0], [46.0, 8.0], [46.0, 14.0], [40.0, 14.0]])
    desk.wait_for_step(command, "reached", 60)
    wait_at(desk, vehicle, 40.0, 14.0)
    assert "update accepted" in yard.output(vehicle)

    drive = send(desk, vehicle, "SetPath", points=[[40.0, 14.0], [80.0, 14.0], [80.0, 12.0]])
    abort_on_the_way(desk, vehicle, drive, 42.0)


def test_another_target_on_the_way_takes_the_place_of_the_first(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    replace_on_the_way(desk, vehicle)


def test_an_emergency_stop_that_is_given_twice_stops_it_until_the_next_task(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    drive = send(desk, vehicle, x=90.0, y=8.0)
    wait_under_way(desk, vehicle)
    desk.ask("emergency_stop", {"reason": "test"})
    desk.ask("emergency_stop", {"reason": "test"})
    try:
        desk.wait_for_step(drive, "aborted")
        desk.until(lambda: "paused" in (desk.robots[vehicle].get("status") or ""))
        assert wait_for_standing(desk, vehicle) < 80.0
    finally:
        desk.ask("clear_emergency_stop", {"reason": "test"})
    again = send(desk, vehicle, x=20.0, y=12.0)
    desk.wait_for_step(again, "reached")
    assert actions(yard, vehicle).count("stopPause") == 1


def test_why_it_refuses_an_order_is_told(desk, yard):
    vehicle = begin(yard, desk, knows="attic")
    command = send(desk, vehicle, x=40.0, y=8.0)
    desk.wait_for_step(command, "failed")
    assert "UNKNOWN_MAP_ID" in reason(desk, command)


def test_a_vehicle_that_dies_is_gone_and_goes_on_when_it_is_back(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    command = send(desk, vehicle, x=24.0, y=8.0)
    wait_under_way(desk, vehicle)
    yard.kill(vehicle)
    # Its last will says so at once.
    desk.until(lambda: desk.robots[vehicle]["state"] == "lost")
    yard.start_vehicle_3_0(vehicle, 20.0, 8.0)
    desk.wait_for_step(command, "reached")


def test_a_vehicle_of_2_1_is_named_and_not_led(desk, yard):
    head = '"headerId": 1, "timestamp": "2026-11-23T12:00:00Z", "version": "2.1.0", "manufacturer": "Acme"'
    online = f'{{{head}, "serialNumber": "old-1", "connectionState": "ONLINE"}}'
    yard.publish("vda5050/v3/Acme/old-1/connection", online)
    wait_until(lambda: "version '2.1.0' is not spoken here" in yard.output("adapter"))
    assert "old-1" not in desk.robots
