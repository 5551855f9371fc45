"""Vehicle, broker, adapter and gateway are killed on the way and come back: nothing lost, nothing twice."""

from __future__ import annotations

import json

from tests.robot_bridge.links.vda5050.driving import (
    SLOW,
    begin,
    orders_of,
    reason,
    send,
    steps,
    wait_under_way,
)


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
